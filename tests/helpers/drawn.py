"""Hypothesis strategies: machines that could be built, of any size, and states of motion about their middle."""

from functools import cache
from typing import NamedTuple

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import flexapod as fx

seeds = st.integers(0, 2**32 - 1)


class Situation(NamedTuple):
    """A machine in motion with all its loads; `force` and `moment` act in the platform's axes."""

    hexapod: fx.Hexapod
    platform: fx.Motion
    base: fx.Motion
    leg_force: np.ndarray
    force: np.ndarray
    moment: np.ndarray

    @property
    def loads(self) -> dict[str, np.ndarray]:
        return {"leg_force": self.leg_force, "force": self.force, "moment": self.moment}


@st.composite
def machines(draw) -> fx.Hexapod:
    """A general machine: no symmetry, every leg its own, bodies that could be cast, all frictions on."""
    size, mass = 10.0 ** draw(st.floats(-1.5, 0.5)), 10.0 ** draw(st.floats(-1, 3))
    height, ratio = draw(st.floats(0.5, 2)), draw(st.floats(0.3, 1.2))
    return _machine(np.random.default_rng(draw(seeds)), size, mass, height, ratio)


@cache
def machine(seed: int) -> fx.Hexapod:
    """One such machine, always the same for a seed."""
    rng = np.random.default_rng(seed)
    size, mass = 10.0 ** rng.uniform(-1.5, 0.5), 10.0 ** rng.uniform(-1, 3)
    return _machine(rng, size, mass, rng.uniform(0.5, 2), rng.uniform(0.3, 1.2))


def _machine(rng, size, mass, height, ratio) -> fx.Hexapod:
    base_angle = np.radians(rng.uniform(-8, 8, 6) + np.array([-15, 15, 105, 135, 225, 255]))
    platform_angle = np.radians(rng.uniform(-8, 8, 6) + np.array([-50, 50, 70, 170, 190, 290]))
    values = {
        "name": "drawn",
        "gravity": rng.normal(size=3) * 6,
        "base.joints": size * _ring(rng, 1.0, base_angle),
        "base.universal_axes": _ring(rng, 1.0, base_angle + np.pi / 2) + 0.3 * rng.normal(size=(6, 3)),
        "platform.joints": size * _ring(rng, ratio, platform_angle),
        "platform.mass": np.array(mass),
        "platform.mass_center": 0.2 * size * rng.normal(size=3),
        "platform.inertia": _inertia(rng, mass, ratio * size),
        "legs.stiffness": mass / size * 10 ** rng.uniform(4, 5, 6),
        "home.position": np.array([0, 0, height * size]),
        "home.orientation": np.zeros(3),
    }
    damping = {"prismatic": mass, "universal": mass * size**2, "spherical": mass * size**2}
    values |= {f"legs.damping.{k}": v * rng.uniform(0, 1, 6) for k, v in damping.items()}
    for part, side in (("lower", 1), ("upper", -1)):
        masses = 0.2 * mass * rng.uniform(0.1, 1, 6)
        values[f"legs.{part}.mass"] = masses
        values[f"legs.{part}.mass_center"] = size * (0.1 * rng.normal(size=(6, 3)) + [side * 0.4 * height, 0, 0])
        values[f"legs.{part}.inertia"] = np.array([_inertia(rng, m, 0.3 * size) for m in masses])
    return fx.Hexapod.from_values(values)


def sprung(hexapod: fx.Hexapod, rng: np.random.Generator, suspension: bool = True) -> fx.Hexapod:
    """The same machine with springs in series, in its joints and beside its legs, at rest a little away from home.

    Those of the joints are as stiff as the legs at a tenth of the machine's size or so.
    """
    legs = hexapod.legs.stiffness.mean()
    length = float(np.linalg.norm(hexapod.base_joints, axis=1).mean())
    joint, square = 0.01 * legs * length**2, rng.normal(size=(2, 6, 6))
    units = np.diag([1.0] * 3 + [length] * 3)
    at_rest = hexapod.home.displaced([*(0.02 * length * rng.normal(size=3)), *(0.05 * rng.normal(size=3))])
    changes = {
        "legs.series_stiffness": legs * rng.uniform(1, 5, (6, 2)),
        "legs.joint_stiffness.universal": joint * rng.uniform(0.1, 1, (6, 2)),
        "legs.joint_stiffness.spherical": joint * rng.uniform(0.1, 1, 6),
        "legs.joint_stiffness.torsion": joint * rng.uniform(0.1, 1, 6),
        "legs.joint_rest.position": at_rest.position,
        "legs.joint_rest.orientation": at_rest.rpy,
    }
    if suspension:
        stiffness, damping = (units @ (s @ s.T) @ units for s in square)
        changes |= {
            "suspension.stiffness": 0.1 * legs * (stiffness + stiffness.T) / 2,
            "suspension.damping": 1e-3 * legs * (damping + damping.T) / 2,
            "suspension.point": 0.3 * length * rng.normal(size=3),
        }
    return hexapod.replace(changes)


