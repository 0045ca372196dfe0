"""A hexapod as control loops and optimisers call it: arrays in, arrays out, shapes checked and nothing else."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from numbers import Real
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import one_of
from flexapod.conventions import JOINT_MODELS, Array, JointModel
from flexapod.errors import ArgumentError, PoseError, shown
from flexapod.pose import Pose, PoseLike, as_pose
from flexapod.showing import in_notebooks

if TYPE_CHECKING:
    from flexapod.design.hexapod import Hexapod

_ZERO = (0.0,) * 6
_POSE = "a float64 array (6,) of x, y, z (m), roll, pitch, yaw (rad), or (12,) of a position and a matrix by rows"
_SHAPES = {"pose": ((6,), (12,))}
_NEEDED = {
    "pose": _POSE,
    "twist": "a float64 array (6,) of a velocity (m/s) and an angular velocity (rad/s)",
    "acceleration": "a float64 array (6,) of an acceleration (m/s^2) and an angular acceleration (rad/s^2)",
    "leg_force": "a float64 array (6,) of forces, N",
    "wrench": "a float64 array (6,) of a force (N) and a moment (N m)",
}


@in_notebooks
class LinearMatrices(NamedTuple):
    """Linear dynamics M x'' + C x' + K x = H f about a pose held at rest; unpacks as `M, C, K, H`.

    x is a small displacement of the platform (translation of its reference point, m, and rotation vector, rad, inertial
    axes), f a change of the leg forces, N.

    Attributes
    ----------
    M, C, K : ndarray
        Mass, damping and stiffness, (6, 6), SI, inertial axes.
    H : ndarray
        Force transformation, (6, 6).
    """

    M: Array
    C: Array
    K: Array
    H: Array


_matrices = partial(tuple.__new__, LinearMatrices)  # of the four that the core gives; `_make` counts them first


class CompiledHexapod:
    """A hexapod for loops that call it very often; made by `Hexapod.compiled`.

    Every method takes plain arrays of one state and returns new ones. Shapes are checked, values are not: numbers that
    are not finite, a matrix that does not rotate, or a pose that no leg can take give NaN or numbers without meaning,
    and no error. The functions of `flexapod` with these names check everything, and take many poses.

    Arrays, the same for all methods:

    - pose: x, y, z (m) and roll, pitch, yaw (rad) of the platform, (6,); or its position (m) and rotation matrix by
      rows, (12,). In the inertial frame, in which the base rests.
    - twist: velocity of the platform's reference point (m/s) and angular velocity (rad/s), inertial axes, (6,)
    - acceleration: of that point (m/s^2), and angular (rad/s^2), inertial axes, (6,)
    - leg_force: N, positive where legs push platform and base apart, (6,)
    - wrench: force (N) and moment (N m) on the platform at its reference point, in its own axes, (6,)

    Attributes
    ----------
    joint : str
        Model of the base joints.
    base : Pose
        Pose of the base in the inertial frame, at rest.

    See Also
    --------
    flexapod.sweep : Many poses at once, which costs far less a pose.

    Notes
    -----
    Eqs 5, 6, 34 and 35 of the paper, by the compiled code of those functions. Frequencies come as in a sweep, each
    right to a few roundings of the highest one. Lists and tuples of numbers are taken as well as arrays.

    Examples
    --------
    >>> machine = fx.load("motion-base").compiled()
    >>> pose = np.array([0, 0, 2.39, 0, 0, 0])
    >>> round(machine.stability_index(pose), 1)  # rad/s
    28.1
    >>> machine.leg_lengths(pose).round(3).tolist()
    [2.706, 2.706, 2.706, 2.706, 2.706, 2.706]
    """

    __slots__ = ("_core", "_hexapod", "base", "joint")

    def __init__(self, hexapod: Hexapod, base: PoseLike | None = None, joint: JointModel = "universal") -> None:
        self.joint = one_of(joint, "joint", JOINT_MODELS)
        self.base = Pose((0.0, 0.0, 0.0)) if base is None else as_pose(base, "base")
        if self.base.shape:
            raise PoseError(f"base has batch axes {self.base.shape}; one pose is needed. Index it first.")
        self._hexapod = hexapod
        self._core = _core.Compiled(hexapod.packed, _core.Joint[self.joint], self.base.packed)

    def stability_index(self, pose: ArrayLike) -> float:
        """Compute the dynamic stability index, the lowest natural frequency, rad/s."""
        found = self._core.stability_index(pose)
        return self._again("stability_index", pose=pose) if found is None else found

    def natural_frequencies(self, pose: ArrayLike) -> Array:
        """Compute the six undamped natural frequencies, rad/s, (6,), ascending."""
        found = self._core.natural_frequencies(pose)
        return self._again("natural_frequencies", pose=pose) if found is None else found

    def leg_lengths(self, pose: ArrayLike) -> Array:
        """Compute the leg lengths, m, (6,)."""
        found = self._core.leg_lengths(pose)
        return self._again("leg_lengths", pose=pose) if found is None else found

    def jacobian(self, pose: ArrayLike) -> Array:
        """Compute the matrix that takes a twist to the rates of the leg lengths, m/s, (6, 6); H is its transpose."""
        found = self._core.jacobian(pose)
        return self._again("jacobian", pose=pose) if found is None else found

    def forward_dynamics(
        self, pose: ArrayLike, twist: ArrayLike, leg_force: ArrayLike, wrench: ArrayLike = _ZERO
    ) -> Array:
        """Compute the platform's acceleration (m/s^2) and angular acceleration (rad/s^2), inertial axes, (6,)."""
        found = self._core.forward_dynamics(pose, twist, leg_force, wrench)
        return (
            self._again("forward_dynamics", pose=pose, twist=twist, leg_force=leg_force, wrench=wrench)
            if found is None
            else found
        )

    def inverse_dynamics(
        self, pose: ArrayLike, twist: ArrayLike = _ZERO, acceleration: ArrayLike = _ZERO, wrench: ArrayLike = _ZERO
    ) -> Array:
        """Compute the leg forces for a motion, N, (6,); NaN where H is singular."""
        found = self._core.inverse_dynamics(pose, twist, acceleration, wrench)
        return (
            self._again("inverse_dynamics", pose=pose, twist=twist, acceleration=acceleration, wrench=wrench)
            if found is None
            else found
        )

    def linearised(self, pose: ArrayLike, wrench: ArrayLike = _ZERO) -> LinearMatrices:
        """Compute M, C, K and H, (6, 6) each, about the pose held at rest under gravity and a wrench."""
        found = self._core.linearised(pose, wrench)
        return _matrices(self._again("linearised", pose=pose, wrench=wrench) if found is None else found)

    def _again(self, method: str, **given: ArrayLike) -> Any:
        """The answer to what the core does not read at once. Raises ArgumentError for the first that is wrong."""
        return getattr(self._core, method)(*(_plain(name, value) for name, value in given.items()))

    def __repr__(self) -> str:
        return f"<CompiledHexapod {self._hexapod.name!r}, joint={self.joint!r}, base={self.base!r}>"

    def __reduce__(self) -> tuple[type[CompiledHexapod], tuple[Hexapod, Pose, str]]:
        return CompiledHexapod, (self._hexapod, self.base, self.joint)


def _plain(name: str, value: ArrayLike) -> Array:
    """An argument as a plain array, from a list of numbers of any kind too. Raises ArgumentError for what is none."""
    array = np.empty(0)
    if type(value) is np.ndarray and value.dtype == np.float64:
        array = value
    elif isinstance(value, list | tuple) and all(isinstance(one, Real) for one in value):
        with suppress(OverflowError):
            array = np.array(value, dtype=np.float64)
    if array.shape not in _SHAPES.get(name, ((6,),)):
        told = f"an array of {value.dtype} {value.shape}" if isinstance(value, np.ndarray) else shown(value)
        raise ArgumentError(f"{name} is {told}; it must be {_NEEDED[name]}.")
    return array
