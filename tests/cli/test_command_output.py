"""What the commands say to a reader, where other tests read their JSON: tables, notes, files, and refusals."""

import json
import os
import runpy
import signal
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner

import flexapod as fx
from flexapod.cli import group, main
from flexapod.cli.options import common
from flexapod.cli.output import interrupt
from flexapod.cli.output.progress import PoseProgress

NEAR = ["--from", 0, 0, 0.89, 0, 0, 0, "--to", 0.05, 0, 0.9, 0, 0, 0]


@pytest.fixture
def homeless(tmp_path):
    """A design file without a home pose."""
    file = tmp_path / "homeless.toml"
    file.write_text(fx.load("mukherjee-i").replace({"home": None}).to_toml())
    return file


def words(run, *arguments):
    code, out, err = run(*arguments)
    assert code == 0, err
    return out


def refusal(run, *arguments):
    code, _, err = run(*arguments)
    assert code == 2
    return err


def test_an_interrupt_is_not_a_fault(run, monkeypatch):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("flexapod.mechanics.at_rest.pose_state", stopped)
    code, out, err = run("modes", "mukherjee-i")
    assert (code, out, err) == (130, "", "\nInterrupted.\n")


def test_the_first_signal_is_a_wish_and_the_second_stops_at_once():
    before = signal.getsignal(signal.SIGINT)
    with interrupt.Stopping() as stop:
        assert not stop()
        signal.raise_signal(signal.SIGTERM)
        assert stop()
        assert stop.signal == signal.SIGTERM
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


def test_importing_the_module_that_runs_it_runs_nothing(capsys):
    runpy.run_module("flexapod.__main__", run_name="imported")
    assert capsys.readouterr().out == ""


def test_check_says_what_was_not_checked(run, homeless):
    assert "No home pose and no --pose: nothing was checked at a pose, neither limits" in words(run, "check", homeless)


def test_brackets_in_a_warning_are_shown(capsys):
    common.print_warnings(["add [home] to the [design]"])
    assert capsys.readouterr().out == "Warning: add [home] to the [design]\n"


def test_animate_says_how_much_larger_it_shows_the_motion(run, tmp_path, monkeypatch):
    monkeypatch.setattr("flexapod.plots.animation._PER_PERIOD", 3)
    out = words(run, "animate", "cubic-isolator", "--exaggeration", 5000, "--out", tmp_path / "mode.gif")
    assert out == f"Wrote {tmp_path / 'mode.gif'}: mode 1, motion shown 5000 times larger\n"


def test_odd_names_make_plain_files_where_one_is(run, tmp_path):
    odd = tmp_path / "odd.toml"
    odd.write_text(fx.load("motion-base").replace({"name": "../a b/c"}).to_toml())
    out = tmp_path / "out"
    words(run, "optimise", odd, "--vary", "platform.mass=900:1100", "--trials", 0, "--verify", 2, "--points", 1,
          "--out", out)  # fmt: skip
    assert {file.suffix: file.name[:5] for file in out.iterdir()} == dict.fromkeys((".toml", ".html", ".png"), "a-b-c")


def test_robust_without_files_and_sensitivity(result):
    found = result(
        "robust",
        "motion-base",
        "--uncertain",
        "legs.stiffness_law.bulk_modulus=10%",
        "--samples",
        16,
        "--sensitivity",
        0,
    )
    assert found["files"] == []
    assert not any(name.startswith("sobol") for name in found)


def test_control_says_the_most_damping(run):
    out = words(run, "control", "precision-positioner", "velocity", "--gain", 20000)
    locus = fx.control.root_locus(
        fx.load("precision-positioner"), fx.home_pose(fx.load("precision-positioner")), "velocity"
    )
    assert f"most damping without sampling {locus.attrs['best_damping']:.4g} at gain" in out
    assert "N s/m" in out


def test_control_says_when_actuators_were_at_their_limit(result):
    found = result("control", "cubic-isolator", "velocity", "--gain", 50, "--shake", 0.01, "--duration", 0.5,
                   "--force-limit", 1e-4)  # fmt: skip
    assert found["run"]["saturated"] > 0
    assert any(text.startswith("The actuators were at their limit in") for text in found["warnings"])


SPECTRA = {
    "VC-C": fx.vc_curve("VC-C"),
    "ground": fx.excitation.ground_noise("high"),
    "ground:low": fx.excitation.ground_noise("low"),
    "sea:3:9s": fx.excitation.sea_spectrum(3, 9),
    "flat:0.1g:1Hz:20Hz": fx.excitation.flat_spectrum(0.980665, 2 * np.pi, 40 * np.pi),
}


