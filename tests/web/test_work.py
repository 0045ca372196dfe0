"""What a job's process does, here in a thread: the messages of each kind of job, and how jobs fail."""

import json
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from itertools import pairwise
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.helpers.plain import file, plain_machine
from tests.web.asked import ASKED, BOX, LONG, MACHINE, POSE
from tests.web.serving import apart

import flexapod as fx

pytest.importorskip("starlette")

from flexapod.web import pose_ranges, response
from flexapod.web import worker as work
from flexapod.web.clients import Client
from flexapod.web.encode import as_json
from flexapod.web.jobs import Jobs
from flexapod.web.security import Guard


def as_bytes(spec: dict[str, Any]) -> bytes:
    return json.dumps(spec).encode()


class Work:
    """The loop of a job's process, at the other end of a pipe."""

    def __init__(self) -> None:
        self.pipe, theirs = multiprocessing.Pipe()
        self.thread = threading.Thread(target=work.serve, args=(theirs,))
        self.thread.start()

    def __call__(self, kind: str, /, **spec: Any) -> list[tuple[dict[str, Any], bytes]]:
        self.pipe.send((kind, as_bytes(ASKED | spec)))
        found = []
        while not found or found[-1][0]["type"] not in ("done", "failed"):
            assert self.pipe.poll(60), "the job says nothing"
            found.append(self.pipe.recv())
        return found

    def failure(self, kind: str, /, **spec: Any) -> str:
        return self(kind, **spec)[-1][0]["error"]


@pytest.fixture
def job() -> Iterator[Work]:
    found = Work()
    yield found
    found.pipe.close()
    found.thread.join(timeout=60)
    assert not found.thread.is_alive()  # it ends with its pipe


def rows_of(parts: list[tuple[dict[str, Any], bytes]], columns: int) -> np.ndarray:
    return np.frombuffer(b"".join(data for _, data in parts), "<f4").reshape(-1, columns).astype(float)


def test_one_process_does_one_job_after_another(job: Work) -> None:
    cloud = job("cloud", box=BOX, points=40_000, seed=1)
    told = [message for message, _ in cloud[:-1]]
    assert told[-1]["done"] == told[-1]["total"] == 40_000
    assert all(a["done"] < b["done"] for a, b in pairwise(told))
    rows = rows_of(cloud, 9)
    six = rows[-5:, :6]
    poses = fx.Pose.from_rpy(*six[:, :3].T, *np.radians(six[:, 3:]).T)
    np.testing.assert_allclose(rows[-5:, 6], fx.stability_index(MACHINE, poses), rtol=1.2e-7)  # float32 rounds to 6e-8
    again = rows_of(job("cloud", box=BOX, points=100, seed=1), 9)
    np.testing.assert_array_equal(again, rows[:100])


def test_a_cloud_and_the_worst_pose_are_within_the_limits(job: Work) -> None:
    text = Path(file("motion-base")).read_text(encoding="utf-8")
    machine, asked = plain_machine("motion-base"), {"design": text, "pose": [0.0, 0.0, 2.39, 0.0, 0.0, 0.0]}
    box = pose_ranges.box(machine)
    rows = rows_of(job("cloud", box=box, points=60_000, seed=1, **asked), 9)
    ok = fx.check_limits(machine, fx.Pose.from_rpy(*rows[:, :3].T, *np.radians(rows[:, 3:6]).T)).ok
    np.testing.assert_array_equal(rows[:, 8], ok)
    for everywhere in (False, True):
        worst = job("worst", box=box, all_poses=everywhere, **asked)[0][0]
        assert worst["index"] < rows[ok | everywhere, 6].min()
        assert (worst["within"] is None) == everywhere
        assert ("of the box is within the limits" in worst["words"]) != everywhere
    assert "all_poses is 1; it must be true or false" in job.failure("worst", box=box, all_poses=1)


def test_a_slice_holds_the_other_coordinates(job: Work) -> None:
    found = rows_of(job("slice", box=BOX, across="x", up="pitch", side=3), 3).reshape(3, 3, 3)
    xs, pitch = np.linspace(-0.01, 0.01, 3), np.radians([-5, 0, 5])
    poses = fx.Pose.from_rpy(xs[None], 0.0, 0.086, np.radians(1.0), pitch[:, None], np.radians(3.0))
    np.testing.assert_allclose(found[..., 0], fx.stability_index(MACHINE, poses), rtol=1.2e-7)
    np.testing.assert_array_equal(found[..., 2], fx.check_limits(MACHINE, poses).ok)


def test_the_worst_pose_says_where_the_box_ends(job: Work) -> None:
    message = job("worst", box=BOX)[0][0]
    found = fx.worst_pose(MACHINE, fx.Box(**dict(zip(("x", "y", "z", "roll", "pitch", "yaw"), (
        (a * s, b * s) for a, b, s in zip(BOX["low"], BOX["high"], [1, 1, 1, *[np.pi / 180] * 3], strict=True)
    ), strict=True))))  # fmt: skip
    assert message["index"] == found.omega_1
    assert "on the box's edge in " + ", ".join(found.at_bounds) in message["words"]
    assert message["words"].startswith("Least index")


