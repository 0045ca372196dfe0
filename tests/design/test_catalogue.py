"""The published machines that come with Flexapod: each has the number that its source prints, and says what it assumes."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.cases import case

import flexapod as fx
from flexapod.design.catalogue import catalogue, description
from flexapod.design.design_file import find

OWN = {"cubic-isolator", "motion-base", "precision-positioner"}  # after published ones, with estimates of our own
CATALOGUE = catalogue()
PUBLISHED = {}


def published(test):
    """A test of the number that the machine of its name has published."""
    PUBLISHED[test.__name__.removeprefix("test_").replace("_", "-")] = test
    return test


# --- their numbers, from the sources -------------------------------------------------------------------------------


@published
def test_taghirad_6_3():
    """The printed force, from the source's programs evaluated apart; and it depends on nothing that is assumed."""
    expected = json.loads(case("taghirad", "expected.json").read_text())["states"][0]
    assert expected["name"] == "home, at rest"
    machine = fx.load("taghirad-6-3")
    other = machine.replace({"legs.stiffness": 3e5})
    for one in (machine, other):
        force = fx.inverse_dynamics(one, joint="spin_free")
        np.testing.assert_allclose(force, expected["leg_forces"], rtol=1e-9)
        np.testing.assert_allclose(force, 3614.937, atol=5e-4)


@published
def test_dietmaier_40():
    expected = json.loads(case("dietmaier", "expected.json").read_text())
    machine = fx.load("dietmaier-40")
    found = fx.forward_kinematics_all(machine, expected["leg_lengths"])
    assert len(found.row) == len(expected["postures"]) == 40
    # Home is one of them: its angles are written with eight decimals of a degree.
    np.testing.assert_allclose(fx.inverse_kinematics(machine), expected["leg_lengths"], atol=2e-9)


@published
def test_nairck_6_6():
    expected = json.loads(case("nairck", "expected.json").read_text())
    machine = fx.load("nairck-6-6")
    x, y, z = np.array(expected["pose"]["position_mm"]) / 1e3
    turned = Rotation.from_euler("XYZ", expected["pose"]["rpy_deg"], degrees=True)
    pose = fx.Pose([x, y, z], turned)
    # Angles are printed to 5e-4 degrees, which are 0.013 mm at the joints.
    np.testing.assert_allclose(1e3 * fx.inverse_kinematics(machine, pose), expected["lengths_mm"], atol=0.014)
    rise = fx.envelope(machine, directions=4).axes[2].most
    assert 1e3 * rise == pytest.approx(expected["extent_mm"][1][2], abs=6e-4)


@published
def test_wolfram_stewart():
    expected = json.loads(case("wolfram", "expected.json").read_text())
    machine = fx.load("wolfram-stewart")
    np.testing.assert_allclose(fx.inverse_kinematics(machine), expected["lengths"], rtol=5e-15)
    directions = fx.force_transformation(machine)[:3].T
    np.testing.assert_allclose(directions, expected["directions"], atol=5e-15)


@published
def test_genhexkins():
    expected = json.loads(case("genhexkins", "expected.json").read_text())
    machine = fx.load("genhexkins")
    for one in expected["cases"]:
        pose = fx.Pose.from_rpy(*one["position"], *one["rpy"])
        np.testing.assert_allclose(fx.inverse_kinematics(machine, pose), one["lengths"], atol=5.1e-5)
    np.testing.assert_allclose(fx.inverse_kinematics(machine), 3.5823, atol=5e-5)


@published
def test_dehaeze_general():
    """Two digits, as the source prints them."""
    for mass in (1.0, 7.0):
        machine = fx.load("dehaeze-general").replace({"platform.mass": mass})
        compliance = np.linalg.inv(fx.linearise(machine, fx.home_pose(machine)).K)
        printed = [f"{x:.1e}" for x in np.diag(compliance)]
        assert printed == ["4.7e-08", "4.7e-08", "2.1e-08", "5.2e-06", "5.2e-06", "1.7e-06"]
        assert (f"{compliance[0, 4]:.1e}", f"{compliance[1, 3]:.1e}") == ("3.2e-07", "-3.2e-07")


@published
def test_dehaeze_cubic():
    for middle in (0.6, 0.3):
        machine = fx.load("dehaeze-cubic").replace({"cubic.middle": middle})
        stiffness = fx.linearise(machine, fx.home_pose(machine)).K
        np.testing.assert_allclose(stiffness, np.diag([2, 2, 2, 0.015, 0.015, 0.06]), rtol=1e-12, atol=1e-14)


@published
def test_roboop_stewart():
    lengths = fx.inverse_kinematics(fx.load("roboop-stewart"))
    # One unit of the fourth decimal: the joints are printed with four.
    np.testing.assert_allclose(lengths, [3.0508, 3.2324, 3.2997, 3.4560, 3.5797, 3.6935], atol=1e-4)


