"""Excitations: exact derivatives, spectra that have the power they name, recordings, clear errors."""

import pickle

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.errors import ArgumentError

HERTZ = 2 * np.pi
TIMES = np.linspace(0.0, 2.0, 201)
RECORD = np.linspace(0.0, 3.0, 301)

KINDS = {
    "harmonic": fx.harmonic("z", 2.0, 7.0, 0.3),
    "sum of harmonics": fx.harmonic("z", [1.0, 0.5, -0.2], [3.0, 11.0, 0.0], [0.0, 1.0, 2.0]),
    "many harmonics": fx.random_motion(
        "z", fx.excitation.flat_spectrum(1.0, 2.0, 40.0, quantity="displacement"), seed=1, samples=50
    ),
    "linear sweep": fx.sine_sweep("z", 1.0, 5.0, 30.0, 1.5, law="linear"),
    "log sweep": fx.sine_sweep("z", 1.0, 30.0, 5.0, 1.5, hold="velocity"),
    "sweep with held acceleration": fx.sine_sweep("z", 1.0, 5.0, 30.0, 1.5, hold="acceleration"),
    "shock": fx.half_sine_shock("z", 20.0, 0.53),
    "shock with recovery": fx.half_sine_shock("z", 20.0, 0.53, recovery=0.9),
    "pulse": fx.excitation.half_sine_pulse("z", 20.0, 0.53),
    "polynomial": fx.excitation.polynomial("z", [0.1, -0.2, 0.3, 0.0, 0.5]),
    "smooth step": fx.excitation.smooth_step("z", 0.7, 1.33),
    "recorded values": fx.excitation.time_series(RECORD, np.sin(5 * RECORD), "z"),
    "recorded velocity": fx.excitation.time_series(RECORD, np.sin(5 * RECORD), "z", recorded="velocity"),
    "recorded acceleration": fx.excitation.time_series(RECORD, np.sin(5 * RECORD), "z", recorded="acceleration"),
    "ramped": fx.harmonic("z", 2.0, 7.0, 0.3).ramped(1.1),
    "stopped": fx.harmonic("z", 2.0, 7.0, 0.3).ramped(0.3).stopped(1.01, 0.7),
    "delayed": (3 * fx.harmonic("z", 2.0, 7.0)).delayed(0.21),
}


@pytest.mark.parametrize("excitation", KINDS.values(), ids=KINDS.keys())
def test_derivatives_are_those_of_the_value(excitation):
    """Central differences of order 4 on a step that leaves 1e-9 of the scales here."""
    step = 1e-3
    times = TIMES[2:-2] + 5e-3  # no stencil across a corner: those are at multiples of 0.01 s
    ahead, behind, far_ahead, far_behind = (
        [v[:, 2] for v in excitation.evaluate(times + k * step)] for k in (1, -1, 2, -2)
    )
    _, rate, acceleration = (v[:, 2] for v in excitation.evaluate(times))
    for order, exact in ((0, rate), (1, acceleration)):
        difference = 8 * (ahead[order] - behind[order]) - (far_ahead[order] - far_behind[order])
        # Step^4 / 30 times the fifth derivative: (40 rad/s)^4 1e-12 / 30 is 9e-8 of the derivative for the fastest;
        # the ramps' and splines' jumps in higher derivatives leave about 1e-5 where a stencil spans them.
        np.testing.assert_allclose(difference / (12 * step), exact, atol=1e-4 * np.abs(exact).max())


@pytest.mark.parametrize("name", ["harmonic", "sum of harmonics", "many harmonics"])
def test_sums_of_sines_are_exact(name):
    """Long sums go by Taylor series inside; the answer is the sum, wherever time jumps to."""
    excitation = KINDS[name]
    A, w, phase = excitation.terms[0].numbers.reshape(-1, 3).T
    times = np.random.default_rng(3).uniform(0, 50, 400)
    angle = np.outer(times, w) + phase
    expected = (A * np.sin(angle)).sum(1), (A * w * np.cos(angle)).sum(1), -(A * w**2 * np.sin(angle)).sum(1)
    for found, exact in zip(excitation.evaluate(times), expected, strict=True):
        # Angles up to 2000 rad round by 2e-13.
        np.testing.assert_allclose(found[:, 2], exact, atol=1e-11 * np.abs(exact).max())


