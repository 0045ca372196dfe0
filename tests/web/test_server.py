"""The server without a browser: answers against the library, refusals, limits, and jobs."""

import json
import struct
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.helpers.waiting import until
from tests.web.asked import ASKED, BOX, LONG, MACHINE, POSE, TEXT

import flexapod as fx

pytest.importorskip("starlette")
from starlette.testclient import TestClient

from flexapod.web import designs
from flexapod.web.app import STATIC, application
from flexapod.web.limits import JOB_BYTES


@pytest.fixture(scope="module")
def client() -> Iterator[TestClient]:
    with TestClient(application(), base_url="http://127.0.0.1:8765") as client:
        yield client


def frames(content: bytes) -> list[tuple[dict[str, Any], bytes]]:
    found = []
    while content:
        head, data = struct.unpack("<II", content[:8])
        found.append((json.loads(content[8 : 8 + head]), content[8 + head : 8 + head + data]))
        content = content[8 + head + data :]
    return found


def test_a_state_is_the_library_s(client: TestClient) -> None:
    state = client.post("/api/state", json=ASKED).json()
    modes = fx.natural_modes(MACHINE, POSE)
    np.testing.assert_array_equal(state["omega"], modes.omega)  # JSON keeps every bit of a float
    np.testing.assert_array_equal(np.array(state["shape"]).T, modes.shape)
    assert state["condition"] == fx.condition_number(MACHINE, POSE)
    np.testing.assert_array_equal(state["legs"]["force"], fx.hold(MACHINE, POSE).leg_force)
    np.testing.assert_array_equal(state["damped"]["ratio"], fx.linearise(MACHINE, POSE).modes().damping_ratio)
    assert [mode["text"] for mode in state["modes"]] == [d.text for d in fx.describe_modes(MACHINE, POSE)]


def test_changes_and_the_joint_model_reach_the_library(client: TestClient) -> None:
    asked = ASKED | {"changes": {"platform.mass": 40, "legs.stiffness[2]": 5e7}, "joint": "spin_free"}
    state = client.post("/api/state", json=asked).json()
    changed = MACHINE.replace({"platform.mass": 40, "legs.stiffness[2]": 5e7})
    np.testing.assert_array_equal(state["omega"], fx.natural_modes(changed, POSE, joint="spin_free").omega)


@pytest.mark.parametrize("name", ["mukherjee-ii", "precision-positioner"])
def test_the_legs_energies_are_all_that_their_springs_hold(client: TestClient, name: str) -> None:
    """Screws and joints in series too; what the joints hold by bending is no energy of a leg's."""
    machine = fx.load(name)
    x, y, z = machine.home.position
    pose = [x, y, z + 0.001, 0.0, 0.1, 0.0]  # m and degrees
    state = client.post("/api/state", json={"design": machine.to_toml(), "changes": {}, "pose": pose}).json()
    pose[4] = np.radians(pose[4])
    held = fx.hold(machine, pose)
    whole = fx.energy(machine, pose, unstretched_length=held.unstretched_length)
    assert sum(state["legs"]["energy"]) == pytest.approx(float(whole.elastic - whole.joints), rel=1e-9)


def test_a_singular_pose_is_told_not_failed(client: TestClient) -> None:
    flat = {"platform.joints": MACHINE.platform_joints.tolist(), "base.joints": MACHINE.base_joints.tolist()}
    state = client.post("/api/state", json={"design": TEXT, "changes": flat, "pose": [0, 0, 0, 0, 0, 0]}).json()
    assert state["legs"]["force"] is None
    assert "singular" in state["grave"][0]
    assert state["damped"] is None


def test_every_wrong_key_of_a_design_is_found_at_its_line(client: TestClient) -> None:
    text = TEXT.replace("mass = 4.0", "mass = -4.0").replace("stiffness = 8e7", "stifness = 8e7")
    answer = client.post("/api/design", json={"design": text})
    assert answer.status_code == 422
    found = {error["key"]: error for error in answer.json()["fields"]}
    assert set(found) == {"platform.mass", "legs.stifness"}
    lines = text.splitlines()
    assert lines[found["platform.mass"]["line"] - 1] == "mass = -4.0"
    assert lines[found["legs.stifness"]["line"] - 1] == "stifness = 8e7"


@pytest.mark.parametrize("text", ["", "[base", "a = 1", "x = " + "[" * 5000, "\x00", "platform.mass = 'text'"])
def test_text_that_is_no_design_is_refused_with_words(client: TestClient, text: str) -> None:
    answer = client.post("/api/design", json={"design": text})
    assert answer.status_code == 422
    assert answer.json()["error"]


