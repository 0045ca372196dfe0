"""Springs of a design other than constant ones along the legs: what a file says, what it is refused, where it goes."""

import re

import numpy as np
import pytest
from tests.helpers.plain import file, plain_machine

import flexapod as fx
from flexapod import _core
from flexapod.design import layout
from flexapod.design.design_file import template
from flexapod.design.layout import unit_name
from flexapod.design.packing import PLACES, compliance_slope
from flexapod.design.schema import KEYS
from flexapod.design.shorthands import SETS
from flexapod.optimisation.design_map import DesignMap
from flexapod.optimisation.ensemble import Ensemble

PLAIN = plain_machine("precision-positioner")
BASE = plain_machine("motion-base")
OIL = {
    "kind": "hydraulic",
    "bulk_modulus_GPa": 1.4,
    "area_1_cm2": 20,
    "area_2_cm2": 12,
    "dead_1_mm": 80,
    "dead_2": 0.1,
    "stroke": 1.8,
    "shortest": 1.5,
}
SCREW = {"kind": "screw", "fixed_N_per_um": 80, "axial_rigidity_kN": 4.2e4, "zero_length_mm": 200}
TABLE = {"kind": "table", "lengths_mm": [200, 260, 280, 300], "stiffnesses_N_per_um": [60, 50, 45, 43]}
SUSPENSION = np.diag([2e4, 2e4, 5e4, 100.0, 100.0, 200.0])


def with_law(hexapod, law, **changes):
    """The machine with a law, some of its keys changed, or taken out where None."""
    given = {key: value for key, value in {**law, **changes}.items() if value is not None}
    return hexapod.replace({"legs.stiffness_law": given})


def coupled():
    """A suspension with numbers beside its diagonal."""
    matrix = SUSPENSION.copy()
    matrix[0, 4] = matrix[4, 0] = 300.0
    return matrix


EVERY = with_law(PLAIN, SCREW).replace(
    {
        "legs.series_stiffness_N_per_um": [94, 200],
        "legs.loss_factor": [0.01, 0.02, 0.03, 0.04, 0.05, 0.06],
        "legs.joint_stiffness.universal": [15, 20],
        "legs.joint_stiffness.spherical_N_mm_per_rad": 15e3,
        "legs.joint_stiffness.torsion": [1, 2, 3, 4, 5, 6],
        "legs.joint_stiffness.loss_factor": 0.01,
        "legs.joint_rest.position_mm": [1, 2, 243],
        "legs.joint_rest.orientation_deg": [0.1, 0.2, 0.3],
        "limits.universal_moment_N_mm": 900,
        "limits.spherical_moment": 0.8,
        "suspension.stiffness": coupled(),
        "suspension.damping": [1, 1, 2, 0, 0, 0.1],
        "suspension.point_mm": [0, 0, 50],
    }
)


@pytest.mark.parametrize(
    "machine",
    [
        EVERY,
        PLAIN.replace({"legs.series_stiffness": 94e6}),
        PLAIN.replace({"legs.series_stiffness": [[9e7, 8e7]] * 5 + [[9e7, 7e7]]}),
        PLAIN.replace({"legs.loss_factor": 0.02}),
        PLAIN.replace({"legs.joint_stiffness.universal": [[1, 2]] * 5 + [[3, 4]]}),
        PLAIN.replace({"legs.joint_rest.position": [0, 0, 0.24]}),
        with_law(BASE, OIL),
        with_law(PLAIN, SCREW, zero_length_mm=[200, 210, 220, 230, 240, 250]),
        with_law(PLAIN, TABLE),
        PLAIN.replace({"suspension.stiffness": SUSPENSION}),
        PLAIN.replace({"suspension.damping": [1, 2, 3, 4, 5, 6]}),
        PLAIN.replace({"limits.universal_moment": 1}),
        PLAIN.replace({"limits.spherical_moment": 1}),
    ],
)
def test_a_machine_comes_back_from_its_file(machine):
    again = fx.Hexapod.from_toml(machine.to_toml())
    assert again == machine
    assert hash(again) == hash(machine)
    assert again.digest == machine.digest
    assert np.array_equal(again.packed, machine.packed)
    assert machine.digest not in {PLAIN.digest, BASE.digest}


def test_limits_of_the_two_moments_are_told_apart():
    one, other = (PLAIN.replace({f"limits.{joint}_moment": 1}) for joint in ("universal", "spherical"))
    assert one != other
    assert one.digest != other.digest


