"""Many simulations of the complete machine at once, integrated in the compiled core: arrays in, arrays out."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.conventions import AXES, LEGS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError
from flexapod.excitation.excitation import Excitation, check_channels
from flexapod.mechanics.inputs import is_universal
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.mechanics.statics import hold
from flexapod.pose import Motion, Pose, vectors

OUTCOMES = (
    "complete",
    "singular",
    "leg_collapsed",
    "joint_locked",
    "step_collapse",
    "not_finite",
    "max_steps",
    "stopped",
)

Load = Excitation | ArrayLike | None
Start = Literal["rest", "carried"] | Pose | Motion


@dataclass(frozen=True, eq=False)
class Run:
    """One simulation: a machine at rest in `pose` on its base, and what drives it from t = 0.

    hexapod: the design. pose: the equilibrium, inertial frame; the legs' unstretched lengths are those that hold it
    there under gravity and the constant loads, unless `unstretched_length` (6,) m gives others (the lengths at the pose
    let gravity ring). base_motion: `Excitation` of x, y, z, roll, pitch, yaw from the base's pose at rest, `base`
    (default: the origin). force (N), moment (N m): on the platform, in its axes, at its reference point; constant (3,),
    or an Excitation, which comes on top of rest. leg_command: Excitation of legs "1" to "6", change of unstretched
    length, m. start: "rest" (at the equilibrium, with no velocity in the inertial frame), "carried" (moving rigidly
    with the base as it is at t = 0), or a Pose or Motion of the platform in the inertial frame.

    Raises: PoseError for a pose or base that is not one Pose; the rest is checked when it is simulated.
    Source: Eq. 35; E6.
    """

    hexapod: Hexapod
    pose: Pose
    base_motion: Excitation | None = None
    force: Load = None
    moment: Load = None
    leg_command: Excitation | None = None
    start: Start = "rest"
    base: Pose | None = None
    unstretched_length: ArrayLike | None = None

    def __post_init__(self) -> None:
        for name in ("pose", "base"):
            value = getattr(self, name)
            if not (isinstance(value, Pose) or (name == "base" and value is None)):
                raise PoseError(f"{name} is {value!r}; a simulation takes a Pose")
            if value is not None and value.shape:
                raise PoseError(f"{name} has batch axes {value.shape}; a simulation takes one pose. Index it first.")

    def histories(self) -> dict[str, Excitation]:
        """What drives the machine in time, by name."""
        uses = {
            "base_motion": self.base_motion,
            "force": self.force,
            "moment": self.moment,
            "leg_command": self.leg_command,
        }
        return {name: use for name, use in uses.items() if isinstance(use, Excitation)}


class Trajectories(NamedTuple):
    """n simulations at m instants; rows after the end of one that was stopped are NaN.

    displacement: (n, m, 6) of the platform from its equilibrium pose, inertial axes, translation (m) and rotation
    vector (rad), with full relative precision however small. relative: the same seen from the base, in its axes: zero
    where the platform rides with the base rigidly. work: (n, m, 4) done by base, external wrench, leg commands and
    friction since t = 0, J (zero unless asked for). platform, base: (n, m, 24) motions as `Motion.packed`, and
    leg_force: (n, m, 6) N (m = 0 unless asked for). status: (n,) of OUTCOMES. end_time: (n,) s. last: (n, 24), the
    platform's motion then. steps: (n, 3) accepted, rejected, evaluations of the equations of motion.
    unstretched_length: (n, 6) m, without commands.
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
class Method:
    """How accurately and how long to integrate.

    rtol: error of one step relative to the displacement and speed of the last periods of the slowest mode. atol: m, the
    absolute part (default 1e-16 of the platform's size: rounding). max_step: s. max_steps: per simulation.
    stop_at_singular: end where H becomes singular (det H changes sign). threads: default all.
    """

    rtol: float = 1e-9
    atol: float | None = None
    max_step: float = np.inf
    max_steps: float = 1e8
    stop_at_singular: bool = True
    threads: int | None = None

    def __post_init__(self) -> None:
        if not 1e-15 <= self.rtol <= 1e-2:
            raise ArgumentError(f"rtol is {self.rtol:g}; it must be between 1e-15 and 1e-2.")
        for name in ("atol", "max_step", "max_steps", "threads"):
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise ArgumentError(f"{name} is {value}; it must be > 0.")


