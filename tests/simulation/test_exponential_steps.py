"""Exponential Adams steps against SciPy's integrator, the matrix exponential, conservation laws and Runge-Kutta steps."""

from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from tests.helpers.drawn import machine as drawn
from tests.helpers.drawn import sprung, with_round_legs
from tests.helpers.plain import plain_machine
from tests.helpers.support import JOINTS, displaced

import flexapod as fx
from flexapod.errors import ArgumentError, SimulationError
from flexapod.simulation.integrator import IntegratorOptions, equations, integrate

RUNGE_KUTTA = IntegratorOptions(method="runge_kutta", threads=1)
AUTOMATIC = IntegratorOptions(threads=1)
FRICTION = {
    f"legs.damping.{joint}": c
    for joint, c in zip(("prismatic", "universal", "spherical"), (30.0, 0.1, 0.1), strict=True)
}
TABLE = {
    "legs.stiffness": None,
    "legs.stiffness_law": {"kind": "table", "lengths": [0.1, 0.2, 0.4], "stiffnesses": [2e7, 1.5e7, 1e7]},
}


def machines():
    plain = plain_machine("precision-positioner")
    return {
        "plain": plain,
        "friction": plain.replace(FRICTION),
        "law": plain.replace(TABLE),
        "springs and suspension": with_round_legs(sprung(drawn(2), np.random.default_rng(2))),
    }


MACHINES = machines()


class Motions(NamedTuple):
    """Scales of a machine: its size, m, and its lowest and highest frequency, rad/s."""

    size: float
    low: float
    high: float

    def base(self, kind):
        if kind == "small":
            return fx.harmonic("z", 1e-6 * self.size, 1.5 * self.low)
        if kind == "shock":
            return fx.half_sine_shock("z", 5.0, 20.0 / self.high)
        if kind == "floor":
            spectrum = fx.excitation.flat_spectrum(0.5, 0.1 * self.low, 2.0 * self.low)
            return fx.random_motion("x", spectrum, samples=60)
        return fx.harmonic("roll", 0.2, 0.1 * self.low) + fx.harmonic("x", 0.05 * self.size, 0.05 * self.low)


KINDS = ("small", "shock", "floor", "swing")


def motions(hexapod, joint="universal"):
    omega = fx.natural_modes(hexapod, joint=joint).omega
    return Motions(float(np.linalg.norm(hexapod.platform_joints, axis=1).mean()), float(omega[0]), float(omega[-1]))


def run_of(hexapod, kind, joint="universal"):
    """The run, and a duration of about 500 rad of the fastest mode."""
    scales = motions(hexapod, joint)
    command = fx.harmonic("2", 1e-6 * scales.size, 0.5 * scales.low) if kind == "floor" else None
    return fx.simulation.SimulationRun(hexapod, base_motion=scales.base(kind), leg_command=command), 500 / scales.high


def scipys(run, times, joint):
    """The displacement seen from the base by SciPy's integrator, (m, 6)."""
    eq, scales = equations(run, joint=joint), motions(run.hexapod, joint)
    largest = reach(integrate([run], times, joint=joint, options=RUNGE_KUTTA).relative[0], scales.size)
    atol = 1e-11 * largest * np.repeat([1.0, 1.0 / scales.size, scales.low, scales.low / scales.size], 3)
    return solve_ivp(eq.rates, (0, times[-1]), eq.start(), "DOP853", rtol=1e-11, atol=atol, t_eval=times).y[:6].T


def reach(displacement, size):
    """The largest translation, or rotation at the machine's size, m."""
    return max(np.abs(displacement[:, :3]).max(), size * np.abs(displacement[:, 3:]).max())


def apart(found, expected, size):
    return reach(found - expected, size) / reach(expected, size)


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", MACHINES)
def test_motions_and_works_at_samples_inside_steps(name, kind, joint):
    """Motions are SciPy's, but for the machine with springs, for which that integrator's steps become too small; works, and
    motions of that machine, are those of Runge-Kutta steps with a thousandth of the error.
    """
    run, duration = run_of(MACHINES[name], kind, joint)
    times = np.linspace(0, duration, 101)
    size = motions(MACHINES[name], joint).size
    found = integrate([run], times, joint=joint, options=AUTOMATIC, works=True)
    assert found.status == ["complete"]
    assert found.steps[0, 3] > 0 or kind == "swing"
    exact = integrate([run], times, joint=joint, options=IntegratorOptions(1e-12, method="runge_kutta"), works=True)
    motion = exact.relative[0] if name == "springs and suspension" else scipys(run, times, joint)
    assert apart(found.relative[0], motion, size) < 1e-7
    assert np.abs(found.work - exact.work).max() < 1e-7 * np.abs(exact.work).max()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii", "precision-positioner", "motion-base"])
