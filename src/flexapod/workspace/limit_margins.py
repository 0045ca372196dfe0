"""By how much a pose is within the design's limits, with exact derivatives: the constraints of a search."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from flexapod.conventions import LEG_PAIRS, LEGS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError
from flexapod.mechanics.load_limits import force_bounds
from flexapod.workspace.coordinates import AtCoordinates
from flexapod.workspace.quantities import kernel_limits
from flexapod.workspace.static_forces import static_forces

_TINY = np.finfo(float).eps
_FORCES = 45  # the first column of forces


def none_within(count: int) -> PoseError:
    """What is told where poses can be computed and the design's limits allow none of them."""
    return PoseError(
        f"none of the {count} poses is within the design's limits. Choose other poses, or take all of them (all_poses, "
        "on the command line --all-poses)."
    )


def refuse_force_limits(hexapod: Hexapod) -> None:
    """Raises ArgumentError for limits of leg forces, of which nothing can be proved yet."""
    if force_bounds(hexapod.limits) is not None:
        raise ArgumentError(
            f"{hexapod.name!r} limits leg forces (limits.leg_compression, limits.leg_tension), of which nothing can be "
            "proved yet. Leave them out of the design that is proved."
        )


class LimitMargins:
    """Margins of every limit of a design at x, y, z, roll, pitch, yaw (6,), with exact derivatives.

    A margin is a share of what it is taken from: of the greatest leg length, of 1 - cos of the largest angle, of the
    least distance between legs, of the square of the largest moment, of the root of the squares of a leg's force and
    its limit. Those >= 0 are kept. Each is a smooth function of the pose: the least distance between legs is that of
    every two of them. `names` says what each margin limits, `kernel` is the same for sweeps. Forces are those of rest,
    under the weight. The range of a stiffness law limits the legs' lengths as well; with `only_law` nothing else does.
    """

    def __init__(self, hexapod: Hexapod, only_law: bool = False, joint: JointModel = "universal") -> None:
        self._at = AtCoordinates(hexapod, joint)
        bounds = [*_law_bounds(hexapod), *([] if only_law else _bounds(hexapod))]
        self.kernel, self.only_law = kernel_limits(hexapod, only_law), only_law
        self.names = tuple(bound.name for bound in bounds)
        self._columns = np.array([bound.column for bound in bounds], dtype=int)
        self._bounds, self._sign, self._scale = (
            np.array([getattr(bound, name) for bound in bounds], dtype=float) for name in ("value", "sign", "scale")
        )
        self._of_force = self._columns >= _FORCES

    def __call__(self, six: Array) -> tuple[Array, Array]:
        """Margins (m,), and their derivatives by the six coordinates (m, 6)."""
        at = self._at(six)
        parts = [*at.legs(), *([static_forces(at)] if self._of_force.any() else [])]
        value = np.concatenate([value[0] for value, _ in parts])[self._columns]
        slope = np.concatenate([slope[0] for _, slope in parts])[self._columns]
        size = np.where(self._of_force, np.hypot(self._scale, value), self._scale)
        by_value = np.where(self._of_force, (self._scale**2 + self._bounds * value) / size**2, 1.0)
        return self._sign * (value - self._bounds) / size, (self._sign * by_value / size)[:, None] * slope


def margins_to_keep(hexapod: Hexapod, all_poses: bool, joint: JointModel = "universal") -> LimitMargins | None:
    """The margins that a pose must keep to count; None where all poses do.

    Where all poses are asked for, those outside the range of a stiffness law still have no frequencies.
    """
    limited = hexapod.limits.given and not all_poses
    if not limited and hexapod.legs.stiffness_law is None:
        return None
    return LimitMargins(hexapod, not limited, joint)


class _Bound(NamedTuple):
    """sign (value of the column - value) / scale >= 0.

    Columns: 6 lengths, 15 distances, 12 cosines of angles, 12 squares of moments, 6 forces. What a force is taken from
    also has its square beside that of the scale: it is infinite at a singular pose.
    """

    name: str
    column: int
    sign: int
    value: float
    scale: float


def _law_bounds(hexapod: Hexapod) -> Iterator[_Bound]:
    """The range of a design's stiffness law as bounds of the legs' lengths."""
    law = hexapod.legs.stiffness_law
    if law is not None:
        for i, (leg, (least, most)) in enumerate(zip(LEGS, law.range, strict=True)):
            scale = float(most if np.isfinite(most) else least)
            yield _Bound(f"least length of the stiffness law of leg {leg}", i, 1, float(least), scale)
            if np.isfinite(most):
                yield _Bound(f"greatest length of the stiffness law of leg {leg}", i, -1, float(most), scale)


def _bounds(hexapod: Hexapod) -> Iterator[_Bound]:
    limits = hexapod.limits
    if limits.leg_length is not None:
        lengths = np.broadcast_to(np.asarray(limits.leg_length, dtype=float), (6, 2))
        for i, (leg, (least, most)) in enumerate(zip(LEGS, lengths, strict=True)):
            yield _Bound(f"least length of leg {leg}", i, 1, least, most)
            yield _Bound(f"greatest length of leg {leg}", i, -1, most, most)
    if limits.leg_distance:
        for k, (i, j) in enumerate(LEG_PAIRS):
            words = f"distance of legs {LEGS[i]} and {LEGS[j]}"
            yield _Bound(words, 6 + k, 1, limits.leg_distance, limits.leg_distance)
    for kind, first, most in (("universal", 21, limits.universal_angle), ("spherical", 27, limits.spherical_angle)):
        if most is not None and most < np.pi:
            for i, leg in enumerate(LEGS):
                yield _Bound(f"{kind} joint of leg {leg}", first + i, 1, np.cos(most), max(1 - np.cos(most), _TINY))
    for kind, first, moment in (("universal", 33, limits.universal_moment), ("spherical", 39, limits.spherical_moment)):
        if moment is not None:
            for i, leg in enumerate(LEGS):
                yield _Bound(f"moment of the {kind} joint of leg {leg}", first + i, -1, moment**2, moment**2)
    for words, sign, most in (("compression", -1, limits.leg_compression), ("tension", 1, limits.leg_tension)):
        if most is not None:
            for i, leg in enumerate(LEGS):
                yield _Bound(
                    f"greatest {words} of leg {leg}", _FORCES + i, sign, -sign * most, most or _weight(hexapod)
                )


def _weight(hexapod: Hexapod) -> float:
    """Of the platform, N; that of 1 kg where there is none."""
    return float(np.linalg.norm(hexapod.gravity)) * hexapod.platform_mass or 9.81
