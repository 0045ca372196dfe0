"""Corners of films: one instant, lengths in words."""

import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.plots import animation


@pytest.fixture(scope="module")
def isolator():
    hexapod = plain_machine("cubic-isolator")
    return hexapod, fx.home_pose(hexapod)


def test_a_simulation_of_one_instant_is_no_film(isolator, tmp_path):
    hexapod, pose = isolator
    one = fx.simulate(hexapod, pose, duration=0.01, samples=2).isel(time=[0])
    with pytest.raises(fx.ArgumentError, match="fewer than two instants; nothing moves"):
        fx.animate_simulation(one, hexapod, tmp_path / "run.gif")


@pytest.mark.parametrize(("metres", "words"), [(2.5, "2.5 m"), (0.0123, "12.3 mm"), (4e-6, "4 µm"), (5e-10, "0.5 nm")])
def test_lengths_have_units_of_their_size(metres, words):
    assert animation._length(metres) == words
