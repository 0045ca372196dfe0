"""The command kinematics: lengths to poses and back, all assemblies, and rows that have no answer."""

import csv
import io

import numpy as np
import pytest
from tests.helpers.cases import case

import flexapod as fx

LEGS = [f"leg{k}_mm" for k in range(1, 7)]
POSES = fx.Pose.from_rpy(
    [0, 0.1, -0.2], [0, 0.05, 0], [2.39, 2.4, 2.5], [0, 2, -5], [0, 0, 3], [0, 10, 0], degrees=True
)


@pytest.fixture
def table(run):
    """The rows of the CSV that a command prints, and what it says beside it."""

    def call(*arguments):
        code, out, err = run("kinematics", *arguments)
        assert code == 0, err
        return list(csv.DictReader(io.StringIO(out))), err

    return call


@pytest.fixture
def lengths(tmp_path):
    """A log of leg lengths with its times, in mm; rows 3 and 5 of the file have no pose."""
    rows = (1e3 * fx.inverse_kinematics(fx.load("motion-base"), POSES)).tolist()
    rows.insert(1, [27000, *rows[0][1:]])
    rows.insert(3, ["", *rows[0][1:]])
    file = tmp_path / "lengths.csv"
    lines = [",".join(["time", *LEGS]), *(",".join(map(str, [k / 100, *row])) for k, row in enumerate(rows))]
    file.write_text("\n".join(lines))
    return file


def test_lengths_give_poses_and_bad_rows_are_told(table, lengths):
    rows, err = table("motion-base", lengths)
    assert [row["status"] for row in rows] == ["found", "not_found", "found", "wrong_lengths", "found"]
    assert [row["line"] for row in rows] == ["2", "3", "4", "5", "6"]
    assert [float(row["t_s"]) for row in rows] == [0, 0.01, 0.02, 0.03, 0.04]
    good = [row for row in rows if row["status"] == "found"]
    place = [[float(row[f"{axis}_m"]) for axis in "xyz"] for row in good]
    turn = [[float(row[f"{axis}_deg"]) for axis in ("roll", "pitch", "yaw")] for row in good]
    np.testing.assert_allclose(place, POSES.position, atol=1e-9)
    np.testing.assert_allclose(turn, np.degrees(POSES.rpy), atol=1e-8)
    assert [row["x_m"] + row["yaw_deg"] for row in rows if row["status"] != "found"] == ["", ""]
    assert "1 of 5 rows: not_found, line 3." in err
    assert "1 of 5 rows: wrong_lengths, line 5." in err


def test_poses_give_lengths_back(run, table, lengths, tmp_path):
    """What is written is read again: poses from lengths, lengths from poses, in any order of rotation."""
    for more in ((), ("--rotation-order", "ZXZ"), ("--rotation-order", "XYZ", "--pivot", 0.1, 0, -0.2)):
        code, out, _ = run("kinematics", "motion-base", lengths, "--out", tmp_path / "poses.csv", *more)
        assert (code, out) == (0, "")
        rows, err = table("motion-base", tmp_path / "poses.csv")
        found = np.array([[float(row[f"leg{k}_m"] or "nan") for k in range(1, 7)] for row in rows])
        expected = fx.inverse_kinematics(fx.load("motion-base"), POSES)
        np.testing.assert_allclose(found[[0, 2, 4]], expected, rtol=1e-10)
        assert [row["status"] for row in rows] == ["ok", "not_finite", "ok", "not_finite", "ok"]
        assert "2 of 5 rows: not_finite, lines 3, 5." in err


def test_all_assemblies(table, lengths):
    rows, err = table("motion-base", lengths, "--all")
    machine = fx.load("motion-base")
    every = fx.forward_kinematics_all(machine, fx.inverse_kinematics(machine, POSES))
    assert len(rows) == len(every.row)
    first = [row for row in rows if row["assembly"] == "1"]
    assert [row["line"] for row in first] == ["2", "4", "6"]
    np.testing.assert_allclose([float(row["x_m"]) for row in first], POSES.position[:, 0], atol=1e-8)
    assert {row["side"] for row in rows} == {"1", "-1"}
    assert "no real assembly has the lengths of line 3." in err


def test_dietmaiers_forty_by_one_command(result, tmp_path):
    file = tmp_path / "lengths.csv"
    file.write_text("leg1,leg2,leg3,leg4,leg5,leg6\n1,0.645275,1.086284,1.503439,1.281933,0.771071\n")
    found = result("kinematics", case("dietmaier", "dietmaier.toml"), file, "--all")
    assert len(found["rows"]) == 40
    assert {row["status"] for row in found["rows"]} == {"complete"}


def test_a_start_and_limits(result, lengths):
    below = result("kinematics", "motion-base", lengths, "--start", 0, 0, -2.4, 0, 0, 0)
    assert below["rows"][0]["z_m"] == pytest.approx(-2.39)
    above = result("kinematics", "motion-base", lengths)
    assert [row["within_limits"] for row in above["rows"]] == [1, 0, 1, 0, 1]


