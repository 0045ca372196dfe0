"""The options of `flexapod simulate`."""

from __future__ import annotations

import click

from flexapod.cli.options import common
from flexapod.cli.options.drives import drive_options
from flexapod.cli.options.points import point_option
from flexapod.cli.options.quantities import TIME, Quantity

simulate_options = common.stack(
    drive_options,
    click.option(
        "--duration",
        type=TIME,
        default=None,
        metavar="SECONDS",
        help="As 0.5, 500ms or 2min. Default: the length of the recording.",
    ),
    click.option("--force", type=Quantity("force"), nargs=3, default=(0, 0, 0), metavar="X Y Z", help="Constant, N."),
    click.option(
        "--moment", type=Quantity("moment"), nargs=3, default=(0, 0, 0), metavar="X Y Z", help="Constant, N m."
    ),
    click.option(
        "--start",
        type=click.Choice(("rest", "carried")),
        default="rest",
        show_default=True,
        help="The platform is at rest in the room, or moves with the base, when it begins.",
    ),
    point_option("Point of the platform whose motion is told"),
    common.loss_frequency_option,
    click.option("--unloaded", is_flag=True, help="Let gravity ring: the legs are unstretched at the pose."),
    click.option("--samples", type=common.count(2), default=None, help="Default: 20 a period of the highest mode."),
    click.option("--rtol", type=common.NUMBER, default=1e-9, show_default=True, help="Relative error of a step."),
    click.option("--reactions", is_flag=True, help="Forces and moments in all joints too."),
    common.out_option("Write figures, .csv and .nc here."),
    click.option(
        "--animate",
        type=common.FILE,
        default=None,
        metavar="FILE",
        help="Write a moving picture of the last periods: a .gif, or an .mp4 with the extra 'video'.",
    ),
    common.exaggeration_option,
)