def test_sweep_starts_and_ends_at_its_frequencies():
    sweep = fx.sine_sweep("x", 1e-3, 10.0, 400.0, 500.0, hold="acceleration")
    for about, omega in ((0.3, 10.0), (501.0, 400.0)):
        times = about + np.linspace(0, 3 * np.pi / omega, 2000)
        value, _, acceleration = (v[:, 0] for v in sweep.evaluate(times))
        peak = np.abs(acceleration).max()
        assert np.abs(value).max() == pytest.approx(peak / omega**2, rel=0.02)  # what it sweeps in a second
        assert peak == pytest.approx(1e-3 * 10.0**2, rel=0.02)  # held


def test_half_sine_shock_has_its_pulse_and_comes_to_rest():
    shock = fx.half_sine_shock("y", 50.0, 0.011, recovery=0.05)
    assert shock.evaluate(0.0055)[2][1] == pytest.approx(50.0, rel=1e-12)  # the peak, by definition
    assert shock.evaluate(0.011)[1][1] == pytest.approx(2 * 50.0 * 0.011 / np.pi, rel=1e-12)
    value, rate, acceleration = shock.evaluate([1.0, 2.0])
    assert value[0, 1] == value[1, 1] > 0
    assert np.all(rate == 0)
    assert np.all(acceleration == 0)
    going_on = fx.half_sine_shock("y", 50.0, 0.011).evaluate([1.0, 2.0])
    assert np.diff(going_on[0][:, 1]) == pytest.approx(2 * 50.0 * 0.011 / np.pi, rel=1e-12)


def test_excitations_add_scale_and_begin_when_told():
    a, b = fx.harmonic("x", 1.0, 2.0), fx.harmonic("roll", 0.1, 3.0)
    both = 2.0 * (a + b).delayed(0.5)
    assert both.channels == ("x", "roll")
    value = both.evaluate([0.4, 0.9])[0]
    assert np.all(value[0] == 0)
    np.testing.assert_allclose(value[1], [2 * np.sin(0.8), 0, 0, 0.2 * np.sin(1.2), 0, 0], rtol=1e-14)
    stopped = a.stopped(1.0, 0.5).evaluate([0.9, 1.6])[0][:, 0]
    np.testing.assert_allclose(stopped, [np.sin(1.8), 0.0], rtol=1e-14)


# --- the base's motion -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["rpy", "vector"])
@pytest.mark.parametrize("size", [1e-7, 0.2, 2.0])
def test_base_turns_as_its_angles_say(kind, size):
    angles = {"roll": (1.0, 3.0, 0.2), "pitch": (0.7, 2.0, 1.0), "yaw": (-0.8, 1.0, 2.0)}
    motion = fx.Excitation()
    for channel, (amplitude, omega, phase) in angles.items():
        motion = motion + fx.harmonic(channel, size * amplitude, omega, phase)
    rest = fx.Pose((1.0, 2.0, 3.0), Rotation.from_rotvec([0.3, -0.2, 0.1]))
    if kind == "vector":
        motion = motion.as_rotation_vector()

    def turn(t):
        e = motion.evaluate(t)[0][..., 3:]
        return (Rotation.from_euler("xyz", e) if kind == "rpy" else Rotation.from_rotvec(e)) * rest.rotation

    times, step = np.linspace(0.1, 3.0, 30), 1e-4
    found = motion.motion(times, rest)
    np.testing.assert_allclose(found.pose.matrix, turn(times).as_matrix(), atol=1e-15)
    np.testing.assert_allclose(found.pose.position, np.tile(rest.position, (30, 1)), rtol=0)
    # R(t+h) R(t-h)^T = exp(2 h w + O(h^3)), rounded by 1e-16 / h: small motions keep relative precision in the core,
    # but not in this difference of matrices.
    w = (turn(times + step) * turn(times - step).inv()).as_rotvec() / (2 * step)
    np.testing.assert_allclose(found.angular_velocity, w, atol=3e-7 * size + 1e-11)
    ahead, behind = (motion.motion(times + k * step, rest).angular_velocity for k in (1, -1))
    np.testing.assert_allclose(found.angular_acceleration, (ahead - behind) / (2 * step), atol=1e-5 * size)


