"""Short forms of a design stay its source: any of their keys can be changed, and files keep them."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.design.design_file import template

OWN = fx.Hexapod.from_toml(template("own"))
CUBE = plain_machine("cubic-isolator")
TABLES = {"own": OWN, "cube": CUBE, **{name: plain_machine(name) for name in ("motion-base", "precision-positioner")}}


def edited(text, old, new):
    """The design of a file after one of its lines was edited by hand."""
    assert text.count(old) == 1
    return fx.Hexapod.from_toml(text.replace(old, new))


@pytest.mark.parametrize(
    ("change", "old", "new"),
    [
        ({"platform.circle.radius_mm": 310}, "radius = 0.30", "radius_mm = 310"),
        ({"base.circle.height": 0.02}, "height = 0.0 ", "height = 0.02 "),
        ({"base.circle.angles_deg[1]": 72}, "[50.0, 70.0,", "[50.0, 72,"),
        ({"base.circle": {"radius_mm": 510}}, "radius = 0.50", "radius_mm = 510"),
        ({"legs.upper.rod.mass": 1.25}, "rod]\nmass = 1.0\n", "rod]\nmass = 1.25\n"),
        ({"legs.upper.rod.length_mm": "350.5"}, "length = 0.35", "length_mm = 350.5"),
        ({"legs.upper.rod.radius": None}, "radius_mm = 15.0 ", "# "),
        ({"legs.upper.rod.mass[3]": 2}, "rod]\nmass = 1.0\n", "rod]\nmass = [1, 1, 1, 2, 1, 1]\n"),
        ({"base.circle.radius": 0.52, "platform.circle.height_mm": 12, "platform.mass": 61}, None, None),
    ],
)
def test_a_change_is_what_editing_the_file_is(change, old, new):
    text = template("own")
    changed = OWN.replace(change)
    if old is None:
        text = text.replace("radius = 0.50", "radius = 0.52").replace("mass = 60.0 ", "mass = 61 ")
        old, new = "radius = 0.30", "radius = 0.30\nheight_mm = 12"
    assert changed == edited(text, old, new)
    assert [form.table for form in changed.short_forms] != []
    assert sorted(form.table for form in changed.short_forms) == sorted(form.table for form in OWN.short_forms)
    assert fx.Hexapod.from_toml(changed.to_toml()) == changed


def test_cubes_keep_their_form():
    bigger = CUBE.replace({"cubic.edge_mm": 220})
    assert bigger.home.position[2] == pytest.approx(0.22 * 0.6 / np.sqrt(12))
    np.testing.assert_allclose(bigger.base_joints, CUBE.base_joints * 1.1, atol=1e-15)
    assert bigger.replace({"cubic.edge_mm": 200}) == CUBE
    by_height = CUBE.replace({"cubic.height": 0.2 / np.sqrt(3)})  # in place of the edge
    np.testing.assert_allclose(by_height.base_joints, CUBE.base_joints, atol=1e-15)
    assert "height" in by_height.to_toml()
    assert "\nedge" not in by_height.to_toml()
    with pytest.raises(fx.DesignError, match=r"cubic\.edge and cubic\.height are both given"):
        CUBE.replace({"cubic.edge": 0.2, "cubic.height": 0.1})
    moved = CUBE.replace({"home.position": [0, 0, 0.07]}).replace({"cubic.edge": 0.3})
    assert moved.home.position.tolist() == [0, 0, 0.07]  # a home of one's own is not the cube's
    assert moved.short_forms[-1].table == "cubic" or moved.short_forms[0].table == "cubic"


def test_a_value_of_ones_own_ends_the_short_form_that_made_it():
    moved = OWN.replace({"base.joints[0][2]": 0.01})
    tables = [form.table for form in moved.short_forms]
    assert tables == ["platform.circle", "legs.upper.rod"]
    np.testing.assert_array_equal(moved.universal_axes, OWN.universal_axes)  # they stay
    with pytest.raises(fx.DesignError, match=r"no \[base.circle\]: it gives base.joints as they are"):
        moved.replace({"base.circle.radius": 0.6})
    whole = moved.replace({"base.circle.radius": 0.6, "base.circle.half_angle_deg": 10})
    assert np.hypot(*whole.base_joints.T[:2]) == pytest.approx(0.6)
    heavy = OWN.replace({"legs.upper.mass": 3})
    assert [form.table for form in heavy.short_forms] == ["base.circle", "platform.circle"]
    assert OWN.replace({"base.joints": OWN.base_joints}).short_forms == OWN.short_forms  # nothing changed
    with pytest.raises(fx.DesignError, match="both"):
        OWN.replace({"base.joints": OWN.base_joints, "base.circle.radius": 0.6})


def test_axes_of_ones_own_outlive_a_change_of_the_circle():
    axes = np.tile([1.0, 0, 0], (6, 1))
    own = OWN.replace({"base.universal_axes": axes})
    np.testing.assert_array_equal(own.replace({"base.circle.radius": 0.6}).universal_axes, axes)
    turned = OWN.replace({"base.circle.angles_deg": np.degrees(OWN.short_forms[0].given["angles"]) + 10})
    out = turned.base_joints / np.linalg.norm(turned.base_joints, axis=1)[:, None]
    np.testing.assert_allclose(turned.universal_axes, np.cross([0, 0, 1], out), atol=1e-15)  # default ones follow
    # Axes that are the default of another home pose are written, for they would not be found again.
    low = OWN.replace({"home.position": [0, 0, 0.01], "base.circle.radius": 0.6, "platform.circle.radius": 0.6})
    assert fx.Hexapod.from_toml(low.to_toml()) == low


@pytest.mark.parametrize("hexapod", TABLES.values(), ids=TABLES)
def test_files_pickles_and_copies_keep_short_forms(hexapod, tmp_path):
    tables = {form.table: sorted(form.given) for form in hexapod.short_forms}
    assert tables
    hexapod.save(tmp_path / "again.toml")
    others = [
        fx.load(tmp_path / "again.toml"),
        pickle.loads(pickle.dumps(hexapod)),
        copy.deepcopy(hexapod),
        dataclasses.replace(hexapod, name=hexapod.name),
        hexapod.replace({"platform.mass": 5}).replace({"platform.mass": hexapod.platform_mass}),
    ]
    for other in others:
        assert other == hexapod
        assert hash(other) == hash(hexapod)
        assert {form.table: sorted(form.given) for form in other.short_forms} == tables
        table = "cubic" if "cubic" in tables else "base.circle"
        key = f"{table}.{'edge' if table == 'cubic' else 'radius'}"
        assert other.replace({key: 0.7}) == hexapod.replace({key: 0.7}) != hexapod
    text = (tmp_path / "again.toml").read_text()
    assert "universal_axes" not in text
    for table in tables:
        assert f"[{table}]" in text


def test_fields_that_no_longer_fit_end_short_forms_too():
    other = dataclasses.replace(OWN, base_joints=OWN.base_joints * 1.1)
    assert "base.circle" not in [form.table for form in other.short_forms]
    assert fx.Hexapod.from_toml(other.to_toml()) == other


def test_half_angles():
    text = template("own").replace("angles_deg = [50.0, 70.0, 170.0, 190.0, 290.0, 310.0]", "half_angle_deg = 10")
    text = text.replace("angles_deg = [10.0, 110.0, 130.0, 230.0, 250.0, 350.0]", "half_angle_deg = 10")
    pairs = fx.Hexapod.from_toml(text)
    np.testing.assert_allclose(pairs.base_joints, OWN.base_joints, atol=1e-15)
    np.testing.assert_allclose(pairs.platform_joints, OWN.platform_joints, atol=1e-15)
    wide = pairs.replace({"base.circle.half_angle_deg": 15})
    np.testing.assert_allclose(
        OWN.replace({"base.circle.half_angle_deg": 15}).base_joints, wide.base_joints, atol=1e-15
    )
    assert "half_angle" in wide.to_toml()
    back = wide.replace({"base.circle.angles_deg": [50, 70, 170, 190, 290, 310]})
    np.testing.assert_allclose(back.base_joints, OWN.base_joints, atol=1e-15)
    with pytest.raises(
        fx.DesignError, match="pairs are at 60, 180 and 300 degrees; the joints of this design are else"
    ):
        plain_machine("precision-positioner").replace({"base.circle.half_angle": 0.2})


def test_a_circle_takes_the_place_of_a_cube_and_back():
    circles = {"base.circle.radius": 0.2, "base.circle.half_angle_deg": 12, "platform.circle.radius": 0.1}
    circles |= {"platform.circle.half_angle_deg": 12}
    on_circles = CUBE.replace(circles)
    assert {form.table for form in on_circles.short_forms} >= {"base.circle", "platform.circle"}
    assert "cubic" not in {form.table for form in on_circles.short_forms}
    np.testing.assert_array_equal(on_circles.home.position, CUBE.home.position)
    again = on_circles.replace({"cubic.edge": 0.2, "cubic.middle": 0.6, "cubic.center_in_platform": [0, 0, 0]})
    assert again == CUBE


def test_the_command_line_changes_short_forms(run, result, tmp_path):
    file = tmp_path / "own.toml"
    assert run("new", file)[0] == 0
    changes = ["platform.circle.radius_mm=310", "legs.upper.rod.mass=2", "base.circle.angles_deg[0]=51"]
    found = result("check", file, *(word for change in changes for word in ("--set", change)))
    expected = fx.load(file).replace(
        {"platform.circle.radius": 0.31, "legs.upper.rod.mass": 2, "base.circle.angles_deg[0]": 51}
    )
    assert found["digest"] == expected.digest != fx.load(file).digest
