"""The commands response and animate, and the figures of vibration."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from PIL import Image
from tests.helpers.cases import case

import flexapod as fx
from flexapod.plots import response as plots_response

CENTER = ["--pose", "0", "0", "0.085", "0", "0", "0"]
AXES = ["x", "y", "z", "roll", "pitch", "yaw"]
II = fx.Pose((0, 0, 0.085))


# --- response ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "variable", "given"),
    [
        ([], "absolute", {"base": "z"}),
        (["--relative", "--axis", "roll"], "relative", {"base": "roll"}),
        (["--from", "wrench", "--axis", "x"], "compliance", {"wrench": "x"}),
        (["--from", "command", "--axis", "4", "--loss-factor", "0.02"], "command", {"leg": "4"}),
    ],
)
def test_response_prints_what_the_library_gives(result, arguments, variable, given):
    found = result("response", "mukherjee-ii", *CENTER, "--omega-max", "2000", "--points", "50", *arguments)
    omega = np.array(found["omega_rad_s"])
    assert omega[-1] == pytest.approx(2000)
    hexapod = fx.load("mukherjee-ii")
    eta = found["loss_factor"]
    assert eta == [0.02 if "--loss-factor" in arguments else 0.0] * 6
    expected = fx.transmissibility(hexapod, II, omega=omega, loss_factor=eta)[variable].sel(given)
    for axis in AXES:
        complex_amplitude = np.array(found["amplitude"][axis]) * np.exp(1j * np.array(found["phase_rad"][axis]))
        np.testing.assert_allclose(complex_amplitude, expected.sel(output=axis), rtol=1e-9, atol=1e-300)
    inside = [w for w in found["damped_omega_rad_s"] if omega[0] < w < 2000]
    assert len(inside) == 3
    assert all(np.abs(omega / w - 1).min() < 1e-12 for w in inside)  # every resonance is a point of the curve


def test_response_writes_files_that_read_back(run, tmp_path):
    psd = tmp_path / "floor.csv"
    psd.write_text("frequency_hz,z,roll\n1,1e-6,0\n80,1e-6,1e-7\n")
    out = tmp_path / "made" / "here"
    options = ["--amplitude", "1e-5", "--steps", "5", "--psd", psd, "--out", out, "--points", "40"]
    code, text, _ = run("response", "cubic-isolator", *options)
    assert code == 0
    assert "5 of 5 frequencies" in text
    names = {f"{name}.{kind}" for name in ("response", "stepped", "random") for kind in ("csv", "nc", "png")}
    assert {path.name for path in out.iterdir()} == names
    hexapod = fx.load("cubic-isolator")
    home = fx.home_pose(hexapod)
    with xr.open_dataset(out / "response.nc") as saved:
        read = saved.absolute_re.values + 1j * saved.absolute_im.values
        expected = fx.transmissibility(hexapod, home, omega=saved.omega.values)
        np.testing.assert_allclose(read, expected.absolute, rtol=1e-14, atol=1e-14)
        assert saved.omega.attrs["units"] == "rad/s"
    table = pd.read_csv(out / "response.csv")
    np.testing.assert_allclose(table.frequency_hz * 2 * np.pi, table.omega_rad_s)
    expected = fx.transmissibility(hexapod, home, omega=table.omega_rad_s).absolute.sel(output="z", base="z")
    np.testing.assert_allclose(table.z_amplitude_m_per_m, np.abs(expected), rtol=1e-12)
    with xr.open_dataset(out / "random.nc") as saved:
        grid = np.array([1.0, 80.0]) * 2 * np.pi
        levels = np.zeros((2, 6))
        levels[:, 2], levels[:, 3] = 1e-6, [0, 1e-7]
        expected = fx.random_response(hexapod, home, psd=levels / (2 * np.pi), omega=grid)
        np.testing.assert_allclose(saved.rms_leg_force, expected.rms_leg_force, rtol=1e-12)
    stepped = pd.read_csv(out / "stepped.csv", index_col=0)
    response = fx.transmissibility(hexapod, home, omega=stepped.index.values).absolute.sel(output="z", base="z")
    np.testing.assert_allclose(
        stepped.z_ratio_m_per_m, np.abs(response), rtol=1e-4
    )  # (amplitude / leg)^2 enlarged by resonance
    for name in ("response", "stepped", "random"):
        with Image.open(out / f"{name}.png") as picture:
            assert min(picture.size) > 700


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--axis", "3"], "does not go with --from base"),
        (["--from", "command", "--axis", "z"], "choose one of 1, 2, 3, 4, 5, 6"),
        (["--from", "wrench", "--relative"], "--relative is for --from base"),
        (["--omega-min", "500", "--omega-max", "100"], "less than"),
        (["--omega-min", "-5"], "omega-min"),
        (["--from", "wrench", "--amplitude", "1e-6"], "--amplitude shakes the base"),
        (["--amplitude", "0"], "amplitude"),
        (["--points", "1"], "points"),
        (["--psd", "nowhere.csv"], "nowhere.csv"),
        (["--set", "platform.mass=-1"], "platform.mass"),
    ],
)
def test_response_wrong_command_lines(run, arguments, message):
    code, out, err = run("response", "mukherjee-ii", *CENTER, *arguments)
    assert code == 2
    assert message in err
    assert out == ""


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "nothing in it"),
        ("hz,z\n1,2\n", "must have frequency_hz"),
        ("frequency_hz\n1\n", "must have frequency_hz"),
        ("frequency_hz,up\n1,2\n", "must have frequency_hz"),
        ("frequency_hz,z\n1,much\n2,3\n", "line 2, column z: 'much' is no finite number"),
        (
            "frequency_hz,z\n0,1\n1,1\n0.5,1\n",
            "line 4, column frequency_hz: 0.5 Hz; frequencies must be above zero and",
        ),
        ("frequency_hz,z\n-1,1\n1,1\n", "line 2, column frequency_hz: -1 Hz"),
        ("frequency_hz,z\n0,1\n1,1\n", "1 frequencies above 0 Hz; two or more"),
        ("frequency_hz,x_g2/Hz,z_mm2/Hz\n1,1,1\n2,1,1\n", "spectra of acceleration and displacement"),
        ("frequency_hz,z_N2/Hz\n1,1\n2,1\n", "'z_N2/Hz' has the unit 'N2_per_Hz'"),
        ("frequency_hz,z\n2,1\n1,1\n", "ascending"),
        ("frequency_hz,z\n1,1\n2,-1\n", "negative"),
        ("frequency_hz,z\n1,1\n2,\n", "line 3, column z: '' is no finite number"),
    ],
)
def test_bad_spectrum_files(run, tmp_path, text, message):
    path = tmp_path / "floor.csv"
    path.write_text(text)
    code, _, err = run("response", "mukherjee-ii", *CENTER, "--psd", path)
    assert code == 2
    assert message in err


FLOORS = {
    "Frequency (Hz),Z (m2/s4/Hz)": 1.0,
    "f_Hz;z_(m/s^2)^2/Hz": 1.0,
    "frequency_hz,z_g2/Hz": 9.80665**-2,
    "frequency [kHz],z [mm²/s³]": 1e6,
    "frequency_rad/s,z": 1.0,
}


@pytest.mark.parametrize("header", FLOORS)
def test_spectra_are_read_in_their_units(result, tmp_path, header):
    hertz = {"k": 1e-3, "r": 2 * np.pi}.get(header.split("[")[1][0] if "[" in header else header[10], 1.0)
    mark = ";" if ";" in header else ","
    rows = [f"{hertz * f:.15g}{mark}{1e-6 * FLOORS[header]:.15g}" for f in (1, 80)]
    path = tmp_path / "floor.csv"
    path.write_text("\n".join([header, *rows]), encoding="utf-8")
    expected = fx.random_response(fx.load("cubic-isolator"), psd=[1e-6, 1e-6], frequency=[1, 80], axis="z")
    found = result("response", "cubic-isolator", "--points", 5, "--psd", path)
    np.testing.assert_allclose(found["random_rms"]["leg_force"], expected.rms_leg_force, rtol=1e-10)


@pytest.mark.parametrize(("unit", "of"), [("mm2/Hz", "displacement"), ("(mm/s)2/Hz", "velocity")])
def test_a_spectrum_says_what_it_is_of(result, tmp_path, unit, of):
    path = tmp_path / "floor.csv"
    path.write_text(f"frequency_hz,z_{unit}\n1,1e-6\n80,1e-6\n")
    expected = fx.random_response(fx.load("cubic-isolator"), psd=[1e-12, 1e-12], frequency=[1, 80], axis="z", of=of)
    found = result("response", "cubic-isolator", "--points", 5, "--psd", path)
    np.testing.assert_allclose(found["random_rms"]["displacement"][2], expected.rms_displacement[2], rtol=1e-12)


def test_the_line_at_zero_of_welchs_method_is_left_out(result, tmp_path):
    path = tmp_path / "welch.csv"
    path.write_text("frequency_hz,z\n0,1\n1,1e-6\n80,1e-6\n")
    found = result("response", "cubic-isolator", "--points", 5, "--psd", path)
    assert "welch.csv, line 2: the density at 0 Hz is left out" in found["warnings"][0]
    path.write_text("frequency_hz,z\n1,1e-6\n80,1e-6\n")
    without = result("response", "cubic-isolator", "--points", 5, "--psd", path)
    assert (found["random_rms"], without["warnings"]) == (without["random_rms"], [])


@pytest.mark.parametrize("name", ["psd", "psd2"])
def test_spectra_as_people_write_them(result, name):
    found = result("response", "motion-base", "--points", 5, "--psd", case("recordings", f"{name}.csv"))
    assert found["random_rms"]["acceleration"][2] > 0


@pytest.mark.parametrize("source", ["wrench", "command"])
def test_a_spectrum_of_the_base_is_none_of_a_load(run, tmp_path, source):
    path = tmp_path / "wind.csv"
    path.write_text("frequency_hz,z\n1,1\n80,1\n")
    code, out, err = run("response", "cubic-isolator", "--from", source, "--psd", path)
    assert (code, out) == (2, "")
    assert f"not --from {source}" in err
    assert "on the platform are given by --load" in err


# --- animate -------------------------------------------------------------------------------------------------------


def test_animate_command(result, run, tmp_path, monkeypatch):
    path = tmp_path / "mode.gif"
    found = result("animate", "mukherjee-ii", *CENTER, "--mode", "3", "--exaggeration", "5000", "--out", path)
    assert (found["mode"], found["exaggeration"], found["file"]) == (3, 5000.0, str(path))
    with Image.open(path) as picture:
        assert picture.n_frames == 32
    for arguments in (["--mode", "7"], ["--out", tmp_path / "a.png"], ["--exaggeration", "-1"]):
        assert run("animate", "mukherjee-ii", *CENTER, *arguments)[0] == 2
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    code, _, err = run("animate", "mukherjee-ii", *CENTER, "--out", tmp_path / "a.mp4")
    assert code == 2
    assert "flexapod[video]" in err


# --- figures -------------------------------------------------------------------------------------------------------


def test_figures_say_what_they_show():
    hexapod = fx.load("motion-base")
    pose = fx.home_pose(hexapod)
    response = fx.transmissibility(hexapod, pose, omega=np.geomspace(5, 200, 30))
    figure = plots_response.frequency_response(response, "absolute", "x")
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert labels == ["amplitude, m/m", "amplitude, rad/m", "phase, deg", "phase, deg"]
    legend = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert legend == ["translation x"]
    still = "no motion: translation y, translation z, rotation about x, rotation about z"  # as symmetry has it
    assert figure.get_supxlabel() == still
    wrench = plots_response.frequency_response(response, "compliance", "roll")
    assert wrench.axes[0].get_ylabel() == "amplitude, m/(N m)"
    random = plots_response.random_spectra(fx.random_response(hexapod, pose, psd=[1.0, 1.0], omega=[5, 200], axis="z"))
    assert random.axes[0].get_ylabel() == "density, (m/s²)²/Hz"
    assert random.axes[-1].get_xlabel() == "frequency, Hz"
    assert len(random.axes) == 2  # no empty half for the rotations


@pytest.mark.parametrize(("first", "last", "modes"), [(0.5, 80, 0), (5, 80, 5), (0.5, 1, 6)])
def test_modes_outside_the_band_of_a_spectrum_are_told(result, tmp_path, first, last, modes):
    omega = fx.linearise(fx.load("cubic-isolator")).modes().omega / (2 * np.pi)
    file = tmp_path / "sound.csv"
    file.write_text(f"frequency_hz,force_z_N2/Hz\n{first},1e-6\n{last},1e-6\n")
    told = result("response", "cubic-isolator", "--points", 5, "--load", file)["warnings"]
    outside = omega[(omega < first) | (omega > last)]
    assert (len(outside), len(told)) == (modes, min(modes, 1))
    if modes:
        listed = told[0].partition("there lie modes, at ")[2].partition(" Hz")[0].split(", ")
        assert np.array(listed, float) == pytest.approx(outside, rel=5e-3)  # with losses a little lower


def test_two_loads_of_one_stem_keep_their_own_names(result, tmp_path):
    """A file of the same name in another folder, and one that is called as the moving base is."""
    names = [tmp_path / "day" / "wind.csv", tmp_path / "night" / "wind.csv", tmp_path / "base.csv"]
    for k, name in enumerate(names):
        name.parent.mkdir(exist_ok=True)
        name.write_text(f"frequency_hz,force_y\n1,{k + 1}\n60,{k + 1}\n")
    loads = [word for name in names for word in ("--load", name)]
    found = result("response", "cubic-isolator", *loads)["random_rms_by_source"]
    assert list(found) == [str(name) for name in names]
    y = [found[str(name)]["displacement"][1] for name in names]
    np.testing.assert_allclose(np.array(y) ** 2 / y[0] ** 2, [1, 2, 3], rtol=1e-9)
