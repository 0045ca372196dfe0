"""Figures of simulations: no panel for rounding, units with the prefix that makes plain numbers, envelopes."""

import numpy as np
import pytest

from flexapod.plots import simulation
from flexapod.plots.style import moves, new_figure, panels, prefixed

TIMES = np.linspace(0, 1, 4001)
NAMES = ("translation x", "translation y", "translation z", "rotation about x", "rotation about y", "rotation about z")


def drawn(sizes, turns=3.0):
    return simulation.displacements(TIMES, np.outer(np.sin(2 * np.pi * turns * TIMES), sizes))


def test_rounding_has_no_panel():
    figure = drawn([3e-20, 0, 2e-6, 1e-19, 4e-7, 0])
    assert [ax.get_title("left") for ax in figure.axes] == ["(a) translation z", "(b) rotation about y"]
    assert figure.get_supxlabel() == f"no motion: {', '.join(NAMES[i] for i in (0, 1, 3, 5))}"
    assert [ax.get_ylabel() for ax in figure.axes] == ["µm", "nrad"]


@pytest.mark.parametrize("count", range(1, 7))
def test_there_are_as_many_panels_as_motions(count):
    figure = drawn([1e-3] * count + [0] * (6 - count))
    assert len(figure.axes) == count
    assert all(ax.get_xlabel() == "time, s" for ax in figure.axes)
    figure.canvas.draw()


def test_nothing_that_moves_is_said():
    (ax,) = drawn(np.zeros(6)).axes
    assert ax.texts[0].get_text() == "nothing moves"


def test_many_oscillations_are_an_envelope():
    few, many = drawn([0, 0, 1e-3, 0, 0, 0]).axes[0], drawn([0, 0, 1e-3, 0, 0, 0], 700).axes[0]
    assert (len(few.lines), len(few.collections)) == (1, 0)
    assert (len(many.lines), len(many.collections)) == (2, 1)
    low, high = (line.get_ydata() for line in many.lines)
    assert low.max() < -0.7e-3  # ten samples in a bin meet the extremes of a sine to their spacing
    assert high.min() > 0.7e-3
    assert (low.min(), high.max()) == pytest.approx((-1e-3, 1e-3), rel=1e-3)


@pytest.mark.parametrize(
    ("limit", "label", "tick"), [(2e-6, "µm", "1"), (0.0, "m", "0"), (5.0, "m", "1e−06"), (3e4, "km", "1e−09"),
                                 (1e-20, "fm", "1e+09")]
)  # fmt: skip
def test_numbers_along_an_axis_are_plain(limit, label, tick):
    _, (ax,) = panels(new_figure(3, 2), 1)
    ax.set_ylim(-limit, limit) if limit else ax.set_ylim(-0.0, 1.0)
    prefixed(ax, "m")
    assert ax.get_ylabel() == label
    assert ax.yaxis.get_major_formatter()(0.0) == "0"
    if limit:
        assert ax.yaxis.get_major_formatter()(1e-6) == tick


def test_what_moves_is_more_than_rounding_beside_the_largest():
    assert moves(np.array([[1.0, 1e-8, 1e-10, np.inf, np.nan]])).tolist() == [True, True, False, False, False]
