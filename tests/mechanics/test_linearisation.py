"""The exact tangent: against differences of the dynamics, the potential energy, closed forms, and Eq. 5."""

import numpy as np
import pytest
from hypothesis import given, settings
from tests.helpers.drawn import machines
from tests.helpers.plain import plain_machine
from tests.helpers.support import EPS, JOINTS, MACHINES, apart, away, center, difference, displaced, relative, size

import flexapod as fx

BASE = displaced(fx.Pose([0.3, -0.2, 0.5]), [0, 0, 0, 0.2, -0.3, 0.8])
both_models = pytest.mark.parametrize("joint", JOINTS)


def soft(name: str) -> fx.Hexapod:
    """The machine with legs so soft that gravity and preload matter, and with all frictions."""
    hexapod = plain_machine(name)
    weight, length = 10 * hexapod.platform_mass, size(hexapod)
    damping = {"prismatic": 0.3, "universal": 0.1 * length**2, "spherical": 0.2 * length**2}
    c = weight / np.sqrt(10 * length)
    return hexapod.replace(
        {
            "legs.stiffness": 5 * weight / length * np.array([1, 1.2, 0.9, 1.1, 1.3, 0.8]),
            **{f"legs.damping.{k}": c * v for k, v in damping.items()},
        }
    )


def on_base(pose: fx.Pose) -> fx.Pose:
    return fx.Pose(BASE.position + BASE.matrix @ pose.position, BASE.matrix @ pose.matrix)


def load_of(hexapod) -> dict:
    force = 2 * hexapod.platform_mass * np.array([0.3, -0.5, 0.8])
    return {"force": force, "moment": 0.1 * size(hexapod) * force[[2, 0, 1]]}


def blocks(matrix):
    return [matrix[np.ix_(rows, columns)] for rows in (range(3), range(3, 6)) for columns in (range(3), range(3, 6))]


# --- the matrices against differences ---------------------------------------------------------------------------------


@both_models
@pytest.mark.parametrize("name", ["mukherjee-i", "motion-base", "cubic-isolator"])
def test_matrices_are_derivatives_of_the_dynamics(name, joint, measured):
    """Accelerations from the legs' springs, F = -K (L - L0), by how both plates are displaced and move."""
    hexapod = soft(name)
    pose, load = on_base(away(hexapod)), load_of(hexapod)
    tangent = fx.linearise(hexapod, pose, base=BASE, joint=joint, **load)
    L_0 = tangent.rest.unstretched_length

    def acceleration(platform=pose, base=BASE, **rates):
        p = fx.Motion(platform, **{k: v for k, v in rates.items() if not k.startswith("base_")})
        b = fx.Motion(base, **{k.removeprefix("base_"): v for k, v in rates.items() if k.startswith("base_")})
        F = hexapod.legs.stiffness * (L_0 - fx.inverse_kinematics(hexapod, platform, base=base))
        return np.concatenate(fx.forward_dynamics(hexapod, p, base=b, leg_force=F, joint=joint, **load))

    def columns(response, steps):
        found = [difference(lambda t, e=e: response(t * e), h) for e, h in zip(np.eye(6), steps, strict=True)]
        return -tangent.M @ np.column_stack(found)

    length = size(hexapod)
    scale = np.repeat([length, 1.0], 3)
    small = 2e-4 * scale
    assert np.linalg.norm(acceleration()) < 1e-9  # at rest: the rounding of the leg forces through J_p
    pairs = {
        "K": columns(lambda x: acceleration(platform=displaced(pose, x)), small),
        "K_b": columns(lambda x: acceleration(base=displaced(BASE, x)), small),
        "C": columns(lambda v: acceleration(velocity=v[:3], angular_velocity=v[3:]), 0.1 * scale),
        "C_b": columns(lambda v: acceleration(base_velocity=v[:3], base_angular_velocity=v[3:]), 0.1 * scale),
        "M_b": columns(lambda a: acceleration(base_acceleration=a[:3], base_angular_acceleration=a[3:]), scale),
    }
    for label, expected in pairs.items():
        for mine, theirs in zip(blocks(getattr(tangent, label)), blocks(expected), strict=True):
            # Fourth-order differences: by displacement with a step of 2e-4, 1e-15 of truncation and eps / 2e-4 of
            # rounding, through J_p's condition of some thousands; exact in velocities (quadratic) and accelerations.
            measured("rest/tangent", np.abs(mine - theirs).max() / np.abs(theirs).max(), 1e-8)
    equations = fx.equations_of_motion(hexapod, pose, base=BASE, joint=joint)
    assert relative(tangent.M, equations.J_p) < 1e-14  # sums over the legs in another order
    assert relative(tangent.H, equations.H) < 1e-14


