"""The stepped sine on the non-linear machine against the tangent, a settled run, a fitted run from rest, and laws."""

import numpy as np
import pytest
from tests.helpers.states import CENTER

import flexapod as fx
from flexapod.conventions import AXES
from flexapod.simulation.integrator import IntegratorOptions, integrate
from flexapod.simulation.run import SimulationRun

II = fx.Pose(CENTER["mukherjee-ii"])
STRONG = {"legs.damping.prismatic": 2e5, "legs.damping.universal": 3.0, "legs.damping.spherical": 2.0}


@pytest.fixture(scope="module")
def paper():
    return fx.load("mukherjee-ii")


def apart(dataset) -> np.ndarray:
    """Distance of the non-linear response from the tangent's, all outputs together."""
    difference = np.linalg.norm(dataset.response - dataset.linear, axis=1)
    return difference / np.linalg.norm(dataset.linear, axis=1)


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_small_motion_is_the_tangents(paper, axis, joint, measured):
    # Away from resonances (492, 493, 762, 8635, 16159, 16208 rad/s). What remains is of the order of the amplitude
    # squared over the leg's length squared, 1e-9, and the tolerance of shooting.
    found = fx.stepped_sine(
        paper, II, omega=[100.0, 430.0, 550.136, 700.0, 900.0], amplitude=1e-6, axis=axis, joint=joint, tolerance=1e-9
    )
    assert (found.status == "found").all()
    measured("frequency/stepped", apart(found), 3e-7)
    difference = np.abs(found.response - found.linear).values
    largest = np.abs(found.linear).max(axis=1).values[:, None]
    assert (difference < np.maximum(1e-3 * np.abs(found.linear).values, 1e-7 * largest)).all()  # every single output


def test_linear_is_the_transmissibility(paper):
    omega = [200.0, 600.0]
    found = fx.stepped_sine(paper, II, omega=omega, amplitude=1e-6, axis="pitch")
    expected = fx.transmissibility(paper, II, omega=omega).absolute.sel(base="pitch")
    np.testing.assert_array_equal(found.linear, expected)
    np.testing.assert_array_equal(found.ratio, np.abs(found.response))
    np.testing.assert_array_equal(found.harmonics.sel(harmonic=1), found.ratio)


def test_difference_from_the_tangent_grows_with_the_amplitude_squared(paper, measured):
    """Three amplitudes: the fundamental of a motion x has no second-order part, so it differs by x^2."""
    amplitude = np.array([0.00125, 0.0025, 0.005])
    steps = [fx.stepped_sine(paper, II, omega=[550.136, 640.0, 755.0], amplitude=a, axis="roll") for a in amplitude]
    differences = np.array([apart(d) for d in steps])
    assert (differences[-1] > 3e-4).all()
    # The next term is of fourth order: a hundredth of the second where the difference is a hundredth.
    measured("frequency/quadratic", np.log2(differences[1:] / differences[:-1]) - 2, 0.02)
    second = np.array([np.linalg.norm(d.harmonics.sel(harmonic=2), axis=1) for d in steps])
    np.testing.assert_allclose(np.log2(second[1:] / second[:-1]), 1.0, atol=0.02)  # per amplitude


def test_peaks_lie_at_the_tangents_damped_frequencies(paper, measured):
    poles = fx.linearise(paper, II).modes().pole
    for mode, output in ((0, "x"), (1, "y"), (2, "yaw")):
        damped = poles[mode].imag
        # 0.01 % apart; so small an amplitude that the motion of some 1e4 times it stays small beside a leg
        omega = damped * (1 + np.arange(-10, 11) * 1e-4 + 3e-6)
        found = fx.stepped_sine(paper, II, omega=omega, amplitude=1e-9, axis="z")
        assert (found.status == "found").all()
        peak = float(omega[found.ratio.sel(output=output).values.argmax()])
        measured("frequency/peaks", peak / damped - 1, 1e-4)  # the nearest frequency of the grid


def settled(hexapod, omega: float, amplitude: float, axis: str) -> np.ndarray:
    """Complex response (6,) per amplitude of a run from rest, in the last of so many periods that all else died out."""
    slowest = -fx.linearise(hexapod, II).modes().pole.real.max()
    periods = int(np.ceil(25 / slowest * omega / (2 * np.pi)))  # e^-25 is 1e-11
    period = 2 * np.pi / omega
    times = (periods + np.arange(64) / 64) * period
    run = SimulationRun(hexapod, II, base_motion=fx.harmonic(axis, amplitude, omega))
    x = integrate([run], times, options=IntegratorOptions(rtol=1e-11), motions=False).displacement[0]
    return 1j * np.exp(-1j * omega * times) @ x * 2 / 64 / amplitude


