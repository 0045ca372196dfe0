"""The options of `flexapod response`."""

from __future__ import annotations

import click

from flexapod.cli.options import common
from flexapod.cli.options.points import point_option
from flexapod.cli.options.quantities import FREQUENCY
from flexapod.cli.options.shaking import shaking_options
from flexapod.conventions import AXES, LEGS

response_options = common.stack(
    click.option(
        "--from",
        "source",
        type=click.Choice(("base", "wrench", "command")),
        default="base",
        show_default=True,
        help="What shakes: the base, a wrench at the output point, or a leg's length command.",
    ),
    click.option(
        "--axis", type=click.Choice(AXES + LEGS), default=None, help="Axis, or leg for commands. Default: z, 1."
    ),
    click.option("--relative", is_flag=True, help="Motion relative to the base instead of absolute motion."),
    click.option(
        "--omega-min", type=FREQUENCY, default=None, metavar="RAD/S", help="Default: a fifth of the lowest mode."
    ),
    click.option(
        "--omega-max", type=FREQUENCY, default=None, metavar="RAD/S", help="Default: 1.5 times the highest mode."
    ),
    click.option(
        "--points",
        type=click.IntRange(2, 1_000_000),
        default=500,
        show_default=True,
        help="Frequencies, equally spaced by logarithm; 13 more are put around each resonance.",
    ),
    point_option("Output point of the platform"),
    click.option(
        "--loss-factor",
        type=common.NOT_NEGATIVE,
        help="Of the legs' springs, in place of the design's legs.loss_factor.",
    ),
    click.option(
        "--amplitude",
        type=str,
        default=None,
        metavar="M",
        help="Shake the base of the non-linear machine too, by this amplitude (m or rad), at --steps frequencies.",
    ),
    click.option("--steps", type=click.IntRange(2, 100_000), default=100, show_default=True, help="See --amplitude."),
    shaking_options,
    common.out_option("Write figures, .csv and .nc here."),
)
