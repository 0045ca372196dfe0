"""The options of `flexapod control`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common
from flexapod.cli.options.points import PointGiven, point_option
from flexapod.cli.options.quantities import FREQUENCY, HERTZ, TIME, Quantity
from flexapod.cli.options.shaking import shaking_options

if TYPE_CHECKING:
    from flexapod.conventions import JointModel

LAWS = ("pid", "force", "velocity", "lqg", "h-infinity")


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str
    law: str
    changes: tuple[str, ...]
    pose: tuple[float, ...] | None
    joint: JointModel
    as_json: bool
    kp: float | None
    kd: float | None
    ki: float
    space: str
    actuator: str
    bandwidth: float | None
    gain: float | None
    leak: float | None
    measure: str
    effort: float | None
    noise: float | None
    dt: float | None
    delay: int
    shake: float | None
    axes: str
    band: tuple[float, float] | None
    duration: float | None
    force_limit: float | None
    sensor_noise: float | None
    loss_frequency: float | None
    seed: int
    psd: Path | None
    loads: tuple[Path, ...]
    at: tuple[PointGiven, ...]
    point: PointGiven
    out: Path | None


law_options = common.stack(
    click.argument("law", type=click.Choice(LAWS)),
    click.option(
        "--kp", type=common.NUMBER, help="Proportional gain of pid, N/m (force, joint space), or as the library says."
    ),
    click.option("--kd", type=common.NUMBER, help="Derivative gain of pid, N s/m."),
    click.option("--ki", type=common.NUMBER, default=0.0, help="Integral gain of pid, N/(m s)."),
    click.option("--space", type=click.Choice(["joint", "task"]), default="joint", show_default=True, help="Of pid."),
    click.option(
        "--actuator",
        type=click.Choice(["force", "command"]),
        default="force",
        show_default=True,
        help="What pid commands: leg forces, or changes of leg length.",
    ),
    click.option("--bandwidth", type=FREQUENCY, metavar="RAD_S", help="Of the filter of pid's derivative."),
    click.option(
        "--gain",
        type=common.POSITIVE,
        help="Of force (rad/s) or velocity (N s/m). Default: the most damping at the sampling time.",
    ),
    click.option(
        "--leak", type=Quantity("frequency", need=">= 0"), metavar="RAD_S", help="Of force. Default: omega_1 / 10."
    ),
    click.option(
        "--measure",
        default="acceleration",
        show_default=True,
        metavar="KIND,...",
        help="What lqg and h-infinity see: acceleration, leg_force, leg_length, leg_rate, position, velocity.",
    ),
    click.option("--effort", type=common.POSITIVE, help="Weight of leg forces in lqg and h-infinity. Default: 0.1."),
    click.option("--noise", type=common.POSITIVE, help="Sensor noise that lqg and h-infinity expect. Default: 0.1."),
)
run_options = common.stack(
    point_option("Point of the platform whose motion is told"),
    click.option("--dt", type=TIME, metavar="S", help="Sampling time. Default: 2 pi/(20 omega_max)."),
    click.option("--delay", type=common.count(0, 100), default=0, help="Samples by which forces come late."),
    click.option(
        "--shake",
        type=Quantity("acceleration", need="> 0"),
        metavar="M_S2",
        help="Run on a base with this RMS acceleration on each axis.",
    ),
    click.option("--axes", default="x,y,z", show_default=True, metavar="AXIS,...", help="Axes of the base that shake."),
    click.option(
        "--band",
        type=(HERTZ, HERTZ),
        default=None,
        metavar="HZ HZ",
        help="Of the shaking. Default: about the modes.",
    ),
    click.option("--duration", type=TIME, metavar="S", help="Of the run. Default: 60 periods of the lowest mode."),
    click.option(
        "--force-limit", type=Quantity("force", need="> 0"), metavar="N", help="Largest force of an actuator."
    ),
    click.option("--sensor-noise", type=common.POSITIVE, help="RMS noise of the first measurement, in its unit."),
    shaking_options,
    common.loss_frequency_option,
    click.option("--seed", type=common.SEED, default=0, show_default=True, help="Of shaking and noise."),
    common.out_option("Where to write the report and figures. Default: nothing is written."),
)
