"""What constraints can bound: each kind of quantity from a sweep, where it is extreme, and its exact derivatives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any, Literal, NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.design.layout import PLACES
from flexapod.optimisation.derivatives import Slopes, soft_least, soft_most

Found = Mapping[str, Any]
Side = Literal["least", "most"]
_SHARPNESS = 1000.0  # of smooth extremes of singular values and of compliances: they are 0.2 % on the safe side
_HELD = 3  # poses held for each leg and side


class Values(NamedTuple):
    """Values (k,), their derivatives (k, n), and which column of the kind (leg, joint) each belongs to."""

    value: Array
    slope: Array
    column: Array


class Kind:
    """A quantity with one column or one for each leg. log: compared by ratio, for what spans decades."""

    quantities: tuple[str, ...] = ()
    unit = ""
    log = False

    def measure(self, found: Found, numbers: Array, side: Side) -> Array:
        """(w,) the extreme value of each column over the poses swept."""
        columns = self.columns(found, numbers)
        return columns.max(axis=0) if side == "most" else columns.min(axis=0)

    def held(self, found: Found, numbers: Array, side: Side) -> Array:
        """Numbers of the poses where the columns are extreme."""
        columns = self.columns(found, numbers)
        order = np.argsort(-columns if side == "most" else columns, axis=0)
        return np.unique(order[:_HELD])

    def columns(self, found: Found, numbers: Array) -> Array:
        """(poses, w)"""
        raise NotImplementedError

    def slopes(self, at: Slopes) -> Values:
        """At the poses held."""
        raise NotImplementedError


def _flat(value: Array, slope: Array) -> Values:
    k, w = value.shape
    return Values(value.ravel(), slope.reshape(k * w, -1), np.tile(np.arange(w), k))


class LegLengths(Kind):
    quantities = ("leg_length",)
    unit = "m"

    def columns(self, found: Found, numbers: Array) -> Array:
        return found["leg_length"]

    def slopes(self, at: Slopes) -> Values:
        return _flat(*at.leg_length)


class LegStroke(Kind):
    """Longest less shortest length of each leg."""

    quantities = ("leg_length",)
    unit = "m"

    def measure(self, found: Found, numbers: Array, side: Side) -> Array:
        return np.ptp(found["leg_length"], axis=0)

    def held(self, found: Found, numbers: Array, side: Side) -> Array:
        """For each leg in turn its shortest and its longest poses."""
        order = np.argsort(found["leg_length"], axis=0)
        few = min(_HELD, len(order))
        return np.concatenate([order[:few], order[-few:]]).T.ravel()

    def slopes(self, at: Slopes) -> Values:
        length, slope = at.leg_length
        poses = len(length) // 6
        few = poses // 2
        values, slopes = [], []
        for leg in range(6):
            own = slice(leg * poses, (leg + 1) * poses)
            L, dL = length[own, leg], slope[own, leg]
            values.append((L[few:, None] - L[None, :few]).ravel())
            slopes.append((dL[few:, None] - dL[None, :few]).reshape(few * few, -1))
        return Values(np.concatenate(values), np.concatenate(slopes), np.repeat(np.arange(6), few * few))


@dataclass(frozen=True)
class JointAngles(Kind):
    joint: Literal["universal", "spherical"]
    unit = "rad"

    @property
    def quantities(self) -> tuple[str, ...]:  # type: ignore[override]
        return (f"{self.joint}_angle",)

    def columns(self, found: Found, numbers: Array) -> Array:
        return found[f"{self.joint}_angle"]

    def slopes(self, at: Slopes) -> Values:
        mine = slice(0, 6) if self.joint == "universal" else slice(6, 12)
        cosine, slope = (part[:, mine] for part in at.joint_cosine)
        sine = np.sqrt(np.maximum(1 - cosine**2, 1e-12))  # a joint that is hardly bent bounds nothing
        return _flat(np.arccos(np.clip(cosine, -1, 1)), -slope / sine[..., None])


class LegDistance(Kind):
    quantities = ("leg_distance",)
    unit = "m"

    def columns(self, found: Found, numbers: Array) -> Array:
        return found["leg_distance"][:, None]

    def slopes(self, at: Slopes) -> Values:
        return _flat(*at.leg_distance)


class Conditioning(Kind):
    """cond(H), in metres."""

    quantities = ("cond_H",)
    log = True

    def columns(self, found: Found, numbers: Array) -> Array:
        return found["cond_H"][:, None]

    def slopes(self, at: Slopes) -> Values:
        H, dH = at.H
        U, sigma, Vt = np.linalg.svd(H)
        slope = np.einsum("krs,krcn,ksc->ksn", U, dH, Vt)
        safe = np.maximum(sigma, 1e-13 * sigma[:, :1])
        high, by_high = soft_most(safe, slope, _SHARPNESS)
        low, by_low = soft_least(safe, slope, _SHARPNESS)
        value = np.exp(high - low)
        return _flat(value[:, None], (value[:, None] * (by_high - by_low))[:, None])


@dataclass(frozen=True)
class Sag(Kind):
    """How far a force (N) at the reference point moves it in the direction where the legs give way most.

    force None: the platform's own weight.
    """

    force: float | None = None
    quantities = ("lowest_stiffness",)
    unit = "m"
    log = True

    def columns(self, found: Found, numbers: Array) -> Array:
        return (self._force(numbers) / found["lowest_stiffness"])[:, None]

    def _force(self, numbers: Array) -> float:
        if self.force is not None:
            return self.force
        return float(numbers[PLACES["platform.mass"]] * np.linalg.norm(numbers[PLACES["gravity"]]))

    def slopes(self, at: Slopes) -> Values:
        K, dK = at.stiffness
        block = np.linalg.inv(K)[:, :3]
        dC = -np.einsum("kar,krsn,ksb->kabn", block, dK, block.swapaxes(1, 2))
        most, V = np.linalg.eigh(block[:, :, :3])
        slope = np.einsum("kam,kabn,kbm->kmn", V, dC, V)
        logarithm, by = soft_most(most, slope, _SHARPNESS)
        force, by_force = self._force(at.numbers), np.zeros(at.jacobian.shape[1])
        if self.force is None:
            gravity = PLACES["gravity"]
            g = at.numbers[gravity]
            size = float(np.linalg.norm(g))
            by_force = at.jacobian[PLACES["platform.mass"]] / at.numbers[PLACES["platform.mass"]]
            by_force = by_force + g @ at.jacobian[gravity] / max(size, 1e-300) ** 2
        value = force * np.exp(logarithm)
        return _flat(value[:, None], (value[:, None] * (by + by_force))[:, None])


class Whole(Kind):
    """A property of the design that does not depend on where it stands."""

    def measure(self, found: Found, numbers: Array, side: Side) -> Array:
        return self.columns(found, numbers).max(axis=0)


class Mass(Whole):
    unit = "kg"
    _parts = np.concatenate([PLACES[k].ravel() for k in ("platform.mass", "legs.lower.mass", "legs.upper.mass")])

    def columns(self, found: Found, numbers: Array) -> Array:
        return numbers[self._parts].sum().reshape(1, 1)

    def slopes(self, at: Slopes) -> Values:
        value = self.columns({}, at.numbers)[0]
        return Values(value, at.jacobian[self._parts].sum(axis=0)[None], np.zeros(1, dtype=np.int64))


@dataclass(frozen=True)
class Radius(Whole):
    """Distance of the farthest joint of a plate from a line along z through (x, y) of its frame."""

    plate: Literal["base", "platform"]
    x: float
    y: float
    unit = "m"

    def columns(self, found: Found, numbers: Array) -> Array:
        place = PLACES[f"{self.plate}.joints"]
        return np.hypot(numbers[place[:, 0]] - self.x, numbers[place[:, 1]] - self.y)[None]

    def measure(self, found: Found, numbers: Array, side: Side) -> Array:
        return self.columns(found, numbers).max(axis=1)

    def slopes(self, at: Slopes) -> Values:
        place = PLACES[f"{self.plate}.joints"]
        dx, dy = at.numbers[place[:, 0]] - self.x, at.numbers[place[:, 1]] - self.y
        radius = np.maximum(np.hypot(dx, dy), 1e-300)
        slope = dx[:, None] * at.jacobian[place[:, 0]] + dy[:, None] * at.jacobian[place[:, 1]]
        return Values(radius, slope / radius[:, None], np.zeros(6, dtype=np.int64))


def enclosing_circle(points: Array) -> tuple[Array, float]:
    """Centre (2,) and radius of the least circle that holds a few points (n, 2)."""
    best, radius = points.mean(axis=0), np.inf
    for count in (2, 3):
        for chosen in combinations(points, count):
            p = np.array(chosen)
            if count == 2:
                center = p.mean(axis=0)
            else:
                edges = 2 * (p[1:] - p[0])
                if abs(np.linalg.det(edges)) < 1e-12 * np.abs(edges).max() ** 2:
                    continue
                center = np.linalg.solve(edges, (p[1:] ** 2).sum(axis=1) - (p[0] ** 2).sum())
            reach = np.linalg.norm(points - center, axis=1).max()
            if reach < radius:
                best, radius = center, float(reach)
    return best, radius