def test_changes_that_are_wrong_are_found_one_by_one(client: TestClient) -> None:
    changes = {"platform.mass": -1, "legs.stiffness": 0, "base.radius": -3, "gravity": [0, 0, -9]}
    answer = client.post("/api/design", json={"design": TEXT, "changes": changes})
    assert {error["key"] for error in answer.json()["fields"]} == {"platform.mass", "legs.stiffness", "base.radius"}


def test_all_presets_are_described_and_stand(client: TestClient) -> None:
    start = client.get("/api/start").json()
    assert sorted(start["presets"]) == fx.packaged_designs()
    for text in start["presets"].values():
        described = client.post("/api/design", json={"design": text}).json()
        assert fx.Hexapod.from_toml(described["toml"]).digest == described["digest"]
        state = client.post("/api/state", json={"design": text, "pose": described["home"]}).json()
        assert state["index"] > 0
        assert np.all(np.array(described["box"]["low"]) < described["box"]["high"])


def test_radii_scale_the_joints(client: TestClient) -> None:
    source = designs.Source(TEXT, json.dumps({"base.radius": 0.06}))
    joints = designs.built(source).base_joints
    assert np.hypot(*joints.T[:2]).mean() == pytest.approx(0.06, rel=1e-12)
    np.testing.assert_array_equal(joints[:, 2], MACHINE.base_joints[:, 2])


def test_a_cloud_is_the_library_s_at_those_poses(client: TestClient) -> None:
    answer = client.post("/api/jobs/cloud", json=ASKED | {"box": BOX, "points": 1000, "seed": 3})
    parts = frames(answer.content)
    assert [message["type"] for message, _ in parts] == ["job", "points", "done"]
    rows = np.frombuffer(b"".join(data for _, data in parts), dtype="<f4").reshape(-1, 9)
    assert len(rows) == 1000
    six = rows[:, :6].astype(float)
    assert np.all(six >= np.float32(BOX["low"]))
    assert np.all(six <= np.float32(BOX["high"]))
    poses = fx.Pose.from_rpy(*six[:, :3].T, *np.radians(six[:, 3:]).T)
    np.testing.assert_allclose(rows[:, 6], fx.stability_index(MACHINE, poses), rtol=6e-8 * 2)  # float32 rounds to 6e-8
    np.testing.assert_allclose(rows[:, 7], fx.condition_number(MACHINE, poses), rtol=6e-8 * 2)


def test_a_slice_lies_where_it_says(client: TestClient) -> None:
    asked = ASKED | {"box": BOX, "across": "yaw", "up": "z", "side": 5}
    parts = frames(client.post("/api/jobs/slice", json=asked).content)
    rows = np.frombuffer(b"".join(data for _, data in parts), "<f4")
    index = rows.reshape(5, 5, 3)[1, 4, 0]  # second line up, last across
    six = [0.001, 0.0, 0.0825, *np.radians([1.0, 2.0, 5.0])]
    assert index == pytest.approx(fx.stability_index(MACHINE, fx.Pose.from_rpy(*six)), rel=1e-7)


def test_the_worst_pose_is_no_better_than_any_other(client: TestClient) -> None:
    message = frames(client.post("/api/jobs/worst", json=ASKED | {"box": BOX}).content)[1][0]
    rows = np.random.default_rng(0).uniform(BOX["low"], BOX["high"], (2000, 6))
    poses = fx.Pose.from_rpy(*rows[:, :3].T, *np.radians(rows[:, 3:]).T)
    assert message["index"] <= fx.stability_index(MACHINE, poses).min()
    here = message["pose"]
    found = fx.stability_index(MACHINE, fx.Pose.from_rpy(*here[:3], *np.radians(here[3:])))
    assert found == pytest.approx(message["index"], rel=1e-9)


def test_a_response_is_the_library_s(client: TestClient) -> None:
    answer = client.post("/api/response", json=ASKED | {"quantity": "compliance", "loss_factor": 0.01}).json()
    data = fx.transmissibility(MACHINE, POSE, omega=answer["omega"], loss_factor=0.01)["compliance"].to_numpy()
    np.testing.assert_allclose(np.moveaxis(answer["magnitude"], -1, 0), np.abs(data), rtol=6e-5)  # five digits are sent
    assert answer["output_units"] == ["m"] * 3 + ["rad"] * 3
    assert len(answer["modes"]) == 6


