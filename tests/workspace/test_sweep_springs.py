"""Sweeps of machines with springs in their joints, a suspension, springs in series and stiffness laws."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator
from tests.helpers.drawn import machine, sprung
from tests.helpers.plain import plain_machine
from tests.helpers.support import JOINTS, difference, size
from tests.oracles.exact_modes import exact_modes

import flexapod as fx
from flexapod import _core

EPS = np.finfo(float).eps
OUTSIDE = _core.SweepStatus.outside_stiffness_law.value
BOX = fx.Workspace.about_home(0.05, 0.1)


def poses_about(hexapod, seed: int, count: int, travel=0.1, turn=0.2) -> np.ndarray:
    scale = np.repeat([travel * size(hexapod), turn], 3)
    middle = np.concatenate([hexapod.home.position, hexapod.home.rpy])
    return middle + np.random.default_rng(seed).uniform(-1, 1, (count, 6)) * scale


def swept(hexapod, poses, joint="universal", *quantities) -> dict:
    asked = _core.SweepQuantity.omega
    for name in quantities:
        asked |= _core.SweepQuantity[name]
    return _core.sweep(hexapod.packed, _core.Joint[joint], poses, asked, _core.SweepLimits(), 1)


def scaled_joints(hexapod, factor: float):
    """The machine with springs in its joints so many times as stiff, from nothing to all that holds the platform."""
    springs = hexapod.legs.joint_stiffness
    return hexapod.replace(
        {
            f"legs.joint_stiffness.{name}": factor * getattr(springs, name)
            for name in ("universal", "spherical", "torsion")
        }
    )


def near_singular(hexapod, seed: int) -> np.ndarray:
    """Poses at and about one where the legs alone do not hold the platform."""
    rng, plain = np.random.default_rng(seed), poses_about(hexapod, seed, 1)[0]
    yaw = np.linspace(0.0, np.pi, 2001)
    line = np.tile(plain, (len(yaw), 1))
    line[:, 5] = yaw
    sign = np.sign(np.linalg.det(fx.force_transformation(hexapod, fx.Pose.from_rpy(*line.T))))
    change = np.flatnonzero(sign[1:] != sign[:-1])
    low, high = yaw[change[0]], yaw[change[0] + 1]
    for _ in range(50):
        middle = 0.5 * (low + high)
        plain[5] = middle
        same = np.sign(np.linalg.det(fx.force_transformation(hexapod, fx.Pose.from_rpy(*plain)))) == sign[change[0]]
        low, high = (middle, high) if same else (low, middle)
    offsets = np.concatenate([[0.0], 10.0 ** rng.uniform(-9, -2, 4)])
    found = np.tile(plain, (5, 1))
    found[:, 5] = low + offsets
    return found


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("factor", [1e-12, 1e-8, 1e-4, 1.0, 1e4, 1e8])
def test_springs_in_joints_cost_no_digits(factor, joint, measured):
    """At regular poses and where the joints' springs alone hold the platform, from weak springs to far stiffer ones."""
    for seed in (3, 4):
        hexapod = scaled_joints(sprung(machine(seed), np.random.default_rng(seed), suspension=seed == 4), factor)
        poses = np.concatenate([poses_about(hexapod, seed, 3), near_singular(hexapod, seed)])
        found = swept(hexapod, poses, joint, "omega_1")
        for i, pose in enumerate(poses):
            exact = exact_modes(hexapod, pose, joint == "universal")
            scale = EPS * exact.cond_B
            measured("sweeps/joint-springs", (found["omega"][i] / exact.omega - 1) / scale, 100)
            single = fx.natural_modes(hexapod, fx.Pose.from_rpy(*pose), joint=joint).omega
            measured("modes/joint-springs", (single / exact.omega - 1) / scale, 100)


LAWS = {
    "screw": {"fixed": [8e6, 9e6, 8e6, 8e6, 7e6, 8e6], "axial_rigidity": 2e7, "zero_length": 1.5},
    "hydraulic": {
        "bulk_modulus": 1.2e9,
        "area_1": 5e-3,
        "area_2": [3e-3, 3e-3, 3e-3, 2e-3, 3e-3, 3e-3],
        "dead_1": 0.1,
        "dead_2": 0.2,
        "stroke": 1.3,
        "shortest": 1.95,
    },
    "table": {"lengths": [1.9, 2.1, 2.3, 2.6, 3.0, 3.3], "stiffnesses": [9e6, 8.5e6, 7e6, 4e6, 3.9e6, 4.2e6]},
}


