"""Designs and states that tests draw at random, always from a seeded generator.

`appendix_a` is typed from the paper on its own, so that the design files can be checked against it.
"""

from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

import flexapod as fx

# Middle of the workspace, where a design file gives no home pose: platform in the base's frame, m.
CENTER = {"mukherjee-i": (0.0, 0.0, 0.89), "mukherjee-ii": (0.0, 0.0, 0.085)}

BASE_JOINTS = {
    "I": [[0.6, 0.1, -0.3, -0.3, 0.20, 0.5], [0.2, 0.5, 0.3, -0.4, -0.30, -0.2], [0.0, 0.1, 0.1, 0.0, -0.05, 0.0]],
    "II": [
        [0.03, 0.004486, -0.015, -0.02793, -0.015, 0.02345],
        [0.00, 0.02966, 0.02598, -0.01095, -0.02598, -0.01872],
        [0.0] * 6,
    ],
}
PLATFORM_JOINTS = {
    "I": [[0.3, 0.3, 0.0, -0.2, -0.15, 0.15], [0.0, 0.2, 0.3, 0.1, -0.20, -0.15], [0.1, 0.0, 0.0, -0.1, -0.05, -0.05]],
    "II": [
        [0.0428, 0.0326, -0.0334, -0.0432, -0.0094, 0.0106],
        [0.0139, 0.0313, 0.0301, 0.0127, -0.0440, -0.0437],
        [0.0] * 6,
    ],
}
UNIVERSAL_AXES = [
    [-0.8141, 0.2308, 0.9535, 1.0, 0.7071, -0.9535],
    [0.2714, 0.9231, 0.2860, 0.0, 0.7071, 0.2860],
    [0.0, 0.3077, 0.0953, 0.0, 0.0, -0.0953],
]
LOWER_INERTIA = np.array([[10, 5, 7], [5, 2, 3], [7, 3, 1]]) * 1e-3
UPPER_INERTIA = np.array([[5, 2, 2], [2, 2, 1], [2, 1, 3]]) * 1e-3


def appendix_a(machine: str, mass: float) -> SimpleNamespace:
    """Test manipulator "I" or "II" of the paper's Appendix A, with the readings that docs list, as plain arrays."""
    first = machine == "I"
    axes = np.array(UNIVERSAL_AXES).T
    scale = 1.0 if first else 1e-3
    center = {True: ([0.4, 0.14, -0.18], [-0.6, -0.08, 0.08]), False: ([0.04, 0.014, -0.018], [-0.6, -0.008, 0.008])}
    lower_center, upper_center = center[first]
    inertia = np.array([[50, 3, 4], [3, 40, 3], [4, 3, 100]]) * 1e-3 if first else np.eye(3) * 1e-4
    damping = SimpleNamespace(prismatic=np.full(6, 0.001), universal=np.full(6, 0.0001), spherical=np.full(6, 0.0002))
    lower = _same_part(3.0 if first else 0.3, lower_center, LOWER_INERTIA * scale)
    upper = _same_part(1.0 if first else 0.1, upper_center, UPPER_INERTIA * scale)
    stiffness = np.full(6, 2e8 if first else 8e7)
    return SimpleNamespace(
        name=f"mukherjee-{machine.lower()}",
        gravity=np.array([0.0, 0.0, -9.81]),
        base_joints=np.array(BASE_JOINTS[machine]).T,
        universal_axes=axes / np.linalg.norm(axes, axis=1, keepdims=True),
        platform_joints=np.array(PLATFORM_JOINTS[machine]).T,
        platform_mass=mass,
        platform_mass_center=np.array([0.04, 0.03, -0.06]) if first else np.zeros(3),
        platform_inertia=inertia,
        legs=SimpleNamespace(stiffness=stiffness, damping=damping, lower=lower, upper=upper),
        home=None,
    )


def _same_part(mass, mass_center, inertia) -> SimpleNamespace:
    return SimpleNamespace(
        mass=np.full(6, mass), mass_center=np.tile(mass_center, (6, 1)), inertia=np.tile(inertia, (6, 1, 1))
    )


class State(NamedTuple):
    """One state with its loads; `force` and `moment` act on the platform in its own axes."""

    platform: Any  # fx.Motion without acceleration
    base: Any  # fx.Motion
    leg_force: np.ndarray
    force: np.ndarray
    moment: np.ndarray

    @property
    def loads(self) -> dict[str, np.ndarray]:
        return {"leg_force": self.leg_force, "force": self.force, "moment": self.moment}


