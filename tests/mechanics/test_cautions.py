"""Cautions: the report, the command `check` and the page say the same of a pose, with one set of thresholds."""

import json

import numpy as np
import pytest

import flexapod as fx
from flexapod.mechanics.cautions import NEAR_SINGULAR, mode_clusters, singularity
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
    from flexapod.web import requests, state

    hexapod = fx.load(name)
    six = [*fx.home_pose(hexapod).position, 0.0, 0.0, yaw]
    found = gather(hexapod, fx.Pose.from_rpy(*six[:3], 0, 0, np.radians(yaw)))
    said = state.snapshot(requests.question({"design": hexapod.to_toml(), "pose": six}))["warnings"]
    assert said == [one.text for one in found.cautions if one.code not in ("limit", "design")]
    assert code in [one.code for one in found.cautions] if code else not said or "singular" not in said[0]


def test_near_singular_is_a_condition_number_without_units():
    assert singularity(NEAR_SINGULAR) == []
    near = singularity(1.01 * NEAR_SINGULAR)[0]
    assert (near.code, near.numbers) == ("near_singular", {"condition": 1.01 * NEAR_SINGULAR})
    assert singularity(np.inf)[0].code == "singular"


def test_check_leaves_what_is_only_near_to_the_report(result):
    found = result("check", "precision-positioner", "--pose", 0, 0, 0.244, 0, 0, 89)
    assert found["singularity"] == []
    assert json.dumps(result("check", "precision-positioner", "--pose", 0, 0, 0.244, 0, 0, 90)["singularity"])


def test_near_repeated_modes_stand_together():
    assert mode_clusters(np.array([1.0, 1.001, 2.0, 3.0, 3.001, 3.002])) == [[0, 1], [2], [3, 4, 5]]
