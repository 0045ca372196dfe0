"""Poses of the command line and of files: orders of rotation, a pivot, and motions measured from home."""

import numpy as np
import pytest
from tests.helpers.cases import case
from tests.helpers.plain import file, plain_machine

import flexapod as fx

BASE, MACHINE = file("motion-base"), plain_machine("motion-base")  # legs of any length
HEAD = "x_mm,y_mm,z_mm"


def index(result, *arguments):
    return result("modes", BASE, *arguments)["omega_rad_s"]


def expected(angles, order="xyz", pivot=(0, 0, 0)):
    pose = fx.Pose.from_angles([0.1, 0, 2.4], angles, order, degrees=True, pivot=pivot)
    return fx.natural_modes(MACHINE, pose).omega


@pytest.mark.parametrize("order", ["XYZ", "ZXZ", "zyx", "xyz"])
def test_a_pose_in_another_order(result, order):
    found = index(result, "--pose", 0.1, 0, 2.4, 10, 20, -15, "--rotation-order", order)
    np.testing.assert_allclose(found, expected([10, 20, -15], order), rtol=1e-12)


def test_a_pivot(result):
    found = index(result, "--pivot", 0, 0, -0.3, "--pose", 0.1, 0, 2.4, 10, 20, -15)
    np.testing.assert_allclose(found, expected([10, 20, -15], pivot=[0, 0, -0.3]), rtol=1e-12)


def test_an_order_that_is_none(run):
    code, _, err = run("modes", BASE, "--rotation-order", "roll")
    assert code == 2
    assert "rotation order is 'roll'" in err


TABLES = {
    "the order as a column": (f"{HEAD},roll_deg,pitch_deg,yaw_deg,rotation_order\n100,0,2400,10,20,-15,XYZ\n", ()),
    "the order on the line": (f"{HEAD},roll,pitch,yaw\n100,0,2400,10,20,-15\n", ("--rotation-order", "XYZ")),
    "angles by number": (
        f"{HEAD},Angle 1 [deg],Angle 2 [deg],Angle 3 [deg],rotation order\n100,0,2400,10,20,-15,XYZ\n",
        (),
    ),
    "angles about their axes": (f"{HEAD},yaw,pitch,roll,rotation_order\n100,0,2400,-15,20,10,XYZ\n", ()),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_of_poses_in_another_order(result, tmp_path, name):
    text, more = TABLES[name]
    (tmp_path / "poses.csv").write_text(text)
    found = result("kinematics", BASE, tmp_path / "poses.csv", *more)["rows"][0]
    pose = fx.Pose.from_angles([0.1, 0, 2.4], [10, 20, -15], "XYZ", degrees=True)
    np.testing.assert_allclose(found["length_m"], fx.inverse_kinematics(MACHINE, pose), rtol=1e-12)


def test_each_row_has_its_own_order_and_pivot(result, tmp_path):
    rows = ["100,0,2400,10,20,-15,xyz,0", "100,0,2400,10,20,-15,ZXZ,0", "100,0,2400,10,20,-15,XYZ,250"]
    head = f"{HEAD},angle_1,angle_2,angle_3,rotation_order,pivot_x_mm,pivot_y_mm,pivot_z_mm"
    (tmp_path / "poses.csv").write_text("\n".join([head, *(f"{row},0,{row.rpartition(',')[2]}" for row in rows)]))
    found = result("kinematics", BASE, tmp_path / "poses.csv")["rows"]
    for row, (order, pivot) in zip(found, [("xyz", 0), ("ZXZ", 0), ("XYZ", 0.25)], strict=True):
        pose = fx.Pose.from_angles([0.1, 0, 2.4], [10, 20, -15], order, degrees=True, pivot=[pivot, 0, pivot])
        np.testing.assert_allclose(row["length_m"], fx.inverse_kinematics(MACHINE, pose), rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"{HEAD},angle_1,angle_2,angle_3\n0,0,2400,0,0,0\n", "need an order of rotation"),
        (f"{HEAD},roll,pitch,yaw,rotation_order\n0,0,2400,0,0,0,ZXZ\n", "line 2: roll, pitch and yaw turn"),
        (f"{HEAD},roll,pitch,yaw,rotation_order\n0,0,2400,0,0,0,abc\n", "line 2: the rotation order is 'abc'"),
        (f"{HEAD},roll,pitch,yaw,pivot_x_mm\n0,0,2400,0,0,0,1\n", "no column pivot_y, pivot_z"),
    ],
)
def test_tables_that_do_not_say_how_they_turn(run, tmp_path, text, words):
    (tmp_path / "poses.csv").write_text(text)
    code, _, err = run("sweep", BASE, "--poses", tmp_path / "poses.csv")
    assert code == 2
    assert words in " ".join(err.split())


