"""What drives a simulation, as said on the command line: channels, numbers with units, spectra."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common
from flexapod.conventions import AXES, LEGS, TRANSLATIONS, TWO_PI

if TYPE_CHECKING:
    from flexapod.excitation.excitation import Excitation
    from flexapod.excitation.spectra import Spectrum

USES = {"base": "base_motion", "force": "force", "moment": "moment", "leg": "leg_command"}
UNITS = {
    "": 1.0,
    "m": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "um": 1e-6,
    "nm": 1e-9,
    "rad": 1.0,
    "mrad": 1e-3,
    "urad": 1e-6,
    "deg": TWO_PI / 360,
    "N": 1.0,
    "kN": 1e3,
    "Nm": 1.0,
    "m/s2": 1.0,
    "g": 9.80665,
    "rad/s2": 1.0,
    "rad/s": 1.0,
    "Hz": TWO_PI,
    "rpm": TWO_PI / 60,
    "s": 1.0,
    "ms": 1e-3,
    "min": 60.0,
}
NUMBER = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([a-zA-Z/2]*)")


class Quantity(click.ParamType):
    """A number, SI unless a unit follows it at once: 1e-6, 1um, 0.5deg, 20Hz."""

    name = "number"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        match = NUMBER.fullmatch(str(value).strip())
        if match is None or match[2] not in UNITS:
            self.fail(f"{value!r} is not a number with a unit of {', '.join(u for u in UNITS if u)}.", param, ctx)
        return float(match[1]) * UNITS[match[2]]


QUANTITY = Quantity()


def _drive(name: str, numbers: int, metavar: str, words: str) -> Callable[[Any], Any]:
    kinds = (str, *[QUANTITY] * numbers)
    return click.option(f"--{name}", type=kinds, multiple=True, metavar=f"CHANNEL {metavar}", help=words)


drive_options = common.stack(
    _drive("harmonic", 2, "AMPLITUDE OMEGA", "A sine, as `--harmonic z 1um 750`."),
    _drive("sweep", 4, "AMPLITUDE FROM TO SECONDS", "A sine swept by logarithm from one frequency to another."),
    _drive("shock", 2, "PEAK SECONDS", "A half-sine pulse: of the base's acceleration, or of a load itself."),
    _drive("step", 2, "CHANGE SECONDS", "A smooth change, as of a load or a leg's length."),
    _drive("spin", 1, "RATE", "A constant rate, as `--spin yaw 30rpm --start carried`."),
    click.option(
        "--random",
        type=(str, str),
        multiple=True,
        metavar="CHANNEL SPECTRUM",
        help="Random motion: VC-A to VC-G, ground, ground:low, sea:HEIGHT:PERIOD, or flat:RMS:FROM:TO (acceleration).",
    ),
    click.option(
        "--recording",
        type=(click.Choice(tuple(USES)), click.Path(exists=True, dir_okay=False)),
        multiple=True,
        metavar="USE FILE",
        help="A CSV file for base, force, moment or leg: columns time and channels, as time,z_um,roll_deg or leg1_mm.",
    ),
    click.option("--seed", type=int, default=1, show_default=True, help="Of --random."),
    click.option("--ramp", type=QUANTITY, default=None, metavar="SECONDS", help="Let all drives rise smoothly."),
)


def drives(given: dict[str, Any]) -> dict[str, Excitation]:
    """Excitations by argument of `simulate`, from the options above. Raises UsageError for an unknown channel."""
    from flexapod.excitation import piecewise, random_phases, recordings, sines
    from flexapod.excitation.excitation import Excitation

    def shock(use: str, channel: str, peak: float, duration: float) -> Excitation:
        if use != "base_motion":
            return piecewise.half_sine_pulse(channel, peak, duration)
        return piecewise.half_sine_shock(channel, peak, duration, recovery=4 * duration)  # brings the base to rest

    makers: dict[str, Callable[..., Excitation]] = {
        "harmonic": sines.harmonic,
        "sweep": sines.sine_sweep,
        "step": piecewise.smooth_step,
        "spin": lambda channel, rate: piecewise.polynomial(channel, [0.0, rate]),
    }
    total: dict[str, Excitation] = {}

    def add(use: str, drive: Excitation) -> None:
        total[use] = total.get(use, Excitation()) + drive

    for name, make in makers.items():
        for channel, *numbers in given[name]:
            use, own = _channel(channel)
            add(use, make(own, *numbers))
    for channel, *numbers in given["shock"]:
        use, own = _channel(channel)
        add(use, shock(use, own, *numbers))
    for i, (channel, text) in enumerate(given["random"]):
        use, own = _channel(channel)
        add(use, random_phases.random_motion(own, _spectrum(text), seed=given["seed"] + i))
    for use, file in given["recording"]:
        add(USES[use], recordings.read_time_series(file))
    if given["ramp"] is not None:
        total = {use: drive.ramped(given["ramp"]) for use, drive in total.items()}
    return total


def _channel(text: str) -> tuple[str, str]:
    """`z` and `base:z` move the base; `force:z`, `moment:z` and `leg:3` load the platform and command a leg."""
    use, _, own = text.rpartition(":")
    use = use or "base"
    allowed = {"base": AXES, "leg": LEGS}.get(use, TRANSLATIONS)
    if use not in USES or own not in allowed:
        raise click.UsageError(
            f"channel {text!r} is unknown: give {', '.join(AXES)} for the base, force:x to force:z, moment:x to "
            "moment:z, or leg:1 to leg:6."
        )
    return USES[use], own


def _spectrum(text: str) -> Spectrum:
    from flexapod.excitation import spectra

    kind, *words = text.split(":")
    if kind in spectra.VC_SPEED and not words:
        return spectra.vc_curve(kind)
    if kind == "ground" and len(words) < 2:
        return spectra.ground_noise(words[0] if words else "high")  # type: ignore[arg-type]
    numbers = [QUANTITY.convert(word, None, None) for word in words]
    if kind == "sea" and len(numbers) in (2, 3):
        return spectra.sea_spectrum(*numbers)
    if kind == "flat" and len(numbers) == 3:
        return spectra.flat_spectrum(numbers[0], numbers[1], numbers[2])
    raise click.UsageError(
        f"spectrum {text!r} is unknown: give VC-A to VC-G, ground, ground:low, sea:HEIGHT:PERIOD, "
        "sea:HEIGHT:PERIOD:GAMMA or flat:RMS:FROM:TO."
    )
