"""Corners of excitations."""

import numpy as np
import pytest

import flexapod as fx

TIMES = np.linspace(0, 0.3, 40)


@pytest.mark.parametrize(
    "one",
    [
        fx.harmonic("x", [1e-3, 2e-3], [20.0, 33.0], 0.3),
        fx.sine_sweep("x", 1e-3, 10.0, 60.0, 0.2),
        fx.excitation.smooth_step("x", 1e-3, 0.1),
        fx.half_sine_shock("x", 5.0, 0.02, recovery=0.1),
        fx.excitation.time_series(np.linspace(0, 0.3, 60), np.sin(np.linspace(0, 9, 60)), "x"),
    ],
    ids=["sines", "sweep", "step", "shock", "recording"],
)
def test_an_excitation_times_a_number_is_as_much_larger(one):
    for scaled in (-2.5 * one, one * -2.5):
        for found, expected in zip(scaled.evaluate(TIMES), one.evaluate(TIMES), strict=True):
            np.testing.assert_allclose(found, -2.5 * expected, rtol=1e-13, atol=1e-13 * np.abs(expected).max())
