"""Natural modes: their algebra, their accuracy, their sensitivities, and what is said about them."""

import numpy as np
import pytest
from hypothesis import given, settings
from tests.helpers.drawn import machines, situations
from tests.helpers.plain import plain_machine
from tests.helpers.support import EPS, JOINTS, MACHINES, apart, away, center, difference, displaced, size
from tests.oracles.exact import natural_frequencies

import flexapod as fx

both_models = pytest.mark.parametrize("joint", JOINTS)


def turned(hexapod, degrees: float) -> fx.Pose:
    """The middle of the workspace turned about z; at 90 degrees a symmetric machine is singular (Fichter)."""
    return displaced(center(hexapod), [0, 0, 0, 0, 0, np.radians(degrees)])


# --- algebra ----------------------------------------------------------------------------------------------------------


@both_models
@given(case=situations())
def test_modes_diagonalise_inertia_and_stiffness(joint, case):
    hexapod, pose, base = case.hexapod, case.platform.pose, case.base.pose
    omega, shape = fx.natural_modes(hexapod, pose, joint=joint, base=base)
    e = fx.equations_of_motion(hexapod, pose, base=base, joint=joint)
    K = e.H @ np.diag(hexapod.legs.stiffness) @ e.H.T
    assert (np.diff(omega) >= 0).all()
    # J_p's condition, up to 1e5 in mixed units, grows the rounding of its factor.
    np.testing.assert_allclose(shape.T @ e.J_p @ shape, np.eye(6), atol=100 * EPS * np.linalg.cond(e.J_p))
    np.testing.assert_allclose(
        shape.T @ K @ shape, np.diag(omega**2), atol=100 * EPS * np.linalg.cond(e.J_p) * omega[-1] ** 2
    )
    assert fx.stability_index(hexapod, pose, joint=joint, base=base) == omega[0]


@both_models
@given(case=situations())
def test_energy_shares_sum_to_one(joint, case):
    shares = fx.mechanics.energy_shares(case.hexapod, case.platform.pose, joint=joint, base=case.base.pose)
    assert shares.strain.shape == (6, 6)
    assert shares.kinetic.shape == (7, 6)
    np.testing.assert_allclose(shares.strain.sum(axis=0), 1, rtol=1e-14)
    # v^T J v = 1 to the rounding of modes, which J_p's condition grows.
    np.testing.assert_allclose(shares.kinetic.sum(axis=0), 1, atol=1e-9)
    assert (shares.strain >= 0).all()
    assert (shares.kinetic >= -1e-12).all()  # bodies that could be cast


def test_energy_shares_of_known_machines():
    cube = plain_machine("cubic-isolator").replace({"legs.lower": None, "legs.upper": None})
    shares = fx.mechanics.energy_shares(cube, center(cube))
    np.testing.assert_allclose(shares.kinetic[0], 1, rtol=1e-13)  # massless legs carry none
    omega = fx.natural_modes(cube, center(cube)).omega
    vertical = np.argmin(np.abs(omega - np.sqrt(2e4 / 20)))
    yaw = np.argmax(omega)
    for mode in (vertical, yaw):
        if mode == yaw:  # symmetric: every leg the same
            np.testing.assert_allclose(shares.strain[:, mode], 1 / 6, rtol=1e-9)
    batch = fx.mechanics.energy_shares(cube, fx.Pose(np.tile(center(cube).position, (4, 1))))
    assert batch.strain.shape == (4, 6, 6)
    assert batch.kinetic.shape == (4, 7, 6)


# --- accuracy ---------------------------------------------------------------------------------------------------------