def draw_state(hexapod, rng: np.random.Generator, moving_base: bool = True) -> State:
    """A state about the middle of the workspace, well away from singular poses; the base anywhere and turning."""
    center, rpy = (CENTER[hexapod.name], np.zeros(3)) if hexapod.home is None else hexapod.home
    upright = Rotation.from_euler("xyz", np.array(rpy))  # SciPy refuses a read-only array
    arms = hexapod.platform_joints @ upright.as_matrix().T
    size = np.linalg.norm(arms + center - hexapod.base_joints, axis=1).mean()
    offset, turn = _draw_relative_pose(hexapod, rng, np.asarray(center), upright, size)
    if moving_base:
        position, rotation = rng.normal(size=3) * size, Rotation.from_rotvec(rng.normal(size=3))
        motion = [scale * rng.normal(size=3) for scale in (size, 1.0, 5 * size, 3.0)]
    else:
        position, rotation, motion = np.zeros(3), Rotation.identity(), [np.zeros(3)] * 4
    base = fx.Motion(fx.Pose(position, rotation), *motion)
    pose = fx.Pose(position + rotation.apply(offset), rotation * turn)
    # The platform moves with the base and about a leg's length and a radian per second besides.
    velocity = motion[0] + np.cross(motion[1], rotation.apply(offset)) + size * rng.normal(size=3)
    platform = fx.Motion(pose, velocity, motion[1] + rng.normal(size=3))
    weight = 10.0 * hexapod.platform_mass
    return State(platform, base, weight * rng.normal(size=6), *(weight * rng.normal(size=(2, 3)) * [[1.0], [size]]))


def _draw_relative_pose(hexapod, rng, center, upright, size) -> tuple[np.ndarray, Rotation]:
    for _ in range(1000):
        offset = center + 0.1 * size * rng.uniform(-1, 1, 3)
        turn = Rotation.from_rotvec(0.2 * rng.uniform(-1, 1, 3)) * upright
        arms = hexapod.platform_joints @ turn.as_matrix().T
        legs = arms + offset - hexapod.base_joints
        s = legs / np.linalg.norm(legs, axis=1, keepdims=True)
        lever = np.linalg.norm(arms, axis=1).mean()
        condition = np.linalg.cond(np.hstack([s, np.cross(arms, s) / lever]))
        if condition < 100 and np.abs(np.sum(s * hexapod.universal_axes, axis=1)).max() < 0.9:
            return offset, turn
    raise AssertionError(f"no regular pose of {hexapod.name} found about {center}")


def perturbed(hexapod, rng: np.random.Generator, friction: tuple[float, float, float] = (50.0, 2.0, 3.0)):
    """The design with every number of the dynamics changed and each leg its own.

    `friction` bounds the coefficients of the prismatic (N s/m), universal and spherical joints (N m s/rad), by default
    strong enough to decide the motion.
    """
    size = np.linalg.norm(hexapod.platform_joints - hexapod.base_joints + [0, 0, 1e-9], axis=1).mean()
    turn = Rotation.from_rotvec(rng.normal(size=3)).as_matrix()
    names = ("prismatic", "universal", "spherical")
    changes = {
        "gravity": hexapod.gravity + rng.normal(size=3),
        "base.joints": hexapod.base_joints + 0.03 * size * rng.normal(size=(6, 3)),
        "base.universal_axes": hexapod.universal_axes + 0.2 * rng.normal(size=(6, 3)),
        "platform.joints": hexapod.platform_joints + 0.03 * size * rng.normal(size=(6, 3)),
        "platform.mass": hexapod.platform_mass * rng.uniform(0.5, 2.0),
        "platform.mass_center": hexapod.platform_mass_center + 0.1 * size * rng.normal(size=3),
        "platform.inertia": _symmetric(turn @ hexapod.platform_inertia @ turn.T) * rng.uniform(0.5, 2.0),
        **{f"legs.damping.{n}": top * rng.uniform(size=6) for n, top in zip(names, friction, strict=True)},
    }
    for name in ("lower", "upper"):
        part = getattr(hexapod.legs, name)
        turns = Rotation.from_rotvec(rng.normal(size=(6, 3))).as_matrix()
        inertia = _symmetric(turns @ part.inertia @ turns.transpose(0, 2, 1))
        changes[f"legs.{name}.mass"] = part.mass * rng.uniform(0.5, 1.5, 6)
        changes[f"legs.{name}.mass_center"] = part.mass_center * rng.uniform(0.5, 1.5, (6, 3))
        changes[f"legs.{name}.inertia"] = inertia * rng.uniform(0.5, 1.5, (6, 1, 1))
    return hexapod.replace(changes)


def _symmetric(matrix: np.ndarray) -> np.ndarray:
    return 0.5 * (matrix + np.swapaxes(matrix, -1, -2))