def with_law(kind: str, more=None) -> fx.Hexapod:
    law = {f"legs.stiffness_law.{key}": value for key, value in LAWS[kind].items()}
    return plain_machine("motion-base").replace(
        {"limits": None, "legs.stiffness": None, "legs.stiffness_law.kind": kind, **law, **(more or {})}
    )


def stiffness_of(kind: str, L: np.ndarray) -> np.ndarray:
    """The laws written out, (..., 6)."""
    p = {key: np.asarray(value, dtype=float) for key, value in LAWS[kind].items()}
    if kind == "screw":
        return 1 / (1 / p["fixed"] + (L - p["zero_length"]) / p["axial_rigidity"])
    if kind == "hydraulic":
        x = L - p["shortest"]
        columns = p["area_1"] / (x + p["dead_1"]) + p["area_2"] / (p["stroke"] - x + p["dead_2"])
        return p["bulk_modulus"] * columns
    return PchipInterpolator(p["lengths"], p["stiffnesses"])(L)


@pytest.mark.parametrize("series", [None, 2e7])
@pytest.mark.parametrize("kind", LAWS)
def test_frequencies_by_a_law_are_those_of_constants_at_each_pose(kind, series):
    hexapod = with_law(kind, {} if series is None else {"legs.series_stiffness": [series]})
    poses = poses_about(hexapod, 1, 40, 0.1, 0.1)
    found = swept(hexapod, poses, "universal", "omega_1")
    assert (found["status"] == 0).all()
    single = fx.natural_modes(hexapod, fx.Pose.from_rpy(*poses.T)).omega
    np.testing.assert_allclose(found["omega"], single, rtol=1e-12)
    plain = plain_machine("motion-base")
    for pose, omega in zip(poses, single, strict=True):
        k = stiffness_of(kind, fx.inverse_kinematics(plain, fx.Pose.from_rpy(*pose)))
        k = k if series is None else 1 / (1 / k + 1 / series)
        expected = fx.natural_modes(plain.replace({"legs.stiffness": k}), fx.Pose.from_rpy(*pose)).omega
        np.testing.assert_allclose(omega, expected, rtol=1e-12)


@pytest.mark.parametrize("kind", LAWS)
def test_a_pose_outside_a_law_has_a_status_and_alone_an_error(kind):
    hexapod = with_law(kind)
    poses = poses_about(hexapod, 2, 200, 0.5, 0.1)
    lengths = fx.inverse_kinematics(hexapod, fx.Pose.from_rpy(*poses.T))
    least, most = hexapod.legs.stiffness_law.range.T
    outside = ((lengths < least) | (lengths > most)).any(axis=1)
    found = swept(hexapod, poses, "universal", "omega_1", "lowest_stiffness", "leg_length")
    np.testing.assert_array_equal(found["status"] == OUTSIDE, outside)
    np.testing.assert_array_equal(np.isnan(found["omega"]).all(axis=1), outside)
    np.testing.assert_array_equal(np.isnan(found["lowest_stiffness"]), outside)
    np.testing.assert_allclose(found["leg_length"], lengths, rtol=1e-14)
    batch = fx.natural_modes(hexapod, fx.Pose.from_rpy(*poses.T)).omega
    np.testing.assert_array_equal(np.isnan(batch).all(axis=1), outside)
    if outside.any():
        with pytest.raises(fx.PoseError, match=f"stiffness_law \\({kind}\\) says nothing"):
            fx.natural_modes(hexapod, fx.Pose.from_rpy(*poses[np.argmax(outside)]))


