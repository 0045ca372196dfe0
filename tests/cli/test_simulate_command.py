"""The command `flexapod simulate`: drives are understood, results written and exact, errors say what is wrong."""

import json

import numpy as np
import pytest
import xarray as xr
from tests.helpers.cases import case
from tests.helpers.plain import file

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
    for name in found["files"]:
        assert (out / name).stat().st_size > 100
    assert {name.rsplit(".")[-1] for name in found["files"]} == {"nc", "csv", "png"}


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


ISOLATOR = ("simulate", "cubic-isolator")
BASE = "motion-base"


def refused(capsys, *arguments):
    assert main([str(argument) for argument in arguments]) == 2
    return capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--duration", "20Hz"), "'20Hz' is not a number with a unit of time"),
        (("--duration", "1kN"), "unit of time"),
        (("--duration", "10mm"), "unit of time"),
        (("--duration", "-1s"), "duration is -1s; it must be finite and > 0"),
        (("--harmonic", "z", "1deg", "20Hz"), "--harmonic: '1deg' is not a number with a unit of length"),
        (("--harmonic", "z", "1um", "20ms"), "unit of frequency"),
        (("--harmonic", "roll", "1mm", "750"), "unit of angle"),
        (("--harmonic", "force:x", "1mm", "750"), "unit of force"),
        (("--harmonic", "moment:x", "1N", "750"), "unit of moment"),
        (("--sweep", "z", "1um", "1Hz", "2s", "3s"), "'2s' is not a number with a unit of frequency"),
        (("--sweep", "leg:1", "1N", "1Hz", "2Hz", "3s"), "unit of length"),
        (("--shock", "z", "1mm", "10ms"), "unit of acceleration"),
        (("--shock", "roll", "1g", "10ms"), "unit of angular acceleration"),
        (("--shock", "force:z", "3g", "10ms"), "unit of force"),
        (("--step", "leg:1", "1mm", "10Hz"), "unit of time"),
        (("--spin", "yaw", "30mm"), "unit of angular velocity"),
        (("--spin", "force:x", "3"), "--spin turns or moves the base"),
        (("--ramp", "5Hz"), "unit of time"),
        (("--force", "1", "2m", "3"), "unit of force"),
        (("--moment", "1", "2N", "3"), "unit of moment"),
        (("--random", "z", "sea:1Hz:8kN"), "'1Hz' is not a number with a unit of length"),
        (("--random", "z", "sea:1m:8kN"), "unit of time"),
        (("--random", "z", "sea:1m:8s:3N"), "GAMMA is '3N'"),
        (("--random", "z", "flat:10N:1:100"), "unit of acceleration"),
        (("--random", "force:z", "flat:10g:1:100"), "unit of force"),
        (("--random", "force:z", "VC-A"), "force:z takes flat:RMS:FROM:TO"),
        (("--random", "moment:z", "ground"), "moment:z takes flat:RMS:FROM:TO"),
        (("--random", "leg:1", "sea:1:8"), "leg:1 takes flat:RMS:FROM:TO"),
        (("--random", "roll", "VC-A"), "roll takes flat:RMS:FROM:TO"),
        (("--seed", -1), "-1 is not in the range"),
        (("--highpass", "1"), "--detrend and --highpass are for --recording"),
        (("--detrend", "median"), "'median' is not one of"),
    ],
)
def test_every_number_has_its_dimension(capsys, arguments, words):
    assert words in refused(capsys, *ISOLATOR, "--duration", "1ms", *arguments)


def test_units_of_each_dimension_are_read(result):
    first = result("--harmonic", "z", "0.001mm", "100 Hz", "--duration", "0.01 s", "--samples", 30)
    again = result("--harmonic", "z", "1µm", "6000rpm", "--duration", "10ms", "--samples", 30)
    assert first["displacement"]["largest"][2] == pytest.approx(again["displacement"]["largest"][2], rel=1e-12)


@pytest.mark.parametrize(
    ("text", "quantity"), [("1um", "displacement"), ("1um/s", "velocity"), ("0.1g", "acceleration")]
)
def test_the_unit_of_a_flat_spectrum_says_what_it_is_of(text, quantity):
    from flexapod.cli.options.drives import _spectrum

    assert _spectrum(f"flat:{text}:1Hz:10Hz", "base_motion", "z").quantity == quantity


