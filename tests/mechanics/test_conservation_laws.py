"""Laws that hold for any machine in any motion: energy, virtual work, symmetry, invariance."""

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.spatial.transform import Rotation
from tests.helpers.drawn import Situation, machines, seeds, situations, with_round_legs
from tests.helpers.plain import plain_machine
from tests.helpers.support import (
    EPS,
    JOINTS,
    MACHINES,
    accelerated,
    apart,
    center,
    difference,
    later,
    relative,
    size,
    time_scale,
)

import flexapod as fx

both_models = pytest.mark.parametrize("joint", JOINTS)


def accelerations(case: Situation, joint: str):
    return fx.forward_dynamics(case.hexapod, case.platform, base=case.base, joint=joint, **case.loads)


def in_motion(case: Situation, joint: str) -> fx.Motion:
    """The platform's motion with the accelerations that its loads give it."""
    return accelerated(case.platform, *accelerations(case, joint))


# --- energy -----------------------------------------------------------------------------------------------------------


@both_models
@given(case=situations())
def test_rate_of_energy_is_power(joint, case, measured):
    """d(kinetic + gravitational + elastic)/dt = power of actuators, wrench and moving base, less friction.

    The leg force is a spring's and an actuator's. The paper's model has legs that turn with the universal joint but
    move as if they did not: energy is conserved only where that makes no difference, in legs round about their axes.
    """
    if joint == "spin_free":
        case = case._replace(hexapod=with_round_legs(case.hexapod))
    hexapod, base = case.hexapod, case.base
    platform = in_motion(case, joint)
    spring = 0.4 * case.leg_force
    rates = fx.leg_rates(hexapod, platform, base=base)
    unstretched = rates.length + spring / hexapod.legs.stiffness

    def energy(t):
        e = fx.energy(hexapod, later(platform, t), base=later(base, t), unstretched_length=unstretched, joint=joint)
        return e.kinetic + e.gravitational + e.elastic

    reaction = fx.joint_reactions(hexapod, platform, base=base, leg_force=case.leg_force, joint=joint)
    R = platform.pose.matrix
    powers = [
        (case.leg_force - spring) @ rates.rate,
        (R @ case.force) @ platform.velocity,
        (R @ case.moment) @ platform.angular_velocity,
        -reaction.base_force @ base.velocity,
        -reaction.base_moment @ base.angular_velocity,
        -fx.energy(hexapod, platform, base=base, joint=joint).dissipation,
    ]
    if joint == "spin_free":
        powers.append(_power_without_work(case, reaction))
    time = time_scale(hexapod, platform, base)
    flow = np.abs(powers).max() + abs(energy(0.0)) / time
    # Differences of fourth order: a step of 1e-3 of the time scale errs by 1e-12 of the flow times the fifth
    # derivative's factor, some thousands at worst (stiff springs stretch fast), and by rounding, eps / 1e-3.
    measured("laws/power", (difference(energy, 1e-3 * time) - sum(powers)) / flow, 1e-8)


def _power_without_work(case: Situation, reaction: fx.mechanics.Reactions) -> float:
    """Power on the turning base of the moments that hold the legs about their own axes in the paper's model.

    W.s = 0 is no law of any joint on the base: the moment along s that it takes does no work on the leg, which does
    not turn about s, but would do some on the base, which does. Friction's own part of the moment is real.
    """
    s = fx.force_transformation(case.hexapod, case.platform.pose, base=case.base.pose)[:3].T
    base_spin = s @ case.base.angular_velocity
    friction = -case.hexapod.legs.damping.universal * base_spin
    return float((np.sum(reaction.universal_moment * s, axis=1) - friction) @ base_spin)


# --- virtual work -----------------------------------------------------------------------------------------------------


