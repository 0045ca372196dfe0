"""Every name in the tables of docs/notation.md is one of the library's, with the shape that stands beside it."""

import inspect
import re
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from tests.helpers.public import PUBLIC

import flexapod as fx
from flexapod.design.schema import KEYS

PAGE = Path(__file__).parents[2] / "docs" / "notation.md"
BATCH = (2,)
OF_POSES = (
    *("inverse_kinematics", "leg_rates", "force_transformation", "condition_number", "joint_angles", "leg_distance"),
    *(
        "equations_of_motion",
        "joint_reactions",
        "energy",
        "hold",
        "natural_modes",
        "stability_index",
        "energy_shares",
        "joint_moments",
    ),
)


class Row(NamedTuple):
    name: str
    shape: str
    keys: tuple[str, ...]


def rows() -> list[Row]:
    """One for each name in backquotes in the second column; (keys) of the design file stand in brackets after it."""
    found = []
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if not line.startswith("| ") or line.startswith("| symbol"):
            continue
        _, cell, _, shape = (part.strip() for part in line.strip("|").split("|"))
        brackets = re.findall(r"\((`[^)]*)\)", cell)
        keys = tuple(re.findall(r"`([^`]+)`", " ".join(brackets)))
        outside = re.sub(r"\(`[^)]*\)|\[[^]]*\]\([^)]*\)", "", cell)
        names, shapes = re.findall(r"`([^`]+)`", outside), shape.split("; ")
        shapes = shapes if len(shapes) == len(names) else [shape] * len(names)
        found += [Row(name, of, keys) for name, of in zip(names, shapes, strict=True)]
    return found


ROWS = rows()


@cache
def samples() -> dict[str, object]:
    """What public functions return for a small machine, and instances of public types."""
    h = fx.load("cubic-isolator").replace(
        {"limits.leg_length": [0.1, 0.2], "limits.universal_angle": 0.5, "limits.spherical_angle": 0.5,
         "limits.leg_distance": 0.01, "limits.universal_moment": 1.0, "limits.spherical_moment": 1.0,
         "legs.series_stiffness": [1e6, 2e6], "legs.joint_stiffness.universal": 0.1, "suspension.stiffness": [1e2] * 6}
    )  # fmt: skip
    home, law = fx.home_pose(h), fx.control.VelocityFeedback(100.0)
    two = fx.Pose(np.tile(home.position, (2, 1)))
    omega, tangent = [5.0, 20.0], fx.linearise(h, home)
    box = fx.Box.about(home, 0.005, 0.02)
    batch = {name: PUBLIC[name](h, two) for name in OF_POSES}
    returned = batch | {
        "linearise": tangent,
        "frequency_sensitivity": fx.frequency_sensitivity(h, home),
        "transmissibility": fx.transmissibility(h, home, omega=omega),
        "random_response": fx.random_response(h, home, psd=[1.0, 1.0], omega=omega, axis="z"),
        "stepped_sine": fx.stepped_sine(h, home, omega=omega, amplitude=1e-6, axis="z"),
        "controlled_transmissibility": fx.control.controlled_transmissibility(h, home, controller=law, omega=omega),
        "simulate": fx.simulate(h, home, duration=0.01, samples=5),
        "sweep": fx.sweep(h, two),
        "worst_pose": fx.worst_pose(h, box, samples=64, starts=2),
        "closed_loop": fx.control.closed_loop(h, home, law, nearness=0.0),
        "sampling_time": fx.control.sampling_time(h, home),
    }
    parts = (h.legs.damping, h.legs.lower, h.legs.joint_stiffness, h.suspension)
    instances = (h, h.legs, *parts, h.limits, two, fx.Motion(two), tangent.modes())
    return {f"{name}()": value for name, value in returned.items()} | {
        type(value).__name__: value for value in (*instances, tangent.state_space())
    }


def same_shape(written: str, shape: tuple[int, ...]) -> bool:
    if " or " in written:
        return any(same_shape(part, shape) for part in written.split(" or "))
    if written == "number":
        return shape == ()
    sizes = [part.strip() for part in written.strip("()").split(",") if part.strip()]
    if sizes[:1] == ["..."]:
        sizes = [*map(str, BATCH), *sizes[1:]]
    return len(sizes) == len(shape) and all(w.isalpha() or int(w) == n for w, n in zip(sizes, shape, strict=True))


def test_the_page_has_its_tables():
    assert len(ROWS) > 90


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_name_is_one_of_the_library_and_has_its_shape(row):
    argument = re.fullmatch(r"(\w+)\((\w+)=\)", row.name)
    if argument:
        assert argument[2] in inspect.signature(PUBLIC[argument[1]]).parameters
        return
    head, _, attribute = row.name.partition(".")
    public = PUBLIC[head.removesuffix("()")]
    assert head.endswith("()") == inspect.isfunction(public)
    if head not in samples():  # made by a longer computation: its type tells what it has
        assert attribute in {*dir(public), *getattr(public, "__dataclass_fields__", ())}
        assert not row.shape
        return
    value = samples()[head]
    shape = np.shape(getattr(value, attribute) if attribute else value)
    assert same_shape(row.shape, shape) if row.shape else attribute, f"{row.name} has the shape {shape}"


@pytest.mark.parametrize("row", [row for row in ROWS if row.keys], ids=lambda row: row.name)
def test_keys_are_those_of_a_design_file(row):
    assert set(row.keys) <= set(KEYS)


def test_a_wrong_shape_is_seen():
    assert same_shape("(..., 6)", (2, 6))
    assert not same_shape("(..., 6)", (6,))
    assert not same_shape("(6, 3)", (3, 6))
    assert same_shape("(n, 6)", (9, 6))
    assert not same_shape("number", (1,))
