"""The options of `flexapod optimise`, and those that it shares with `flexapod robust`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from flexapod.cli.options import common
from flexapod.cli.options.quantities import DEGREES, LENGTH

if TYPE_CHECKING:
    from flexapod.conventions import JointModel

#: What --keep may name: the constraint, and the dimension of its bound.
KEEPS = {
    "footprint": "length",
    "platform-footprint": "length",
    "stroke": "length",
    "shortest-leg": "length",
    "longest-leg": "length",
    "clearance": "length",
    "universal-angle": "angle",
    "spherical-angle": "angle",
    "cond": None,
    "mass": "mass",
    "deflection": "length",
    "limits": None,
}

where_options = common.stack(
    common.pose_option,
    click.option(
        "--around",
        type=(LENGTH, DEGREES),
        default=None,
        metavar="M DEG",
        help="The workspace of every coordinate of the home pose plus and minus these; it moves with home.",
    ),
    click.option(
        "--box", multiple=True, metavar="NAME=LEAST:LARGEST,...", help="A workspace in the base frame (m, degrees)."
    ),
)
out_option = common.out_option(
    "Where to write the report (HTML), figures (PNG) and designs (TOML). Default: here; with --json: no files."
)
threads_option = click.option("--threads", type=common.THREADS, default=None, help="Default: all cores.")
optimise_options = common.stack(
    click.option(
        "--vary",
        multiple=True,
        required=True,
        metavar="KEY=LEAST:LARGEST",
        help="A variable: a key of the design file, as platform.mass=20:40 or platform.joints_mm[:][2]=-5:5. +KEY adds "
        "to what is there, *KEY scales it, A,-B ties B to minus A. base.circle.half_angle and "
        ".turn, and the same of the platform, make three symmetric pairs of joints. Repeatable.",
    ),
    click.option(
        "--keep",
        multiple=True,
        metavar="NAME[_UNIT][=BOUND]",
        help=f"A constraint: {', '.join(KEEPS)}. Without a bound: no worse than the design is now. Repeatable.",
    ),
    click.option(
        "--against", metavar="NAME", help="The Pareto front of the index against this (mass, footprint, cond, ...)."
    ),
    where_options,
    click.option(
        "--mean",
        type=common.GIVEN_FILE,
        default=None,
        metavar="FILE",
        help="Raise the mean index over the poses of a file (x,y,z,roll,pitch,yaw in m, degrees).",
    ),
    click.option("--trials", type=common.count(0, 10**6), default=200, show_default=True, help="Of the global search."),
    click.option(
        "--study",
        type=click.Path(path_type=Path, dir_okay=False),
        default=None,
        metavar="FILE",
        help="Keep the trials in this SQLite file: to stop, to go on, to share the search between processes.",
    ),
    click.option("--sampler", type=click.Choice(["tpe", "sobol"]), default="tpe", show_default=True),
    click.option("--seed", type=common.SEED, default=0, show_default=True),
    click.option("--points", type=common.count(1), default=2**12, show_default=True, help="Poses of a trial."),
    click.option(
        "--verify", type=common.count(2, 10**8), default=2**17, show_default=True, help="Poses of the last sweep."
    ),
    click.option(
        "--certify",
        is_flag=True,
        help="Prove what the index of the result is at least over the whole workspace, to 1 %, in at most 5 minutes.",
    ),
    click.option(
        "--refine", type=common.count(0, 1000), default=12, show_default=True, help="Points of a front made exact."
    ),
    threads_option,
    out_option,
)


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str
    vary: tuple[str, ...]
    keep: tuple[str, ...]
    against: str | None
    pose: tuple[float, ...] | None
    around: tuple[float, float] | None
    box: tuple[str, ...]
    mean: Path | None
    trials: int
    study: Path | None
    sampler: Literal["tpe", "sobol"]
    seed: int
    points: int
    verify: int
    certify: bool
    refine: int
    threads: int | None
    out: Path | None
    changes: tuple[str, ...]
    joint: JointModel
    as_json: bool

    def settings(self) -> dict[str, Any]:
        names = ("trials", "study", "seed", "threads", "joint")
        return {"samples": self.points, **{name: getattr(self, name) for name in names}}