@given(case=situations())
def test_leg_rates_are_derivatives_of_lengths(case, measured):
    hexapod, platform, base = case.hexapod, case.platform, case.base
    found = fx.leg_rates(hexapod, platform, base=base)
    step = 1e-3 * time_scale(hexapod, platform, base)
    length = difference(lambda t: fx.leg_rates(hexapod, later(platform, t), base=later(base, t)).length, step)
    rate = difference(lambda t: fx.leg_rates(hexapod, later(platform, t), base=later(base, t)).rate, step)
    # Fourth order with a step of 1e-3: 1e-12 times the fifth derivative's factor, some hundreds; rounding eps / 1e-3.
    measured("laws/leg-rates", [relative(found.rate, length), relative(found.acceleration, rate)], 1e-9)


@given(case=situations())
def test_H_transposed_is_the_leg_rates(case, measured):
    """Virtual work: the legs' forces and the platform's wrench do the same work."""
    hexapod = case.hexapod
    H = fx.force_transformation(hexapod, case.platform.pose, base=case.base.pose)
    twist = np.concatenate([case.platform.velocity, case.platform.angular_velocity])
    rate = fx.leg_rates(hexapod, case.platform, base=case.base.pose).rate  # base at rest
    # Sums of six products whose parts cancel a hundredfold at most.
    measured("laws/virtual-work", relative(H.T @ twist, rate), 1000 * EPS)


@both_models
@given(case=situations())
def test_inverse_dynamics_undoes_forward_dynamics(joint, case):
    platform = in_motion(case, joint)
    wrench = {"force": case.force, "moment": case.moment}
    found = fx.inverse_dynamics(case.hexapod, platform, base=case.base, joint=joint, **wrench)
    H = fx.force_transformation(case.hexapod, platform.pose, base=case.base.pose)
    J = fx.equations_of_motion(case.hexapod, platform, base=case.base, joint=joint).J_p
    # Rounding of the wrench, grown by the conditions of J_p and H.
    assert relative(found, case.leg_force) < 100 * EPS * np.linalg.cond(H) * np.linalg.cond(J)


@both_models
@given(case=situations())
def test_equations_of_motion_are_the_forward_dynamics(joint, case):
    e = fx.equations_of_motion(case.hexapod, case.platform, base=case.base, joint=joint)
    R = case.platform.pose.matrix
    base = np.concatenate([case.base.acceleration, case.base.angular_acceleration])
    wrench = np.concatenate([R @ case.force, R @ case.moment])
    expected = np.linalg.solve(e.J_p, e.H @ case.leg_force + wrench - e.eta + e.J_b @ base)
    found = np.concatenate(accelerations(case, joint))
    # The same equations in two orders of summing; J_p mixes kg and kg m2, and its condition grows the rounding.
    assert relative(found, expected) < 100 * EPS * np.linalg.cond(e.J_p)


# --- inertia ----------------------------------------------------------------------------------------------------------


@both_models
@given(case=situations())
def test_inertia_is_symmetric_and_positive_definite(joint, case):
    J = fx.equations_of_motion(case.hexapod, case.platform, base=case.base, joint=joint).J_p
    scale = np.sqrt(np.diag(J))
    scaled = J / np.outer(scale, scale)
    np.testing.assert_allclose(scaled, scaled.T, rtol=0, atol=30 * EPS)  # sums of some 30 products
    assert np.linalg.eigvalsh(scaled)[0] > 0
    platform_alone = fx.equations_of_motion(
        case.hexapod.replace({"legs.lower": None, "legs.upper": None}), case.platform, base=case.base
    ).J_p
    # Legs add a positive semidefinite inertia; the tolerance is the rounding of the two inertias.
    assert np.linalg.eigvalsh((J - platform_alone) / np.outer(scale, scale))[0] > -100 * EPS


@both_models
@given(case=situations())
def test_kinetic_energy_is_half_of_twist_times_inertia(joint, case, measured):
    still = fx.Motion(case.base.pose)
    J = fx.equations_of_motion(case.hexapod, case.platform, base=still, joint=joint).J_p
    twist = np.concatenate([case.platform.velocity, case.platform.angular_velocity])
    found = fx.energy(case.hexapod, case.platform, base=still, joint=joint).kinetic
    # Sums of squares: no cancellation to speak of.
    measured("laws/kinetic-energy", apart(found, twist @ J @ twist / 2), 1e-12)


