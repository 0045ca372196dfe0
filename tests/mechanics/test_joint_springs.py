"""Springs in the joints, a suspension and springs in series: against Pinocchio, energies and limits."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from scipy.spatial.transform import Rotation
from tests.helpers.drawn import machine, machines, seeds, sprung
from tests.helpers.plain import plain_machine
from tests.helpers.states import State, draw_state, perturbed
from tests.helpers.support import JOINTS, away, difference, displaced, relative, size
from tests.oracles import chain_springs
from tests.oracles.closed_chain import ClosedChain

import flexapod as fx
from flexapod.mechanics.springs import axial_stiffness, spring_matrix


def drawn_machine(seed: int) -> fx.Hexapod:
    return sprung(machine(seed), np.random.default_rng([seed, 14]))


@cache
def twenty(block: int, suspension: bool = True, moving_base: bool = True) -> list[tuple[fx.Hexapod, State]]:
    """Sprung machines, each with a state; those that stand near a singular pose at home are passed over."""
    found, seed = [], 100 * block
    while len(found) < 20:
        hexapod = sprung(machine(seed), np.random.default_rng([seed, 14]), suspension)
        seed += 1
        try:
            state = draw_state(hexapod, np.random.default_rng([seed, 15]), moving_base)
        except AssertionError:
            continue
        found.append((hexapod, state))
    return found


def free(hexapod: fx.Hexapod) -> fx.Hexapod:
    return hexapod.replace({"gravity": [0.0, 0.0, 0.0]})


# --- against the closed chain of Pinocchio --------------------------------------------------------------------------


@pytest.mark.parametrize("block", range(10))
def test_two_hundred_machines_move_as_the_engine_says(block, measured):
    for hexapod, state in twenty(block):
        expected = ClosedChain(hexapod).acceleration(state.platform, state.base, **state.loads)
        found = fx.forward_dynamics(hexapod, state.platform, base=state.base, joint="universal", **state.loads)
        measured("springs/engine", [relative(f, e) for f, e in zip(found, expected, strict=True)], 1e-10)


@pytest.mark.parametrize("block", range(10))
def test_two_hundred_machines_vibrate_as_the_engine_says(block, measured):
    for hexapod, state in twenty(block, suspension=False, moving_base=False):
        chain = ClosedChain(hexapod)
        axial = 1 / (1 / hexapod.legs.stiffness + hexapod.legs.series_compliance)
        K = chain.stiffness_matrix(state.platform, state.base, axial)
        M = chain.mass_matrix(state.platform, state.base)
        root = np.linalg.inv(np.linalg.cholesky(M))
        expected = np.sqrt(np.linalg.eigvalsh(root @ K @ root.T))
        measured(
            "springs/frequencies", np.abs(fx.natural_modes(hexapod, state.platform.pose).omega / expected - 1), 1e-10
        )


@pytest.mark.parametrize("block", range(10))
def test_two_hundred_machines_have_the_engines_joint_moments(block, measured):
    for hexapod, state in twenty(block):
        pose, base = state.platform.pose, state.base.pose
        found = fx.joint_moments(hexapod, pose, base=base)
        turn, tilt = chain_springs.universal_angles(hexapod, pose, base).T
        bends = [chain_springs.bend_and_twist(chain_springs.platform_turn(hexapod, i, pose, base)) for i in range(6)]
        bend, twist = np.array(bends).T
        # the tilt out of the plane normal to k is a turn against y
        expected = [np.stack([turn, -tilt], axis=1), bend, twist]
        angles = [found.universal_angle, found.bending_angle, found.torsion_angle]
        measured("springs/angles", [relative(f, e) for f, e in zip(angles, expected, strict=True)], 1e-10)
        springs = hexapod.legs.joint_stiffness
        np.testing.assert_allclose(found.universal_moment, springs.universal * found.universal_angle, rtol=1e-15)
        np.testing.assert_allclose(found.bending_moment, springs.spherical * found.bending_angle, rtol=1e-15)
        np.testing.assert_allclose(found.torsion_moment, springs.torsion * found.torsion_angle, rtol=1e-15)


@pytest.mark.parametrize("name", ["mukherjee-i", "motion-base"])
def test_joints_carry_what_the_engine_says(name, measured):
    rng = np.random.default_rng(12)
    for _ in range(10):
        hexapod = perturbed(plain_machine(name), rng)
        home = draw_state(hexapod, rng, moving_base=False).platform.pose
        hexapod = sprung(hexapod.replace({"home.position": home.position, "home.orientation": home.rpy}), rng)
        state, chain = draw_state(hexapod, rng), ClosedChain(hexapod)
        expected = chain.joint_forces(state.platform, state.base, **state.loads)
        linear, angular = chain.acceleration(state.platform, state.base, **state.loads)
        motion = fx.Motion(
            state.platform.pose, state.platform.velocity, state.platform.angular_velocity, linear, angular
        )
        found = fx.joint_reactions(hexapod, motion, base=state.base, leg_force=state.leg_force, section=1.0)
        for field in expected._fields:
            sign = -1.0 if field.startswith(("spherical", "universal")) else 1.0
            measured("springs/reactions", relative(getattr(found, field), sign * getattr(expected, field)), 1e-10)


# --- energies and their derivatives ---------------------------------------------------------------------------------


@pytest.mark.parametrize("joint", JOINTS)
@given(hexapod=machines(), seed=seeds)
def test_forces_are_the_derivatives_of_the_energy_at_any_rotation(joint, hexapod, seed):
    rng = np.random.default_rng(seed)
    hexapod = free(sprung(hexapod, rng))
    turn = Rotation.from_rotvec(rng.normal(size=3))
    base = fx.Pose(rng.normal(size=3), turn)
    seen = displaced(away(hexapod, 0.1), np.concatenate([np.zeros(3), 0.7 * rng.normal(size=3)]))
    pose = fx.Pose(base.position + turn.as_matrix() @ seen.position, base.matrix @ seen.matrix)
    try:
        L_0 = fx.inverse_kinematics(hexapod, pose, base=base) * rng.uniform(0.97, 1.03, 6)
    except fx.errors.PoseError:  # a leg along its axis
        return

    def energy(x, of_base: bool) -> float:
        moved = displaced(base if of_base else pose, x)
        p, b = (pose, moved) if of_base else (moved, base)
        return float(fx.energy(hexapod, p, base=b, unstretched_length=L_0, joint=joint).elastic)

    length = size(hexapod)
    unit = np.array([length] * 3 + [1.0] * 3)  # in which energies change by their own size
    slopes = [
        np.array([difference(lambda h, x=x, of=of_base: energy(h * unit * x, of), 1e-4) for x in np.eye(6)])
        for of_base in (False, True)
    ]
    force = axial_stiffness(hexapod, L_0)[0] * (L_0 - fx.inverse_kinematics(hexapod, pose, base=base))
    equations = fx.equations_of_motion(hexapod, pose, base=base, joint=joint)
    on_platform = equations.H @ force - equations.eta
    found = fx.joint_reactions(hexapod, pose, base=base, leg_force=force, joint=joint)
    on_base = np.concatenate([found.base_force, found.base_moment])
    scale = energy(np.zeros(6), False)
    assert np.abs(slopes[0] + unit * on_platform).max() < 1e-8 * (scale + np.abs(slopes[0]).max())
    assert np.abs(slopes[1] + unit * on_base).max() < 1e-8 * (scale + np.abs(slopes[1]).max())
    rest = np.cross(pose.position - base.position, on_platform[:3])
    total = np.concatenate([on_platform[:3] + on_base[:3], on_platform[3:] + rest + on_base[3:]])
    assert np.abs(unit * total).max() < 1e-10 * (scale + np.abs(slopes[0]).max())  # the springs are inside the machine


@pytest.mark.parametrize("joint", JOINTS)
@given(hexapod=machines(), seed=seeds)
def test_the_tangent_where_nothing_is_stressed_is_the_stiffness_of_eq_5(joint, hexapod, seed):
    hexapod = free(sprung(hexapod, np.random.default_rng(seed)))
    linear = fx.linearise(hexapod, hexapod.rest, joint=joint)
    assert relative(linear.K, linear.springs @ linear.springs.T) < 1e-12
    assert relative(linear.K @ linear.carry, -linear.K_b) < 1e-9  # a rigid motion of all strains nothing


@pytest.mark.parametrize("joint", JOINTS)
@given(hexapod=machines(), seed=seeds)
def test_the_tangent_is_symmetric_under_preload_and_its_derivative_is_that_of_the_force(joint, hexapod, seed):
    hexapod = sprung(hexapod, np.random.default_rng(seed))
    pose = away(hexapod)
    linear = fx.linearise(hexapod, pose, joint=joint)
    scale = np.sqrt(np.outer(np.diag(linear.K), np.diag(linear.K)).clip(0))
    if joint == "universal":  # in the other model legs whose mass is off their axis weigh without a potential
        assert np.abs((linear.K - linear.K.T) / scale.max()).max() < 1e-12


@given(hexapod=machines(), seed=seeds)
def test_shares_of_energy_are_those_of_the_springs(hexapod, seed):
    hexapod = sprung(hexapod, np.random.default_rng(seed))
    pose = away(hexapod)
    shares, modes = fx.mechanics.energy_shares(hexapod, pose), fx.natural_modes(hexapod, pose)
    total = shares.strain.sum(axis=0) + shares.joints.sum(axis=0) + shares.suspension
    np.testing.assert_allclose(total, 1.0, rtol=1e-12)
    by = fx.frequency_sensitivity(hexapod, pose).springs
    springs = hexapod.legs.joint_stiffness
    of_joints = (
        2
        / modes.omega[:, None]
        * (
            (by["legs.joint_stiffness.universal"] * springs.universal).sum(axis=2)
            + by["legs.joint_stiffness.spherical"] * springs.spherical
            + by["legs.joint_stiffness.torsion"] * springs.torsion
        )
    )  # omega^2 is the sum of stiffnesses times its derivatives
    np.testing.assert_allclose(of_joints, shares.joints.T, rtol=1e-9, atol=1e-13)
    lower = np.tril(np.ones((6, 6)))
    of_suspension = (
        2 / modes.omega * (lower * by["suspension.stiffness"] * hexapod.suspension.stiffness).sum(axis=(1, 2))
    )
    np.testing.assert_allclose(of_suspension, shares.suspension, rtol=1e-9, atol=1e-12)


# --- limits ---------------------------------------------------------------------------------------------------------


@given(hexapod=machines())
def test_without_stiffness_nothing_changes_in_the_last_bit(hexapod):
    none = hexapod.replace({"legs.joint_stiffness.universal": 0.0, "legs.joint_rest.position": [0.0, 0.0, 1.0]})
    pose = away(hexapod)
    assert spring_matrix(none, pose).shape == (6, 6)
    np.testing.assert_array_equal(fx.natural_modes(none, pose).omega, fx.natural_modes(hexapod, pose).omega)
    found, expected = fx.linearise(none, pose), fx.linearise(hexapod, pose)
    for name in ("M", "C", "K", "M_b", "C_b", "K_b", "H", "springs", "command_stiffness"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
    quantities = ("omega", "cond_H", "leg_force", "lowest_stiffness")
    found, expected = (fx.sweep(machine, pose, quantities=quantities) for machine in (none, hexapod))
    for name in quantities:
        np.testing.assert_array_equal(found[name], expected[name])
    found, expected = fx.frequency_sensitivity(none, pose), fx.frequency_sensitivity(hexapod, pose)
    for by, as_before in zip(found[:-1], expected[:-1], strict=True):
        np.testing.assert_array_equal(by, as_before)
    np.testing.assert_array_equal(
        fx.inverse_dynamics(none, pose, moment=[1, 2, 3]), fx.inverse_dynamics(hexapod, pose, moment=[1, 2, 3])
    )


@given(hexapod=machines())
def test_weak_springs_change_frequencies_by_their_derivative(hexapod):
    """The derivatives by stiffnesses that are not there."""
    pose = away(hexapod)
    omega, by = fx.natural_modes(hexapod, pose).omega, fx.frequency_sensitivity(hexapod, pose).springs
    weak = 1e-7 * hexapod.legs.stiffness.mean() * size(hexapod) ** 2
    for name, place in (("universal", (3, 1)), ("spherical", (0,)), ("torsion", (5,))):
        key = f"legs.joint_stiffness.{name}"
        stiffness = np.zeros(by[key].shape[1:])
        stiffness[place] = weak
        more = fx.natural_modes(hexapod.replace({key: stiffness}), pose).omega
        np.testing.assert_allclose(more - omega, weak * by[key][:, *place], rtol=1e-3, atol=1e-9 * omega[5])


def test_joints_of_endless_stiffness_lock():
    """Two legs' torsion and bending without end hold the platform where it is, and frequencies grow with the root."""
    hexapod = machine(3)
    pose, found = away(hexapod), []
    for stiffness in (1e16, 1e18):
        locked = hexapod.replace(
            {f"legs.joint_stiffness.{name}": stiffness for name in ("universal", "spherical", "torsion")}
        )
        found.append(fx.natural_modes(locked, pose).omega)
    np.testing.assert_allclose(found[1] / found[0], 10.0, rtol=1e-6)