@pytest.mark.parametrize("name", MACHINES)
def test_stiffness_is_the_hessian_of_potential_energy(name, measured):
    hexapod = soft(name)
    pose = away(hexapod)
    tangent = fx.linearise(hexapod, pose)

    def potential(x):
        e = fx.energy(hexapod, displaced(pose, x), unstretched_length=tangent.rest.unstretched_length)
        return e.gravitational + e.elastic

    scale = np.repeat([size(hexapod), 1.0], 3)  # displacements of the machine's size
    step = 2e-3

    def second(i, j):
        def mixed(h):
            u, v = h * scale[i] * np.eye(6)[i], h * scale[j] * np.eye(6)[j]
            return (potential(u + v) - potential(u - v) - potential(v - u) + potential(-u - v)) / (4 * h * h)

        return (4 * mixed(step) - mixed(2 * step)) / 3

    expected = np.array([[second(i, j) for j in range(6)] for i in range(6)])
    found = tangent.K * np.outer(scale, scale)
    # Richardson's extrapolation: step^4 is 2e-11, times the sixth derivative's factor; rounding eps / step^2, 5e-11.
    measured("rest/hessian", (found - expected) / np.abs(expected).max(), 3e-8)
    np.testing.assert_allclose(found, found.T, atol=1e-13 * np.abs(found).max())  # rounding


@given(hexapod=machines())
def test_stiffness_is_symmetric_without_a_turning_wrench(hexapod):
    pose = center(hexapod)
    scale = np.repeat([1.0, 1 / size(hexapod)], 3)
    free = fx.linearise(hexapod, pose).K * np.outer(scale, scale)
    assert np.abs(free - free.T).max() < 1e-13 * np.abs(free).max()  # rounding of sums of some hundred products
    turning = fx.linearise(hexapod, pose, **load_of(hexapod)).K * np.outer(scale, scale)
    assert np.abs(turning - turning.T).max() > 1e-9 * np.abs(turning).max()


@pytest.mark.parametrize("name", MACHINES)
def test_base_and_platform_moving_as_one(name, measured):
    """Legs do not feel a displacement of the whole machine: only gravity, which does not turn along, does."""
    hexapod = soft(name)
    pose = on_base(away(hexapod))
    tangent = fx.linearise(hexapod, pose, base=BASE, **load_of(hexapod))
    together = tangent.K_b + tangent.K @ tangent.carry
    g, one = hexapod.gravity, np.eye(3)
    weight = [fx.equations_of_motion(hexapod.replace({"gravity": e}), pose, base=BASE).eta for e in one]
    tilt = np.column_stack(weight) @ np.column_stack([np.cross(g, e) for e in one])
    expected = np.hstack([np.zeros((6, 3)), tilt])
    scale = np.abs(tangent.K @ tangent.carry).max(axis=1, keepdims=True)
    measured("rest/together", (together - expected) / scale, 1e-12)  # rounding
    assert np.abs(together[:, 3:]).max() > 1e-3 * np.abs(hexapod.gravity).max() * hexapod.platform_mass
    friction = tangent.C_b + tangent.C @ tangent.carry
    assert (np.abs(friction) < 1e-12 * np.abs(tangent.C @ tangent.carry).max(axis=1, keepdims=True)).all()


# --- Eq. 5 and beyond -------------------------------------------------------------------------------------------------


