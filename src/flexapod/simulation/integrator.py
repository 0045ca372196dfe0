"""Many simulations of the complete machine at once, integrated in the compiled core: arrays in, arrays out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import number, numbers, one_of, thread_count
from flexapod.conventions import ROTATIONS, TRANSLATIONS, Array, JointModel
from flexapod.errors import ArgumentError, PoseError, shown
from flexapod.excitation.excitation import Excitation, check_use
from flexapod.mechanics.inputs import as_joint, single_base, single_pose
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.mechanics.springs import axial_stiffness, refuse_outside_law
from flexapod.mechanics.statics import hold
from flexapod.pose import Motion, Pose, as_pose
from flexapod.rotations import vector_from_rotation
from flexapod.simulation.run import Load, SimulationRun, Start

Method = Literal["automatic", "runge_kutta"]
METHODS: tuple[str, ...] = get_args(Method)


class Trajectories(NamedTuple):
    """n simulations at m instants; rows after the end of one that was stopped are NaN.

    displacement: (n, m, 6) of the platform from its equilibrium pose, inertial axes, translation (m) and rotation
    vector (rad), with full relative precision however small. relative: the same seen from the base, in its axes: zero
    where the platform rides with the base rigidly. work: (n, m, 4) done by base, external wrench, leg commands and
    friction since t = 0, J (zero unless asked for). platform, base: (n, m, k) motions as `Motion.packed`, and
    leg_force: (n, m, 6) N (m = 0 unless asked for). status: (n,) names of `_core.Outcome`. end_time: (n,) s. last:
    (n, k), the platform's motion then. steps: (n, 4) accepted, rejected, evaluations of the equations of motion,
    exponential steps among those accepted. unstretched_length: (n, 6) m, without commands.
    """

    displacement: Array
    relative: Array
    work: Array
    platform: Array
    base: Array
    leg_force: Array
    status: np.ndarray
    end_time: Array
    last: Array
    steps: np.ndarray
    unstretched_length: Array


@dataclass(frozen=True)
class IntegratorOptions:
    """How accurately and how long to integrate; the arguments of `simulate` with the same names describe them."""

    rtol: float = 1e-9
    atol: float | None = None
    max_step: float = np.inf
    max_steps: float = 1e8
    stop_at_singular: bool = True
    threads: int | None = None
    method: Method = "automatic"

    def __post_init__(self) -> None:
        if not 1e-15 <= number(self.rtol, "rtol") <= 1e-2:
            raise ArgumentError(f"rtol is {self.rtol:g}; it must be between 1e-15 and 1e-2.")
        for name in ("atol", "max_step", "max_steps"):
            value = getattr(self, name)
            try:
                holds = value is None or float(value) > 0
            except (TypeError, ValueError, OverflowError):
                holds = False
            if not holds:
                raise ArgumentError(f"{name} is {shown(value)}; it must be > 0.")
        thread_count(self.threads)
        one_of(self.method, "method", METHODS)


def integrate(
    runs: Sequence[SimulationRun],
    times: ArrayLike,
    *,
    joint: JointModel = "universal",
    options: IntegratorOptions = IntegratorOptions(),
    motions: bool = True,
    works: bool = False,
    progress: Callable[[float], object] | None = None,
) -> Trajectories:
    """Integrate all runs from t = 0 to the last of `times`, (m,) or (n, m) s, ascending, >= 0; on all threads.

    Exponential Adams steps where they are quicker, else Runge-Kutta of order 8 (Dormand and Prince) with an interpolant
    of order 7; orientation on SO(3). A run that cannot go on is data (`status`), not an error. An interrupt stops it.
    `progress` is called with the fraction done, about 20 times a second.
    """
    if len(runs) == 0:
        raise ArgumentError("there is nothing to simulate: `runs` is empty.")
    t = _times(times, len(runs))
    prepared = [prepare(run, until, joint) for run, until in zip(runs, t[:, -1], strict=True)]
    found = _core.simulate(
        [p.setup for p in prepared],
        t,
        _core.SimulationOptions(
            rtol=options.rtol,
            atol=options.atol or 0.0,
            max_step=options.max_step,
            max_steps=options.max_steps,
            stop_at_singular=options.stop_at_singular,
            motions=motions,
            works=works,
            exponential=options.method == "automatic",
            threads=thread_count(options.threads),
        ),
        progress,
    )
    return Trajectories(
        found.displacement,
        found.relative,
        found.work,
        found.platform,
        found.base,
        found.leg_force,
        status=np.array([outcome.name for outcome in found.outcome]),
        end_time=found.time,
        last=found.last,
        steps=found.steps,
        unstretched_length=np.stack([p.unstretched_length for p in prepared]),
    )


def equations(run: SimulationRun, *, joint: JointModel = "universal") -> _core.Equations:
    """Eq. 35 of a run for other integrators and controllers: `start()` gives y, `rates(t, y)` its derivative.

    y: (12,) the platform as seen from the base, in its axes: translation from rest (m), rotation vector from rest (rad,
    below a full turn), velocity, angular velocity.
    """
    return _core.Equations(prepare(run, 0.0, joint).setup)


class Prepared(NamedTuple):
    """One run as the core takes it."""

    setup: _core.SimulationSetup
    unstretched_length: Array


def prepare(run: SimulationRun, until: float, joint: JointModel) -> Prepared:
    """One run to the time `until`, s, as the core takes it."""
    run = run.with_friction(joint)
    pose = single_pose(run.hexapod, run.pose)
    base = single_base(run.hexapod, run.base)
    force, force_history = _split(run.force, "force")
    moment, moment_history = _split(run.moment, "moment")
    if run.unstretched_length is None:
        rest = hold(run.hexapod, pose, base=base, force=force, moment=moment, joint=joint)
        leg_force, lengths = rest.leg_force, rest.unstretched_length
    else:
        lengths = numbers(run.unstretched_length, "unstretched_length", (6,))
        refuse_outside_law(run.hexapod, lengths, "unstretched_length")
        stiffness, _ = axial_stiffness(run.hexapod, lengths)
        leg_force = stiffness * (lengths - inverse_kinematics(run.hexapod, pose, base=base))
    base_motion, command = run.base_motion or Excitation(), run.leg_command or Excitation()
    for use, history in run.histories().items():
        check_use(history, use)
        _check_recordings(use, history, until)
    displacement, velocity = _start(run.start, pose)
    setup = _core.SimulationSetup(
        design=run.hexapod.packed,
        joint=as_joint(joint),
        platform=pose.packed,
        base=Motion.fixed(base).pose.packed,
        leg_force=leg_force,
        wrench=np.concatenate([force, moment]),
        displacement=displacement,
        velocity=velocity,
        roll_pitch_yaw=base_motion.rotation == "rpy",
        carried=isinstance(run.start, str) and run.start == "carried",
        base_motion=base_motion.packed,
        load=np.concatenate([force_history, moment_history]),
        command=command.packed,
    )
    return Prepared(setup, lengths)


def _check_recordings(use: str, history: Excitation, until: float) -> None:
    for term in history.terms:
        if term.last < min(until, term.stop) * (1 - 1e-12):
            raise ArgumentError(
                f"the recording of {use} {term.channel} ends at {term.last:.9g} s, the simulation at {until:.9g} s; "
                "shorten the simulation, or give a longer recording."
            )


def _split(load: Load, name: str) -> tuple[Array, Array]:
    """The constant part of a force or moment, and the packed terms of its history in the wrench's channels."""
    if load is None:
        return np.zeros(3), np.zeros(0)
    if not isinstance(load, Excitation):
        return numbers(load, name, (3,)), np.zeros(0)
    check_use(load, name)
    if name == "force":
        return np.zeros(3), load.packed
    return np.zeros(3), load.on(dict(zip(TRANSLATIONS, ROTATIONS, strict=True))).packed


