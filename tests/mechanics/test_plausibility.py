"""Numbers that are hardly meant: told by check, by the report and by the page; none in the packaged designs."""

from pathlib import Path

import numpy as np
import pytest

import flexapod as fx
from flexapod.design.design_file import template
from flexapod.mechanics import plausibility
from flexapod.mechanics.cautions import pose_cautions, unitless_condition

CASES = Path(__file__).parents[1] / "data" / "cases"
OIL = {
    "bulk_modulus": 1e9,
    "area_1": 5e-3,
    "area_2": 3e-3,
    "dead_1": 0.05,
    "dead_2": 0.05,
    "stroke": 1.0,
    "shortest": 0.1,
}
OWN = fx.Hexapod.from_toml(template("own"))


def codes(hexapod, pose=None):
    pose = fx.home_pose(hexapod) if pose is None else pose
    omega = fx.natural_modes(hexapod, pose).omega
    condition = unitless_condition(hexapod, pose)
    try:
        rest = fx.hold(hexapod, pose)
    except fx.SingularPoseError:
        rest = None
    return [one.code for one in pose_cautions(hexapod, pose, omega, condition, None, rest)]


@pytest.mark.parametrize("name", fx.packaged_designs())
def test_packaged_designs_are_plausible(name):
    hexapod = fx.load(name)
    pose = fx.home_pose(hexapod)
    assert plausibility.implausible(hexapod) == []
    assert plausibility.legs_that_cross(hexapod, pose) == plausibility.soft_legs(hexapod, fx.hold(hexapod, pose)) == []


@pytest.mark.parametrize(
    ("changes", "code", "words"),
    [
        ({"platform.inertia": [1.95e6, 1.95e6, 3.675e6]}, "radius_of_gyration", "247 m with 60 kg"),  # kg mm2
        ({"platform.inertia_kg_mm2": [1.95, 1.95, 3.675]}, "radius_of_gyration", "check the units of platform.inertia"),
        (
            {"platform.mass_center": [0, 0, 50]},
            "mass_center",
            "platform.mass_center is 50 m from the platform's joints",
        ),
        ({"legs.lower.mass_center": [200, 0, 0]}, "mass_center", "legs.lower.mass_center is 200 m from the leg's base"),
        ({"legs.upper.rod.length": 350}, "mass_center", "legs.upper.mass_center is 175 m"),
        ({"gravity": [0, 0, -9810]}, "gravity", "1e+03 times the Earth's"),
        ({"gravity_mm_per_s2": [0, 0, -9.81]}, "gravity", "[0, 0, 0]"),
        ({"gravity": [0, 0, 9.81]}, "gravity", "points along +z"),
        ({"base.circle.radius": 500, "platform.circle.radius": 300}, "size", "base.circle.radius_mm"),
        ({"platform.circle.radius_mm": 0.3}, "size", "the platform's 0.0003 m"),
        ({"home.position": [0, 0, 500]}, "size", "in mm it is home.position_mm"),
        ({"legs.stiffness": 20}, "soft_legs", "legs.stiffness_N_per_um"),
        ({"legs.series_stiffness": [94, 94]}, "series_stiffness", "leaves 2.35e-06 of the 2e+07 N/m of leg 1"),
        ({"legs.joint_stiffness.universal": [0, 15e6]}, "joint_stiffness", "universal_N_mm_per_rad"),
        ({"legs.joint_stiffness.spherical": 15e6}, "joint_stiffness", "times the leg's axial stiffness of 2e+07 N/m"),
        ({"legs.joint_stiffness.spherical_N_mm_per_rad": 0.015}, "joint_stiffness", "which is nothing"),
        (
            {
                "legs.joint_stiffness.spherical": 15e6,
                "legs.stiffness_law": {"kind": "table", "lengths": [0.4, 0.8], "stiffnesses": [2e7, 2e7]},
            },
            "joint_stiffness",
            "times the leg's axial stiffness of 2e+07 N/m",
        ),
        ({"limits.universal_moment": 1}, "idle_limit", "Give legs.joint_stiffness.universal, or leave it out"),
        ({"suspension.stiffness": [1, 1, 1, 100, 100, 100]}, "suspension", "springs 10 m from their centre"),
        ({"legs.loss_factor": 2}, "loss_factor", "2 % is 0.02"),
        (
            {
                "legs.stiffness_law": {"kind": "hydraulic", **OIL},
                "drive": {"lead": 0.01, "efficiency": 0.9},
            },
            "drive",
            "Leave [drive] out",
        ),
        ({"legs.joint_stiffness.loss_factor": 1.5}, "loss_factor", "legs.joint_stiffness.loss_factor is 1.5"),
    ],
)
def test_what_is_hardly_meant_is_told_with_its_number(changes, code, words):
    hexapod = OWN.replace(changes)
    pose = fx.home_pose(hexapod)
    found = plausibility.implausible(hexapod) + plausibility.soft_legs(hexapod, fx.hold(hexapod, pose))
    (text,) = [one.text for one in found if one.code == code and words in one.text]
    assert text.endswith(".")
    assert code in codes(hexapod)
    assert code not in codes(OWN)


