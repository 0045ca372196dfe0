"""Where a body is and how it moves: `Pose` and `Motion`, each one or many (leading batch axes)."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod._suggestions import Suggesting, suggests
from flexapod.checks import floats
from flexapod.conventions import Array
from flexapod.errors import FlexapodError, PoseError, shown
from flexapod.rotations import (
    FIXED,
    angles_of_matrix,
    checked_matrices,
    many_quaternions,
    matrices_of_quaternions,
    matrix_of_angles,
    rpy_matrix,
    rpy_of_matrices,
    threads_for,
)

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

#: What a pose may be given as: six numbers are x, y, z in m and roll, pitch, yaw in rad.
PoseLike: TypeAlias = "Pose | ArrayLike"
MotionLike: TypeAlias = "Pose | Motion | ArrayLike"


def vectors(value: ArrayLike, name: str, width: int = 3, error_type: type[FlexapodError] = PoseError) -> Array:
    """A copy of `value` as finite float64 of shape (..., width); raises `error_type` otherwise."""
    try:
        array = floats(value)
    except (TypeError, ValueError) as error:
        raise error_type(f"{name} is {shown(value)}; it must hold {width} numbers.") from error
    if array.ndim == 0 or array.shape[-1] != width:
        raise error_type(f"{name} has shape {array.shape}; its last axis must hold {width} numbers.")
    array = np.ascontiguousarray(array)
    if not _core.all_finite(array, threads_for(array.size)):
        raise error_type(f"{name} holds NaN or infinity; all its numbers must be finite.")
    return array


_WORDS = dict.fromkeys("xyz", "position") | {
    **dict.fromkeys(("roll", "pitch", "yaw", "orientation"), "rpy (roll, pitch, yaw), or rotation"),
    **dict.fromkeys(("euler", "as_euler"), "angles(order)"),
    **dict.fromkeys(("quaternion", "quat", "as_quat"), "rotation.as_quat()"),
    **dict.fromkeys(("as_matrix", "rotation_matrix", "R"), "matrix"),
    **dict.fromkeys(("from_euler", "from_xyzrpy"), "from_rpy, or from_angles for other orders of rotation"),
    "from_rotation": "Pose(position, rotation)",
}


@suggests(_WORDS)
class Pose(metaclass=Suggesting):
    """Position of a body's reference point and its orientation; one pose or many, equal and hashed by value.

    Parameters
    ----------
    position : array_like
        Position of the reference point, m, (..., 3).
    rotation : scipy.spatial.transform.Rotation or array_like, optional
        Orientation: a `Rotation` (one or many), or matrices (..., 3, 3) that take vectors from body axes to the outer
        frame. Left out, the body is not turned.

    Attributes
    ----------
    position : ndarray
        Position, m, (..., 3), read-only.
    matrix : ndarray
        Rotation matrices, (..., 3, 3), read-only.

    Raises
    ------
    PoseError
        For wrong shapes, numbers that are not finite, or matrices that do not rotate.

    Notes
    -----
    Section 4.2 of the paper; an orientation is a rotation, not three angles. Functions that take a pose also take six
    numbers: x, y, z in m and roll, pitch, yaw in rad.

    Examples
    --------
    >>> fx.Pose.from_rpy(0, 0, 0.5, yaw=30, degrees=True)
    Pose(x=0 y=0 z=0.5 m, roll=0 pitch=0 yaw=30 deg)
    >>> from scipy.spatial.transform import Rotation
    >>> fx.Pose([0, 0, 0.5], Rotation.from_euler("z", 30, degrees=True)).rpy.round(4).tolist()
    [0.0, 0.0, 0.5236]
    >>> fx.Pose([[0, 0, 0.5], [0, 0, 0.6]])[1]
    Pose(x=0 y=0 z=0.6 m, roll=0 pitch=0 yaw=0 deg)
    """

    __slots__ = ("_matrix", "_quaternion", "position")

    position: Array
    _matrix: Array | None  # made of the quaternion when it is first asked for
    _quaternion: Array | None

    def __init__(self, position: ArrayLike, rotation: Rotation | ArrayLike | None = None) -> None:
        try:
            p = vectors(position, "position")
        except PoseError:
            if np.asarray(position, dtype=object).shape[-1:] != (6,):
                raise
            raise PoseError(
                "position has six numbers; it must have three, x, y, z in m. With angles: "
                "Pose.from_rpy(x, y, z, roll, pitch, yaw)."
            ) from None
        q = many_quaternions(rotation)
        R = q if q is not None else np.eye(3) if rotation is None else checked_matrices(rotation)
        own = (4,) if q is not None else (3, 3)
        if p.ndim == 1 and R.shape == (3, 3):
            self.position, self._matrix, self._quaternion = _read_only(p), _read_only(R), None
            return
        try:
            shape = np.broadcast_shapes(p.shape[:-1], R.shape[: -len(own)])
        except ValueError:
            raise PoseError(
                f"position {p.shape} and rotation {R.shape} do not fit: their leading axes must be equal or 1."
            ) from None
        self.position = np.broadcast_to(p, (*shape, 3))
        turned = np.broadcast_to(R, (*shape, *own))
        self._matrix, self._quaternion = (turned, None) if q is None else (None, turned)

    @property
    def matrix(self) -> Array:
        """Rotation matrices, (..., 3, 3), read-only."""
        if self._matrix is None:
            assert self._quaternion is not None
            self._matrix = _read_only(matrices_of_quaternions(self._quaternion))
        return self._matrix

    @classmethod
    def from_rpy(
        cls,
        x: ArrayLike,
        y: ArrayLike,
        z: ArrayLike,
        roll: ArrayLike = 0,
        pitch: ArrayLike = 0,
        yaw: ArrayLike = 0,
        *,
        degrees: bool = False,
    ) -> Pose:
        """Make a pose from a position and three angles, turned about the fixed axes x (roll), then y (pitch), then z.

        Parameters
        ----------
        x, y, z : array_like
            Position, m, (...).
        roll, pitch, yaw : array_like
            Angles about the fixed axes x, y and z, in this order, (...), rad.
        degrees : bool
            Whether the angles are given in degrees.

        Returns
        -------
        Pose
            One pose, or as many as the numbers' common shape has.

        Raises
        ------
        PoseError
            For what is not a finite number, or shapes that do not fit.
        """
        try:
            numbers = np.broadcast_arrays(*(floats(v) for v in (x, y, z, roll, pitch, yaw)))
        except (TypeError, ValueError) as error:
            raise PoseError(f"x, y, z, roll, pitch and yaw must be numbers, or arrays that fit: {error}") from error
        six = vectors(np.stack(numbers, axis=-1), "pose", 6)
        return Pose(six[..., :3], rpy_matrix(np.radians(six[..., 3:]) if degrees else six[..., 3:]))

    @classmethod
    def from_angles(
        cls,
        position: ArrayLike,
        angles: ArrayLike,
        order: str = FIXED,
        *,
        degrees: bool = False,
        pivot: ArrayLike = (0.0, 0.0, 0.0),
    ) -> Pose:
        """Make a pose from a position and three angles of any order, turned about any point of the body.

        Parameters
        ----------
        position : array_like
            Position of the reference point before the body is turned, m, (..., 3).
        angles : array_like
            Angles about the axes of `order`, the first turn first, (..., 3), rad.
        order : str
            Axes of the three turns in SciPy's words: "xyz" about fixed axes (roll, pitch, yaw), "XYZ" about moving
            axes, "ZXZ" for Euler's angles, and so on.
        degrees : bool
            Whether the angles are given in degrees.
        pivot : array_like
            Point of the body, in its own axes, m, (..., 3), that the turn leaves in place: the reference point goes to
            position + (E - R) pivot.

        Returns
        -------
        Pose
            One pose, or as many as the numbers' common shape has.

        Raises
        ------
        PoseError
            For an unknown order, what is not a finite number, or shapes that do not fit.
        """
        place, turn, point = vectors(position, "position"), vectors(angles, "angles"), vectors(pivot, "pivot")
        matrix = matrix_of_angles(np.radians(turn) if degrees else turn, order)
        try:
            return cls(place + point - np.einsum("...ij,...j->...i", matrix, point), matrix)
        except ValueError:
            raise PoseError("position, angles and pivot do not fit: their leading axes must be equal or 1.") from None

    def angles(self, order: str = FIXED, *, degrees: bool = False) -> Array:
        """Give the three angles, rad or degrees, (..., 3), that `from_angles` takes for this orientation."""
        found = self.rpy if isinstance(order, str) and order == FIXED else angles_of_matrix(self.matrix, order)
        return np.degrees(found) if degrees else found

    def position_about(self, pivot: ArrayLike) -> Array:
        """Give the position, m, (..., 3), that `from_angles` takes with this pivot for the same pose."""
        point = vectors(pivot, "pivot")
        return self.position - point + np.einsum("...ij,...j->...i", self.matrix, point)

    def displaced(self, by: PoseLike) -> Pose:
        """Give the pose displaced by another: positions add, and `by` turns it about the outer frame's axes."""
        by = as_pose(by, "by")
        return Pose.trusted(self.position + by.position, by.matrix @ self.matrix)

    @classmethod
    def trusted(cls, position: Array, matrix: Array) -> Pose:
        """The poses of numbers that are known to be poses, or NaN where there is none: nothing is checked."""
        pose = Pose.__new__(Pose)
        pose._hold(position, matrix)
        return pose

    def _hold(self, position: Array, matrix: Array) -> None:
        """Keep views of numbers that nobody changes."""
        self.position, self._matrix = _read_only(position[...]), _read_only(matrix[...])
        self._quaternion = None

    @property
    def rotation(self) -> Rotation:
        """Orientation as a scipy `Rotation`, flattened over the batch axes."""
        from scipy.spatial.transform import Rotation

        if self._quaternion is not None:
            return Rotation.from_quat(self._quaternion.reshape(-1, 4) if self.shape else self._quaternion)
        return Rotation.from_matrix(self.matrix if self.matrix.ndim == 2 else self.matrix.reshape(-1, 3, 3))

    @property
    def rpy(self) -> Array:
        """Roll, pitch, yaw in rad, (..., 3): fixed axes x, y, z; pitch within +-pi/2, yaw 0 where pitch is +-pi/2."""
        return rpy_of_matrices(self.matrix)

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch axes; () for one pose."""
        return self.position.shape[:-1]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Pose):
            return NotImplemented
        return np.array_equal(self.position, other.position) and np.array_equal(self.matrix, other.matrix)

    def __hash__(self) -> int:
        return hash((self.shape, (self.position + 0.0).tobytes(), (self.matrix + 0.0).tobytes()))  # -0.0 is 0.0

    def __getitem__(self, index: Any) -> Pose:
        if self._matrix is not None:
            return Pose.trusted(self.position[index], self._matrix[index])
        assert self._quaternion is not None
        pose = Pose.__new__(Pose)
        pose.position, pose._matrix, pose._quaternion = self.position[index], None, self._quaternion[index]
        return pose

    @property
    def numbers(self) -> tuple[Array, Array]:
        """Positions (n, 3) and rotations, (n, 9) or as quaternions (n, 4), of all poses, as sweeps take them."""
        turned = self._matrix if self._quaternion is None else self._quaternion
        width = 9 if self._quaternion is None else 4
        assert turned is not None
        return (
            np.ascontiguousarray(self.position).reshape(-1, 3),
            np.ascontiguousarray(turned).reshape(-1, width),
        )

    @property
    def packed(self) -> Array:
        """(..., n): its numbers in the core's order, position and matrix by rows."""
        return np.concatenate([self.position, self.matrix.reshape(*self.shape, 9)], axis=-1)

    def __repr__(self) -> str:
        if self.shape:
            return f"<Pose {self.shape}>"
        x, y, z = self.position
        roll, pitch, yaw = np.degrees(self.rpy)
        return f"Pose(x={x:.6g} y={y:.6g} z={z:.6g} m, roll={roll:.5g} pitch={pitch:.5g} yaw={yaw:.5g} deg)"


