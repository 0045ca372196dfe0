"""Cautions: the report, the command `check` and the page say the same of a pose, with one set of thresholds."""

import json
from pathlib import Path

import numpy as np
import pytest
from tests.helpers.plain import file, plain_machine

import flexapod as fx
from flexapod.mechanics.cautions import NEAR_SINGULAR, singularity
from flexapod.mechanics.modes import mode_clusters
from flexapod.report import gather


@pytest.mark.parametrize(
    ("name", "yaw", "code"),
    [
        ("motion-base", 89.5, "near_singular"),
        ("precision-positioner", 89.0, "near_singular"),
        ("precision-positioner", 90.0, "singular"),
        ("motion-base", 10.0, None),
    ],
)
def test_report_and_page_give_the_same_cautions(name, yaw, code):
    pytest.importorskip("starlette")
    from flexapod.web.state import snapshot

    hexapod = plain_machine(name)
    six = [*fx.home_pose(hexapod).position, 0.0, 0.0, yaw]
    found = gather(hexapod, fx.Pose.from_rpy(*six[:3], 0, 0, np.radians(yaw)))
    shown = snapshot(hexapod, six)
    said = [*shown["grave"], *shown["warnings"]]
    assert said == [one.text for one in found.cautions if one.code not in ("limit", "design")]
    assert code in [one.code for one in found.cautions] if code else not said or "singular" not in said[0]


def test_near_singular_is_a_condition_number_without_units():
    assert singularity(NEAR_SINGULAR) == []
    near = singularity(1.01 * NEAR_SINGULAR)[0]
    assert (near.code, near.numbers) == ("near_singular", {"condition": 1.01 * NEAR_SINGULAR})
    assert singularity(np.inf)[0].code == "singular"


def test_check_leaves_what_is_only_near_to_the_report(result):
    found = result("check", file("precision-positioner"), "--pose", 0, 0, 0.244, 0, 0, 89)
    assert found["singularity"] == []
    assert json.dumps(result("check", file("precision-positioner"), "--pose", 0, 0, 0.244, 0, 0, 90)["singularity"])


def test_near_repeated_modes_stand_together():
    assert mode_clusters(np.array([1.0, 1.001, 2.0, 3.0, 3.001, 3.002])) == [[0, 1], [2], [3, 4, 5]]


STRUTS = Path(__file__).parents[1] / "data" / "cases" / "tangential-struts" / "m2-mass.toml"
NEAR = {"base.universal_axes[3]": [1.0, 0.0, np.tan(np.radians(1.0))]}  # strut 4 runs along x


def test_a_leg_along_its_axis_is_named_everywhere(result, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where the report is written
    hexapod = fx.load(STRUTS).replace(NEAR)
    found = [one for one in gather(hexapod).cautions if one.code == "axis_along_leg"]
    assert [one.numbers["leg"] for one in found] == [4]
    assert found[0].numbers["angle_deg"] == pytest.approx(1.0, abs=1e-6)
    assert found[0].text.startswith("Leg 4 is 1 degrees from the axis of its universal joint")
    file = tmp_path / "near.toml"
    hexapod.save(file)
    for command in ("check", "modes", "report"):
        out = run(command, file)[1]
        assert found[0].text in " ".join(out.split())
    assert result("check", file)["ok"] is False
    assert found[0].text in result("modes", file)["warnings"]
    pytest.importorskip("starlette")
    from flexapod.web.state import snapshot

    assert found[0].text in snapshot(hexapod, [*hexapod.home.position, 0, 0, 0])["warnings"]


def test_a_sweep_names_the_leg_behind_its_least_index(run, tmp_path):
    """The least index of the sweep is where the leg is nearest to its axis."""
    file = tmp_path / "near.toml"
    fx.load(STRUTS).replace(NEAR).save(file)
    code, out, err = run("sweep", file, "--around", 0.005, 0.5, "--points", 2000)
    assert (code, "At the pose of the least index: Leg 4 is" in " ".join(out.split())) == (0, True), err


def test_an_axis_two_degrees_away_is_no_fault():
    away = {"base.universal_axes[3]": [1.0, 0.0, np.tan(np.radians(2.01))]}
    assert not [one for one in gather(fx.load(STRUTS).replace(away)).cautions if one.code == "axis_along_leg"]
    turned = fx.load(STRUTS).replace({"base.universal_axes[3]": [-1.0, 0.0, np.tan(np.radians(1.9))]})
    assert [one for one in gather(turned).cautions if one.code == "axis_along_leg"]  # an axis has no sign