def test_digests_of_machines_without_such_springs_are_those_of_earlier_versions():
    digests = {name: plain_machine(name).digest for name in ("mukherjee-i", "mukherjee-ii")}
    assert digests == {"mukherjee-i": "465568b080e0be8f", "mukherjee-ii": "e3006217886c9d9f"}


def test_numbers_are_where_the_core_looks():
    n = {key: EVERY.packed[place] for key, place in PLACES.items()}
    np.testing.assert_allclose(n["legs.series_compliance"], 1 / 94e6 + 1 / 200e6, rtol=1e-15)
    np.testing.assert_array_equal(n["legs.joint_stiffness.universal"], [[15, 20]] * 6)
    np.testing.assert_array_equal(n["legs.joint_stiffness.spherical"], 15)
    np.testing.assert_array_equal(n["legs.joint_stiffness.torsion"], [1, 2, 3, 4, 5, 6])
    assert n["legs.stiffness_law.kind"] == _core.Law.screw.value
    np.testing.assert_array_equal(n["legs.stiffness_law.axial_rigidity"], 4.2e7)
    np.testing.assert_array_equal(n["legs.stiffness"], 1)
    np.testing.assert_array_equal(n["legs.joint_rest.position"], [0.001, 0.002, 0.243])
    np.testing.assert_allclose(n["legs.joint_rest.matrix"], EVERY.rest.matrix, atol=1e-16)
    np.testing.assert_array_equal(n["suspension.stiffness"], coupled())
    np.testing.assert_array_equal(n["suspension.point"], [0, 0, 0.05])
    assert np.isnan(EVERY.legs.stiffness).all()
    table = with_law(PLAIN, TABLE).packed
    assert table[PLACES["legs.stiffness_law.count"]] == 4
    np.testing.assert_array_equal(table[PLACES["legs.stiffness_law.lengths"]], [0.2, 0.26, 0.28, *[0.3] * 21])
    np.testing.assert_array_equal(table[PLACES["legs.stiffness_law.stiffnesses"]][2:], [45e6, *[43e6] * 21])


def test_rest_is_home_where_nothing_else_is_said():
    assert PLAIN.rest is PLAIN.home
    assert not PLAIN.sprung
    moved = PLAIN.replace({"legs.joint_stiffness.torsion": 1, "home.position[0]": 0.01})
    assert moved.sprung
    np.testing.assert_array_equal(moved.packed[PLACES["legs.joint_rest.position"]], moved.home.position)
    np.testing.assert_array_equal(EVERY.rest.position, [0.001, 0.002, 0.243])


@pytest.mark.parametrize("given", [15.0, [15.0, 15.0], [15.0] * 6, [[15.0, 15.0]] * 6])
def test_a_base_joint_takes_one_a_pair_six_or_six_pairs(given):
    found = PLAIN.replace({"legs.joint_stiffness.universal": given})
    assert found == PLAIN.replace({"legs.joint_stiffness.universal": 15})
    assert found.legs.joint_stiffness == fx.design.JointStiffness(universal=given)


@pytest.mark.parametrize("given", [9e7, [9e7], [[9e7]] * 6])
def test_one_spring_in_series(given):
    found = PLAIN.replace({"legs.series_stiffness": given}).legs
    assert found.series_stiffness.shape == (6, 1)
    assert found == fx.design.Legs(
        PLAIN.legs.stiffness, PLAIN.legs.damping, PLAIN.legs.lower, PLAIN.legs.upper, series_stiffness=given
    )


def test_one_area_is_that_of_both_chambers():
    one = with_law(BASE, OIL, area_1_cm2=None, area_2_cm2=None, area_cm2=20)
    assert one == with_law(BASE, OIL, area_2_cm2=20)
    wide = one.replace({"legs.stiffness_law.area_mm2": 2500})
    np.testing.assert_array_equal(wide.legs.stiffness_law.area_2, 2.5e-3)


