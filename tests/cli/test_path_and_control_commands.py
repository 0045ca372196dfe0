"""The commands path and control as a user meets them: numbers, files, messages."""

import re
import warnings

import numpy as np
import pandas as pd
import pytest

import flexapod as fx

pytest.importorskip("ompl")

FROM = ["--from", 0, 0, 0.89, 0, -33, -10]
TO = ["--to", 0, 0, 0.89, 0, 45, 53]


def test_plan_writes_a_path_that_reads_back(run, result, tmp_path):
    found = result("path", "mukherjee-i", *FROM, *TO, "--bound", 100, "--duration", 2, "--out", tmp_path)
    assert found["above_bound"] is True
    assert found["least_index_rad_s"] >= 100
    assert found["plan"]["straight_least_index_rad_s"] < 5
    names = {"path-index.png", "path-loads.png", "path-plane.png", "path.csv", "waypoints.csv", "path.html"}
    assert {file.name for file in tmp_path.iterdir()} == names
    again = result("path", "mukherjee-i", tmp_path / "waypoints.csv", "--bound", 100)
    assert again["least_index_rad_s"] == pytest.approx(
        found["least_index_rad_s"], rel=1e-9
    )  # twelve digits in the file
    assert again["duration_s"] == 2.0
    html = (tmp_path / "path.html").read_text()
    assert html.count("<svg") == 3
    assert "http" not in re.sub(r'xmlns[:\w]*="[^"]*"', "", html)  # needs no network
    code, out, _ = run("path", "mukherjee-i", tmp_path / "waypoints.csv", "--bound", 105)
    assert code == 0
    assert "BELOW it in places" in out


@pytest.mark.parametrize("given", [("--duration", 2), ("--leg-rate", 0.1), ("--condition", 50), ("--clearance", 0.01)])
def test_what_only_a_planned_path_has_is_refused_beside_a_file(run, tmp_path, given):
    file = tmp_path / "w.csv"
    file.write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0,0,0.9,0,0,0\n")
    code, _, err = run("path", "mukherjee-i", file, *given)
    assert code == 2
    assert f"{given[0]} is for a path that is planned" in err


def test_path_of_a_file(result, tmp_path):
    rows = ["t,x,y,z,roll,pitch,yaw,weight", "0,0,0,0.89,0,0,0,1", "1,0.05,0.02,0.9,5,0,10,3", "2,0,0,0.95,0,0,0,1"]
    file = tmp_path / "w.csv"
    file.write_text("\n".join(rows))
    found = result("path", "mukherjee-i", file, "--ends", "free")
    poses = fx.Pose.from_rpy([0, 0.05, 0], [0, 0.02, 0], [0.89, 0.9, 0.95], np.radians([0, 5, 0]), 0,
                             np.radians([0, 10, 0]))  # fmt: skip
    path = fx.Trajectory(poses, [0, 1, 2], ends="free", weights=[1, 3, 1])
    expected = fx.path_index(fx.load("mukherjee-i"), path)
    assert found["least_index_rad_s"] == pytest.approx(expected.minimum)
    assert found["weighted_mean_index_rad_s"] == pytest.approx(expected.weighted_mean)
    assert found["bound_rad_s"] is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["path", "mukherjee-i"], "give a FILE of waypoints, or --from and --to"),
        (["path", "mukherjee-i", *FROM, *TO], "Give --bound RAD_S"),
        (["path", "mukherjee-i", *FROM, *TO, "--bound", 150], "below the bound of 150 rad/s"),
        (["path", "mukherjee-i", *FROM, *TO, "--bound", 100, "--least", "time"], "least time needs a LegSpeed"),
        (["path", "mukherjee-i", *FROM, *TO, "--bound", 100, "--duration", 1, "--leg-rate", 1], "Give one of them"),
        (["path", "mukherjee-i", "nowhere.csv"], "File 'nowhere.csv' does not exist"),
        (["control", "cubic-isolator", "pid", "--kp", 1], "pid needs its gains"),
        (["control", "cubic-isolator", "pid", "--kp", -1e6, "--kd", 1], "the machine is unstable with joint-space PID"),
        (["control", "cubic-isolator", "force", "--gain", 60, "--leak", 0], "needs a leak"),
        (["control", "cubic-isolator", "lqg", "--noise", 0.001, "--dt", 0.02], "sample faster"),
        (["control", "cubic-isolator", "lqg", "--measure", "jerk"], "measure is"),
    ],
)
def test_what_is_wrong_is_said(run, arguments, words):
    code, _, err = run(*arguments)
    assert code == 2
    assert words in err