# --- invariance -------------------------------------------------------------------------------------------------------


@both_models
@given(case=situations(), seed=seeds)
def test_moving_the_world_changes_nothing(joint, case, seed, measured):
    """Turn and shift everything, gravity too: vectors turn along, numbers stay."""
    rng = np.random.default_rng(seed)
    Q = Rotation.from_rotvec(rng.normal(size=3)).as_matrix()
    shift = rng.normal(size=3) * size(case.hexapod)

    def turned(motion):
        pose = fx.Pose(Q @ motion.pose.position + shift, Q @ motion.pose.matrix)
        rates = (motion.velocity, motion.angular_velocity, motion.acceleration, motion.angular_acceleration)
        return fx.Motion(pose, *(Q @ v for v in rates))

    other = case._replace(
        hexapod=case.hexapod.replace({"gravity": Q @ case.hexapod.gravity}),
        platform=turned(case.platform),
        base=turned(case.base),
    )
    J = fx.equations_of_motion(case.hexapod, case.platform, base=case.base, joint=joint).J_p
    for a, b in zip(accelerations(case, joint), accelerations(other, joint), strict=True):
        measured("laws/frame", relative(b, Q @ a) / (EPS * np.linalg.cond(J)), 100)  # rounding of the load through J_p
    one, two = (
        fx.joint_reactions(c.hexapod, c.platform, base=c.base, leg_force=c.leg_force, joint=joint)
        for c in (case, other)
    )
    for field in one._fields:
        # A moment is a small difference of large levers: ten thousand roundings.
        assert relative(getattr(two, field), getattr(one, field) @ Q.T) < 1e-11, field
    frequencies = [
        fx.natural_modes(c.hexapod, c.platform.pose, joint=joint, base=c.base.pose).omega for c in (case, other)
    ]
    np.testing.assert_allclose(*frequencies, rtol=1e-9)  # eps times the condition of L^-1 H K^1/2, at most 1e6 here


@both_models
@given(case=situations(), seed=seeds)
def test_uniform_motion_changes_nothing(joint, case, seed, measured):
    """Galileo: one velocity more for platform and base. Einstein: one acceleration more for both and for gravity."""
    velocity, acceleration = np.random.default_rng(seed).normal(size=(2, 3)) * size(case.hexapod)

    def carried(m):
        return fx.Motion(
            m.pose, m.velocity + velocity, m.angular_velocity, m.acceleration + acceleration, m.angular_acceleration
        )

    other = case._replace(
        hexapod=case.hexapod.replace({"gravity": case.hexapod.gravity + acceleration}),
        platform=carried(case.platform),
        base=carried(case.base),
    )
    linear, angular = accelerations(case, joint)
    moved_linear, moved_angular = accelerations(other, joint)
    J = fx.equations_of_motion(case.hexapod, case.platform, base=case.base, joint=joint).J_p
    found = np.array([relative(moved_linear - acceleration, linear), relative(moved_angular, angular)])
    measured("laws/uniform", found / (EPS * np.linalg.cond(J)), 100)  # rounding of the load through J_p


@both_models
@given(case=situations())
def test_translation_of_base_and_platform_together_is_weight(joint, case, measured):
    """E2's sign: with a_p = a_b = a at rest, the wrench is that of gravity -a."""
    a = np.array([1.0, -2.0, 3.0])
    platform, base = (fx.Motion(m.pose, acceleration=a) for m in (case.platform, case.base))
    weightless = case.hexapod.replace({"gravity": np.zeros(3)})
    heavy = case.hexapod.replace({"gravity": -a})
    e = fx.equations_of_motion(weightless, platform, base=base, joint=joint)
    moved = (e.J_p - e.J_b)[:, :3] @ a + e.eta
    held = fx.equations_of_motion(heavy, case.platform.pose, base=case.base.pose, joint=joint).eta
    measured("laws/weight", relative(moved, held), 1e-13)  # sums of some hundred products


