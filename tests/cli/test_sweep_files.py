"""`flexapod sweep`: files of poses and of results, and any size and stream that a shell may give it."""

import io
import json
import subprocess
import sys

import numpy as np
import pandas
import pytest

import flexapod as fx
from flexapod.cli import main
from flexapod.workspace.store.file_formats import save

I = fx.load("mukherjee-i")
AROUND = ("--around", "0.05", "10")


def run(capsys, *arguments):
    """Exit code, standard output and standard error of a command in this process."""
    code = main([str(a) for a in arguments])
    said = capsys.readouterr()
    return code, said.out, said.err


def sweep_of(capsys, *arguments):
    """The worst index and its pose, of a sweep of manipulator I."""
    code, text, said = run(capsys, "sweep", "mukherjee-i", *arguments, "--json")
    assert code == 0, said
    return json.loads(text)["summary"]["worst"]


def test_what_a_sweep_writes_is_read_as_the_same_poses(tmp_path, capsys):
    table, again = tmp_path / "poses.csv", tmp_path / "again.csv"
    quantities = ("--quantities", "all")
    for given in ((*AROUND, "--points", 50), ("--grid", "x=0:0.1:3,roll=-5:5:4,yaw=10")):
        first = sweep_of(capsys, *given, *quantities, "--out", table)
        assert sweep_of(capsys, "--poses", table, *quantities, "--out", again)["omega_1"] == first["omega_1"]
        texts = [[line for line in file.read_text().splitlines() if line[0] != "#"] for file in (table, again)]
        assert texts[0] == texts[1]
        assert texts[0][0].startswith("x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,omega_1_rad_per_s,")


@pytest.mark.parametrize(
    ("titles", "row"),
    [
        ("x,y,z,roll,pitch,yaw", "0.05,0.2,0.89,0,0,10"),
        ("x,y,z,yaw,pitch,roll", "0.05,0.2,0.89,10,0,0"),
        ("yaw_deg,roll_rad,pitch_mrad,z_m,y_mm,x_mm", "10,0,0,0.89,200,50"),
        ("yaw_rad;X [mm];y;z;Roll;Pitch", "0,174532925199432957;50;0,2;0,89;0;0"),
    ],
)
def test_columns_of_poses_are_read_by_their_names_and_units(titles, row, tmp_path, capsys):
    path = tmp_path / "poses.csv"
    path.write_text(f"{titles}\n{row}\n")
    expected = fx.stability_index(I, fx.Pose.from_rpy(0.05, 0.2, 0.89, 0, 0, np.radians(10)))
    assert sweep_of(capsys, "--poses", path)["omega_1"] == pytest.approx(float(expected), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x,y,z,roll,pitch,yaw,omega_1\n0,0.2,0.89,0.1,0,0,1\n", "column 'roll' names no unit"),  # a sweep of 0.1
        ("x,y,z,roll,pitch,yaw,mass\n0,0.2,0.89,0,0,0,1\n", "column 'mass' is unknown"),
        ("x,foo,bar,1,2,3\n0,0.2,0.89,0,0,0\n", "column 'foo' is unknown"),
        ("x,y,z,roll,pitch\n0,0.2,0.89,0,0\n", "there is no column yaw"),
        ("x,y,z,roll_m,pitch,yaw\n0,0.2,0.89,0,0,0\n", "column 'roll_m' has the unit 'm'"),
    ],
)
def test_poses_whose_columns_are_not_clear_are_refused(text, words, tmp_path, capsys):
    (tmp_path / "poses.csv").write_text(text)
    code, _, said = run(capsys, "sweep", "mukherjee-i", "--poses", tmp_path / "poses.csv")
    assert code == 2
    assert words in said


def npy_files():
    yield "empty", b"", "cannot be read"
    for name, rows in {
        "complex": np.ones((2, 6), complex),
        "dates": np.full((2, 6), np.datetime64("2026-01-01")),
        "flags": np.ones((2, 6), bool),
        "records": np.zeros(2, [(name, float) for name in "abcdef"]),
        "texts": np.full((2, 6), "a"),
        "shape": np.zeros((2, 5)),
        "none": np.zeros((0, 6)),
    }.items():
        stream = io.BytesIO()
        np.save(stream, rows)
        yield name, stream.getvalue(), {"shape": "has shape (2, 5)", "none": "holds no pose"}.get(name, "real numbers")
    stream = io.BytesIO()
    np.savez(stream, a=np.zeros((2, 6)))
    yield "npz", stream.getvalue(), "several arrays"
    yield "cut", b"\x93NUMPY\x01\x00v\x00{'descr'", "cannot be read"


