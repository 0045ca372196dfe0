"""`flexapod sweep` as it is used: from a shell."""

import json
import os
import signal
import socket
import subprocess
import sys
import time

import numpy as np
import pytest
from tests.helpers.plain import file

import flexapod as fx
from flexapod.cli import main

BASE = file("motion-base")  # legs of any length
I = fx.load("mukherjee-i")


def run(capsys, *arguments):
    """Exit code, standard output and standard error of a command in this process."""
    code = main([str(a) for a in arguments])
    said = capsys.readouterr()
    return code, said.out, said.err


def test_summary_in_words_and_in_json(capsys):
    given = ("sweep", "mukherjee-i", "--around", 0.05, 10, "--points", 2000, "--seed", 3, "--at-least", 200)
    code, words, _ = run(capsys, *given)
    assert code == 0
    code, text, _ = run(capsys, *given, "--json", "--worst")
    assert code == 0
    found = json.loads(text)
    box = fx.Box.about(fx.home_pose(I), 0.05, np.radians(10))
    expected = fx.summarise(fx.sweep(I, fx.random_poses(box, 2000, seed=3)), 200.0)
    assert found["summary"]["worst"]["omega_1"] == expected.worst.omega_1
    assert found["summary"]["worst"]["pose"]["yaw"] == expected.worst.pose[5]
    assert found["summary"]["above"]["fraction"] == expected.above.fraction
    assert found["worst_pose"]["omega_1"] < expected.worst.omega_1
    assert f"{expected.worst.omega_1:.5g}" in words
    assert f"{expected.correlation:.3f}" in words


def test_box_and_what_it_leaves_out(capsys):
    code, text, _ = run(
        capsys, "sweep", "mukherjee-i", "--box", "x=-0.1:0.1,yaw=-10:20", "--box", "z=0.9", "--points", 10, "--json"
    )
    assert code == 0
    box = json.loads(json.loads(text)["attributes"]["poses"])["box"]
    assert box["x"] == [-0.1, 0.1]
    assert box["yaw"] == [np.radians(-10), np.radians(20)]
    assert box["z"] == [0.9, 0.9]
    assert box["y"] == [0.2, 0.2]  # home


def test_grid_to_netcdf_and_a_figure(tmp_path, capsys):
    import xarray as xr

    out, figure = tmp_path / "map.nc", tmp_path / "map.png"
    grid = "x=-0.1:0.3:5,y=0:0.4:4,z=0.8"
    code, _, _ = run(
        capsys, "sweep", "mukherjee-i", "--grid", grid, "--quantities", "all", "--out", out, "--figure", figure
    )
    assert code == 0
    found = xr.load_dataset(out)
    assert dict(found.sizes) == {"x": 5, "y": 4, "mode": 6, "leg": 6}
    assert figure.read_bytes().startswith(b"\x89PNG")


def test_poses_of_a_file(tmp_path, capsys):
    rows = np.array([[0.1, 0.2, 0.8, 0, 0, 10], [0.1, 0.2, 0.9, 5, 0, 0]])
    (tmp_path / "poses.csv").write_text("x,y,z,roll,pitch,yaw\n" + "\n".join(",".join(map(str, r)) for r in rows))
    np.save(tmp_path / "poses.npy", rows)
    lowest = []
    for name in ("poses.csv", "poses.npy"):
        code, text, _ = run(capsys, "sweep", "mukherjee-i", "--poses", tmp_path / name, "--json")
        assert code == 0
        lowest.append(json.loads(text)["summary"]["worst"]["omega_1"])
    pose = fx.Pose.from_rpy(*rows[:, :3].T, *np.radians(rows[:, 3:]).T)
    assert lowest == [pytest.approx(fx.stability_index(I, pose).min(), rel=1e-12)] * 2


def test_poses_beyond_the_limits_do_not_count(tmp_path, capsys):
    given = ("sweep", BASE, "--around", 0.67, 24, "--points", 2000, "--worst", "--quantities", "omega_1")
    code, words, _ = run(capsys, *given)
    assert code == 0
    found = {}
    for option in ((), ("--all-poses",)):
        code, text, _ = run(
            capsys, *given, *option, "--json", "--figure", tmp_path / "cloud.png", "--quantities", "all"
        )
        assert code == 0
        found[option] = json.loads(text)
    inside, everything = found.values()
    share = f"within the design's limits: {inside['summary']['within_limits']} of 2000 poses"
    assert share in " ".join(words.split())
    assert "worst of the box within the limits" in words
    assert inside["summary"]["within_limits"] == everything["summary"]["within_limits"] < 400
    for part in ("summary", "worst_pose"):
        least = [one[part]["worst"] if part == "summary" else one[part] for one in (inside, everything)]
        assert 23.9 < least[0]["omega_1"] < 25.5
        assert least[1]["omega_1"] < 22
    assert inside["worst_pose"]["at_limits"]
    code, _, said = run(capsys, "sweep", BASE, "--grid", "z=3.5:3.6:3", "--json")
    assert code == 2
    assert "none of the 3 poses is within the design's limits" in said
    code, _, _ = run(capsys, "sweep", BASE, "--grid", "z=3.5:3.6:3", "--all-poses")
    assert code == 0


