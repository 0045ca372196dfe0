"""What stops a motion from home: margins of every limit at many poses, and how far they surely hold along a way."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.conventions import LEG_PAIRS, LEGS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.inputs import States, states
from flexapod.mechanics.joint_limits import leg_distances, moment_excess, neutral_directions
from flexapod.mechanics.kinematics import platform_size
from flexapod.pose import Pose
from flexapod.rotations import rpy_matrix
from flexapod.workspace.quantities import evaluate, kernel_limits

SINGULAR = "singular pose"
NO_LEG = "a leg without length, or along its universal joint's axis"
_SINGULAR_AT = 1e-9  # determinant of H, moments over the platform's size and columns of length 1
_COARSE = (
    1e-2  # of the mean leg length: the longest step between poses, in which what has no bound on its slope is seen
)


class Bounds(NamedTuple):
    """Bounds beside those of the design: the index (rad/s), cond(H), and the length (m) that its moments are over."""

    least_index: float | None
    condition_number: float | None
    characteristic_length: float | None


class Displacements:
    """Poses displaced from home: a point of the platform is moved, and the platform turned about it.

    Displacements are rows (n, 6): x, y, z (m) along the base frame's axes, roll, pitch, yaw (rad) about them.
    """

    def __init__(self, home: Pose, point: Array) -> None:
        self.home, self.point = home, point
        self._place = home.position + home.matrix @ point

    def poses(self, rows: Array) -> Pose:
        """The poses of displacements."""
        matrix = rpy_matrix(rows[:, 3:]) @ self.home.matrix
        return Pose.trusted(self._place + rows[:, :3] - matrix @ self.point, matrix)


@dataclass(frozen=True)
class Ways:
    """How fast displacements change: of the point (n,), m, and of the angle (n,), rad, each by one of the way."""

    speed: Array
    turn: Array

    @classmethod
    def along(cls, rows: Array) -> Ways:
        """Ways along straight lines of displacement, rows (n, 6); three turns at once are at most their sum."""
        return cls(np.linalg.norm(rows[:, :3], axis=1), np.abs(rows[:, 3:]).sum(axis=1))

    def __getitem__(self, index: NDArray[np.intp]) -> Ways:
        return Ways(self.speed[index], self.turn[index])


class TravelLimits:
    """Margins of all limits at displacements: >= 0 where they are kept. `names` says what each column limits.

    A margin is in the unit of what it limits. How fast lengths, angles and distances can change at most is known, so
    that `free` can say how far on a way none of them can be exceeded. Singular poses, cond(H), the index, moments of
    joints and static leg forces are looked at in small steps instead; a singular pose is noticed by the sign of det H
    on its other side.
    """

    def __init__(self, hexapod: Hexapod, displacements: Displacements, bounds: Bounds, joint: JointModel) -> None:
        self.hexapod, self.displacements, self.bounds, self.joint = hexapod, displacements, bounds, joint
        self.names = tuple(_names(hexapod, bounds))
        self._arm = np.linalg.norm(hexapod.platform_joints - displacements.point, axis=1)
        self._size = platform_size(hexapod)
        length = bounds.characteristic_length or 1.0
        self._scaled = None if bounds.condition_number is None else (length, *_in_lengths(hexapod, length))
        self._kernel = kernel_limits(hexapod)
        self._neutral = neutral_directions(hexapod)
        s = states(hexapod, displacements.home)
        self.leg = float(_core.leg_rates(hexapod.packed, s.platform, s.base)[0].mean())
        self._side = 1.0
        self._side = float(np.sign(self._determinant(s)[0, 0]))

    def joint_speed(self, ways: Ways) -> Array:
        """The greatest speeds of the platform's joints, (n, 6), m by one of the way."""
        return ways.speed[:, None] + self._arm * ways.turn[:, None]

    def longest_step(self, ways: Ways) -> Array:
        """The longest step (n,) on each way: what has no known slope is looked at no more rarely."""
        with np.errstate(divide="ignore"):
            return _COARSE * self.leg / self.joint_speed(ways).max(axis=1)

    def margins(self, rows: Array) -> Array:
        """Margins (n, k); NaN where a leg cannot take the pose."""
        return self._found(rows, None)[0]

    def free(self, rows: Array, ways: Ways) -> tuple[Array, Array]:
        """Margins (n, k), and how far (n,) on each way no limit with a known slope is exceeded."""
        return self._found(rows, ways)

    def _found(self, rows: Array, ways: Ways | None) -> tuple[Array, Array]:
        poses = self.displacements.poses(rows)
        s = states(self.hexapod, poses)
        length = _core.leg_rates(self.hexapod.packed, s.platform, s.base)[0]
        slope = None
        if ways is not None:
            joint = self.joint_speed(ways)
            swing = 2 * joint / length  # at most, as long as no leg has lost half its length
            slope = _Slopes(joint, swing, swing + ways.turn[:, None])
        parts = list(self._geometry(s, length, slope))
        margins = np.concatenate([*(part for part, _ in parts), *self._sampled(poses, s)], axis=1)
        if ways is None or slope is None:
            return margins, np.empty(0)
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = [(part / steep).min(axis=1) for part, steep in parts if steep is not None]
        half = (0.5 * length / slope.joint).min(axis=1)
        return margins, np.min([half, self.longest_step(ways), *reach], axis=0)

    def _geometry(self, s: States, length: Array, slope: _Slopes | None) -> Iterator[tuple[Array, Array | None]]:
        limits, packed = self.hexapod.limits, self.hexapod.packed
        if limits.leg_length is not None:
            least, most = np.broadcast_to(limits.leg_length, (6, 2)).T
            steep = None if slope is None else slope.joint
            yield length - least, steep
            yield most - length, steep
        if self.hexapod.legs.stiffness_law is not None:
            least, most = self.hexapod.legs.stiffness_law.range.T
            yield length - least, None if slope is None else slope.joint
            yield most - length, None if slope is None else slope.joint
        if limits.universal_angle is not None or limits.spherical_angle is not None:
            angles = _core.joint_angles(packed, s.platform, s.base, self._neutral)
            for most, found, name in (
                (limits.universal_angle, angles[2], "swing"),
                (limits.spherical_angle, angles[3], "swing_in_platform"),
            ):
                if most is not None:
                    yield most - found.reshape(-1, 6), None if slope is None else getattr(slope, name)
        if limits.leg_distance is not None:
            apart = leg_distances(self.hexapod, s).reshape(-1, len(LEG_PAIRS))
            pairs = np.array(LEG_PAIRS)
            yield apart - limits.leg_distance, None if slope is None else slope.joint[:, pairs].max(axis=2)

    def _determinant(self, s: States) -> Array:
        """det H (n, 1), positive on home's side of the singular poses: moments over the platform's size, columns 1."""
        H = _core.force_transformation(self.hexapod.packed, s.platform, s.base).reshape(-1, 6, 6)
        scale = np.repeat([1.0, 1 / self._size], 3)
        columns = np.sqrt(np.einsum("nij,nij,i->nj", H, H, scale**2)).prod(axis=1)
        return (self._side * scale.prod() * np.linalg.det(H) / columns)[:, None]

    def _sampled(self, poses: Pose, s: States) -> Iterator[Array]:
        limits = self.hexapod.limits
        yield self._determinant(s) - _SINGULAR_AT
        if self._scaled is not None:
            length, scaled, kernel = self._scaled
            rows = Pose.trusted(poses.position / length, poses.matrix).packed
            cond = evaluate(scaled, rows, ("cond_H",), self.joint, 1, kernel)["cond_H"]
            with np.errstate(divide="ignore"):
                yield 1 / cond[:, None] - 1 / self.bounds.condition_number  # type: ignore[operator]
        if self.bounds.least_index is not None:
            found = evaluate(self.hexapod, poses.packed, ("omega_1",), self.joint, 1, self._kernel)["omega_1"]
            yield found[:, None] - self.bounds.least_index
        for moment in moment_excess(self.hexapod, poses, joint=self.joint):
            yield moment.most - moment.value.reshape(-1, 6)
        if limits.leg_compression is not None or limits.leg_tension is not None:
            force = inverse_dynamics(self.hexapod, poses, joint=self.joint)
            if limits.leg_compression is not None:
                yield limits.leg_compression - force
            if limits.leg_tension is not None:
                yield force + limits.leg_tension