MOTIONS = {
    "harmonic": ({"axis": "x", "amplitude": 1e-5, "frequency": 50.0}, 7),
    "sweep": ({"axis": "z", "amplitude": 1e-5, "frequency": 20.0, "end": 90.0}, 9),
    "shock": ({"axis": "y", "peak": 20.0, "pulse": 0.01}, 8),
    "step": ({"axis": "roll", "amplitude": 1e-3, "pulse": 0.02}, 10),
}


@pytest.mark.parametrize("kind", MOTIONS)
def test_a_base_motion_moves_its_axis_alone(kind: str, job: Work) -> None:
    """Columns: time, six of the platform, six of the base, lengths and forces of the legs."""
    form, column = MOTIONS[kind]
    parts = job("time", kind=kind, duration=0.03, **form)
    assert {message["type"] for message, _ in parts} == {"progress", "run", "done"}
    run = next(message for message, _ in parts if message["type"] == "run")
    rows = rows_of(parts, 25)
    assert rows.shape[0] == run["count"]
    assert rows[-1, 0] == pytest.approx(0.03)
    moved = np.abs(rows[:, 7:13]).max(axis=0)
    assert moved[column - 7] > 1e-6
    assert np.delete(moved, column - 7).max() == 0.0
    assert "steps" in run["words"]
    assert run["factor"] >= 1.0
    if kind == "step":
        assert rows[-1, column] == pytest.approx(1e-3, rel=1e-6)


def test_a_recorded_motion_is_what_its_file_says(job: Work) -> None:
    t = np.linspace(0, 0.02, 200)
    csv = "\ufefftime,z_um\n" + "\n".join(f"{a},{1e3 * (a / 0.02) ** 4}" for a in t)  # with the mark that editors leave
    rows = rows_of(job("time", kind="csv", csv=csv, duration=0.02), 25)
    assert rows[-1, 9] == pytest.approx(1e-3, rel=1e-5)


def test_a_run_that_stops_shows_how_far_it_came(job: Work) -> None:
    """On weak springs a shock carries the platform through a singular pose; the page plays it so far."""
    parts = job("time", changes={"legs.stiffness": 1e5}, kind="shock", axis="z", peak=-2e4, pulse=0.02, duration=0.2)
    run = next(message for message, _ in parts if message["type"] == "run")
    rows = rows_of(parts, 25)
    assert rows[-1, 0] < 0.2
    assert "singular" in run["words"]


@pytest.mark.parametrize(
    ("kind", "spec", "words"),
    [
        ("cloud", {}, "box must have low and high"),
        ("cloud", {"box": {"low": BOX["high"], "high": BOX["low"]}}, "the box of x runs from 0.01 to -0.01"),
        ("cloud", {"box": {"low": [0] * 6}}, "box.high must be 6 finite numbers"),
        ("cloud", {"box": BOX, "points": 0}, "points is 0; it must be a number from 1 to"),
        ("slice", {"box": BOX, "across": "x", "up": "x"}, "the two coordinates of a slice must differ"),
        ("slice", {"box": BOX, "across": "w"}, "across is 'w'; it must be one of x, y, z"),
        ("time", {"duration": 1e4}, "duration is 10000 s; at most"),
        ("time", {"kind": "csv"}, "csv must be the text of a CSV file"),
        ("time", {"joint": []}, "joint is []; it must be one of universal"),
        ("time", {"kind": "hop"}, "kind is 'hop'; it must be one of harmonic"),
        ("time", {"kind": "step", "pulse": -1}, "pulse is -1; it must be a number from"),
    ],
)
def test_a_wrong_job_says_why_and_the_process_lives_on(kind: str, spec: dict[str, Any], words: str, job: Work) -> None:
    assert words in job.failure(kind, **spec)
    assert job("slice", box=BOX, across="x", up="y", side=2)[-1][0]["type"] == "done"