@pytest.mark.parametrize("text", SPECTRA)
def test_spectra_by_their_names(text):
    from flexapod.cli.options.drives import _spectrum

    found, expected = _spectrum(text, "base_motion", "z"), SPECTRA[text]
    omega = np.geomspace(expected.omega_min, expected.omega_max, 50)
    assert found.quantity == expected.quantity
    np.testing.assert_allclose(found.density(omega), expected.density(omega), rtol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--random", "z", "VC-C:2"), "spectrum 'VC-C:2' is unknown"),
        (("--random", "z", "ground:loud"), "model is 'loud'; it must be one of 'low', 'high'"),
        (("--random", "z", "ground:low:2"), "spectrum 'ground:low:2' is unknown"),
        (("--random", "z", "flat:1:2"), "flat:RMS:FROM:TO"),
        (("--animate", "run.avi"), "run.avi is neither .gif nor .mp4"),
        (("--animate", "nowhere/run.gif"), "nowhere is no directory"),
    ],
)
def test_what_simulate_refuses(run, arguments, told):
    assert told in refusal(run, "simulate", "mukherjee-ii", "--duration", 0.01, *arguments)


def test_simulate_shows_its_motion(run, result, tmp_path, monkeypatch):
    from PIL import Image

    drive = ("--harmonic", "z", "1um", 750, "--duration", "50ms", "--samples", 200)
    from functools import partial

    from flexapod.plots import animation

    monkeypatch.setattr(animation, "animate_simulation", partial(animation.animate_simulation, frames=6))
    file = tmp_path / "run.gif"
    out = words(run, "simulate", "mukherjee-ii", *drive, "--animate", file, "--exaggeration", 3000)
    assert f"Wrote {file}" in out
    with Image.open(file) as film:
        assert film.n_frames == 6
    assert result("simulate", "mukherjee-ii", *drive, "--animate", file)["files"] == [str(file)]


def test_simulate_says_what_the_library_warns_of(run, tmp_path):
    record = tmp_path / "coarse.csv"
    record.write_text("\n".join(["time,z_um", *(f"{0.002 * i},{np.sin(0.9 * i):.6f}" for i in range(20))]))
    code, out, err = run("simulate", "mukherjee-ii", "--recording", "base", record, "--duration", 0.02)
    assert (code, err.strip()) == (0, "")
    assert "Warning: The recording of base_motion z" in out


def test_a_run_that_ends_early_and_is_not_written_just_says_so(run):
    drive = ("--shock", "z", "-1e5", "20ms", "--set", "legs.stiffness=1e5")
    code, out, err = run("simulate", "mukherjee-ii", *drive, "--duration", 0.2)
    assert (code, out) == (2, "")
    assert "The motion so far" not in err


@pytest.mark.parametrize("name", ["response.nc", "response.png"])
def test_a_file_in_the_way_is_told(run, tmp_path, name):
    """Where a directory has a result's name, the command says so: no traceback."""
    (tmp_path / name).mkdir()
    err = refusal(run, "response", "mukherjee-ii", "--points", 5, "--out", tmp_path)
    assert f"{tmp_path / name} cannot be written" in err


def test_response_gives_every_study_as_json(result, tmp_path):
    psd = tmp_path / "psd.csv"
    psd.write_text("frequency_hz,z\n1,1e-6\n500,1e-6\n")
    found = result("response", "mukherjee-ii", "--points", 5, "--amplitude", 1e-7, "--steps", 2, "--psd", psd,
                   "--omega-min", 100, "--omega-max", 200)  # fmt: skip
    assert found["stepped"]["status"] == ["found", "found"]
    assert found["stepped"]["amplitude"] == 1e-7
    assert len(found["random_rms"]["leg_force"]) == 6
    assert found["random_rms"]["acceleration"][2] > 0


def test_response_of_a_machine_that_does_not_vibrate(result):
    """With friction far above critical there is no resonance to tell the height of."""
    found = result("response", "mukherjee-ii", "--points", 5, "--set", "legs.damping.prismatic=1e8")
    assert all(height is None for row in found["amplitude_at_modes"] for height in row)


