"""The options of `flexapod certify`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common
from flexapod.cli.options.cluster import cluster_options
from flexapod.cli.options.optimise import threads_option, where_options
from flexapod.cli.options.quantities import FREQUENCY, TIME

if TYPE_CHECKING:
    from flexapod.conventions import JointModel


class Share(click.ParamType):
    """A share above 0 and below 1, as 0.01 or 1%."""

    name = "share"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        if not isinstance(value, str):
            return float(value)
        text = value.strip()
        try:
            share = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
        except ValueError:
            share = float("nan")
        if not 0 < share < 1:
            self.fail(f"{value!r} is no share; give one above 0 and below 1, as 1% or 0.01.", param, ctx)
        return share


claim_options = common.stack(
    click.option(
        "--at-least",
        type=FREQUENCY,
        metavar="RAD_S",
        help="Prove that the stability index is at least this at every pose, as 125 or 20Hz.",
    ),
    click.option("--gap", type=Share(), metavar="SHARE", help="Without --at-least: how close a bound.  [default: 1%]"),
    click.option("--regular", is_flag=True, help="Prove that no pose is singular instead."),
    click.option("--limits", is_flag=True, help="Prove that every pose is within the design's limits instead."),
    click.option(
        "--condition", type=common.POSITIVE, metavar="C", help="Prove that cond(H), in metres, is at most this instead."
    ),
    click.option(
        "--largest",
        is_flag=True,
        help="Find the largest box of the shape of --around or --box, about its middle, for which --at-least holds.",
    ),
)
region_options = common.stack(
    where_options,
    click.option(
        "--path",
        "path_file",
        type=common.GIVEN_FILE,
        metavar="FILE",
        help="All along a path, as `flexapod path` reads it.",
    ),
    click.option(
        "--ends",
        type=click.Choice(["rest", "free", "periodic"]),
        default="rest",
        show_default=True,
        help="How the path of --path begins and ends.",
    ),
    click.option("--from-home", is_flag=True, help="Measure the poses of --path from the home pose."),
    click.option("--within-limits", is_flag=True, help="Let only poses within the design's limits count."),
    click.option(
        "--uncertain",
        multiple=True,
        metavar="KEY=SPREAD[%][,DISTRIBUTION]",
        help="A stiffness, mass, moment of inertia or place of a joint that strays, as for `flexapod robust`: the "
        "bound holds for all of its values. Repeatable.",
    ),
    click.option("--payload", metavar="LEAST:LARGEST", help="Mass (kg) of a load on the platform beyond the design's."),
    click.option(
        "--payload-at",
        nargs=3,
        metavar="X Y Z",
        help="Where it is in the platform frame (m): numbers, or ranges LEAST:LARGEST, for all of which the bound is. "
        "Default: its origin.",
    ),
)
run_options = common.stack(
    click.option("--time-limit", type=TIME, metavar="S", help="How long to try; then what is proved so far is told."),
    threads_option,
    *cluster_options,
    click.option("--resume", is_flag=True, help="Go on with the certificate that the same command began in --out."),
    click.option(
        "--check", type=common.GIVEN_FILE, metavar="FILE", help="Prove the certificate in FILE anew, by other boxes."
    ),
    common.out_option(
        "Where to keep the certificate (JSON), also while it is made, and its page (HTML). Default: here; with --json: "
        "no files."
    ),
)


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str | None
    at_least: float | None
    gap: float | None
    regular: bool
    limits: bool
    condition: float | None
    largest: bool
    pose: tuple[float, ...] | None
    around: tuple[float, float] | None
    box: tuple[str, ...]
    path_file: Path | None
    ends: str
    from_home: bool
    within_limits: bool
    uncertain: tuple[str, ...]
    payload: str | None
    payload_at: tuple[str, str, str] | None
    time_limit: float | None
    threads: int | None
    scheduler: str | None
    timeout: float
    resume: bool
    check: Path | None
    out: Path | None
    changes: tuple[str, ...]
    joint: JointModel
    as_json: bool
