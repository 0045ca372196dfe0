"""Designs that are none: every message names the thing, its value, what is required, and what to do."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexapod.design.changes import parse_assignments
from flexapod.design.hexapod import Hexapod
from flexapod.design.home import Home
from flexapod.design.loading import load
from flexapod.design.parts import Damping, LegPart, Legs, Limits
from flexapod.design.schema import KEYS, TABLES, TEXT_KEYS
from flexapod.errors import DesignError

GOOD = """
name = "good"
gravity = [0.0, 0.0, -9.81]
[base]
joints = [[0.5, 0, 0], [0.4, 0.4, 0], [-0.4, 0.4, 0], [-0.5, 0, 0], [-0.1, -0.5, 0], [0.1, -0.5, 0]]
universal_axes = [[0, 1, 0], [1, 1, 0], [1, -1, 0], [0, 1, 0], [1, 0, 0], [1, 0, 0]]
[platform]
joints = [[0.3, 0.1, 0], [0.1, 0.3, 0], [-0.1, 0.3, 0], [-0.3, 0.1, 0], [-0.2, -0.3, 0], [0.2, -0.3, 0]]
mass = 10.0
mass_center = [0.0, 0.0, 0.0]
inertia = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
[legs]
stiffness = 1e7
[legs.damping]
prismatic = 1.0
[legs.lower]
mass = 3.0
mass_center = [0.2, 0.0, 0.0]
inertia = [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2]]
[legs.upper]
mass = 1.0
mass_center = [-0.2, 0.0, 0.0]
inertia = [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2]]
[limits]
leg_length = [0.4, 0.8]
[home]
position = [0.0, 0.0, 0.5]
"""

AXES = "universal_axes = [[0, 1, 0], [1, 1, 0], [1, -1, 0], [0, 1, 0], [1, 0, 0], [1, 0, 0]]"
INERTIA = "inertia = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]"
SIX_BAD = "[1e7, 1e7, 1e7, -8e7, 1e7, 1e7]"
CIRCLE = "[base.circle]\nradius = 0.5\nangles_deg = [0, 60, 120, 180, 240, 300]\n"

# What is wrong: the text replaced, by what, and the parts that the message must have (thing, value, need, remedy).
BAD = {
    # keys
    "missing key": ("mass = 10.0\n", "", ["missing: platform.mass", "platform with payload", "kg", "Add it"]),
    "missing keys are named together": (
        "stiffness = 1e7\n[legs.damping]\nprismatic = 1.0\n[legs.lower]\nmass = 3.0",
        "[legs.damping]\nprismatic = 1.0\n[legs.lower]",
        ["legs.stiffness", "N/m", "legs.lower.mass", "Add them"],
    ),
    "missing joints": (GOOD[GOOD.index("[base]") : GOOD.index("[platform]")], "", ["base.joints", "[base.circle]"]),
    "missing table": (GOOD[GOOD.index("[legs]") :], "", ["missing: legs.stiffness", "axial stiffness"]),
    "misspelt key": (
        "mass_center = [0.0, 0.0",
        "mass_centre = [0.0, 0.0",
        ["platform.mass_centre", "Did you mean platform.mass_center?"],
    ),
    "misspelt table": ("[legs.damping]", "[legs.dampers]", ["legs.dampers", "not a key", "Keys of [legs]: damping"]),
    "misspelt top table": ("[limits]", "[limit]", ["limit is not a key", "Did you mean limits?"]),
    "key in the wrong table": ("gravity =", "mass = 4.0\ngravity =", ["mass is not a key", "platform.mass"]),
    "unknown key": (
        "[limits]",
        "[limits]\nwobble = 3",
        ["limits.wobble", "Keys of [limits]: leg_acceleration, leg_compression, leg_distance, leg_length"],
    ),
    "rod and plain keys": (
        "[limits]\nleg_length = [0.4, 0.8]",
        "[limits]\n[legs.upper.rod]\nmass = 1",
        ["legs.upper.mass", "both", "Leave one of them out"],
    ),
    "a table for a number": ("mass = 10.0", "mass = {value = 10.0}", ["platform.mass", "dict", "must be one number"]),
    "a part left out": (
        GOOD[GOOD.index("[legs.upper]") : GOOD.index("[limits]")],
        "",
        ["[legs.upper] is missing while [legs.lower] is given", "leave both out for massless legs"],
    ),
    "home without position": ("position = [0.0, 0.0, 0.5]", "orientation_deg = [0, 0, 0]", ["missing: home.position"]),
    # units
    "unit of another dimension": (
        "mass = 10.0",
        "mass_mm = 10.0",
        ["platform.mass_mm", "'mm' is no unit of mass", "mass_kg, mass_g"],
    ),
    "unknown unit": (
        "stiffness = 1e7",
        "stiffness_N_per_parsec = 1e7",
        ["'N_per_parsec' is not a unit", "stiffness_N_per_um"],
    ),
    "unit where there is none": (
        AXES,
        AXES.replace("axes", "axes_mm"),
        ["universal_axes_mm", "'mm'", "has none", "universal_axes ="],
    ),
    "the same value twice": (
        "mass = 10.0",
        "mass = 10.0\nmass_g = 10000",
        ["platform.mass and platform.mass_g both give", "Leave one of them out"],
    ),
    "two units": ("mass = 10.0", "mass_kg = 10.0\nmass_g = 1e4", ["platform.mass_kg and platform.mass_g both give"]),
    "degrees for radians": (
        "[home]",
        "[home]\norientation = [0, 0, 90]",
        ["home.orientation[2] is 90 rad", "<= 6.283 rad", "_deg"],
    ),
    "a cone wider than half a turn": (
        "[limits]",
        "[limits]\nuniversal_angle_deg = 190",
        ["limits.universal_angle_deg is 190 deg", "<= 180 deg"],
    ),
    # shapes and types
    "five joints": (
        "joints = [[0.5, 0, 0], ",
        "joints = [",
        ["base.joints has shape 5 x 3", "six rows [x, y, z]", "each of the six legs"],
    ),
    "two coordinates": (
        "joints = [[0.5, 0, 0]",
        "joints = [[0.5, 0]",
        ["base.joints has rows of different lengths", "six rows"],
    ),
    "five values": (
        "stiffness = 1e7",
        "stiffness = [1, 2, 3, 4, 5]",
        ["legs.stiffness has shape 5", "one number or six numbers"],
    ),
    "one number for a vector": (
        "mass_center = [0.0, 0.0, 0.0]",
        "mass_center = 0.0",
        ["platform.mass_center has one number", "three numbers"],
    ),
    "a flat inertia": (INERTIA, "inertia = [1, 1]", ["platform.inertia has shape 2", "three rows of three numbers"]),
    "text": ("mass = 10.0", 'mass = "heavy"', ["platform.mass is 'heavy' (text)", "must be one number"]),
    "text in a list": (
        "position = [0.0, 0.0, 0.5]",
        'position = [0.0, "up", 0.5]',
        ["home.position[1] is 'up' (text)", "must be a number"],
    ),
    "a truth value": ("mass = 10.0", "mass = true", ["platform.mass is True (bool)", "must be one number"]),
    "a date": ("mass = 10.0", "mass = 2024-01-01", ["platform.mass", "date", "must be one number"]),
    "a number for the name": ('name = "good"', "name = 5", ["name is 5", "must be text", 'name = "my hexapod"']),
    "an empty name": ('name = "good"', 'name = " "', ["name is ' '", "must be text"]),
    "NaN": ("mass = 10.0", "mass = nan", ["platform.mass is nan kg", "finite"]),
    "infinity": (
        "stiffness = 1e7",
        "stiffness = inf",
        ["legs.stiffness is inf N/m", "finite", "large finite value for a rigid leg"],
    ),
    "NaN in a row": ("[-0.5, 0, 0]", "[-0.5, nan, 0]", ["base.joints[3][1] is nan m", "finite"]),
    "an integer beyond all numbers": ("mass = 10.0", f"mass = 1{'0' * 400}", ["platform.mass", "too large", "finite"]),
    "a number beyond all numbers in SI": (
        "mass = 10.0",
        "mass_t = 1e308",
        ["platform.mass_t is 1e+308 t", "smaller than 1e+100"],
    ),
    # ranges
    "negative mass": (
        "mass = 10.0",
        "mass = -10.0",
        ["platform.mass is -10 kg", "> 0", "mass of platform and payload"],
    ),
    "no mass": ("mass = 10.0", "mass_g = 0", ["platform.mass_g is 0 g", "> 0"]),
    "negative leg mass": ("mass = 3.0", "mass = -3.0", ["legs.lower.mass is -3 kg", ">= 0", "massless legs"]),
    "negative stiffness of one leg": (
        "stiffness = 1e7",
        f"stiffness = {SIX_BAD}",
        ["legs.stiffness[3] is -8e+07 N/m", "> 0", "in series"],
    ),
    "no stiffness": ("stiffness = 1e7", "stiffness_N_per_um = 0", ["legs.stiffness_N_per_um is 0 N/um", "> 0"]),
    "negative damping": (
        "prismatic = 1.0",
        "prismatic = -1.0",
        ["legs.damping.prismatic is -1 N s/m", ">= 0", "Give 0"],
    ),
    "limits the wrong way round": (
        "leg_length = [0.4, 0.8]",
        "leg_length = [0.8, 0.4]",
        ["limits.leg_length is [0.8, 0.4] m", "<", "shortest length first"],
    ),
    "limits of one leg": (
        "leg_length = [0.4, 0.8]",
        "leg_length = [[0.4, 0.8], [0.4, 0.8], [0.5, 0.5], [0.4, 0.8], [0.4, 0.8], [0.4, 0.8]]",
        ["limits.leg_length[2] is [0.5, 0.5] m"],
    ),
    "a negative limit": (
        "leg_length = [0.4, 0.8]",
        "leg_length = [-0.4, 0.8]",
        ["limits.leg_length[0] is -0.4 m", ">= 0"],
    ),
    # geometry and mass
    "all joints in one place": (
        "joints = [[0.5, 0, 0], [0.4, 0.4, 0], [-0.4, 0.4, 0], [-0.5, 0, 0], [-0.1, -0.5, 0], [0.1, -0.5, 0]]",
        "joints = [[1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0]]",
        ["base.joints[0] to base.joints[5] coincide at [1.0, 0.0, 0.0] m", "Move some"],
    ),
    "zero axis": ("[1, -1, 0]", "[0, 0, 0]", ["base.universal_axes[2] is [0.0, 0.0, 0.0]", "direction", "tangent"]),
    "asymmetric inertia": (
        INERTIA,
        INERTIA.replace("[1.0, 0.0, 0.0]", "[1.0, 0.5, 0.0]"),
        ["platform.inertia is not symmetric", "[0][1] is 0.5 and [1][0] is 0", "both sides"],
    ),
    "inertia that is not positive definite": (
        INERTIA,
        INERTIA.replace("[1.0, 0.0, 0.0]", "[-1.0, 0.0, 0.0]"),
        ["platform.inertia is not positive definite", "-1 kg m2", "> 0", "signs"],
    ),
    "singular inertia": (
        INERTIA,
        "inertia = [[1, 1, 0], [1, 1, 0], [0, 0, 1]]",
        ["platform.inertia is not positive definite"],
    ),
    "no inertia": (
        INERTIA,
        "inertia = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]",
        ["platform.inertia is not positive definite", "0 kg m2"],
    ),
    "asymmetric leg inertia": (
        "inertia = [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2]]\n[legs.upper]",
        "inertia = [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.1, 0.2]]\n[legs.upper]",
        ["legs.lower.inertia is not symmetric", "[1][2] is 0 and [2][1] is 0.1"],
    ),
    # short forms
    "joints and circle": (
        "[limits]",
        CIRCLE + "[limits]",
        ["base.joints and [base.circle] are both given", "Leave one of them out"],
    ),
    "joints and cube": (
        "[limits]",
        "[cubic]\nedge = 1\nmiddle = 0.5\n[limits]",
        ["base.joints and [cubic] are both given"],
    ),
}


def refused(text: str) -> str:
    with pytest.raises(DesignError) as caught:
        Hexapod.from_toml(text)
    return str(caught.value)


def test_the_good_design_is_good():
    assert Hexapod.from_toml(GOOD).warnings == ()


@pytest.mark.parametrize("name", BAD)
def test_bad_design(name):
    old, new, parts = BAD[name]
    assert old in GOOD
    message = refused(GOOD.replace(old, new, 1))
    for part in parts:
        assert part in message
    assert message.rstrip().endswith((".", "?"))


SHORT = CIRCLE + GOOD[GOOD.index("[platform]") :]

BAD_SHORT_FORMS = {
    "five angles": (
        "[0, 60, 120, 180, 240, 300]",
        "[0, 60, 120, 180, 240]",
        ["base.circle.angles_deg has shape 5", "six numbers"],
    ),
    "degrees for radians": ("angles_deg", "angles", ["base.circle.angles[1] is 60 rad", "_deg"]),
    "no radius": ("radius = 0.5", "", ["base.circle.radius is missing", "Add radius"]),
    "radius of zero": ("radius = 0.5", "radius_mm = 0", ["base.circle.radius_mm is 0 mm", "> 0"]),
    "a joint above the centroid, and no home": (
        SHORT,
        "[base]\njoints = [[0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 0.5]]\n"
        + GOOD[GOOD.index("[platform]") : GOOD.index("[home]")],
        ["base.universal_axes is left out", "base.joints[0] is at [0.0, 0.0, 1.0] m", "Give base.universal_axes"],
    ),
    "rod and mass": (
        "[legs.upper]\n",
        "[legs.upper]\nrod = {mass = 1, length = 1}\n",
        ["legs.upper.mass and [legs.upper.rod]"],
    ),
    "rod without length": (
        GOOD[GOOD.index("[legs.upper]") : GOOD.index("[limits]")],
        "[legs.upper.rod]\nmass = 1\n",
        ["legs.upper.rod.length is missing", "Add length"],
    ),
    "a table that is a number": (
        SHORT,
        "limits = 3\n" + SHORT.replace("[limits]\nleg_length = [0.4, 0.8]\n", ""),
        ["limits is 3", "must be a table", "Write [limits]"],
    ),
}


@pytest.mark.parametrize("name", BAD_SHORT_FORMS)
def test_bad_short_form(name):
    old, new, parts = BAD_SHORT_FORMS[name]
    assert old in SHORT
    message = refused(SHORT.replace(old, new, 1))
    for part in parts:
        assert part in message


CUBE = (
    "[cubic]\nedge = 0.3\nmiddle = 0.7\n"
    + GOOD[GOOD.index("[platform]") : GOOD.index("joints = [[0.3")]
    + GOOD[GOOD.index("mass = 10.0") : GOOD.index("[home]")]
)


@pytest.mark.parametrize(
    ("old", "new", "parts"),
    [
        ("edge = 0.3", "", ["cubic.edge and cubic.height are both missing"]),
        ("edge = 0.3", "edge = 0.3\nheight = 0.2", ["cubic.edge and cubic.height are both given", "Give one"]),
        ("middle = 0.7", "", ["cubic.middle is missing", "Add middle"]),
        ("middle = 0.7", "middle = 1.2", ["cubic.middle is 1.2", "<= 1", "such as 0.7"]),
        ("edge = 0.3", "edge_kg = 0.3", ["'kg' is no unit of length", "edge_mm"]),
    ],
)
def test_bad_cube(old, new, parts):
    assert len(Hexapod.from_toml(CUBE).base_joints) == 6
    message = refused(CUBE.replace(old, new, 1))
    for part in parts:
        assert part in message


# ---- inertias that are odd but usable --------------------------------------------------------------------------------


def test_a_leg_inertia_no_rigid_body_has_is_a_warning():
    lower = "inertia = [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2]]\n[legs.upper]"
    for bad, words in (
        ("[[-0.1, 0, 0], [0, 0.2, 0], [0, 0, 0.2]]", "below zero"),
        ("[[0.1, 0, 0], [0, 0.2, 0], [0, 0, 0.5]]", "exceeds the sum of the other two"),
    ):
        (warning,) = Hexapod.from_toml(GOOD.replace(lower, f"inertia = {bad}\n[legs.upper]")).warnings
        assert warning.startswith("legs.lower.inertia (all legs): no rigid body has it")
        assert words in warning
    hexapod = Hexapod.from_toml(GOOD).replace({"legs.upper.inertia[4][0][0]": -0.1})
    assert hexapod.warnings[0].startswith("legs.upper.inertia (legs 5): no rigid body has it")


def test_a_platform_inertia_that_breaks_the_triangle_inequality_is_a_warning():
    (warning,) = Hexapod.from_toml(GOOD.replace(INERTIA, "inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 3]]")).warnings
    assert warning.startswith("platform.inertia: no rigid body has it")
    assert "exceeds the sum" in warning


def test_thin_rods_and_discs_are_no_cause_for_warning():
    text = GOOD.replace(INERTIA, "inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 2]]")
    assert Hexapod.from_toml(text).replace({"legs.lower": None, "legs.upper": None}).warnings == ()


# ---- files -----------------------------------------------------------------------------------------------------------


def refused_file(path) -> str:
    with pytest.raises(DesignError) as caught:
        load(path)
    return str(caught.value)


def test_a_file_that_is_not_toml_gives_the_line(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text("name = 'a'\n[base\njoints = 3\n")
    message = refused_file(path)
    for part in ("bad.toml", "not TOML", "line 2", "flexapod new"):
        assert part in message


@pytest.mark.parametrize("text", ["", "\n# only a comment\n"])
def test_an_empty_file(tmp_path, text):
    path = tmp_path / "empty.toml"
    path.write_text(text)
    message = refused_file(path)
    for part in ("empty.toml", "is empty", "[base], [platform] and [legs]", "flexapod new"):
        assert part in message


@pytest.mark.parametrize("content", [b"\x89PNG\r\n\x1a\n\x00", b"name = 1" + b"0" * 5000, b"a = " + b"[" * 5000])
def test_files_that_are_something_else(tmp_path, content):
    path = tmp_path / "picture.toml"
    path.write_bytes(content)
    message = refused_file(path)
    assert "picture.toml" in message
    assert "TOML" in message


def test_errors_in_a_file_name_the_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(GOOD.replace("mass = 10.0", "mass = -10.0"))
    assert "mine.toml: platform.mass is -10 kg" in refused_file(path)
    path.write_text(GOOD.replace("[1, -1, 0]", "[0, 0, 0]"))
    assert "mine.toml: base.universal_axes[2]" in refused_file(path)


def test_a_missing_file_lists_the_packaged_designs(tmp_path):
    message = refused_file("mukherje-ii")
    for part in (
        "'mukherje-ii' is neither a file nor a packaged design",
        "Did you mean 'mukherjee-ii'?",
        "cubic-isolator",
    ):
        assert part in message
    message = refused_file(tmp_path / "nowhere.toml")
    assert "nowhere.toml' is neither a file nor a packaged design" in message
    assert "motion-base" in message
    assert "neither a file" in refused_file("x" * 5000)


def test_a_directory(tmp_path):
    message = refused_file(tmp_path)
    assert str(tmp_path) in message
    assert "is a directory; a design is a .toml file" in message


# ---- changes ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"platform.mas": 3}, ["platform.mas is not a key", "Did you mean platform.mass"]),
        ({"platfrom.mass": 3}, ["platfrom is not a key", "Did you mean platform?"]),
        ({"legs.lowr.mass[2]": 3}, ["legs.lowr is not a key", "legs.lower"]),
        ({"mass": 3}, ["mass is not a key", "platform.mass"]),
        ({"platform.mass_mm": 3}, ["platform.mass_mm", "no unit of mass", "mass_kg"]),
        ({"platform.mass": 3, "platform.mass_g": 3000}, ["both give platform.mass"]),
        ({"platform.mass": -3}, ["platform.mass is -3 kg", "> 0"]),
        ({"platform.mass": True}, ["platform.mass is True (bool)"]),
        ({"platform.mass": "heavy"}, ["platform.mass is 'heavy'", "TOML value"]),
        ({"platform.mass": "3\nname = 'sneaked in'"}, ["TOML value"]),
        ({"platform.mass": float("nan")}, ["platform.mass is nan kg", "finite"]),
        ({"platform.mass": 1j}, ["platform.mass", "complex", "one number"]),
        ({"platform.mass": np.array([True])}, ["platform.mass", "one number"]),
        ({"platform": 3}, ["platform is 3", "must be a table"]),
        ({"base.joints": np.zeros((5, 3))}, ["base.joints has shape 5 x 3", "six rows"]),
        ({"legs.stiffness[6]": 1e7}, ["legs.stiffness[6] is outside legs.stiffness", "6", "count from 0"]),
        ({"legs.stiffness[0][0]": 1e7}, ["outside legs.stiffness"]),
        ({"legs.stiffness[-1]": 1e7}, ["'legs.stiffness[-1]' is no key", "legs.stiffness[2]"]),
        ({"legs.stiffness[2]_N_per_um": 1e7}, ["is no key", "legs.stiffness[2]"]),
        ({"legs.stiffness[2]": -1.0}, ["legs.stiffness[2] is -1 N/m", "> 0", "in series"]),
        ({"legs.stiffness_N_per_um[2]": "-1"}, ["legs.stiffness_N_per_um[2] is -1 N/um"]),
        ({"base.joints[2]": [1, 2]}, ["base.joints[2] has shape 2", "three numbers"]),
        ({"platform.mass[0]": 3}, ["platform.mass[0] is outside platform.mass", "one number"]),
        ({"name[0]": "x"}, ["name"]),
        ({"limits.leg_distance[0]": 3}, ["limits.leg_distance is not a list in this design"]),
        ({"platform.inertia[0][1]": 0.1}, ["platform.inertia is not symmetric"]),
        (
            {"base.circle.radius": 0.3},
            ["base.circle.radius is set, but this design has no [base.circle]", "half_angle"],
        ),
        ({"base.joints": None}, ["missing: base.joints"]),
        ({"platfrom": None}, ["platfrom is not a key"]),
        ({3: 4}, ["3 is no key", "text"]),
    ],
)
def test_bad_change(changes, parts):
    hexapod = Hexapod.from_toml(GOOD)
    with pytest.raises(DesignError) as caught:
        hexapod.replace(changes)
    for part in parts:
        assert part in str(caught.value)


scalars = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
anything = st.recursive(
    scalars, lambda inner: st.lists(inner, max_size=6) | st.dictionaries(st.text(), inner), max_leaves=9
)
shaped = st.sampled_from([(), (3,), (6,), (3, 3), (6, 3)]).flatmap(
    lambda shape: st.floats().map(lambda number: np.full(shape, number).tolist())
)


@given(st.sampled_from([*KEYS, *TABLES, *TEXT_KEYS]), anything | shaped)
@settings(max_examples=120, deadline=None)
def test_whatever_is_given_it_is_a_design_or_a_design_error(key, value):
    hexapod = Hexapod.from_toml(GOOD)
    try:
        changed = hexapod.replace({key: value})
    except DesignError as error:
        assert str(error).rstrip().endswith((".", "?"))  # noqa: PT017
    else:
        assert Hexapod.from_toml(changed.to_toml()) == changed


@pytest.mark.parametrize("text", ["platform.mass", "platform.mass=", "=3", ""])
def test_bad_assignment(text):
    with pytest.raises(DesignError, match=r"KEY=VALUE, such as platform\.mass=400"):
        parse_assignments([text])


def test_an_assignment_given_twice():
    with pytest.raises(DesignError, match=r"platform\.mass is set twice"):
        parse_assignments(["platform.mass=3", "platform.mass=4"])


# ---- designs made in Python ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "parts"),
    [
        (lambda: Legs(-1.0), ["legs.stiffness is -1 N/m", "> 0"]),
        (lambda: Legs([1, 2, 3]), ["legs.stiffness has shape 3"]),
        (lambda: Damping(universal=[0, 0, 0, 0, 0, -1]), ["legs.damping.universal[5] is -1 N m s/rad", ">= 0"]),
        (lambda: LegPart(1.0, [0, 0, 0], [[1, 2, 0], [0, 1, 0], [0, 0, 1]]), ["inertia is not symmetric"]),
        (lambda: LegPart(float("inf"), [0, 0, 0], np.eye(3)), ["mass is inf kg", "finite"]),
        (lambda: Limits(leg_length=[1, 1]), ["limits.leg_length is [1, 1] m"]),
        (lambda: Limits(universal_angle=45), ["limits.universal_angle is 45 rad", "_deg"]),
        (lambda: Home([0, 0]), ["home.position has shape 2"]),
    ],
)
def test_parts_check_themselves(make, parts):
    with pytest.raises(DesignError) as caught:
        make()
    for part in parts:
        assert part in str(caught.value)


@pytest.mark.parametrize(
    ("field", "value", "parts"),
    [
        ("name", 5, ["name is 5", "text"]),
        ("gravity", [0, 0], ["gravity has shape 2", "three numbers"]),
        ("platform_mass", 0, ["platform.mass is 0 kg", "> 0"]),
        ("base_joints", np.zeros((6, 3)), ["base.joints[0] to base.joints[5] coincide"]),
        ("platform_inertia", -np.eye(3), ["platform.inertia is not positive definite"]),
        ("universal_axes", np.zeros((6, 3)), ["base.universal_axes[0]"]),
        ("legs", 3, ["legs is 3", "must be a Legs"]),
        ("limits", None, ["limits is None", "must be a Limits"]),
        ("home", (0, 0, 1), ["home is (0, 0, 1)", "must be a Pose"]),
    ],
)
def test_a_hexapod_checks_itself(field, value, parts):
    good = Hexapod.from_toml(GOOD)
    names = ("name", "gravity", "base_joints", "universal_axes", "platform_joints", "platform_mass")
    names += ("platform_mass_center", "platform_inertia", "legs", "limits", "home")
    with pytest.raises(DesignError) as caught:
        Hexapod(**{name: getattr(good, name) for name in names} | {field: value})
    for part in parts:
        assert part in str(caught.value)


def test_a_key_of_another_table_is_named_with_its_unit():
    with pytest.raises(DesignError, match=r"Did you mean base\.circle\.radius_mm"):
        Hexapod.from_toml("[base]\nradius_mm = 220\n[platform]\n[legs]\n")


def test_two_moments_are_not_enough():
    text = GOOD.replace("inertia = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]", "inertia = [0.2, 0.4]", 1)
    with pytest.raises(DesignError, match=r"platform\.inertia .*three rows of three numbers.*principal moments"):
        Hexapod.from_toml(text)
