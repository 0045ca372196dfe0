"""Forward kinematics: the pose, or all poses, at which the legs have given lengths."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import floats, thread_count
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, KinematicsError, PoseError, shown
from flexapod.mechanics.inputs import as_hexapod
from flexapod.mechanics.kinematics import home_pose, platform_size, sides
from flexapod.pose import Pose, PoseLike, as_pose, unpack, vectors
from flexapod.rotations import orthonormal
from flexapod.showing import in_notebooks

_TOLERANCE = 1e-11  # of the longest leg: what a length may be off
_POSE = Pose((0.0, 0.0, 0.0)).packed.size  # numbers of a pose in the core
_BLOCK = 32  # sets of lengths for each thread and call of the core: between calls an interrupt is heard


class FoundPose(Pose):
    """A pose found from leg lengths, or many; NaN where none was found.

    Attributes
    ----------
    status : str or ndarray of str
        (...), "found": Newton's method led there from the start; "nearest": it led nowhere, or beyond a singular pose,
        and this is the nearest to the start of all assemblies on the start's side; "not_found"; "wrong_lengths": the
        lengths are not six numbers > 0.
    misfit : ndarray
        Largest error of a length, m, (...); where no pose was found, of the closest pose that Newton's method reached.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> lengths = fx.inverse_kinematics(machine)
    >>> fx.forward_kinematics(machine, [lengths, lengths * [10, 1, 1, 1, 1, 1]]).status.tolist()
    ['found', 'not_found']
    """

    __slots__ = ("misfit", "status")

    status: Any
    misfit: Any

    def __init__(self, position: Array, matrix: Array, status: Any, misfit: Any) -> None:
        self._hold(position, matrix)
        self.status, self.misfit = (str(status) if np.ndim(status) == 0 else status), misfit

    def __getitem__(self, index: Any) -> FoundPose:
        return FoundPose(self.position[index], self.matrix[index], self.status[index], self.misfit[index])

    def __repr__(self) -> str:
        if self.shape:
            found = np.isfinite(self.position).all(axis=-1).sum()
            return f"<FoundPose {self.shape}, {found} found>"
        return super().__repr__() if np.isfinite(self.position).all() else f"<FoundPose, {self.status}>"


@in_notebooks
class Assemblies(NamedTuple):
    """All poses at which the legs have given lengths.

    Attributes
    ----------
    pose : Pose
        The k poses, in the base frame, (k,); those of a set of lengths follow one another, the nearest to the start
        first.
    row : ndarray of int
        The set of lengths that each pose belongs to, (k,), counted from 0.
    side : ndarray of int
        Sign of det H at each pose, (k,): only poses of one sign are joined by motions that pass no singular pose. 0 at
        a singular pose, where several assemblies meet, or where the platform moves though no leg does.
    misfit : ndarray
        Largest error of a length at each pose, m, (k,).
    status : str or ndarray of str
        (...), "complete"; "incomplete": some path was lost, and a pose may be missing; "wrong_lengths": the lengths are
        not six numbers > 0.
    paths : int
        Number of assemblies, complex ones too, of these joints with general lengths: at most 40.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> found = fx.forward_kinematics_all(machine, fx.inverse_kinematics(machine))
    >>> len(found.row), found.pose[0].position.round(3)[2].item()
    (8, 2.39)
    """

    pose: Pose
    row: np.ndarray
    side: np.ndarray
    misfit: Array
    status: Any
    paths: int


def forward_kinematics(hexapod: Hexapod, lengths: ArrayLike, *, start: PoseLike | None = None) -> FoundPose:
    """Find the pose, in the base frame, at which the legs have given lengths.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    lengths : array_like
        Leg lengths, m, (..., 6).
    start : Pose or array_like, optional
        Where the search begins, one for all or one for each set of lengths. Left out, the home pose, or a pose above
        the base.

    Returns
    -------
    FoundPose
        The pose or poses, with the leading axes of `lengths`, and their `status`. In a batch, lengths that admit no
        pose give NaN.

    Raises
    ------
    KinematicsError
        For a single set of lengths that admits no pose, with the misfit, or that has a length that is not > 0.
    ArgumentError
        For lengths that are not six numbers each; for a single set, also where one is not finite.
    PoseError
        For a start that is wrong, or does not fit the lengths.

    See Also
    --------
    flexapod.inverse_kinematics : The leg lengths at a pose.
    flexapod.forward_kinematics_all : All poses with these lengths.

    Notes
    -----
    Newton's method on Eq. 6 of the paper, damped far from the solution: near the start it finds the assembly that the
    legs lead to, elsewhere any. Where it ends without one, or beyond a singular pose (det H has another sign than at
    the start, so that no motion leads there without passing one), all assemblies are computed as in
    `flexapod.forward_kinematics_all`, and the nearest on the start's side is taken, with the status "nearest". Whether
    the machine can get there from the start, sides alone do not tell. The lengths are met to 1e-11 of the longest.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> lengths = fx.inverse_kinematics(machine, [0.1, 0, 2.4, 0, 0.05, 0])
    >>> (fx.forward_kinematics(machine, lengths).position.round(6) + 0.0).tolist()
    [0.1, 0.0, 2.4]
    """
    as_hexapod(hexapod)
    rows, shape, good = _checked(lengths)
    starts = _starts(hexapod, rows, shape, good, start)
    packed = np.full((len(rows), _POSE), np.nan)
    misfit, status = np.full(len(rows), np.nan), np.full(len(rows), "wrong_lengths", dtype="<U13")
    packed[good], misfit[good] = _core.forward_kinematics(hexapod.packed, rows[good], _at_rest(starts[good]))
    pose = _poses(packed)
    side, wanted = _sides_of_both(hexapod, pose, starts)
    status[good] = "found"
    again = good & ~((misfit <= _TOLERANCE * rows.max(axis=1)) & (side * wanted >= 0))
    if again.any():
        which = np.flatnonzero(again)
        found, numbers, errors = _nearest(hexapod, rows[which], starts[which], wanted[which])
        status[which] = "not_found"
        packed[which[found]], misfit[which[found]], status[which[found]] = numbers, errors, "nearest"
        packed[status == "not_found"] = np.nan
        pose = _poses(packed)
    if not shape and status[0] == "not_found":
        raise KinematicsError(
            f"leg lengths {np.array2string(rows[0], precision=6)} m admit no pose that could be found: the closest "
            f"one misses a length by {misfit[0]:.3g} m; check the lengths."
        )
    position, matrix = pose.position.reshape(*shape, 3), pose.matrix.reshape(*shape, 3, 3)
    return FoundPose(position, matrix, status.reshape(shape), misfit.reshape(shape)[()])


def forward_kinematics_all(
    hexapod: Hexapod, lengths: ArrayLike, *, start: PoseLike | None = None, threads: int | None = None
) -> Assemblies:
    """Find every pose, in the base frame, at which the legs have given lengths.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    lengths : array_like
        Leg lengths, m, (..., 6).
    start : Pose or array_like, optional
        Pose from which the poses found are ordered, the nearest first. Left out, the home pose, or one above the base.
    threads : int, optional
        Threads for many sets of lengths; all cores by default.

    Returns
    -------
    Assemblies
        The poses, and whether they are all.

    Raises
    ------
    KinematicsError
        For a single set of lengths with one that is not > 0.
    ArgumentError
        For lengths that are not six numbers each; for a single set, also where one is not finite; for a wrong number of
        threads.
    PoseError
        For a start that is wrong, or does not fit the lengths.

    See Also
    --------
    flexapod.forward_kinematics : The pose that the legs lead to from a start.

    Notes
    -----
    Homotopy continuation [1]_. A platform with general complex joints and lengths has 40 assemblies [2]_; followed
    while its numbers change into those of the machine, they end, with probability one, at all its isolated assemblies.
    The real ones are polished by Newton's method to 1e-11 of the longest leg or better. "complete" says that no path
    was lost, none ended where another did, and that with each complex assembly its conjugate was found. Poses of a
    continuum, along which the platform moves though no leg does, are not isolated; at most single ones of them are
    found, with side 0.

    References
    ----------
    .. [1] A. P. Morgan and A. J. Sommese, "Coefficient-parameter polynomial continuation", Applied Mathematics and
       Computation 29 (1989).
    .. [2] C. W. Wampler, "Forward displacement analysis of general six-in-parallel SPS (Stewart) platform manipulators
       using soma coordinates", Mechanism and Machine Theory 31 (1996).

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> found = fx.forward_kinematics_all(machine, fx.inverse_kinematics(machine))
    >>> found.status, found.side.tolist()
    ('complete', [-1, 1, 1, 1, 1, -1, -1, -1])
    """
    as_hexapod(hexapod)
    rows, shape, good = _checked(lengths)
    starts = _starts(hexapod, rows, shape, good, start)
    status = np.full(len(rows), "wrong_lengths", dtype="<U13")
    search = _core.AssemblySearch(hexapod.packed)
    which = np.flatnonzero(good)
    row, packed, misfit, complete = _all(search, rows[which], thread_count(threads))
    row = which[row]
    status[which] = np.where(complete, "complete", "incomplete")
    pose = _poses(packed)
    order = np.lexsort((_distance(hexapod, pose, starts[row]), row))
    pose = pose[order]
    return Assemblies(
        pose,
        row[order],
        sides(hexapod, pose),
        misfit[order],
        status.reshape(shape) if shape else str(status[0]),
        max(search.paths, 0),
    )


def _checked(lengths: ArrayLike) -> tuple[Array, tuple[int, ...], np.ndarray]:
    """Rows of lengths, their batch axes, and which of them may be lengths; a single set must be."""
    try:
        wanted = floats(lengths)
    except (TypeError, ValueError):
        raise ArgumentError(f"lengths is {shown(lengths)}; it must hold 6 numbers.") from None
    if wanted.ndim < 2:
        wanted = vectors(wanted, "lengths", 6, ArgumentError)
        if (wanted <= 0).any():
            raise KinematicsError(f"lengths has {wanted.min():.6g} m; every leg length must be > 0 m.")
    if wanted.shape[-1] != 6:
        raise ArgumentError(f"lengths has shape {wanted.shape}; its last axis must hold 6 numbers.")
    rows = wanted.reshape(-1, 6)
    good: np.ndarray = np.all(np.isfinite(rows) & (rows > 0), axis=1)
    return rows, wanted.shape[:-1], good


def _starts(hexapod: Hexapod, rows: Array, shape: tuple[int, ...], good: np.ndarray, start: PoseLike | None) -> Pose:
    """A start for each row: the one given, home, or over the base at a height that the lengths suggest."""
    given = home_pose(hexapod) if start is None else as_pose(start, "start")
    if given is not None:
        vectors(given.position, "start")  # poses that were found may be NaN
    else:
        b, p = hexapod.base_joints, hexapod.platform_joints
        centre = b.mean(axis=0) - p.mean(axis=0)
        offset = np.linalg.norm((p + centre - b)[:, :2], axis=1)
        safe = np.where(good[:, None], rows, 1.0)
        rise = np.sqrt(np.maximum(safe**2 - offset**2, (0.3 * safe) ** 2)).mean(axis=1)
        return Pose(centre + rise[:, None] * np.array([0.0, 0.0, 1.0]))
    try:
        position, matrix = np.broadcast_to(given.position, (*shape, 3)), np.broadcast_to(given.matrix, (*shape, 3, 3))
    except ValueError:
        raise PoseError(f"start has batch axes {given.shape}, which do not fit those of the lengths, {shape}") from None
    return Pose.trusted(position.reshape(-1, 3), matrix.reshape(-1, 3, 3))


def _sides_of_both(hexapod: Hexapod, one: Pose, other: Pose) -> np.ndarray:
    """`sides` of two lists of poses of the same length, (2, n): computed at once, for what a call costs."""
    position, matrix = np.concatenate([one.position, other.position]), np.concatenate([one.matrix, other.matrix])
    return sides(hexapod, Pose.trusted(position, matrix)).reshape(2, -1)


def _all(search: _core.AssemblySearch, rows: Array, threads: int) -> tuple[np.ndarray, Array, Array, np.ndarray]:
    """All assemblies of each row of lengths: the row of each, its numbers, its misfit; whether each row has all."""
    step = _BLOCK * threads
    parts = [search.find(np.ascontiguousarray(rows[k : k + step]), threads) for k in range(0, max(len(rows), 1), step)]
    row = np.concatenate([part[0] + k * step for k, part in enumerate(parts)])
    packed, misfit, complete = (np.concatenate([part[k] for part in parts]) for k in (1, 2, 3))
    return row, packed, misfit, complete


def _nearest(hexapod: Hexapod, rows: Array, starts: Pose, wanted: np.ndarray) -> tuple[np.ndarray, Array, Array]:
    """The nearest of all assemblies on the start's side: the rows that have one, its numbers, and its misfit."""
    row, numbers, misfit, _ = _all(_core.AssemblySearch(hexapod.packed), rows, thread_count(None))
    same = sides(hexapod, _poses(numbers)) * wanted[row] >= 0
    row, numbers, misfit = row[same], numbers[same], misfit[same]
    order = np.lexsort((_distance(hexapod, _poses(numbers), starts[row]), row))
    found, first = np.unique(row[order], return_index=True)
    best = order[first]
    return found, numbers[best], misfit[best]


def _poses(packed: Array) -> Pose:
    """Poses of the core's numbers, which may be NaN; the rotations are made exact."""
    parts = unpack(packed)
    good = np.isfinite(parts["matrix"]).all(axis=(-2, -1), keepdims=True)
    matrix = np.where(good, orthonormal(np.where(good, parts["matrix"], np.eye(3))), np.nan)
    return Pose.trusted(parts["position"], matrix)


def _at_rest(pose: Pose) -> Array:
    """Poses (n,) as the core's numbers of motions."""
    return np.concatenate([pose.packed, np.zeros((len(pose.position), _core.motion_size - _POSE))], axis=1)


def _distance(hexapod: Hexapod, pose: Pose, start: Pose) -> Array:
    """How far poses (n,) are from others, m: a turn counts with the platform's size."""
    cosine = (np.einsum("nij,nij->n", pose.matrix, start.matrix) - 1) / 2
    angle = np.arccos(np.clip(cosine, -1, 1))
    return np.hypot(np.linalg.norm(pose.position - start.position, axis=-1), platform_size(hexapod) * angle)