@pytest.mark.parametrize("joint", JOINTS)
def test_a_turned_and_moved_machine_bears_the_same(joint):
    hexapod = drawn_machine(7)
    pose = away(hexapod)
    turn, shift = Rotation.from_rotvec([0.4, -1.1, 0.7]), np.array([3.0, -2.0, 5.0])
    base = fx.Pose(shift, turn)
    moved = fx.Pose(shift + turn.as_matrix() @ pose.position, turn.as_matrix() @ pose.matrix)
    one, other = (fx.joint_moments(hexapod, p, base=b, joint=joint) for p, b in ((pose, None), (moved, base)))
    for a, b in zip(one, other, strict=True):
        np.testing.assert_allclose(b, a, rtol=1e-11, atol=1e-12 * np.abs(a).max())
    omegas = [fx.natural_modes(hexapod, p, base=b, joint=joint).omega for p, b in ((pose, None), (moved, base))]
    np.testing.assert_allclose(*omegas, rtol=1e-12)


# --- closed forms ---------------------------------------------------------------------------------------------------


def test_a_suspension_alone_holds_the_platform_at_its_own_frequencies():
    """Legs of nearly no stiffness and no mass: the platform on the suspension, at its mass centre."""
    hexapod = plain_machine("cubic-isolator")
    k = np.array([1e4, 2e4, 4e4, 50.0, 70.0, 90.0])
    inertia = np.diag([0.02, 0.03, 0.05])
    alone = hexapod.replace(
        {
            "legs.stiffness": 1e-9,
            "legs.lower": None,
            "legs.upper": None,
            "platform.mass_center": [0, 0, 0],
            "platform.inertia": inertia,
            "suspension.stiffness": np.diag(k),
        }
    )
    expected = np.sqrt(k / np.concatenate([[alone.platform_mass] * 3, np.diag(inertia)]))
    np.testing.assert_allclose(fx.natural_modes(alone).omega, np.sort(expected), rtol=1e-10)