def test_another_stiffness_takes_the_place_of_the_present_one():
    oil = with_law(BASE, OIL)
    assert oil.replace({"legs.stiffness": BASE.legs.stiffness}) == BASE
    table = with_law(oil, TABLE, lengths_mm=[2000, 3000, 3500, 4000])
    assert isinstance(table.legs.stiffness_law, fx.design.TableLaw)
    softer = oil.replace({"legs.stiffness_law.bulk_modulus_MPa": 700, "legs.stiffness_law.stroke[3]": 1.9})
    np.testing.assert_array_equal(softer.legs.stiffness_law.bulk_modulus, 7e8)
    np.testing.assert_array_equal(softer.legs.stiffness_law.range[3], [1.5, 3.4])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"legs.series_stiffness": [9e7] * 6}, "six numbers, which may be one for each leg or six in series"),
        ({"legs.series_stiffness": [[9e7] * 6] * 6}, "6 springs in series with a leg; there may be 5 at most"),
        ({"legs.series_stiffness": []}, "shape 0; it must be some numbers or one number or six rows"),
        ({"legs.series_stiffness": [9e7, 0]}, r"series_stiffness\[1\] is 0 N/m; it must be > 0. Leave out what is"),
        ({"legs.series_stiffness": [[1, 2], [3]]}, "rows of different lengths"),
        ({"legs.joint_stiffness.universal": -1}, "is -1 N m/rad; it must be >= 0. Give 0 for a joint that turns"),
        ({"legs.joint_stiffness.universal": [1, 2, 3]}, r"shape 3; it must be two numbers \[first axis, second axis\]"),
        ({"legs.joint_stiffness.torsion": [1, 2]}, "has shape 2; it must be one number or six"),
        ({"legs.joint_stiffness.torsion_N_m": 1}, "'N_m' is no unit of angular stiffness.*torsion_N_m_per_deg"),
        ({"legs.joint_stiffness.bending": 1}, r"Keys of \[legs.joint_stiffness\]: loss_factor, spherical, torsion"),
        ({"legs.joint_rest.orientation": [0, 0, 1]}, r"missing: legs.joint_rest.position"),
        ({"legs.loss_factor": 200}, "is 200; it must be <= 10"),
        ({"limits.spherical_moment": 0}, "is 0 N m; it must be > 0"),
        ({"suspension.point": [0, 0, 0]}, "given without stiffness and damping"),
        ({"suspension.stiffness_N_per_m": [1] * 6}, "suspension.stiffness has none"),
        ({"suspension.stiffness": np.triu(np.ones((6, 6)))}, r"\[0\]\[1\] is 1 and \[1\]\[0\] is 0; it must be symm"),
        ({"suspension.stiffness": -SUSPENSION}, r"stiffness\[0\]\[0\] is -20000; numbers on the diagonal must be >= 0"),
        (
            {"suspension.damping": np.ones((6, 6)) + np.eye(6)[::-1]},
            r"\[0\]\[5\] is 2, beyond 1, the root of \[0\]\[0\]",
        ),
        ({"suspension.damping": 1.9 * np.eye(6) - 0.9}, "it has the eigenvalue -3.5; none may be < 0"),
        ({"suspension.stiffness": [1, 2, 3]}, "it must be six rows of six numbers, or those on the diagonal"),
        ({"home": None, "suspension.stiffness": [1] * 6}, "suspension has no pose in which it is without force. Add"),
        ({"home": None, "legs.joint_stiffness.torsion": 1}, r"legs.joint_stiffness has no pose.*Add \[home\]"),
    ],
)
def test_what_no_machine_can_have_is_refused(change, words):
    with pytest.raises(fx.DesignError, match=words):
        PLAIN.replace(change)


