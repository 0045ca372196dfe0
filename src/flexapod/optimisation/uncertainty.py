"""Robustness: the stability index of designs whose stiffness, mass or payload is uncertain."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod import _core
from flexapod.checks import thread_count, whole
from flexapod.conventions import Array, JointModel, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import HOME
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError
from flexapod.mechanics.inputs import as_joint
from flexapod.mechanics.joint_limits import check_limits
from flexapod.optimisation.ensemble import Ensemble
from flexapod.optimisation.payload_range import Payload
from flexapod.optimisation.uncertain_parameters import Uncertain, UncertainRange
from flexapod.optimisation.worst_case import worst_case
from flexapod.optional import needed
from flexapod.pose import Pose
from flexapod.progress import ProgressLike, with_progress
from flexapod.showing import drawn, in_notebooks
from flexapod.workspace.limit_margins import none_within
from flexapod.workspace.region import RegionLike, as_region, home_of
from flexapod.workspace.sobol import Sobol

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

Progress = Callable[[float], object]
_BLOCK = 2**20  # designs times poses computed at once
_ROUNDING = 1e-12  # of an index: designs that differ less do not differ
_QUANTILES = (0.001, 0.01, 0.05, 0.5, 0.95, 0.99)


@in_notebooks
@dataclass(frozen=True, eq=False)
class Robustness:
    """Distribution and worst case of the stability index, as `flexapod.robustness` found them.

    Attributes
    ----------
    samples : xarray.Dataset
        Over ``sample``: ``index``, rad/s, and every parameter, in the unit of its key.
    ranges : dict of str to UncertainRange
        What was assumed of each parameter, by name.
    nominal : float
        Index of the design as it is, rad/s.
    mean, deviation : float
        Mean and standard deviation of the index, rad/s.
    quantiles : dict of float to float
        Index, rad/s, by the share of samples below it.
    worst : float
        Smallest index that was found over the ranges of the parameters, rad/s.
    worst_at : dict of str to float
        The parameters there, in the units of their keys (the payload: kg, m).
    searches, agreed : int
        Number of searches for it, and how many of them ended at this index.
    sensitivity : xarray.Dataset or None
        Over ``parameter``: the Sobol indices ``first`` and ``total``, shares of the variance of the index, and their
        95 % confidence half-widths ``first_confidence`` and ``total_confidence``.
    """

    samples: xr.Dataset
    ranges: dict[str, UncertainRange]
    nominal: float
    mean: float
    deviation: float
    quantiles: dict[float, float]
    worst: float
    worst_at: dict[str, float]
    searches: int
    agreed: int
    sensitivity: xr.Dataset | None

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw how the index is distributed: `plots.optimisation.spread`."""
        return drawn(self, ax=ax)


@with_progress("robustness")
def robustness(
    hexapod: Hexapod,
    uncertain: Sequence[Uncertain | Payload],
    region: RegionLike = None,
    *,
    samples: int = 2**14,
    pose_samples: int = 256,
    sensitivity: int = 0,
    all_poses: bool = False,
    joint: JointModel = "universal",
    seed: int = 0,
    threads: int | None = None,
    progress: ProgressLike = None,
) -> Robustness:
    """Find the distribution and the worst case of the stability index of an uncertain design.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    uncertain : sequence of Uncertain and Payload
        What is uncertain; all independent of one another.
    region : Pose, array_like of shape (n, 6), Box, Workspace, PoseSet or Trajectory, optional
        Where the index counts: the index of a sample is the smallest over it. Numbers are x, y, z in m, roll, pitch,
        yaw in rad. The home pose by default.
    samples : int, optional
        Number of designs drawn, from a scrambled Sobol sequence.
    pose_samples : int, optional
        Number of poses of a box or a workspace.
    sensitivity : int, optional
        Number of base samples of a sensitivity analysis, a power of two such as 1024; it takes
        sensitivity * (parameters + 2) designs more. None is made by default.
    all_poses : bool, optional
        If True, poses beyond the limits of `hexapod` count as well.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.
    seed : int, optional
        Seed of the samples.
    threads : int, optional
        Number of threads. All cores by default.
    progress : callable or False, optional
        Called with the share done, from 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

    Returns
    -------
    Robustness
        The distribution, the worst case, and the sensitivities.

    Raises
    ------
    ArgumentError
        If a range is one that a design cannot have, or another argument is invalid.
    DesignError
        If `hexapod` is not a Hexapod.
    MissingExtraError
        If SALib is needed and not installed.
    PoseError
        If the region is invalid, or none of its poses is within the limits.

    Notes
    -----
    The poses are the same for all designs: those within the limits of `hexapod` itself, as given, unless `all_poses` is
    set. The frequencies of all designs are exact, and computed many at a time. For the worst case, all corners of the
    ranges are computed where there are up to ten parameters; with more, one end after another is exchanged from many
    corners. Pattern searches from the lowest corners and samples, apart from one another, follow. The sensitivities are
    Sobol indices [1]_, estimated after Saltelli [2]_.

    References
    ----------
    .. [1] I. M. Sobol, Global sensitivity indices for nonlinear mathematical models and their Monte Carlo estimates,
       Mathematics and Computers in Simulation 55 (2001).
    .. [2] A. Saltelli, Making best use of model evaluations to compute sensitivity indices, Computer Physics
       Communications 145 (2002).

    Examples
    --------
    >>> oil = fx.Uncertain("legs.stiffness_law.bulk_modulus", 0.2, each=False)
    >>> found = fx.robustness(fx.load("motion-base"), oil, samples=64)
    >>> round(found.worst / found.nominal, 4) == round(0.8**0.5, 4)
    True
    """
    ensemble = Ensemble(hexapod, uncertain)
    whole(samples, "samples", 2)
    whole(seed, "seed", 0)
    if whole(sensitivity, "sensitivity", 0) and (sensitivity < 16 or sensitivity & (sensitivity - 1)):
        raise ArgumentError(f"sensitivity is {sensitivity}; it must be a power of two, at least 16, such as 1024.")
    where = as_region(region)
    rows = where.rows(home_of(hexapod, where), whole(pose_samples, "pose_samples"))
    of, rows = len(rows), rows if all_poses else _within_limits(hexapod, rows, joint)
    index = _Index(ensemble, rows, joint, threads)
    nominal = index.nominal(hexapod.name)
    u = Sobol(len(ensemble.names), seed).points(0, samples)
    share = samples / (samples + sensitivity * (len(ensemble.names) + 2))
    values = index(u, (lambda done: progress(share * done)) if progress else None)
    worst = worst_case(index, u, values, seed)
    analysis = None
    if sensitivity:
        rest = (lambda done: progress(share + (1 - share) * done)) if progress else None
        analysis = _sensitivity(ensemble, index, sensitivity, seed, rest).assign_attrs(origin(hexapod))
    return Robustness(
        samples=_samples(
            ensemble,
            u,
            values,
            hexapod,
            {"joint": joint, "poses": len(rows), "poses_beyond_limits": of - len(rows), "seed": seed},
        ),
        ranges=ensemble.ranges(),
        nominal=nominal,
        mean=float(values.mean()),
        deviation=float(values.std(ddof=1)),
        quantiles={q: float(np.quantile(values, q)) for q in _QUANTILES},
        worst=worst.index,
        worst_at={name: float(ensemble.told(k, worst.at[k : k + 1])[0]) for k, name in enumerate(ensemble.names)},
        searches=worst.searches,
        agreed=worst.agreed,
        sensitivity=analysis,
    )