@pytest.mark.parametrize(("gain", "creeps"), [(26.4, True), (13.0, False)])
def test_a_gain_that_nearly_takes_the_stiffness_away_is_told(run, gain, creeps):
    code, out, err = run("control", "cubic-isolator", "force", "--gain", gain)
    assert code == 0
    assert ("decays only in" in out + err) is creeps
    h = fx.load("cubic-isolator")
    with warnings.catch_warnings(record=True) as warned:  # the function says it too, and its result
        warnings.simplefilter("always")
        law = fx.control.ForceFeedback(gain, leak=0.1 * fx.linearise(h).modes().omega[0])
        loop = fx.control.closed_loop(h, None, law, nearness=0)
    assert any("falls over" in str(one.message) for one in warned) is creeps
    assert any("falls over" in text for text in loop.cautions) is creeps
    assert ("falls over" in loop._repr_html_()) is creeps
    assert run("control", "cubic-isolator", "force", "--gain", 26.8)[0] == 2


def test_dampers_that_hardly_yield_do_not_take_stiffness_away():
    with pytest.warns(fx.control.GainWarning, match="dampers so strong"):
        loop = fx.control.closed_loop(fx.load("cubic-isolator"), None, fx.control.VelocityFeedback(1e5), nearness=0)
    assert "falls over" not in " ".join(loop.cautions)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (["x,y,z"], "Its first line must be t,x,y,z,roll,pitch,yaw"),
        (
            ["t,x,y,z,roll,pitch,yaw", "0,0,0,1,0,0,0", "1,0,0,high,0,0,0"],
            "line 3, column z: 'high' is no finite number",
        ),
        (["t,x,y,z,roll,pitch,yaw", "0,0,0,1,0,0,0"], "at least two poses"),
        (["t,x,y,z,roll,pitch,yaw", "1,0,0,1,0,0,0", "0,0,0,1,0,0,0"], "times must increase"),
    ],
)
def test_wrong_files_are_told_what_is_wrong(run, tmp_path, rows, words):
    file = tmp_path / "w.csv"
    file.write_text("\n".join(rows))
    code, _, err = run("path", "mukherjee-i", file)
    assert code == 2
    assert words in err


def test_control_gives_the_library_s_numbers(result, tmp_path):
    h = fx.load("cubic-isolator")
    pose = fx.home_pose(h)
    found = result("control", "cubic-isolator", "lqg", "--shake", 0.01, "--duration", 2, "--out", tmp_path)
    dt = fx.control.sampling_time(h, pose)
    assert found["sampling_time_s"] == dt == found["recommended_sampling_time_s"]
    loop = fx.control.closed_loop(h, pose, fx.control.lqg(h, pose).sampled(dt))
    assert found["worst_damping"] == pytest.approx(loop.worst_damping)
    assert found["run"]["rms_acceleration_controlled"][2] < 0.6 * found["run"]["rms_acceleration_passive"][2]
    np.testing.assert_allclose(
        found["run"]["rms_acceleration_controlled"][:3],
        found["run"]["predicted_rms_acceleration_controlled"][:3],
        rtol=0.05,
    )
    names = {"control-transmissibility.png", "control-run.png", "control.html"}
    assert {file.name for file in tmp_path.iterdir()} == names


def test_damping_gain_is_chosen_for_the_sampled_loop(result):
    found = result("control", "precision-positioner", "velocity")
    h = fx.load("precision-positioner")
    continuous = fx.control.root_locus(h, fx.home_pose(h), "velocity").attrs["best_gain"]
    assert found["best_gain"] == pytest.approx(continuous)
    assert found["worst_damping"] > 0.5
    slower = result("control", "precision-positioner", "velocity", "--dt", 4 * found["sampling_time_s"])
    assert slower["worst_damping"] > 0.05
    assert any("sample faster" in text for text in slower["warnings"])