def test_base_spins_without_end():
    spin = fx.excitation.polynomial("yaw", [0.0, 40.0])
    for motion in (spin.motion([0.0, 1.0, 7.3]), spin.as_rotation_vector().motion([0.0, 1.0, 7.3])):
        np.testing.assert_allclose(motion.angular_velocity, [[0, 0, 40.0]] * 3, rtol=1e-15)
        np.testing.assert_allclose(motion.angular_acceleration, 0, atol=1e-11)
        expected = Rotation.from_rotvec(np.outer([0, 40.0, 292.0], [0, 0, 1])).as_matrix()
        np.testing.assert_allclose(motion.pose.matrix, expected, atol=1e-13)


def test_a_sum_of_both_kinds_of_rotation_is_refused():
    a, b = fx.harmonic("roll", 0.1, 1.0), fx.harmonic("yaw", 0.1, 1.0).as_rotation_vector()
    with pytest.raises(ArgumentError, match="rotation vector"):
        a + b
    assert (fx.harmonic("x", 1.0, 1.0) + b).rotation == "vector"


# --- spectra ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("spectrum", "derivative"),
    [
        (fx.excitation.flat_spectrum(3e-3, 20.0, 500.0), 2),
        (fx.vc_curve("VC-C"), 1),
        (fx.excitation.ground_noise("high"), 2),
        (fx.excitation.sea_spectrum(3.0, 9.0, 3.3), 0),
    ],
)
def test_random_motion_has_its_spectrum(spectrum, derivative):
    motion = fx.random_motion("z", spectrum, seed=7, samples=500)
    length = 100 * 2 * np.pi * 500 / spectrum.omega_max
    values = motion.evaluate(np.linspace(0, length, 10000))[derivative][:, 2]
    # Sum of A^2 / 2 over the lines against the integral of the density: bands of 1/500 of the range, and a finite time.
    assert np.sqrt(np.mean(values**2)) == pytest.approx(spectrum.rms(), rel=0.03)


def test_vc_curves_have_their_speed_in_each_one_third_octave():
    for name, speed in (("VC-A", 50e-6), ("VC-E", 3.12e-6)):
        spectrum = fx.vc_curve(name)
        for middle in (10.0, 20.0, 40.0, 63.0):
            omega = HERTZ * np.linspace(middle * 2 ** (-1 / 6), middle * 2 ** (1 / 6), 2001)
            band = np.sqrt(np.trapezoid(spectrum.density(omega), omega))
            assert band == pytest.approx(speed, rel=0.01)  # the width of a band over its middle, log against linear
    omega = HERTZ * np.linspace(5 * 2 ** (-1 / 6), 5 * 2 ** (1 / 6), 2001)
    acceleration = np.sqrt(np.trapezoid(omega**2 * fx.vc_curve("VC-A").density(omega), omega))
    assert acceleration == pytest.approx(260e-6 * 9.81, rel=0.02)  # published: 260 ug from 4 to 8 Hz


def test_ground_noise_is_petersons():
    density = fx.excitation.ground_noise("high").density(np.array([HERTZ])) * HERTZ  # per Hz, at 1 s
    assert 10 * np.log10(density[0]) == pytest.approx(-116.85, abs=1e-9)  # a of the row from 0.8 s
    for model in ("low", "high"):
        omega = np.geomspace(0.01 * HERTZ, 10 * HERTZ, 40000)
        level = 10 * np.log10(fx.excitation.ground_noise(model).density(omega))
        assert np.abs(np.diff(level)).max() < 0.15  # published with two digits, the rows meet to about 0.1 dB


def test_sea_has_its_height_and_peak():
    for gamma in (1.0, 3.3):
        sea = fx.excitation.sea_spectrum(4.0, 10.0, gamma)
        assert 4 * sea.rms() == pytest.approx(4.0, rel=1e-3)  # by definition; the tables' grids differ
        omega = np.linspace(0.3, 1.5, 4001)
        assert omega[np.argmax(sea.density(omega))] == pytest.approx(HERTZ / 10, rel=1e-3)
    # Pierson and Moskowitz: S = (5/16) Hs^2 wp^4 w^-5 exp(-1.25 (wp/w)^4), but for 1e-4 of energy left out.
    w, peak = np.array([0.5, 0.9]), HERTZ / 10
    expected = 5 / 16 * 16 * peak**4 / w**5 * np.exp(-1.25 * (peak / w) ** 4)
    np.testing.assert_allclose(fx.excitation.sea_spectrum(4.0, 10.0).density(w), expected, rtol=1e-3)


