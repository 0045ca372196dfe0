"""What a report says first and last: headline, verdict, and inputs from which the machine can be made again."""

import re

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod import plots
from flexapod.report import gather, page
from flexapod.report.studies import inputs
from flexapod.report.studies.machine import study

AXES = ("x", "y", "z")


def _table(section, title):
    (found,) = [table for table in section.items if table.title.startswith(title)]
    return {column.title: list(column.values) for column in found.columns}


def _floats(table, *names):
    return np.array([[float(value) for value in table[name]] for name in names]).T


def _again(h):
    """The machine of the tables that a page lists."""
    section = inputs.section(h)
    joints, legs, bodies = (_table(section, title) for title in ("Joints", "Legs", "Bodies"))
    values = {
        "name": h.name,
        "base.joints": _floats(joints, *(f"base {a}" for a in AXES)) / 1e3,
        "platform.joints": _floats(joints, *(f"platform {a}" for a in AXES)) / 1e3,
        "base.universal_axes": _floats(joints, *(f"axis {a}" for a in AXES)),
        "gravity": h.gravity,
    }
    for name in ("stiffness", "damping, prismatic", "damping, universal", "damping, spherical"):
        values["legs." + name.replace(", ", ".")] = np.broadcast_to(_floats(legs, name)[:, 0], 6)
    rows = {name: k for k, name in enumerate(bodies["body"])}
    mass, centre = _floats(bodies, "mass")[:, 0], _floats(bodies, *(f"centre {a}" for a in AXES)) / 1e3
    J = _floats(bodies, *(f"J {n}" for n in ("xx", "yy", "zz", "xy", "xz", "yz")))
    J = J[:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3)
    k = rows["platform with payload"]
    values |= {"platform.mass": mass[k], "platform.mass_center": centre[k], "platform.inertia": J[k]}
    for side in ("lower", "upper"):
        chosen = [rows.get(f"leg {leg}, {side} part", rows.get(f"leg 1 to 6, {side} part")) for leg in range(1, 7)]
        values |= {f"legs.{side}.{n}": v[chosen] for n, v in (("mass", mass), ("mass_center", centre), ("inertia", J))}
    return fx.Hexapod.from_values({key: np.asarray(value) if key != "name" else value for key, value in values.items()})


@pytest.mark.parametrize("name", fx.packaged_designs())
def test_the_machine_can_be_made_again_from_the_tables(name):
    h = plain_machine(name).replace(
        {"legs.stiffness[2]": 1.1 * plain_machine(name).legs.stiffness[2], "legs.lower.mass[0]": 3.0}
    )
    again, pose = _again(h), fx.home_pose(h)
    np.testing.assert_allclose(fx.natural_modes(again, pose).omega, fx.natural_modes(h, pose).omega, rtol=1e-6)
    np.testing.assert_allclose(fx.linearise(again, pose).M, fx.linearise(h, pose).M, rtol=1e-6, atol=1e-9)


def test_every_number_of_a_leg_is_listed():
    h = plain_machine("motion-base")
    columns = {column.title for table in inputs.section(h).items for column in table.columns}
    own = {key for key, value in h.values().items() if key.startswith("legs.") and np.shape(value) == (6,)}
    assert {key.removeprefix("legs.").replace(".", ", ") for key in own if not key.endswith("mass")} <= columns


def test_home_and_limits_are_listed_as_they_are():
    values = [
        table.columns[1].values
        for table in inputs.section(plain_machine("cubic-isolator")).items
        if table.style == "facts"
    ]
    ((gravity, home, limits),) = values
    assert gravity == "(0, 0, -9.81) m/s\u00b2"
    assert home == "x 0, y 0, z 0.0346410162 m; roll 0\u00b0, pitch 0\u00b0, yaw 0\u00b0"
    assert limits.startswith("length 115 to 125 mm; universal joint 5\u00b0")


def _rows(name, pose=None, **changes):
    h = plain_machine(name).replace(changes) if changes else plain_machine(name)
    found = gather(h, fx.home_pose(h) if pose is None else pose)
    return found, [row for row in study(found).rows if row.on in ("both", "page")]


def test_the_headline_is_what_the_warnings_say_to_rely_on():
    found, rows = _rows("cubic-isolator")
    assert rows[1].label == "Lowest frequency with weight and preload"
    assert rows[1].value == pytest.approx(28.2571, abs=1e-4)
    assert any(caution.code == "preload" for caution in found.cautions)
    assert rows[2].value == found.omega[0]


def test_the_index_comes_first_where_nothing_speaks_against_it():
    found, rows = _rows("mukherjee-ii")
    assert not any(caution.code in ("preload", "unstable") for caution in found.cautions)
    assert (rows[1].label, rows[1].value) == ("Dynamic stability index", found.omega[0])


def test_a_machine_that_falls_over_has_no_lowest_frequency():
    _, rows = _rows("cubic-isolator", **{"platform.mass": 200.0})
    assert (rows[1].value, rows[1].note) == ("none", "not stable at rest")


@pytest.mark.parametrize(
    ("name", "pose", "changes", "verdict"),
    [
        ("cubic-isolator", None, {}, "kept"),
        ("cubic-isolator", fx.Pose([0, 0, 0.05]), {}, "18 exceeded"),
        ("mukherjee-i", None, {}, "none set"),
    ],
)
def test_a_verdict_on_the_limits_stands_at_the_top(name, pose, changes, verdict):
    found, rows = _rows(name, pose, **changes)
    (row,) = [row for row in rows if row.label == "Limits at this pose"]
    assert row.value == verdict
    if verdict.endswith("exceeded"):
        assert int(verdict.split()[0]) == len(fx.check_limits(found.hexapod, found.pose).exceeded)


def test_mode_pictures_number_the_legs():
    h = plain_machine("cubic-isolator")
    ax = plots.mode(h, None, fx.natural_modes(h), 1)
    assert [text.get_text() for text in ax.texts] == list("123456")
    made = page(study(gather(h)))
    pictures = re.findall(r'<svg[^>]*aria-label="Mode \d">.*?</svg>|<svg.*?</svg>', made, re.DOTALL)
    numbered = [picture for picture in pictures if all(f">{leg}</text>" in picture for leg in range(1, 7))]
    assert len(numbered) >= 7  # the machine and six modes


@pytest.mark.parametrize(
    "omega",
    [
        [29.9, 29.9, 31.2, 31.2, 31.2, 50.6],  # within a factor of two
        [100.0] * 6,
        [1e-3, 1.0, 10.0, 100.0, 1e3, 1e6],
        [6.0, 7.0, 8.0, 9.0, 10.0, 7000.0],
    ],
)
def test_the_frequency_axis_has_ticks_and_holds_all_marks(omega):
    tangent = 0.5 * np.array(omega)
    ax = plots.frequencies(omega, tangent=tangent)
    low, high = ax.get_xlim()
    inside = [tick for tick in ax.get_xticks() if low <= tick <= high]
    assert 3 <= len(inside) <= 10
    assert ax.get_xlabel() == "natural frequency, Hz"
    assert low < tangent.min() / (2 * np.pi)
    assert high > max(omega) / (2 * np.pi)
    assert not any("," in label.get_text() for label in ax.get_xticklabels())


def test_limits_have_their_units_as_people_write_them():
    limited = plain_machine("motion-base").replace({"limits.leg_acceleration": 5, "limits.leg_rate": 0.5})
    words = inputs.limits(limited)
    assert "acceleration of legs 5 m/s\u00b2, of motions" in words
    assert "rate of legs 0.5 m/s, of motions" in words
