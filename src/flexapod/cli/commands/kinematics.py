"""`flexapod kinematics`: poses from leg lengths, and leg lengths from poses."""

from __future__ import annotations

from pathlib import Path

import click

from flexapod.cli.options import common
from flexapod.output_files import write_file


@click.command()
@common.design_argument
@click.argument("file", type=common.GIVEN_FILE)
@click.option("--all", "every", is_flag=True, help="Give all assemblies of each set of leg lengths.")
@common.pose_named("--start", help="Pose that the search of poses begins at (m, degrees). Default: home pose.")
@common.rotation_options
@common.set_option
@click.option("--out", type=common.FILE, metavar="CSV", help="Default: standard output.")
@common.json_option
def command(
    design: str,
    file: Path,
    every: bool,
    start: tuple[float, ...] | None,
    changes: tuple[str, ...],
    out: Path | None,
    as_json: bool,
) -> None:
    """Poses of DESIGN from the leg lengths in FILE, or leg lengths from poses, as CSV.

    FILE is CSV: columns leg1 to leg6 give poses, columns x, y, z, roll, pitch, yaw give leg lengths (m and degrees, or
    units as in leg1_mm). Rows that have no answer are told by their line, and do not stop the others.

    \b
    flexapod kinematics motion-base lengths.csv --out poses.csv
    flexapod kinematics motion-base lengths.csv --all
    """
    from flexapod.cli.studies.kinematics import compute

    hexapod = common.load_design(design, changes)
    found = compute(hexapod, file, start=common.pose_or_none(hexapod, start), every=every)
    if as_json:
        common.print_json(found.to_dict())
    elif out is None:
        click.echo(found.to_csv(), nl=False)
    if out is not None:
        write_file(out, found.to_csv())
    for note in [] if as_json else found.notes:
        click.echo(f"Warning: {note}", err=True)
