"""Quantities that constraints bound: their values in a sweep, the poses where they are extreme, their derivatives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.design.layout import PLACES
from flexapod.optimisation.derivatives import DesignDerivatives, soft_least, soft_most
from flexapod.showing import in_notebooks

Found = Mapping[str, Any]
Side = Literal["least", "most"]
_SHARPNESS = 1000.0  # of smooth extremes of singular values and of compliances: they are 0.2 % on the safe side
_HELD = 3  # poses held for each leg and side


@in_notebooks
class Values(NamedTuple):
    """Values of a quantity at some poses, with derivatives by the n variables of a search.

    Attributes
    ----------
    value : ndarray, shape (k,)
        The values.
    slope : ndarray, shape (k, n)
        Their derivatives.
    column : ndarray of int, shape (k,)
        Which column of the quantity (leg or joint) each belongs to.
    """

    value: Array
    slope: Array
    column: Array


class ConstraintQuantity:
    """A quantity that a constraint can bound, with one column or one for each leg: an extension point.

    A subclass writes `columns`, from the quantities of a sweep, and `derivatives`. `measure` and `worst_poses` suit
    quantities of which the constraint bounds the extreme value over the poses.

    Attributes
    ----------
    quantities : tuple of str
        Names of the quantities of `flexapod.sweep` that `columns` needs.
    unit : str
        SI unit.
    log : bool
        Whether values are compared by ratio, for quantities that span decades.
    """

    quantities: tuple[str, ...] = ()
    unit = ""
    log = False

    def columns(self, found: Found, numbers: Array) -> Array:
        """Return the values (poses, w), from a sweep and the numbers of the design."""
        raise NotImplementedError

    def derivatives(self, at: DesignDerivatives) -> Values:
        """Return the values at the poses of `at`, with derivatives."""
        raise NotImplementedError

    def measure(self, found: Found, numbers: Array, side: Side) -> Array:
        """Return the extreme value (w,) of each column over the poses of a sweep."""
        columns = self.columns(found, numbers)
        return columns.max(axis=0) if side == "most" else columns.min(axis=0)

    def worst_poses(self, found: Found, numbers: Array, side: Side) -> Array:
        """Return the numbers of the poses where the columns are extreme."""
        columns = self.columns(found, numbers)
        order = np.argsort(-columns if side == "most" else columns, axis=0)
        return np.unique(order[:_HELD])

    def describe(self) -> str:
        """Return the quantity as text: equal for equal quantities."""
        return repr(self) if self.__dict__ else type(self).__name__


def _flat(value: Array, slope: Array) -> Values:
    k, w = value.shape
    return Values(value.ravel(), slope.reshape(k * w, -1), np.tile(np.arange(w), k))


class LegLengths(ConstraintQuantity):
    """Lengths of the six legs."""

    quantities = ("leg_length",)
    unit = "m"

    def columns(self, found: Found, numbers: Array) -> Array:
        return found["leg_length"]

    def derivatives(self, at: DesignDerivatives) -> Values:
        return _flat(*at.leg_length)


class LegStroke(ConstraintQuantity):
    """Difference of the longest and the shortest length of each leg."""

    quantities = ("leg_length",)
    unit = "m"

    def measure(self, found: Found, numbers: Array, side: Side) -> Array:
        return np.ptp(found["leg_length"], axis=0)

    def worst_poses(self, found: Found, numbers: Array, side: Side) -> Array:
        """For each leg in turn its shortest and its longest poses."""
        order = np.argsort(found["leg_length"], axis=0)
        few = min(_HELD, len(order))
        return np.concatenate([order[:few], order[-few:]]).T.ravel()

    def derivatives(self, at: DesignDerivatives) -> Values:
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
class _OfJoints(ConstraintQuantity):
    """What is found of the six joints of one kind; the core gives both kinds side by side, universal joints first."""

    joint: Literal["universal", "spherical"]
    name: ClassVar[str]

    @property
    def quantities(self) -> tuple[str, ...]:  # type: ignore[override]
        return (f"{self.joint}_{self.name}",)

    @property
    def mine(self) -> slice:
        return slice(0, 6) if self.joint == "universal" else slice(6, 12)

    def columns(self, found: Found, numbers: Array) -> Array:
        return found[f"{self.joint}_{self.name}"]


@dataclass(frozen=True)
class JointAngles(_OfJoints):
    """Angles by which the joints of one kind turn from where they are at home."""

    name = "angle"
    unit = "rad"

    def derivatives(self, at: DesignDerivatives) -> Values:
        cosine, slope = (part[:, self.mine] for part in at.joint_cosine)
        sine = np.sqrt(np.maximum(1 - cosine**2, 1e-12))  # a joint that is hardly bent bounds nothing
        return _flat(np.arccos(np.clip(cosine, -1, 1)), -slope / sine[..., None])


@dataclass(frozen=True)
class JointMoments(_OfJoints):
    """Bending moments of the springs in the joints of one kind."""

    name = "moment"
    unit = "N m"

    def derivatives(self, at: DesignDerivatives) -> Values:
        square, slope = (part[:, self.mine] for part in at.joint_moment)
        moment = np.sqrt(np.maximum(square, 1e-24))  # a joint that is hardly bent bounds nothing
        return _flat(moment, 0.5 * slope / moment[..., None])


@dataclass(frozen=True)
class LegForces(ConstraintQuantity):
    """Forces with which legs push, or pull, at rest under the machine's weight."""

    sense: Literal["compression", "tension"]
    unit = "N"

    @property
    def quantities(self) -> tuple[str, ...]:  # type: ignore[override]
        return (f"leg_{self.sense}",)

    def columns(self, found: Found, numbers: Array) -> Array:
        return found[f"leg_{self.sense}"][:, None]

    def derivatives(self, at: DesignDerivatives) -> Values:
        sign = 1.0 if self.sense == "compression" else -1.0
        force, slope = at.static_force
        return _flat(sign * force, sign * slope)


