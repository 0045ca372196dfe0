"""The options of `flexapod sweep`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common
from flexapod.cli.options.cluster import PartOf, cluster_options
from flexapod.cli.options.quantities import DEGREES, LENGTH, TIME, Quantity
from flexapod.output_files import check_figure, check_file

if TYPE_CHECKING:
    from flexapod.conventions import JointModel

DEFAULT_POINTS = 100_000
MOST_POINTS = 2**40  # workspace.pose_sets.MOST, which takes long to import


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str
    changes: tuple[str, ...]
    joint: JointModel
    as_json: bool
    box: tuple[str, ...]
    around: tuple[float, float] | None
    grid: tuple[str, ...]
    poses: Path | None
    points: int | None
    seed: int
    even: bool
    quantities: str
    out: Path | None
    resume: bool
    chunk: int | None
    keep_poses: bool
    summary: bool
    threads: int | None
    scheduler: str | None
    timeout: float
    part: tuple[int, int] | None
    time_limit: float | None
    at_least: float | None
    worst: bool
    all_poses: bool
    figure: Path | None
    level: float | None

    @property
    def streamed(self) -> bool:
        return self.out is not None and self.out.suffix.lower() == ".zarr"


def _check_figure(path: Path) -> None:
    check_figure(path)
    check_file(path)


def _check_out(path: Path) -> None:
    if path.suffix.lower() != ".zarr":  # a store looks for itself
        check_file(path)


poses_options = common.stack(
    click.option(
        "--box",
        multiple=True,
        metavar="NAME=LEAST:LARGEST,...",
        help="Ranges of x, y, z (m), roll, pitch, yaw (degrees); one value holds a coordinate, and those not named are "
        "held at the home pose. Repeatable.",
    ),
    click.option(
        "--around",
        type=(LENGTH, DEGREES),
        default=None,
        metavar="M DEG",
        help="The box of the home pose plus and minus so many metres and degrees.",
    ),
    click.option(
        "--grid",
        multiple=True,
        metavar="NAME=FIRST:LAST:COUNT,...",
        help="All combinations of these values instead of points in a box. Repeatable.",
    ),
    click.option(
        "--poses",
        type=common.GIVEN_FILE,
        default=None,
        help="Poses of a .csv or .npy file: x, y, z (m), roll, pitch, yaw (degrees). A CSV may name other units, as "
        "x_mm, roll_rad; one that --out wrote is read as well.",
    ),
    click.option(
        "--points",
        type=common.count(most=MOST_POINTS),
        default=None,
        metavar="N",
        help=f"Number of poses in the box.  [default: {DEFAULT_POINTS}]",
    ),
    click.option("--seed", type=common.SEED, default=0, show_default=True, help="Seed of the points."),
    click.option(
        "--low-discrepancy", "even", is_flag=True, help="Points of a scrambled Sobol sequence instead of random ones."
    ),
)
output_options = common.stack(
    click.option(
        "--quantities",
        default="omega_1,cond_H",
        show_default=True,
        metavar="NAMES",
        help="What to compute, separated by commas; `all` for everything. Of a design with limits, within_limits comes "
        "to it.",
    ),
    click.option(
        "--out",
        type=common.Output(_check_out),
        default=None,
        help="Where to write: .zarr (streamed, any size), .nc, .parquet or .csv.",
    ),
    click.option("--resume", is_flag=True, help="Go on with a .zarr store that the same command began."),
    click.option(
        "--chunk",
        type=common.count(1, 10**9),
        default=None,
        metavar="N",
        help="Most poses in a block of a .zarr store.  [default: up to 64 MiB]",
    ),
    click.option(
        "--keep-poses/--no-poses",
        default=True,
        help="Whether a .zarr store holds the coordinates of points in a box, or only how to make them again.",
    ),
    click.option("--summary/--no-summary", default=True, help="Whether to read the results once more for the summary."),
)
machine_options = common.stack(
    click.option("--threads", type=common.THREADS, default=None, metavar="N", help="Threads.  [default: all cores]"),
    *cluster_options,
    click.option(
        "--part",
        type=PartOf(),
        metavar="K/N",
        help="Compute the Kth of N parts of a .zarr store, beside runs of the others; whoever comes first makes it.",
    ),
    click.option(
        "--time-limit",
        type=TIME,
        metavar="S",
        help="How long to compute; what is in the .zarr store then is kept for --resume, and the exit code is 3.",
    ),
)
reading_options = common.stack(
    click.option(
        "--at-least",
        type=Quantity("frequency"),
        default=None,
        metavar="RAD_S",
        help="A wanted stability index: what part of the workspace reaches it?",
    ),
    click.option("--worst", is_flag=True, help="Refine the worst pose of the box by descent from several starts."),
    click.option(
        "--all-poses",
        is_flag=True,
        help="Let poses beyond the design's limits count in the summary, the worst pose and the figure as well.",
    ),
    click.option(
        "--figure",
        type=common.Output(_check_figure),
        default=None,
        help="Draw (.png, .pdf, .svg) the map of a grid of two coordinates, the surface of equal index of one of "
        "three, else index against cond(H).",
    ),
    click.option(
        "--level",
        type=Quantity("frequency"),
        default=None,
        metavar="RAD_S",
        help="Index of the surface that --figure draws.  [default: the median]",
    ),
)
