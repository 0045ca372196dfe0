"""Units of keys against Pint, and the words of errors about them."""

import numpy as np
import pint
import pytest

import flexapod as fx
from flexapod.design.design_file import template
from flexapod.design.units import QUANTITIES, UNITS, si_unit
from flexapod.errors import told_apart

OWN = fx.Hexapod.from_toml(template("own"))
PINT = pint.UnitRegistry()
#: Where a word of a key is another unit to Pint.
WORDS = {"g": "g_0", "in": "inch", "lb": "pound", "t": "tonne", "lbf": "force_pound", "ft": "foot"}


def to_pint(unit, dimension):
    """`lbf_s_per_in` as Pint writes it."""
    above, _, below = unit.partition("_per_")

    def product(text):
        words = []
        for word in filter(None, text.split("_")):
            power = word[-1] if word[-1].isdigit() and word not in ("g_0",) else ""
            name = word.removesuffix(power) if power else word
            name = "gram" if name == "g" and dimension != "acceleration" else WORDS.get(name, name)
            words.append(f"{name}**{power}" if power else name)
        return " * ".join(words) or "1"

    return f"({product(above)}) / ({product(below)})"


@pytest.mark.parametrize(
    ("dimension", "unit"), [(d, u) for d, units in QUANTITIES.items() for u in units if u not in ("mg", "Hz", "kHz")]
)
def test_units_are_those_of_pint(dimension, unit):  # mg is a milligram to it, and Hz no angle
    si = PINT(to_pint(si_unit(dimension), dimension))
    known = PINT(to_pint(unit, dimension)).to(si.units)
    multiply, divide = QUANTITIES[dimension][unit]
    assert multiply / divide == pytest.approx(known.magnitude, rel=4e-15)


@pytest.mark.parametrize(
    ("changes", "key", "expected"),
    [
        ({"base.circle.radius_ft": 2}, "base.joints", OWN.base_joints / 0.5 * 0.6096),
        ({"legs.stiffness_lbf_per_in": 1e5}, "legs.stiffness", 1e5 * 0.45359237 * 9.80665 / 0.0254),
        (
            {"platform.inertia_lb_in2": [6000, 6000, 9000]},
            "platform.inertia",
            np.diag([6, 6, 9]) * 0.45359237 * 0.64516,
        ),
        ({"gravity_g": [0, 0, -1]}, "gravity", [0, 0, -9.80665]),
        ({"legs.damping.prismatic_lbf_s_per_in": 2}, "legs.damping.prismatic", 2 * 0.45359237 * 9.80665 / 0.0254),
        ({"platform.mass_g": 5e4}, "platform.mass", 50),
    ],
)
def test_imperial_units_and_gravity_in_g(changes, key, expected):
    found = OWN.replace(changes).values()[key]
    np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("dimension", UNITS)
def test_every_dimension_has_its_article(dimension):
    key = {
        "length": "base.circle.radius",
        "mass": "platform.mass",
        "inertia": "platform.inertia",
        "stiffness": "legs.stiffness",
        "damping": "legs.damping.prismatic",
        "angular damping": "legs.damping.universal",
        "angular stiffness": "legs.joint_stiffness.torsion",
        "bending stiffness": "legs.lower.rod.bending_stiffness",
        "force": "legs.stiffness_law.axial_rigidity",
        "moment": "limits.universal_moment",
        "pressure": "legs.stiffness_law.bulk_modulus",
        "area": "legs.stiffness_law.area",
        "acceleration": "gravity",
        "angle": "limits.universal_angle",
        "velocity": "limits.leg_rate",
        "angular velocity": "drive.motor.max_speed",
        "power": "limits.leg_power",
    }[dimension]
    wrong = "mm" if dimension != "length" else "kg"
    with pytest.raises(fx.DesignError) as caught:
        OWN.replace({f"{key}_{wrong}": 1})
    article = "an" if dimension[0] in "aeiou" else "a"
    assert f"{key} is {article} {dimension}. Use" in str(caught.value)


def test_remedies_are_for_what_is_wrong():
    with pytest.raises(fx.DesignError, match="give that of actuator, joints and mounts in series") as caught:
        OWN.replace({"legs.stiffness": 0})
    assert "rigid" not in str(caught.value)
    with pytest.raises(fx.DesignError, match="large finite value for a rigid leg"):
        OWN.replace({"legs.stiffness": float("inf")})


@pytest.mark.parametrize(
    ("value", "bound", "expected"),
    [
        (1.20004, 1.2, ("1.20004", "1.2")),
        (1.1999, 1.2, ("1.1999", "1.2")),
        (2.0, 1.0, ("2", "1")),
        (1.2, 1.2, ("1.2", "1.2")),
        (np.nextafter(1.2, 2), 1.2, ("1.2000000000000002", "1.2")),
        (float("nan"), 1.0, ("nan", "1")),
        (float("inf"), 1.0, ("inf", "1")),
    ],
)
def test_digits_that_tell_numbers_apart(value, bound, expected):
    words = told_apart(value, bound)
    assert tuple(float(word) for word in words) == pytest.approx(
        tuple(map(float, expected)), nan_ok=True, abs=0, rel=1e-15
    )
    if value != bound and value == value:
        assert words[0] != words[1]


def test_limits_are_told_with_enough_digits():
    length = float(fx.inverse_kinematics(OWN)[0])
    for bound in (length * (1 + 1e-6), length * (1 + 1e-14)):
        (words, *_) = fx.check_limits(OWN.replace({"limits.leg_length": [bound, 2.0]})).exceeded
        value, least = (float(part.split(" m")[0]) for part in (words.split("length ")[1], words.split("below ")[1]))
        assert value < least
    with pytest.raises(fx.DesignError) as caught:
        OWN.replace({"limits.leg_length": [0.8 + 1e-9, 0.8]})
    assert "[0.800000001, 0.8] m" in str(caught.value)
    with pytest.raises(fx.DesignError) as caught:
        OWN.replace({"limits.universal_angle_deg": 180 * (1 + 1e-9)})
    assert "is 180.0000002 deg; it must be <= 180" in str(caught.value)