def integrate(
    runs: Sequence[Run],
    times: ArrayLike,
    *,
    joint: JointModel = "universal",
    method: Method = Method(),
    motions: bool = True,
    works: bool = False,
    progress: Callable[[float], object] | None = None,
) -> Trajectories:
    """Integrate all runs from t = 0 to the last of `times`, (m,) or (n, m) s, ascending, >= 0; on all threads.

    Method: Runge-Kutta of order 8 (Dormand and Prince) with an interpolant of order 7, orientation on SO(3)
    (corrections E7). Errors are those of `Run`'s parts; what happens later is data (`status`). An interrupt stops it.
    `progress` is called with the fraction done, about 20 times a second.
    """
    if not runs:
        raise ArgumentError("there is nothing to simulate: `runs` is empty.")
    t = _times(times, len(runs))
    prepared = [prepare(run, until, joint) for run, until in zip(runs, t[:, -1], strict=True)]
    options = [
        method.rtol,
        method.atol or 0.0,
        method.max_step,
        method.max_steps,
        method.stop_at_singular,
        motions,
        works,
        method.threads or os.cpu_count() or 1,
    ]
    found = _core.simulate(
        np.stack([run.hexapod.packed for run in runs]),
        is_universal(joint),
        np.stack([p.setup for p in prepared]),
        [packed for p in prepared for packed in p.excitations],
        t,
        np.array(options, dtype=float),
        progress,
    )
    displacement, relative, work, platform, base, leg_force, outcome, end_time, last, counts = found
    status = np.array(OUTCOMES)[outcome.astype(int)]
    lengths = np.stack([p.unstretched_length for p in prepared])
    return Trajectories(
        displacement, relative, work, platform, base, leg_force, status, end_time, last, counts.astype(int), lengths
    )


def equations(run: Run, *, joint: JointModel = "universal") -> _core.Equations:
    """Eq. 35 of a run for other integrators and controllers: `start()` gives y, `rates(t, y)` its derivative.

    y: (12,) the platform as seen from the base, in its axes: translation from rest (m), rotation vector from rest (rad,
    below a full turn), velocity, angular velocity.
    """
    p = prepare(run, 0.0, joint)
    return _core.Equations(run.hexapod.packed, is_universal(joint), p.setup, p.excitations)


class Prepared(NamedTuple):
    """One run as the core takes it."""

    setup: Array
    excitations: list[Array]
    unstretched_length: Array


def prepare(run: Run, until: float, joint: JointModel) -> Prepared:
    """One run to the time `until`, s, as the core takes it."""
    force, force_history = _split(run.force, "force")
    moment, moment_history = _split(run.moment, "moment")
    if run.unstretched_length is None:
        rest = hold(run.hexapod, run.pose, base=run.base, force=force, moment=moment, joint=joint)
        leg_force, lengths = rest.leg_force, rest.unstretched_length
    else:
        lengths = vectors(run.unstretched_length, "unstretched_length", 6)
        leg_force = run.hexapod.legs.stiffness * (lengths - inverse_kinematics(run.hexapod, run.pose, base=run.base))
    base_motion, command = run.base_motion or Excitation(), run.leg_command or Excitation()
    for use, history in run.histories().items():
        _check_recordings(use, history, until)
    check_channels(base_motion, "base_motion", AXES)
    check_channels(command, "leg_command", LEGS)
    flags = [base_motion.rotation == "rpy", isinstance(run.start, str) and run.start == "carried"]
    pose_rows = (Motion(run.pose).packed[:12], Motion.fixed(run.base).packed[:12])
    setup = np.concatenate([*pose_rows, leg_force, force, moment, *_start(run), flags])
    packed = [base_motion.packed, np.concatenate([force_history, moment_history]), command.packed]
    return Prepared(setup, packed, lengths)


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
        constant = vectors(load, name)
        if constant.ndim != 1:
            raise PoseError(f"{name} has shape {constant.shape}; one simulation takes three numbers")
        return constant, np.zeros(0)
    check_channels(load, name, AXES[:3])
    if name == "force":
        return np.zeros(3), load.packed
    return np.zeros(3), load.on(dict(zip(AXES[:3], AXES[3:], strict=True))).packed


def _start(run: Run) -> tuple[Array, Array]:
    """Displacement from rest and velocity at t = 0, (6,) each, inertial axes."""
    start = run.start
    if isinstance(start, str):
        if start not in ("rest", "carried"):
            raise ArgumentError(f"start is {start!r}; it must be 'rest', 'carried', a Pose or a Motion.")
        return np.zeros(6), np.zeros(6)
    motion = start if isinstance(start, Motion) else Motion(start)
    if motion.shape:
        raise PoseError(f"start has batch axes {motion.shape}; a simulation starts from one motion. Index it first.")
    turn = Pose(np.zeros(3), motion.pose.matrix @ run.pose.matrix.T).rotation.as_rotvec()
    displacement = np.concatenate([motion.pose.position - run.pose.position, turn])
    return displacement, np.concatenate([motion.velocity, motion.angular_velocity])


def _times(times: ArrayLike, n: int) -> Array:
    t = np.asarray(times, dtype=float)
    if t.ndim not in (1, 2) or (t.ndim == 2 and t.shape[0] != n) or t.shape[-1] == 0:
        raise ArgumentError(f"times have shape {t.shape}; (m,) or ({n}, m) is needed")
    if not np.isfinite(t).all() or (t[..., 0] < 0).any() or (np.diff(t, axis=-1) < 0).any():
        raise ArgumentError("times must be finite, >= 0 and ascending: a simulation starts at t = 0 s")
    return np.ascontiguousarray(np.broadcast_to(t, (n, t.shape[-1])))
