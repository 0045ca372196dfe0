"""The dynamic stability index along a trajectory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.checks import one_of, positive, whole
from flexapod.conventions import TRANSLATIONS, Array, JointModel, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError, PoseError, SingularPoseError
from flexapod.mechanics.inputs import as_hexapod
from flexapod.mechanics.joint_limits import check_limits
from flexapod.mechanics.kinematics import condition_number, force_transformation
from flexapod.mechanics.modes import natural_modes
from flexapod.paths.trajectory import Trajectory
from flexapod.pose import Pose
from flexapod.showing import drawn, in_notebooks

if TYPE_CHECKING:
    from matplotlib.figure import Figure, SubFigure

_ZERO_INDEX = 1e-6  # of the largest index on the path: what a singular pose leaves of the lowest frequency
_MOST_SAMPLES = 10**6  # instants of a path: a gigabyte
_CUTS, _ROUNDS = 16, 11  # a minimum is bracketed by 2/16 of its bracket, 11 times: to 1e-10 of a sample's distance


@in_notebooks
@dataclass(frozen=True, eq=False)
class PathIndex:
    """The dynamic stability index along a trajectory, as `path_index` gives it.

    Attributes
    ----------
    samples : xarray.Dataset
        Over `time` (s): index (rad/s), condition_number, within_limits (bool), weight, cumulative_index (integral of
        weight times index from the start, rad), position (time, axis) (m) and rpy (time, axis) (rad).
    minimum : float
        Least index, rad/s, refined between samples.
    minimum_time : float
        Its time, s.
    minimum_pose : Pose
        Its pose.
    bound : float or None
        The bound given, rad/s.
    below : tuple of (float, float)
        Start and end times, s, between which the index lies below the bound.
    weighted_mean : float
        Mean index, rad/s, weighted by the trajectory's weights.
    crossings : tuple of float
        Times, s, at which the trajectory passes through a singular pose; only with ``singular="keep"``.

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i")
    >>> found = fx.path_index(hexapod, fx.Trajectory([[0, 0, 0.89, 0, 0, 0], [0.1, 0, 0.89, 0, 0, 0]], [0, 1]))
    >>> found.samples["index"].dims, found.below
    (('time',), ())
    """

    samples: xr.Dataset
    minimum: float
    minimum_time: float
    minimum_pose: Pose
    bound: float | None
    below: tuple[tuple[float, float], ...]
    weighted_mean: float
    crossings: tuple[float, ...]

    @property
    def above(self) -> bool:
        """Say whether the index stays at or above the bound all along."""
        return not self.below and not self.crossings

    def plot(self, beside: PathIndex | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
        """Draw the index along the path: `plots.path.index_along`, with its options."""
        return drawn(self, beside=beside, figure=figure)


def path_index(
    hexapod: Hexapod,
    path: Trajectory,
    *,
    bound: float | None = None,
    samples: int = 400,
    joint: JointModel = "universal",
    singular: str = "raise",
) -> PathIndex:
    """Compute the lowest natural frequency along a trajectory, and where it falls below a bound.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    path : Trajectory
        The motion of the platform; its speed does not matter here.
    bound : float, optional
        Bound on the index, rad/s.
    samples : int, optional
        Number of instants at which the index is computed, at least 8. Its minima and its crossings of the bound are
        refined between them.
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.
    singular : {"raise", "keep"}, optional
        Whether a singular pose on the way is an error, or recorded in `crossings`.

    Returns
    -------
    PathIndex
        The index over time, its minimum, where it lies below the bound, and its weighted mean.

    Raises
    ------
    SingularPoseError
        If the trajectory passes through a singular pose.
    PoseError
        If the legs cannot take a pose of the trajectory.
    ArgumentError
        If the bound is not > 0, there are too few or too many samples, or `path` is not a Trajectory.

    See Also
    --------
    path_loads : leg forces and speeds along a trajectory.
    plan_path : a trajectory that keeps a bound.

    Notes
    -----
    The index and its use as a bound for paths are those of [1]_, conclusion 1. The weights of the trajectory are joined
    by straight lines in time; the weighted mean is the integral of weight times index over that of the weight, by
    Simpson's rule over the samples. Where the index has a kink between samples (two modes cross), that costs the mean
    some 1e-4 of its value with the default samples; more samples lower it with their square.

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration (2007).

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i")
    >>> path = fx.Trajectory([[0, 0, 0.89, 0, 0, 0], [0.1, 0, 0.89, 0, 0, 0]], times=[0.0, 1.0])
    >>> found = fx.path_index(hexapod, path, bound=90.0)
    >>> found.above, round(found.minimum, 1)
    (True, 173.1)
    """
    check_arguments(hexapod, path, samples)
    if bound is not None:
        positive(bound, "bound", "rad/s")
    one_of(singular, "singular", ("raise", "keep"))
    times = path.grid(samples)

    def index(t: ArrayLike) -> Array:
        return natural_modes(hexapod, path(np.atleast_1d(t)).pose, joint=joint).omega[:, 0]

    values = index(times)
    _all_possible(path, times, values)
    crossings = singular_times(hexapod, path, times)
    low_points = dips(index, times, values)
    least_time, least = min([*low_points, *zip(times, values, strict=True)], key=lambda point: point[1])
    if least < _ZERO_INDEX * values.max() and not crossings:
        crossings = (float(least_time),)  # touched, not crossed
    if crossings:
        least_time, least = crossings[0], 0.0
    if crossings and singular == "raise":
        raise SingularPoseError(
            f"the path passes through a singular pose at t = {crossings[0]:.6g} s, {path(crossings[0]).pose!r}; the "
            "legs cannot hold the platform there. Lead the path round it (plan_path, on "
            "the command line --from and --to)."
        )
    all_times = np.unique(np.concatenate([times, [t for t, _ in low_points], crossings]))
    dataset = _samples(hexapod, path, all_times, index(all_times), joint)
    mean = float(dataset["cumulative_index"][-1] / np.trapezoid(path.weights, path.times))
    below = () if bound is None else _below(index, all_times, dataset["index"].values, bound)
    return PathIndex(
        dataset, float(least), float(least_time), path(least_time).pose, bound, below, mean, tuple(crossings)
    )


def check_arguments(hexapod: Hexapod, path: Trajectory, samples: int) -> None:
    """Raises DesignError or ArgumentError for what is no design, no trajectory, or a wrong number of samples."""
    as_hexapod(hexapod)
    if not isinstance(path, Trajectory):
        raise ArgumentError(f"path is {type(path).__name__}; it must be a flexapod Trajectory.")
    if whole(samples, "samples", 8) > _MOST_SAMPLES:
        raise ArgumentError(f"samples is {samples}; at most {_MOST_SAMPLES} are computed. Ask for fewer.")


def _all_possible(path: Trajectory, times: Array, values: Array) -> None:
    lost = np.flatnonzero(~np.isfinite(values))
    if lost.size:
        t = times[lost[0]]
        raise PoseError(f"no leg can take the pose at t = {t:.6g} s of the path, {path(t).pose!r}. Move the waypoints.")


def singular_times(hexapod: Hexapod, path: Trajectory, times: Array) -> tuple[float, ...]:
    """Times at which det H changes sign: a path from one side to the other passes through a singular pose."""

    def side(t: ArrayLike) -> Array:
        sign, logarithm = np.linalg.slogdet(force_transformation(hexapod, path(np.atleast_1d(t)).pose))
        return sign * np.exp(np.clip(logarithm, -600, 600))

    signs = np.sign(side(times))
    changed = np.flatnonzero(signs[:-1] * signs[1:] <= 0)
    if not changed.size:
        return ()
    from scipy.optimize import brentq  # slow to load, and few paths need it

    roots = [brentq(lambda t: side(t)[0], times[i], times[i + 1], xtol=1e-12 * path.duration) for i in changed]
    return tuple(np.unique(roots).tolist())


def dips(value: Callable[[ArrayLike], Array], times: Array, values: Array) -> list[tuple[float, float]]:
    """Every local minimum of the samples, refined between its neighbours: (time, value)."""
    inner = np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:])) + 1
    if not inner.size:
        return []
    low, high = times[inner - 1], times[inner + 1]
    each = np.arange(inner.size)
    for _ in range(_ROUNDS):  # all at once: the evaluations of one would wait for one another
        t = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _CUTS + 1)
        found = value(t.ravel()).reshape(t.shape)
        least = found.argmin(axis=1)
        low, high = t[each, np.maximum(least - 1, 0)], t[each, np.minimum(least + 1, _CUTS)]
    return list(zip(t[each, least].tolist(), found[each, least].tolist(), strict=True))


def _below(
    index: Callable[[ArrayLike], Array], times: Array, values: Array, bound: float
) -> tuple[tuple[float, float], ...]:
    low = values < bound
    edges = np.flatnonzero(low[:-1] != low[1:])
    roots: list[float] = []
    if edges.size:
        from scipy.optimize import brentq

        roots = [float(brentq(lambda t: index(t)[0] - bound, times[i], times[i + 1])) for i in edges]
    starts = ([float(times[0])] if low[0] else []) + [r for r, i in zip(roots, edges, strict=True) if not low[i]]
    ends = [r for r, i in zip(roots, edges, strict=True) if low[i]] + ([float(times[-1])] if low[-1] else [])
    return tuple(zip(starts, ends, strict=True))


def _samples(hexapod: Hexapod, path: Trajectory, times: Array, values: Array, joint: JointModel) -> xr.Dataset:
    from scipy.integrate import cumulative_simpson

    pose = path(times).pose
    weight = np.interp(times, path.times, path.weights)
    cumulative = cumulative_simpson(weight * values, x=times, initial=0.0)
    variables: dict[str, Any] = {
        "index": ("time", values, in_unit("rad/s", "dynamic stability index")),
        "condition_number": ("time", condition_number(hexapod, pose), in_unit("1", "condition number of H (metres)")),
        "within_limits": ("time", check_limits(hexapod, pose, joint=joint).ok),
        "weight": ("time", weight, in_unit("1")),
        "cumulative_index": ("time", cumulative, in_unit("rad", "integral of weight times index")),
        "position": (("time", "axis"), pose.position, in_unit("m")),
        "rpy": (("time", "axis"), pose.rpy, in_unit("rad")),
    }
    coordinates = {"time": ("time", times, in_unit("s")), "axis": list(TRANSLATIONS)}
    return xr.Dataset(variables, coordinates, {**origin(hexapod), "joint": joint})