def reaches(machine, limits):
    """Whether each axis alone goes as far as the controller's position limits, mm and degrees."""
    axes = fx.envelope(machine, directions=4).axes
    travel = [min(-axis.least, axis.most) for axis in axes]
    return np.array(travel) >= np.array([*np.array(limits[:3]) / 1e3, *np.radians(limits[3:])])


@published
def test_rubin_camera_hexapod():
    machine = fx.load("rubin-camera-hexapod")
    limits = [11.4, 11.4, 13.1, 0.36, 0.36, 0.1]
    assert reaches(machine, limits).all()
    half = machine.replace({"limits.leg_length": machine.limits.leg_length + np.array([7.05e-3, -7.05e-3])})
    assert not reaches(half, limits)[2:5].any()  # with half the strut travel it would not
    assert (np.abs(fx.force_transformation(machine)[2]) > 0.5).all()  # all struts move it in z
    length = 1e3 * fx.inverse_kinematics(machine)
    np.testing.assert_allclose(1e3 * machine.limits.leg_length, length[:, None] + [-14.1, 14.1], atol=5.1e-4)


@published
def test_rubin_m2_hexapod():
    machine = fx.load("rubin-m2-hexapod")
    np.testing.assert_allclose(1e3 * fx.inverse_kinematics(machine), 493.0, atol=5e-4)
    assert reaches(machine, [10.5, 10.5, 8.9, 0.175, 0.175, 0.05]).all()
    x, y, z = np.abs(fx.force_transformation(machine)[:3]) > 1e-9  # what struts must change for small motions
    assert np.flatnonzero(z).tolist() == [0, 1, 2]
    assert np.flatnonzero(y).tolist() == [4, 5]
    assert np.flatnonzero(x).tolist() == [3, 4, 5]
    assert np.abs(fx.force_transformation(machine)[0]).argmax() == 3  # "contributes most"


@published
def test_mukherjee_ii():
    """The frequency at which the paper's vibration grows, within what one doubtful mass centre leaves open."""
    machine = fx.load("mukherjee-ii")
    assert fx.natural_modes(machine, joint="spin_free").omega[2] == pytest.approx(761.4, abs=0.05)
    other = machine.replace({"legs.upper.mass_center": fx.load("mukherjee-i").legs.upper.mass_center})
    third = fx.natural_modes(other, joint="spin_free").omega[2]
    assert third == pytest.approx(750.4, abs=0.05)
    assert third == pytest.approx(749.715, rel=1e-3)


# --- what the files say -----------------------------------------------------------------------------------------------


def test_every_published_number_is_tested():
    assert {name for name, one in CATALOGUE.items() if one.published} == set(PUBLISHED)
    assert len(PUBLISHED) >= 10


def test_every_file_says_whose_it_is():
    for name, one in CATALOGUE.items():
        assert one.about.endswith(".")
        assert one.kind
        assert one.by.startswith("Flexapod, after ") == (name in OWN)
        assert one.source
        assert re.fullmatch(r"(19|20)\d\d|", one.year)
        text = find(name).read_text(encoding="utf-8")
        body = text[text.index("\nname = ") :]
        assert ("Assumed" in body) == bool(one.assumed and "Assumed: see above." in body)
        assert fx.load(name).home is not None


def test_the_folder_stays_small():
    assert sum(find(name).stat().st_size for name in CATALOGUE) < 60_000


def test_the_head_of_a_file():
    text = "# A machine.\n# It moves.\n#\n# Kind: crane\n# By: N. N.\n#   and others\n# Note: x\n#   y\n\nname = 'a'\n# Year: 1\n"
    found = description(text)
    assert found == ("A machine. It moves.", "crane", "N. N. and others", "", "", "", "")
    assert description("name = 'a'") == ("",) * 7


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ("dietmaier-40", ["dietmaier-40"]),
        ("MOOG", ["rubin-camera-hexapod", "rubin-m2-hexapod"]),
        ("telescope m2", ["rubin-m2-hexapod"]),
        ("dehaeze 2020 isolator", ["dehaeze-cubic"]),
        ("textbook 2013", ["taghirad-6-3"]),
        ("Bélanger", ["roboop-stewart"]),
        ("mallik", ["mukherjee-i", "mukherjee-ii"]),
    ],
)
def test_designs_are_found_by_name_maker_kind_author_and_year(run, result, words, names):
    assert list(result("designs", "--search", words)) == names
    code, out, _ = run("designs", "--search", words)
    assert code == 0
    assert all(name in out for name in names)
    assert "source" in out
    assert [name for name in CATALOGUE if name in run("designs")[1]] == list(CATALOGUE)


def test_the_page_of_the_manual_has_them_all():
    made = (Path(__file__).parents[2] / "docs" / "machines.md").read_text(encoding="utf-8")
    for name, one in CATALOGUE.items():
        assert f"| `{name}` |" in made
        assert one.source in made
        assert all(one.published in row for row in made.splitlines() if row.startswith(f"| `{name}`"))
