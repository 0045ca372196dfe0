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
@click.option("--from-home", is_flag=True, help="Poses, of FILE, of --start and those that are found, count from home.")
@common.rotation_options
@common.set_option
@click.option("--out", type=common.FILE, metavar="CSV", help="Default: standard output.")
@common.json_option
def command(
    design: str,
    file: Path,
    every: bool,
    start: tuple[float, ...] | None,
    from_home: bool,
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
    origin = common.home_for(hexapod, "--from-home") if from_home else None
    begin = common.pose_or_none(hexapod, start)
    if origin is not None and start is not None:
        begin = origin.displaced(common.pose_of(start))
    found = compute(hexapod, file, start=begin, every=every, origin=origin)
    if as_json:
        common.print_json(found.to_dict())
    elif out is None:
        click.echo(found.to_csv(), nl=False)
    if out is not None:
        write_file(out, found.to_csv())
    for note in [] if as_json else found.notes:
        click.echo(f"Warning: {note}", err=True)
