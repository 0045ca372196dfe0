"""Named points of a design: read, written, changed, told apart, and refused."""

import json
import pickle

import numpy as np
import pytest

import flexapod as fx
from flexapod.mechanics.inputs import as_point

TEXT = fx.load("motion-base").to_toml() + "\n[points]\nvertex_mm = [0, 0, -150]\neye = [0.2, 0, 1.1]\n"


def test_points_are_read_in_their_units_and_written_bit_for_bit():
    machine = fx.Hexapod.from_toml(TEXT)
    assert {name: place.tolist() for name, place in machine.points.items()} == {
        "eye": [0.2, 0.0, 1.1],
        "vertex": [0.0, 0.0, -0.15],
    }
    again = fx.Hexapod.from_toml(machine.to_toml())
    assert again == machine
    assert again.digest == machine.digest
    assert again.points["vertex"].tobytes() == machine.points["vertex"].tobytes()
    assert pickle.loads(pickle.dumps(machine)) == machine


def test_points_are_numbers_of_the_design():
    machine = fx.load("motion-base")
    pointed = machine.replace({"points": {"eye": [0.2, 0, 1.1]}})
    assert pointed != machine
    assert pointed.digest != machine.digest
    assert len({machine.digest, pointed.digest, pointed.replace({"points.eye[2]": 1.2}).digest}) == 3
    assert fx.Hexapod.from_toml(TEXT).replace({"points.vertex": None}) == pointed
    assert pointed.replace({"points": None}) == machine
    assert pointed.replace({"points": None}).digest == machine.digest
    assert hash(pointed) == hash(fx.Hexapod.from_toml(pointed.to_toml()))


def test_changes_of_points():
    machine = fx.Hexapod.from_toml(TEXT).replace({"points.vertex_cm[2]": -20, "points.top_in": [0, 0, 1]})
    assert machine.points["vertex"].tolist() == [0.0, 0.0, -0.2]
    assert machine.points["top"].tolist() == [0.0, 0.0, 0.0254]
    assert list(machine.points) == ["eye", "top", "vertex"]


def test_points_do_not_change():
    points = fx.Hexapod.from_toml(TEXT).points
    with pytest.raises(ValueError, match="read-only"):
        points["eye"][0] = 1.0
    with pytest.raises(TypeError):
        points["eye"] = [0, 0, 0]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("vertex = [0, 0]", "points.vertex has shape 2; it must be three numbers"),
        ("vertex = 1", "points.vertex has one number; it must be three numbers"),
        ("vertex = [0, 0, nan]", r"points.vertex\[2\] is nan m; it must be a finite number"),
        ('vertex = "top"', "points.vertex is 'top'"),
        ("vertex_deg = [0, 0, 1]", "'deg' is no unit of length; points.vertex is a length"),
        ("vertex_kg = [0, 0, 1]", "'kg' is no unit of length"),
        ("1st = [0, 0, 1]", "the name of a point is a letter followed by"),
        ('"the top" = [0, 0, 1]', "'the top'; the name of a point is"),
        ("_mm = [0, 0, 1]", "the name of a point is"),
        ("vertex_mm_mm = [0, 0, 1]", "points.vertex_mm ends in 'mm', which a file reads as a unit"),
        ("vertex = [0, 0, 1]\nvertex_mm = [0, 0, 1]", "both give points.vertex"),
        ("a.b = [0, 0, 1]", r"points.a is \{'b': \[0, 0, 1\]\}"),
        (f"{'a' * 41} = [0, 0, 1]", "at most 40 in all"),
    ],
)
def test_what_is_no_point_is_refused(given, words):
    text = fx.load("motion-base").to_toml() + "\n[points]\n" + given
    with pytest.raises(fx.DesignError, match=words):
        fx.Hexapod.from_toml(text)


@pytest.mark.parametrize(("given", "words"), [(3, "it must be a mapping"), ({3: [0, 0, 1]}, "points has the name 3")])
def test_points_of_the_wrong_kind_are_refused(given, words):
    machine = fx.load("motion-base")
    parts = {name: getattr(machine, name) for name in ("base_joints", "platform_joints", "platform_mass", "legs")}
    parts |= {name: getattr(machine, name) for name in ("platform_mass_center", "platform_inertia")}
    with pytest.raises(fx.DesignError, match=words):
        fx.Hexapod(**parts, points=given)


def test_a_point_is_found_by_name_or_place():
    machine = fx.Hexapod.from_toml(TEXT)
    np.testing.assert_array_equal(as_point(machine, "eye"), [0.2, 0, 1.1])
    np.testing.assert_array_equal(as_point(machine, (1, 2, 3)), [1.0, 2.0, 3.0])
    with pytest.raises(fx.ArgumentError, match=r"point is 'vertx', .* it has eye, vertex\. Did you mean 'vertex'"):
        as_point(machine, "vertx")
    with pytest.raises(fx.ArgumentError, match="'motion-base', which names none"):
        as_point(fx.load("motion-base"), "vertex")
    with pytest.raises(fx.ArgumentError, match="must have shape"):
        as_point(machine, [1.0, 2.0])


def test_points_are_checked_and_no_variables_of_a_search(run, tmp_path):
    path = tmp_path / "pointed.toml"
    path.write_text(TEXT)
    code, out, _ = run("check", path)
    assert code == 0
    assert "points.vertex" in out
    code, out, _ = run("check", path, "--json", "--set", "points.eye=[1,2,3]")
    assert json.loads(out)["values"]["points.eye"] == [1, 2, 3]
    with pytest.raises(fx.ArgumentError, match=r"points.vertex\[2\] is not a number that a search can change"):
        fx.optimisation.Variable("points.vertex[2]", -1.0, 1.0).parts(fx.Hexapod.from_toml(TEXT))
