"""Numbers of short forms as variables of a search and as uncertain numbers."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.design.design_file import template
from flexapod.errors import ArgumentError
from flexapod.optimisation.design_map import DesignMap
from flexapod.optimisation.ensemble import Ensemble

BASE, CUBE = plain_machine("motion-base"), plain_machine("cubic-isolator")
OWN = fx.Hexapod.from_toml(template("own"))
CASES = {
    "cube": (
        CUBE,
        {"cubic.edge_mm": (150, 250), "cubic.middle": (0.4, 0.8), "legs.lower.rod.mass_g": (200, 400)},
        {"cubic.edge_mm": 210, "cubic.middle": 0.5, "legs.lower.rod.mass_g": 350},
    ),
    "circles": (
        BASE,
        {
            "base.circle.radius": (1, 2),
            "base.circle.angles_deg[1]": (60, 80),
            "platform.circle.height_mm": (-100, 100),
            "legs.upper.rod.length": (1.5, 2),
            "legs.upper.rod.radius_mm[2]": (20, 60),
        },
        {
            "base.circle.radius": 1.7,
            "base.circle.angles_deg[1]": 72,
            "platform.circle.height_mm": 30,
            "legs.upper.rod.length": 1.8,
            "legs.upper.rod.radius_mm[2]": 35,
        },
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_a_variable_of_a_short_form_is_what_replace_makes(case):
    hexapod, bounds, values = CASES[case]
    search = DesignMap(hexapod, [fx.Variable(key, *both) for key, both in bounds.items()])
    for key, at in search.values(search.own()).items():
        assert hexapod.replace({key: at}).packed == pytest.approx(hexapod.packed, rel=1e-14, abs=1e-15)
    x = search.from_values(values)
    found, expected = search.hexapod_at(x), hexapod.replace(values)
    np.testing.assert_allclose(found.packed, expected.packed, rtol=1e-14, atol=1e-15)
    np.testing.assert_allclose(found.home.position, expected.home.position, rtol=1e-14, atol=1e-15)
    tables = {form.table: sorted(form.given) for form in found.short_forms}
    assert tables == {form.table: sorted(form.given) for form in expected.short_forms}
    assert fx.Hexapod.from_toml(found.to_toml()) == found
    step = 1e-6 * np.eye(len(x))
    differences = [(search.numbers(x + h) - search.numbers(x - h)) / 2e-6 for h in step]
    np.testing.assert_allclose(search.jacobian(x), np.stack(differences, axis=1), atol=1e-6)


def test_a_circle_that_is_not_of_pairs_keeps_its_angles_in_a_search():
    uneven = OWN.replace({"base.circle.angles_deg": [50, 70, 170, 190, 290, 330]})
    search = DesignMap(uneven, [fx.optimisation.JointCircle("base", radius=(0.4, 0.6))])
    found = search.hexapod_at(np.array([0.55]))
    np.testing.assert_allclose(
        found.packed, uneven.replace({"base.circle.radius": 0.55}).packed, rtol=1e-14, atol=1e-15
    )
    scaled = DesignMap(uneven, [fx.Variable("base.circle.radius", 0.8, 1.2, kind="scale")])
    np.testing.assert_allclose(
        scaled.hexapod_at(np.array([1.1])).base_joints, found.base_joints, rtol=1e-14, atol=1e-16
    )


@pytest.mark.parametrize(
    ("hexapod", "targets", "words"),
    [
        (
            fx.load("mukherjee-ii"),
            ["cubic.edge"],
            r"has no \[cubic\]; it gives base.joints and platform.joints as they",
        ),
        (fx.load("mukherjee-ii"), ["base.circle.radius"], r'Use JointCircle\("base"'),
        (CUBE, ["cubic.height"], "does not give height"),
        (CUBE, ["cubic.edge", "base.joints[0][0]"], r"base.joints\[0\]\[0\] and \[cubic\] both set base.joints"),
        (BASE, ["legs.upper.rod.mass", "legs.upper.mass"], r"and \[legs.upper.rod\] both set legs.upper.mass"),
    ],
)
def test_variables_that_the_design_does_not_have(hexapod, targets, words):
    with pytest.raises(ArgumentError, match=words):
        DesignMap(hexapod, [fx.Variable(key, 0.1, 0.2) for key in targets])


def test_uncertain_numbers_of_short_forms():
    uncertain = [
        fx.Uncertain("platform.circle.radius_mm", 5, relative=False),
        fx.Uncertain("base.circle.angles_deg[0]", 0.5, relative=False),
        fx.Uncertain("legs.upper.rod.mass", 0.1),
        fx.Uncertain("platform.mass", 0.2),
    ]
    ensemble = Ensemble(BASE, uncertain)
    u = np.random.default_rng(0).uniform(0, 1, (5, len(ensemble.names)))
    designs = ensemble.designs(u)
    for row, share in zip(designs, 2 * u - 1, strict=True):
        angles = np.degrees(BASE.short_forms[0].given["angles"])
        changes = {
            "platform.circle.radius_mm": 1600 + 5 * share[0],
            "base.circle.angles_deg[0]": angles[0] + 0.5 * share[1],
            "legs.upper.rod.mass": 40 * (1 + 0.1 * share[2:8]),
            "platform.mass": 4000 * (1 + 0.2 * share[8]),
        }
        np.testing.assert_allclose(row, BASE.replace(changes).packed, rtol=1e-13, atol=1e-15)
    with pytest.raises(ArgumentError, match="both uncertain"):
        Ensemble(BASE, [*uncertain, fx.Uncertain("legs.upper.mass", 0.1)])
    with pytest.raises(ArgumentError, match=r"has no \[cubic\]"):
        Ensemble(BASE, [fx.Uncertain("cubic.edge", 0.1)])


def test_commands_take_the_keys_of_the_file(run, result, tmp_path):
    file = tmp_path / "own.toml"
    OWN.save(file)
    found = result(
        "robust", file, "--uncertain", "platform.circle.radius_mm=1", "--uncertain", "legs.upper.rod.mass=10%,together",
        "--samples", 64, "--sensitivity", 0,
    )  # fmt: skip
    assert set(found["worst_at"]) == {"platform.circle.radius_mm", "legs.upper.rod.mass"}
    assert abs(found["worst_at"]["platform.circle.radius_mm"] - 300) <= 1.0001
    out = tmp_path / "out"
    code, _, _ = run(
        "optimise", file, "--vary", "platform.circle.radius_mm=250:320", "--vary", "legs.upper.rod.mass=0.8:1.2",
        "--trials", 3, "--points", 32, "--verify", 64, "--out", out,
    )  # fmt: skip
    assert code == 0
    (design,) = out.glob("*.toml")
    better = plain_machine(design)
    assert {form.table for form in better.short_forms} == {form.table for form in OWN.short_forms}
    assert "[platform.circle]" in design.read_text()
    assert fx.stability_index(better) > fx.stability_index(OWN)


def test_bounds_are_told_with_enough_digits():
    search = DesignMap(OWN, [fx.Variable("platform.mass", 50, 70)])
    with pytest.raises(ArgumentError, match=r"platform.mass = 70.00000001, outside its bounds 50 to 70"):
        search.from_values({"platform.mass": 70 + 1e-8})
    with pytest.raises(ArgumentError, match=r"may go up to 1.0000001, but .* must be <= 1 "):
        DesignMap(CUBE, [fx.Variable("cubic.middle", 0.4, 1 + 1e-7)])