@both_models
@pytest.mark.parametrize("name", MACHINES)
def test_frequencies_approach_eq_5_as_legs_stiffen(name, joint, measured):
    """The difference is of first order in load over stiffness: it falls as 1 / stiffness."""
    hexapod = soft(name)
    pose = away(hexapod)
    stiffness = hexapod.legs.stiffness * 1e3
    gaps = []
    for factor in (1.0, 10.0):
        stiff = hexapod.replace({"legs.stiffness": factor * stiffness, "legs.damping": None})
        exact = fx.linearise(stiff, pose, joint=joint).modes().omega
        paper = fx.natural_modes(stiff, pose, joint=joint).omega
        gaps.append(np.linalg.norm(exact**2 / paper**2 - 1))
    assert gaps[0] < 0.2
    # The next order is the first squared: a few per cent of it where the gap is a few per cent.
    measured("rest/stiffening", apart(gaps[0] / gaps[1], 10), 0.2)


def test_gravity_topples_a_soft_machine_that_eq_5_calls_stable():
    """A tall mass on soft legs, an inverted pendulum: its tangent loses all stiffness where Eq. 5 sees nothing."""
    tall = plain_machine("cubic-isolator").replace(
        {"platform.mass_center": [0, 0, 0.5], "legs.lower": None, "legs.upper": None, "legs.damping": None}
    )
    pose = center(tall)

    def at(stiffness):
        return tall.replace({"legs.stiffness": stiffness})

    def lowest(stiffness):
        return np.linalg.eigvalsh(fx.linearise(at(stiffness), pose).K)[0]

    assert lowest(1e5) > 0 > lowest(1e3)
    low, high = 1e3, 1e5
    for _ in range(60):
        middle = np.sqrt(low * high)
        low, high = (low, middle) if lowest(middle) > 0 else (middle, high)
    # On the way the exact index falls to zero while Eq. 5's falls as the root of the stiffness.
    index = [fx.linearise(at(f * high), pose).modes().omega[0] for f in (4.0, 1.1, 1.001)]
    eq_5 = [fx.stability_index(at(f * high), pose) for f in (4.0, 1.1, 1.001)]
    assert index[2] < 0.03 * index[0]
    np.testing.assert_allclose(eq_5, np.sqrt([4, 1.1, 1.001]) * eq_5[2] / np.sqrt(1.001), rtol=1e-12)

    falling = fx.linearise(at(0.5 * high), pose)
    modes = falling.modes()
    grows = modes.pole.real > 0
    assert grows.any()
    assert (modes.damping_ratio[grows] < 0).all()
    assert fx.stability_index(at(0.5 * high), pose) > 0.5 * eq_5[2]
    # And so the machine does: pushed along its falling mode, forward dynamics carries it further.
    push = 1e-4 * modes.shape[:, np.argmax(modes.pole.real)].real
    tilted = displaced(pose, push)
    soft_legs = at(0.5 * high)
    F = soft_legs.legs.stiffness * (falling.rest.unstretched_length - fx.inverse_kinematics(soft_legs, tilted))
    answer = np.concatenate(fx.forward_dynamics(soft_legs, tilted, leg_force=F))
    np.testing.assert_allclose(answer, modes.pole.real.max() ** 2 * push, atol=1e-2 * np.abs(answer).max())


# --- damped modes -----------------------------------------------------------------------------------------------------


def test_damping_ratio_of_massless_legs_in_closed_form(measured):
    """C = c H H^T and K = k H H^T: every damping ratio is c omega / (2 k)."""
    k, c = 1e4, 12.0
    changes = {"gravity": [0, 0, 0], "legs.lower": None, "legs.upper": None, "legs.stiffness": k}
    hexapod = plain_machine("cubic-isolator").replace(changes | {"legs.damping.prismatic": c})
    pose = away(hexapod)
    modes = fx.linearise(hexapod, pose).modes()
    omega = fx.natural_modes(hexapod, pose).omega
    np.testing.assert_allclose(modes.omega, omega, rtol=1e-11)  # an eigenvalue problem of condition 1e3
    measured("rest/damping", apart(modes.damping_ratio, c * omega / (2 * k)), 1e-9)
    # Vertically at the centre it is the mass on six springs: 2 k and 2 c for a cube.
    one = fx.linearise(hexapod, center(hexapod)).modes()
    vertical = np.argmin(np.abs(one.omega - np.sqrt(2 * k / 20)))
    assert one.omega[vertical] == pytest.approx(np.sqrt(2 * k / 20), rel=1e-11)
    assert one.damping_ratio[vertical] == pytest.approx(2 * c / (2 * np.sqrt(2 * k * 20)), rel=1e-9)


