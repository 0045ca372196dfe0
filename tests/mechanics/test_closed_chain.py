"""The library against a closed chain of rigid bodies in Pinocchio, and that engine against stored answers and laws."""

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.plain import plain_machine
from tests.helpers.states import appendix_a, draw_state, perturbed
from tests.helpers.support import apart, relative
from tests.oracles.closed_chain import ClosedChain, bench_constraint_dynamics

import flexapod as fx

GOLDEN = json.loads((Path(__file__).parents[1] / "data" / "golden.json").read_text(encoding="utf-8"))["cases"]
UNIVERSAL = [case for case in GOLDEN if case["joint"] == "universal"]  # spin_free is no mechanism


def plain_motion(case: dict) -> SimpleNamespace:
    pose = SimpleNamespace(position=np.array(case["position"]), matrix=np.array(case["rotation"]))
    names = ("velocity", "angular_velocity", "acceleration", "angular_acceleration")
    return SimpleNamespace(pose=pose, **{name: np.array(case.get(name, np.zeros(3))) for name in names})


def golden_state(case: dict) -> tuple[ClosedChain, tuple, tuple]:
    machine, mass = case["design"].split(" M=")
    loads = tuple(np.array(case[k]) for k in ("leg_force", "force_platform_frame", "moment_platform_frame"))
    motions = plain_motion(case["platform"]), plain_motion(case["base"])
    return ClosedChain(appendix_a(machine, float(mass))), motions, loads


# --- the engine against the stored answers --------------------------------------------------------------------------


@pytest.mark.parametrize("case", UNIVERSAL, ids=lambda case: case["design"])
def test_engine_reproduces_golden(case, measured):
    chain, motions, loads = golden_state(case)
    linear, angular = chain.acceleration(*motions, *loads)
    # Two codes that share nothing. The engine's two ways to solve its equations differ by 4e-14; the stored answers,
    # whose J_b came from differences of large numbers, leave up to 5e-12 where the platform weighs 4000 kg.
    found = relative(linear, case["acceleration"]), relative(angular, case["angular_acceleration"])
    measured("motion/stored-engine", found, 1e-11)
    assert relative(chain.mass_matrix(*motions), case["J_p"]) < 1e-12
    assert relative(chain.base_matrix(*motions), case["J_b"]) < 1e-11


# --- the library against the engine ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii"])
@pytest.mark.parametrize("block", range(5))
def test_forward_dynamics_agrees_with_engine(name, block, measured):
    """200 states in all, half of them of the packaged designs, half of perturbed ones with strong friction."""
    rng = np.random.default_rng([2007, block])
    packaged = plain_machine(name)
    for hexapod in [packaged] * 10 + [perturbed(packaged, rng) for _ in range(10)]:
        state = draw_state(hexapod, rng)
        expected = ClosedChain(hexapod).acceleration(state.platform, state.base, **state.loads)
        found = fx.forward_dynamics(hexapod, state.platform, base=state.base, joint="universal", **state.loads)
        # The engine's own rounding is below 1e-13 here. cond(J_p) reaches 4e4, so that a J_p good to 1e-14 may leave
        # 1e-10, which is what is promised.
        measured("motion/engine", [relative(f, e) for f, e in zip(found, expected, strict=True)], 1e-10)


@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii"])
def test_equations_of_motion_agree_with_engine(name, measured):
    rng = np.random.default_rng(34)
    for _ in range(10):
        hexapod = perturbed(plain_machine(name), rng)
        state, chain = draw_state(hexapod, rng), ClosedChain(hexapod)
        equations = fx.equations_of_motion(hexapod, state.platform, base=state.base, joint="universal")
        measured("motion/J_p", relative(equations.J_p, chain.mass_matrix(state.platform, state.base)), 1e-11)
        measured("motion/J_b", relative(equations.J_b, chain.base_matrix(state.platform, state.base)), 1e-11)
        measured("motion/eta", relative(equations.eta, chain.bias(state.platform, state.base)), 1e-11)