def test_stepped_sine_without_a_motion_is_said():
    from flexapod.report.studies.response import stepped_words

    nothing = xr.Dataset(
        {"status": ("omega", np.array(["diverged", "singular"]))}, attrs={"amplitude": 0.1, "amplitude_unit": "m"}
    )
    assert stepped_words(nothing).endswith("amplitude 0.1 m: no periodic motion found at any frequency.")


def test_path_shows_the_plan(run):
    out = words(run, "path", "mukherjee-i", *NEAR, "--bound", 90, "--leg-rate", 0.5)
    assert "length 0.05099 m; the straight line has 0.05099 m" in out
    assert "above it all along" in out


def test_path_takes_a_straight_line_where_it_is_free(result, tmp_path):
    found = result("path", "mukherjee-i", *NEAR, "--bound", 90, "--out", tmp_path)
    assert found["plan"]["batches"] == 0
    assert found["length_m"] == pytest.approx(np.hypot(0.05, 0.01))
    assert "path-plane.png" not in {file.name for file in tmp_path.iterdir()}
    html = (tmp_path / "path.html").read_text()
    assert html.count("<svg") == 2


def test_path_of_a_file_without_a_bound(run, tmp_path):
    file, out = tmp_path / "way.csv", tmp_path / "out"
    file.write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0.05,0,0.9,0,0,5\n")
    told = words(run, "path", "mukherjee-i", file, "--set", "limits.leg_length=[0.1, 0.87]", "--out", out)
    assert "bound" not in told
    assert "Warning: The path leaves the design's limits for" in told
    assert {f.name for f in out.iterdir()} == {"path.csv", "path-index.png", "path-loads.png", "path.html"}
    assert "leaves the design&#x27;s limits" in (out / "path.html").read_text()


def test_a_figure_in_the_way_is_told(run, tmp_path):
    file, out = tmp_path / "way.csv", tmp_path / "out"
    file.write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0.05,0,0.9,0,0,5\n")
    (out / "path-index.png").mkdir(parents=True)
    assert "path-index.png cannot be written" in refusal(run, "path", "mukherjee-i", file, "--out", out)


def test_all_coordinates_named_need_no_home(run, result, homeless):
    named = ["--box", "x=-0.1:0.1,y=0,z=0.8:0.9", "--box", "roll=0,pitch=0,yaw=-5:5", "--points", 50]
    assert result("sweep", homeless, *named)["summary"]["poses"] == 50
    err = refusal(run, "sweep", homeless, "--box", "x=-0.1:0.1")
    assert "names no home pose. Name all six coordinates with --box" in err
    assert "names no home pose for --around" in refusal(run, "sweep", homeless, "--around", 0.1, 10)


def test_the_worst_pose_in_words(run):
    out = words(run, "sweep", "mukherjee-ii", "--around", 0.004, 4, "--points", 300, "--worst")
    hexapod = fx.load("mukherjee-ii")
    found = fx.worst_pose(hexapod, fx.Box.about(fx.home_pose(hexapod), 0.004, np.radians(4)))
    assert f"worst of the box: ω1 = {found.omega_1:.8g} rad/s at (" in out
    assert f"at the bounds of {', '.join(found.at_bounds)}" in out.replace("\n", " ")
    assert f"{found.agreed} of {found.starts} descents ended there" in out


def test_a_singular_box_in_words(run):
    out = words(run, "sweep", "mukherjee-i", "--box", "pitch=-33:45,yaw=-10:53", "--points", 300, "--worst")
    assert "worst of the box: singular, ω1 = 0, at (" in out


def test_a_summary_leaves_out_what_there_is_not(run, result):
    """One pose has an index, but no correlation of index and condition."""
    one = ["--grid", "x=0.05"]
    assert "rank correlation" not in words(run, "sweep", "mukherjee-ii", *one)
    assert result("sweep", "mukherjee-ii", *one)["summary"]["correlation"] is None
    out = words(run, "sweep", "mukherjee-ii", "--around", 0.004, 4, "--points", 50, "--quantities", "omega_1")
    assert "least cond" not in out
    found = result("sweep", "mukherjee-ii", "--around", 0.004, 4, "--points", 50, "--quantities", "omega_1")
    assert found["summary"]["best_conditioned"] is None


def test_progress_counts_in_words():
    with PoseProgress() as bar:
        bar(SimpleNamespace(total=2_500_000, done=250, before=0, statuses={0: 240, 3: 10}))
        task = bar._progress.tasks[0]
        assert task.fields["poses"] == "250 of 2.5 M poses"
        assert task.fields["bad"] == "10 not ok"


