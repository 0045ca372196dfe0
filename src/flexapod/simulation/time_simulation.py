"""Time simulation of the complete machine on its moving base (Section 5): one run or many, as xarray Datasets."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any, NamedTuple, TypedDict, Unpack, get_type_hints

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.conventions import AXES, LEGS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, SimulationError
from flexapod.excitation.excitation import Excitation
from flexapod.mechanics.dynamics import energy, joint_reactions
from flexapod.mechanics.kinematics import leg_rates
from flexapod.mechanics.modes import advised_sampling_time, natural_modes
from flexapod.pose import Motion, Pose
from flexapod.simulation.integrator import Load, Method, Run, Start, Trajectories, integrate

MOST_SAMPLES = 20_000
REASONS = {
    "singular": "det H changes sign there, and no leg forces hold the platform. Start nearer to the equilibrium, drive "
    "it less, or go on through with stop_at_singular=False",
    "leg_collapsed": "the joints of a leg meet there, and its length passes through zero. Start nearer to the "
    "equilibrium, or drive it less",
    "joint_locked": "a leg lies along its universal joint's axis there, and the joint cannot turn. Choose an axis "
    "across the leg, or drive it less",
    "step_collapse": "no step was small enough for the accuracy asked for. Look at the motion so far, loosen rtol, or "
    "smooth what drives the machine",
    "not_finite": "the accelerations are not finite there. Look at the motion so far and at what drives the machine",
    "max_steps": "the steps allowed were used up. Raise max_steps, loosen rtol, or shorten the duration",
}


class Settings(TypedDict, total=False):
    """Optional arguments of `simulate`.

    start, base, unstretched_length: as in `Run`. joint: "universal" (exact) or "spin_free" (the paper's). times: (m,) s
    at which to sample, or samples: how many, evenly from 0 to `duration`; by default the spacing that conclusion 3 of
    the paper asks for, but at most 20 000 of them. rtol, atol, max_step, max_steps, stop_at_singular, threads: as in
    `Method`. reactions: what all joints carry. energies: the energy balance (default True). progress: is called with
    the fraction done.
    """

    start: Start
    base: Pose | None
    unstretched_length: ArrayLike | None
    joint: JointModel
    times: ArrayLike
    samples: int
    rtol: float
    atol: float | None
    max_step: float
    max_steps: float
    stop_at_singular: bool
    threads: int | None
    reactions: bool
    energies: bool
    progress: Callable[[float], object] | None


RUN_SETTINGS = ("start", "base", "unstretched_length")
METHOD_SETTINGS = tuple(item.name for item in fields(Method))


def simulate(
    hexapod: Hexapod,
    pose: Pose,
    *,
    base_motion: Excitation | None = None,
    force: Load = None,
    moment: Load = None,
    leg_command: Excitation | None = None,
    duration: float | None = None,
    **settings: Unpack[Settings],
) -> xr.Dataset:
    """Motion of the complete machine from rest at a pose, driven by its base, loads and leg commands.

    The legs hold `pose` under gravity and constant loads before t = 0; leg forces are F = -K (L - L0(t)), the
    orientation is integrated on SO(3). base_motion, leg_command: Excitations, from `fx.harmonic` and its like; force
    (N) and moment (N m) in the platform's axes: three constants or an Excitation. duration in s. More arguments:
    `Settings`.

    Dataset over time, in SI units with units in attrs: displacement from equilibrium (inertial axes) and
    relative_displacement (seen from the base) of `output` x, y, z, roll, pitch, yaw (rotation vector); the platform's
    position, rotation, velocity, angular_velocity, acceleration, angular_acceleration; base_position, base_rotation;
    leg_length, unstretched_length, leg_force (positive: compression); kinetic, gravitational, elastic energy, work by
    source, energy_error; with `reactions`, the forces and moments of `fx.joint_reactions`. attrs: the largest
    energy_error over the largest of kinetic energy and works as `energy_error`, steps and evaluations.

    Raises: SimulationError, with the time, the pose and the Dataset so far, where the platform passes through a
    singular pose, a leg through zero length, or the steps collapse; ArgumentError for excitations or settings that are
    wrong; PoseError for a batch of poses; SingularPoseError where no leg forces hold the pose. Warns where a recording
    is too coarse for the machine.
    Source: Eq. 35; E6, E7; E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I (1993).
    """
    own = {name: settings.pop(name) for name in RUN_SETTINGS if name in settings}  # type: ignore[misc]
    run = Run(hexapod, pose, base_motion, force, moment, leg_command, **own)
    dataset = simulate_many([run], duration, **settings).isel(run=0)
    told = ("status", "end_time", "steps", "evaluations", "energy_error_relative")
    for name in told:
        if name in dataset:  # without energies there is no balance
            dataset.attrs[name.removesuffix("_relative")] = dataset[name].values.item()
    dataset = dataset.drop_vars(told, errors="ignore")
    last = dataset.attrs.pop("last")[0]
    status, end = dataset.attrs["status"], dataset.attrs["end_time"]
    if status == "complete":
        return dataset
    where = Pose(last[:3], last[3:12].reshape(3, 3))
    result = dataset.sel(time=dataset.time <= end)
    raise SimulationError(
        f"the simulation ended at t = {end:.9g} s in {where!r}: {REASONS[status]}.", end, where, result
    )


def simulate_many(runs: Sequence[Run], duration: float | None = None, **settings: Unpack[Settings]) -> xr.Dataset:
    """As `simulate` for many runs, each a `Run`, on all threads at once: the same Dataset with a first dimension `run`.

    duration: s. A run that ends early is data: its `status`, `end_time` (s), and NaN from there on. All are sampled at
    the same times. start, base and unstretched_length belong to each Run.

    Raises: ArgumentError for excitations or settings that are wrong, or no runs; SingularPoseError where no leg forces
    hold a pose.
    Source: Eq. 35, as `simulate`.
    """
    options = _options(settings, RUN_SETTINGS)
    method = Method(**{name: options[name] for name in METHOD_SETTINGS if name in options})
    joint = options.get("joint", "universal")
    highest = [natural_modes(run.hexapod, run.pose, joint=joint, base=run.base).omega[-1] for run in runs]
    times = _sample_times(options, duration, max(highest, default=0.0))
    notes = [note for run, omega in zip(runs, highest, strict=True) for note in _coarse(run, omega)]
    for note in dict.fromkeys(notes):
        warnings.warn(note, UserWarning, stacklevel=_outside())
    energies = options.get("energies", True)
    found = integrate(runs, times, joint=joint, method=method, works=energies, progress=options.get("progress"))
    wanted = _Wanted(joint, energies, options.get("reactions", False))
    each = [_dataset(run, found, i, times, wanted) for i, run in enumerate(runs)]
    dataset = xr.concat([part.reindex(time=times) for part in each], dim="run", combine_attrs="drop_conflicts")
    names = sorted({run.hexapod.name for run in runs})
    dataset.attrs = {
        "design": ", ".join(names),
        "joint": joint,
        "method": "Runge-Kutta 8(5,3), Dormand and Prince; orientation on SO(3)",
        "rtol": method.rtol,
        "warnings": list(dict.fromkeys(notes)),
        "last": found.last,
    }
    return dataset


class _Wanted(NamedTuple):
    joint: JointModel
    energies: bool
    reactions: bool


def _options(settings: Any, refused: Sequence[str]) -> dict[str, Any]:
    known = [name for name in get_type_hints(Settings) if name not in refused]
    for name in settings:
        if name not in known:
            raise ArgumentError(f"{name!r} is no argument here; there are {', '.join(known)}.")
    return dict(settings)


def _outside() -> int:
    """Stack level of the first caller outside this file, for warnings."""
    level = 1
    frame = inspect.currentframe()
    while frame is not None and frame.f_code.co_filename == __file__:
        level, frame = level + 1, frame.f_back
    return level - 1


def _sample_times(options: dict[str, Any], duration: float | None, highest: float) -> Array:
    if "times" in options:
        if duration is not None or "samples" in options:
            raise ArgumentError("times are given, so duration and samples must not be.")
        return np.asarray(options["times"], dtype=float)
    if duration is None or not (np.isfinite(duration) and duration > 0):
        raise ArgumentError(f"duration is {duration} s; it must be > 0 and finite, or give times.")
    most = MOST_SAMPLES if highest <= 0 else min(MOST_SAMPLES, int(np.ceil(duration / advised_sampling_time(highest))))
    samples = options.get("samples", max(most, 1) + 1)
    if samples < 2:
        raise ArgumentError(f"samples is {samples}; it must be >= 2.")
    return np.linspace(0.0, duration, int(samples))


def _coarse(run: Run, highest: float) -> list[str]:
    """What a recording cannot show because of its sampling."""
    notes = []
    for use, history in run.histories().items():
        for term in history.terms:
            if term.sampled > 0 and np.pi / term.sampled < highest:
                notes.append(
                    f"the recording of {use} {term.channel} is sampled every {term.sampled:.4g} s and holds nothing "
                    f"above {np.pi / term.sampled:.4g} rad/s, but {run.hexapod.name!r} has natural frequencies up to "
                    f"{highest:.4g} rad/s: what excites them is not in it."
                )
    return notes


def _dataset(run: Run, found: Trajectories, i: int, times: Array, wanted: _Wanted) -> xr.Dataset:
    """One run as far as it got."""
    reached = int(np.isfinite(found.displacement[i, :, 0]).sum())
    times = times[:reached]
    platform, base = _motion(found.platform[i, :reached]), _motion(found.base[i, :reached])
    command = Excitation() if run.leg_command is None else run.leg_command
    unstretched = found.unstretched_length[i] + command.evaluate(times)[0]
    length = leg_rates(run.hexapod, platform, base=base).length
    force = found.leg_force[i, :reached]
    three, turned = ("time", "axis"), ("time", "axis", "body_axis")
    variables: dict[str, tuple[tuple[str, ...], Any, dict[str, str]]] = {
        "displacement": (("time", "output"), found.displacement[i, :reached], {"units": "m, rad"}),
        "relative_displacement": (("time", "output"), found.relative[i, :reached], {"units": "m, rad"}),
        "position": (three, platform.pose.position, {"units": "m"}),
        "rotation": (turned, platform.pose.matrix, {"units": "1"}),
        "velocity": (three, platform.velocity, {"units": "m/s"}),
        "angular_velocity": (three, platform.angular_velocity, {"units": "rad/s"}),
        "acceleration": (three, platform.acceleration, {"units": "m/s2"}),
        "angular_acceleration": (three, platform.angular_acceleration, {"units": "rad/s2"}),
        "base_position": (three, base.pose.position, {"units": "m"}),
        "base_rotation": (turned, base.pose.matrix, {"units": "1"}),
        "leg_length": (("time", "leg"), length, {"units": "m"}),
        "unstretched_length": (("time", "leg"), unstretched, {"units": "m"}),
        "leg_force": (("time", "leg"), force, {"units": "N"}),
    }
    state = _State(run.hexapod, platform, base, unstretched, force)
    if wanted.energies:
        variables |= _energies(state, found.work[i, :reached], wanted.joint)
    if wanted.reactions:
        variables |= _reactions(state, wanted.joint)
    variables |= {
        "status": ((), str(found.status[i]), {}),
        "end_time": ((), found.end_time[i], {"units": "s"}),
        "steps": ((), int(found.steps[i, 0]), {}),
        "evaluations": ((), int(found.steps[i, 2]), {}),
    }
    coordinates = {
        "time": ("time", times, {"units": "s"}),
        "output": list(AXES),
        "axis": list(AXES[:3]),
        "body_axis": list(AXES[:3]),
        "leg": list(LEGS),
        "source": ["base", "wrench", "leg_command", "friction"],
    }
    return xr.Dataset(variables, coordinates)


class _State(NamedTuple):
    hexapod: Hexapod
    platform: Motion
    base: Motion
    unstretched: Array
    leg_force: Array


def _motion(rows: Array) -> Motion:
    pose = Pose(rows[:, :3], rows[:, 3:12].reshape(-1, 3, 3))
    return Motion(pose, *(rows[:, i : i + 3] for i in (12, 15, 18, 21)))


def _energies(state: _State, work: Array, joint: JointModel) -> dict[str, Any]:
    e = energy(state.hexapod, state.platform, base=state.base, unstretched_length=state.unstretched, joint=joint)
    kinetic, gravitational, elastic = (np.asarray(part) for part in (e.kinetic, e.gravitational, e.elastic))
    total = kinetic + gravitational + elastic
    error = total - total[0] - work.sum(axis=1)
    scale = max(np.nanmax(kinetic), np.nanmax(np.abs(work)))
    joules = {"units": "J"}
    return {
        "kinetic_energy": (("time",), kinetic, joules),
        "gravitational_energy": (("time",), gravitational, joules),
        "elastic_energy": (("time",), elastic, joules),
        "work": (("time", "source"), work, joules),
        "energy_error": (("time",), error, joules),
        "energy_error_relative": ((), np.nanmax(np.abs(error)) / scale if scale > 0 else 0.0, {}),
    }


def _reactions(state: _State, joint: JointModel) -> dict[str, Any]:
    found = joint_reactions(state.hexapod, state.platform, base=state.base, leg_force=state.leg_force, joint=joint)
    return {
        name: (
            ("time", "axis") if name.startswith("base") else ("time", "leg", "axis"),
            value,
            {"units": "N" if name.endswith("force") else "N m"},
        )
        for name, value in found._asdict().items()
    }