# --- motions from home ------------------------------------------------------------------------------------------------

CENTRED = "time_s,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg\n0,0,0,0,0,0,0\n1,100,0,-50,0,5,0\n2,0,0,0,0,0,0\n"


def test_a_motion_centred_on_home(run, result, tmp_path):
    file = tmp_path / "motion.csv"
    file.write_text(CENTRED)
    code, _, err = run("path", BASE, file)
    assert code == 2
    assert "2.39 m from the home pose" in err
    assert "--from-home" in err
    found = result("path", BASE, file, "--from-home")
    machine = MACHINE
    steps = fx.Pose.from_rpy([0, 0.1, 0], 0, [0, -0.05, 0], 0, np.radians([0, 5, 0]), 0)
    path = fx.Trajectory(steps, [0, 1, 2], origin=machine.home)
    assert found["least_index_rad_s"] == pytest.approx(fx.path_index(machine, path).minimum, rel=1e-12)
    np.testing.assert_allclose(path(1.0).pose.position, [0.1, 0, 2.34], atol=1e-12)


def test_no_hint_where_the_path_is_elsewhere(run, tmp_path):
    file = tmp_path / "motion.csv"
    file.write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,2.39,0,0,0\n1,0,0,2.39,0,0,100\n")
    code, _, err = run("path", BASE, file)
    assert code == 2
    assert "singular pose" in err
    assert "--from-home" not in err


def test_a_plan_from_home(result):
    pytest.importorskip("ompl")
    poses = ("--from", 0, 0, 2.39, 0, 0, 0, "--to", 0.05, 0, 2.42, 0, 0, 0)
    absolute = result("path", BASE, *poses, "--bound", 20)
    moved = ("--from", 0, 0, 0, 0, 0, 0, "--to", 0.05, 0, 0.03, 0, 0, 0)
    relative = result("path", BASE, *moved, "--bound", 20, "--from-home")
    assert relative["least_index_rad_s"] == pytest.approx(absolute["least_index_rad_s"], rel=1e-9)


@pytest.mark.parametrize("name", ["wp", "wpmm", "wp2"])
def test_waypoints_in_m_and_mm(result, name):
    found = result("path", BASE, case("recordings", f"{name}.csv"))
    assert found["least_index_rad_s"] > 20
    assert found["duration_s"] in (1.0, 2.0)


def test_planned_waypoints_say_how_they_turn(result, tmp_path):
    pytest.importorskip("ompl")
    ends = ("--from", 0, 0, 2.39, 0, 0, 0, "--to", 0.05, 0, 2.42, 3, 5, 10)
    found = result("path", BASE, *ends, "--bound", 20, "--rotation-order", "ZXZ", "--out", tmp_path)
    again = result("path", BASE, tmp_path / "waypoints.csv")
    assert (tmp_path / "waypoints.csv").read_text().startswith("t_s,x_m,y_m,z_m,angle_1_deg,")
    assert again["least_index_rad_s"] == pytest.approx(found["least_index_rad_s"], rel=1e-9)


def test_an_option_and_a_column_that_contradict_each_other_are_refused(run, tmp_path):
    """Neither is taken in silence; the same said twice is fine."""
    file = tmp_path / "poses.csv"
    file.write_text("x,y,z,roll,pitch,yaw,rotation_order,pivot_x,pivot_y,pivot_z\n0,0,2.4,0,5,9,ZYX,0,0,0.5\n")
    for option, words in (
        (("--rotation-order", "XYZ"), "line 2: the order is ZYX, and --rotation-order is XYZ"),
        (("--pivot", "0", "0", "0.4"), "pivot_x, ... and --pivot name different points"),
    ):
        code, _, err = run("kinematics", "motion-base", file, *option)
        assert code == 2
        assert words in " ".join(err.split())
    alone = run("kinematics", "motion-base", file)
    both = run("kinematics", "motion-base", file, "--rotation-order", "ZYX", "--pivot", 0, 0, 0.5)
    assert alone[0] == both[0] == 0
    assert alone[1] == both[1]