def spectra(folder):
    """Files of a base's and a load's spectra, and the options that give them."""
    (folder / "floor.csv").write_text("frequency_hz,z\n1,1e-6\n60,1e-6\n")
    (folder / "wind.csv").write_text("frequency_hz,force_y\n0.5,0.01\n60,1e-5\n")
    return ["--psd", folder / "floor.csv", "--load", folder / "wind.csv", "--at", 0, 0, 0.1]


def test_spectra_and_loads_shake_the_controlled_machine(run, result, tmp_path):
    h = fx.load("cubic-isolator")
    law = ["control", "cubic-isolator", "velocity", "--gain", 200, "--point", 0, 0, 0.05]
    found = result(*law, *spectra(tmp_path), "--out", tmp_path / "out")
    sampled = fx.control.VelocityFeedback(200.0).on(fx.linearise(h)).sampled(found["sampling_time_s"])
    wind = fx.vibration.RandomLoad([0.01, 1e-5], frequency=[0.5, 60], axis="force_y", point=(0, 0, 0.1), name="wind")
    floor = {"psd": [1e-6, 1e-6], "frequency": [1, 60], "axis": "z", "loads": wind, "point": (0, 0, 0.05)}
    with_control = fx.control.controlled_random_response(h, controller=sampled, **floor)
    for key, expected in (("", with_control), ("passive_", fx.random_response(h, **floor))):
        for name, values in found[f"{key}random_rms"].items():
            np.testing.assert_allclose(values, expected[f"rms_{name}"], rtol=1e-9, atol=1e-15)
        assert list(found[f"{key}random_rms_by_source"]) == ["base", "wind"]
    assert set(found["random_rms"]) - set(found["passive_random_rms"]) == {"actuator_force"}
    assert {name for name in map(str, found["files"]) if "random" in name} == {
        str(tmp_path / "out" / f"control-random{end}") for end in (".png", ".csv", ".nc", "-passive.csv", "-passive.nc")
    }
    table = pd.read_csv(tmp_path / "out" / "control-random.csv")
    np.testing.assert_allclose(table.cumulative_displacement_of_point_z_m.iloc[-1], with_control.rms_displacement[2])
    squares = np.trapezoid(table.psd_actuator_force_3_N2_per_rad_s, table.omega_rad_s)
    assert np.sqrt(squares) == pytest.approx(float(with_control.rms_actuator_force[2]), rel=0.01)
    code, _, err = run(*law, *spectra(tmp_path), "--dt", 0.02)
    assert code == 2
    assert "Sample at least every 0.008333 s (dt, on the command line --dt)" in " ".join(err.split())
    assert "µm" in run(*law, *spectra(tmp_path))[1]


def test_a_machine_that_only_control_holds_has_no_passive_response(run, tmp_path):
    """A tall mass on soft legs falls over: the controller holds it, and that is told once."""
    law = ["control", "cubic-isolator", "pid", "--kp", 1e4, "--kd", 500, "--set", "platform.mass_center=[0, 0, 1.0]"]
    code, out, err = run(*law, *spectra(tmp_path), "--dt", 1e-3)
    assert code == 0, err
    told = " ".join((out + err).split())
    assert "Without control: the machine is not stable at rest" in told
    assert told.count("e-fold in 4.8 s") == 1
    assert " 500 Hz" not in told  # half the sampling frequency, where a pole of the loop alternates
    assert "no control" not in out.split("RMS by")[1].split("Warning")[0]


def test_pid_shows_where_gains_are_near(run, tmp_path):
    code, out, _ = run("control", "motion-base", "pid", "--kp", 1e5, "--kd", 1e4, "--out", tmp_path)
    assert code == 0
    assert "Warning" in out
    assert "lie near a natural frequency" in out
    assert (tmp_path / "control-gains.png").stat().st_size > 10_000