@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii"])
def test_joint_reactions_agree_with_engine(name, measured):
    rng = np.random.default_rng(12)
    for _ in range(10):
        hexapod = perturbed(plain_machine(name), rng)
        state, chain = draw_state(hexapod, rng), ClosedChain(hexapod)
        expected = chain.joint_forces(state.platform, state.base, **state.loads)
        linear, angular = chain.acceleration(state.platform, state.base, **state.loads)
        motion = fx.Motion(
            state.platform.pose, state.platform.velocity, state.platform.angular_velocity, linear, angular
        )
        # Section 1.0: the engine takes the prismatic pair's moment about the platform joint.
        found = fx.joint_reactions(hexapod, motion, base=state.base, leg_force=state.leg_force, section=1.0)
        for field in expected._fields:
            # The engine names what acts on the legs; the library what the legs do to platform and base.
            sign = -1.0 if field.startswith(("spherical", "universal")) else 1.0
            # Both round at 1e-13; the accelerations, and the light leg's share of them, cost the rest.
            measured("motion/reactions", relative(getattr(found, field), sign * getattr(expected, field)), 1e-10)


@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii"])
def test_moment_in_the_prismatic_pair_depends_on_the_section(name):
    """Moving the section along the leg changes the moment by the lever of the force."""
    rng = np.random.default_rng(13)
    hexapod = perturbed(plain_machine(name), rng)
    state = draw_state(hexapod, rng)
    near, far = (
        fx.joint_reactions(hexapod, state.platform, base=state.base, leg_force=state.leg_force, section=f)
        for f in (0.25, 0.75)
    )
    s, _, _ = _leg_vectors(hexapod, state.platform, state.base)
    lengths = fx.inverse_kinematics(hexapod, state.platform.pose, base=state.base.pose)
    lever = 0.5 * lengths[:, None] * np.cross(s, near.prismatic_force)
    assert relative(near.prismatic_moment - far.prismatic_moment, lever) < 1e-12  # the same sums in another order


@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii", "motion-base"])
def test_energies_agree_with_engine(name, measured):
    rng = np.random.default_rng(14)
    for _ in range(10):
        hexapod = perturbed(plain_machine(name), rng)
        state, chain = draw_state(hexapod, rng), ClosedChain(hexapod)
        found = fx.energy(hexapod, state.platform, base=state.base)
        # Sums of positive terms (or nearly so: the paper's leg inertias are not) of a few dozen products.
        expected = [chain.kinetic_energy(state.platform, state.base), chain.dissipation(state.platform, state.base)]
        measured("motion/energies", apart([found.kinetic, found.dissipation], expected), 1e-12)
        # Terms of both signs: against their size, the platform's weight at a leg's length or so.
        weight = hexapod.platform_mass * np.linalg.norm(hexapod.gravity) * np.linalg.norm(state.platform.pose.position)
        potential = chain.potential_energy(state.platform, state.base)
        assert found.gravitational == pytest.approx(potential, abs=1e-12 * weight)
        assert found.elastic == 0


# --- the engine against laws ----------------------------------------------------------------------------------------


def strong_friction(machine: str, mass: float) -> SimpleNamespace:
    hexapod = appendix_a(machine, mass)
    damping = {"prismatic": 50.0, "universal": 2.0, "spherical": 3.0}
    hexapod.legs.damping = SimpleNamespace(**{k: top * np.linspace(0.5, 1, 6) for k, top in damping.items()})
    return hexapod


@pytest.mark.parametrize("case", UNIVERSAL[::3], ids=lambda case: case["design"])
def test_engine_keeps_the_power_balance(case):
    """Rate of energy = power of leg forces, loads and what moves the base, less friction."""
    _, (platform, base), (leg_force, force, moment) = golden_state(case)
    machine, mass = case["design"].split(" M=")
    chain = ClosedChain(strong_friction(machine, float(mass)))
    platform.acceleration, platform.angular_acceleration = chain.acceleration(platform, base, leg_force, force, moment)
    step = 1e-6
    ahead, behind = (_energy(chain, _moved(platform, t), _moved(base, t)) for t in (step, -step))
    joints = chain.joint_forces(platform, base, leg_force, force, moment)
    turned = platform.pose.matrix
    power = (
        leg_force @ _leg_rates(chain.hexapod, platform, base)
        + (turned @ force) @ platform.velocity
        + (turned @ moment) @ platform.angular_velocity
        - joints.base_force @ base.velocity
        - joints.base_moment @ base.angular_velocity
        - chain.dissipation(platform, base)
    )
    # Central differences: the step squared times third derivatives, and the energies' rounding over the step.
    largest = np.abs(leg_force * _leg_rates(chain.hexapod, platform, base)).max() + chain.dissipation(platform, base)
    assert (ahead - behind) / (2 * step) == pytest.approx(power, abs=1e-6 * largest)


def _energy(chain, platform, base) -> float:
    return chain.kinetic_energy(platform, base) + chain.potential_energy(platform, base)