def test_overdamped_modes_are_given_by_their_slow_pole():
    k, c = 1e4, 4000.0
    changes = {"gravity": [0, 0, 0], "legs.lower": None, "legs.upper": None, "legs.stiffness": k}
    hexapod = plain_machine("cubic-isolator").replace(changes | {"legs.damping.prismatic": c})
    modes = fx.linearise(hexapod, away(hexapod)).modes()
    omega = fx.natural_modes(hexapod, away(hexapod)).omega
    ratio = c * omega / (2 * k)
    assert ratio.min() > 1
    slow = omega * (ratio - np.sqrt(ratio**2 - 1))
    np.testing.assert_allclose(np.sort(-modes.pole.real), np.sort(slow), rtol=1e-7)  # differences of poles 1e2 apart
    assert (modes.pole.imag == 0).all()
    np.testing.assert_allclose(modes.damping_ratio, 1)


@both_models
@pytest.mark.parametrize("name", MACHINES)
def test_damped_modes_solve_their_equation(name, joint):
    hexapod = soft(name).replace({"legs.stiffness": 50 * soft(name).legs.stiffness})
    t = fx.linearise(hexapod, away(hexapod), joint=joint)
    modes = t.modes()
    assert (np.diff(modes.omega) >= -1e-12 * modes.omega[1:]).all()
    assert (modes.damping_ratio > 0).all()
    scale = np.repeat([1.0, 1 / size(hexapod)], 3)
    for p, v in zip(modes.pole, modes.shape.T, strict=True):
        rest = scale * (p * p * t.M @ v + p * t.C @ v + t.K @ v)
        # Rounding of an eigenvector of the 12 by 12 problem.
        assert np.abs(rest).max() < 1e-9 * np.abs(scale * (p * p * t.M @ v)).max()
        assert v @ t.M @ v == pytest.approx(1, abs=1e-12)
    np.testing.assert_allclose(modes.omega, np.abs(modes.pole), rtol=1e-15)
    np.testing.assert_allclose(modes.damping_ratio, -modes.pole.real / modes.omega, rtol=1e-15)


# --- state space ------------------------------------------------------------------------------------------------------


def response(t: fx.mechanics.Linearisation, omega: float, K_b: np.ndarray) -> np.ndarray:
    """Outputs for unit inputs at one frequency, straight from M, C and K: (24, 24)."""
    s = 1j * omega
    dynamic = s * s * t.M + s * t.C + t.K
    from_base = -(s * s * t.M_b + s * t.C_b + K_b) / s**2  # the base's displacement is its acceleration over s^2
    K_legs = np.diag(t.leg_stiffness)
    x = np.linalg.solve(dynamic, np.hstack([from_base, t.H, np.eye(6), t.H @ K_legs]))
    x_b = np.hstack([np.eye(6) / s**2, np.zeros((6, 18))])
    stretch = t.H.T @ (x - t.carry @ x_b)
    actuator = np.hstack([np.zeros((6, 6)), np.eye(6), np.zeros((6, 6)), K_legs])
    return np.vstack([x - t.carry @ x_b, stretch, actuator - K_legs @ stretch, s * s * x])