def _read_only(array: Array) -> Array:
    array.flags.writeable = False
    return array


def as_pose(value: Any, name: str = "pose") -> Pose:
    """A Pose from a Pose, or from x, y, z (m), roll, pitch, yaw (rad) as (..., 6) numbers; or PoseError."""
    if isinstance(value, Pose):
        return value
    if isinstance(value, Motion) or np.ndim(value) == 0 or isinstance(value, str):
        raise PoseError(
            f"{name} is {type(value).__name__}; give a flexapod Pose, or x, y, z in m and roll, pitch, yaw in rad."
        )
    six = vectors(value, name, 6)
    return Pose(six[..., :3], rpy_matrix(six[..., 3:]))


#: Name, numbers and shape of each part of a motion as the core has it, in its order; the first two are the pose.
_PARTS = [
    (field.name, slice(field.offset, field.offset + field.index.size), field.shape) for field in _core.MOTION_LAYOUT
]
rates = attrgetter(*(name for name, _, _ in _PARTS[2:]))  # of a Motion, in the core's order


def unpack(numbers: Array) -> dict[str, Array]:
    """The parts of a motion, or of a pose alone, by name, from numbers (..., n) in the core's order."""
    return {
        name: numbers[..., place].reshape(*numbers.shape[:-1], *shape)
        for name, place, shape in _PARTS
        if place.stop <= numbers.shape[-1]
    }


