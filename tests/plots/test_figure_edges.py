"""Corners of figures and reports: own axes, wide ranges, nothing to beware of, machines that are not there."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod import plots
from flexapod.mechanics import at_rest
from flexapod.mechanics.cautions import Caution, pose_cautions
from flexapod.plots import machine_3d, response
from flexapod.plots import path as plots_path
from flexapod.report import findings
from flexapod.report import page as whole
from flexapod.report.studies import machine, path
from flexapod.report.terminal import show


def test_axes_are_made_where_none_are_given():
    hexapod = plain_machine("motion-base")
    pose = fx.home_pose(hexapod)
    modes = fx.natural_modes(hexapod, pose)
    for ax in (plots.machine(hexapod), plots.mode(hexapod, None, modes, 1), plots.frequencies(modes.omega)):
        assert plt.fignum_exists(ax.figure.number)  # pyplot shows it, as in a notebook


def frequency_axis(omega):
    ax = Figure().add_subplot()
    plots.frequencies(np.array(omega), ax=ax)
    return ax


@pytest.mark.parametrize(
    ("top", "ticks"),
    [(2.0, [1, 1.5, 2]), (50.0, [1, 3, 10, 30]), (1e4, [1, 10, 100, 1000, 10000])],
    ids=["an octave", "two decades", "four decades"],
)
def test_frequencies_have_few_round_ticks(top, ticks):
    ax = frequency_axis(2 * np.pi * np.geomspace(1.0, top, 6))
    assert ax.get_xticks().tolist() == ticks
    assert [text.get_text() for text in ax.get_xticklabels()] == [f"{tick:g}" for tick in ticks]


def test_a_machine_that_does_not_vibrate_has_a_bare_axis():
    assert frequency_axis(np.zeros(6)).get_xscale() == "linear"


def test_a_mode_without_motion_stays_where_it_is():
    np.testing.assert_array_equal(machine_3d._enlarged(np.zeros(6), np.eye(3), 0.1), np.zeros(6))


def test_spectra_of_leg_forces_are_in_newtons():
    hexapod = fx.load("mukherjee-ii")
    omega = np.geomspace(100, 2000, 60)
    found = fx.random_response(hexapod, fx.home_pose(hexapod), psd=np.full(60, 1e-4), omega=omega, axis="z")
    figure = response.random_spectra(found, "leg_force")
    assert [ax.get_ylabel() for ax in figure.axes] == ["density, N²/Hz"] * 2 + ["RMS below, N"] * 2
    assert "leg 1" in figure.axes[2].get_legend().get_texts()[0].get_text()
    moved = response.random_spectra(found, "acceleration")
    assert moved.axes[3].get_ylabel() == "RMS below, rad/s²"


def page(found):
    return whole(machine.study(found))


def report(hexapod, pose, **options):
    return findings.gather(hexapod, pose, **options)


def test_a_report_without_cautions_has_no_box_for_them():
    hexapod = plain_machine("motion-base")
    found = report(hexapod, fx.home_pose(hexapod))
    assert "To beware of" not in page(replace(found, cautions=[]))
    said = page(replace(found, cautions=[Caution("dog", "the <dog>")]))
    assert "To beware of" in said
    assert "the &lt;dog&gt;" in said


def test_energies_below_zero_are_explained():
    """As those of a leg inertia that no rigid body has."""
    found = report(fx.load("mukherjee-i"), fx.Pose([0, 0, 0.89]))
    odd = replace(found, shares=found.shares._replace(kinetic=found.shares.kinetic - 0.01))
    even = replace(found, shares=found.shares._replace(kinetic=np.abs(found.shares.kinetic)))
    words = "A part below zero comes from a leg inertia that no rigid body has."
    assert words in page(odd)
    assert words not in page(even)


def test_a_pose_that_no_leg_forces_hold_is_said_to_be(monkeypatch):
    """Between singular to rounding and not: the index is there, the tangent is not."""
    hexapod = plain_machine("motion-base")
    pose = fx.home_pose(hexapod)
    omega = fx.natural_modes(hexapod, pose).omega

    def refused(*given, **options):
        raise fx.SingularPoseError("no leg forces hold it")

    monkeypatch.setattr(at_rest, "linearise", refused)
    found = report(hexapod, pose)
    assert found.rest is None
    assert found.damped is None
    np.testing.assert_array_equal(found.omega, omega)
    words = "No leg forces hold this pose: the tangent is not available."
    assert words in [one.text for one in found.cautions]
    assert words in [one.text for one in pose_cautions(hexapod, pose, omega, 3.0, None)]


def test_the_summary_of_a_singular_pose_has_no_influences(capsys):
    from rich.console import Console

    hexapod = fx.load("mukherjee-i")
    flat = hexapod.replace({"platform.joints": hexapod.base_joints.tolist()})
    show(machine.study(report(flat, fx.Pose([0, 0, 0.5]))), Console(width=200))
    told = capsys.readouterr().out
    assert "What matters most" not in told
    assert "The pose is singular" in told


def test_a_path_that_leaves_the_limits_says_when():
    hexapod = fx.load("mukherjee-i").replace({"limits.leg_length": [0.1, 0.87]})
    way = fx.Trajectory(fx.Pose.from_rpy([0.0, 0.05], 0, [0.85, 1.1]), [0.0, 2.0])
    found = path.PathFindings(way, fx.path_index(hexapod, way), fx.paths.path_loads(hexapod, way), 0.3)
    words = path.cautions(found)
    assert any("The path leaves the design's limits for" in one.text and "first at" in one.text for one in words)
    figure = plots_path.index_along(found.along, None)
    assert "bound" not in [text.get_text() for text in figure.axes[0].get_legend().get_texts()]


def test_frequencies_that_fall_over_are_words_and_marks_stay_inside():
    """The exact tangent of a heavy isolator: marks below all of Eq. 5, and two modes without a frequency."""
    hexapod = plain_machine("cubic-isolator").replace({"platform.mass": 200})
    pose = fx.Pose.from_rpy(0.004, 0, 0.0346, 0, 2, 0, degrees=True)
    omega = fx.natural_modes(hexapod, pose).omega
    poles = fx.linearise(hexapod, pose).modes().pole
    ax = fx.plots.frequencies(omega, ax=Figure().add_subplot(), tangent=poles)
    low, high = ax.get_xlim()
    marks = np.concatenate([line.get_xdata() for line in ax.get_lines()])
    assert np.isfinite(marks).sum() == 10
    assert ((marks > low) & (marks < high))[np.isfinite(marks)].all()
    assert [text.get_text() for text in ax.texts] == ["falls over", "falls over"]
    still = fx.plots.frequencies(omega, ax=Figure().add_subplot(), tangent=np.append(1j * omega[:5], -3.0))
    assert [text.get_text() for text in still.texts] == ["does not vibrate"]


def test_the_report_puts_the_tangent_beside_the_mode_that_moves_alike():
    hexapod = plain_machine("cubic-isolator").replace({"platform.mass": 200})
    found = report(hexapod, fx.Pose.from_rpy(0.004, 0, 0.0346, 0, 2, 0, degrees=True))
    section = next(one for one in machine.study(found).sections if one.title == "Natural frequencies")
    columns = {column.title: column.values for column in section.items[1].columns}
    rows = dict(zip(columns["mostly"], columns["tangent"], strict=True))
    assert (rows["x"], rows["y"]) == ("falls over", "falls over")
    assert rows["z"] == pytest.approx(2.04137, rel=1e-5)
    assert rows["roll"] == pytest.approx(20.4144, rel=1e-5)
    assert found.to_dict()["tangent"]["of_undamped_mode"] == [3, 1, 2, 5, 4, 6]
    assert found.to_dict()["stability"] == machine.study(found).rows[0].value == "falls over"


@pytest.mark.parametrize("width", [None, 0.088])
def test_a_mode_fills_its_figure(width):
    """Without ticks no room is kept for them: what is drawn takes more than half the page, and nothing is cut off."""
    machine = fx.load("motion-base")
    with fx.plots.for_print(width=width):
        figure = fx.plots.mode(machine, None, fx.natural_modes(machine), 1).figure
    figure.canvas.draw()
    inked = np.asarray(figure.canvas.buffer_rgba())[..., :3].min(axis=2) < 250
    for along in (inked.any(axis=0), inked.any(axis=1)):
        assert along.mean() > 0.55
        assert not along[[0, -1]].any()
