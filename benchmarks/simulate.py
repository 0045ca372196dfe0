"""Time per simulated second of the complete machine, against SciPy, SUNDIALS and MuJoCo.

Manipulators I and II, base shaken by 1e-6 m in z at the third mode, relative tolerance 1e-9. SciPy and SUNDIALS call
the very same compiled equations (`flexapod.simulation.integrator.equations`) from Python; one line more is SciPy with
them written in Python around `fx.forward_dynamics`. The candidates take turns and the least CPU time of each counts,
so that a busy machine slows all alike. scikit-sundae and mujoco are optional: pip install scikit-sundae mujoco.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import flexapod as fx
from benchmarks._contest import OURS, Contender, Contest, Plan, cpu_seconds
from benchmarks._machine import missing
from benchmarks._vibration import WANTED, Vibration, machine, own_run, ring, vibration
from flexapod.simulation.integrator import IntegratorOptions, Method, equations, integrate

TURNS = 5
RTOL = 1e-9
ONCE = ("SciPy Radau", "SUNDIALS BDF", "SciPy DOP853, fx.forward_dynamics")  # slow enough to be measured once
MACHINES = {"mukherjee-i": (0.0, 0.0, 0.89), "mukherjee-ii": (0.0, 0.0, 0.085)}


class Candidate(NamedTuple):
    """solve(duration) gives the displacement from rest seen from the base, (12,), at the end."""

    name: str
    duration: float  # s simulated each turn
    solve: Callable[[float], Any]


def contests(plan: Plan) -> list[Contest]:
    """Manipulator II to nine digits against integrators, and to a per cent against other simulators."""
    return [_against_integrators(plan), _against_simulators(plan)]


PACKAGES = {"flexapod": "flexapod", "SciPy": "scipy", "SUNDIALS": "scikit-sundae"}
TIMED = 0.2  # s simulated each turn of the simulators, once the step is found
TOLD = {  # the candidates of the table of all tools, and in which words
    "flexapod": "compiled",
    "SciPy DOP853": "DOP853 on Flexapod's compiled equations",
    "SciPy LSODA": "LSODA on the same",
    "SUNDIALS Adams": "Adams on the same",
    "SciPy DOP853, fx.forward_dynamics": "DOP853 around fx.forward_dynamics",
}


def _against_integrators(plan: Plan) -> Contest:
    name = "mukherjee-ii"
    hexapod, pose = fx.load(name), fx.Pose(MACHINES[name])
    shaken = fx.harmonic("z", 1e-6, fx.natural_modes(hexapod, pose).omega[2])
    run = fx.simulation.SimulationRun(hexapod, pose, base_motion=shaken)
    found = {c.name: c for c in _candidates(run, plan.has("scikit-sundae"))}
    contenders = []
    for name, how in TOLD.items():
        if name in found:
            c = found[name]
            tool = name.split()[0]
            duration = c.duration / plan.size(1, 10)
            error = _error(run, duration, c.solve(duration)) if contenders else None
            timed = cpu_seconds(lambda c=c, T=duration: c.solve(T), duration)
            contenders.append(Contender(OURS if tool == "flexapod" else tool, PACKAGES[tool], how, timed, error, 1e-4))
    return Contest("Simulation, rtol 1e-9", "simulated second", "displacement at the end, relative", contenders)


def _against_simulators(plan: Plan) -> Contest:
    """Each with the largest step or tolerance that is good enough."""
    hexapod, pose = machine()
    trial = vibration(hexapod, pose, 5)
    rtol, samples = 1e-4, 4000
    times = np.linspace(0, trial.duration, samples + 1)
    run, options = own_run(trial), IntegratorOptions(rtol=rtol, threads=1)
    omega, own = ring(integrate([run], times, options=options).relative[0] @ trial.weights, times[1])
    _, amplitude = ring(integrate([run], times).relative[0] @ trial.weights, times[1])
    v = trial._replace(duration=TIMED / plan.size(1, 10))
    timed = cpu_seconds(lambda: integrate([run], [v.duration], options=options, motions=False), v.duration)
    error, how = abs(omega / trial.omega - 1), f"rtol {rtol:g}, {_lost(own / amplitude)}"
    contenders = [Contender(OURS, "flexapod", how, timed, error, WANTED)]
    if plan.has("mujoco-core"):
        contenders.append(_mujoco(v, trial, amplitude))
    if plan.has("exudyn"):
        contenders.append(_exudyn(v, trial, amplitude))
    return Contest("Simulation, fastest mode to 1 %", "simulated second", "frequency, relative", contenders)


def _lost(share: float) -> str:
    return f"amplitude {share - 1:+.1%}"


def _mujoco(v: Vibration, trial: Vibration, amplitude: float) -> Contender:
    from benchmarks import _mujoco

    runs = []
    for integrator in _mujoco.INTEGRATORS:
        for step in _mujoco.STEPS:
            omega, last = ring(_mujoco.ringing(trial, integrator, step), step)
            if abs(omega / v.omega - 1) < WANTED:
                run = _mujoco.Simulation(v, integrator, step)
                how = f"{integrator}, {step:g} s a step, {_lost(last / amplitude)}"
                runs.append((run.cpu_seconds(), run, how, abs(omega / v.omega - 1)))
                break
    _, run, how, error = min(runs, key=lambda r: r[0])
    return Contender("MuJoCo", "mujoco-core", how, lambda: run.cpu_seconds() / v.duration, error, WANTED)


def _exudyn(v: Vibration, trial: Vibration, amplitude: float) -> Contender:
    from benchmarks._exudyn import STEPS, Machine

    for step in STEPS:
        recorded = Machine(v.hexapod, v.pose, v.wrench)
        recorded.record()
        recorded.simulate(trial.duration, step)
        omega, last = ring(recorded.recorded() @ v.weights, step)
        error = abs(omega / v.omega - 1)
        if error < WANTED:
            break
    plain = Machine(v.hexapod, v.pose, v.wrench)
    how = f"trapezoidal rule, {step:g} s a step, {_lost(last / amplitude)}"
    return Contender("Exudyn", "exudyn", how, lambda: plain.simulate(v.duration, step) / v.duration, error, WANTED)


def main() -> None:
    """Print a table for each machine."""
    for name, position in MACHINES.items():
        hexapod, pose = fx.load(name), fx.Pose(position)
        omega = fx.natural_modes(hexapod, pose).omega
        run = fx.simulation.SimulationRun(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, omega[2]))
        print(f"{name}: modes {omega[0]:.4g} to {omega[-1]:.5g} rad/s, rtol {RTOL:g}")
        _table(run, _candidates(run, not missing("scikit-sundae")))
    print("mukherjee-ii with damped legs")
    _damped()
    _many()
    if not missing("mujoco-core"):
        from benchmarks import _mujoco

        _mujoco.main()


def _candidates(run: fx.simulation.SimulationRun, sundials: bool) -> list[Candidate]:
    def flexapod(duration: float, works: bool = False, method: Method = "automatic") -> Any:
        options = IntegratorOptions(rtol=RTOL, threads=1, method=method)
        return integrate([run], [duration], options=options, motions=False, works=works).relative[0, 0]

    eq = equations(run)
    y0, scale = eq.start(), _scale(run)
    candidates = [
        Candidate("flexapod", 0.25, flexapod),
        Candidate("flexapod with energy balance", 0.25, lambda T: flexapod(T, works=True)),
        Candidate("flexapod, Runge-Kutta steps alone", 0.25, lambda T: flexapod(T, method="runge_kutta")),
    ]
    written = _written_in_python(run)
    start = np.concatenate([run.pose.position, [0, 0, 0, 1], np.zeros(6)])
    fine = np.concatenate([scale[:6], scale[5:6], scale[6:]])
    candidates.append(
        Candidate(
            "SciPy DOP853, fx.forward_dynamics",
            0.002,
            lambda T: _seen(run, T, solve_ivp(written, (0, T), start, "DOP853", rtol=RTOL, atol=RTOL * fine).y[:, -1]),
        )
    )
    for method, duration in (("DOP853", 0.05), ("LSODA", 0.05), ("Radau", 0.002)):
        candidates.append(
            Candidate(
                f"SciPy {method}",
                duration,
                lambda T, m=method: solve_ivp(eq.rates, (0, T), y0, m, rtol=RTOL, atol=RTOL * scale).y[:6, -1],
            )
        )
    return candidates + (_sundials(eq, y0, scale) if sundials else [])


def _written_in_python(run: fx.simulation.SimulationRun) -> Callable[[float, Any], Any]:
    """Eq. 35 as a user writes it: absolute position, quaternion, velocities."""
    hexapod = run.hexapod
    unstretched = fx.hold(hexapod, run.pose).unstretched_length

    def rates(t: float, z: Any) -> Any:
        base = run.base_motion.motion(t)
        platform = fx.Motion(fx.Pose(z[:3], Rotation.from_quat(z[3:7])), z[7:10], z[10:])
        stretch = fx.inverse_kinematics(hexapod, platform.pose, base=base.pose) - unstretched
        a, alpha = fx.forward_dynamics(hexapod, platform, base=base, leg_force=-hexapod.legs.stiffness * stretch)
        w, q = z[10:], z[3:7]
        return np.concatenate([z[7:10], 0.5 * (w * q[3] + np.cross(w, q[:3])), [-0.5 * w @ q[:3]], a, alpha])

    return rates


def _seen(run: fx.simulation.SimulationRun, t: float, z: Any) -> Any:
    """Displacement from rest seen from the base, for a base that does not turn."""
    base = run.base_motion.motion(t)
    return np.concatenate([z[:3] - base.pose.position - run.pose.position, Rotation.from_quat(z[3:7]).as_rotvec()])


def _scale(run: fx.simulation.SimulationRun) -> Any:
    """Largest displacement, rotation, velocity, angular velocity, each three times: what absolute errors refer to."""
    found = integrate([run], np.linspace(0, 0.02, 2000))
    x, rate = found.relative[0], np.gradient(found.relative[0], 1e-5, axis=0)
    return np.repeat([np.abs(part).max() for part in (x[:, :3], x[:, 3:], rate[:, :3], rate[:, 3:])], 3)


def _sundials(eq: Any, y0: Any, scale: Any) -> list[Candidate]:
    from sksundae.cvode import CVODE

    def rates(t: float, y: Any, out: Any) -> None:
        out[:] = eq.rates(t, np.ascontiguousarray(y))

    def solve(duration: float, method: str) -> Any:
        solver = CVODE(rates, method=method, rtol=RTOL, atol=RTOL * scale, max_num_steps=10**7)
        return np.asarray(solver.solve(np.array([0, duration]), y0).y)[-1, :6]

    return [Candidate(f"SUNDIALS {m}", 0.02, lambda T, m=m: solve(T, m)) for m in ("Adams", "BDF")]


def _table(run: fx.simulation.SimulationRun, candidates: list[Candidate]) -> None:
    least = dict.fromkeys((c.name for c in candidates), np.inf)
    error = {}
    for turn in range(TURNS):
        for c in candidates:
            if turn and c.name in ONCE:
                continue
            began = time.process_time()
            end = c.solve(c.duration)
            least[c.name] = min(least[c.name], (time.process_time() - began) / c.duration)
            error[c.name] = _error(run, c.duration, end)
    ours = least["flexapod"]
    for name, seconds in least.items():
        print(
            f"  {name:34s} {seconds:9.3f} s per simulated second, {seconds / ours:7.1f} times; error {error[name]:.0e}"
        )


def _error(run: fx.simulation.SimulationRun, duration: float, end: Any) -> float:
    options = IntegratorOptions(rtol=1e-13, atol=1e-20, method="runge_kutta")
    exact = integrate([run], [0.5 * duration, duration], options=options).relative[0, -1]
    return max(np.abs(end[i] - exact[i]).max() / np.abs(exact[i]).max() for i in (slice(0, 3), slice(3, 6)))


def _damped() -> None:
    """Where an implicit method would be better: legs with ever more damping, 0.02 s at rtol 1e-6."""
    for damping in (1e-3, 1e4, 1e5, 1e6):
        hexapod = fx.load("mukherjee-ii").replace({"legs.damping.prismatic": damping})
        run = fx.simulation.SimulationRun(
            hexapod, fx.Pose(MACHINES["mukherjee-ii"]), base_motion=fx.harmonic("z", 1e-6, 750.0)
        )
        eq, scale = equations(run), _scale(run)
        began = time.process_time()
        integrate([run], [0.02], options=IntegratorOptions(rtol=1e-6, threads=1), motions=False)
        ours = time.process_time() - began
        began = time.process_time()
        solve_ivp(eq.rates, (0, 0.02), eq.start(), "Radau", rtol=1e-6, atol=1e-6 * scale)
        radau = time.process_time() - began
        print(f"  {damping:7g} N s/m: flexapod {1e3 * ours:6.1f} ms, SciPy Radau {1e3 * radau:6.1f} ms")


def _many() -> None:
    hexapod, pose = fx.load("mukherjee-ii"), fx.Pose(MACHINES["mukherjee-ii"])
    runs = [
        fx.simulation.SimulationRun(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, w))
        for w in np.linspace(300, 900, 200)
    ]
    for threads in (1, None):
        began = time.perf_counter()
        integrate(runs, [0.1], options=IntegratorOptions(rtol=RTOL, threads=threads), motions=False)
        words = "one thread" if threads else "all threads"
        print(f"200 simulations of 0.1 s on {words}: {time.perf_counter() - began:.2f} s")


if __name__ == "__main__":
    main()