BETTER = ["optimise", "mukherjee-ii", "--vary", "home.position_mm[2]=70:100", "--points", 64, "--verify", 256]


def test_a_front_as_json_without_files(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    out = words(run, *BETTER, "--vary", "platform.mass=2:4", "--against", "mass", "--trials", 30, "--refine", 2,
                "--box", "x=-0.001:0.001", "--json")  # fmt: skip
    found = json.loads(out)
    assert list(tmp_path.iterdir()) == []
    assert found["against"] == "total mass"
    assert (np.diff(found["index_rad_s"]) > 0).all()
    assert (np.diff(found["against_values"]) > 0).all()
    heights = np.array(found["variables"]["home.position_mm[2]"])
    assert ((heights >= 70) & (heights <= 100)).all()  # in the unit that the name says


def test_mean_over_the_poses_of_a_file(run, tmp_path):
    file = tmp_path / "poses.csv"
    file.write_text("x,y,z,roll,pitch,yaw\n0,0,0.085,0,0,0\n0.001,0,0.086,1,0,2\n")
    found = json.loads(words(run, *BETTER[:2], "--vary", "platform.mass=2:4", *BETTER[4:], "--trials", 0, "--mean",
                             file, "--json"))  # fmt: skip
    poses = fx.Pose.from_rpy([0, 0.001], 0, [0.085, 0.086], np.radians([0, 1]), 0, np.radians([0, 2]))
    lighter = fx.load("mukherjee-ii").replace({"platform.mass": 2.0})
    assert found["index_rad_s"] == pytest.approx(fx.stability_index(lighter, poses).mean(), rel=1e-3)
    assert "mean index over 2 poses" in found["objective"]
    err = refusal(run, *BETTER, "--trials", 0, "--mean", file, "--around", 0.001, 1)
    assert "--mean takes the poses of its file. Leave --pose, --box and --around out." in err


@pytest.fixture
def served(monkeypatch):
    """`flexapod serve` up to where it would wait for pages; what it would have opened in a browser."""
    import uvicorn

    opened = []
    monkeypatch.setattr(uvicorn.Server, "run", lambda self, sockets: [bound.close() for bound in sockets])
    monkeypatch.setattr("webbrowser.open", opened.append)

    def call(*arguments):
        found = CliRunner().invoke(group, ["serve", "--port", "0", *map(str, arguments)])
        assert found.exit_code == 0, found.output
        return found.output, opened

    return call


def test_serve_says_where_it_is_and_opens_it(served):
    out, opened = served("mukherjee-ii", "--open")
    address = opened[0]
    assert out == f"Flexapod is at {address} (Ctrl-C ends it)\n"
    assert address.startswith("http://127.0.0.1:")


def test_serve_shows_what_is_wrong_with_a_design_and_serves_it(served, tmp_path):
    file = tmp_path / "broken.toml"
    file.write_text(fx.load("mukherjee-ii").to_toml().replace("mass = 4.0", "mass = -4.0"))
    out, opened = served(file)
    assert "Note: " in out
    assert "platform.mass is -4" in out
    assert opened == []


@pytest.mark.skipif(os.name == "nt", reason="no IPv6 loopback by this name")
def test_serve_writes_addresses_of_the_sixth_version_in_brackets(served):
    out, _ = served("--host", "::1", "--json")
    assert json.loads(out)["url"].startswith("http://[::1]:")
    address, *warned = served("--host", "0.0.0.0", "--json")[0].splitlines()
    assert json.loads(address)["url"].startswith("http://127.0.0.1:")
    assert "token" in " ".join(warned)  # other computers can reach it


def test_a_study_is_seen_before_its_figures_are_drawn(tmp_path, monkeypatch, capsys):
    seen = []
    monkeypatch.setattr("flexapod.report.html.page", lambda study: seen.append(capsys.readouterr().out) or "a page")
    assert main(["report", "motion-base", "--out", str(tmp_path)]) == 0
    assert seen[0].startswith("motion-base: ")
    assert capsys.readouterr().out == f"Wrote {tmp_path / 'motion-base.html'}\n"


@pytest.mark.skipif(os.name != "posix", reason="/bin/true")
def test_files_are_written_though_nobody_reads(tmp_path):
    line = f'"{sys.executable}" -m flexapod report motion-base --out "{tmp_path}" | true'
    subprocess.run(line, shell=True, check=True, timeout=120)
    assert [file.name for file in tmp_path.iterdir()] == ["motion-base.html"]
