"""Bounds of machines with springs in joints and beside the legs, and with laws of leg stiffness, through every way to them."""

import numpy as np
import pytest
from tests.helpers.drawn import sprung, with_law
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.certificates import checking, file
from flexapod.report.studies.certificate import study

BASE = plain_machine("motion-base")
HOME = fx.home_pose(BASE)
RNG = np.random.default_rng(14)
SPRUNG = sprung(BASE, RNG)
LENGTHS = fx.inverse_kinematics(BASE, HOME)
OIL = {"kind": "hydraulic", "bulk_modulus": 1e9, "area_1": 5e-3, "area_2": 3e-3, "dead_1": 0.05, "dead_2": 0.05}
LAWS = {
    "screw": {"kind": "screw", "fixed": 4e7, "axial_rigidity": 6e7, "zero_length": 1.5},
    "hydraulic": {**OIL, "stroke": 1.4, "shortest": 1.9},
    "table": {"kind": "table", "lengths": [1.9, 2.4, 2.6, 2.9, 3.3], "stiffnesses": [3e7, 2e7, 2.2e7, 1.5e7, 2.5e7]},
}
MACHINES = {"joints and suspension": SPRUNG} | {
    name: BASE.replace({"limits": None, "legs.stiffness": None, "legs.stiffness_law": law})
    for name, law in LAWS.items()
}
MACHINES["both"] = with_law(SPRUNG.replace({"limits": None}), RNG, "hydraulic")
SMALL = fx.Box.about(HOME, 0.02, np.radians(1))
TALL = fx.Box(z=(2.2, 3.2), pitch=(0.0, 0.05))  # leaves the range of the hydraulic law


def least(design, box, joint="universal", samples=20_000):
    found = fx.sweep(design, fx.random_poses(box, samples, seed=3), quantities="omega_1", joint=joint)
    return float(found.omega_1.min())


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize("kind", MACHINES)
def test_the_bound_is_below_every_sample_and_is_checked_anew(kind, joint, tmp_path):
    design, path = MACHINES[kind], tmp_path / "proof.json"
    found = fx.certify(design, SMALL, joint=joint, path=path)
    assert found.proved
    assert found.lower <= least(design, SMALL, joint)
    assert found.lower == pytest.approx(0.99 * found.upper, rel=1e-12)
    assert found.upper == pytest.approx(float(fx.stability_index(design, found.pose, joint=joint)), rel=1e-9)
    checked = checking.check_certificate(path)
    assert checked.proved
    assert checked.lower == found.lower
    again = fx.certify(design, SMALL, joint=joint, path=path, resume=True)
    assert file.text_of(again) == file.text_of(found)
    above = fx.certify(design, SMALL, joint=joint, at_least=found.upper * (1 + 1e-6))
    assert above.status == "refuted"


@pytest.mark.parametrize("kind", ["both", "table"])
def test_paths_and_searches_are_proved(kind):
    design = MACHINES[kind]
    path = fx.Trajectory([[0, 0, 2.4, 0, 0, 0], [0.1, 0.05, 2.5, 0.1, 0, 0.1]], [0, 1])
    found = fx.certify(design, path, at_least=10.0)
    assert found.proved
    assert fx.certify(design, path).lower <= fx.path_index(design, path).minimum
    worst = fx.worst_pose(design, SMALL, certified=True, samples=256)
    assert 0.99 * worst.omega_1 <= worst.proved * (1 + 1e-12) < worst.omega_1
    largest = fx.certified_box(design, fx.Workspace.about_home(0.02, 0.02), 0.98 * worst.omega_1, tolerance=0.3)
    assert largest.certificate.proved
    assert least(design, largest.box) >= 0.98 * worst.omega_1


def test_a_pose_beyond_the_range_of_a_law_refutes_and_is_told(tmp_path):
    design, path = MACHINES["hydraulic"], tmp_path / "proof.json"
    found = fx.certify(design, TALL, path=path)
    assert (found.status, found.lower) == ("refuted", 0.0)
    assert np.isnan(found.upper)
    assert found.broken.startswith("stiffness law of leg ")
    assert f"a pose is outside the range of the {found.broken}" in found.words
    assert any("for its stiffness law" in words for words in fx.check_limits(design, found.pose).exceeded)
    with pytest.raises(fx.PoseError, match=r"legs\.stiffness_law"):
        fx.stability_index(design, found.pose)
    assert checking.check_certificate(path).status == "refuted"
    shown = study(found)
    assert any(row.value.startswith("outside the range of the stiffness law") for row in shown.rows if row.value)
    wanted = fx.certify(design, TALL, at_least=5.0, path=path)
    assert wanted.status == "refuted"
    assert checking.check_certificate(path).status == "refuted"
    whole = fx.certify(BASE, TALL)
    assert whole.proved


def test_within_the_limits_poses_beyond_the_law_do_not_count():
    design = MACHINES["hydraulic"]
    inside = fx.certify(design, TALL, within_limits=True, gap=0.05)
    assert inside.proved
    assert 0 < inside.share_outside < 1
    assert inside.lower <= least(design, TALL)
    worst = fx.worst_pose(design, TALL, certified=True)
    assert 0.99 * worst.omega_1 <= worst.proved * (1 + 1e-12) < worst.omega_1
    limits = fx.certify_limits(design, TALL)
    assert limits.status == "refuted"
    assert limits.broken.startswith("length of leg")
    assert fx.certify_limits(design, SMALL).proved
    # All poses within the law's range, whatever the design's own limits are.
    narrow = MACHINES["hydraulic"].replace({"limits.leg_length": [2.3, 2.8]})
    everywhere = fx.worst_pose(narrow, TALL, certified=True, all_poses=True)
    assert everywhere.omega_1 == pytest.approx(worst.omega_1, rel=1e-6)
    assert everywhere.proved == pytest.approx(worst.proved, rel=1e-6)