def test_a_random_force_is_one_of_newtons(capsys):
    """Far below the modes the platform follows the force by its compliance: 10 N give 10 N times that."""
    drive = ("--random", "force:z", "flat:10N:0.1Hz:2Hz", "--ramp", "100ms", "--duration", "40s", "--samples", 4000)
    assert main([*map(str, ("simulate", "precision-positioner", *drive)), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    hexapod = fx.load("precision-positioner")
    soft = fx.transmissibility(hexapod, frequency=[0.5]).compliance.sel(output="z", wrench="z").values[0]
    # 400 sines over 40 s: the power of one record is met to some percent
    assert found["displacement"]["rms"][2] == pytest.approx(10 * abs(soft), rel=0.1)


def test_a_recording_gives_the_duration(capsys, tmp_path):
    """A recording of 60 s at 2 kHz ends half a millisecond before 60 s."""
    times = np.arange(2000) / 2000
    record = tmp_path / "floor.csv"
    np.savetxt(record, np.column_stack([times, 1e-6 * np.sin(90 * times)]), delimiter=",", header="time,z", comments="")
    for given in ((), ("--duration", 1), ("--duration", "0.9996")):
        assert main([*map(str, (*ISOLATOR, "--recording", "base", record, "--samples", 5, *given)), "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["duration_s"] == pytest.approx(0.9995)
    words = refused(capsys, *ISOLATOR, "--recording", "base", record, "--duration", 1.01)
    assert "ends at 0.9995 s, the simulation at 1.01 s" in words


@pytest.mark.parametrize(
    ("use", "name", "options", "words"),
    [
        ("base", "offset", (), r"offset.csv, column z) begins at 0.3 m in its first row, off zero"),
        ("base", "yawoffset", (), "begins at 90 degrees in its first row"),
        ("base", "acc2", (), "has a mean of 9.81 m/s2, which holds gravity, and drifts by 19.5 m within 1.99 s"),
        ("base", "offset", ("--start", "carried"), None),
        ("base", "offset", ("--detrend", "first"), "begins in motion, z with 0.006283 m/s, up to 100% of the greatest"),
        ("base", "yawoffset", ("--detrend", "first"), "begins in motion, yaw with 0.06283 degrees/s"),
        ("base", "wrap", ("--start", "carried"), None),
        ("base", "wrap2", ("--start", "carried"), None),
        ("base", "nowrap2", ("--start", "carried"), None),
        ("leg", "leglen", ("--detrend", "first"), "of leg_command begin in motion, 1 with 0.01 m/s, 2 with"),
        ("base", "offset", ("--detrend", "first", "--ramp", "100ms"), None),
    ],
)
def test_recordings_as_people_have_them(capsys, use, name, options, words):
    arguments = ("simulate", BASE, "--recording", use, case("recordings", f"{name}.csv"), *options, "--json")
    assert main([str(argument) for argument in arguments]) == 0
    found = json.loads(capsys.readouterr().out)
    if words is None:
        assert found["warnings"] == []
        assert 7e3 < min(found["leg_force_N"]["least"]) < max(found["leg_force_N"]["largest"]) < 9e3
    else:
        assert words in found["warnings"][0]


def test_lengths_of_legs_are_no_commands(capsys):
    record = case("recordings", "leglen.csv")
    words = refused(capsys, "simulate", BASE, "--recording", "leg", record)
    assert "leglen.csv, column leg1_mm) begins at 2.9 m in its first row" in words
    assert "detrend 'first'" in words


def test_what_a_recording_does_is_told_where_the_simulation_ends_early(capsys):
    words = refused(capsys, "simulate", BASE, "--recording", "base", case("recordings", "wrap2.csv"))
    assert "wrap2.csv, column yaw_deg) begins at 179 degrees" in words


def test_legs_that_leave_their_stroke_are_told(capsys):
    base = file("motion-base")  # legs of any length
    steps = [word for leg in range(1, 7) for word in ("--step", f"leg:{leg}", "700mm", "200ms")]
    assert main(["simulate", base, *steps, "--duration", "0.4", "--json"]) == 0
    (told,) = json.loads(capsys.readouterr().out)["warnings"]
    assert "length of legs 1, 2, 3, 4, 5, 6 is above its limit, first at t = 0.1295 s" in told
    assert "3.41038 m against 3.261 m" in told
    assert main(["simulate", base, *steps, "--duration", "0.4"]) == 0
    assert "Warning: Limit exceeded: length of legs" in capsys.readouterr().out


def test_a_balance_that_rounding_hides_is_said_to_be_none(run):
    """A millinewton on a mirror of 150 kg: its works are less than the rounding of the energy stored."""
    line = [
        "simulate",
        case("tangential-struts", "m2.toml"),
        "--harmonic",
        "force:z",
        "1e-3",
        "10",
        "--duration",
        "0.5",
    ]
    code, out, _ = run(*line)
    assert code == 0
    assert "rounding of the energy stored in springs and height hides them" in " ".join(out.split())
    code, out, _ = run(*line[:4], "1e3", *line[5:])
    assert "rounding" not in out