@pytest.mark.parametrize(
    ("law", "changes", "words"),
    [
        (OIL, {"kind": None}, r"legs.stiffness and \[legs.stiffness_law\] are both given"),
        (OIL, {"kind": "oil"}, 'is \'oil\'; it must be one of: "screw", "hydraulic", "table"'),
        (OIL, {"kind": 3}, "is 3; it must be text"),
        (OIL, {"stroke": None}, r"missing: legs.stiffness_law.stroke \(longest minus shortest leg\)"),
        (OIL, {"area_1_cm2": None}, r"needs .*\(area gives both areas\)"),
        (OIL, {"area": 1}, "legs.stiffness_law.area and legs.stiffness_law.area_1 are both given"),
        (OIL, {"fixed": 1}, "fixed is no number of the law 'hydraulic', which has bulk_modulus, area_1"),
        (OIL, {"strok": 1}, "Did you mean legs.stiffness_law.stroke"),
        (OIL, {"dead_2": 0}, "dead_2 is 0 m; it must be > 0. Some oil is left"),
        (OIL, {"bulk_modulus_N": 1}, "'N' is no unit of pressure"),
        (OIL, {"stroke": 1.1}, "leg 1 is 2.70608 m long at home; its legs.stiffness_law holds to 2.6 m"),
        (OIL, {"shortest": 2.2}, "leg 1 is 2.151 m long by limits.leg_length; its legs.stiffness_law holds from 2.2"),
        (SCREW, {"zero_length_mm": 3000}, "leg 1 is 2.70608 m long at home; its legs.stiffness_law holds from 3 m"),
        (TABLE, {"lengths_mm": [2000, 4000, 3000, 5000]}, r"lengths\[2\] is 3 m, after 4 m; lengths must rise"),
        (TABLE, {"lengths_mm": [2000, 2000, 3000, 5000]}, r"lengths\[1\] is 2 m, after 2 m; lengths must rise"),
        (TABLE, {"lengths_mm": [2000]}, "has 1 lengths; it must have from 2 to 24. Give the ends"),
        (TABLE, {"lengths_mm": list(range(30))}, r"lengths_mm\[0\] is 0 mm; it must be > 0"),
        (TABLE, {"lengths_mm": list(range(1, 31))}, "has 30 lengths; it must have from 2 to 24. Leave out"),
        (TABLE, {"lengths_mm": [2000, 4000]}, "stiffnesses has 4 numbers and legs.stiffness_law.lengths 2"),
        (TABLE, {"stiffnesses_N_per_um": [1, 2, 3, -4]}, r"\[3\] is -4 N/um; it must be > 0"),
        (TABLE, {"lengths_mm": 2000}, "has one number; it must be some numbers"),
    ],
)
def test_a_law_that_is_none_is_refused(law, changes, words):
    with pytest.raises(fx.DesignError, match=words):
        with_law(BASE, law, **changes)


def test_a_law_and_a_constant_are_not_both_given():
    text = with_law(BASE, OIL).to_toml().replace("[legs.stiffness_law]", "[legs]\nstiffness = 1\n[legs.stiffness_law]")
    with pytest.raises(fx.DesignError, match="both say how stiff the legs are"):
        fx.Hexapod.from_toml(text)
    law = fx.design.TableLaw([1, 2], [1e7, 2e7])
    for make, words in (
        (lambda: fx.design.Legs(None), "are both missing"),
        (lambda: fx.design.Legs(1e7, stiffness_law=law), "are both given"),
        (lambda: fx.design.Legs(["1"], stiffness_law=law), "are both given"),
        (lambda: fx.design.Legs(None, stiffness_law=5), "must be a ScrewLaw or HydraulicLaw or TableLaw"),
        (lambda: fx.design.Legs(1e7, joint_stiffness=5.0), "must be a JointStiffness"),
        (lambda: fx.design.Legs(1e7, joint_rest=[0, 0, 1]), "legs.joint_rest is .*must be a Pose"),
        (lambda: fx.design.JointStiffness(universal=[[1], [1, 2]]), "rows of different lengths"),
    ):
        with pytest.raises(fx.DesignError, match=words):
            make()


def test_a_leg_along_its_axis_at_rest_has_no_neutral_joint():
    axes = PLAIN.universal_axes.copy()
    axes[3] = PLAIN.home.position + PLAIN.platform_joints[3] - PLAIN.base_joints[3]
    with pytest.raises(fx.DesignError, match="home has leg 4 without a direction across its universal axis"):
        PLAIN.replace({"base.universal_axes": axes, "legs.joint_stiffness.torsion": 1})


