"""Machines whose legs meet at common joints: 6-3, 3-3, and the cube with full edges."""

import json
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.helpers.support import apart

import flexapod as fx
from flexapod.design.layout import PLACES, SIZE, numbers
from flexapod.mechanics.inputs import as_joint
from flexapod.optimisation.derivatives import DesignDerivatives

CASES = Path(__file__).parents[1] / "data" / "cases"
GENHEX = CASES / "coincident-joints" / "genhex.toml"
OCTAHEDRON = CASES / "faults" / "octahedron-3-3.toml"
CUBE = CASES / "faults" / "cubic-full-edges.toml"
THREE = CASES / "three-three" / "three-three.toml"
SHARED = "Joints coincide: legs 1 and 6, 2 and 3, 4 and 5 on the base"


def rows_about(hexapod, count=20, seed=1):
    """Poses about home: x, y, z in m, roll, pitch, yaw in rad."""
    home = np.concatenate([hexapod.home.position, hexapod.home.rpy])
    return home + np.random.default_rng(seed).uniform(-0.05, 0.05, (count, 6))


def distance_of(hexapod, pose, i, j):
    """Of two legs that may share joints: in 200 000 steps along one of them, or from the joints that are not shared."""
    lower = hexapod.base_joints
    upper = hexapod.platform_joints @ pose.matrix.T + pose.position
    base, platform = (np.allclose(joints[i], joints[j], atol=1e-12) for joints in (lower, upper))
    if base or platform:
        mine = upper if base else lower
        return min(to_segment(mine[i], lower[j], upper[j]), to_segment(mine[j], lower[i], upper[i]))
    steps = np.linspace(0, 1, 20001)[:, None]
    return to_segment(lower[i] + steps * (upper[i] - lower[i]), lower[j], upper[j]).min()


def to_segment(x, one, other):
    b = other - one
    t = np.clip((x - one) @ b / (b @ b), 0, 1)
    return np.linalg.norm(x - one - np.multiply.outer(t, b), axis=-1)


def test_frequencies_of_a_six_three_machine():
    omega = fx.natural_modes(fx.load(GENHEX)).omega
    np.testing.assert_allclose(omega, [1339.672, 1339.684, 1729.102, 1953.426, 1953.480, 2344.706], atol=6e-4, rtol=0)


def test_frequencies_of_the_full_cube_are_in_closed_form():
    """K = diag(2k, 2k, 2k, k a^2 / 2 twice, 2 k a^2) about the centre, with edge a."""
    omega = fx.natural_modes(fx.load(CUBE)).omega
    k, m, edge = 1e7, 10.0, 0.5
    turning = np.sqrt([k * edge**2 / 2 / 0.1] * 2 + [2 * k * edge**2 / 0.2])
    np.testing.assert_allclose(omega, [*[np.sqrt(2 * k / m)] * 3, *turning], rtol=1e-12)


@pytest.mark.parametrize(("y", "z", "index"), [(-2.76191, 5.31148, 32.029), (-5.90098, 1.00916, 61.332)])
def test_assemblies_of_a_three_three_machine(y, z, index):
    hexapod = fx.load(THREE)
    lengths = np.array([6, 12, 7, 11, 13, 9.0])
    found = []
    for side, *tilt in np.random.default_rng(0).uniform(-np.pi, np.pi, (60, 4)):
        with suppress(fx.KinematicsError):
            start = fx.Pose.from_rpy(-0.4, y, np.copysign(z, side), *tilt)
            found.append(fx.forward_kinematics(hexapod, lengths, start=start))
    near = [pose for pose in found if np.allclose(np.abs(pose.position), np.abs([-0.4, y, z]), atol=6e-6)]
    assert {bool(pose.position[2] > 0) for pose in near} == {True, False}  # both mirror images
    for pose in near:
        np.testing.assert_allclose(fx.inverse_kinematics(hexapod, pose), lengths, rtol=1e-12)
        assert fx.stability_index(hexapod, pose) == pytest.approx(index, abs=6e-4)


