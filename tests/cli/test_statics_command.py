"""The command statics: elevations, tables of cases, and what is wrong with them."""

import csv
import io
import re

import numpy as np
import pytest
import xarray as xr

import flexapod as fx
from flexapod.mechanics import gravity_at
from flexapod.plots.statics import _together

ELEVATIONS = np.array([90.0, 75, 60, 45, 30, 15])


def rows(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_elevations_of_a_telescope(result, run, tmp_path):
    line = [
        "statics",
        "motion-base",
        "--elevation",
        "90:15:6",
        "--base-roll",
        10,
        "--reference",
        90,
        "--point",
        0,
        0,
        "500mm",
    ]
    found = result(*line, "--out", tmp_path / "here")
    machine = fx.load("motion-base")
    gravity = gravity_at(np.radians(ELEVATIONS), np.radians(10))
    expected = fx.load_cases(machine, gravity=gravity, point=[0, 0, 0.5], reference=0)
    assert found["case"] == ["90", "75", "60", "45", "30", "15"]
    np.testing.assert_allclose(found["leg_force_N"], expected.leg_force, rtol=1e-12)
    np.testing.assert_allclose(found["deflection_m"], expected.deflection, atol=1e-15)
    np.testing.assert_allclose(found["stiffness_m_rad_N"], expected.stiffness, rtol=1e-9)
    names = {"statics.png", "statics.csv", "statics-stiffness.csv", "statics.nc", "statics.html"}
    assert {file.name for file in (tmp_path / "here").iterdir()} == names
    code, out, _ = run(*line, "--csv")
    assert code == 0
    assert out == (tmp_path / "here" / "statics.csv").read_text()
    table = rows(out)
    assert [float(row["elevation_deg"]) for row in table] == ELEVATIONS.tolist()
    assert [float(row["leg_force_6_N"]) for row in table] == expected.leg_force.values[:, 5].tolist()
    # Where legs turn from push to pull: the force there, between the two cases beside it, is small.
    assert found["reversals"]
    for leg in found["reversals"]:
        for at in leg["elevation_deg"]:
            own = fx.load_cases(machine, gravity=gravity_at(np.radians(at), np.radians(10)), reference=None)
            force = abs(own.leg_force.sel(leg=leg["leg"]).item())
            assert force < 0.05 * np.abs(found["leg_force_N"]).max()
    assert "turn from tension to compression" in " ".join(found["warnings"])


def test_cases_of_a_table(result, run, tmp_path):
    file = tmp_path / "cases.csv"
    file.write_text("case;gravity_z;force_x_kN;moment_z;at_z [mm];z;x;y;roll;pitch;yaw_rad\n"
                    "still;-9,81;0;0;0;2,4;0;0;0;0;0\nwind;-9,81;1,5;-20;500;2,4;0,1;0;1;0;0,02\n")  # fmt: skip
    found = result("statics", "motion-base", file, "--axes", "base")
    poses = fx.Pose.from_rpy([0, 0.1], 0, 2.4, [0, np.radians(1)], 0, [0, 0.02])
    expected = fx.load_cases(
        fx.load("motion-base"), poses, force=[[0, 0, 0], [1500, 0, 0]], moment=[[0, 0, 0], [0, 0, -20]],
        at=[[0, 0, 0], [0, 0, 0.5]], axes="base",
    )  # fmt: skip
    np.testing.assert_allclose(found["deflection_m"], expected.deflection, rtol=1e-9, atol=1e-15)
    assert found["case"] == ["still", "wind"]
    other = result("statics", "motion-base", file, "--axes", "platform")
    assert other["deflection_m"] != found["deflection_m"]
    code, out, _ = run("statics", "motion-base", file, "--reference", "still")
    assert code == 0
    assert "held as they are in case still" in out


def test_cases_keep_their_names_and_matrices_in_files(run, result, tmp_path):
    file = tmp_path / "cases.csv"
    file.write_text("case,force_x\nstill,0\nwind,1500\n")
    found = result("statics", "motion-base", file, "--point", 0, 0, 0.5, "--out", tmp_path / "here")
    with xr.open_dataset(tmp_path / "here" / "statics.nc") as saved:
        assert saved.name.values.tolist() == ["still", "wind"]
    table = rows((tmp_path / "here" / "statics-stiffness.csv").read_text())
    assert len(table) == 2 * 2 * 36
    for k, name in enumerate(("still", "wind")):
        for matrix in ("stiffness", "compliance"):
            values = [float(row["value"]) for row in table if (row["case"], row["matrix"]) == (name, matrix)]
            assert np.ravel(found[f"{matrix}_m_rad_N"][k]).tolist() == values
    units = {(row["matrix"], row["of"], row["by"]): row["unit"] for row in table}
    assert units["stiffness", "x", "z"] == "N/m"
    assert units["stiffness", "roll", "yaw"] == "N m/rad"
    assert units["compliance", "pitch", "y"] == "rad/N"
    assert units["compliance", "z", "roll"] == "m/(N m)"
    assert "Stiffness" in run("statics", "motion-base", file)[1]  # in the terminal too
    elevations = result("statics", "motion-base", "--elevation", "90:30:3", "--out", tmp_path / "up")
    with xr.open_dataset(tmp_path / "up" / "statics.nc") as saved:
        np.testing.assert_allclose(np.degrees(saved.elevation), elevations["elevation_deg"])


def test_rounding_is_no_force_and_no_reversal(run):
    """A machine without weight has no forces, and none that turn."""
    code, out, err = run("statics", "cubic-isolator", "--set", "gravity=[0, 0, 0]")
    assert code == 0
    assert not re.search(r"\de-1\d", out + err)
    assert "turn from tension" not in out + err


def test_curves_that_coincide_are_drawn_as_one():
    gravity = gravity_at(np.radians(ELEVATIONS), np.radians(30))
    cases = fx.load_cases(fx.load("motion-base"), gravity=gravity, reference=0)
    force = cases.leg_force.values
    groups = _together(force)
    assert sorted(leg for legs in groups for leg in legs) == list(range(6))
    assert len(groups) < 6  # the machine is symmetric about the slope
    for legs in groups:
        assert np.ptp(force[:, legs], axis=1).max() < 0.01 * np.ptp(force)
    figure = fx.plots.statics.load_cases(cases, np.radians(ELEVATIONS))
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert len(labels) == len(groups)
    assert any(label.startswith("legs ") for label in labels)


def test_one_case_and_limits(run, result):
    found = result("statics", "motion-base")
    assert found["case"] == ["1"]
    assert found["elevation_deg"] is None
    code, out, _ = run("statics", "motion-base", "--elevation", "90:15:3", "--set", "limits.leg_tension_kN=20")
    assert code == 0
    assert "Leg forces are beyond the design's limits in case 15" in out
    heavy = result("statics", "motion-base", "--set", "legs.stiffness=3000", "--set", "platform.mass=40000")
    assert heavy["status"] != ["ok"]
    assert heavy["leg_force_N"][0][0] is None
    assert "Case 1" in " ".join(heavy["warnings"])


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (["--elevation", "90:15"], "write FIRST:LAST:COUNT"),
        (["--elevation", "90:15:0"], "at least 1"),
        (["--elevation", "up"], "not a number"),
        (["--base-roll", "5"], "Give --elevation as well"),
        (["--elevation", "90", "--set", "gravity=[0,0,0]"], "no gravity that an elevation could turn"),
        (["--elevation", "90:0:2", "--reference", "45"], "names no case; the cases are 90, 0"),
        (["--elevation", "90", "--csv", "--json"], "Give one of them"),
        (["nowhere.csv"], "File 'nowhere.csv' does not exist"),
        (["cases.csv", "--elevation", "90"], "both give cases"),
        (["cases.csv", "--pose", "0", "0", "2.4", "0", "0", "0"], "both give the pose"),
        (["wrong.csv"], "column 'wind' is unknown"),
        (["both.csv"], "both give gravity"),
        (["roll.csv"], "Give a column elevation as well"),
        (["empty.csv"], "there are 0 cases"),
        (["word.csv"], "line 3, column force_x: '3x' is no finite number"),
        (["half.csv"], "there is no column y, z"),
    ],
)
def test_what_is_refused(run, tmp_path, monkeypatch, line, words):
    monkeypatch.chdir(tmp_path)
    files = {
        "cases.csv": "x,y,z,roll,pitch,yaw\n0,0,2.4,0,0,0\n",
        "wrong.csv": "wind\n3\n",
        "both.csv": "elevation,gravity_z\n90,-9.81\n",
        "roll.csv": "base_roll\n10\n",
        "empty.csv": "force_x\n",
        "word.csv": "force_x\n1\n3x\n",
        "half.csv": "x\n1\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    code, _, err = run("statics", "motion-base", *line)
    assert code == 2
    assert words in " ".join(err.split())


def test_the_point_of_a_force_that_is_not_there_is_refused(run, tmp_path):
    (tmp_path / "cases.csv").write_text("case,at_z_mm\na,10\n")
    code, _, err = run("statics", "cubic-isolator", str(tmp_path / "cases.csv"))
    assert code == 2
    assert "at_x, ... say where a force acts, and there is none" in " ".join(err.split())
