"""The command `flexapod simulate`: drives are understood, results written and exact, errors say what is wrong."""

import json

import numpy as np
import pytest
import xarray as xr

import flexapod as fx
from flexapod.cli import main

MACHINE = ("simulate", "mukherjee-ii")


@pytest.fixture
def result(capsys):
    def call(*arguments):
        assert main([str(argument) for argument in (*MACHINE, *arguments, "--json")]) == 0
        return json.loads(capsys.readouterr().out)

    return call


def simulated(**drives):
    hexapod = fx.load("mukherjee-ii")
    return fx.simulate(hexapod, fx.home_pose(hexapod), duration=0.01, samples=30, **drives)


def test_every_drive_is_what_the_library_makes_of_it(result, tmp_path):
    record = tmp_path / "record.csv"
    times = np.linspace(0, 0.02, 201)
    lines = [f"{1e3 * t:.6g},{0.2 * np.sin(300 * t):.9g}" for t in times]
    record.write_text("\n".join(["time_ms,y_um", *lines]))
    found = result(
        *("--harmonic", "z", "1um", "100Hz", "--harmonic", "leg:3", "2e-7", 500, "--sweep", "roll", "1urad", 200, 900),
        *("10ms", "--shock", "x", "0.1g", "2ms", "--shock", "force:x", 3, "2ms", "--step", "moment:z", 0.1, "5ms"),
        *("--random", "pitch", "flat:0.5:100:900", "--seed", 5, "--recording", "base", record, "--ramp", "1ms"),
        *("--duration", "10ms", "--samples", 30),
    )
    base = (
        fx.harmonic("z", 1e-6, 200 * np.pi)
        + fx.sine_sweep("roll", 1e-6, 200, 900, 0.01)
        + fx.half_sine_shock("x", 0.980665, 2e-3, recovery=8e-3)
        + fx.random_motion("pitch", fx.excitation.flat_spectrum(0.5, 100, 900), seed=5)
        + fx.excitation.time_series(times, 2e-7 * np.sin(300 * times), "y")
    )
    expected = simulated(
        base_motion=base.ramped(1e-3),
        force=fx.excitation.half_sine_pulse("x", 3.0, 2e-3).ramped(1e-3),
        moment=fx.excitation.smooth_step("z", 0.1, 5e-3).ramped(1e-3),
        leg_command=fx.harmonic("3", 2e-7, 500).ramped(1e-3),
    )
    largest = np.abs(expected.displacement.values).max(axis=0)
    # The recording's nine digits, and sums in another order.
    np.testing.assert_allclose(found["displacement"]["largest"], largest, rtol=1e-6)
    assert found["energy_error"] < 1e-6


def test_constant_loads_start_and_spin(result):
    found = result(
        "--spin", "yaw", "30rpm", "--start", "carried", "--force", 5, 0, 0, "--duration", 0.01, "--samples", 30
    )
    expected = simulated(base_motion=fx.excitation.polynomial("yaw", [0, np.pi]), start="carried", force=(5.0, 0, 0))
    largest = np.abs(expected.displacement.values).max(axis=0)
    np.testing.assert_allclose(found["displacement"]["largest"], largest, rtol=1e-9)
    ringing = result("--unloaded", "--duration", 0.01)
    assert ringing["displacement"]["largest"][2] > 1e-8
    assert result("--duration", 0.01)["displacement"]["largest"][2] < 1e-15


def test_files_hold_the_motion(result, tmp_path):
    out = tmp_path / "run"
    arguments = ("--harmonic", "z", "1um", 750, "--duration", 0.01, "--samples", 30, "--reactions", "--out", out)
    found = result(*arguments)
    expected = simulated(base_motion=fx.harmonic("z", 1e-6, 750), reactions=True)
    with xr.open_dataset(out / "simulation.nc") as stored:
        np.testing.assert_array_equal(stored.displacement, expected.displacement)
        np.testing.assert_array_equal(stored.universal_moment, expected.universal_moment)
        assert stored.leg_force.attrs["units"] == "N"
    table = np.genfromtxt(out / "simulation.csv", delimiter=",", names=True)
    np.testing.assert_allclose(table["displacement_z_m"], expected.displacement[:, 2], rtol=1e-11, atol=1e-30)
    np.testing.assert_allclose(table["leg_force_6_N"], expected.leg_force[:, 5], rtol=1e-11)
    for file in found["files"]:
        assert (out / file).stat().st_size > 100
    assert {file.rsplit(".")[-1] for file in found["files"]} == {"nc", "csv", "png"}


def test_a_table_is_shown(capsys):
    assert main([*MACHINE, "--harmonic", "z", "1um", "750", "--duration", "10ms"]) == 0
    shown = capsys.readouterr().out
    assert "largest" in shown
    assert "energy balance error" in shown


def test_a_coarse_recording_is_told(result, tmp_path):
    record = tmp_path / "coarse.csv"
    record.write_text("time_ms,z_um\n" + "\n".join(f"{i},{np.sin(0.1 * i)}" for i in range(40)))
    assert "sampled every 0.001 s" in result("--recording", "base", record, "--duration", "20ms")["warnings"][0]


def test_a_motion_that_ends_early_is_kept(capsys, tmp_path):
    soft = ("--set", "legs.stiffness=100", "--set", "gravity=[0,0,0]")
    push = ("--step", "force:z", "-100", "1ms", "--duration", "1", "--out", str(tmp_path))
    assert main([*MACHINE, *soft, *push]) == 2
    assert "det H changes sign" in capsys.readouterr().err
    with xr.open_dataset(tmp_path / "simulation.nc") as stored:
        assert stored.attrs["status"] == "singular"
        assert stored.time[-1] < 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--harmonic", "q", 1, 1, "--duration", 1), "channel 'q' is unknown"),
        (("--harmonic", "force:roll", 1, 1, "--duration", 1), "channel 'force:roll' is unknown"),
        (("--harmonic", "z", "1ly", 1, "--duration", 1), "'1ly' is not a number"),
        (("--harmonic", "z", "nan", 1, "--duration", 1), "'nan' is not a number"),
        (("--random", "z", "VC-Q", "--duration", 1), "spectrum 'VC-Q' is unknown"),
        (("--random", "z", "sea:2", "--duration", 1), "spectrum 'sea:2' is unknown"),
        (("--harmonic", "z", 1, 1), "Missing option '--duration'"),
        (("--duration", 0), "duration is 0"),
        (("--duration", 1, "--rtol", 1), "rtol is 1"),
        (("--force", 1, 0, 0, "--step", "force:x", 1, 1, "--duration", 1), "constant or driven"),
        (("--recording", "base", "none.csv", "--duration", 1), "none.csv"),
    ],
)
def test_what_is_wrong_is_said(capsys, arguments, words):
    assert main([str(argument) for argument in (*MACHINE, *arguments)]) == 2
    assert words in capsys.readouterr().err
