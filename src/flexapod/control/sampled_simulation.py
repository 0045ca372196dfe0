"""A sampled controller on the non-linear machine over a shaking base, beside what the tangent predicts of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Unpack

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.linalg import expm

from flexapod import _core
from flexapod.control.closed_loop_poles import assess, unstable_words
from flexapod.control.plant import MEASURES, Controller, Plant, static
from flexapod.conventions import AXES, LEGS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, SimulationError, UnstableError
from flexapod.excitation.excitation import Excitation
from flexapod.mechanics.inputs import ZERO, as_joint
from flexapod.mechanics.linearisation import RestOptions, linearise
from flexapod.pose import Pose
from flexapod.simulation.integrator import OUTCOMES, prepare
from flexapod.simulation.run import SimulationRun

CASES = ("controlled", "passive")
_SIGNALS = 6 * len(MEASURES)
_TURN_A_STEP = 0.5  # rad of the fastest mode: the method of order 8 then errs by less than 1e-8 a step
_FINER = 8  # the tangent's steps within one of the simulation, over which base acceleration runs straight


@dataclass(frozen=True)
class Hardware:
    """What actuators and sensors leave of a controller.

    force_limit: N, largest force of each leg's actuator, a number or six. noise: root mean square of the white noise on
    each kind of measurement (see `Controller`), in its unit, a number or six, as `{"acceleration": 1e-3}`. seed: of the
    noise.

    Source: own.
    """

    force_limit: ArrayLike = np.inf
    noise: Mapping[str, ArrayLike] = field(default_factory=dict)
    seed: int = 0

    def limits(self) -> Array:
        """Largest force of each leg's actuator, (6,) N.

        Raises: ArgumentError for limits that are not > 0, or neither one nor six.
        """
        try:
            limit = np.broadcast_to(np.asarray(self.force_limit, dtype=np.float64), (6,)).copy()
        except (TypeError, ValueError):
            raise ArgumentError(f"force_limit is {self.force_limit!r}; give a number, or six for the legs") from None
        if not (limit > 0).all():
            raise ArgumentError(f"force_limit is {self.force_limit!r} N; it must be > 0")
        return limit

    def drawn(self, samples: int) -> Array:
        """(samples, 36) noise on every measurement.

        Raises: ArgumentError for a measurement that is none, or noise below zero.
        """
        rms = np.zeros(_SIGNALS)
        for name, value in self.noise.items():
            if name not in MEASURES:
                raise ArgumentError(f"noise names {name!r}; there are {', '.join(MEASURES)}")
            part = np.asarray(value, dtype=np.float64)
            if part.shape not in ((), (6,)) or not np.isfinite(part).all() or (part < 0).any():
                raise ArgumentError(f"noise of {name} is {value!r}; give a finite number >= 0, or six")
            rms[_columns(name)] = part
        drawn: Array = rms * np.random.default_rng(self.seed).standard_normal((samples, _SIGNALS))
        return drawn


def simulate_control(
    hexapod: Hexapod,
    pose: Pose,
    controller: Controller,
    base_motion: Excitation,
    duration: float,
    *,
    hardware: Hardware = Hardware(),
    after: float = 0.0,
    progress: Callable[[float], Any] | None = None,
    **rest: Unpack[RestOptions],
) -> xr.Dataset:
    """The non-linear machine on a moving base, with a sampled controller and without.

    controller: sampled (see `Controller.sampled`); its forces are held between samples. base_motion: of the base from
    its pose at rest; at t = 0 the platform moves with it. duration: s. hardware: what actuators and sensors leave of
    the controller. after: root mean squares are taken from this time on, s. rest: as for `linearise`.

    Dataset over (case, time, axis), cases "controlled" and "passive": `acceleration`, absolute, m/s2 and rad/s2;
    `displacement` from rest, inertial axes, m and rad; `relative`, the same seen from the base; over (sample_time,
    leg): `force`, N. Over (case, axis): `rms_acceleration`, `rms_displacement`, and what the exact tangent predicts of
    both for the same base motion, sampling and noise but without force limits, `predicted_...`. Attributes: saturated,
    the share of samples at which a force was limited; steps, of the integrator in each sample.

    Raises: UnstableError where the tangent shows the sampled loop to be unstable; SimulationError where the machine
    passes a singular pose or the motion grows without bound; ArgumentError for a controller that is not sampled, or
    wrong times; PoseError and SingularPoseError as `linearise`.
    Source: own; the machine is that of Eq. 35.
    """
    plant = Plant(linearise(hexapod, pose, **rest))
    dt = _checked(plant, controller, duration, after)
    samples = round(duration / dt)
    steps = max(1, int(np.ceil(dt * plant.omega_0 / _TURN_A_STEP)))
    noise, limits = hardware.drawn(samples), hardware.limits()
    bench = _Bench(hexapod, pose, base_motion, rest, dt, samples, steps)
    idle = static(np.zeros((6, 6)), ("leg_rate",), "no control")
    found, predicted = {}, {}
    for number, (case, law) in enumerate(zip(CASES, (controller, idle), strict=True)):
        report = None if progress is None else _part(progress, 0.5 * number, 0.5)
        found[case] = bench.run(law, limits, noise, report)
        predicted[case] = bench.predict(plant, law, noise)
    return _dataset(bench, found, predicted, after).assign_attrs(
        design=hexapod.name,
        digest=hexapod.digest,
        controller=controller.name,
        dt_s=dt,
        steps=steps,
        saturated=float(found["controlled"].cut.mean()),
    )


def _checked(plant: Plant, controller: Controller, duration: float, after: float) -> float:
    """The sampling time, s, of a controller that can be run."""
    if controller.dt is None:
        raise ArgumentError(f"{controller.name} is continuous; sample it first: controller.sampled(dt)")
    if not (np.isfinite(duration) and duration > after >= 0 and duration >= controller.dt):
        raise ArgumentError(
            f"duration is {duration} s and after is {after} s; a sample of {controller.dt:.5g} s must fit, and "
            "duration must be > after >= 0"
        )
    loop = assess(plant, controller)
    if not loop.stable:
        raise UnstableError(unstable_words(loop))
    return controller.dt


def _part(progress: Callable[[float], Any], first: float, share: float) -> Callable[[float], Any]:
    return lambda done: progress(first + share * done)


class _Found(NamedTuple):
    measured: Array  # (rows, 36)
    displacement: Array  # (rows, 6)
    force: Array  # (samples, 6)
    cut: Array  # (samples,)


@dataclass(frozen=True)
class _Bench:
    """One shaken machine and a clock."""

    hexapod: Hexapod
    pose: Pose
    base_motion: Excitation
    rest: RestOptions
    dt: float
    samples: int
    steps: int

    @property
    def times(self) -> Array:
        """(rows,) at which motions are recorded, s."""
        return np.asarray(np.arange(self.samples * self.steps + 1) * (self.dt / self.steps), dtype=np.float64)

    def run(self, law: Controller, limit: Array, noise: Array, progress: Callable[[float], Any] | None) -> _Found:
        """The simulation in the core."""
        run = SimulationRun(
            self.hexapod,
            self.pose,
            base_motion=self.base_motion,
            force=self.rest.get("force", ZERO),
            moment=self.rest.get("moment", ZERO),
            base=self.rest.get("base"),
            start="carried",
        )
        joint = self.rest.get("joint", "universal")
        ready = prepare(run, self.samples * self.dt, joint)
        *rows, outcome = _core.control_loop(
            self.hexapod.packed,
            as_joint(joint),
            ready.setup,
            ready.excitations[0],
            [*_wide(law), limit],
            noise,
            np.array([self.dt, float(self.steps)]),
            progress,
        )
        found = _Found(*rows)
        how = OUTCOMES[int(outcome[0])]
        if how != "complete":
            last = int(np.isfinite(found.displacement[:, 0]).sum()) - 1
            raise SimulationError(
                f"the simulation of {law.name} ended at t = {self.times[last]:.6g} s: {how.replace('_', ' ')}. Shake "
                "the base less, or lower the gains.",
                time=float(self.times[last]),
            )
        return found

    def predict(self, plant: Plant, law: Controller, noise: Array) -> _Found:
        """The same on the tangent, without force limits: exact but for base acceleration, straight over short steps."""
        fine = self.steps * _FINER
        h = self.dt / fine
        A, B, start, end = _ramped(plant, h)
        at = np.arange(self.samples * fine + 1) * h
        value, _, acceleration = self.base_motion.evaluate(at)
        w = np.concatenate([acceleration, value], axis=1)
        drive = (w[:-1] @ start.T + w[1:] @ end.T).reshape(self.samples, fine, 12)
        shaken = np.zeros((self.samples, 12))
        by_base = np.empty((self.samples, self.steps, 12))
        by_state, by_force = np.eye(12), np.zeros((12, 6))
        maps = []
        for i in range(fine):
            shaken = shaken @ A.T + drive[:, i]
            by_state, by_force = A @ by_state, A @ by_force + B
            if (i + 1) % _FINER == 0:
                by_base[:, i // _FINER] = shaken
                maps.append((by_state, by_force))
        to_state, to_force = (np.stack(m) for m in zip(*maps, strict=True))
        z, force, x = np.zeros(12), np.zeros(6), np.zeros(law.order)
        rows = plant.measured(law.measures)
        C, D, G = plant.C[rows], plant.D[rows], plant.G[rows]
        forces = np.empty((self.samples, 6))
        states = np.empty((self.samples, self.steps, 12))
        for k in range(self.samples):
            y = C @ z + D @ force + G @ w[k * fine] + noise[k, rows]
            force, x = law.C @ x + law.D @ y, law.A @ x + law.B @ y
            forces[k] = force
            states[k] = to_state @ z + to_force @ force + by_base[k]
            z = states[k, -1]
        every = np.vstack([np.zeros(12), states.reshape(-1, 12)])
        held = np.vstack([np.zeros(6), np.repeat(forces, self.steps, axis=0)])
        base = w[::_FINER]
        measured = every @ plant.C.T + held @ plant.D.T + base @ plant.G.T
        displacement = measured[:, _columns("position")] + value[::_FINER] @ plant.linear.carry.T
        return _Found(measured, displacement, forces, np.zeros(self.samples))


def _columns(measure: str) -> slice:
    """Where one kind of measurement is among all of them."""
    first = 6 * MEASURES.index(measure)
    return slice(first, first + 6)


def _wide(law: Controller) -> list[Array]:
    """A, B, C, D of a controller that is shown all 36 measurements."""
    columns = np.concatenate([np.arange(6) + 6 * MEASURES.index(name) for name in law.measures])
    B, D = np.zeros((law.order, _SIGNALS)), np.zeros((6, _SIGNALS))
    B[:, columns], D[:, columns] = law.B, law.D
    return [np.ascontiguousarray(m) for m in (law.A, B, law.C, D)]


def _ramped(plant: Plant, h: float) -> tuple[Array, Array, Array, Array]:
    """Over a step h: z' = A z + B f + E_0 w(start) + E_1 w(end), the force held and w running straight."""
    whole = np.zeros((42, 42))
    whole[:12] = np.hstack([plant.A, plant.B, plant.E, np.zeros((12, 12))])
    whole[18:30, 30:] = np.eye(12) / h
    step = expm(h * whole)
    rising = step[:12, 30:]
    return step[:12, :12], step[:12, 12:18], step[:12, 18:30] - rising, rising


