"""Whole designs bent out of shape: what the reader gives back is a design or a DesignError, and never anything else.

`make fuzz` searches the same reader for minutes, guided by what its code does (tests/fuzz/designs.py).
"""

import copy
import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexapod.design import design_file
from flexapod.design.design_file import packaged_designs
from flexapod.design.hexapod import Hexapod
from flexapod.design.loading import load
from flexapod.design.schema import KEYS, TABLES
from flexapod.design.shorthands import expand
from flexapod.design.units import ALL_UNITS
from flexapod.errors import DesignError

TREES = [tomllib.loads(design_file.find(name).read_text(encoding="utf-8")) for name in packaged_designs()]
TREES.append(tomllib.loads(design_file.template("bent")))
SPRINGS = """
stiffness_N_per_um = 20.0
series_stiffness_N_per_um = [94.0, 94.0]
loss_factor = 0.02
joint_stiffness = {universal = [15.0, 20.0], spherical_N_mm_per_rad = 15e3, torsion = 10.0, loss_factor = 0.01}
joint_rest = {position = [0.0, 0.0, 0.5], orientation_deg = [1.0, 0.0, 0.0]}
"""
TABLE = 'stiffness_law = {kind = "table", lengths = [0.4, 0.6, 0.8], stiffnesses = [3e7, 2e7, 1e7]}'
OIL = """
stiffness_law = {kind = "hydraulic", bulk_modulus_GPa = 1.4, area_cm2 = 20, dead_1 = 0.1, dead_2 = 0.1, stroke = 0.5, shortest = 0.4}
"""
SUSPENSION = "[suspension]\nstiffness = [2e4, 2e4, 5e4, 100.0, 100.0, 200.0]\npoint_mm = [0, 0, 50]\n"
for legs in (SPRINGS, TABLE, OIL):
    text = design_file.template("sprung").replace("stiffness_N_per_um = 20.0", legs.strip(), 1)
    TREES.append(tomllib.loads(text + SUSPENSION))
NAMES = sorted({part for key in (*KEYS, *TABLES) for part in key.split(".")})
SHAPES = [(), (0,), (1,), (2,), (3,), (6,), (0, 3), (3, 3), (6, 0), (6, 2), (6, 3), (6, 6), (6, 3, 3), (2, 6, 3, 3)]
SHAPES.append((1,) * 9)

odd = [0, -1, 1, -0.0, 1e-320, 1e-9, 1e99, 1e101, 1e308, -1e308, float("nan"), float("inf"), 10**400, -(10**4000)]
numbers = st.sampled_from(odd) | st.floats() | st.integers()
scalars = numbers | st.booleans() | st.none() | st.text(max_size=6) | st.dates() | st.times()
filled = st.tuples(st.sampled_from(SHAPES), numbers).map(lambda of: np.full(*of, dtype=object).tolist())
nested = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=7) | st.dictionaries(st.sampled_from(NAMES) | st.text(), inner, max_size=3),
    max_leaves=12,
)
values = filled | nested
unit_names = st.sampled_from(sorted(ALL_UNITS)) | st.text(max_size=3)
keys = st.sampled_from(NAMES) | st.text(max_size=5) | st.builds("{}_{}".format, st.sampled_from(NAMES), unit_names)