def _start(start: Start, rest: Pose) -> tuple[Array, Array]:
    """Displacement from rest and velocity at t = 0, (6,) each, inertial axes."""
    if isinstance(start, str):
        one_of(start, "start", ("rest", "carried"))
        return np.zeros(6), np.zeros(6)
    motion = start if isinstance(start, Motion) else Motion(as_pose(start, "start"))
    if motion.shape:
        raise PoseError(f"start has batch axes {motion.shape}; a simulation starts from one motion. Index it first.")
    turn = vector_from_rotation(motion.pose.matrix @ rest.matrix.T)
    displacement = np.concatenate([motion.pose.position - rest.position, turn])
    return displacement, np.concatenate([motion.velocity, motion.angular_velocity])


def _times(times: ArrayLike, n: int) -> Array:
    t = np.asarray(times, dtype=float)
    if t.ndim not in (1, 2) or (t.ndim == 2 and t.shape[0] != n) or t.shape[-1] == 0:
        raise ArgumentError(f"times have shape {t.shape}; (m,) or ({n}, m) is needed")
    if not np.isfinite(t).all() or (t[..., 0] < 0).any() or (np.diff(t, axis=-1) < 0).any():
        raise ArgumentError("times must be finite, >= 0 and ascending: a simulation starts at t = 0 s")
    return np.ascontiguousarray(np.broadcast_to(t, (n, t.shape[-1])))
