"""One grid round the resonances for every response, and frequencies in rad/s or Hz."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.conventions import TWO_PI
from flexapod.vibration.frequency_response import transmissibility
from flexapod.vibration.harmonic import complex_poles

MACHINE = plain_machine("cubic-isolator")


def test_the_grid_meets_every_peak():
    for machine in (MACHINE, MACHINE.replace({"legs.damping.prismatic": 1e-4})):
        omega = fx.vibration.frequency_grid(machine)
        poles = complex_poles(fx.linearise(machine))
        assert omega[0] == pytest.approx(0.2 * abs(poles).min())
        assert omega[-1] == pytest.approx(1.5 * abs(poles).max())
        assert (np.diff(omega) > 0).all()
        for pole in poles:
            for shift in (0.0, *(2.0 ** np.arange(-2, 4))):
                for side in (-1, 1):
                    at = pole.imag + side * shift * abs(pole.real)
                    assert np.abs(omega - at).min() < 1e-12 * abs(pole) or not omega[0] < at < omega[-1]
        found = transmissibility(machine, omega=omega).compliance
        peaks = transmissibility(machine, omega=poles.imag).compliance
        np.testing.assert_array_less(np.abs(peaks).max("omega") * (1 - 1e-9), np.abs(found).max("omega") + 1e-300)


def test_ends_samples_and_damping_are_taken():
    omega = fx.vibration.frequency_grid(MACHINE, omega_min=10.0, omega_max=1e3, samples=50)
    assert (omega[0], omega[-1]) == pytest.approx((10.0, 1e3))
    assert 50 <= omega.size <= 50 + 6 * 13
    damped = fx.vibration.frequency_grid(MACHINE, loss_factor=0.3)
    assert not np.array_equal(damped, fx.vibration.frequency_grid(MACHINE))
    with pytest.raises(fx.ArgumentError, match="omega_min is 5 rad/s; it must be less than omega_max, 4 rad/s"):
        fx.vibration.frequency_grid(MACHINE, omega_min=5.0, omega_max=4.0)
    with pytest.raises(fx.ArgumentError, match="samples is 1"):
        fx.vibration.frequency_grid(MACHINE, samples=1)
    with pytest.raises(fx.ArgumentError, match="omega_min is 0"):
        fx.vibration.frequency_grid(MACHINE, omega_min=0.0)


def test_responses_take_the_grid_where_no_frequencies_are_given():
    grid = fx.vibration.frequency_grid(MACHINE, loss_factor=0.02)
    response = fx.transmissibility(MACHINE, loss_factor=0.02)
    np.testing.assert_array_equal(response.omega, grid)
    steps = fx.stepped_sine(MACHINE, axis="z", amplitude=1e-9)
    np.testing.assert_array_equal(steps.omega, fx.vibration.frequency_grid(MACHINE, samples=100))
    loop = fx.control.controlled_transmissibility(MACHINE, None, controller=fx.control.VelocityFeedback(100.0))
    np.testing.assert_array_equal(loop.omega, fx.vibration.frequency_grid(MACHINE))
    slow = fx.control.VelocityFeedback(100.0).on(fx.linearise(MACHINE)).sampled(np.pi / 60)
    sampled = fx.control.controlled_transmissibility(MACHINE, None, controller=slow)
    np.testing.assert_array_equal(sampled.omega, loop.omega[loop.omega < 59.4])
    flat = fx.random_response(MACHINE, psd=lambda omega: np.ones_like(omega), axis="z", loss_factor=0.02)
    assert flat.omega[0] == grid[0]
    assert flat.omega[-1] == grid[-1]


def test_frequencies_may_be_in_hertz():
    hertz = np.array([1.0, 5.0, 30.0])
    for call in (
        lambda **at: fx.transmissibility(MACHINE, **at).absolute,
        lambda **at: fx.stepped_sine(MACHINE, axis="x", amplitude=1e-9, **at).response,
        lambda **at: (
            fx.control.controlled_transmissibility(MACHINE, None, controller=fx.control.PID(1.0, 1.0), **at).controlled
        ),
    ):
        np.testing.assert_array_equal(call(frequency=hertz), call(omega=TWO_PI * hertz))
        with pytest.raises(fx.ArgumentError, match="omega and frequency are both given"):
            call(frequency=hertz, omega=hertz)
    with pytest.raises(fx.ArgumentError, match=r"frequency\[0\] is -1.0 Hz"):
        fx.transmissibility(MACHINE, frequency=-1.0)


def test_densities_over_frequencies_in_hertz_are_per_hertz():
    hertz = np.array([1.0, 5.0, 300.0])
    levels, options = np.array([1.0, 3.0, 2.0]), {"axis": "z", "loss_factor": 0.02}
    expected = fx.random_response(MACHINE, psd=levels / TWO_PI, omega=TWO_PI * hertz, **options)
    found = fx.random_response(MACHINE, psd=levels, frequency=hertz, **options)
    np.testing.assert_allclose(found.rms_acceleration, expected.rms_acceleration, rtol=1e-13)
    function = fx.random_response(MACHINE, psd=lambda f: 1.0 / f, frequency=hertz, **options)
    same = fx.random_response(MACHINE, psd=lambda omega: 1.0 / omega, omega=TWO_PI * hertz, **options)
    np.testing.assert_allclose(function.rms_acceleration, same.rms_acceleration, rtol=1e-12)


def test_a_spectrum_in_the_wrong_place_is_told():
    with pytest.raises(TypeError, match="random_response"):
        fx.random_response(MACHINE, fx.home_pose(MACHINE), fx.vc_curve("VC-C"), "z")
    with pytest.raises(TypeError, match=r"transmissibility\(\) got an unexpected keyword argument 'damping'"):
        fx.transmissibility(MACHINE, omega=[10.0], damping=0.01)