def test_automatic_choice_costs_no_more(name, kind):
    """In evaluations, of which exponential steps need the algebra of a third of one beside their own."""
    run, duration = run_of(plain_machine(name), kind)
    auto, fixed = (
        integrate([run], [4 * duration], options=o, motions=False).steps[0] for o in (AUTOMATIC, RUNGE_KUTTA)
    )
    assert fixed[3] == 0
    assert auto[2] + 0.3 * auto[3] < 1.05 * fixed[2] + 300  # 300: one beginning that leads to nothing
    if kind == "small":
        assert auto[2] < 0.3 * fixed[2]


@pytest.mark.parametrize("joint", JOINTS)
def test_small_vibrations_are_the_matrix_exponential(joint):
    """What steps of 1.5 radians of the fastest mode leave is the motion's own non-linearity."""
    hexapod = MACHINES["friction"]
    scales = motions(hexapod, joint)
    start = 1e-8 * np.array([1.0, -2.0, 3.0, 20.0, 10.0, -5.0]) * np.repeat([scales.size, 1.0], 3)
    pose = fx.home_pose(hexapod)
    state = fx.linearise(hexapod, pose, joint=joint)
    times = np.linspace(0, 300 / scales.high, 8)
    back = -np.linalg.solve(state.M, np.hstack([state.K, state.C]))
    A = np.vstack([np.eye(12)[6:], back])
    expected = np.stack([(expm(A * t) @ np.concatenate([start, np.zeros(6)]))[:6] for t in times])
    run = fx.simulation.SimulationRun(hexapod, pose, start=displaced(pose, start))
    found = integrate([run], times, joint=joint, options=AUTOMATIC)
    assert found.steps[0, 3] > 100
    assert apart(found.relative[0], expected, scales.size) < 1e-5


def test_errors_go_with_the_tolerance():
    run = fx.simulation.SimulationRun(MACHINES["plain"], start=fx.Pose(fx.home_pose(MACHINES["plain"]).position + 3e-4))
    times = np.linspace(0, 400 / motions(MACHINES["plain"]).high, 31)
    exact = scipys(run, times, "universal")
    found = [integrate([run], times, options=IntegratorOptions(rtol)) for rtol in (1e-5, 1e-7, 1e-9)]
    assert all(f.steps[0, 3] > 0 for f in found)
    errors = [apart(f.relative[0], exact, motions(MACHINES["plain"]).size) for f in found]
    assert errors[0] > 5 * errors[1] > 25 * errors[2]


def test_energy_is_kept_for_a_thousand_periods_by_exponential_steps():
    hexapod = MACHINES["plain"].replace(dict.fromkeys(FRICTION, 0.0))
    scales, pose = motions(hexapod), fx.home_pose(hexapod)
    start = fx.Motion(fx.Pose(pose.position + 1e-5 * scales.size), [0.01, 0.0, -0.02], [0.03, 0.05, -0.04])
    found = fx.simulate(hexapod, start=start, duration=2000 * np.pi / scales.low, samples=200, rtol=1e-12)
    assert found.attrs["exponential_steps"] > 0.9 * found.attrs["steps"]
    assert found.attrs["energy_error"] < 1e-8


@pytest.mark.parametrize("method", ["automatic", "runge_kutta"])
def test_a_pose_that_is_singular_ends_both_methods_there(method):
    """Legs driven slowly, with the platform hardly shaken, until no leg forces hold it."""
    hexapod = plain_machine("mukherjee-ii")
    pose = fx.Pose([0, 0, 0.085])
    command = sum((fx.excitation.polynomial(leg, [0.0, 0.3]) for leg in "135"), fx.Excitation())
    with pytest.raises(SimulationError) as caught:
        fx.simulate(hexapod, pose, leg_command=command, duration=1.0, samples=50, method=method, energies=False)
    ended = caught.value.result.attrs
    assert (ended["exponential_steps"] > 0) == (method == "automatic")
    H = fx.force_transformation(hexapod, caught.value.pose)
    singular_values = np.linalg.svd(H, compute_uv=False)
    assert ended["status"] == "singular"
    assert singular_values[-1] < 1e-6 * singular_values[0]


def test_what_was_done_is_told():
    hexapod = MACHINES["plain"]
    shaken = fx.harmonic("z", 1e-6, 400.0)
    auto = fx.simulate(hexapod, base_motion=shaken, duration=0.2, samples=10)
    fixed = fx.simulate(hexapod, base_motion=shaken, duration=0.2, samples=10, method="runge_kutta")
    assert 0 < auto.attrs["exponential_steps"] < auto.attrs["steps"]
    assert fixed.attrs["exponential_steps"] == 0
    assert auto.attrs["method"].startswith("exponential Adams")
    assert fixed.attrs["method"].startswith("Runge-Kutta")
    with pytest.raises(ArgumentError, match=r"method is 'adams'; it must be one of 'automatic', 'runge_kutta'"):
        fx.simulate(hexapod, duration=0.1, method="adams")


def test_longest_steps_are_kept_to():
    run, duration = run_of(MACHINES["plain"], "small")
    longest = 0.4 / motions(MACHINES["plain"]).high
    found = integrate([run], [duration], options=IntegratorOptions(max_step=longest))
    assert found.steps[0, 3] > 0
    assert found.steps[0, 0] >= duration / longest