def _dataset(bench: _Bench, found: dict[str, _Found], predicted: dict[str, _Found], after: float) -> xr.Dataset:
    times = bench.times
    kept = times >= after
    parts = {
        "acceleration": (
            lambda f: f.measured[:, _columns("acceleration")],
            "absolute acceleration",
            ("m/s2", "rad/s2"),
        ),
        "displacement": (lambda f: f.displacement, "displacement from rest", ("m", "rad")),
        "relative": (lambda f: f.measured[:, _columns("position")], "displacement relative to the base", ("m", "rad")),
    }
    variables: dict[str, Any] = {}
    for name, (take, words, _) in parts.items():
        values = np.stack([take(found[case]) for case in CASES])
        variables[name] = (("case", "time", "axis"), values, {"long_name": words})
        if name == "relative":
            continue
        for prefix, source in (("", found), ("predicted_", predicted)):
            rms = np.stack([np.sqrt((take(source[case])[kept] ** 2).mean(axis=0)) for case in CASES])
            variables[f"{prefix}rms_{name}"] = (("case", "axis"), rms, {"long_name": f"root mean square {words}"})
    variables["force"] = (
        ("sample_time", "leg"),
        found["controlled"].force,
        {"units": "N", "long_name": "leg force of the controller"},
    )
    units = [["m/s2"] * 3 + ["rad/s2"] * 3, ["m"] * 3 + ["rad"] * 3]
    return xr.Dataset(
        variables,
        {
            "case": list(CASES),
            "time": ("time", times, {"units": "s"}),
            "sample_time": ("sample_time", times[:: bench.steps][:-1], {"units": "s"}),
            "axis": list(AXES),
            "leg": list(LEGS),
            "acceleration_unit": ("axis", units[0]),
            "displacement_unit": ("axis", units[1]),
        },
        {"position_m": bench.pose.position.tolist(), "rpy_rad": bench.pose.rpy.tolist()},
    )