def _moved(motion, t) -> SimpleNamespace:
    """The motion a short time later, to second order."""
    w, alpha = motion.angular_velocity, motion.angular_acceleration
    position = motion.pose.position + t * motion.velocity + 0.5 * t * t * motion.acceleration
    turned = Rotation.from_rotvec(t * w + 0.5 * t * t * alpha).as_matrix() @ motion.pose.matrix
    velocities = {"velocity": motion.velocity + t * motion.acceleration, "angular_velocity": w + t * alpha}
    return SimpleNamespace(pose=SimpleNamespace(position=position, matrix=turned), **velocities)


def _leg_vectors(hexapod, platform, base) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Leg directions and the arms of the platform's and the base's joints, inertial axes."""
    arms = hexapod.platform_joints @ platform.pose.matrix.T
    feet = hexapod.base_joints @ base.pose.matrix.T
    legs = platform.pose.position + arms - base.pose.position - feet
    return legs / np.linalg.norm(legs, axis=1, keepdims=True), arms, feet


def _leg_rates(hexapod, platform, base) -> np.ndarray:
    s, arms, feet = _leg_vectors(hexapod, platform, base)
    upper = platform.velocity + np.cross(platform.angular_velocity, arms)
    lower = base.velocity + np.cross(base.angular_velocity, feet)
    return np.sum(s * (upper - lower), axis=1)


@pytest.mark.parametrize("case", UNIVERSAL[::3], ids=lambda case: case["design"])
def test_engine_joint_forces_balance(case):
    _, (platform, base), loads = golden_state(case)
    machine, mass = case["design"].split(" M=")
    hexapod = strong_friction(machine, float(mass))
    chain = ClosedChain(hexapod)
    linear, angular = chain.acceleration(platform, base, *loads)
    joints = chain.joint_forces(platform, base, *loads)
    s, arms, feet = _leg_vectors(hexapod, platform, base)
    scale = np.abs(joints.spherical_force).max()

    turned, w = platform.pose.matrix, platform.angular_velocity
    center = turned @ hexapod.platform_mass_center
    inertia = turned @ hexapod.platform_inertia @ turned.T
    pull = hexapod.platform_mass * (linear + np.cross(angular, center) + np.cross(w, np.cross(w, center)))
    pull -= hexapod.platform_mass * hexapod.gravity
    np.testing.assert_allclose(turned @ loads[1] - joints.spherical_force.sum(0), pull, atol=1e-11 * scale)
    spin = inertia @ angular + np.cross(w, inertia @ w) + np.cross(center, pull)
    given = turned @ loads[2] - (np.cross(arms, joints.spherical_force) + joints.spherical_moment).sum(0)
    np.testing.assert_allclose(given, spin, atol=1e-11 * scale)

    push = loads[0] - hexapod.legs.damping.prismatic * _leg_rates(hexapod, platform, base)
    np.testing.assert_allclose(np.sum(s * joints.prismatic_force, axis=1), push, atol=1e-11 * scale)
    np.testing.assert_allclose(joints.base_force, -joints.universal_force.sum(0), atol=1e-11 * scale)
    on_base = -(joints.universal_moment + np.cross(feet, joints.universal_force)).sum(0)
    np.testing.assert_allclose(joints.base_moment, on_base, atol=1e-11 * scale)


def test_engine_universal_reaction_without_friction_is_normal_to_both_axes():
    _, (platform, base), loads = golden_state(UNIVERSAL[0])
    hexapod = appendix_a("I", 40.0)
    hexapod.legs.damping.universal = np.zeros(6)
    moment = ClosedChain(hexapod).joint_forces(platform, base, *loads).universal_moment
    k = hexapod.universal_axes @ base.pose.matrix.T
    y = np.cross(k, _leg_vectors(hexapod, platform, base)[0])
    for axis in (k, y):
        assert np.abs(np.sum(axis * moment, axis=1)).max() < 1e-11 * np.abs(moment).max()


@pytest.mark.parametrize(("machine", "mass", "height"), [("I", 40.0, 0.9), ("II", 4.0, 0.085)])
def test_pinocchio_constraint_dynamics_agrees(machine, mass, height):
    pose = SimpleNamespace(position=np.array([0.0, 0.0, height]), matrix=np.eye(3))
    # The proximal method leaves a residual of the order of its accuracy times the loops' conditioning.
    assert bench_constraint_dynamics(appendix_a(machine, mass), pose).error < 1e-8
