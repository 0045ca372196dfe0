"""Errors that Flexapod raises. Every message names the thing, its value, what is required and the remedy."""

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


def told_apart(value: float, bound: float, digits: tuple[int, int] = (4, 4)) -> tuple[str, str]:
    """A value and a bound in words, with so many digits or as many more as show which of them is larger."""
    for more in range(14):
        words = f"{value:.{digits[0] + more}g}", f"{bound:.{digits[1] + more}g}"
        shown_as = float(words[0]), float(words[1])
        if (shown_as[0] < shown_as[1], shown_as[0] > shown_as[1]) == (value < bound, value > bound):
            break
    return words


class FlexapodError(Exception):
    """Base of all errors of Flexapod: catching it catches them all."""


class ArgumentError(FlexapodError, ValueError):
    """A wrong argument: an unknown name, a number out of range, an array of a wrong shape."""


class DesignError(FlexapodError, ValueError):
    """Not a hexapod: a design with a wrong key, unit, size or value, or something else where a design is needed."""


class PoseError(FlexapodError, ValueError):
    """A wrong pose or motion, one that no leg can take, or a batch where one pose is needed."""


class KinematicsError(FlexapodError, ValueError):
    """Leg lengths that admit no pose, or a search that did not find one."""


class SingularPoseError(FlexapodError, ValueError):
    """A pose at which the legs cannot hold the platform (H is singular)."""


class InfeasibleError(FlexapodError, ValueError):
    """No design keeps every constraint: the start breaks one, or a search found none."""


class PathError(FlexapodError, ValueError):
    """Waypoints or times that make no trajectory, or a path that cannot be found."""


class UnstableError(FlexapodError, ValueError):
    """A closed loop that is unstable in the linear dynamics, or a controller that cannot be made."""


class OutputError(FlexapodError, OSError):
    """A file or store that cannot be written, read, or taken up again."""


class MissingExtraError(FlexapodError, ImportError):
    """A package that a part of Flexapod needs and that is not installed."""


class ClusterError(FlexapodError, RuntimeError):
    """A cluster of computers that cannot be reached, or that gave up."""


class SimulationError(FlexapodError, RuntimeError):
    """A simulation that could not go on.

    Attributes
    ----------
    time : float
        When it ended, s.
    pose : Pose
        Where the platform was then.
    result : xarray.Dataset
        What was simulated until then.
    """

    def __init__(self, message: str, time: float = float("nan"), pose: Any = None, result: Any = None) -> None:
        super().__init__(message)
        self.time, self.pose, self.result = time, pose, result