@pytest.mark.parametrize("kind", LAWS)
def test_a_command_changes_the_force_as_the_tangent_says(kind):
    hexapod = with_law(kind)
    rest = fx.hold(hexapod, force=[1e4, -2e4, -5e4])
    linear = fx.linearise(hexapod, force=[1e4, -2e4, -5e4])
    np.testing.assert_allclose(
        stiffness_of(kind, rest.unstretched_length) * (rest.unstretched_length - rest.leg_length),
        rest.leg_force,
        rtol=1e-9,
    )
    np.testing.assert_allclose(linear.leg_stiffness, stiffness_of(kind, rest.unstretched_length), rtol=1e-12)

    def force(by):
        L_0 = rest.unstretched_length + by
        return stiffness_of(kind, L_0) * (L_0 - rest.leg_length)

    np.testing.assert_allclose(linear.command_stiffness, difference(force, 1e-4), rtol=1e-8)
    found = fx.static_equilibrium(hexapod, rest.unstretched_length, start=hexapod.home, force=[1e4, -2e4, -5e4])
    np.testing.assert_allclose(found.pose.position, hexapod.home.position, atol=1e-9)


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize(
    "hexapod", [sprung(machine(5), np.random.default_rng(5)), with_law("table")], ids=["joints", "law"]
)
def test_gradients_follow_joints_and_laws(hexapod, joint):
    poses = poses_about(hexapod, 3, 30, 0.05, 0.1)
    modes = swept(hexapod, poses, joint)["omega"]
    poses = poses[modes[:, 1] > 1.05 * modes[:, 0]][:12]
    found = swept(hexapod, poses, joint, "omega_1_gradient")["omega_1_gradient"]
    unit = np.repeat([size(hexapod), 1.0], 3)
    for k in range(6):
        step = np.zeros(6)
        step[k] = unit[k]
        slope = difference(lambda h, step=step: swept(hexapod, poses + h * step, joint)["omega"][:, 0], 1e-4)
        np.testing.assert_allclose(unit[k] * found[:, k], slope, atol=1e-7 * modes[:, 0].max())


def test_moments_of_sweeps_are_those_of_poses_and_their_limits():
    hexapod = sprung(machine(9), np.random.default_rng(9))
    poses = poses_about(hexapod, 4, 100)
    pose = fx.Pose.from_rpy(*poses.T)
    alone = fx.joint_moments(hexapod, pose)
    bend = np.linalg.norm(alone.universal_moment, axis=-1)
    found = fx.sweep(hexapod, poses, quantities=["universal_moment", "spherical_moment"])
    np.testing.assert_allclose(found.universal_moment, bend, rtol=1e-12)
    np.testing.assert_allclose(found.spherical_moment, alone.bending_moment, rtol=1e-12)
    limits = {"limits.universal_moment": float(np.median(bend.max(axis=1)))}
    limits["limits.spherical_moment"] = float(np.quantile(alone.bending_moment.max(axis=1), 0.7))
    limited = hexapod.replace(limits)
    within = fx.sweep(limited, poses, quantities="within_limits").within_limits.values
    np.testing.assert_array_equal(within, fx.check_limits(limited, pose).ok)
    assert 20 < within.sum() < 80
    words = fx.check_limits(limited, fx.Pose.from_rpy(*poses[np.argmin(within)])).exceeded
    assert any("joint moment" in line and line.endswith("N m") for line in words)


def test_worst_poses_keep_to_moments_and_to_a_law():
    law = with_law("hydraulic")
    box = fx.Workspace.about_home(0.6, 0.1)
    worst = fx.worst_pose(law, box, samples=2048, starts=2, all_poses=True)
    lengths = fx.inverse_kinematics(law, worst.pose)
    least, most = law.legs.stiffness_law.range.T
    assert worst.omega_1 > 1.0
    assert (lengths >= least - 1e-9).all()
    assert (lengths <= most + 1e-9).all()
    hexapod = sprung(machine(9), np.random.default_rng(9))
    bend = fx.joint_moments(hexapod, poses_about(hexapod, 5, 50)).bending_moment.max()
    limited = hexapod.replace({"limits.spherical_moment": 0.5 * float(bend)})
    kept = fx.worst_pose(limited, fx.Workspace.about_home(0.1 * size(hexapod), 0.2), samples=1024, starts=4)
    assert fx.joint_moments(limited, kept.pose).bending_moment.max() <= 0.5 * bend * (1 + 1e-6)


@pytest.mark.parametrize("joint", JOINTS)
def test_designs_side_by_side_are_those_alone(joint):
    base = sprung(machine(11), np.random.default_rng(11))
    designs = [scaled_joints(base, f) for f in (0.0, 0.1, 1.0, 3.0)]
    poses = poses_about(base, 6, 3)
    rows = np.stack([d.packed for d in designs])
    packed = fx.Pose.from_rpy(*poses.T).packed
    found = _core.sweep_designs(rows, _core.Joint[joint], np.ascontiguousarray(packed), False, 6, 1)
    for design, omega in zip(designs, found, strict=True):
        expected = fx.natural_modes(design, fx.Pose.from_rpy(*poses.T), joint=joint).omega
        np.testing.assert_allclose(omega, expected, rtol=1e-11)
    mixed = np.stack([with_law("screw").packed, with_law("table").packed])
    with pytest.raises(ValueError, match="laws of one kind"):
        _core.sweep_designs(mixed, _core.Joint[joint], np.ascontiguousarray(packed), False, 6, 1)