@pytest.mark.parametrize(
    ("machine", "variables"),
    [
        (
            EVERY,
            [
                fx.Variable("legs.series_stiffness_N_per_um", 10, 300),
                fx.Variable("legs.joint_stiffness.universal[:][1]", 0, 50),
                fx.Variable("legs.joint_stiffness.spherical[2]", 0, 50),
                fx.Variable("legs.stiffness_law.axial_rigidity_kN", 1e3, 1e6, log=True),
                fx.Variable("legs.joint_rest.orientation_deg[1]", -1, 1),
                fx.Variable("suspension.stiffness[0][4]", -400, 400),
                fx.Variable("suspension.point_mm[2]", 0, 100),
            ],
        ),
        (
            PLAIN.replace({"legs.joint_stiffness.torsion": 1}),
            [fx.Variable("home.orientation_deg[0]", -5, 5), fx.Variable("home.position[2]", 0.2, 0.3)],
        ),
        (with_law(PLAIN, TABLE), [fx.Variable("legs.stiffness_law.stiffnesses", 0.5, 2, kind="scale")]),
        (with_law(PLAIN, TABLE), [fx.Variable("legs.stiffness_law.stiffnesses_N_per_um[3]", 10, 90)]),
        (with_law(BASE, OIL), [fx.Variable("legs.stiffness_law.area_cm2", 1, 100)]),
        (
            plain_machine("cubic-isolator").replace({"legs.joint_stiffness.torsion": 1}),
            [fx.Variable("cubic.edge", 0.3, 0.6)],
        ),
    ],
)
def test_searches_vary_springs_with_exact_derivatives(machine, variables):
    found = DesignMap(machine, variables)
    x = np.clip(1.02 * found.own() + 1e-3 * (found.high - found.low), found.low, found.high)
    hexapod = found.hexapod_at(x)
    np.testing.assert_array_equal(hexapod.packed, found.numbers(x)[: _core.design_size])
    jacobian = found.jacobian(x)
    for k in range(len(x)):
        step = 1e-5 * (found.high - found.low)[k] * np.eye(len(x))[k]
        slope = (found.numbers(x + step) - found.numbers(x - step)) / (2 * step[k])
        np.testing.assert_allclose(jacobian[:, k], slope, rtol=1e-6, atol=1e-8 * np.abs(slope).max())


def test_a_whole_key_leaves_out_room_that_the_design_does_not_use():
    names = [p.name for p in fx.Uncertain("legs.series_stiffness", 0.1).parameters(EVERY)]
    assert len(names) == 12
    assert names[-1] == "legs.series_stiffness[5][1]"
    nodes = fx.Uncertain("legs.stiffness_law.stiffnesses", 0.1).parameters(with_law(PLAIN, TABLE))
    assert [p.words for p in nodes] == [f"legs.stiffness_law.stiffnesses, node {i}" for i in (1, 2, 3, 4)]
    words = [p.words for p in fx.Uncertain("legs.joint_stiffness.universal[2]", 0.1).parameters(EVERY)]
    assert words == [f"legs.joint_stiffness.universal, leg 3, axis {i}" for i in (1, 2)]
    (entry,) = fx.Uncertain("suspension.stiffness[0][4]", 0.1).parameters(EVERY)
    assert entry.words == "suspension.stiffness, x-pitch"


def test_uncertain_springs_reach_the_core():
    ensemble = Ensemble(EVERY, fx.Uncertain("legs.series_stiffness", 0.1, each=False))
    compliance = ensemble.designs(np.array([[0.0], [0.5], [1.0]]))[:, PLACES["legs.series_compliance"]]
    own = EVERY.legs.series_compliance
    np.testing.assert_allclose(compliance, [own / 0.9, own, own / 1.1], rtol=1e-14)


@pytest.mark.parametrize(
    ("machine", "key", "words"),
    [
        (
            PLAIN,
            "legs.stiffness_law.fixed",
            r"has no legs.stiffness_law.fixed\[0\]. Write the design with \[legs.stiff",
        ),
        (PLAIN, "suspension.stiffness[0][0]", r"Write the design with \[suspension\]"),
        (PLAIN, "legs.series_stiffness", "Write the design with legs.series_stiffness"),
        (EVERY, "legs.series_stiffness[0][3]", r"has no legs.series_stiffness\[0\]\[3\]"),
        (EVERY, "legs.stiffness", "Its legs have a stiffness law: change the numbers of"),
        (EVERY, "legs.stiffness_law.stroke", "has no legs.stiffness_law.stroke"),
        (with_law(PLAIN, TABLE), "legs.stiffness_law.lengths[7]", r"has no legs.stiffness_law.lengths\[7\]"),
        (PLAIN.replace({"home": None}), "legs.joint_stiffness.torsion", r"names no pose.*add \[home\] or"),
        (PLAIN, "legs.joint_rest.position", r"Write the design with \[legs.joint_rest\]"),
        (PLAIN, "legs.series_compliance", "series_compliance is not a key of a design"),
        (
            PLAIN,
            "legs.stiffness_law.kind",
            "legs.stiffness_law.kind is not a number that a search can change.*: it is text",
        ),
        (EVERY, "legs.loss_factor", "stray: it counts in responses, in random vibration and in time"),
        (
            EVERY,
            "legs.joint_stiffness.loss_factor[2]",
            "stray: it counts in responses, in random vibration and in time",
        ),
        (PLAIN, "drive.motor.speeds", "stray: it counts for the motors along a path"),
        (PLAIN, "points.vertex", "stray: it is a place at which motions are told"),
        (PLAIN, "limits.leg_rate", "stray: searches keep the limits as the design has them"),
    ],
)
def test_what_a_design_does_not_have_does_not_vary(machine, key, words):
    for make in (lambda: fx.Variable(key, 1, 2).parts(machine), lambda: fx.Uncertain(key, 0.1).parameters(machine)):
        with pytest.raises(fx.ArgumentError, match=words):
            make()