@pytest.mark.parametrize("state", range(4))
def test_published_dynamics_with_joints_that_coincide(state):
    """Taghirad's 6-3 machine: the mass matrix and leg forces of his programs, with the joints where they are."""
    folder = CASES / "taghirad"
    text = (folder / "taghirad.toml").read_text().replace("30.0000002, 150, 150.0000002, 270, 270.0000002", "X")
    hexapod = fx.Hexapod.from_toml(text.replace("X", "30, 150, 150, 270, 270"))
    assert "1 and 2, 3 and 4, 5 and 6 on the platform" in hexapod.warnings[0]
    given = json.loads((folder / "expected.json").read_text())["states"][state]
    vectors = [np.array(given[name]) for name in ("position", "euler_zyx_alpha_beta_gamma")]
    pose = fx.Pose.from_rpy(*vectors[0], *vectors[1])
    names = ("velocity", "angular_velocity", "acceleration", "angular_acceleration")
    motion = fx.Motion(pose, *(np.array(given[name]) for name in names))
    force = fx.inverse_dynamics(hexapod, motion, joint="spin_free")
    assert apart(force, given["leg_forces"], floor=1.0) < 1e-7
    J = fx.equations_of_motion(hexapod, pose, joint="spin_free").J_p
    assert np.abs(J - given["M_twist"]).max() < 1e-6 * np.abs(J).max()


@pytest.mark.parametrize("file", [GENHEX, OCTAHEDRON, CUBE], ids=lambda file: file.stem)
def test_distance_leaves_the_common_joint_out(file):
    hexapod = fx.load(file)
    rows = rows_about(hexapod)
    poses = fx.Pose.from_rpy(*rows.T)
    found = fx.mechanics.leg_distance(hexapod, poses)
    pairs = [(i, j) for i in range(5) for j in range(i + 1, 6)]
    expected = [min(distance_of(hexapod, pose, i, j) for i, j in pairs) for pose in poses]
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    swept = fx.sweep(hexapod, rows, quantities=("leg_distance", "within_limits"))
    np.testing.assert_allclose(swept.leg_distance, found, rtol=1e-12)
    between = sorted(found)[8:10]  # the distance of two joints of genhex's platform is the same at all poses
    if np.ptp(between) > 1e-9:
        limited = hexapod.replace({"limits.leg_distance": float(np.mean(between))})
        kept = fx.sweep(limited, rows, quantities=("within_limits",)).within_limits.values
        assert kept.sum() == fx.check_limits(limited, poses).ok.sum() == 11


def test_derivatives_of_the_distance_of_legs_that_meet():
    hexapod = fx.load(OCTAHEDRON)
    rows = rows_about(hexapod, 3)
    start, step = numbers(hexapod), 1e-6
    towards = np.zeros((SIZE, 1))
    towards[PLACES["platform.joints"][[0, 1], 2]] = 1.0  # of legs 1 and 2, which share them: they stay together

    def pairs(by):
        at = DesignDerivatives(start + by * towards[:, 0], towards, rows, False, as_joint("universal"))
        return at.leg_distance

    value, slope = pairs(0.0)
    assert np.isfinite(slope).all()
    assert (value > 0.1).all()
    np.testing.assert_allclose(slope[..., 0], (pairs(step)[0] - pairs(-step)[0]) / (2 * step), atol=1e-8)


def test_legs_that_share_both_joints_are_singular_and_named(run):
    joints = fx.load(OCTAHEDRON).platform_joints.copy()
    joints[5] = joints[0]  # legs 1 and 6 share a joint on the base already
    twice = fx.load(OCTAHEDRON).replace({"platform.joints": joints})
    assert twice.warnings[0].startswith("Legs 1 and 6 share both joints: they are one leg twice")
    assert "singular at every pose" in twice.warnings[0]
    assert fx.mechanics.leg_distance(twice) == 0
    assert fx.stability_index(twice) < 1e-5
    code, out, _ = run("check", str(OCTAHEDRON), "--set", f"platform.joints={joints.tolist()}")
    assert code == 0
    assert "Legs 1 and 6 share both joints" in out


@pytest.mark.parametrize("plate", ["base", "platform"])
def test_all_joints_of_a_plate_in_one_place_are_refused(plate):
    with pytest.raises(fx.DesignError, match=rf"{plate}.joints\[0\] to {plate}.joints\[5\] coincide") as caught:
        fx.load(GENHEX).replace({f"{plate}.joints": [[0.1, 0.2, 0.3]] * 6, "base.universal_axes": [[1, 0, 0]] * 6})
    assert "three places" in str(caught.value)


def test_numbers_of_legs_that_meet_stand_together():
    texts = [text.get_text() for text in fx.plots.machine(fx.load(OCTAHEDRON)).texts]
    assert [text for text in texts if text[0].isdigit()] == ["1, 6", "2, 3", "4, 5"]
    texts = [text.get_text() for text in fx.plots.machine(plain_machine("motion-base")).texts]
    assert [text for text in texts if text[0].isdigit()] == list("123456")