def _within_limits(hexapod: Hexapod, rows: Array, joint: JointModel) -> Array:
    """The poses that the design's own limits allow. Raises PoseError where they allow none."""
    if not hexapod.limits.given:
        return rows
    kept = np.atleast_1d(check_limits(hexapod, Pose.from_rpy(*rows.T), joint=joint).ok)
    if not kept.any():
        raise none_within(len(rows))
    return rows[kept]


class _Index:
    """The least index over poses, for designs at points of the unit cube."""

    def __init__(self, ensemble: Ensemble, rows: Array, joint: JointModel, threads: int | None) -> None:
        self.ensemble, self.joint, self.threads = ensemble, as_joint(joint), thread_count(threads)
        self.poses = Pose.from_rpy(*rows.T).packed

    def nominal(self, name: str) -> float:
        found = float(self.of(self.ensemble.base[None, : HOME.start])[0])
        if found <= 0:
            raise ArgumentError(f"the index of {name!r} itself is zero at these poses; choose some that it can hold.")
        return found

    def of(self, designs: Array) -> Array:
        omega = _core.sweep_designs(np.ascontiguousarray(designs), self.joint, self.poses, False, 1, self.threads)
        return np.nan_to_num(omega[:, :, 0]).min(axis=1)

    def __call__(self, u: Array, progress: Progress | None = None) -> Array:
        size = max(64, _BLOCK // len(self.poses))
        found = np.empty(len(u))
        for first in range(0, len(u), size):
            part = slice(first, first + size)
            found[part] = self.of(self.ensemble.designs(u[part]))
            if progress is not None:
                progress(min(1.0, (first + size) / len(u)))
        return found


def moves(values: Array) -> bool:
    """Whether values of many designs differ by more than rounding."""
    return float(np.std(values)) > _ROUNDING * float(np.abs(values).max())


def _sensitivity(ensemble: Ensemble, index: _Index, base: int, seed: int, progress: Progress | None) -> xr.Dataset:
    """First-order and total Sobol indices with 95 % confidence half-widths."""
    import xarray as xr

    why = "the sensitivity analysis needs SALib; without it, leave sensitivity out"
    sample, analyse = (needed(f"SALib.{part}.sobol", "optimise", why) for part in ("sample", "analyze"))
    p = len(ensemble.names)
    problem = {"num_vars": p, "names": list(ensemble.names), "bounds": [[0.0, 1.0]] * p}
    u = sample.sample(problem, base, calc_second_order=False, seed=seed)
    found = index(u, progress)
    if moves(found):  # SALib takes a seed of 0 for none
        scaled = (found - found.mean()) / found.std()
        result = analyse.analyze(problem, scaled, calc_second_order=False, seed=seed + 1)
    else:
        result = dict.fromkeys(("S1", "ST", "S1_conf", "ST_conf"), np.zeros(p))
    axis = ("parameter",)
    return xr.Dataset(
        {
            "first": (axis, result["S1"], in_unit("1", "share of the variance of the index")),
            "total": (axis, result["ST"], in_unit("1", "share with interactions")),
            "first_confidence": (axis, result["S1_conf"], in_unit("1")),
            "total_confidence": (axis, result["ST_conf"], in_unit("1")),
        },
        {"parameter": list(ensemble.names)},
        {"designs": len(u)},
    )


def _samples(ensemble: Ensemble, u: Array, values: Array, hexapod: Hexapod, about: dict[str, Any]) -> xr.Dataset:
    import xarray as xr

    data: dict[str, Any] = {name: ("sample", ensemble.told(k, u[:, k])) for k, name in enumerate(ensemble.names)}
    data["index"] = ("sample", values, in_unit("rad/s", "dynamic stability index"))
    return xr.Dataset(data, attrs={**origin(hexapod), **about})