class _Slopes(NamedTuple):
    """How fast things change at most, by one of the way: joints (m), directions of legs in base and platform (rad)."""

    joint: Array
    swing: Array
    swing_in_platform: Array


def _names(hexapod: Hexapod, bounds: Bounds) -> Iterator[str]:
    """What the columns of margins limit, in their order."""
    limits = hexapod.limits
    by_leg: list[str] = []
    if limits.leg_length is not None:
        by_leg += ["least length of leg", "greatest length of leg"]
    if hexapod.legs.stiffness_law is not None:
        by_leg += ["least length of the stiffness law of leg", "greatest length of the stiffness law of leg"]
    by_leg += ["universal joint of leg"] * (limits.universal_angle is not None)
    by_leg += ["spherical joint of leg"] * (limits.spherical_angle is not None)
    yield from (f"{words} {leg}" for words in by_leg for leg in LEGS)
    if limits.leg_distance is not None:
        yield from (f"distance of legs {LEGS[i]} and {LEGS[j]}" for i, j in LEG_PAIRS)
    yield SINGULAR
    if bounds.condition_number is not None:
        yield "bound of cond(H)"
    if bounds.least_index is not None:
        yield "bound of the index"
    for limit, words in ((limits.universal_moment, "universal"), (limits.spherical_moment, "spherical")):
        if limit is not None:
            yield from (f"moment of the {words} joint of leg {leg}" for leg in LEGS)
    for limit, words in ((limits.leg_compression, "compression"), (limits.leg_tension, "tension")):
        if limit is not None:
            yield from (f"greatest {words} of leg {leg}" for leg in LEGS)


def _in_lengths(hexapod: Hexapod, length: float) -> tuple[Hexapod, _core.SweepLimits]:
    """The machine measured in a length: its H has moments over that length."""
    scaled = dataclasses.replace(
        hexapod,
        base_joints=hexapod.base_joints / length,
        platform_joints=hexapod.platform_joints / length,
        limits=type(hexapod.limits)(),
        home=None,
        short_forms=(),
    )
    return scaled, kernel_limits(scaled)