class Motion:
    """Pose, velocity and acceleration of a body in the inertial frame; one motion or many, equal and hashed by value.

    Parameters
    ----------
    pose : Pose or array_like
        Where the body is: a Pose, or x, y, z in m and roll, pitch, yaw in rad.
    velocity : array_like
        Velocity of the reference point, m/s, (..., 3).
    angular_velocity : array_like
        Angular velocity, rad/s, (..., 3).
    acceleration : array_like
        Acceleration of the reference point, m/s2, (..., 3).
    angular_acceleration : array_like
        Angular acceleration, rad/s2, (..., 3).

    Raises
    ------
    PoseError
        For wrong shapes or numbers that are not finite.

    Notes
    -----
    Section 4.2 of the paper. What is left out is zero.

    Examples
    --------
    >>> motion = fx.Motion([0, 0, 0.5, 0, 0, 0], velocity=[0, 0, 0.1])
    >>> motion.velocity.tolist()
    [0.0, 0.0, 0.1]
    """

    __slots__ = ("acceleration", "angular_acceleration", "angular_velocity", "pose", "velocity")

    pose: Pose
    velocity: Array
    angular_velocity: Array
    acceleration: Array
    angular_acceleration: Array

    def __init__(
        self,
        pose: PoseLike,
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
        acceleration: ArrayLike = (0.0, 0.0, 0.0),
        angular_acceleration: ArrayLike = (0.0, 0.0, 0.0),
    ) -> None:
        given = {
            "velocity": velocity,
            "angular_velocity": angular_velocity,
            "acceleration": acceleration,
            "angular_acceleration": angular_acceleration,
        }
        pose = as_pose(pose)
        checked = {name: vectors(value, name) for name, value in given.items()}
        if pose.position.ndim == 1 and all(v.ndim == 1 for v in checked.values()):
            self.pose = pose
            for name, value in checked.items():
                setattr(self, name, _read_only(value))
            return
        try:
            shape = np.broadcast_shapes(pose.shape, *(v.shape[:-1] for v in checked.values()))
        except ValueError:
            raise PoseError("the leading axes of pose, velocities and accelerations must be equal or 1.") from None
        self.pose = Pose.trusted(
            np.broadcast_to(pose.position, (*shape, 3)), np.broadcast_to(pose.matrix, (*shape, 3, 3))
        )
        for name, value in checked.items():
            setattr(self, name, np.broadcast_to(value, (*shape, 3)))

    @classmethod
    def fixed(cls, pose: Pose | None = None) -> Motion:
        """At rest, at the inertial frame's origin or at a pose."""
        return cls(Pose((0.0, 0.0, 0.0)) if pose is None else pose)

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch axes; () for one motion."""
        return self.pose.shape

    @property
    def packed(self) -> Array:
        """(..., n): its numbers in the core's order (`flexapod._core.MOTION_LAYOUT`)."""
        flat = self.pose.matrix.reshape(*self.shape, 9)
        return np.concatenate([self.pose.position, flat, *rates(self)], axis=-1)

    @classmethod
    def unpacked(cls, numbers: Array) -> Motion:
        """The motion of numbers (..., n) in the core's order."""
        parts = unpack(numbers)
        return cls(Pose(parts.pop("position"), parts.pop("matrix")), **parts)

    def __eq__(self, other: object) -> bool:
        return np.array_equal(self.packed, other.packed) if isinstance(other, Motion) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.shape, (self.packed + 0.0).tobytes()))

    def __repr__(self) -> str:
        return f"<Motion {self.shape}>" if self.shape else f"Motion({self.pose!r}, v={self.velocity}, ...)"