@both_models
@pytest.mark.parametrize("name", ["motion-base", "precision-positioner", "cubic-isolator"])
@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
def test_frequencies_near_a_singular_pose_against_50_digits(name, joint, off, measured):
    """Turned to within `off` degrees of the singular pose: cond(B) up to 1e8 and more."""
    hexapod = plain_machine(name)
    pose = turned(hexapod, 90 - off)
    found = fx.natural_modes(hexapod, pose, joint=joint).omega
    expected = [float(w) for w in natural_frequencies(hexapod, pose, joint)]
    condition = found[-1] / found[0]
    assert condition > 1e3
    # What float64 allows: eps times the condition of B = L^-1 H K^1/2, whose singular values they are.
    measured("modes/near-singular", apart(found, expected) / (EPS * condition), 100)
    np.testing.assert_allclose(found[1:], expected[1:], rtol=1e-9)  # the others are not near zero


def test_near_singular_conditions_span_what_is_promised():
    conditions = [
        np.divide(
            *fx.natural_modes(plain_machine("motion-base"), turned(plain_machine("motion-base"), 90 - off)).omega[
                [-1, 0]
            ]
        )
        for off in (1e-2, 1e-4, 1e-6)
    ]
    assert conditions[0] < 2e4
    assert conditions[-1] > 1e8


@both_models
@pytest.mark.parametrize("name", MACHINES)
def test_frequencies_at_ordinary_poses_against_50_digits(name, joint, measured):
    hexapod = plain_machine(name)
    for pose in (center(hexapod), away(hexapod)):
        found = fx.natural_modes(hexapod, pose, joint=joint).omega
        expected = [float(w) for w in natural_frequencies(hexapod, pose, joint)]
        measured("modes/ordinary", apart(found, expected) / (EPS * found[-1] / found[0]), 100)


@both_models
@pytest.mark.parametrize("name", ["motion-base", "precision-positioner", "cubic-isolator"])
def test_index_is_zero_at_a_singular_pose(name, joint):
    hexapod = plain_machine(name)
    omega = fx.natural_modes(hexapod, turned(hexapod, 90), joint=joint).omega
    assert omega[0] < 100 * EPS * omega[-1]  # rounding of B
    assert omega[1] > 1e-3 * omega[-1]
    assert fx.condition_number(hexapod, turned(hexapod, 90)) > 1e14
    shares = fx.mechanics.energy_shares(hexapod, turned(hexapod, 90), joint=joint)
    np.testing.assert_allclose(shares.kinetic.sum(axis=0), 1, atol=1e-9)


# --- sensitivities ----------------------------------------------------------------------------------------------------

SMALL = 1e-4  # relative step


def frequencies_of(hexapod, pose, joint, key, direction, step):
    """omega as a function of how far `key` is moved along `direction`."""

    def omega(t):
        values = hexapod.values()
        moved = fx.Hexapod.from_values(values | {key: values[key] + t * direction})
        return fx.natural_modes(moved, pose, joint=joint).omega

    return difference(omega, step)


def slope_error(found, expected, omega):
    """Against fourth-order differences, per relative change of the number; to be below 1e-8.

    Truncation is 1e-16 times the fifth derivative's factor, which near-equal frequencies make large; rounding is eps
    times cond(B) over the step of 1e-4.
    """
    return np.abs(found - expected) / (omega + 10 * np.abs(expected))


def directions(shape):
    for index in np.ndindex(shape):
        direction = np.zeros(shape)
        direction[index] = 1
        yield index, direction


@both_models
@pytest.mark.parametrize("name", ["mukherjee-i", "motion-base"])
def test_sensitivities_are_derivatives(name, joint, measured):
    hexapod = plain_machine(name)
    pose = away(hexapod)
    found = fx.frequency_sensitivity(hexapod, pose, joint=joint)
    omega, length = fx.natural_modes(hexapod, pose, joint=joint).omega, size(hexapod)
    mass, k = hexapod.platform_mass, hexapod.legs.stiffness[0]
    cases = [
        ("platform.mass", found.platform_mass, mass),
        ("platform.mass_center", found.platform_mass_center, length),
        ("legs.stiffness", found.stiffness, k),
        ("base.joints", found.base_joints, length),
        ("platform.joints", found.platform_joints, length),
        ("legs.lower.mass", found.lower_mass, mass),
        ("legs.upper.mass", found.upper_mass, mass),
    ]
    for key, derivative, scale in cases:
        assert derivative.shape == (6, *hexapod.values()[key].shape), key
        for index, direction in directions(hexapod.values()[key].shape):
            expected = frequencies_of(hexapod, pose, joint, key, direction, SMALL * scale)
            measured("modes/sensitivities", slope_error(derivative[:, *index] * scale, expected * scale, omega), 1e-8)