def test_a_ships_motions_follow_one_sea():
    """Heave as the wave, pitch a quarter period later: their product averages to nothing, their lines are the same."""
    sea = fx.excitation.sea_spectrum(2.0, 8.0)
    motion = fx.excitation.sea_motion(
        sea, {"z": lambda w: np.ones_like(w), "pitch": lambda w: 1j * w**2 / 9.81}, seed=4
    )
    heave, pitch = (term.numbers.reshape(-1, 3) for term in motion.terms)
    np.testing.assert_array_equal(heave[:, 1], pitch[:, 1])
    np.testing.assert_allclose(pitch[:, 2] - heave[:, 2], np.pi / 2, rtol=1e-12)
    np.testing.assert_allclose(pitch[:, 0], heave[:, 0] * heave[:, 1] ** 2 / 9.81, rtol=1e-12)


@pytest.mark.parametrize(
    "spectrum",
    [
        fx.vc_curve("VC-A"),
        fx.excitation.ground_noise("low"),
        fx.excitation.sea_spectrum(2.0, 8.0, 3.3),
        fx.excitation.flat_spectrum(1.0, 1.0, 9.0, quantity="moment"),
    ],
)
def test_spectra_go_to_other_processes(spectrum):
    sent = pickle.loads(pickle.dumps(spectrum))
    omega = np.geomspace(spectrum.omega_min, spectrum.omega_max, 40)
    np.testing.assert_array_equal(sent.density(omega), spectrum.density(omega))
    own = ("quantity", "omega_min", "omega_max", "unit")
    assert [getattr(sent, name) for name in own] == [getattr(spectrum, name) for name in own]


def test_a_random_force_has_the_rms_of_its_spectrum():
    force = fx.random_motion("z", fx.excitation.flat_spectrum(10.0, 5.0, 200.0, quantity="force"), seed=3)
    assert force.evaluate(np.linspace(0, 200, 40001))[0][:, 2].std() == pytest.approx(10.0, rel=0.02)


@pytest.mark.parametrize(
    ("argument", "drive", "is_a"),
    [
        ("force", fx.random_motion("z", fx.vc_curve("VC-A")), "motion"),
        ("force", fx.half_sine_shock("z", 1.0, 0.01), "motion"),
        ("moment", fx.sine_sweep("z", 1.0, 1.0, 2.0, 1.0, hold="acceleration"), "motion"),
        ("moment", fx.random_motion("z", fx.excitation.flat_spectrum(1.0, 5.0, 9.0, quantity="force")), "force"),
        ("base_motion", fx.random_motion("z", fx.excitation.flat_spectrum(1.0, 5.0, 9.0, quantity="force")), "force"),
    ],
)
def test_a_drive_goes_where_its_quantity_belongs(argument, drive, is_a):
    with pytest.raises(ArgumentError, match=f"{argument} drives 'z' by what is a {is_a}; it takes a"):
        fx.simulate(plain_machine("cubic-isolator"), duration=0.1, **{argument: drive})


# --- recordings ------------------------------------------------------------------------------------------------------


def test_recording_is_splined_smoothly():
    times = np.linspace(5.0, 8.0, 601)
    found = fx.excitation.time_series(times, np.sin(4 * (times - 5.0)), "x").evaluate(np.linspace(0, 3, 999))
    t = np.linspace(0, 3, 999)
    exact = np.sin(4 * t), 4 * np.cos(4 * t), -16 * np.sin(4 * t)
    for value, expected, tolerance in zip(found, exact, (1e-11, 1e-8, 1e-5), strict=True):
        # A quintic spline on steps h errs by (4h)^6, (4h)^5, (4h)^4 of each derivative, some more at the ends.
        np.testing.assert_allclose(value[:, 0], expected, atol=tolerance * np.abs(expected).max())