@pytest.mark.parametrize("gravity", [0.0, -9.81])
@pytest.mark.parametrize("name", ["motion-base", "cubic-isolator", "mukherjee-i"])
def test_state_space_is_the_second_order_equation(name, gravity, measured):
    hexapod = soft(name).replace({"gravity": [0, 0, gravity], "legs.stiffness": 100 * soft(name).legs.stiffness})
    t = fx.linearise(hexapod, on_base(away(hexapod)), base=BASE, **load_of(hexapod))
    system = t.to_control()
    for omega in t.modes().omega[0] * np.array([0.3, 1.0, 4.0]):
        found = system(1j * omega)
        # Twelve states cannot hold how a tilted base tilts gravity: without that, K_b is -K carry.
        expected = response(t, omega, -t.K @ t.carry)
        exact = response(t, omega, t.K_b)
        if gravity:
            assert relative(expected[:, 3:5], exact[:, 3:5]) > 1e-6  # there is such an effect
            exact = np.delete(exact, [3, 4, 5], 1)
            assert relative(np.delete(expected, [3, 4, 5], 1), exact) < 1e-9
        else:
            assert relative(expected, exact) < 1e-9
        for rows in np.split(np.arange(24), 4):
            for columns in np.split(np.arange(24), [3, 6, 12, 18]):
                mine, theirs = found[np.ix_(rows, columns)], expected[np.ix_(rows, columns)]
                # Two ways to solve equations whose condition is up to 1e5.
                measured("rest/state-space", relative(mine, theirs), 1e-9)


def test_state_space_names_its_signals():
    hexapod = plain_machine("motion-base")
    t = fx.linearise(hexapod, center(hexapod))
    system, plain = t.to_control(), t.state_space()
    assert (system.nstates, system.ninputs, system.noutputs) == (12, 24, 24)
    assert system.input_labels == list(plain.inputs)
    assert plain.inputs[:7] == (
        *(f"base_acceleration_{a}" for a in ("x", "y", "z", "roll", "pitch", "yaw")),
        "leg_force_1",
    )
    assert plain.outputs[-1] == "acceleration_yaw"
    assert len(set(plain.inputs)) == len(set(plain.outputs)) == 24
    assert system.poles().imag.max() == pytest.approx(t.modes().pole.imag.max(), rel=1e-9)


@settings(max_examples=10)
@given(hexapod=machines())
def test_slow_base_carries_the_platform_along(hexapod):
    """Far below the lowest frequency the platform moves rigidly with the base: transmissibility 1."""
    t = fx.linearise(hexapod.replace({"gravity": [0, 0, 0]}), center(hexapod))
    lowest = t.modes().omega[0]
    s = t.state_space()
    slow = 1e-4j * lowest
    found = s.C @ np.linalg.solve(slow * np.eye(12) - s.A, s.B) + s.D
    carried, scale = found[18:, :6], np.repeat([1.0, size(hexapod)], 3)
    # What is left is the frequency ratio (with friction of order one), and its square.
    np.testing.assert_allclose(carried * scale[:, None] / scale, t.carry * scale[:, None] / scale, atol=1e-5)


@pytest.mark.parametrize("name", MACHINES)
def test_a_leg_command_moves_the_platform_as_kinematics_does(name):
    """Slow commands of leg length on stiff legs: the platform goes where the lengths say."""
    hexapod = plain_machine(name).replace({"gravity": [0, 0, 0]})
    s = fx.linearise(hexapod, away(hexapod)).state_space()
    still = -s.C @ np.linalg.solve(s.A, s.B) + s.D
    H = fx.force_transformation(hexapod, away(hexapod))
    np.testing.assert_allclose(H.T @ still[:6, 18:], np.eye(6), atol=1e-9)  # eps times cond(H) squared at most
    np.testing.assert_allclose(still[6:12, 18:], np.eye(6), atol=1e-9)
    stiffness = hexapod.legs.stiffness.max()
    np.testing.assert_allclose(still[12:18, 18:], 0, atol=1e-9 * stiffness)  # no load, no leg force
    assert EPS * np.linalg.cond(H) ** 2 < 1e-9


def test_a_motion_is_no_pose_at_rest():
    """Its velocities and accelerations would be in the forces that hold it."""
    hexapod = fx.load("motion-base")
    falling = fx.Motion(hexapod.home, acceleration=hexapod.gravity)
    with pytest.raises(fx.PoseError, match="pose is Motion"):
        fx.linearise(hexapod, falling)
    with pytest.raises(fx.PoseError, match="base is Motion"):
        fx.linearise(hexapod, base=fx.Motion.fixed())
