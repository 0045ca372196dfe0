"""Natural frequencies and mode shapes about a pose (Eq. 5 of the paper), and the dynamic stability index."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod._suggestions import suggests
from flexapod.checks import not_negative, numbers
from flexapod.conventions import TWO_PI, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import ZERO, PointLike, as_joint, as_point, at_once, pose_or_home
from flexapod.mechanics.point_motion import shift
from flexapod.mechanics.springs import law_states
from flexapod.pose import PoseLike
from flexapod.showing import drawn, in_notebooks

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Words for what modes have.
MODE_WORDS = {
    **dict.fromkeys(("frequencies", "freq", "hz", "f", "frequency_hz"), "frequency (Hz), or omega (rad/s)"),
    **dict.fromkeys(("shapes", "mode_shapes", "vectors", "eigenvectors", "vector"), "shape"),
    **dict.fromkeys(("zeta", "damping", "damping_ratios"), "damping_ratio"),
}


@in_notebooks
@suggests(MODE_WORDS)
class NaturalModes(NamedTuple):
    """The six undamped modes about a pose; unpacks as `omega, shape`.

    Attributes
    ----------
    omega : ndarray
        Natural frequencies, rad/s, (..., 6), ascending.
    shape : ndarray
        Mode shapes, (..., 6, 6): columns are twists of the platform, the translation of the reference point, or of the
        point asked for (rows 1 to 3), and the rotation vector (rows 4 to 6) in inertial axes. They are mass-normalised,
        shape^T J_p shape = 1 at the reference point, so their units are kg^-1/2 and rad kg^-1/2 m^-1.
    """

    omega: Array
    shape: Array

    @property
    def frequency(self) -> Array:
        """Natural frequencies, Hz, (..., 6)."""
        return self.omega / TWO_PI

    @property
    def damping_ratio(self) -> Array:
        """Zeros, (..., 6): these modes are undamped. Those of `flexapod.linearise` have damping."""
        return np.zeros_like(self.omega)

    def plot(
        self, *, ax: Axes | None = None, tangent: ArrayLike | None = None, labels: Sequence[str] | None = None
    ) -> Axes:
        """Draw the six frequencies of one pose, in Hz: `plots.frequencies`, with its options."""
        return drawn(self, ax=ax, tangent=tangent, labels=labels)


def natural_modes(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    point: PointLike = ZERO,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> NaturalModes:
    """Compute the six natural frequencies and mode shapes at a pose, undamped, without preload or gravity.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    point : array_like or str
        Point of the platform whose motion the shapes tell, (3,) m, in its frame, or the name of a point of the design.
        Left out, the reference point.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    NaturalModes
        `omega` (rad/s, (..., 6), ascending), `frequency` (Hz) and `shape` (twists as columns, (..., 6, 6)).

    Raises
    ------
    PoseError
        At a single pose that no leg can take, or outside the range of the design's stiffness law; in a batch such a
        pose gives NaN.
    ArgumentError
        For an unknown joint model.

    See Also
    --------
    flexapod.describe_modes : The modes in words.
    flexapod.linearise : With gravity, preload and damping: `linearise(...).modes()`.

    Notes
    -----
    Eq. 5 of the paper. The frequencies are singular values of L^-1 F with J_p = L L^T and the stiffness F F^T of all
    springs at the platform (H K^1/2 of the legs, and columns of joints and suspension, taken as unstressed at the
    pose), which keeps the low ones accurate near a singular pose; at one, the lowest is zero to rounding.

    Examples
    --------
    >>> modes = fx.natural_modes(fx.load("motion-base"))
    >>> modes.frequency.round(2).tolist()  # Hz
    [4.46, 4.48, 8.84, 14.97, 15.88, 17.28]
    """
    found = at_once("natural_modes", hexapod, pose, base, joint) if point is ZERO else None
    if found is not None:
        return NaturalModes(*found)
    s = law_states(hexapod, pose, base)
    omega, shape = _core.natural_modes(hexapod.packed, as_joint(joint), s.platform, s.base)
    shape = shape.reshape(*s.shape, 6, 6)
    place = as_point(hexapod, point)
    if place.any():
        shape = shift(pose_or_home(hexapod, pose), place) @ shape
    return NaturalModes(omega.reshape(*s.shape, 6), shape)


def stability_index(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> Array | float:
    """Compute the dynamic stability index, the lowest natural frequency.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    float or ndarray
        The lowest natural frequency, rad/s, (...); zero at a singular pose.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For an unknown joint model.

    See Also
    --------
    flexapod.worst_pose : Where in a region it is least.

    Notes
    -----
    Section 2 of the paper.

    Examples
    --------
    >>> round(float(fx.stability_index(fx.load("motion-base"))), 2)
    28.05
    """
    return natural_modes(hexapod, pose, base=base, joint=joint).omega[..., 0][()]


def near_repeated(omega: Array, gap: float = 0.01) -> list[tuple[int, int]]:
    """List neighbouring modes of nearly the same frequency.

    Parameters
    ----------
    omega : array_like
        Natural frequencies, rad/s, (6,), ascending.
    gap : float
        Frequencies are nearly the same if they differ by less than this part of the higher one.

    Returns
    -------
    list of tuple of int
        Pairs of modes, numbered from 0.

    Notes
    -----
    Modes that share a frequency have no shapes of their own: any mixture of them is a mode as well.

    Examples
    --------
    >>> fx.mechanics.near_repeated([10.0, 10.05, 20.0, 30.0, 40.0, 50.0])
    [(0, 1)]
    """
    omega = numbers(omega, "omega", (6,))
    gap = not_negative(gap, "gap")
    return [(i, i + 1) for i in range(5) if omega[i + 1] - omega[i] < gap * omega[i + 1]]


def mode_clusters(omega: Array) -> list[list[int]]:
    """The modes, numbered from 0, with near-repeated ones together: [[0, 1], [2], [3, 4, 5]]."""
    joined = set(near_repeated(omega))
    clusters = [[0]]
    for i in range(5):
        if (i, i + 1) in joined:
            clusters[-1].append(i + 1)
        else:
            clusters.append([i + 1])
    return clusters


def advised_sampling_time(omega_max: float) -> float:
    """Largest sensible sampling time of a controller, s: a twentieth of a period of the fastest mode (conclusion 3)."""
    return float(TWO_PI / (20 * omega_max))
