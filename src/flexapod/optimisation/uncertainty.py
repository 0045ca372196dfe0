"""Robustness: how far the stability index strays when stiffness, mass or payload are not what the design says.

Thousands of designs are drawn and their frequencies found by the compiled kernel, many designs at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import thread_count
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import HOME, PLACES, entries, numbers
from flexapod.errors import ArgumentError
from flexapod.mechanics.inputs import as_joint
from flexapod.optional import needed
from flexapod.pose import Pose
from flexapod.workspace.box_minimum import pattern_minimum
from flexapod.workspace.region import Region, RegionLike, as_region
from flexapod.workspace.sobol import Sobol

if TYPE_CHECKING:
    import xarray as xr

Distribution = Literal["uniform", "normal", "triangular", "lognormal"]
_BLOCK = 2**20  # designs times poses computed at once
_STARTS = 8  # worst samples from which the worst case is searched
_QUANTILES = (0.001, 0.01, 0.05, 0.5, 0.95, 0.99)


@dataclass(frozen=True)
class Uncertain:
    """A number of the design (or several that stray together) that is only known to lie about its value.

    target: a key as for `Variable`. spread: half the width of a uniform or triangular distribution, the standard
    deviation of a normal or lognormal one. distribution: which of these. relative: the spread is a share of the
    design's value, else an amount in the key's unit. each: with several entries, such as legs.stiffness, each strays on
    its own, else all together.

    Source: own.
    """

    target: str
    spread: float
    distribution: Distribution = "uniform"
    relative: bool = True
    each: bool = True

    def parameters(self, hexapod: Hexapod) -> list[Stray]:
        """One for each number that strays on its own.

        Raises: ArgumentError for ranges that a design cannot have.
        """
        _check(self.target, self.spread, self.distribution)
        index, rule, unit = entries(self.target)
        if self.target.startswith("home"):
            raise ArgumentError("the home pose is where the machine is told to stand, not a number that strays.")
        value = numbers(hexapod)[index]
        if self.relative and not value.any():
            raise ArgumentError(
                f"{self.target} is zero, so a share of it is nothing. Give relative=False and an amount."
            )
        width = self.spread * np.abs(value) if self.relative else np.full(len(index), self.spread * unit)
        sets = [[k] for k in range(len(index))] if self.each else [list(range(len(index)))]
        found = []
        for chosen in sets:
            name = self.target if len(sets) == 1 else f"{self.target}[{chosen[0]}]"
            low = (value - width * _reach(self.distribution))[chosen].min()
            if rule.least is not None and (low < rule.least or (rule.open_ and low <= rule.least)):
                raise ArgumentError(
                    f"{name} may stray down to {low / unit:.6g}; {rule.meaning} must be "
                    f"{'>' if rule.open_ else '>='} {rule.least:.6g}. Lessen the spread, or take another distribution."
                )
            found.append(Stray(name, self.distribution, index[chosen], width[chosen], self.spread))
        return found


@dataclass(frozen=True)
class Payload:
    """A load on the platform beyond what the design has: a point mass (kg) at a position (m, platform frame).

    mass: (least, most); position: three pairs (least, most), or numbers where it is known. All uniform.

    Source: own.
    """

    mass: tuple[float, float]
    position: tuple[ArrayLike, ArrayLike, ArrayLike] = (0.0, 0.0, 0.0)

    def parameters(self, hexapod: Hexapod) -> list[Stray]:
        """The payload's mass and its three coordinates.

        Raises: ArgumentError for a mass below zero, or ranges that do not ascend.
        """
        low, high = self.mass
        if not 0 <= low <= high < np.inf:
            raise ArgumentError(f"the payload's mass is from {low} to {high} kg; it must be >= 0, the least first.")
        found = [Stray("payload.mass", "uniform", None, np.array([low, high]), 0.0)]
        for axis, given in zip("xyz", self.position, strict=True):
            pair = np.broadcast_to(np.asarray(given, dtype=np.float64), 2)
            if not (np.isfinite(pair).all() and pair[0] <= pair[1]):
                raise ArgumentError(f"the payload's {axis} is {given!r} m; it must be a number, or (least, most).")
            found.append(Stray(f"payload.{axis}", "uniform", None, np.array(pair), 0.0))
        return found


@dataclass(frozen=True)
class Stray:
    """One uncertain parameter: entries of the design and the width of each, or (index None) a range of the payload."""

    name: str
    distribution: Distribution
    index: Any
    width: Array
    spread: float

    @property
    def fixed(self) -> bool:
        return self.index is None and self.width[0] == self.width[1]


def _check(name: str, spread: float, distribution: str) -> None:
    if not (np.isfinite(spread) and spread > 0):
        raise ArgumentError(f"{name}: the spread is {spread}; it must be > 0.")
    if distribution not in ("uniform", "normal", "triangular", "lognormal"):
        raise ArgumentError(
            f"{name}: the distribution is {distribution!r}; it must be uniform, normal, triangular or lognormal."
        )
    if distribution == "lognormal" and spread > 2:
        raise ArgumentError(f"{name}: a lognormal spread of {spread} is of the logarithm; it must be at most 2.")


def _reach(distribution: str) -> float:
    """How many spreads below its value a number may come; a normal one is cut off at four."""
    return {"uniform": 1.0, "triangular": 1.0, "normal": 4.0, "lognormal": 0.0}[distribution]


@dataclass(frozen=True, eq=False)
class Robustness:
    """How the index strays; see `robustness`.

    samples: Dataset over `sample`: `index` (rad/s) and each parameter. nominal: index of the design as it is; mean,
    deviation: of the samples, rad/s; quantiles: {share: index}. worst: least index over the ranges of the parameters,
    found from the worst samples downhill (normal ones are taken to four standard deviations); worst_at: the parameters
    there. sensitivity: Dataset over `parameter` of Sobol indices, or None.

    Source: A. Saltelli (2002) for the indices.
    """

    samples: xr.Dataset
    nominal: float
    mean: float
    deviation: float
    quantiles: dict[float, float]
    worst: float
    worst_at: dict[str, float]
    sensitivity: xr.Dataset | None


class Ensemble:
    """Designs that stray from one, as functions of parameters in the unit cube."""

    def __init__(self, hexapod: Hexapod, uncertain: Sequence[Uncertain | Payload]) -> None:
        uncertain = [uncertain] if isinstance(uncertain, Uncertain | Payload) else uncertain
        wrong = [u for u in uncertain if not isinstance(u, Uncertain | Payload)]
        if wrong or not uncertain:
            raise ArgumentError(
                f"uncertain {f'holds {wrong[0]!r}' if wrong else 'is empty'}; give Uncertain or Payload."
            )
        self.hexapod = hexapod
        self.base = numbers(hexapod)[: HOME.start]
        every = [p for u in uncertain for p in u.parameters(hexapod)]
        self.payload = [p for p in every if p.index is None]
        self.parameters = [p for p in every if not p.fixed]
        names = [p.name for p in self.parameters]
        if len(set(names)) < len(names) or len(self.payload) > 4:
            double = next((n for n in names if names.count(n) > 1), "the payload")
            raise ArgumentError(f"{double} is given twice. Leave one of them out.")
        if not names:
            raise ArgumentError("nothing strays: every range is one number.")
        self.names = names

    def designs(self, u: Array) -> Array:
        """(s, n) for points u (s, p) of the unit cube."""
        found = np.tile(self.base, (len(u), 1))
        load = {p.name: np.full(len(u), p.width[0]) for p in self.payload}
        for k, p in enumerate(self.parameters):
            if p.index is None:
                load[p.name] = self.value(k, u[:, k])
            else:
                away = _quantile(p.distribution, u[:, k], p.spread)
                if p.distribution == "lognormal":
                    found[:, p.index] = self.base[p.index] * away[:, None]
                else:
                    found[:, p.index] += away[:, None] * p.width
        if load:
            _load(found, load["payload.mass"], np.stack([load[f"payload.{axis}"] for axis in "xyz"], axis=1))
        return found

    def value(self, k: int, u: Array) -> Array:
        """What parameter k is at u, SI: the number itself (the first of several that stray together)."""
        p = self.parameters[k]
        if p.index is None:
            return p.width[0] + (p.width[1] - p.width[0]) * u
        away, own = _quantile(p.distribution, u, p.spread), self.base[p.index[0]]
        return own * away if p.distribution == "lognormal" else own + away * p.width[0]


def _quantile(distribution: str, u: Array, spread: float) -> Array:
    """The distribution of unit spread about 0 (lognormal: of the factor about 1), cut off where it has no end."""
    if distribution == "uniform":
        return 2 * u - 1
    if distribution == "triangular":
        return np.where(u < 0.5, np.sqrt(2 * u) - 1, 1 - np.sqrt(np.maximum(2 * (1 - u), 0.0)))
    from scipy.special import ndtr, ndtri

    cut = ndtr(-4.0)
    normal = np.asarray(ndtri(cut + u * (1 - 2 * cut)))
    return np.exp(spread * normal) if distribution == "lognormal" else normal


def _load(designs: Array, mass: Array, at: Array) -> None:
    """Adds a point mass to the platform: mass, mass centre, and inertia about the new mass centre."""
    M, R = designs[:, PLACES["platform.mass"]].copy(), designs[:, PLACES["platform.mass_center"]].copy()
    total = M + mass
    designs[:, PLACES["platform.mass"]] = total
    designs[:, PLACES["platform.mass_center"]] = (M[:, None] * R + mass[:, None] * at) / total[:, None]
    d = at - R
    reduced = M * mass / total  # two point masses about their common centre
    inertia, (i, j) = PLACES["platform.inertia"], np.triu_indices(3, 1)
    designs[:, inertia.diagonal()] += reduced[:, None] * ((d**2).sum(axis=1, keepdims=True) - d**2)
    designs[:, inertia[i, j]] -= reduced[:, None] * d[:, i] * d[:, j]


def robustness(
    hexapod: Hexapod,
    uncertain: Sequence[Uncertain | Payload],
    over: RegionLike = None,
    *,
    samples: int = 2**14,
    poses: int = 256,
    sensitivity: int = 0,
    **options: Any,
) -> Robustness:
    """Distribution and worst case of the stability index (rad/s) when parts of the design are uncertain.

    uncertain: `Uncertain` and `Payload`, independent of one another. over: a pose (default: home), poses, or a box or
    `Workspace`, of which `poses` poses are looked at; the index of a sample is the least over them. samples: designs
    drawn (a scrambled Sobol sequence). sensitivity: base samples of a Sobol analysis (SALib), a power of two such as
    1024, which takes sensitivity * (parameters + 2) designs more; 0: none. Options: joint, seed=0, threads, progress
    (called with a stage and its share done).

    Raises: ArgumentError for ranges that a design cannot have; MissingExtraError where SALib is missing; PoseError for
    what names no poses.
    Source: own; I. M. Sobol (2001) and A. Saltelli (2002) for the sensitivity.
    """
    settings = _Settings(**options)
    ensemble = Ensemble(hexapod, uncertain)
    if samples < 2:
        raise ArgumentError(f"samples is {samples}; at least 2 designs must be drawn.")
    rows = _rows(hexapod, as_region(over), poses)
    index = _Index(ensemble, rows, settings)
    nominal = index.nominal(hexapod.name)
    u = Sobol(len(ensemble.names), settings.seed).points(0, samples)
    values = index(u, "samples")
    # The index is monotonic in stiffness and, mostly, in mass: the worst case is then a corner of the ranges.
    worst, worst_u = pattern_minimum(index, u[np.argsort(values)[:_STARTS]])
    return Robustness(
        samples=_samples(ensemble, u, values, hexapod, {"joint": settings.joint, "poses": len(rows)}),
        nominal=nominal,
        mean=float(values.mean()),
        deviation=float(values.std(ddof=1)),
        quantiles={q: float(np.quantile(values, q)) for q in _QUANTILES},
        worst=worst,
        worst_at={name: float(ensemble.value(k, worst_u[k : k + 1])[0]) for k, name in enumerate(ensemble.names)},
        sensitivity=_sobol(ensemble, index, sensitivity, settings.seed) if sensitivity else None,
    )


def _rows(hexapod: Hexapod, where: Region, poses: int) -> Array:
    if where.from_home and hexapod.home is None:
        raise ArgumentError(f"{hexapod.name!r} names no home pose. Give a pose or a box.")
    return where.rows(numbers(hexapod)[HOME], poses)


@dataclass(frozen=True)
class _Settings:
    joint: JointModel = "universal"
    seed: int = 0
    threads: int | None = None
    progress: Callable[[str, float], None] | None = None


class _Index:
    """The least index over poses, for designs at points of the unit cube."""

    def __init__(self, ensemble: Ensemble, rows: Array, settings: _Settings) -> None:
        self.ensemble, self.progress = ensemble, settings.progress
        self.joint, self.threads = as_joint(settings.joint), thread_count(settings.threads)
        pose = Pose.from_rpy(*rows.T)
        self.poses = pose.packed

    def nominal(self, name: str) -> float:
        found = float(self.of(self.ensemble.base[None])[0])
        if found <= 0:
            raise ArgumentError(f"the index of {name!r} itself is zero at these poses; choose some that it can hold.")
        return found

    def of(self, designs: Array) -> Array:
        omega = _core.sweep_designs(np.ascontiguousarray(designs), self.joint, self.poses, False, 1, self.threads)
        return np.nan_to_num(omega[:, :, 0]).min(axis=1)

    def __call__(self, u: Array, stage: str = "") -> Array:
        size = max(64, _BLOCK // len(self.poses))
        found = np.empty(len(u))
        for first in range(0, len(u), size):
            part = slice(first, first + size)
            found[part] = self.of(self.ensemble.designs(u[part]))
            if self.progress is not None and stage:
                self.progress(stage, min(1.0, (first + size) / len(u)))
        return found


def _sobol(ensemble: Ensemble, index: _Index, base: int, seed: int) -> xr.Dataset:
    """First-order and total Sobol indices with 95 % confidence half-widths."""
    import xarray as xr

    why = "the sensitivity analysis needs SALib; without it, leave sensitivity out"
    sample, analyse = (needed(f"SALib.{part}.sobol", "optimise", why) for part in ("sample", "analyze"))
    if base < 16 or base & (base - 1):
        raise ArgumentError(f"sensitivity is {base}; it must be a power of two, at least 16, such as 1024.")
    p = len(ensemble.names)
    problem = {"num_vars": p, "names": list(ensemble.names), "bounds": [[0.0, 1.0]] * p}
    u = sample.sample(problem, base, calc_second_order=False, seed=seed)
    found = index(u, "sensitivity")
    spread = found.std()
    result = analyse.analyze(
        problem, (found - found.mean()) / (spread if spread > 0 else 1.0), calc_second_order=False, seed=seed + 1
    )  # SALib takes a seed of 0 for none
    axis = ("parameter",)
    return xr.Dataset(
        {
            "first": (axis, result["S1"], {"long_name": "share of the variance of the index"}),
            "total": (axis, result["ST"], {"long_name": "share with interactions"}),
            "first_confidence": (axis, result["S1_conf"]),
            "total_confidence": (axis, result["ST_conf"]),
        },
        {"parameter": list(ensemble.names)},
        {"designs": len(u)},
    )


def _samples(ensemble: Ensemble, u: Array, values: Array, hexapod: Hexapod, about: dict[str, Any]) -> xr.Dataset:
    import xarray as xr

    data: dict[str, Any] = {name: ("sample", ensemble.value(k, u[:, k])) for k, name in enumerate(ensemble.names)}
    data["index"] = ("sample", values, {"units": "rad s-1", "long_name": "dynamic stability index"})
    return xr.Dataset(data, attrs={"design": hexapod.name, "digest": hexapod.digest, **about})
