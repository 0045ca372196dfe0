"""What drives a simulation, as said on the command line: channels, numbers with units, spectra, recordings."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common
from flexapod.cli.options.quantities import HERTZ, TIME, dimension_of, read
from flexapod.conventions import AXES, LEGS, ROTATIONS, TRANSLATIONS, TWO_PI

if TYPE_CHECKING:
    from flexapod.excitation.excitation import Excitation
    from flexapod.excitation.spectra import Spectrum

USES = {"base": "base_motion", "force": "force", "moment": "moment", "leg": "leg_command"}
#: Dimensions of the numbers behind a channel; "" is that of the channel's value, "rate" and "pulse" follow from it.
NUMBERS = {
    "harmonic": ("", "frequency"),
    "sweep": ("", "frequency", "frequency", "time"),
    "shock": ("pulse", "time"),
    "step": ("", "time"),
    "spin": ("rate",),
}
RATES = {"length": "velocity", "angle": "angular velocity"}
SECOND_RATES = {"length": "acceleration", "angle": "angular acceleration"}


def _drive(name: str, metavar: str, words: str) -> Callable[[Any], Any]:
    kinds = (str,) * (1 + len(NUMBERS[name]))
    return click.option(f"--{name}", type=kinds, multiple=True, metavar=f"CHANNEL {metavar}", help=words)


drive_options = common.stack(
    _drive("harmonic", "AMPLITUDE OMEGA", "A sine, as `--harmonic z 1um 750`."),
    _drive("sweep", "AMPLITUDE FROM TO SECONDS", "A sine swept by logarithm from one frequency to another."),
    _drive("shock", "PEAK SECONDS", "A half-sine pulse: of the base's acceleration, or of a load itself."),
    _drive("step", "CHANGE SECONDS", "A smooth change, as of a load or a leg's length."),
    _drive("spin", "RATE", "A constant rate, as `--spin yaw 30rpm --start carried`."),
    click.option(
        "--random",
        type=(str, str),
        multiple=True,
        metavar="CHANNEL SPECTRUM",
        help="Random motion of the base: VC-A to VC-G, ground, ground:low, sea:HEIGHT:PERIOD, or flat:RMS:FROM:TO, "
        "whose RMS is an acceleration unless its unit says otherwise. A random load or leg command: flat:RMS:FROM:TO "
        "of the load or command itself.",
    ),
    click.option(
        "--recording",
        type=(click.Choice(tuple(USES)), common.GIVEN_FILE),
        multiple=True,
        metavar="USE FILE",
        help="A CSV file for base, force, moment or leg: columns time and channels, as time,z_um,roll_deg or leg1_mm.",
    ),
    click.option(
        "--detrend",
        type=click.Choice(("first", "mean", "linear")),
        default=None,
        help="Take the first value, the mean or a straight line out of every recording.",
    ),
    click.option(
        "--highpass",
        type=HERTZ,
        default=None,
        metavar="HZ",
        help="Take what is slower than this out of every recording.",
    ),
    click.option("--seed", type=common.SEED, default=1, show_default=True, help="Of --random."),
    click.option("--ramp", type=TIME, default=None, metavar="SECONDS", help="Let all drives rise smoothly."),
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
            add(use, make(own, *_numbers(name, use, own, numbers)))
    for channel, *numbers in given["shock"]:
        use, own = _channel(channel)
        add(use, shock(use, own, *_numbers("shock", use, own, numbers)))
    for i, (channel, text) in enumerate(given["random"]):
        use, own = _channel(channel)
        add(use, random_phases.random_motion(own, _spectrum(text, use, own), seed=given["seed"] + i))
    highpass = None if given["highpass"] is None else TWO_PI * given["highpass"]
    for use, file in given["recording"]:
        add(USES[use], recordings.read_time_series(file, detrend=given["detrend"], highpass=highpass))
    if not given["recording"] and (highpass is not None or given["detrend"] is not None):
        raise click.UsageError("--detrend and --highpass are for --recording, which is not given.")
    if given["ramp"] is not None:
        total = {use: drive.ramped(given["ramp"]) for use, drive in total.items()}
    return total


def _numbers(name: str, use: str, own: str, texts: list[str]) -> list[float]:
    """The numbers of a drive in SI units, each of its dimension."""
    value = _value(use, own)
    if name == "spin" and value not in RATES:
        raise click.UsageError("--spin turns or moves the base, or changes a leg's length, at a constant rate.")
    found = []
    for text, kind in zip(texts, NUMBERS[name], strict=True):
        pulse = SECOND_RATES[value] if use == "base_motion" else value
        dimension = {"": value, "rate": RATES.get(value, ""), "pulse": pulse}.get(kind, kind)
        found.append(read(text, dimension, f"--{name}"))
    return found


def _value(use: str, own: str) -> str:
    """The dimension of a channel's value."""
    return use if use in ("force", "moment") else "angle" if own in ROTATIONS else "length"


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


def _spectrum(text: str, use: str, own: str) -> Spectrum:
    """The spectrum of `--random`. Raises UsageError for one that the channel cannot have."""
    from flexapod.excitation import spectra

    kind, *words = text.split(":")
    value = _value(use, own)
    if kind == "flat" and len(words) == 3:
        low, high = (read(word, "frequency", "--random") for word in words[1:])
        quantities: dict[str, spectra.Quantity] = {value: value if value in spectra.LOADS else "displacement"}
        if use == "base_motion":
            quantities = {SECOND_RATES[value]: "acceleration", RATES[value]: "velocity", value: "displacement"}
        dimension = dimension_of(words[0], tuple(quantities))
        rms = read(words[0], dimension, "--random")
        return spectra.flat_spectrum(rms, low, high, quantity=quantities[dimension])
    known = kind in spectra.VC_SPEED or kind in ("ground", "sea")
    if known and (use != "base_motion" or own in ROTATIONS):
        raise click.UsageError(
            f"spectrum {text!r} is one of a floor's or a sea's translation; {_channel_words(use, own)} takes "
            f"flat:RMS:FROM:TO, as flat:10{'N' if value == 'force' else ''}:1Hz:100Hz."
        )
    if kind in spectra.VC_SPEED and not words:
        return spectra.vc_curve(kind)
    if kind == "ground" and len(words) < 2:
        return spectra.ground_noise(words[0] if words else "high")  # type: ignore[arg-type]
    if kind == "sea" and len(words) in (2, 3):
        height, period = read(words[0], "length", "--random"), read(words[1], "time", "--random")
        return spectra.sea_spectrum(height, period, *(_plain(word) for word in words[2:]))
    raise click.UsageError(
        f"spectrum {text!r} is unknown: give VC-A to VC-G, ground, ground:low, sea:HEIGHT:PERIOD, "
        "sea:HEIGHT:PERIOD:GAMMA or flat:RMS:FROM:TO."
    )


def _channel_words(use: str, own: str) -> str:
    return own if use == "base_motion" else f"{'leg' if use == 'leg_command' else use}:{own}"


def _plain(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise click.UsageError(f"--random: GAMMA is {word!r}; it must be a number without a unit.") from None