def test_flexures_of_upright_legs_are_guided_beams():
    """Six parallel legs: a platform that moves across them bends both joints of each, (k_u + k_s) / L^2 for each leg.

    Turned about the legs it twists them and moves their ends across at the radius r, 6 (k_t + r^2 (k_u + k_s) / L^2).
    """
    angle = np.radians([0, 60, 120, 180, 240, 300])
    ring = np.stack([0.3 * np.cos(angle), 0.3 * np.sin(angle), np.zeros(6)], axis=1)
    L, mass, inertia, k_u, k_s, k_t = 0.5, 10.0, np.array([0.4, 0.5, 0.6]), 15.0, 20.0, 10.0
    upright = plain_machine("cubic-isolator").replace(
        {
            "base.joints": ring,
            "platform.joints": ring,
            "base.universal_axes": np.tile([1.0, 0.0, 0.0], (6, 1)),
            "platform.mass": mass,
            "platform.mass_center": [0, 0, 0],
            "platform.inertia": np.diag(inertia),
            "legs.lower": None,
            "legs.upper": None,
            "home.position": [0, 0, L],
            "limits": None,
            "legs.joint_stiffness.universal": k_u,
            "legs.joint_stiffness.spherical": k_s,
            "legs.joint_stiffness.torsion": k_t,
        }
    )
    across = 6 * (k_u + k_s) / L**2
    F = spring_matrix(upright)
    K = F @ F.T
    np.testing.assert_allclose(np.diag(K)[:2], across, rtol=1e-12)
    about = 6 * k_t + 0.3**2 * across
    np.testing.assert_allclose(K[5, 5], about, rtol=1e-12)
    omega = fx.natural_modes(upright).omega
    assert np.min(np.abs(omega / np.sqrt(about / inertia[2]) - 1)) < 1e-12
    # Across, the platform also tilts by the bending at its joints; the legs' stretch holds that, and is far stiffer.
    assert omega[0] == pytest.approx(np.sqrt(across / mass), rel=0.03)