class LegDistance(ConstraintQuantity):
    """Smallest distance of the axes of two legs."""

    quantities = ("leg_distance",)
    unit = "m"

    def columns(self, found: Found, numbers: Array) -> Array:
        return found["leg_distance"][:, None]

    def derivatives(self, at: DesignDerivatives) -> Values:
        return _flat(*at.leg_distance)


class Conditioning(ConstraintQuantity):
    """Condition number of the force transformation, with lengths in m."""

    quantities = ("cond_H",)
    log = True

    def columns(self, found: Found, numbers: Array) -> Array:
        return found["cond_H"][:, None]

    def derivatives(self, at: DesignDerivatives) -> Values:
        H, dH = at.H
        U, sigma, Vt = np.linalg.svd(H)
        slope = np.einsum("krs,krcn,ksc->ksn", U, dH, Vt)
        safe = np.maximum(sigma, 1e-13 * sigma[:, :1])
        high, by_high = soft_most(safe, slope, _SHARPNESS)
        low, by_low = soft_least(safe, slope, _SHARPNESS)
        value = np.exp(high - low)
        return _flat(value[:, None], (value[:, None] * (by_high - by_low))[:, None])


@dataclass(frozen=True)
class StaticDeflection(ConstraintQuantity):
    """Displacement of the reference point under a force (N) in the direction in which the legs are softest.

    A force of None is the platform's own weight.
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

    def derivatives(self, at: DesignDerivatives) -> Values:
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


class DesignProperty(ConstraintQuantity):
    """A property of the design that does not depend on the pose."""

    def measure(self, found: Found, numbers: Array, side: Side) -> Array:
        return self.columns(found, numbers).max(axis=0)


class Mass(DesignProperty):
    """Mass of the platform and all legs."""

    unit = "kg"
    _parts = np.concatenate([PLACES[k].ravel() for k in ("platform.mass", "legs.lower.mass", "legs.upper.mass")])

    def columns(self, found: Found, numbers: Array) -> Array:
        return numbers[self._parts].sum().reshape(1, 1)

    def derivatives(self, at: DesignDerivatives) -> Values:
        value = self.columns({}, at.numbers)[0]
        return Values(value, at.jacobian[self._parts].sum(axis=0)[None], np.zeros(1, dtype=np.int64))


@dataclass(frozen=True)
class Radius(DesignProperty):
    """Distance of the joints of a plate from a line along z through (x, y) of its frame."""

    plate: Literal["base", "platform"]
    x: float
    y: float
    unit = "m"

    def columns(self, found: Found, numbers: Array) -> Array:
        place = PLACES[f"{self.plate}.joints"]
        return np.hypot(numbers[place[:, 0]] - self.x, numbers[place[:, 1]] - self.y)[None]

    def measure(self, found: Found, numbers: Array, side: Side) -> Array:
        return self.columns(found, numbers).max(axis=1)

    def derivatives(self, at: DesignDerivatives) -> Values:
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
