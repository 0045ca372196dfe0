"""Corners of vibration: a resonance hit exactly, a search that runs out of tries."""

import numpy as np

import flexapod as fx
from flexapod.vibration import stepped
from flexapod.vibration.harmonic import _solve


def test_a_resonance_without_damping_hit_exactly_is_infinite_and_only_there():
    Z = np.stack([np.zeros((6, 6)), 2.0 * np.eye(6)]).astype(complex)
    right = np.ones((2, 6, 3), dtype=complex)
    found = _solve(Z, right)
    assert np.isinf(found[0]).all()
    np.testing.assert_array_equal(found[1], 0.5 * right[1])


def test_a_stepped_sine_that_runs_out_of_tries_says_so(monkeypatch):
    hexapod = fx.load("mukherjee-ii")
    monkeypatch.setattr(stepped, "_ITERATIONS", 1)
    found = fx.stepped_sine(
        hexapod, fx.home_pose(hexapod), omega=[300.0, 400.0], amplitude=1e-4, axis="z", tolerance=1e-14
    )
    assert found.status.values.tolist() == ["not_found"] * 2
