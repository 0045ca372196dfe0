"""`flexapod modes`: the six natural frequencies at a pose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common
from flexapod.cli.options.points import PointGiven, point_option
from flexapod.conventions import AXES, TWO_PI
from flexapod.design.origin import origin
from flexapod.report.numbers import pose_numbers

if TYPE_CHECKING:
    from flexapod.conventions import Array, JointModel
    from flexapod.mechanics.cautions import Caution


@click.command()
@common.machine_options
@common.characteristic_length_option
@point_option("Point of the platform whose motion in each mode is told as well")
@common.json_option
def command(
    design: str,
    pose: tuple[float, ...] | None,
    changes: tuple[str, ...],
    joint: JointModel,
    characteristic_length: float | None,
    point: PointGiven,
    as_json: bool,
) -> None:
    """Six natural frequencies of DESIGN at a pose, lowest first (the lowest is the dynamic stability index).

    DESIGN is a packaged design's name (see `flexapod designs`) or the path of a .toml file.
    """
    from flexapod.design.catalogue import assumed_of
    from flexapod.mechanics import kinematics, modes
    from flexapod.mechanics.at_rest import pose_state
    from flexapod.mechanics.inputs import as_point, point_attributes
    from flexapod.mechanics.point_motion import point_words, shift

    hexapod, where = common.machine(design, changes, pose)
    state = pose_state(hexapod, where, joint=joint)
    omega, shape = state.modes
    condition = state.condition_shown(
        kinematics.condition_number(hexapod, where, characteristic_length=characteristic_length)
    )
    lengths = kinematics.inverse_kinematics(hexapod, where)
    attributes = point_attributes(hexapod, point)
    moved = shift(where, as_point(hexapod, point)) @ shape
    descriptions = [mode.text for mode in state.descriptions]
    warnings = _warnings(state.cautions)
    if as_json:
        common.print_json(
            {
                **origin(hexapod),
                "pose_m_deg": pose_numbers(where),
                "joint": joint,
                "stability": state.stability,
                "omega_rad_s": omega,
                "frequency_hz": omega / TWO_PI,
                "stability_index_rad_s": omega[0],
                "condition_number": condition,
                "characteristic_length_m": characteristic_length,
                "leg_lengths_m": lengths,
                "sampling_time_s": modes.advised_sampling_time(omega[-1]),
                "near_repeated": [[i + 1, j + 1] for i, j in modes.near_repeated(omega)],
                **attributes,
                "mode_shapes": moved,
                "descriptions": descriptions,
                "warnings": warnings,
                "assumed": assumed_of(hexapod),
            }
        )
        return
    _show(f"{hexapod.name} at {where!r}, joint model {joint}: {state.stability}", omega, descriptions)
    _show_point(point_words(attributes["point_m"], attributes["point"]), moved)
    scaled = f" (moments over {characteristic_length:g} m)" if characteristic_length else " (in metres)"
    click.echo(f"Condition number of H: {condition:.6g}{scaled}")
    click.echo("Leg lengths: " + "  ".join(f"{length:.6g}" for length in lengths) + " m")
    common.print_warnings(warnings)
    if assumed := assumed_of(hexapod):
        click.echo(assumed)


def _warnings(cautions: Sequence[Caution]) -> list[str]:
    """All cautions but those of limits, which are only counted."""
    told = [caution.text for caution in cautions if caution.code != "limit"]
    exceeded = sum(int(caution.numbers["times"]) for caution in cautions if caution.code == "limit")
    what = f"{exceeded} limits are" if exceeded > 1 else "A limit is"
    counted = f"{what} exceeded at this pose; `flexapod check` says more."
    return [*told, counted] if exceeded else told


def _show(title: str, omega: Array, descriptions: list[str]) -> None:
    from rich.table import Table
    from rich.text import Text

    from flexapod.report.terminal import put

    common.console().print(Text(title), soft_wrap=True)
    table = Table()
    for heading in ("mode", "rad/s", "Hz"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("motion")
    for i, words in enumerate(descriptions):
        table.add_row(f"{i + 1}", f"{omega[i]:.6g}", f"{omega[i] / TWO_PI:.5g}", words)
    put(table, common.console())


def _show_point(point: str, shape: Array) -> None:
    """The motion of a point in each mode; nothing for the platform's origin, whose motion the words tell."""
    import numpy as np
    from rich.table import Table

    from flexapod.report.numbers import shown, without_rounding
    from flexapod.report.terminal import put

    if not point:
        return
    table = Table(title=f"Mode shapes at {point}, mass-normalised: kg^-1/2, and rad kg^-1/2 m^-1")
    for heading in ("mode", *AXES):
        table.add_column(heading, justify="right", no_wrap=True)
    kept = np.concatenate([without_rounding(part) for part in (shape[:3], shape[3:])])
    for i in range(6):
        table.add_row(f"{i + 1}", *(shown(float(x)) for x in kept[:, i]))
    put(table, common.console())
