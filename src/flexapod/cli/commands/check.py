"""`flexapod check`: is a file a hexapod, is what was read what was meant, and is it within its limits at a pose?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common
from flexapod.design.origin import origin
from flexapod.report.numbers import pose_numbers

if TYPE_CHECKING:
    from flexapod.design.hexapod import Hexapod
    from flexapod.pose import Pose


@click.command()
@common.design_argument
@common.pose_option
@common.set_option
@common.json_option
def command(design: str, pose: tuple[float, ...] | None, changes: tuple[str, ...], as_json: bool) -> None:
    """Check DESIGN: every key and value, and, at the pose given or at home, its limits. What was read is printed back.

    Exit code 2 means that DESIGN is no hexapod; warnings and exceeded limits are printed and leave it at 0.
    """
    from flexapod.cli.output import read_back
    from flexapod.design.catalogue import assumed_of

    hexapod = common.load_design(design, changes)
    where = common.pose_or_none(hexapod, pose)
    found = {**origin(hexapod), "warnings": hexapod.warnings, **_at(hexapod, where)}
    found["assumed"] = assumed_of(hexapod)
    found["ok"] = not (found["warnings"] or found["cautions"] or found["limits_exceeded"])
    if as_json:
        found |= {"values": hexapod.values(), "radii_of_gyration_m": read_back.gyration(hexapod)}
        common.print_json(found)
    else:
        _show(hexapod, where, found)


def _at(hexapod: Hexapod, pose: Pose | None) -> dict[str, Any]:
    """What holds at a pose; null without one."""
    from flexapod.mechanics import joint_limits, kinematics, plausibility
    from flexapod.mechanics.at_rest import pose_state
    from flexapod.mechanics.cautions import NO_FAULT
    from flexapod.mechanics.load_limits import motion_limits_words

    nowhere = "No home pose and no --pose: nothing was checked at a pose, neither limits nor singularity nor stability."
    keys = ("stability", "leg_lengths_m", "leg_distance_m", "condition_number", "singularity", "limits_exceeded")
    if pose is None:
        odd = [caution.text for caution in plausibility.implausible(hexapod)]
        return {**dict.fromkeys(("pose_m_deg", *keys)), "not_checked": nowhere, "cautions": odd}
    state = pose_state(hexapod, pose)
    told = [one for one in state.cautions if one.code not in NO_FAULT or "elsewhere" in one.numbers]
    values = (
        state.stability,
        kinematics.inverse_kinematics(hexapod, pose),
        joint_limits.leg_distance(hexapod, pose),
        state.condition_shown(kinematics.condition_number(hexapod, pose)),
        [one.text for one in told if one.code == "singular" or "elsewhere" in one.numbers],
        joint_limits.check_limits(hexapod, pose).exceeded,
    )
    found = dict(zip(keys, values, strict=True))
    return {
        "pose_m_deg": pose_numbers(pose),
        **found,
        "not_checked": motion_limits_words(hexapod.limits) or None,
        "cautions": [one.text for one in told],
    }


def _show(hexapod: Hexapod, pose: Pose | None, found: dict[str, Any]) -> None:
    from flexapod.cli.output import read_back
    from flexapod.mechanics.limited import together

    out = common.console()
    out.print(repr(hexapod), markup=False, soft_wrap=True)
    for line in ("What was read, in SI units and degrees:", *read_back.lines(hexapod)):
        out.print(line, markup=False, soft_wrap=True)
    if found["not_checked"]:
        out.print(found["not_checked"], soft_wrap=True)
    if pose is not None:
        lengths = found["leg_lengths_m"]
        out.print(f"At {pose!r}: {found['stability']}", markup=False, soft_wrap=True)
        out.print(
            f"  legs {lengths.min():.4g} to {lengths.max():.4g} m, axes at least {found['leg_distance_m']:.4g} m apart"
        )
        out.print(f"  condition number of H {found['condition_number']:.4g} (in metres)")
    if found["assumed"]:
        out.print(found["assumed"], markup=False, soft_wrap=True)
    common.print_warnings((*found["cautions"], *found["warnings"], *together(found["limits_exceeded"] or ())))
    out.print("[bold green]OK[/bold green]" if found["ok"] else "A valid design, with warnings.")