def test_recorded_acceleration_is_integrated_from_rest():
    times = np.linspace(0, 2, 2001)
    found = fx.excitation.time_series(times, np.cos(3 * times), "z", recorded="acceleration").evaluate(times)
    exact = (1 - np.cos(3 * times)) / 9, np.sin(3 * times) / 3, np.cos(3 * times)
    for value, expected in zip(found, exact, strict=True):
        np.testing.assert_allclose(value[:, 2], expected, atol=1e-10)  # cubics on steps of 3 mrad: 1e-11


def write(path, text):
    path.write_text(text)
    return path


ROWS = "\n".join(f"{10 * i},{np.sin(0.1 * i)},{i}" for i in range(20))


def test_csv_units_and_kinds(tmp_path):
    found = fx.read_time_series(write(tmp_path / "a.csv", f"# shaker 3\ntime_ms,z_um,roll_deg\n{ROWS}\n"))
    value = found.evaluate(0.1)[0]
    np.testing.assert_allclose(value[[2, 3]], [np.sin(1.0) * 1e-6, np.radians(10)], rtol=1e-12)
    accelerometer = fx.read_time_series(write(tmp_path / "b.csv", f"time_ms,x_mm_per_s2,y_mm_per_s2\n{ROWS}\n"))
    acceleration = accelerometer.evaluate(0.1)[2]
    np.testing.assert_allclose(acceleration[:2], [np.sin(1.0) * 1e-3, 10e-3], rtol=1e-6)
    assert fx.read_time_series(write(tmp_path / "c.csv", f"time_ms,leg1_um,leg6_um\n{ROWS}")).channels == ("1", "6")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "nothing"),
        ("time,z\n1,2\n", "six or more"),
        (f"time,z,q\n{ROWS}", "'q' is unknown"),
        (f"time,z,roll_mm\n{ROWS}", "unit 'mm'"),
        (f"time,z_parsec,roll\n{ROWS}", "unit 'parsec'"),
        (f"time_ms,z_m_per_s2,roll\n{ROWS}\nq", "line 22 has 1 entries"),
        (f"time_ms,z_m_per_s2,roll_deg\n{ROWS}", "of one kind"),
        (f"time,z,roll_deg\n{ROWS}".replace("50,", "fifty,"), "line 7, column time: 'fifty' is no number"),
        (f"time,z,roll_deg\n{ROWS}".replace("\n50,", "\n,"), "time is nan at sample 6"),
        (f"time,z,roll_deg\n{ROWS}".replace("\n50,", "\n40,"), "must ascend"),
        (f"time,z,roll_deg\n{ROWS}".replace("\n50,", "\n#50,"), "1 gap: nothing between 40 and 60 s"),
        (f"time,z,roll_deg\n{ROWS}".replace(",7\n", ",nan\n"), "roll_deg is nan at sample 8"),
        (f"time,z,z\n{ROWS}", "'z' and 'z' are the same"),
        (f"z,x,y\n{ROWS}", "needed once"),
    ],
)
def test_bad_recordings_are_told_what_is_wrong(tmp_path, text, words):
    with pytest.raises(ArgumentError, match=words) as caught:
        fx.read_time_series(write(tmp_path / "bad.csv", text))
    assert "bad.csv" in str(caught.value)


def test_missing_recording(tmp_path):
    with pytest.raises(ArgumentError, match="cannot be read"):
        fx.read_time_series(tmp_path / "none.csv")