def test_other_claims_are_of_geometry_alone(tmp_path):
    turned = fx.Box.about([*HOME.position, 0, 0, np.pi / 2], 0.01, np.radians(2))
    plain = fx.certify_regular(BASE, turned)
    assert plain.status == "refuted"
    for kind in ("joints and suspension", "screw"):
        design = MACHINES[kind]
        assert fx.certify_regular(design, SMALL).proved, kind
        found = fx.certify_regular(design, turned, path=tmp_path / "proof.json")
        assert found.status == "refuted", kind
        assert checking.check_certificate(tmp_path / "proof.json").status == "refuted", kind
        condition = fx.certify_condition_number(design, SMALL)
        assert condition.upper == pytest.approx(fx.certify_condition_number(BASE, SMALL).upper, rel=1e-6), kind
    held = fx.certify(SPRUNG, turned, gap=0.05)  # springs hold the platform there
    assert held.proved
    assert held.lower > 1.0


def test_limits_of_moments_are_proved_or_broken():
    moments = fx.joint_moments(SPRUNG, fx.random_poses(SMALL, 5000).rows(0, 5000))
    universal = float(np.linalg.norm(moments.universal_moment, axis=-1).max())
    kept = SPRUNG.replace(
        {"limits.universal_moment": 1.2 * universal, "limits.spherical_moment": 1.2 * moments.bending_moment.max()}
    )
    assert fx.certify_limits(kept, SMALL).proved
    for key in ("universal", "spherical"):
        broken = kept.replace({f"limits.{key}_moment": 0.8 * kept.values()[f"limits.{key}_moment"]})
        found = fx.certify_limits(broken, SMALL)
        assert found.status == "refuted"
        assert found.broken.startswith(f"moment in the {key} joint of leg")
        assert any(f"{key} joint moment" in words for words in fx.check_limits(broken, found.pose).exceeded)
    assert fx.certify(kept, SMALL, within_limits=True).share_outside == 0
    assert fx.certify_regular(broken, SMALL, within_limits=True).proved
    with pytest.raises(fx.ArgumentError, match="exact joint model only"):
        fx.certify(kept, SMALL, within_limits=True, joint="spin_free")


RAISING = ["legs.joint_stiffness.universal", "legs.joint_stiffness.spherical[:]", "legs.joint_stiffness.torsion",
           "legs.series_stiffness", "suspension.stiffness[2][2]", "suspension.stiffness[4][4]"]  # fmt: skip
OF_LAWS = {"screw": ["fixed", "axial_rigidity"], "hydraulic": ["bulk_modulus", "area_1", "area_2", "dead_1", "dead_2"]}


@pytest.mark.parametrize(
    ("kind", "target"),
    [("joints and suspension", one) for one in RAISING]
    + [(kind, f"legs.stiffness_law.{name}") for kind, names in OF_LAWS.items() for name in names],
)
def test_uncertain_springs_have_a_worst_end(kind, target):
    design, one = MACHINES[kind], fx.Uncertain(target, 0.1)
    poses = fx.random_poses(fx.Box.about(HOME, 0.2, 0.2), 300)
    worst = fx.sweep(one.at_worst(design), poses, quantities="omega_1").omega_1
    rng = np.random.default_rng(3)
    falls = False
    for _ in range(3):
        changes = {}
        for parameter in one.parameters(design):
            value = design.values()[target.partition("[")[0]]
            place = (
                tuple(int(i) for i in parameter.name[:-1].partition("[")[2].split("]["))
                if "[" in parameter.name
                else ()
            )
            changes[parameter.name] = value[place] * rng.uniform(0.9, 1.1)
        drawn = design.replace(changes)
        index = fx.sweep(drawn, poses, quantities="omega_1").omega_1
        assert (worst <= index * (1 + 1e-12)).all()
        falls |= bool((worst < index * (1 - 1e-9)).any())
    assert falls
    home = fx.certify(design, HOME, uncertain=one)
    assert home.proved
    assert home.upper < float(fx.stability_index(design, HOME))


@pytest.mark.parametrize(
    ("kind", "target"),
    [
        ("screw", "zero_length"),
        ("hydraulic", "stroke"),
        ("hydraulic", "shortest"),
        ("table", "stiffnesses"),
        ("table", "lengths[2]"),
    ],
)
def test_numbers_of_a_law_without_a_worst_end_are_refused(kind, target):
    uncertain = fx.Uncertain(f"legs.stiffness_law.{target}", 0.001)
    with pytest.raises(fx.ArgumentError, match="neither rises nor falls"):
        fx.certify(MACHINES[kind], SMALL, uncertain=uncertain)
    with pytest.raises(fx.ArgumentError, match="neither rises nor falls"):
        fx.certify(SPRUNG, SMALL, uncertain=fx.Uncertain("suspension.stiffness[1][0]", 1.0, relative=False))


def test_the_page_says_which_springs_are_in_the_model():
    words = " ".join(text for section in study(fx.certify(MACHINES["both"], SMALL)).sections for text in section.words)
    for part in ("law of their length (hydraulic)", "springs in series", "springs in the joints", "a suspension"):
        assert part in words
