"""The view for notebooks in Python: poses both ways, what is refused, what a page is told, machines of every kind."""

import json
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx

pytest.importorskip("anywidget")

MACHINE = plain_machine("precision-positioner")
HOME = fx.home_pose(MACHINE)
MEETING = fx.Pose(MACHINE.base_joints[0] - MACHINE.platform_joints[0])  # the joints of leg 1 meet
UP = fx.Pose.from_rpy(*(HOME.position + np.array([0, 0, 0.002])), 0.01, -0.02, 0.03)


@pytest.fixture
def view():
    return fx.view(MACHINE)


def slide(view, six):
    """What a page does when a slider is moved: m and degrees."""
    view.set_state({"_six": list(six)})


def told(view):
    """What a page knows of a view, which JSON can hold."""
    state = view.get_state(["_drawn", "_six", "_snapshot", "_refused", "mode"])
    return json.loads(json.dumps(state, allow_nan=False))


def hz(machine, pose, **options):
    return fx.natural_modes(machine, pose, **options).omega / (2 * np.pi)


def test_it_starts_at_home_or_where_it_is_told(view):
    assert view.pose == HOME
    assert view.mode is None
    assert told(view)["_drawn"]["name"] == MACHINE.name
    np.testing.assert_allclose(told(view)["_snapshot"]["frequency"], hz(MACHINE, HOME), rtol=1e-12)
    assert fx.view(MACHINE, UP).pose == UP


def test_without_a_home_pose_the_first_one_is_where_the_sliders_begin():
    homeless = MACHINE.replace({"home": None})
    with pytest.raises(fx.PoseError, match="home"):
        fx.view(homeless)
    shown = told(fx.view(homeless, UP))
    assert shown["_drawn"]["home"] == shown["_six"]
    low, high = (np.array(shown["_drawn"]["box"][side]) for side in ("low", "high"))
    np.testing.assert_allclose(0.5 * (low + high), shown["_six"], atol=1e-9)


def test_a_pose_that_is_set_is_computed_and_told_once(view):
    seen = []
    view.observe(lambda change: seen.append(change.new), "pose")
    view.pose = UP
    assert seen == [UP]
    assert view.pose is seen[0]  # as it was given, not rounded on the way to the page
    state = told(view)
    np.testing.assert_allclose(state["_snapshot"]["frequency"], hz(MACHINE, UP), rtol=1e-9)
    np.testing.assert_allclose(state["_six"], [*UP.position, *np.degrees(UP.rpy)], atol=1e-11)
    assert state["_snapshot"]["pose"] == state["_six"]
    view.pose = [*HOME.position, 0, 0, 0]
    assert view.pose == HOME
    view.pose = None
    assert seen == [UP, HOME]


def test_a_slider_sets_the_pose(view):
    seen = []
    view.observe(lambda change: seen.append(change.new), "pose")
    x, y, z = HOME.position.tolist()
    slide(view, [x + 0.001, y, z, 0, 2, 0])
    expected = fx.Pose.from_rpy(x + 0.001, y, z, pitch=2, degrees=True)
    assert view.pose == expected
    assert seen == [expected]
    state = told(view)
    assert state["_six"] == state["_snapshot"]["pose"] == [x + 0.001, y, z, 0, 2, 0]
    np.testing.assert_allclose(state["_snapshot"]["frequency"], hz(MACHINE, expected), rtol=1e-12)
    slide(view, [x + 0.001, y, z, 0, 362, 0])  # the same place by other angles stays as it was written
    assert told(view)["_snapshot"]["pose"][4] == 362


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        ([0, 0], "its last axis must hold 6 numbers"),
        ("home", "pose is str; give a flexapod Pose"),
        (np.zeros((2, 6)), "one pose is needed"),
        ([np.nan] * 6, "NaN or infinity"),
        (MEETING, "leg 1 has length 0 m at this pose"),
    ],
)
def test_a_bad_pose_is_refused_and_the_machine_stays(view, bad, words):
    view.pose = UP
    before = told(view)
    with pytest.raises(fx.PoseError, match=words):
        view.pose = bad
    assert view.pose == UP
    assert told(view) == before
    with pytest.raises(fx.PoseError, match=words):
        fx.view(MACHINE, bad)


def test_a_slider_where_no_leg_can_go_is_told_why(view):
    six = [*MEETING.position.tolist(), 0, 0, 0]
    slide(view, six)
    assert view.pose == HOME
    state = told(view)
    assert state["_refused"]["pose"] == state["_six"] == six
    assert (
        "leg 1 has length 0 m at this pose; its joints must not meet. Move the platform." in state["_refused"]["words"]
    )
    view.pose = HOME  # the pose of the machine that is shown, all the time
    assert told(view)["_refused"] is None
    np.testing.assert_allclose(told(view)["_six"][:3], HOME.position)
    slide(view, six)
    slide(view, told(view)["_snapshot"]["pose"])
    assert told(view)["_refused"] is None


def test_an_error_of_who_watches_is_no_refusal(view):
    """The leg forces of a singular pose do not exist; the pose does."""
    view.observe(lambda change: fx.hold(MACHINE, change.new), "pose")
    with pytest.raises(fx.SingularPoseError):
        slide(view, [*HOME.position.tolist(), 0, 0, 90])
    state = told(view)
    assert state["_refused"] is None
    assert state["_snapshot"]["stability"] == "singular"