@both_models
@pytest.mark.parametrize("name", ["mukherjee-i", "motion-base"])
def test_sensitivities_to_inertia_and_pose(name, joint, measured):
    hexapod = plain_machine(name)
    pose = away(hexapod)
    found = fx.frequency_sensitivity(hexapod, pose, joint=joint)
    omega = fx.natural_modes(hexapod, pose, joint=joint).omega
    scale = np.trace(hexapod.platform_inertia) / 3
    for i in range(3):
        for j in range(i, 3):
            twins = np.zeros((3, 3))
            twins[i, j] = twins[j, i] = 1
            expected = frequencies_of(hexapod, pose, joint, "platform.inertia", twins, SMALL * scale)
            for derivative in (found.platform_inertia[:, i, j], found.platform_inertia[:, j, i]):
                measured("modes/sensitivities", slope_error(derivative * scale, expected * scale, omega), 1e-8)
    for i, reach in enumerate(np.repeat([size(hexapod), 1.0], 3)):
        expected = difference(
            lambda t, i=i: fx.natural_modes(hexapod, displaced(pose, t * np.eye(6)[i]), joint=joint).omega,
            SMALL * reach,
        )
        measured("modes/sensitivities", slope_error(found.pose[:, i] * reach, expected * reach, omega), 1e-8)


@settings(max_examples=10)
@given(hexapod=machines())
def test_sensitivities_obey_the_scaling_laws(hexapod, measured):
    """omega is of degree one half in stiffness; moving base and platform as one changes nothing."""
    pose = center(hexapod)
    found, omega = fx.frequency_sensitivity(hexapod, pose), fx.natural_modes(hexapod, pose).omega
    # Euler's theorem for homogeneous functions; the derivatives are exact to the rounding of the modes.
    measured("modes/stiffness-law", apart(found.stiffness @ hexapod.legs.stiffness, omega / 2), 1e-8)
    moved = found.pose[:, :3] + found.base_joints.sum(axis=1)
    np.testing.assert_allclose(moved, 0, atol=1e-8 * omega[-1] / size(hexapod))


def test_sensitivity_at_a_singular_pose_is_nan_only_for_the_lost_frequency():
    hexapod = plain_machine("cubic-isolator").replace({"legs.lower": None, "legs.upper": None})
    found = fx.frequency_sensitivity(hexapod, turned(hexapod, 90))
    assert np.isfinite(found.platform_mass[1:]).all()


# --- words ------------------------------------------------------------------------------------------------------------


def test_modes_of_a_cube_in_words():
    """Massless legs, mass centre at the cube's centre: pure rotations, and translations alike in all directions."""
    hexapod = plain_machine("cubic-isolator").replace(
        {"legs.lower": None, "legs.upper": None, "platform.inertia": np.diag([0.25, 0.28, 0.4])}
    )
    found = fx.describe_modes(hexapod, center(hexapod))
    for mode in found:
        np.testing.assert_allclose(mode.share.sum(), 1, rtol=1e-12)
        if mode.dominant in ("x", "y", "z"):
            assert np.isnan(mode.center).all()
            assert "turning" not in mode.text
    turning = {m.dominant: m for m in found if m.dominant in ("roll", "pitch", "yaw")}
    for i, name in enumerate(("roll", "pitch", "yaw")):
        assert turning[name].text.startswith(f"mostly {name} (100%)")
        np.testing.assert_allclose(turning[name].center, center(hexapod).position, atol=1e-9)
        np.testing.assert_allclose(np.abs(turning[name].axis), np.eye(3)[i], atol=1e-9)
        assert turning[name].share[3 + i] == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("name", ["precision-positioner", "cubic-isolator"])