def test_a_recorded_motion_is_simulated(client: TestClient) -> None:
    t = np.linspace(0, 0.02, 400)
    csv = "time,z_um\n" + "\n".join(f"{a},{1e3 * (a / 0.02) ** 4}" for a in t)
    asked = ASKED | {"kind": "csv", "csv": csv, "duration": 0.02}
    message, data = frames(client.post("/api/jobs/time", json=asked).content)[-2]
    rows = np.frombuffer(data, "<f4").reshape(-1, 25)
    assert message["count"] == len(rows)
    assert rows[-1, 9] == pytest.approx(1e-3, rel=1e-5)  # the base where the recording ends
    wrong = frames(client.post("/api/jobs/time", json=asked | {"csv": "time,q\n0,0"}).content)[-1][0]
    assert wrong["type"] == "failed"
    assert "'q'" in wrong["error"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"pose": [0, 0, 1]}, "pose must be 6"),
        ({"pose": [0, 0, float("inf"), 0, 0, 0]}, "finite"),
        ({"design": 4}, "design must be"),
        ({"joint": "ball"}, "joint is 'ball'"),
        ({"quantity": "colour"}, "quantity is 'colour'"),
        ({"loss_factor": -1}, "loss_factor is -1"),
    ],
)
def test_questions_that_make_no_sense(client: TestClient, change: dict[str, Any], words: str) -> None:
    answer = client.post("/api/response", content=json.dumps(ASKED | change))
    assert answer.status_code == 422
    assert words in answer.json()["error"]


def test_a_box_upside_down_fails_with_words(client: TestClient) -> None:
    box = {"low": BOX["high"], "high": BOX["low"]}
    last = frames(client.post("/api/jobs/cloud", json=ASKED | {"box": box}).content)[-1][0]
    assert last["type"] == "failed"
    assert "the box of x runs from 0.01 to -0.01" in last["error"]


def test_a_job_can_be_stopped_by_its_name(client: TestClient) -> None:
    jobs = client.app.state.jobs
    answers = []
    runner = threading.Thread(target=lambda: answers.append(client.post("/api/jobs/time", json=LONG)))
    runner.start()
    assert until(jobs.running)
    assert client.delete("/api/jobs/nonsense").status_code == 404
    assert client.delete(f"/api/jobs/{jobs.running()[0]}").status_code == 204
    runner.join(timeout=60)
    assert frames(answers[0].content)[-1][0] == {"type": "cancelled"}
    assert jobs.running() == []


def test_unknown_jobs_are_refused(client: TestClient) -> None:
    assert client.post("/api/jobs/mining", json=ASKED).status_code == 404


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "", "[::1", "localhost@evil.example"])
def test_a_foreign_host_is_refused(client: TestClient, host: str) -> None:
    for path in ("/", "/api/start"):
        assert client.get(path, headers={"host": host}).status_code == 421


@pytest.mark.parametrize("host", ["127.0.0.1:8765", "localhost:1234", "[::1]:8765", "LOCALHOST"])
def test_names_of_this_computer_are_answered(client: TestClient, host: str) -> None:
    assert client.get("/api/start", headers={"host": host}).status_code == 200


def test_other_names_are_answered_where_they_were_given() -> None:
    client = TestClient(application(hosts=["bench.example"]), base_url="http://bench.example")
    assert client.get("/api/start").status_code == 200


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "https://evil.example"},
        {"origin": "null"},
        {"origin": "http://localhost:9999"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ],
)
def test_pages_of_other_sites_may_not_ask(client: TestClient, headers: dict[str, str]) -> None:
    assert client.post("/api/state", json=ASKED, headers=headers).status_code == 403
    assert client.post("/api/state", json=ASKED, headers={"origin": "http://127.0.0.1:8765"}).status_code == 200


def test_long_requests_are_refused_announced_or_not(client: TestClient) -> None:
    long = b"x" * (JOB_BYTES + 1)
    assert client.post("/api/design", content=long).status_code == 413
    assert client.post("/api/design", content=iter([long[: JOB_BYTES // 2]] * 3)).status_code == 413
    assert client.post("/api/design", content=b"not json").status_code == 400
    assert client.post("/api/design", content=b"[1]").status_code == 400


def test_every_answer_carries_a_strict_policy(client: TestClient) -> None:
    for path in ("/", "/api/start", "/nowhere", "/assets/index.js"):
        headers = client.get(path).headers
        policy = headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "unsafe" not in policy
        assert "require-trusted-types-for 'script'" in policy
        assert headers["x-content-type-options"] == "nosniff"


def test_files_outside_the_bundle_are_not_served(client: TestClient) -> None:
    for path in ("/../app.py", "/%2e%2e/app.py", "/assets/../../app.py", "/..%2fapp.py"):
        assert client.get(path).status_code == 404


def test_the_bundle_names_no_other_place() -> None:
    page = (STATIC / "index.html").read_text()
    assert "//" not in page.replace("http://www.w3.org", "")
    assert "<script>" not in page
    assert "style=" not in page


def test_the_page_s_packages_are_locked_without_a_registry() -> None:
    """`npm ci` takes them from whichever registry is set up."""
    lock = (Path(__file__).parents[2] / "web" / "package-lock.json").read_text(encoding="utf-8")
    assert '"integrity"' in lock
    assert '"resolved"' not in lock