@pytest.mark.parametrize(
    "poses", [("--grid", "z=3.5:3.6:3"), ("--box", "z=3.5:3.6,roll=0:1", "--points", 500, "--worst")]
)
def test_what_was_written_is_told_where_no_pose_is_within_the_limits(poses, tmp_path, capsys):
    for name in ("far.csv", "far.zarr"):
        given = ("sweep", BASE, *poses, "--out", tmp_path / name, "--figure", tmp_path / "far.png")
        code, text, _ = run(capsys, *given, "--json")
        assert code == 0
        found = json.loads(text)
        assert "summary" not in found
        assert "worst_pose" not in found
        assert any(f"{name} was written, but none of the " in words for words in found["warnings"])
        assert (tmp_path / name).exists()
        (tmp_path / name).rename(tmp_path / f"kept-{name}")
        code, text, _ = run(capsys, *given)
        assert code == 0
        assert "is within the design's limits" in " ".join(text.split())


def test_a_store_of_a_design_with_limits_is_resumed_by_the_same_command(tmp_path, capsys):
    given = ("sweep", "motion-base", *AROUND, "--points", 1000, "--out", tmp_path / "map.zarr")
    for option in ((), ("--resume",), ("--resume", "--all-poses")):
        code, _, said = run(capsys, *given, *option)
        assert code == 0, said
    assert "within_limits" in fx.open_sweep(tmp_path / "map.zarr")