@pytest.mark.parametrize(
    ("name", "content", "words"), [*npy_files()], ids=lambda value: value if isinstance(value, str) else ""
)
def test_arrays_that_are_no_poses_are_refused(name, content, words, tmp_path, capsys):
    path = tmp_path / f"{name}.npy"
    path.write_bytes(content)
    code, _, said = run(capsys, "sweep", "mukherjee-i", "--poses", path)
    assert code == 2
    assert words in said
    assert "columns x,y,z,roll,pitch,yaw" in said


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--grid", "x=0:1:99999999999"), "at most 10000000"),
        (("--grid", "x=0:1:²"), "is no axis"),
        (("--grid", "x=0:1:" + "9" * 400), "at most 10000000"),
        (("--grid", "x=0:1:9999999,y=0:1:9999999"), "poses are too many"),
        ((*AROUND, "--points", "9" * 400), "Invalid value for '--points'"),
        ((*AROUND, "--points", "9" * 400, "--out", "map.zarr"), "Invalid value for '--points'"),
        (
            (*AROUND, "--points", "9999999999", "--low-discrepancy"),
            "--points is 9999999999; --low-discrepancy has 4294967296",
        ),
        ((*AROUND, "--points", "99999999999"), "GiB"),
        ((*AROUND, "--points", "99999999999", "--chunk", "1", "--out", "map.zarr"), "blocks"),
    ],
)
def test_sizes_are_estimated_before_memory_is_asked_for(arguments, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    code, _, said = run(capsys, "sweep", "mukherjee-i", *arguments)
    assert code == 2
    assert words in said
    assert len(said) < 1200
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252", "ascii", "latin-1"])
def test_any_encoding_of_the_output_will_do(encoding, monkeypatch):
    there = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr(sys, "stdout", there)
    assert main(["sweep", "mukherjee-i", *AROUND, "--points", "1000", "--at-least", "60"]) == 0
    there.flush()
    text = there.buffer.getvalue().decode(encoding)
    assert ("ω1 ≥ 60 rad/s" if encoding == "utf-8" else "w1 >= 60 rad/s") in text
    assert "?" not in text


@pytest.mark.parametrize("columns", [{}, {"COLUMNS": "30"}])
def test_no_number_of_a_table_is_cut(columns, capsys, monkeypatch):
    """The condition number at a pose on the edge of singular is long, and so are coordinates."""
    monkeypatch.delenv("COLUMNS", raising=False)
    for name, width in columns.items():
        monkeypatch.setenv(name, width)
    code, said, _ = run(capsys, "sweep", "mukherjee-i", "--around", "0.1", "20", "--points", "200000")
    assert code == 0
    assert "…" not in said
    assert "..." not in said
    found = fx.summarise(fx.sweep(I, fx.random_poses(fx.Box.about(fx.home_pose(I), 0.1, np.radians(20)), 200_000)))
    assert f"{found.worst_conditioned.cond_H:.4g}" in said
    assert "worst" in said


def test_the_head_of_a_table_is_short(tmp_path, capsys):
    sweep_of(capsys, "--grid", "x=-0.1:0.3:81,y=0:0.4:81", "--out", tmp_path / "map.csv")
    head = [line for line in (tmp_path / "map.csv").read_text().splitlines() if line.startswith("#")]
    assert max(map(len, head)) < 400
    uneven = fx.sweep(I, fx.pose_grid(x=np.geomspace(0.01, 0.2, 500)))
    save(uneven, tmp_path / "uneven.csv")
    head = [line for line in (tmp_path / "uneven.csv").read_text().splitlines() if line.startswith("#")]
    assert max(map(len, head)) < 400
    assert np.array_equal(pandas.read_csv(tmp_path / "uneven.csv", comment="#").x_m, np.geomspace(0.01, 0.2, 500))


def test_a_file_that_may_not_be_written_stays(tmp_path, capsys):
    path = tmp_path / "mine.csv"
    path.write_text("mine")
    path.chmod(0o444)
    code, _, said = run(capsys, "sweep", "mukherjee-i", *AROUND, "--points", 10, "--out", path)
    assert code == 2
    assert "may not be written to" in said
    assert path.read_text() == "mine"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--figure", "map.foo"), "Choose .png"),
        (("--figure", "none/map.png"), "is no directory"),
        (("--figure", "map.png", "--quantities", "omega_1"), "needs the quantity cond_H"),
        (("--figure", "map.png", "--quantities", "leg_length"), "needs the quantity omega_1 and cond_H"),
    ],
)
def test_a_figure_that_cannot_be_is_told_before_the_work(arguments, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("flexapod.cli.studies.sweep.sweep", lambda *given, **more: pytest.fail("it was computed"))
    code, _, said = run(capsys, "sweep", "mukherjee-i", *AROUND, *arguments)
    assert code == 2
    assert words in said


def test_a_full_disk_ends_a_netcdf_file_with_a_sentence(small_disk):
    command = ["sweep", "mukherjee-i", *AROUND, "--points", "60000", "--out", str(small_disk / "map.nc")]
    ended = subprocess.run([sys.executable, "-m", "flexapod", *command], capture_output=True, text=True, check=False)
    assert ended.returncode == 2
    assert "map.nc cannot be written: No space left on device" in ended.stderr
    assert not list(small_disk.iterdir())
