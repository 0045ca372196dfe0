"""What can go wrong, by name. Every message says the thing, its value, what is required and the remedy."""

import reprlib
from typing import Any


class _Short(reprlib.Repr):
    """Values in messages: the start of what is long or nested deeply, and integers of any size."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxstring, self.maxother = 4, 80, 80

    def repr_int(self, x: int, level: int) -> str:
        return repr(x) if x.bit_length() < 256 else f"an integer of {x.bit_length()} bits"


shown = _Short().repr


class FlexapodError(Exception):
    """Base of all errors that Flexapod raises on purpose."""


class ArgumentError(FlexapodError, ValueError):
    """A number, table or name given to a study that it cannot work with."""


class DesignError(FlexapodError, ValueError):
    """A design that cannot be a hexapod: a wrong key, unit, size or value."""


class PoseError(FlexapodError, ValueError):
    """A pose or motion of the wrong shape or with values that are not finite."""


class KinematicsError(FlexapodError, ValueError):
    """Leg lengths that admit no pose, or a search that did not find one."""


class SingularPoseError(FlexapodError, ValueError):
    """A pose at which the legs cannot hold the platform (H is singular)."""


class InfeasibleError(FlexapodError, ValueError):
    """No design that keeps every constraint: the start breaks one, or a search found none."""


class PathError(FlexapodError, ValueError):
    """Waypoints or times that make no path, or a path that cannot be found."""


class UnstableError(FlexapodError, ValueError):
    """A closed loop that the exact tangent shows to be unstable, or a controller that cannot be made."""


class OutputError(FlexapodError, OSError):
    """A file or store that cannot be written, read, or taken up again."""


class MissingExtraError(FlexapodError, ImportError):
    """A package that a part of Flexapod needs and that is not installed."""


class ClusterError(FlexapodError, RuntimeError):
    """A cluster of computers that cannot be reached, or that gave up."""


class SimulationError(FlexapodError, RuntimeError):
    """A simulation that could not go on. `time` (s) and `pose`: where it ended; `result`: the Dataset so far."""

    def __init__(self, message: str, time: float = float("nan"), pose: Any = None, result: Any = None) -> None:
        super().__init__(message)
        self.time, self.pose, self.result = time, pose, result