@both_models
@given(case=situations(), seed=seeds)
def test_renumbering_the_legs_permutes_the_results(joint, case, seed):
    order = np.random.default_rng(seed).permutation(6)
    values = case.hexapod.values()
    per_leg = [
        k for k, v in values.items() if k.startswith("legs.") or k.endswith(("joints", "universal_axes")) if v.ndim
    ]
    renumbered = fx.Hexapod.from_values(values | {k: values[k][order] for k in per_leg})
    other = case._replace(hexapod=renumbered, leg_force=case.leg_force[order])
    J = fx.equations_of_motion(case.hexapod, case.platform, base=case.base, joint=joint).J_p
    tolerance = 100 * EPS * np.linalg.cond(J)  # only the order of sums differs
    for a, b in zip(accelerations(case, joint), accelerations(other, joint), strict=True):
        assert relative(b, a) < tolerance
    one, two = (
        fx.joint_reactions(c.hexapod, c.platform, base=c.base, leg_force=c.leg_force, joint=joint)
        for c in (case, other)
    )
    for field in one._fields[:6]:
        np.testing.assert_array_equal(getattr(two, field), getattr(one, field)[order])  # each leg is its own sum
    lengths = [fx.inverse_kinematics(c.hexapod, c.platform.pose, base=c.base.pose) for c in (case, other)]
    np.testing.assert_array_equal(lengths[1], lengths[0][order])


@given(case=situations())
def test_the_reference_point_is_a_matter_of_choice(case, measured):
    """Another origin of the platform's frame: the same machine moves the same way."""
    d = 0.2 * size(case.hexapod) * np.array([0.6, -0.3, 0.7])  # new origin in old platform axes
    values = case.hexapod.values()
    shifted = fx.Hexapod.from_values(
        values
        | {
            "platform.joints": values["platform.joints"] - d,
            "platform.mass_center": values["platform.mass_center"] - d,
        }
    )
    R, platform = case.platform.pose.matrix, case.platform
    arm, w = R @ d, platform.angular_velocity
    motion = fx.Motion(fx.Pose(platform.pose.position + arm, R), platform.velocity + np.cross(w, arm), w)
    other = case._replace(hexapod=shifted, platform=motion, moment=case.moment - np.cross(d, case.force))
    linear, angular = accelerations(case, "universal")
    moved_linear, moved_angular = accelerations(other, "universal")
    J = fx.equations_of_motion(case.hexapod, case.platform, base=case.base).J_p
    expected = linear + np.cross(angular, arm) + np.cross(w, np.cross(w, arm))
    found = np.array([relative(moved_angular, angular), relative(moved_linear, expected)])
    # Rounding of the load through J_p, in two frames.
    measured("laws/reference-point", found / (EPS * np.linalg.cond(J)), 1000)
    omega = [fx.natural_modes(c.hexapod, c.platform.pose, base=c.base.pose).omega for c in (case, other)]
    np.testing.assert_allclose(*omega, rtol=1e-9)  # eps times the condition of L^-1 H K^1/2, at most 1e6 here


# --- weight and symmetry ----------------------------------------------------------------------------------------------


@given(hexapod=machines())
def test_base_carries_the_weight(hexapod):
    """At rest the base bears the weight of platform and legs, in force and in moment about its origin."""
    pose = center(hexapod)
    rest = fx.hold(hexapod, pose)
    found = fx.joint_reactions(hexapod, pose, leg_force=rest.leg_force)
    S = pose.position + hexapod.platform_joints - hexapod.base_joints
    axes = _leg_axes(S, hexapod.universal_axes)
    masses, centers = [hexapod.platform_mass], [pose.position + hexapod.platform_mass_center]
    for part, joints in ((hexapod.legs.lower, hexapod.base_joints), (hexapod.legs.upper, hexapod.base_joints + S)):
        masses += list(part.mass)
        centers += list(joints + np.einsum("nij,nj->ni", axes, part.mass_center))
    weights = np.array(masses)[:, None] * hexapod.gravity
    # Leg forces are good to eps times cond(H), with lengths counted in the machine's size.
    tolerance = (
        1000
        * EPS
        * fx.condition_number(hexapod, pose, characteristic_length=size(hexapod))
        * np.abs(rest.leg_force).max()
    )
    np.testing.assert_allclose(found.base_force, weights.sum(0), atol=tolerance)
    np.testing.assert_allclose(found.base_moment, np.cross(centers, weights).sum(0), atol=tolerance * size(hexapod))