def test_yaw_of_a_symmetric_machine_turns_about_its_axis(name):
    hexapod = plain_machine(name)
    found = {m.dominant: m for m in fx.describe_modes(hexapod, center(hexapod))}
    yaw, heave = found["yaw"], found["z"]
    np.testing.assert_allclose(np.abs(yaw.axis), [0, 0, 1], atol=1e-8)  # modes are exact to eps cond(B)
    np.testing.assert_allclose(yaw.center[:2], 0, atol=1e-8)
    assert yaw.text.startswith("mostly yaw (100%)")
    assert heave.text == "mostly z (100%)"
    assert np.isnan(heave.center).all()
    assert heave.pitch == np.inf


@given(case=situations())
def test_description_is_the_mode(case):
    """Axis, centre and pitch give the mode's twist back."""
    hexapod, pose, base = case.hexapod, case.platform.pose, case.base.pose
    shape = fx.natural_modes(hexapod, pose, base=base).shape
    for mode, twist in zip(fx.describe_modes(hexapod, pose, base=base), shape.T, strict=True):
        spin = twist[3:] @ mode.axis
        velocity = spin * (mode.pitch * mode.axis - np.cross(mode.axis, mode.center - pose.position))
        np.testing.assert_allclose(spin * mode.axis, twist[3:], atol=1e-12 * np.linalg.norm(twist[3:]))
        np.testing.assert_allclose(velocity, twist[:3], atol=1e-9 * np.linalg.norm(twist[:3]))
        nearest = mode.center - (pose.position + pose.matrix @ hexapod.platform_mass_center)
        assert abs(nearest @ mode.axis) < 1e-9 * max(1.0, np.linalg.norm(nearest))
        assert mode.share.sum() == pytest.approx(1, abs=1e-9)
        assert f"{mode.dominant} ({mode.share.max():.0%})" in mode.text


def test_near_repeated_modes():
    assert fx.mechanics.near_repeated(np.array([1.0, 1.005, 2.0, 3.0, 3.0, 4.0])) == [(0, 1), (3, 4)]
    assert fx.mechanics.near_repeated(np.array([1.0, 1.005, 2.0, 3.0, 3.0, 4.0]), gap=0.004) == [(3, 4)]
    two = fx.natural_modes(fx.load("mukherjee-ii"), fx.Pose([0, 0, 0.085])).omega
    assert fx.mechanics.near_repeated(two) == [
        (0, 1),
        (4, 5),
    ]  # the paper's Fig. 7 counts the first two as one resonance


def test_sampling_time():
    """The paper's conclusion 3: twenty samples in the shortest period."""
    assert fx.control.sampling_time(16208.1) == pytest.approx(2 * np.pi / 16208.1 / 20, rel=1e-15)


@both_models
def test_modes_do_not_depend_on_friction_gravity_or_where_the_base_stands(joint):
    hexapod = fx.load("mukherjee-i")
    pose = away(hexapod)
    omega = fx.natural_modes(hexapod, pose, joint=joint).omega
    other = hexapod.replace({"gravity": [1, 2, 3], "legs.damping.prismatic": 9.0, "legs.damping.universal": 9.0})
    np.testing.assert_array_equal(fx.natural_modes(other, pose, joint=joint).omega, omega)
    base = displaced(fx.Pose([1, -2, 3]), [0, 0, 0, 0.4, 0.5, -0.6])
    outer = fx.Pose(base.position + base.matrix @ pose.position, base.matrix @ pose.matrix)
    # Other sums, other rounding: eps times cond(B), 1e2.
    np.testing.assert_allclose(fx.natural_modes(hexapod, outer, joint=joint, base=base).omega, omega, rtol=1e-12)
