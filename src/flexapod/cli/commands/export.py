"""`flexapod export`: the same machine as a file for another tool."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common
from flexapod.design.origin import origin
from flexapod.output_files import check_file
from flexapod.report.numbers import file_name, pose_numbers

if TYPE_CHECKING:
    from flexapod.conventions import JointModel
    from flexapod.design.hexapod import Hexapod
    from flexapod.pose import Pose

SUFFIXES = {"mjcf": ".xml", "urdf": ".urdf", "sdf": ".sdf", "mat": ".mat"}


@click.command()
@common.design_argument
@click.option(
    "--to",
    "kind",
    type=click.Choice(tuple(SUFFIXES)),
    default=None,
    help="mjcf: MuJoCo. urdf: a tree, with its loops and springs in a JSON file beside it. sdf: a world. mat: the "
    "state space about rest, for MATLAB and SciPy. Default: what the ending of --out says, .xml being mjcf.",
)
@click.option(
    "--out",
    type=common.FILE,
    default=None,
    metavar="FILE",
    help="The file to write; by default it is named after the design.",
)
@click.option(
    "--nearest-physical",
    is_flag=True,
    help="Replace bodies that no solid has (leg parts without mass, impossible inertias), which other programs refuse, "
    "by the nearest that exist.",
)
@common.pose_option
@common.set_option
@common.joint_option
@common.json_option
def command(
    design: str,
    kind: str | None,
    out: Path | None,
    nearest_physical: bool,
    pose: tuple[float, ...] | None,
    changes: tuple[str, ...],
    joint: JointModel,
    as_json: bool,
) -> None:
    """Write DESIGN at rest at a pose for another tool.

    \b
    flexapod export motion-base --to mjcf --out motion-base.xml
    """
    from flexapod.interchange.multibody import left_out
    from flexapod.interchange.rigid_bodies import nearest_physical as nearest
    from flexapod.mechanics.modes import natural_modes

    kind = kind or _kind_of(out)
    if joint != "universal" and kind != "mat":
        raise click.UsageError(f"--joint {joint} cannot be written as {kind}: its legs are real bodies. Leave it out.")
    given = common.load_design(design, changes)
    where = common.chosen_pose(given, pose)
    hexapod = nearest(given) if nearest_physical else given
    path = check_file(out or Path(f"{file_name(hexapod.name)}{SUFFIXES[kind]}"))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        files = _write(kind, path, hexapod, where, joint)
    told = [str(warning.message) for warning in caught]
    omega, before = (natural_modes(machine, where, joint=joint).omega for machine in (hexapod, given))
    written, missing = [str(file) for file in files], list(left_out(hexapod, where, kind))
    found = {
        **origin(hexapod),
        "pose_m_deg": pose_numbers(where),
        "format": kind,
        "files": written,
        "bodies_replaced": hexapod != given,
        "frequency_change": float(abs(omega / before - 1).max()),
        "omega_rad_s": omega,
        "warnings": told,
        "left_out": missing,
    }
    if as_json:
        common.print_json(found)
        return
    click.echo(f"Wrote {' and '.join(written)}: {hexapod.name} at {where!r}.")
    if missing:
        click.echo(f"Not in the file: {'; '.join(missing)}.")
    if found["bodies_replaced"]:
        click.echo(f"Bodies were replaced; its natural frequencies change by {found['frequency_change']:.3g} at most.")
    common.print_warnings(told)


def _kind_of(out: Path | None) -> str:
    """The format that the ending of a file says. Raises UsageError where it says none."""
    if out is None:
        raise click.UsageError(f"Missing option '--to'. Choose from: {', '.join(SUFFIXES)}.")
    kinds = {suffix: kind for kind, suffix in SUFFIXES.items()}
    if out.suffix.lower() not in kinds:
        raise click.UsageError(
            f"{out} ends in {out.suffix!r}, which is the ending of no format. Give --to as well, or end it in "
            f"{', '.join(kinds)}."
        )
    return kinds[out.suffix.lower()]


def _write(kind: str, path: Path, hexapod: Hexapod, pose: Pose, joint: JointModel) -> tuple[Path, ...]:
    if kind == "mjcf":
        from flexapod.interchange.mjcf import write_mjcf

        return (write_mjcf(path, hexapod, pose),)
    if kind == "urdf":
        from flexapod.interchange.urdf import write_urdf

        return write_urdf(path, hexapod, pose)
    if kind == "sdf":
        from flexapod.interchange.sdf import write_sdf

        return (write_sdf(path, hexapod, pose),)
    from flexapod.interchange.matlab import write_mat

    return (write_mat(path, hexapod, pose, joint=joint),)