@pytest.mark.parametrize(
    "changes",
    [
        {"gravity": [0, 0, 0]},
        {"gravity": [0, 9.476, -2.539]},  # a telescope at 15 degrees
        {"gravity": [0, 0, -1.62]},
        {"gravity": [0, 0, 9.81], "home.position": [0, 0, -0.5]},  # z points downwards, and the machine stands
        {"home.position": [0, 0, -0.5]},  # it hangs, with z upwards
        {"legs.lower": None, "legs.upper": None},
        {"legs.joint_stiffness": {"universal": 5, "spherical": 4.83, "torsion": 260}, "limits.universal_moment": 1},
        {"legs.stiffness_N_per_um": 0.01, "legs.joint_stiffness": {"universal": 33, "spherical": 33, "torsion": 236}},
        {"legs.series_stiffness_N_per_um": [94, 12.7], "legs.loss_factor": 0.05},
        {"suspension.stiffness": [2e4, 2e4, 5e4, 100, 100, 200]},
    ],
)
def test_what_people_build_is_not_doubted(changes):
    assert plausibility.implausible(OWN.replace(changes)) == []


def test_similar_hexagons_are_singular_everywhere(run, result):
    file = CASES / "faults" / "regular-hexagons.toml"
    hexapod = fx.load(file)
    assert "No pose helps: at all of 64 others" in result("check", file)["singularity"][0]
    # also where the joints are typed with eight digits, and the number is not one of rounding
    off = np.random.default_rng(0).uniform(-1e-8, 1e-8, (6, 3))
    typed = hexapod.replace({"platform.joints": hexapod.platform_joints + off})
    assert 1e6 < unitless_condition(typed, typed.home) < 1e10
    code, out, _ = run("check", file, "--set", f"platform.joints={typed.platform_joints.tolist()}")
    assert code == 0
    assert "No pose helps" in " ".join(out.split())
    # a pose that is singular of a machine that is not
    turned = fx.Pose.from_rpy(0, 0, 0.5, 0, 0, np.pi / 2)
    assert plausibility.singular_everywhere(OWN, turned, unitless_condition(OWN, turned)) is None
    assert "singular" in codes(OWN, turned)


@pytest.mark.parametrize("name", ["crossed", "mm", "mixed"])
def test_legs_that_cross_and_their_units(result, name):
    found = result("check", CASES / "crossed-legs" / f"{name}.toml")
    assert not found["ok"]
    text = " ".join(found["cautions"])
    assert "Legs cross or touch here" in text
    if name == "crossed":
        assert "1 and 6, 2 and 5, 3 and 4" in text
    else:
        assert {"mm": "base.circle.radius_mm", "mixed": "home.position_mm"}[name] in text


def test_legs_that_meet_by_design_do_not_cross():
    for file in ("coincident-joints/genhex", "faults/octahedron-3-3", "faults/cubic-full-edges"):
        hexapod = fx.load(CASES / f"{file}.toml")
        assert plausibility.legs_that_cross(hexapod, hexapod.home) == []


def test_degrees_typed_as_radians_are_refused(run):
    code, _, err = run("check", CASES / "crossed-legs" / "rad.toml")
    assert code == 2
    assert "base.circle.angles[0] is 50 rad" in err
    assert "put _deg at the end" in err


def test_check_prints_back_what_it_read(run, result, tmp_path):
    file = tmp_path / "own.toml"
    OWN.save(file)
    changes = ("--set", "legs.stiffness[2]=1.5e7", "--set", "platform.inertia_kg_cm2=[2e4,2e4,3e4]")
    _, out, _ = run("check", file, *changes)
    lines = {line.strip().split("   ")[0]: line for line in out.splitlines()}
    for key, words in {
        "gravity": "[0, 0, -9.81] m/s2",
        "base.circle.angles": "[50, 70, 170, 190, 290, 310] deg",
        "base.joints": "[0.321394, 0.383022, 0] m (leg 1)",
        "platform.inertia": "[2, 0, 0] kg m2",
        "platform: radii of gyration": "[0.182574, 0.182574, 0.223607] m",
        "legs.stiffness": "2e+07 N/m (leg 1)",
        "legs.damping.prismatic": "200 N s/m (all legs)",
        "legs.upper.rod.length": "0.35 m",
        "limits.universal_angle": "45 deg",
        "home.position": "[0, 0, 0.5] m",
    }.items():
        assert words in lines[key]
    assert "1.5e+07 N/m (leg 3)" in out
    found = result("check", file, *changes)
    again = fx.load(file).replace({"legs.stiffness[2]": 1.5e7, "platform.inertia": [2, 2, 3]})
    assert set(found["values"]) == set(again.values())
    np.testing.assert_array_equal(found["values"]["base.joints"], again.base_joints)
    np.testing.assert_allclose(found["radii_of_gyration_m"]["platform"], np.sqrt([2 / 60, 2 / 60, 3 / 60]))
    assert np.shape(found["radii_of_gyration_m"]["legs.upper"]) == (6, 3)