def test_a_fault_of_ours_is_named_to_the_page_and_traced_on_the_terminal(
    job: Work, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def broken(spec: dict[str, Any]) -> Iterator[Any]:
        raise ZeroDivisionError("of ours")
        yield

    monkeypatch.setitem(work.KINDS, "slice", broken)
    assert job.failure("slice") == "internal error (ZeroDivisionError); see the server"
    assert "ZeroDivisionError: of ours" in capfd.readouterr().err


def test_a_fault_within_a_simulation_reaches_the_job(job: Work, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*given: Any, **options: Any) -> Any:
        raise MemoryError

    monkeypatch.setattr("flexapod.simulation.time_simulation.simulate", broken)
    assert "MemoryError" in job.failure("time", duration=0.01)


def test_numbers_too_large_to_compute_with_are_not_told_on_the_terminal(
    job: Work, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def absurd(asked: dict[str, Any]) -> Iterator[tuple[dict[str, Any], bytes]]:
        yield {"type": "rows"}, (np.array([1e308]) * 10).astype("<f4").tobytes()

    monkeypatch.setitem(work.KINDS, "cloud", absurd)
    rows, done = job("cloud")
    assert done[0]["type"] == "done"
    assert np.frombuffer(rows[1], "<f4") == np.inf
    assert capfd.readouterr().err == ""


def test_a_job_whose_page_has_gone_ends_its_loop() -> None:
    ours, theirs = multiprocessing.Pipe()
    ours.send(("slice", as_bytes(ASKED | {"box": BOX, "across": "x", "up": "y", "side": 2})))
    thread = threading.Thread(target=work.serve, args=(theirs,))
    ours.close()
    thread.start()
    thread.join(timeout=60)
    assert not thread.is_alive()


def kill(processes: list[BaseProcess]) -> None:
    for process in processes:
        assert process.pid is not None
        os.kill(process.pid, signal.SIGKILL)
        assert wait([process.sentinel], 60)  # gone, and nobody has asked for its end


@pytest.mark.parametrize("when", ["idle", "at work"])
def test_a_process_that_dies_is_told_or_replaced(when: str) -> None:
    """As where the system kills one that takes all memory."""
    spec = ASKED | {"box": BOX, "points": 100} if when == "idle" else LONG

    async def messages() -> list[bytes]:
        jobs, found = Jobs(), []
        await jobs.pool.warm()
        processes = [worker.process for worker in jobs.pool.idle]
        try:
            if when == "idle":
                kill(processes)
            async for part in jobs.run(Client("127.0.0.1"), "cloud" if when == "idle" else "time", as_bytes(spec)):
                if when == "at work" and len(found) == 1:  # it has begun to tell
                    kill(processes)
                found.append(part)
        finally:
            jobs.pool.close()
        return found

    last = apart(messages())[-1]
    assert (b"the process of this job died" in last) == (when == "at work")
    assert (b"done" in last) == (when == "idle")


def test_shaking_the_base_moves_the_platform_as_the_library_says() -> None:
    omega = 0.7 * float(fx.stability_index(MACHINE, POSE))
    found = response.shake(ASKED | {"axis": "y", "omega": omega})
    moved = fx.transmissibility(MACHINE, POSE, omega=[omega])["absolute"].to_numpy()[0, :, 1]
    np.testing.assert_array_equal(found["platform"]["real"] + 1j * found["platform"]["imag"], moved)
    np.testing.assert_array_equal(found["base"], np.eye(6)[1])
    assert found["ratio"] == abs(moved[1]) > 1
    arms = np.linalg.norm(MACHINE.platform_joints, axis=1).max()
    drawn = found["reach"] * np.linalg.norm(np.abs(moved[:3]))
    assert 0.1 * response.DRAWN * arms < drawn <= response.DRAWN * arms  # seen, and no farther than it should


def test_a_design_without_a_home_stands_at_a_usual_height() -> None:
    """Where legs have limits, in the middle of them."""
    free = MACHINE.replace({"home": None})
    x, y, z, *turn = pose_ranges.home(free)
    assert turn == [0.0, 0.0, 0.0]
    assert z > 0
    limited = free.replace({"limits.leg_length": [0.09, 0.11]})
    pose = fx.Pose(pose_ranges.home(limited)[:3])
    assert fx.inverse_kinematics(limited, pose).mean() == pytest.approx(0.1, rel=0.02)
    assert [x, y] == pose_ranges.home(limited)[:2]


def test_a_pose_that_is_not_stable_at_rest_is_said_to_be(monkeypatch: pytest.MonkeyPatch) -> None:
    from flexapod.web import state

    heavy = {"platform.mass": 1e7, "platform.mass_center": [0, 0, 0.3]}  # it topples on its springs
    found = state.snapshot(MACHINE.replace(heavy), ASKED["pose"])
    assert "Not stable at rest" in found["grave"][0]


def test_only_pages_are_answered() -> None:
    """A web socket is not: the page opens none."""
    reached = []

    async def app(scope: Any, receive: Any, send: Any) -> None:
        reached.append(scope["type"])

    guard = Guard(app)
    apart(guard({"type": "websocket"}, None, None))  # type: ignore[arg-type]
    assert reached == []
    apart(guard({"type": "lifespan"}, None, None))  # type: ignore[arg-type]
    assert reached == ["lifespan"]


def test_numbers_that_json_has_not_are_null() -> None:
    found = as_json({"a": np.array([1.0, np.nan]), "b": np.float64(np.inf), "c": (1, "x"), "d": np.arange(2)})
    assert found == b'{"a":[1.0,null],"b":null,"c":[1,"x"],"d":[0,1]}'


def test_what_is_told_of_a_recording_reaches_the_page(job: Work) -> None:
    """That it begins off zero, for instance."""
    csv = "time,z_mm\n" + "\n".join(f"{t},{1 + t}" for t in np.linspace(0, 0.02, 50))
    run = next(m for m, _ in job("time", kind="csv", csv=csv, duration=0.02) if m["type"] == "run")
    assert "The recording of base_motion z begins at 0.001 m in its first row, off zero" in run["words"]