def _leg_axes(S, k):
    s = S / np.linalg.norm(S, axis=1, keepdims=True)
    y = np.cross(k, s)
    y /= np.linalg.norm(y, axis=1, keepdims=True)
    return np.stack([s, y, np.cross(s, y)], axis=-1)


@both_models
@pytest.mark.parametrize("name", ["precision-positioner", "cubic-isolator"])
def test_symmetric_machine_has_double_modes(name, joint):
    """Three-fold symmetry about z: modes in x and y, roll and pitch, come in pairs."""
    hexapod = plain_machine(name)
    omega = fx.natural_modes(hexapod, center(hexapod), joint=joint).omega
    pairs = fx.mechanics.near_repeated(omega, gap=1e-3)
    assert len([p for p in pairs if np.isclose(*omega[list(p)], rtol=1e-12, atol=0)]) == 2  # eps times cond(B), 1e2
    J = fx.equations_of_motion(hexapod, center(hexapod), joint=joint).J_p
    turn = np.kron(np.eye(2), Rotation.from_euler("z", 120, degrees=True).as_matrix())
    np.testing.assert_allclose(turn @ J @ turn.T, J, atol=1e-13 * np.abs(J).max())  # rounding of the joints' circle


@pytest.mark.parametrize("name", MACHINES)
def test_joint_models_agree_where_legs_stand_across_their_axes(name, measured):
    """tau = 0: with k normal to every leg and a still base, the exact model has no spin along the leg."""
    hexapod = plain_machine(name)
    pose = center(hexapod)
    legs = pose.position + hexapod.platform_joints @ pose.matrix.T - hexapod.base_joints
    crosswise = hexapod.replace({"base.universal_axes": np.cross(legs, [0.3, 0.5, 1.0])})
    J = [fx.equations_of_motion(crosswise, pose, joint=joint).J_p for joint in JOINTS]
    measured("laws/across", relative(*J), 1e-13)  # k.s is zero to rounding only


@settings(max_examples=10)
@given(case=situations())
def test_many_states_at_once_are_each_of_them(case):
    """A batch is the single states, bit for bit, on any batch axes."""
    steps = np.linspace(-0.02, 0.02, 6)
    motions = [later(case.platform, t) for t in steps]
    poses = fx.Pose(
        np.array([m.pose.position for m in motions]).reshape(2, 3, 3),
        np.array([m.pose.matrix for m in motions]).reshape(2, 3, 3, 3),
    )
    batch = fx.Motion(poses, case.platform.velocity, case.platform.angular_velocity)
    linear, angular = fx.forward_dynamics(case.hexapod, batch, base=case.base, **case.loads)
    assert linear.shape == angular.shape == (2, 3, 3)
    modes = fx.natural_modes(case.hexapod, poses, base=case.base.pose)
    assert modes.omega.shape == (2, 3, 6)
    for i, index in enumerate(np.ndindex(2, 3)):
        motion = fx.Motion(poses[index], case.platform.velocity, case.platform.angular_velocity)
        one = fx.forward_dynamics(case.hexapod, motion, base=case.base, **case.loads)
        np.testing.assert_array_equal(linear[index], one[0])
        np.testing.assert_array_equal(angular[index], one[1])
        single = fx.natural_modes(case.hexapod, motions[i].pose, base=case.base.pose)
        np.testing.assert_array_equal(modes.omega[index], single.omega)
        np.testing.assert_array_equal(modes.shape[index], single.shape)