@pytest.mark.parametrize("size", [1e9, 1e160, 1e308])
def test_a_pose_far_beyond_reason_is_shown_or_refused(view, size):
    slide(view, [size, 0, 0, 0, 0, 0])
    state = told(view)
    assert (state["_refused"] is None) == (state["_snapshot"]["pose"][0] == size)


def test_a_singular_pose_is_shown_as_one(view):
    singular = fx.Pose.from_rpy(*HOME.position, yaw=np.pi / 2)
    view.pose = singular
    state = told(view)["_snapshot"]
    assert state["stability"] == "singular"
    assert state["condition"] is None  # infinity, which JSON has not
    assert state["frequency"][0] == 0.0
    assert "The pose is singular" in state["grave"][0]


def test_broken_limits_are_words(view):
    view.pose = HOME.displaced(fx.Pose([0, 0, 0.05]))
    assert told(view)["_snapshot"]["limits"]["exceeded"] == list(fx.check_limits(MACHINE, view.pose).exceeded) != []


@pytest.mark.parametrize("mode", [0, 7, 1.5, "first", True])
def test_a_mode_is_a_number_from_1_to_6(view, mode):
    view.mode = 6
    with pytest.raises(fx.ArgumentError, match="mode is"):
        view.mode = mode
    assert view.mode == 6
    view.set_state({"mode": 2})
    assert view.mode == 2
    view.mode = None
    assert told(view)["mode"] is None


KINDS = {
    "law": fx.load("motion-base"),
    "series": MACHINE.replace({"legs.series_stiffness": 1e8}),
    "joint springs": MACHINE.replace({"legs.joint_stiffness.universal": 5.0, "legs.joint_stiffness.spherical": 5.0}),
    "suspension": MACHINE.replace({"suspension.stiffness": [1e4, 1e4, 1e4, 1e3, 1e3, 1e3]}),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_springs_of_every_kind_count(kind, joint):
    machine = KINDS[kind]
    shown = fx.view(machine, joint=joint)
    pose = fx.home_pose(machine).displaced(fx.Pose([0.001, 0, 0.002]))
    shown.pose = pose
    np.testing.assert_allclose(told(shown)["_snapshot"]["frequency"], hz(machine, pose, joint=joint), rtol=1e-9)


def test_outside_the_range_of_a_stiffness_law_it_says_so():
    shown = fx.view(KINDS["law"])
    slide(shown, [0.0, 0.0, 3.9, 0.0, 0.0, 0.0])
    words = told(shown)["_refused"]["words"]
    assert re.match(r"leg 1: length .* where legs\.stiffness_law \(hydraulic\) says nothing\. Move the platform", words)
    with pytest.raises(fx.FlexapodError, match=re.escape(words)):
        shown.pose = [0.0, 0.0, 3.9, 0.0, 0.0, 0.0]
    assert shown.pose == KINDS["law"].home


def test_two_views_do_not_share_their_state(view):
    other = fx.view(MACHINE)
    other.pose, other.mode = UP, 3
    assert view.pose == HOME
    assert view.mode is None


def test_where_there_are_no_widgets_it_is_a_picture(view):
    view.pose = UP
    data, _ = view._repr_mimebundle_()
    assert data["application/vnd.jupyter.widget-view+json"]["model_id"] == view.model_id
    ET.fromstring(f"<all>{data['text/html']}</all>")
    assert data["text/html"].count("<svg") == 1
    for frequency in hz(MACHINE, UP):
        assert f"{frequency:.5g}" in data["text/html"]
    assert data["text/plain"] == repr(view) == f"<view of {MACHINE.name} at {UP}>"


def test_the_module_has_all_it_needs(view):
    """Nothing is imported and nothing is loaded from elsewhere; the licence of what it contains is in it."""
    module = view.get_state()["_esm"]
    assert not re.search(r"(^|[;}\n])import\b|\bimport\(", module.partition("*/")[2])
    assert not re.search(r"\bfetch\(|XMLHttpRequest|https?://(?!www\.w3\.org/)", module)
    assert "three.js authors" in module
    assert "MIT License" in module


def test_it_is_imported_late():
    code = (
        "import sys, flexapod as fx\nfx.view\nassert not {'anywidget', 'ipywidgets', 'IPython'} & set(sys.modules)\n"
        "fx.view(fx.load('motion-base'))\nassert not {'starlette', 'uvicorn', 'matplotlib.pyplot'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_notebook_that_was_run_holds_the_view(tmp_path):
    """Its state is in the file, so that a page made of it shows the view without a kernel."""
    for package in ("nbclient", "ipykernel"):
        pytest.importorskip(package)
    import nbformat
    from nbclient import NotebookClient

    code = "import flexapod as fx\nview = fx.view(fx.load('motion-base'))\nview.pose = [0.1, 0, 2.4, 0, 0, 0]\nview"
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)])
    NotebookClient(book, timeout=600, startup_timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    (output,) = book.cells[0].outputs
    model = output["data"]["application/vnd.jupyter.widget-view+json"]["model_id"]
    state = book.metadata["widgets"]["application/vnd.jupyter.widget-state+json"]["state"][model]["state"]
    assert state["_six"][:3] == [0.1, 0.0, 2.4]
    machine = fx.load("motion-base")
    np.testing.assert_allclose(state["_snapshot"]["frequency"], hz(machine, fx.Pose([0.1, 0, 2.4])), rtol=1e-12)
    assert state["_esm"] == (Path(fx.notebook.__file__).parent / "static" / "view.js").read_text(encoding="utf-8")
    assert "<svg" in output["data"]["text/html"]
