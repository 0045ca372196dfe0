"""Every number of the command line has a dimension: units of it are read, and those of others refused."""

import click
import numpy as np
import pytest

from flexapod.cli import COMMANDS, group
from flexapod.cli.options.quantities import Quantity, read

ISOLATOR = "cubic-isolator"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("modes", ISOLATOR, "--pose", "1deg", 0, 0, 0, 0, 0), "'1deg' is not a number with a unit of length"),
        (("modes", ISOLATOR, "--pose", 0, 0, 0, "1mm", 0, 0), "'1mm' is not a number with a unit of angle"),
        (("modes", ISOLATOR, "--characteristic-length", "2s"), "unit of length"),
        (("sweep", ISOLATOR, "--around", "1deg", "1mm"), "unit of length"),
        (("sweep", ISOLATOR, "--box", "x=0:1deg"), "--box x: '1deg' is not a number with a unit of length"),
        (("sweep", ISOLATOR, "--grid", "roll=0:1mm:3"), "--grid roll: '1mm' is not a number with a unit of angle"),
        (("sweep", ISOLATOR, "--points", 8, "--around", 0.001, 1, "--at-least", "2s"), "unit of frequency"),
        (("response", ISOLATOR, "--omega-min", "2s"), "unit of frequency"),
        (("response", ISOLATOR, "--point", 0, 0, "1N"), "unit of length"),
        (
            ("response", ISOLATOR, "--points", 5, "--amplitude", "1deg"),
            "--amplitude: '1deg' is not a number with a unit",
        ),
        (("response", ISOLATOR, "--points", 5, "--axis", "roll", "--amplitude", "1mm"), "unit of angle"),
        (
            ("response", ISOLATOR, "--points", 5, "--amplitude", "-1mm"),
            "--amplitude is -1mm; it must be finite and > 0",
        ),
        (("control", ISOLATOR, "velocity", "--dt", "1Hz"), "unit of time"),
        (("control", ISOLATOR, "velocity", "--shake", "1mm"), "unit of acceleration"),
        (("control", ISOLATOR, "velocity", "--shake", 1, "--band", "1s", "2s"), "unit of frequency"),
        (("control", ISOLATOR, "velocity", "--force-limit", "3g"), "unit of force"),
        (("path", ISOLATOR, "w.csv", "--leg-rate", "1m"), "unit of velocity"),
        (("path", ISOLATOR, "w.csv", "--clearance", "1kN"), "unit of length"),
        (("path", ISOLATOR, "w.csv", "--bound", "3mm"), "unit of frequency"),
    ],
)
def test_a_unit_of_another_dimension_is_refused(run, arguments, words):
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert words in err


def test_a_unit_of_the_dimension_is_read(result):
    bare = result("modes", ISOLATOR, "--pose", 0.001, 0, 0.034, 0, 2, 0)
    named = result("modes", ISOLATOR, "--pose", "1mm", 0, "34 mm", 0, "0.0349065850398866rad", "0mrad")
    assert named["omega_rad_s"] == pytest.approx(bare["omega_rad_s"], rel=1e-12)
    hertz = result("response", ISOLATOR, "--points", 5, "--omega-min", "1Hz", "--omega-max", "0.01kHz")
    assert np.array(hertz["omega_rad_s"])[[0, -1]] == pytest.approx([2 * np.pi, 20 * np.pi])
    boxes = [
        result("sweep", ISOLATOR, "--points", 50, "--box", box)["summary"]
        for box in ("x=-0.001:0.001,roll=-1:1", "x=-1mm:1mm,roll=-1deg:1deg")
    ]
    assert boxes[0] == boxes[1]


@pytest.mark.parametrize(
    ("text", "dimension", "unit", "value"),
    [
        ("1.5", "frequency", "Hz", 1.5),
        ("6.283185307179586rad/s", "frequency", "Hz", 1.0),
        ("60rpm", "frequency", "Hz", 1.0),
        ("1e-3", "length", "", 1e-3),
        ("1 µm", "length", "", 1e-6),
        ("2g", "acceleration", "", 19.6133),
        ("3Nm", "moment", "", 3.0),
        ("-.5deg", "angle", "deg", -0.5),
    ],
)
def test_numbers_are_in_the_unit_of_their_option(text, dimension, unit, value):
    assert read(text, dimension, "--option", unit) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize("text", ["nan", "inf", "", "1e400", "one", "0x10", "1_0", "٣"])
def test_what_is_no_number(text):
    with pytest.raises(click.UsageError, match="finite"):
        read(text, "length", "--option")


@pytest.mark.parametrize("name", COMMANDS)
def test_options_whose_words_name_a_unit_have_its_dimension(name):
    """Where a metavar says M, S, N, HZ, RAD_S, M_S or M_S2, the option takes the units of that dimension."""
    dimensions = {"M": "length", "S": "time", "SECONDS": "time", "N": "force", "HZ": "frequency", "RAD_S": "frequency",
                  "RAD/S": "frequency", "M_S": "velocity", "M_S2": "acceleration", "DEG": "angle"}  # fmt: skip
    command = group.get_command(click.Context(group), name)
    for option in command.params:
        if isinstance(option.type, click.IntRange):  # N of a count
            continue
        kinds = option.type.types if isinstance(option.type, click.Tuple) else [option.type] * option.nargs
        for word, kind in zip((option.metavar or "").split(), kinds, strict=False):
            if word in dimensions and kind is not click.STRING:
                assert isinstance(kind, Quantity), f"{option.opts[0]} {word}"
                assert kind.dimension == dimensions[word], f"{option.opts[0]} {word}"