def test_slope_of_the_compliance_in_series():
    stiffness = np.array([[9e7, 3e7], [1.0, 1e-3]])
    np.testing.assert_allclose(compliance_slope(stiffness), -1 / stiffness**2, rtol=1e-14)


def test_the_core_has_room_for_the_nodes_that_a_table_may_have():
    assert PLACES["legs.stiffness_law.lengths"].size == fx.design.stiffness_laws.MOST_NODES


def in_use(block: str, law: str) -> str:
    """Commented lines of the template as they are without the comment sign, of one law."""
    found, kind = [], law
    for line in block.split("\n"):
        bare = line.removeprefix("# ")
        kind = bare.split('"')[1] if bare.startswith("kind = ") else law if bare.startswith("[") else kind
        if re.match(r"[a-z0-9_A-Z]+ = |\[", bare) and kind == law:
            found.append(bare)
    return "\n".join(found)


@pytest.mark.parametrize("law", ["screw", "hydraulic", "table"])
def test_what_the_template_says_of_springs_can_be_used(law):
    text = template("sprung")
    first, last = text.index("stiffness_N_per_um = 20.0"), text.index("# Viscous friction")
    legs = in_use(text[first:last], law).replace("stiffness_N_per_um = 20.0", "#", 1)
    text = text[:first] + legs + "\n" + text[last:]
    text = text.replace("# universal_moment", "universal_moment").replace("# spherical_moment", "spherical_moment")
    last = text.index("# ---- Home")
    first = text.index("# [suspension]")
    machine = fx.Hexapod.from_toml(text[:first] + in_use(text[first:last], law) + "\n" + text[last:])
    assert machine.legs.stiffness_law.kind.name == law
    assert machine.legs.joint_stiffness.any
    assert machine.legs.series_stiffness.shape == (6, 2)
    assert machine.suspension is not None
    assert machine.limits.spherical_moment == 2.0
    assert machine.rest is not machine.home


def test_the_command_line_sets_and_varies_springs(result, run):
    joints = "legs.joint_stiffness={universal=15, spherical_N_mm_per_rad=15e3}"
    series = "legs.series_stiffness_N_per_um=[94, 94]"
    found = result("check", file("precision-positioner"), "--set", joints, "--set", series)
    assert found["ok"]
    assert found["values"]["legs.joint_stiffness.spherical"] == [15.0] * 6
    assert found["values"]["legs.series_stiffness"] == [[94e6, 94e6]] * 6
    found = result("robust", file("precision-positioner"), "--set", series, "--uncertain", "legs.series_stiffness=10%",
                   "--samples", 16, "--sensitivity", 0)  # fmt: skip
    assert len(found["parameters"]) == 12
    code, _, err = run("modes", file("precision-positioner"), "--set", "legs.joint_stiffness.torsion=-1")
    assert code == 2
    assert "legs.joint_stiffness.torsion is -1 N m/rad; it must be >= 0" in " ".join(err.split())


def test_entries_of_a_suspension_have_units_of_their_own():
    """A force or a moment by a displacement or a turn; a matrix or a row of it has several."""
    found = {
        "suspension.stiffness[2][2]": "N/m",
        "suspension.stiffness[0][4]": "N",
        "suspension.stiffness[4][0]": "N",
        "suspension.stiffness[5][3]": "N m/rad",
        "suspension.damping[0][1]": "N s/m",
        "suspension.damping[1][3]": "N s",
        "suspension.damping[5][5]": "N m s/rad",
        "suspension.stiffness": "",
        "suspension.damping[0]": "",
    }
    assert {key: unit_name(key) for key in found} == found


def test_every_number_of_a_design_varies_or_says_what_it_counts_for():
    left = [key for key in KEYS if key not in layout.EVERY and key not in SETS]
    assert left
    for key in left:
        with pytest.raises(fx.ArgumentError, match=r"may stray: (?!it is text).* Change it in the design"):
            layout.entries(key)
