"""The Dataset of a simulation: motions, leg forces, the energy balance and what the joints carry."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from flexapod.conventions import AXES, LEGS, TRANSLATIONS, Array, JointModel, in_mixed_units, in_unit, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.excitation.excitation import Excitation
from flexapod.mechanics.energies import energy
from flexapod.mechanics.kinematics import leg_rates
from flexapod.mechanics.point_motion import at_point, displacement_at
from flexapod.mechanics.reactions import joint_reactions
from flexapod.pose import Motion, Pose
from flexapod.simulation.integrator import Trajectories
from flexapod.simulation.run import SimulationRun

ROUNDING = 1e-11  # of the energies that make up the balance


class Told(NamedTuple):
    """What a Dataset tells: at which point of the platform, and what besides its motion."""

    point: Array
    joint: JointModel
    energies: bool
    reactions: bool


def one_run(run: SimulationRun, found: Trajectories, i: int, times: Array, told: Told) -> xr.Dataset:
    """One run of many, as far as it got."""
    reached = int(np.isfinite(found.displacement[i, :, 0]).sum())
    times = times[:reached]
    platform, base = Motion.unpacked(found.platform[i, :reached]), Motion.unpacked(found.base[i, :reached])
    command = Excitation() if run.leg_command is None else run.leg_command
    unstretched = found.unstretched_length[i] + command.evaluate(times)[0]
    length = leg_rates(run.hexapod, platform, base=base).length
    force = found.leg_force[i, :reached]
    variables: dict[str, tuple[tuple[str, ...], Any, dict[str, str]]] = {
        **_motion(run, found, i, platform, base, told.point),
        "leg_length": (("time", "leg"), length, in_unit("m")),
        "unstretched_length": (("time", "leg"), unstretched, in_unit("m")),
        "leg_force": (("time", "leg"), force, in_unit("N")),
    }
    state = _State(run.hexapod, platform, base, unstretched, force)
    if told.energies:
        variables |= _energies(state, found.work[i, :reached], told.joint)
    if told.reactions:
        variables |= _reactions(state, told.joint)
    variables |= {
        "status": ((), str(found.status[i]), {}),
        "end_time": ((), found.end_time[i], in_unit("s")),
        "steps": ((), int(found.steps[i, 0]), {}),
        "evaluations": ((), int(found.steps[i, 2]), {}),
        "exponential_steps": ((), int(found.steps[i, 3]), {}),
    }
    coordinates = {
        "time": ("time", times, in_unit("s")),
        "output": list(AXES),
        "output_unit": ("output", [unit_of(axis) for axis in AXES]),
        "axis": list(TRANSLATIONS),
        "body_axis": list(TRANSLATIONS),
        "leg": list(LEGS),
        "source": ["base", "wrench", "leg_command", "friction"],
    }
    return xr.Dataset(variables, coordinates, {"point_m": told.point.tolist()})


def _motion(
    run: SimulationRun, found: Trajectories, i: int, platform: Motion, base: Motion, point: Array
) -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
    """The motion of a point of the platform, and of the base."""
    told = at_point(platform, point)
    rest, still = Motion.fixed(run.base).pose.matrix, run.pose.matrix @ point  # type: ignore[arg-type, union-attr]
    seen = _seen_from_base(told, base)
    three, turned = ("time", "axis"), ("time", "axis", "body_axis")
    return {
        "displacement": (
            ("time", "output"),
            displacement_at(found.displacement[i, : len(seen[0])], still),
            in_mixed_units("output_unit"),
        ),
        "relative_displacement": (
            ("time", "output"),
            displacement_at(found.relative[i, : len(seen[0])], rest.T @ still),
            in_mixed_units("output_unit"),
        ),
        "relative_velocity": (("time", "output"), seen[0], in_mixed_units("output_unit/s")),
        "relative_acceleration": (("time", "output"), seen[1], in_mixed_units("output_unit/s^2")),
        "position": (three, told.pose.position, in_unit("m")),
        "rotation": (turned, platform.pose.matrix, in_unit("1")),
        "velocity": (three, told.velocity, in_unit("m/s")),
        "angular_velocity": (three, platform.angular_velocity, in_unit("rad/s")),
        "acceleration": (three, told.acceleration, in_unit("m/s^2")),
        "angular_acceleration": (three, platform.angular_acceleration, in_unit("rad/s^2")),
        "base_position": (three, base.pose.position, in_unit("m")),
        "base_rotation": (turned, base.pose.matrix, in_unit("1")),
    }


def platform_pose(result: xr.Dataset) -> Pose:
    """The platform's pose in a Dataset of a run, whatever point it tells the motion of."""
    matrix = result.rotation.values
    return Pose(result.position.values - matrix @ np.asarray(result.attrs["point_m"]), matrix)


def _seen_from_base(platform: Motion, base: Motion) -> tuple[Array, Array]:
    """Velocity and acceleration of the platform, linear and angular (n, 6), for who stands on the base, in its axes."""
    turn, w = base.pose.matrix, base.angular_velocity
    arm = platform.pose.position - base.pose.position
    velocity = platform.velocity - base.velocity - np.cross(w, arm)
    spin = platform.angular_velocity - w
    acceleration = platform.acceleration - base.acceleration - np.cross(base.angular_acceleration, arm)
    acceleration -= np.cross(w, np.cross(w, arm)) + 2 * np.cross(w, velocity)
    twist = platform.angular_acceleration - base.angular_acceleration - np.cross(w, spin)
    parts = (np.einsum("nji,nj->ni", turn, part) for part in (velocity, spin, acceleration, twist))
    linear, angular, second, angular_second = parts
    return np.hstack([linear, angular]), np.hstack([second, angular_second])


class _State(NamedTuple):
    hexapod: Hexapod
    platform: Motion
    base: Motion
    unstretched: Array
    leg_force: Array


def _energies(state: _State, work: Array, joint: JointModel) -> dict[str, Any]:
    e = energy(state.hexapod, state.platform, base=state.base, unstretched_length=state.unstretched, joint=joint)
    kinetic, gravitational, elastic = (np.asarray(part) for part in (e.kinetic, e.gravitational, e.elastic))
    total = kinetic + gravitational + elastic
    done = work.sum(axis=1)
    error = total - total[0] - (done - done[0])  # the first instant need not be t = 0
    scale = max(np.nanmax(kinetic), np.nanmax(np.abs(work)))
    stored = max(np.nanmax(np.abs(part)) for part in (kinetic, gravitational, elastic))
    joules = in_unit("J")
    return {
        "kinetic_energy": (("time",), kinetic, joules),
        "gravitational_energy": (("time",), gravitational, joules),
        "elastic_energy": (("time",), elastic, joules),
        "work": (("time", "source"), work, joules),
        "energy_error": (("time",), error, joules),
        "energy_rounding": ((), ROUNDING * stored, joules),
        "energy_error_relative": ((), np.nanmax(np.abs(error)) / scale if scale > 0 else 0.0, in_unit("1")),
    }


def _reactions(state: _State, joint: JointModel) -> dict[str, Any]:
    found = joint_reactions(state.hexapod, state.platform, base=state.base, leg_force=state.leg_force, joint=joint)
    return {
        name: (
            ("time", "axis") if name.startswith("base") else ("time", "leg", "axis"),
            value,
            in_unit("N" if name.endswith("force") else "N m"),
        )
        for name, value in found._asdict().items()
    }
