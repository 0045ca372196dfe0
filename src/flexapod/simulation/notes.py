"""What there is to say of a simulation: of its recordings, the machine's limits, and its energy balance."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from flexapod.conventions import LEGS, ROTATIONS, TRANSLATIONS, Array, JointModel
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import Excitation, Term
from flexapod.mechanics.joint_limits import limit_excess
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.mechanics.limited import LimitedQuantity
from flexapod.mechanics.load_limits import load_excess
from flexapod.mechanics.viscous_losses import LEFT_OUT, has_losses
from flexapod.pose import Pose
from flexapod.simulation.datasets import platform_pose
from flexapod.simulation.run import SimulationRun

JUMPS = 0.01  # of a recording's range: where it begins farther off zero, its start is a blow
KICKS = 0.1  # of a recording's greatest speed: where it begins with more, its start is a blow
ABSOLUTE = 0.5  # of a leg: a command that begins with more is the leg's length, and no change of it
BALANCE = 1e-3  # of the largest of kinetic energy and works


def of_recordings(run: SimulationRun, highest: float) -> list[str]:
    """What a recording does to a run that it should not. highest: natural frequency, rad/s.

    Raises ArgumentError for leg lengths that are given as commands.
    """
    notes: list[str] = []
    slow: dict[tuple[str, float], list[str]] = {}
    kicks: dict[str, list[tuple[float, str]]] = {}
    for use, history in run.histories().items():
        for term in history.terms:
            if term.sampled > 0:
                name = f"the recording of {use} {term.channel}" + (f" ({term.origin})" if term.origin else "")
                notes += [f"{name} {words}." for words in _of_recording(run, use, term, name)]
                if np.pi / term.sampled < highest:
                    slow.setdefault((use, term.sampled), []).append(term.channel)
                if _at_rest(run, use) and (kick := _kick(term)):
                    kicks.setdefault(use, []).append(kick)
    sampling = (_of_sampling(run, *of, channels, highest) for of, channels in slow.items())
    return [*sampling, *notes, *(_of_kicks(use, each) for use, each in kicks.items())]


def _at_rest(run: SimulationRun, use: str) -> bool:
    """Whether what a recording drives, base or leg, is at rest as it begins."""
    return isinstance(run.start, str) and (use == "leg_command" or (use == "base_motion" and run.start == "rest"))


def _kick(term: Term) -> tuple[float, str] | None:
    """Speed with which a recording begins, over its greatest, and in words; None where it is little."""
    rates = Excitation((term,)).evaluate(np.linspace(0.0, term.last, 2001))[1][:, _column(term)]
    speed, fastest = float(rates[0]), float(np.abs(rates).max())
    if abs(speed) <= KICKS * fastest:
        return None
    value = f"{np.degrees(speed):.4g} degrees/s" if term.channel in ROTATIONS else f"{speed:.4g} m/s"
    return abs(speed) / fastest, f"{term.channel} with {value}"


def _of_kicks(use: str, kicks: list[tuple[float, str]]) -> str:
    """That recordings of one use begin in motion, all their channels at once."""
    several, most, named = len(kicks) > 1, max(share for share, _ in kicks), ", ".join(words for _, words in kicks)
    carried = "" if use == "leg_command" else ", or let the platform start with the base (start 'carried')"
    return (
        f"the recording{'s' * several} of {use} begin{'s' * (not several)} in motion, {named}, "
        f"up to {most:.0%} of the greatest speed, and what is driven is at rest: a blow at the start, whose ringing is "
        f"in the results. Let it rise smoothly (a ramp){carried}."
    )


def _column(term: Term) -> int:
    return (LEGS if term.channel in LEGS else (*TRANSLATIONS, *ROTATIONS)).index(term.channel)


def _of_sampling(run: SimulationRun, use: str, sampled: float, channels: list[str], highest: float) -> str:
    """That recordings of one use lack what excites the machine, for all their channels at once."""
    named, several = ", ".join(dict.fromkeys(channels)), len(set(channels)) > 1
    return (
        f"the recording{'s' * several} of {use} {named} {'are' if several else 'is'} sampled every {sampled:.4g} s and "
        f"hold{'s' * (not several)} nothing above {np.pi / sampled:.4g} rad/s, but {run.hexapod.name!r} has natural "
        f"frequencies up to {highest:.4g} rad/s: what excites them is not in {'them' if several else 'it'}."
    )


def _of_recording(run: SimulationRun, use: str, term: Term, name: str) -> Iterator[str]:
    if term.remark:
        yield term.remark
    column = _column(term)
    values = Excitation((term,)).evaluate(np.linspace(0.0, term.last, 2001))[0][:, column]
    first, span = float(values[0]), float(np.ptp(values))
    if use == "leg_command":
        length = inverse_kinematics(run.hexapod, run.pose, base=run.base)[column]
        if abs(first) > ABSOLUTE * length:
            raise ArgumentError(
                f"{name} begins at {first:.6g} m in its first row; a command is a change of the leg's length, which is "
                f"{length:.6g} m at rest. Take the first row out of all rows (detrend 'first')."
            )
    if _at_rest(run, use) and abs(first) > JUMPS * span and first != 0:
        value = f"{np.degrees(first):.6g} degrees" if term.channel in ROTATIONS else f"{first:.6g} m"
        what = "the legs change by it at once" if use == "leg_command" else "the legs take it up at once"
        carried = "" if use == "leg_command" else ", or let the platform start with the base (start 'carried')"
        remedy = f"Let it rise smoothly (a ramp), take it out in place of another trend (detrend 'first'){carried}"
        yield f"begins at {value} in its first row, off zero: {what}. {remedy}"


def of_results(run: SimulationRun, result: xr.Dataset, joint: JointModel) -> list[str]:
    """Losses left out, limits of the machine that the motion exceeds, and an energy balance that is off."""
    return [*_of_losses(run), *_of_limits(run, result, joint), *_of_balance(result)]


def _of_losses(run: SimulationRun) -> list[str]:
    """Loss factors that the run leaves out; with a loss frequency its machine has none any more."""
    return [LEFT_OUT] if has_losses(run.hexapod) else []


def _of_limits(run: SimulationRun, result: xr.Dataset, joint: JointModel) -> list[str]:
    """Forces are those of the run; rates, accelerations and power of actuators are not those of legs that vibrate."""
    if not (run.hexapod.limits.given and result.sizes["time"]):
        return []
    platform = platform_pose(result)
    base = Pose(result.base_position.values, result.base_rotation.values)
    times = result.time.values
    return [
        words
        for quantity in (
            *limit_excess(run.hexapod, platform, base=base, joint=joint, forces=False),
            *load_excess(run.hexapod, result.leg_force.values),
        )
        for words in _exceeded(quantity, times)
    ]


def _exceeded(quantity: LimitedQuantity, times: Array) -> Iterator[str]:
    """What a quantity exceeds below and above: in which legs, from when on, and by how much at most."""
    name, unit = quantity.name, quantity.unit
    values = quantity.value.reshape(times.size, -1)
    for word, sign, bound in (("below", -1.0, quantity.least), ("above", 1.0, quantity.most)):
        bounds = np.broadcast_to(np.asarray(bound, dtype=float), values.shape[1:])
        with np.errstate(invalid="ignore"):
            excess = np.where(np.isfinite(bounds), sign * (values - bounds), -np.inf)
        over = excess > 0
        if not over.any():
            continue
        i, leg = np.unravel_index(int(np.nanargmax(excess)), excess.shape)
        legs = [str(k + 1) for k in np.flatnonzero(over.any(axis=0))]
        who = f" of leg{'s' * (len(legs) > 1)} {', '.join(legs)}" if values.shape[1] == 6 else ""
        yield (
            f"limit exceeded: {name}{who} is {word} its limit, first at t = {times[over.any(axis=1)][0]:.5g} s; the "
            f"farthest is {values[i, leg]:.6g} {unit} against {bounds[leg]:.6g} {unit}, at t = {times[i]:.5g} s."
        )


def _of_balance(result: xr.Dataset) -> list[str]:
    """An error that is more than the rounding of the energies stored, which hides the balance of a small motion."""
    if "energy_error" not in result or not result.sizes["time"]:
        return []
    share, error = float(result.energy_error_relative), float(np.abs(result.energy_error).max())
    if share <= BALANCE or error <= float(result.energy_rounding):
        return []
    return [
        f"the energy balance is off by {share:.2g} of the largest of kinetic energy and works: this motion is not that "
        "of the machine. Lower rtol, or look for a stiffness or a mass that is out of range."
    ]