def test_control_tells_its_law_and_its_shaking(run, result, tmp_path):
    """Everything that is needed to do it again; a card only for what was run."""
    shaken = ["control", "cubic-isolator", "lqg", "--noise", 0.2, "--shake", 0.01, "--band", 1, 8, "--seed", 7]
    found = result(*shaken, "--duration", 1)
    assert found["law"] == {"measures": "acceleration of the platform", "effort": 0.1, "stroke": 0.1, "noise": 0.2}
    shaking = found["run"]["shaking"]
    assert (shaking["rms_acceleration"], shaking["axes"], shaking["seed"]) == (0.01, "x, y, z", 7)
    assert [shaking["band_hz_from"], shaking["band_hz_to"], shaking["duration_s"]] == pytest.approx([1, 8, 1])
    code, out, err = run(*shaken, "--duration", 1, "--out", tmp_path)
    assert (code, "sensor noise expected" in out, "flat from" in out) == (0, True, True), err
    page = (tmp_path / "control.html").read_text()
    assert page.index("<h2>Transmissibility") < page.index("<h2>Closed loop")


def test_control_without_a_run_says_nothing_of_one(run, tmp_path):
    code, out, err = run("control", "precision-positioner", "velocity", "--gain", 20000, "--out", tmp_path)
    assert code == 0, err
    assert "20000 N s/m" in out
    page = (tmp_path / "control.html").read_text()
    assert "not run" not in page
    assert "chosen gain" in page
    assert ">zeros<" not in page
    assert "Pose(" not in out


@pytest.mark.parametrize(
    ("column", "unit", "told"),
    [("x", "m/s\u00b2", True), ("roll", "rad/s\u00b2", True), ("smooth", "", False), ("few", "", False)],
)
def test_rest_at_the_ends_of_a_motion_that_goes_on_is_told(run, tmp_path, column, unit, told):
    t = np.linspace(0.0, 4.0, 7 if column == "few" else 81)
    rows = np.zeros((t.size, 7))
    rows[:, 0] = t
    sine = np.sin(np.pi * t)  # 0.1 m or 5 degrees
    smooth = 0.1 * (t / 4) ** 3 * (10 - 15 * t / 4 + 6 * (t / 4) ** 2)
    rows[:, 4 if column == "roll" else 1] = {"roll": 5 * sine, "smooth": smooth}.get(column, 0.1 * sine)
    file = tmp_path / "way.csv"
    np.savetxt(file, rows, delimiter=",", header="t,x,y,z,roll,pitch,yaw", comments="")
    code, out, err = run("path", "motion-base", file, "--from-home")
    assert code == 0
    assert ("a motion that goes on" in out + err) is told
    if told:
        true = np.pi**2 * (0.1 if column == "x" else np.radians(5))
        free = (out + err).partition(" with free ends")[0].split()[-2:]
        assert free[1] == unit
        assert float(free[0]) == pytest.approx(true, rel=0.02)
    home = fx.home_pose(fx.load("motion-base"))
    six = np.column_stack([rows[:, 1:4], np.radians(rows[:, 4:])])
    path = fx.Trajectory(six, t, origin=home)
    for each in (path, path.between(home, 2.0), path.between(home, 2.0).retimed(2.0)):  # told with the result too
        words = fx.paths.path_loads(fx.load("motion-base"), each, samples=20).attrs["caution"]
        assert bool(words) is told
    if told:
        assert fx.paths.path_loads(fx.load("motion-base"), path).attrs["caution"] in " ".join((out + err).split())
    code, out, err = run("path", "motion-base", file, "--from-home", "--ends", "free")
    assert "a motion that goes on" not in out + err


def test_a_path_joined_to_home_has_the_waypoints_that_were_given(result, tmp_path):
    (tmp_path / "way.csv").write_text(
        "t,x,y,z,roll,pitch,yaw\n0,0.01,0,0,0,0,0\n1,0.02,0,0,0,0,0\n2,0.01,0.01,0,0,0,0\n"
    )
    found = result("path", "motion-base", tmp_path / "way.csv", "--from-home", "--home-time", 1)
    assert found["waypoints_s"] == [0.0, 1.0, 2.0]
    assert found["duration_s"] == pytest.approx(4.0)
    assert [pose[0] for pose in found["waypoints_m_deg"]] == pytest.approx([0.01, 0.02, 0.01])
