"""The options of `flexapod path`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common
from flexapod.cli.options.points import PointGiven, point_option
from flexapod.cli.options.quantities import FREQUENCY, LENGTH, POSITIVE_LENGTH, TIME, Quantity

if TYPE_CHECKING:
    from flexapod.conventions import JointModel


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str
    changes: tuple[str, ...]
    joint: JointModel
    as_csv: bool
    as_json: bool
    file: Path | None
    from_home: bool
    home_time: float | None
    payload: tuple[tuple[float, ...], ...]
    payloads: Path | None
    point: PointGiven
    hold: float | None
    start: tuple[float, ...] | None
    goal: tuple[float, ...] | None
    bound: float | None
    ends: str
    objective: str
    duration: float | None
    leg_rate: float | None
    leg_acceleration: float | None
    condition: float | None
    clearance: float | None
    limits: bool
    certify: bool
    seed: int
    out: Path | None


path_options = common.stack(
    click.argument("file", type=common.GIVEN_FILE, required=False),
    common.pose_named("--from", "start", help="Plan from this pose (m, degrees)."),
    common.pose_named("--to", "goal", help="Plan to this pose (m, degrees)."),
    common.rotation_options,
    click.option("--from-home", is_flag=True, help="Measure the poses of FILE, --from and --to from the home pose."),
    click.option(
        "--home-time",
        type=TIME,
        metavar="S",
        help="Begin and end at home, so long before and after the motion of FILE, which stays as it is.",
    ),
    click.option(
        "--payload",
        type=(Quantity("mass", need=">= 0"), LENGTH, LENGTH, LENGTH),
        multiple=True,
        metavar="KG X Y Z",
        help="A load on the platform beside its own mass, and the place of its centre (m, platform frame). Repeatable.",
    ),
    click.option(
        "--payloads",
        type=common.GIVEN_FILE,
        metavar="CSV",
        help="Loads with inertia, or forces: columns case, mass, x, y, z, ixx, ..., force_x, ..., each if wanted.",
    ),
    point_option("Point of the platform whose motion is told"),
    click.option(
        "--hold",
        type=TIME,
        metavar="S",
        help="Time at rest at the end of the path in every cycle, for the RMS torque of the motors of [drive].",
    ),
    click.option("--bound", type=FREQUENCY, metavar="RAD_S", help="Least natural frequency that the path should keep."),
    click.option(
        "--ends",
        type=click.Choice(["rest", "free", "periodic"]),
        default="rest",
        show_default=True,
        help="How the path of FILE begins and ends.",
    ),
    click.option(
        "--least",
        "objective",
        type=click.Choice(["length", "time"]),
        default="length",
        show_default=True,
        help="What a planned path has least of; time needs --leg-rate or --leg-acceleration.",
    ),
    click.option("--duration", type=TIME, metavar="S", help="Duration of a planned path. Default: 1 s."),
    click.option(
        "--leg-rate",
        type=Quantity("velocity", need="> 0"),
        metavar="M_S",
        help="Fastest rate of a leg; times a planned path.",
    ),
    click.option(
        "--leg-acceleration",
        type=Quantity("acceleration", need="> 0"),
        metavar="M_S2",
        help="Largest acceleration of a leg.",
    ),
    click.option("--condition", type=common.POSITIVE, metavar="C", help="Most that cond(H) may be on a planned path."),
    click.option(
        "--clearance", type=POSITIVE_LENGTH, metavar="M", help="Least distance of leg axes on a planned path."
    ),
    click.option("--limits/--no-limits", default=True, help="Whether a planned path keeps the design's limits."),
    click.option(
        "--certify", is_flag=True, help="Prove the bound at every pose of the path; without --bound, the closest one."
    ),
    click.option("--seed", type=common.SEED, default=0, show_default=True, help="Of the planner's samples."),
    click.option("--csv", "as_csv", is_flag=True, help="Print pose and legs at each instant as CSV, in SI units."),
    common.out_option("Where to write the report, figures, tables and planned waypoints. Default: nothing is written."),
)