# --- legs that do not spin, for which the engine has no chain ---------------------------------------------------------


def least_turn(one, other) -> np.ndarray:
    """Quaternion (w, v) of the least turn that brings one direction to another."""
    q = np.array([1 + one @ other, *np.cross(one, other)])
    return q / np.linalg.norm(q)


def spin_free_angles(hexapod, pose) -> np.ndarray:
    """Swing of each leg across k and about it, bending about y and z, and twist, (6, 5), by quaternions from rest."""
    rest, found = hexapod.rest, np.empty((6, 5))
    turn = Rotation.from_matrix(pose.matrix @ rest.matrix.T)
    for i in range(6):
        n, y, z = chain_springs.leg_axes(hexapod, i, rest, chain_springs._Origin).T
        s = chain_springs.leg_axes(hexapod, i, pose, chain_springs._Origin)[:, 0]
        w, *v = least_turn(n, s)
        swing = Rotation.from_quat([w, *v], scalar_first=True)
        beta = swing.as_rotvec()
        w, *v = (swing.inv() * turn).as_quat(scalar_first=True)
        twist = 2 * np.arctan2(np.dot(v, n), w)
        bend = 2 * np.arctan2(np.linalg.norm(np.cross(n, v)), np.hypot(w, np.dot(v, n)))
        across = np.array([np.dot(v, y), np.dot(v, z)])
        found[i] = [beta @ z, beta @ y, *(across * bend / max(np.linalg.norm(across), 1e-300)), twist]
    return found