FORCE = fx.excitation.flat_spectrum(3.0, 10.0, 90.0, quantity="force")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: fx.harmonic("up", 1.0, 1.0), "axis is 'up'"),
        (lambda: fx.harmonic("x", np.nan, 1.0), "NaN"),
        (lambda: fx.harmonic("x", 1.0, -1.0), "omega is -1"),
        (lambda: fx.harmonic("x", []), "give one of omega"),
        (lambda: fx.harmonic("x", 10**400, 1.0), "amplitude is an integer of 1329 bits"),
        (lambda: fx.harmonic("x", "much", 1.0), "amplitude is 'much'; it must hold numbers"),
        (lambda: fx.harmonic("x", [1, 2], [1, 2, 3]), r"shapes \(2,\) and \(3,\) and \(\)"),
        (lambda: np.nan * fx.harmonic("x", 1.0, 1.0), "factor of an excitation is nan"),
        (lambda: fx.harmonic("x", 1.0, 1.0).evaluate("now"), "times is 'now'"),
        (lambda: fx.harmonic("x", 1.0, 1.0).on({"y": "z"}), "axes takes 'x' to None"),
        (lambda: fx.harmonic("x", 1.0, 1.0).on({"x": np.zeros(3)}), "axes takes 'x' to array"),
        (lambda: fx.excitation.polynomial("x", "t"), "coefficients is 't'"),
        (lambda: fx.random_motion("x", None), "spectrum is None"),
        (lambda: fx.excitation.flat_spectrum(1e200, 1.0, 2.0), "rms is 1e.200; it must be at most"),
        (lambda: fx.excitation.sea_spectrum(1e200, 1.0), "height is 1e.200"),
        (lambda: fx.excitation.time_series(RECORD, ["a"] * 301, "x"), "must hold numbers"),
        (lambda: fx.excitation.time_series(RECORD, np.zeros((301, 2)), ["x", "x"]), "each once"),
        (lambda: fx.excitation.time_series(RECORD, np.zeros(301), 5), "axis is 5"),
        (lambda: fx.harmonic("x", [], 5.0), "empty; at least one sine"),
        (lambda: fx.excitation.flat_spectrum(1.0, 1.0, 2.0, quantity="jerk"), "quantity is 'jerk'"),
        (lambda: fx.random_motion("roll", fx.vc_curve("VC-A")), "axis is 'roll'.*must be one of rad"),
        (lambda: fx.random_motion("roll", FORCE), "spectrum is one of force"),
        (lambda: fx.excitation.sea_motion(FORCE, {"z": np.ones_like}), "spectrum is one of force"),
        (lambda: fx.harmonic("x", 1.0, 1.0).for_use("pressure"), "use is 'pressure'"),
        (lambda: fx.sine_sweep("x", 1.0, 0.0, 2.0, 1.0), "omega_start is 0"),
        (lambda: fx.sine_sweep("x", 1.0, 1.0, 2.0, 1.0, law="cubic"), "law is 'cubic'"),
        (lambda: fx.sine_sweep("x", 1.0, 1.0, 2.0, 1.0, hold="power"), "hold is 'power'"),
        (lambda: fx.half_sine_shock("x", 1.0, 0.0), "duration is 0"),
        (lambda: fx.half_sine_shock("x", 50.0, 5e-324), "too far apart in size"),
        (lambda: fx.half_sine_shock("x", 50.0, 1e308), "too far apart in size"),
        (lambda: fx.half_sine_shock("x", 1e300, 0.01, recovery=1e308), "too far apart in size"),
        (lambda: fx.excitation.smooth_step("x", 1.0, 1e-308), "too far apart in size"),
        (lambda: fx.excitation.polynomial("x", np.ones(9)), "one to eight"),
        (lambda: fx.excitation.smooth_step("x", 1.0, -1.0), "duration is -1"),
        (lambda: fx.harmonic("x", 1.0, 1.0).delayed(-1.0), "delay is -1"),
        (lambda: fx.harmonic("x", 1.0, 1.0).ramped(0.0), "ramp duration is 0"),
        (lambda: fx.harmonic("x", 1.0, 1.0).ramped(2.0).stopped(1.0, 1.0), "before a term has risen"),
        (lambda: fx.vc_curve("VC-Z"), "VC-Z"),
        (lambda: fx.excitation.ground_noise("loud"), "'low', 'high'"),
        (lambda: fx.excitation.sea_spectrum(2.0, 8.0, 0.5), "gamma is 0.5"),
        (lambda: fx.excitation.flat_spectrum(1.0, 3.0, 2.0), "below the second"),
        (lambda: fx.random_motion("x", fx.vc_curve("VC-A"), seed=1, samples=0), "samples is 0"),
        (lambda: fx.excitation.time_series(RECORD, np.sin(RECORD)[:-1], "x"), "are needed"),
        (lambda: fx.excitation.time_series(RECORD, np.sin(RECORD), "x", recorded="jerk"), "recorded is 'jerk'"),
    ],
)
def test_bad_numbers_are_refused(make, words):
    with pytest.raises(ArgumentError, match=words):
        make()
