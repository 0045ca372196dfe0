"""--psd, --load and --at: the spectra of what shakes a machine at random."""

from __future__ import annotations

import click

from flexapod.cli.options import common
from flexapod.cli.options.points import point_option

shaking_options = common.stack(
    click.option(
        "--psd",
        type=common.GIVEN_FILE,
        default=None,
        metavar="CSV",
        help="Spectra of the base for RMS values: column frequency_hz and one or more of x, y, z (m/s2)^2/Hz, roll, "
        "pitch, yaw (rad/s2)^2/Hz, one-sided; or in the units of their titles, as z_g2/Hz or x_mm2/Hz.",
    ),
    click.option(
        "--load",
        "loads",
        type=common.GIVEN_FILE,
        multiple=True,
        metavar="CSV",
        help="Spectra of a random load on the platform: column frequency_hz and one or more of force_x, ... N2/Hz, "
        "moment_x, ... (N m)2/Hz, in inertial axes, one-sided. Repeatable; it adds to --psd.",
    ),
    point_option("Where a load acts, one for all or for each --load in turn", "--at", multiple=True),
)