@pytest.mark.parametrize("block", range(5))
def test_legs_that_do_not_spin_bend_and_twist_by_quaternions(block):
    """The least turn of each leg, and swing and twist of the platform against it."""
    for hexapod, state in twenty(block, suspension=False, moving_base=False):
        pose, base = state.platform.pose, state.base.pose
        inside = fx.Pose(base.matrix.T @ (pose.position - base.position), base.matrix.T @ pose.matrix)
        swing_1, swing_2, bend_y, bend_z, twist = spin_free_angles(hexapod, inside).T
        found = fx.joint_moments(hexapod, pose, base=base, joint="spin_free")
        swings, bend = np.stack([swing_1, swing_2], axis=1), np.hypot(bend_y, bend_z)
        for angle, expected in (
            (found.universal_angle, swings),
            (found.bending_angle, bend),
            (found.torsion_angle, twist),
        ):
            assert relative(angle, expected) < 1e-10
        springs = hexapod.legs.joint_stiffness
        stored = 0.5 * (
            (springs.universal * swings**2).sum() + springs.spherical @ bend**2 + springs.torsion @ twist**2
        )
        assert fx.energy(hexapod, pose, base=base, joint="spin_free").joints == pytest.approx(stored, rel=1e-10)


@pytest.mark.parametrize("name", ["cubic-isolator", "precision-positioner"])
def test_legs_that_do_not_spin_hold_by_the_slopes_of_these_angles(name):
    """At rest K is that of the legs and the sum of k times the slopes of the angles, by differences, squared."""
    joints = {"universal": [3.0, 40.0], "spherical": [5.0, 7.0, 9.0, 11.0, 13.0, 15.0], "torsion": 60.0}
    hexapod = plain_machine(name).replace({"legs.joint_stiffness": joints})
    step, slopes = 1e-5, np.empty((6, 6, 5))
    for j, direction in enumerate(np.eye(6)):
        up, down = (spin_free_angles(hexapod, displaced(hexapod.home, sign * step * direction)) for sign in (1, -1))
        slopes[j] = (up - down) / (2 * step)
    springs = hexapod.legs.joint_stiffness
    k = np.column_stack([springs.universal, springs.spherical, springs.spherical, springs.torsion])
    H = fx.force_transformation(hexapod)
    K = (H * hexapod.legs.stiffness) @ H.T + np.einsum("ila,jla,la->ij", slopes, slopes, k)
    root = np.linalg.inv(np.linalg.cholesky(fx.linearise(hexapod, joint="spin_free").M))
    expected = np.sqrt(np.linalg.eigvalsh(root @ K @ root.T))
    np.testing.assert_allclose(fx.natural_modes(hexapod, joint="spin_free").omega, expected, rtol=1e-8)
    assert (np.abs(expected / fx.natural_modes(hexapod, joint="universal").omega - 1) > 1e-7).any()