AROUND = ("--around", "0.05", "10")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "give one set of poses"),
        ((*AROUND, "--grid", "x=0:1:3"), "give one set of poses"),
        ((*AROUND, "--box", "x=0:1"), "Leave one of them out"),
        (("--box", "x=0.2:-0.1"), "x is from 0.2 to -0.1 m"),
        (("--box", "w=0:1"), "--box w=0:1"),
        (("--box", "x=0:1,x=0:2"), "gives x twice"),
        (("--box", "x=0:1:2"), "is no range"),
        (("--box", "x=a:b"), "--box x: 'a' is not a number with a unit of length"),
        (("--grid", "x=0:1"), "is no axis"),
        (("--grid", "x=0:1:0"), "at least 1"),
        (("--grid", "x=0:1:3", "--points", "5"), "go with --box or --around"),
        (("--grid", "x=0:1:3", "--worst"), "--worst looks for"),
        ((*AROUND, "--points", "0"), "--points"),
        ((*AROUND, "--quantities", "omega_9"), "quantity is 'omega_9'"),
        ((*AROUND, "--resume"), "Give --out NAME.zarr"),
        ((*AROUND, "--out", "map.xyz"), "must end in .zarr"),
        ((*AROUND, "--out", "none/map.nc"), "is no directory"),
        ((*AROUND, "--points", "1000000000", "--out", "map.csv"), "Stream to a store instead: map.zarr"),
        ((*AROUND, "--points", "1000000000"), "GiB"),
        ((*AROUND, "--out", "none/map.zarr"), "is no directory"),
        ((*AROUND, "--out", "none.zarr", "--resume"), "there is no sweep"),
        ((*AROUND, "--figure", "map.xyz", "--points", "10"), "Choose .png"),
    ],
)
def test_a_wrong_command_line_is_told(arguments, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    code, _, said = run(capsys, "sweep", "mukherjee-i", *arguments)
    assert code == 2
    assert words in " ".join(said.split())
    assert not [path for path in tmp_path.rglob("*") if path.is_file()]


def test_empty_and_broken_files_of_poses_are_told(tmp_path, capsys):
    for text, words in (
        ("", "nothing in it"),
        ("x,y,z,roll,pitch,yaw\n", "empty"),
        ("1,2,3\n", "6 columns"),
        ("a,b\n1,2", "'a' is unknown. Give rows of six columns"),
    ):
        path = tmp_path / "poses.csv"
        path.write_text(text)
        code, _, said = run(capsys, "sweep", "mukherjee-i", "--poses", path)
        assert code == 2
        assert words in said


def test_a_changed_design_or_box_is_refused_by_name(tmp_path, capsys):
    out = ("--out", tmp_path / "map.zarr")
    code, _, _ = run(capsys, "sweep", "mukherjee-i", *AROUND, "--points", 1000, *out)
    assert code == 0
    code, _, said = run(capsys, "sweep", "mukherjee-i", *AROUND, "--points", 1000, *out)
    assert code == 2
    assert "exists already" in said
    assert "cannot be written" not in said
    code, _, said = run(capsys, "sweep", "mukherjee-ii", *AROUND, "--points", 1000, *out, "--resume")
    assert code == 2
    for word in ("'mukherjee-i'", I.digest, "'mukherjee-ii'", fx.load("mukherjee-ii").digest):
        assert word in said
    code, _, said = run(capsys, "sweep", "mukherjee-i", "--around", 0.05, 11, "--points", 1000, *out, "--resume")
    assert code == 2
    assert "another poses" in said
    code, _, _ = run(capsys, "sweep", "mukherjee-i", *AROUND, "--points", 1000, *out, "--resume")
    assert code == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_cleanly_and_resume_goes_on(tmp_path, number, capsys):
    path = tmp_path / "map.zarr"
    command = ["sweep", "mukherjee-i", *AROUND, "--points", "2000000", "--chunk", "80000", "--no-summary"]
    command += ["--out", str(path)]
    with subprocess.Popen([sys.executable, "-m", "flexapod", *command], stderr=subprocess.PIPE, text=True) as process:
        while not (path / "omega_1" / "c" / "3").exists():
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(number)
        said = process.communicate(timeout=120)[1]
    assert process.returncode == 128 + number
    assert "Go on with the same command and --resume" in said
    assert "Traceback" not in said
    pending = fx.open_sweep(path).status.values == 255
    assert 0 < pending.sum() < 2_000_000
    code, _, said = run(capsys, *command, "--resume")
    assert code == 0
    assert "2000000 poses in" in said
    assert (fx.open_sweep(path).status.values == 0).all()


def test_progress_shows_rate_and_time_left(tmp_path, capsys):
    from flexapod.cli.output.progress import PoseProgress
    from flexapod.workspace.store.store import Progress

    with PoseProgress() as bar:
        bar(Progress(1_000_000, 2_000_000, 500_000, {0: 499_990, 3: 10}))
    said = capsys.readouterr().err
    for words in ("1 M of 2 M poses", "50%", "poses/s", "left", "10 not ok"):
        assert words in said


def test_scheduler_and_workers_from_the_shell(tmp_path):
    """The commands of docs/cluster.md."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", port]
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", f"tcp://127.0.0.1:{port}", "--nthreads", "1"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
    started = [
        subprocess.Popen([*dask, "--dashboard-address", ":0"], **quiet),
        subprocess.Popen([*worker, "--dashboard-address", ":0"], **quiet),
    ]
    try:
        out = tmp_path / "map.zarr"
        command = ["sweep", "mukherjee-i", *AROUND, "--points", "3000", "--chunk", "1000", "--out", str(out)]
        deadline = time.monotonic() + 180
        while True:
            ended = subprocess.run(
                [sys.executable, "-m", "flexapod", *command, "--scheduler", f"tcp://127.0.0.1:{port}"],
                capture_output=True,
                text=True,
                check=False,
            )
            if ended.returncode == 0 or time.monotonic() > deadline:
                break
        assert ended.returncode == 0, ended.stderr
    finally:
        for process in reversed(started):
            process.send_signal(signal.SIGTERM)
            process.wait(60)
    assert (fx.open_sweep(out).status.values == 0).all()


def test_no_scheduler_there(tmp_path, capsys):
    out, nobody = tmp_path / "map.zarr", ("--scheduler", "tcp://127.0.0.1:9", "--timeout", "500ms")
    code, _, said = run(capsys, "sweep", "mukherjee-i", *AROUND, "--out", out, *nobody)
    assert code == 2
    assert "no Dask scheduler answers at tcp://127.0.0.1:9" in said
    assert not out.exists()


def test_import_stays_light():
    code = (
        "import sys, flexapod; "
        "heavy = {'numpy', 'scipy', 'xarray', 'zarr', 'dask', 'distributed', 'matplotlib', 'rich', 'pandas'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    env = {**os.environ, "PYTHONWARNINGS": "error"}
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=env)
    assert ended.stdout.strip() == "[]"