def with_law(hexapod: fx.Hexapod, rng: np.random.Generator, kind: str | None = None) -> fx.Hexapod:
    """The same machine with legs whose stiffness goes by a law of their length, about as stiff as before at home."""
    lengths = fx.inverse_kinematics(hexapod, hexapod.home)
    size, stiffness = float(lengths.mean()), float(hexapod.legs.stiffness.mean())
    kind = kind or str(rng.choice(["screw", "hydraulic", "table"]))
    nodes = size * np.linspace(0.3, 2.5, 20) * rng.uniform(0.98, 1.02, 20)
    law = {
        "screw": {
            "fixed": 2 * stiffness * rng.uniform(0.5, 2, 6),
            "axial_rigidity": stiffness * size * rng.uniform(0.3, 3, 6),
            "zero_length": 0.3 * lengths,
        },
        "hydraulic": {
            "bulk_modulus": 1e9,
            "area_1": 1e-9 * stiffness * size * rng.uniform(0.2, 0.6, 6),
            "area_2": 1e-9 * stiffness * size * rng.uniform(0.0, 0.5, 6),
            "dead_1": 0.1 * lengths * rng.uniform(0.3, 2, 6),
            "dead_2": 0.1 * lengths * rng.uniform(0.3, 2, 6),
            "stroke": 1.2 * lengths,
            "shortest": 0.4 * lengths,
        },
        "table": {"lengths": nodes, "stiffnesses": stiffness * rng.uniform(0.5, 2, len(nodes))},
    }[kind]
    return hexapod.replace({"legs.stiffness": None, "legs.stiffness_law": {"kind": kind, **law}})


def with_round_legs(hexapod: fx.Hexapod) -> fx.Hexapod:
    """The same machine with legs that look the same when they turn about themselves."""
    changes = {}
    for name in ("lower", "upper"):
        part = getattr(hexapod.legs, name)
        along, across = part.inertia[:, 0, 0], part.inertia[:, 1, 1]
        changes[f"legs.{name}.mass_center"] = part.mass_center * [1, 0, 0]
        changes[f"legs.{name}.inertia"] = np.stack([np.diag(d) for d in np.stack([along, across, across], axis=1)])
    return hexapod.replace(changes)


def _ring(rng, radius, angle):
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0.1 * rng.uniform(-1, 1, 6)])


def _inertia(rng, mass, size):
    """Of a solid ellipsoid, turned at random."""
    a, b, c = (size * rng.uniform(0.2, 1, 3)) ** 2
    turn = Rotation.from_rotvec(rng.normal(size=3)).as_matrix()
    inertia = mass / 5 * turn @ np.diag([b + c, a + c, a + b]) @ turn.T
    return (inertia + inertia.T) / 2


@st.composite
def situations(draw) -> Situation:
    hexapod = draw(machines())
    rng = np.random.default_rng(draw(seeds))
    home, size = hexapod.home.position, float(hexapod.home.position[2])
    turned = Rotation.from_rotvec(rng.uniform(-1.5, 1.5, 3))
    base = fx.Motion(fx.Pose(size * rng.normal(size=3), turned), *_rates(rng, size), *_rates(rng, 5 * size, 5))
    offset = home + 0.1 * size * rng.uniform(-1, 1, 3)
    tilt = Rotation.from_rotvec(rng.uniform(-0.2, 0.2, 3))
    pose = fx.Pose(base.pose.position + turned.apply(offset), turned * tilt)
    velocity, spin = _rates(rng, size)
    carried = base.velocity + np.cross(base.angular_velocity, turned.apply(offset))
    rates = (carried + velocity, base.angular_velocity + spin, *_rates(rng, 5 * size, 5))
    weight = 10 * hexapod.platform_mass
    leg_force, force, moment = (weight * rng.normal(size=n) for n in (6, 3, 3))
    return Situation(hexapod, fx.Motion(pose, *rates), base, leg_force, force, size * moment)


def _rates(rng, linear, angular=1.0):
    return linear * rng.normal(size=3), angular * rng.normal(size=3)