@pytest.mark.parametrize(("omega", "share"), [(300.0, 1.0), (492.5, 1.0), (1500.0, 1.0), (560.0, 0.05)])
def test_with_strong_damping_it_is_what_a_long_run_settles_to(paper, omega, share, measured):
    hexapod = paper.replace({key: share * value for key, value in STRONG.items()})
    for amplitude in (1e-4, 0.02):
        found = fx.stepped_sine(hexapod, II, omega=[omega], amplitude=amplitude, axis="roll")
        expected = settled(hexapod, omega, amplitude, "roll")
        # Shooting stops where its correction is below 1e-7 of the motion; the transient has died to e^-25.
        measured("frequency/settled", (found.response.values[0] - expected) / np.linalg.norm(expected), 3e-7)
        if amplitude < 0.01:
            assert apart(found)[0] < 2e-6  # (1e-4 rad)^2, enlarged by resonance; and so both are the tangent's response
        else:
            assert apart(found)[0] > 5e-6  # and both are not


def test_with_the_papers_friction_it_is_the_driven_part_of_a_run_from_rest(paper, measured):
    """A transient of 1/e in minutes: fitted together with the driven motion by least squares over a second."""
    omega, amplitude = 550.136, 1e-6
    times = np.linspace(0.0, 1.0, 20001)
    run = SimulationRun(paper, II, base_motion=fx.harmonic("z", amplitude, omega))
    x = integrate([run], times, options=IntegratorOptions(rtol=1e-11), motions=False).displacement[0]
    rates = np.append(1j * omega, fx.linearise(paper, II).modes().pole)
    waves = np.exp(np.outer(times, rates))
    fitted = np.linalg.lstsq(np.hstack([waves.real, -waves.imag]), x, rcond=None)[0]
    driven = (fitted[0] + 1j * fitted[7]) * 1j / amplitude
    found = fx.stepped_sine(paper, II, omega=[omega], amplitude=amplitude, axis="z")
    # The fit leaves the motion's second-order part, 1e-5 of it, which is nearly orthogonal to what is fitted.
    measured("frequency/fitted", (found.response.values[0] - driven) / np.abs(driven).max(), 1e-6)


def test_too_large_a_motion_is_data_and_the_rest_completes(paper):
    resonance = fx.linearise(paper, II).modes().pole[2].imag
    found = fx.stepped_sine(paper, II, omega=[550.0, resonance], amplitude=1e-3, axis="yaw")
    assert list(found.status.values) == ["found", "too_large"]
    assert np.isnan(found.ratio[1]).all()
    assert np.isfinite(found.ratio[0]).all()


def test_frequencies_do_not_know_one_another(paper):
    many = fx.stepped_sine(paper, II, omega=np.linspace(500, 700, 7), amplitude=1e-6, axis="y")
    one = fx.stepped_sine(paper, II, omega=[many.omega.values[3]], amplitude=1e-6, axis="y")
    # Products of many small matrices at once round otherwise than of one.
    np.testing.assert_allclose(many.response[3], one.response[0], atol=1e-12)


def test_progress_ends_at_one(paper):
    seen: list[float] = []
    fx.stepped_sine(paper, II, omega=[500.0, 600.0], amplitude=1e-6, axis="z", progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"omega": []}, fx.ArgumentError, "non-empty"),
        ({"omega": [-1.0]}, fx.ArgumentError, "negative"),
        ({"omega": [np.nan]}, fx.ArgumentError, "nan"),
        ({"omega": [0.0, 1.0]}, fx.ArgumentError, "zero"),
        ({"axis": "up"}, fx.ArgumentError, "'up'"),
        ({"amplitude": 0.0}, fx.ArgumentError, "amplitude"),
        ({"amplitude": np.nan}, fx.ArgumentError, "amplitude"),
        ({"pose": fx.Pose([[0, 0, 0.08]])}, fx.PoseError, "batch"),
        ({"joint": "ball"}, fx.ArgumentError, "'ball'"),
        ({"omega": [5e-324]}, fx.ArgumentError, "omega holds 4.94066e-324 rad/s; a stepped sine needs at least 1e-09"),
    ],
)
def test_bad_arguments(paper, change, error, message):
    arguments = {"pose": II, "omega": [500.0], "amplitude": 1e-6, "axis": "z"} | change
    with pytest.raises(error, match=message):
        fx.stepped_sine(paper, **arguments)
