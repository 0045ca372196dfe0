"""What loggers, spreadsheets and CAD programs write: read by one reader, or refused with the place that is wrong."""

import re

import numpy as np
import pytest
from tests.helpers.cases import case
from tests.helpers.plain import plain_machine

import flexapod as fx

TIMES = np.linspace(0.0, 1.0, 101)


def read(name, **options):
    return fx.read_time_series(case("recordings", f"{name}.csv"), **options)


def written(path, text):
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", ["bom", "brackets", "hash", "quoted", "semi", "tab", "upper"])
def test_every_dialect_is_the_same_motion(name):
    np.testing.assert_array_equal(read(name).evaluate(TIMES), read("plain").evaluate(TIMES))


def test_a_separator_at_the_end_of_lines_is_no_column():
    z = read("plain").evaluate(TIMES)[0][:, 2]
    np.testing.assert_allclose(read("trailing").evaluate(TIMES)[0][:, 2], z, atol=1e-15)


def test_time_may_count_from_1970():
    found = read("unix0").evaluate([0.0, 0.25, 0.5])[0][:, 2]
    np.testing.assert_allclose(found, 1e-3 * np.sin(2 * np.pi * np.array([0.0, 0.25, 0.5])), atol=1e-8)


def test_units_may_stand_in_a_line_of_their_own(tmp_path):
    rows = case("recordings", "plain.csv").read_text().splitlines()[1:]
    found = fx.read_time_series(written(tmp_path / "a.csv", "\n".join(["Time,Heave,Roll", "[s],m,°", *rows])))
    np.testing.assert_array_equal(found.evaluate(TIMES), read("plain").evaluate(TIMES))


@pytest.mark.parametrize("name", ["deg", "t"])
def test_an_angle_without_a_unit_is_refused(name):
    with pytest.raises(fx.ArgumentError, match=rf"{name}\.csv: column 'roll' names no unit.*roll_rad.*roll_deg"):
        read(name)


def test_an_angle_goes_on_past_a_half_turn():
    np.testing.assert_allclose(read("wrap2").evaluate(TIMES * 0.6), read("nowrap2").evaluate(TIMES * 0.6), atol=1e-6)
    yaw = np.degrees(read("wrap").evaluate(TIMES * 0.6)[0][:, 5])
    assert (np.diff(yaw) > 0).all()


def test_an_angle_that_jumps_is_told_by_its_line(tmp_path):
    lines = ["time,roll_deg", *(f"{0.01 * i:g},{i if i < 10 else i + 180}" for i in range(20))]
    with pytest.raises(fx.ArgumentError, match=r"jump\.csv: roll_deg goes from 9 to 190 degrees at sample 11.*line 12"):
        fx.read_time_series(written(tmp_path / "jump.csv", "\n".join(lines)))


def test_a_bad_row_is_told_by_its_line(tmp_path):
    lines = ["# a logger", "time,z", *(f"{0.01 * i:g},{i}" for i in range(20))]
    lines[9] = "0.07,"
    with pytest.raises(fx.ArgumentError, match=r"hole\.csv: z is nan at sample 8 of 20 \(line 10\)"):
        fx.read_time_series(written(tmp_path / "hole.csv", "\n".join(lines)))


@pytest.mark.parametrize(
    ("unit", "use"), [("mm", "motion"), ("N", "force"), ("Nm", "moment"), ("kN·m", "moment"), ("g", "motion")]
)
@pytest.mark.filterwarnings("ignore:.*begins in motion")
def test_a_column_drives_what_its_unit_can_drive(tmp_path, unit, use):
    rows = "\n".join(f"{0.01 * i:g},{1e-3 * np.sin(i):.6f}" for i in range(20))
    found = fx.read_time_series(written(tmp_path / "a.csv", f"time,x_{unit}\n{rows}"))
    machine = plain_machine("cubic-isolator")
    for name, taken in (("base_motion", "motion"), ("force", "force"), ("moment", "moment")):
        if taken == use:
            fx.simulate(machine, duration=0.01, samples=2, **{name: found})
        else:
            words = (
                rf"{name} drives 'x' by what is a {use} \(.*a\.csv, column x_{re.escape(unit)}\); it takes a {taken}"
            )
            with pytest.raises(fx.ArgumentError, match=words):
                fx.simulate(machine, duration=0.01, samples=2, **{name: found})


def test_accelerations_may_be_in_g():
    np.testing.assert_allclose(
        read("acc").evaluate(TIMES)[2][:, 2], read("acc2").evaluate(TIMES)[2][:, 2] * 9.80665, rtol=1e-12
    )


def test_offset_and_gravity_of_an_accelerometer_can_be_taken_out():
    """acc2 is 9.81 + 0.05 sin(pi t) m/s2 over one period: without its mean and its drift, a sine of 5 mm."""
    t = 0.01 * np.arange(200)
    sine = -0.05 / np.pi**2 * np.sin(np.pi * t)
    expected = sine - np.polyval(np.polyfit(t, sine, 1), t)
    found = read("acc2", detrend="mean").evaluate(t)
    np.testing.assert_allclose(found[0][:, 2], expected, atol=1e-7)
    assert np.abs(read("acc2").evaluate(t)[0][:, 2]).max() == pytest.approx(0.5 * 9.81 * 4, rel=0.01)


def test_slow_noise_of_an_accelerometer_can_be_filtered_out():
    t = np.arange(0.0, 60.0, 1 / 200)
    rng = np.random.default_rng(0)
    truth = 1e-6 * np.sin(2 * np.pi * 10 * t)
    measured = -((2 * np.pi * 10) ** 2) * truth + 1e-3 + 1e-5 * rng.standard_normal(t.size)
    found = fx.excitation.time_series(t, measured, "z", recorded="acceleration", highpass=2 * np.pi * 2.0)
    inner = slice(400, -400)  # the filter begins and ends with a transient
    np.testing.assert_allclose(found.evaluate(t[inner])[0][:, 2], truth[inner], atol=3e-8)
    raw = fx.excitation.time_series(t, measured, "z", recorded="acceleration")
    assert np.abs(raw.evaluate(t)[0]).max() > 1.0  # metres


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"detrend": "median"}, "detrend is 'median'"),
        ({"highpass": 0.0}, "highpass is 0.0 rad/s"),
        ({"highpass": 400.0}, "must be below 314.159 rad/s"),
        ({"times": np.r_[TIMES[:50], TIMES[50:] + 0.004]}, "0.014 s at sample 51 of 101; highpass needs even"),
        ({"times": TIMES[:10]}, "10 samples; highpass needs 16"),
    ],
)
def test_what_a_filter_cannot_do_is_told(change, words):
    given = {"times": TIMES, "highpass": 20.0, **change}
    times = given.pop("times")
    with pytest.raises(fx.ArgumentError, match=words):
        fx.excitation.time_series(times, np.sin(9 * times), "z", **given)