def places(tree, path=()):
    """Every table, list and value of a tree, as a path to it."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [place for key, value in items for place in ((*path, key), *places(value, (*path, key)))]


@st.composite
def bent(draw):
    """A packaged design with a few things put in, taken out, doubled or replaced anywhere in it."""
    tree = copy.deepcopy(draw(st.sampled_from(TREES)))
    for _ in range(draw(st.integers(1, 3))):
        known = places(tree)
        if not known:
            break
        *path, last = draw(st.sampled_from(known))
        here = tree
        for key in path:
            here = here[key]
        change = draw(st.sampled_from(["replace", "replace", "take out", "put in", "nest"]))
        if change == "replace":
            here[last] = draw(values)
        elif change == "take out":
            del here[last]
        elif change == "nest":
            here[last] = [here[last]] * draw(st.integers(1, 2))
        elif isinstance(here, dict):
            here[draw(keys)] = draw(values)
        else:
            here.insert(last, draw(values))
    return tree


def message_of(make) -> str:
    """What a DesignError says, "" for a design that can be written and read again."""
    try:
        design = make()
    except DesignError as error:
        return str(error)
    assert Hexapod.from_toml(design.to_toml()) == design
    return ""


@given(bent())
@settings(max_examples=400)
def test_a_bent_design_is_a_design_or_a_design_error(tree):
    def built():
        values, forms = expand(design_file.flatten(tree))
        return Hexapod.from_values(design_file.complete(values), forms)

    message = message_of(built)
    assert message == "" or message.rstrip().endswith((".", "?"))


tables = st.sampled_from([*KEYS, *TABLES]) | st.builds(
    "{}[{}]".format, st.sampled_from(sorted(KEYS)), st.integers(0, 6)
)


@given(st.sampled_from(TREES), st.dictionaries(tables | keys, values, min_size=1, max_size=3))
@settings(max_examples=250)
def test_changes_together_give_a_design_or_a_design_error(tree, changes):
    values, forms = expand(design_file.flatten(tree))
    design = Hexapod.from_values(design_file.complete(values), forms)
    message_of(lambda: design.replace(changes))


@given(st.binary(max_size=60), st.integers(0, 2600), st.integers(0, 40))
@settings(max_examples=150)
def test_bytes_put_into_a_file(tmp_path_factory, put_in, place, left_out):
    whole = design_file.find("mukherjee-ii").read_bytes()
    path = tmp_path_factory.mktemp("bent") / "design.toml"
    path.write_bytes(whole[:place] + put_in + whole[place + left_out :])
    message_of(lambda: load(path))


# ---- what this and the longer search have found ----------------------------------------------------------------------


@pytest.mark.parametrize("depth", [7, 40, 200, 450])
def test_lists_nested_deeply(depth):
    message = message_of(lambda: Hexapod.from_toml(f"gravity = {'[' * depth}1{']' * depth}"))
    assert "gravity" in message
    assert "must be" in message
    assert len(message) < 300


@pytest.mark.parametrize("key", ["name", "gravity", "legs.stiffness"])
@pytest.mark.parametrize("depth", [20, 40])  # deeper ones are refused before they are read
def test_tables_nested_deeply(key, depth):
    message = message_of(lambda: Hexapod.from_toml(f"{key}{'.a' * depth} = 1"))
    assert message.startswith(f"{key} is {{'a': ")
    assert len(message) < 300


@pytest.mark.parametrize("value", ["{}", "[{}]", "{{a = {}}}"])
@pytest.mark.parametrize("key", ["name", "limits"])
def test_an_integer_too_long_to_print(key, value):
    message = message_of(lambda: Hexapod.from_toml(f"{key} = {value.format('0x' + 'f' * 5000)}"))
    assert "an integer of 20000 bits" in message or "limits.a is not a key" in message


@pytest.mark.parametrize(
    "changes",
    [
        {"platform": 3, "platform.mass": 4.0},
        {"platform": {"circle": 3}, "platform.circle": {"radius": 0.1}},
        {"base.circle": 3, "base.circle.radius": 0.1},
    ],
)
def test_a_table_and_a_value_in_its_place(changes):
    message = message_of(lambda: load("mukherjee-ii").replace(changes))
    assert "is 3; it must be a table" in message


@pytest.mark.parametrize(("radius", "words"), [("1e-320", "coincide"), ("1e-200", "coincide"), ("1e-150", "")])
def test_joints_too_close_together_for_squares_of_numbers(radius, words):
    text = design_file.find("precision-positioner").read_text(encoding="utf-8")
    assert "radius_mm = 175.5" in text
    message = message_of(lambda: Hexapod.from_toml(text.replace("radius_mm = 175.5", f"radius_mm = {radius}")))
    assert bool(words) == bool(message)
    assert words in message


def test_an_index_of_thousands_of_digits():
    assert "is no key" in message_of(lambda: load("mukherjee-ii").replace({f"legs.stiffness[{'1' * 5000}]": 1e7}))