def test_poses_that_break_limits_are_told(run, lengths, tmp_path):
    """Beside the table, whichever way it converts; nothing where all keep them."""
    stroke = ["--set", "limits.leg_length=[2.3, 2.75]"]
    code, out, err = run("kinematics", "motion-base", lengths, *stroke)
    kept = [row["within_limits"] for row in csv.DictReader(io.StringIO(out)) if row["status"] == "found"]
    told = f"{kept.count('0')} of 3 poses break the design's limits"
    assert code == 0
    assert "0" in kept
    assert told in err
    (tmp_path / "poses.csv").write_text(out)
    assert told in run("kinematics", "motion-base", tmp_path / "poses.csv", *stroke)[2]
    assert "break" not in run("kinematics", "motion-base", lengths, "--set", "limits.leg_length=[0.1, 9.0]")[2]


def test_poses_may_count_from_home(run, result, lengths, tmp_path):
    """Those that are found, those of a file, and the start; for a home that is turned, too."""
    for more in ((), ("--set", "home.orientation_deg=[4, -3, 20]")):
        code, out, _ = run("kinematics", "motion-base", lengths, "--from-home", *more)
        assert code == 0
        (tmp_path / "moved.csv").write_text(out)
        rows = [row for row in csv.DictReader(io.StringIO(out)) if row["status"] == "found"]
        there = np.array([[float(row[f"{axis}_m"]) for axis in "xyz"] for row in rows])
        np.testing.assert_allclose(there, POSES.position - [0, 0, 2.39], atol=1e-9)
        code, out, _ = run("kinematics", "motion-base", tmp_path / "moved.csv", "--from-home", *more)
        back = [float(row["leg1_m"]) for row in csv.DictReader(io.StringIO(out)) if row["status"] == "ok"]
        np.testing.assert_allclose(back, fx.inverse_kinematics(fx.load("motion-base"), POSES)[:, 0], rtol=1e-10)
    below = result("kinematics", "motion-base", lengths, "--from-home", "--start", 0, 0, -4.79, 0, 0, 0)
    assert below["rows"][0]["z_m"] == pytest.approx(-4.78)
    code, _, err = run("kinematics", case("dietmaier", "dietmaier.toml"), lengths, "--from-home")
    assert (code, "names no home pose for --from-home" in err) == (2, True)


def test_what_is_written_is_read_by_every_command_that_takes_poses(run, result, tmp_path):
    """A log of lengths becomes a path and a sweep, and what counts from home is not taken for poses in the base."""
    rows = np.column_stack([[0.0, 0.5, 1.0], fx.inverse_kinematics(fx.load("motion-base"), POSES[:3])])
    log = tmp_path / "log.csv"
    log.write_text("t,leg1,leg2,leg3,leg4,leg5,leg6\n" + "".join(",".join(map(str, row)) + "\n" for row in rows))
    for more, name in (((), "base.csv"), (("--from-home",), "home.csv")):
        assert run("kinematics", "motion-base", log, *more, "--out", tmp_path / name)[0] == 0
    along = [result("path", "motion-base", tmp_path / name, *more) for name, more in (
        ("base.csv", ()), ("home.csv", ("--from-home",)))]  # fmt: skip
    assert along[0]["least_index_rad_s"] == pytest.approx(along[1]["least_index_rad_s"], rel=1e-9)
    assert result("sweep", "motion-base", "--poses", tmp_path / "base.csv")["summary"]["poses"] == 3
    for command, name, more, words in (
        (("kinematics", "motion-base"), "home.csv", (), "Give --from-home."),
        (("path", "motion-base"), "home.csv", (), "Give --from-home."),
        (("sweep", "motion-base", "--poses"), "home.csv", (), "Measure them from the base."),
    ):
        code, _, err = run(*command, tmp_path / name, *more)
        assert code == 2
        assert f"measured from home, and is taken from base. {words}" in " ".join(err.split())
    base = (tmp_path / "home.csv").read_text().replace(",home,", ",base,")
    (tmp_path / "base.csv").write_text(base)
    code, _, err = run("path", "motion-base", tmp_path / "base.csv", "--from-home")
    assert (code, "taken from home. Leave --from-home out." in " ".join(err.split())) == (2, True)


@pytest.mark.parametrize(
    ("text", "more", "words"),
    [
        ("leg1,leg2\n1,2\n", (), "no column leg3, leg4, leg5, leg6"),
        ("leg1_kg,leg2,leg3,leg4,leg5,leg6\n1,1,1,1,1,1\n", (), "unit 'kg'"),
        ("leg1,leg2,leg3,leg4,leg5,leg6,x\n1,1,1,1,1,1,1\n", (), "columns of legs and of poses"),
        ("leg1,leg2,leg3,leg4,leg5,leg6\n1,1,1,one,1,1\n", (), "line 2, column leg4: 'one' is no number"),
        ("x,y,z,roll,pitch,yaw\n0,0,2,0,0,0\n", ("--all",), "--all gives all poses of leg lengths"),
        ("", (), "there is nothing in it"),
    ],
)
def test_files_that_are_neither(run, tmp_path, text, more, words):
    (tmp_path / "file.csv").write_text(text)
    code, out, err = run("kinematics", "motion-base", tmp_path / "file.csv", *more)
    assert (code, out) == (2, "")
    assert words in " ".join(err.split())
