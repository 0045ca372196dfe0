"""Figures of control show what the studies found: poles, gains, marks, words."""

import matplotlib.colors as colours
import numpy as np
import pytest
from matplotlib.contour import ContourSet
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.plots import control


def isolator():
    hexapod = plain_machine("cubic-isolator")
    return hexapod, fx.home_pose(hexapod)


def line_of(ax, label):
    return next(line for line in ax.lines if line.get_label() == label)


def lines_around(ax):
    return [drawn for drawn in ax.collections if isinstance(drawn, ContourSet)]


def test_root_locus_runs_from_crosses_to_circles_and_marks_the_best_gain():
    found = fx.control.root_locus(*isolator(), "force", leak=3.0)
    figure = control.root_locus(found)
    left, right = figure.axes
    crosses = line_of(left, "no control")
    start = crosses.get_xdata() + 1j * crosses.get_ydata()
    damped = fx.linearise(*isolator()).modes().pole
    np.testing.assert_allclose(np.sort(start.imag), np.sort(damped.imag[damped.imag > 0]), rtol=1e-12)
    first = found.pole.values[0]  # at a negligible gain the curves begin at the crosses
    assert np.abs(start[:, None] - first).min(axis=1).max() < 0.02 * abs(start).max()
    seen = np.minimum(np.abs(found.pole.values[1:]), np.abs(found.pole.values[:-1])) < 2 * float(found.omega[-1])
    steps = np.abs(np.diff(found.pole.values, axis=0)) / float(found.omega[-1])
    assert np.median(steps[seen]) < 0.04  # no corners
    assert (steps[seen] > 0.06).mean() < 0.01
    zeros = found.zero.values[np.isfinite(found.zero.values)]
    assert not zeros.size  # legs that meet the plates in ball joints have none, and the legend names none
    assert [text.get_text() for text in left.get_legend().get_texts()] == ["no control", "most damping"]
    chosen = control.root_locus(found, chosen=float(found.gain.values[3])).axes[0]
    at = line_of(chosen, "chosen gain")
    assert (
        np.isclose((at.get_xdata() + 1j * at.get_ydata())[:, None], found.pole.values[3], rtol=1e-9).any(axis=1).all()
    )
    best = int(np.argmin(np.abs(found.gain.values - found.attrs["best_gain"])))
    marks = line_of(left, "most damping")
    pole = marks.get_xdata() + 1j * marks.get_ydata()
    assert np.isin(pole, found.pole.values[best]).all()
    assert (pole.imag > 0).all()
    peak = right.lines[-1]
    assert (peak.get_xdata()[0], peak.get_ydata()[0]) == (found.attrs["best_gain"], found.attrs["best_damping"])
    assert any(f"{found.attrs['best_damping']:.3g} at" in text.get_text() for text in right.texts)
    assert "integral force feedback, all legs, leak 3 rad/s" in figure.get_suptitle()
    for ax in (left, right):
        assert "rad/s" in ax.get_xlabel()


def test_root_locus_of_one_leg_that_damps_nothing():
    """One loop alone leaves motions that it does not see: no gain is the best."""
    hexapod, pose = isolator()
    still = hexapod.replace({"gravity": [0, 0, 0], "legs.damping.prismatic": 0.0})
    found = fx.control.root_locus(still, pose, "velocity", legs=(2,), gains=np.geomspace(1, 1e3, 20))
    found.attrs["best_damping"] = 0.0  # to rounding, whatever its sign
    figure = control.root_locus(found)
    assert "direct velocity feedback, leg 2" in figure.get_suptitle()
    assert "most damping" not in [line.get_label() for line in figure.axes[0].lines]
    two = fx.control.root_locus(still, pose, "velocity", legs=(1, 4), gains=[1.0, 2.0])
    assert "legs 1, 4" in control.root_locus(two).get_suptitle()


@pytest.mark.parametrize(
    ("law", "units"),
    [
        (fx.control.PID(), ("N/m", "N s/m")),
        (fx.control.PID(space="task"), ("1/s²", "1/s")),
        (fx.control.PID(actuator="command"), ("1", "s")),
    ],
)
def test_gain_map_names_its_units(law, units):
    k = 1.0 if law.actuator == "command" else 1e3
    with pytest.warns(fx.control.GainWarning):
        found = fx.control.gain_map(*isolator(), kp=[0.0, k, 4 * k], kd=[0.0, 0.03 * k, 0.3 * k], controller=law)
    left, right, *_ = control.gain_map(found).axes
    assert left.get_ylabel() == f"proportional gain kp, {units[0]}"
    assert right.get_xlabel() == f"derivative gain kd, {units[1]}"


def test_gain_map_bounds_what_lies_near_and_crosses_out_what_is_unstable():
    hexapod, pose = isolator()
    k = float(hexapod.legs.stiffness[0])
    kp, kd = np.array([-1.5 * k, 0.0, 0.5 * k]), np.geomspace(0.5, 500, 5)
    with pytest.warns(fx.control.GainWarning):
        found = fx.control.gain_map(hexapod, pose, kp=kp, kd=kd)
    assert found.near.any()
    assert not found.near.all()
    left, right, *_ = control.gain_map(found).axes
    for ax in (left, right):
        (edge,) = lines_around(ax)
        np.testing.assert_allclose(edge.get_edgecolor()[0], colours.to_rgba(control.ORANGE))
        crosses = next(line for line in ax.lines if line.get_marker() == "x")
        assert set(crosses.get_ydata()) == {-1.5 * k}
        assert ax.get_xscale() == "log"  # gains that are spaced so
        assert ax.get_yscale() == "linear"


def test_gain_map_without_danger_is_silent():
    """Gains that put no pole near a natural frequency: no warning and no line."""
    found = fx.control.gain_map(*isolator(), kp=[3e5, 4e5], kd=[2e4, 3e4], nearness=1e-3)
    assert not found.near.any()
    left, *_ = control.gain_map(found).axes
    assert lines_around(left) == []


@pytest.mark.parametrize(
    ("axes", "labels"),
    [
        ({"yaw": [-0.2, 0.0, 0.2]}, ["yaw, deg", "yaw, deg"]),
        ({"x": [-0.1, 0.1], "yaw": [-0.2, 0.0, 0.2]}, ["x, m", "x, m"]),
        ({"x": [0.0, 0.1], "y": [0.0, 0.1], "z": [2.3, 2.4, 2.5]}, ["x, m", "x, m"]),
    ],
)
def test_a_schedule_of_any_number_of_axes_is_drawn(axes, labels):
    found = fx.control.gain_schedule(
        plain_machine("motion-base"), fx.pose_grid(**{"z": 2.4, **axes}), "velocity", damping=0.3
    )
    figure = control.schedule(found)
    assert [ax.get_xlabel() for ax in figure.axes[:2]] == labels
    assert "gain, N s/m" in [figure.axes[0].get_ylabel(), *(ax.get_ylabel() for ax in figure.axes[2:])]
    if len(axes) == 1:
        gain, fixed = figure.axes[0].lines[:2]
        np.testing.assert_array_equal(gain.get_ydata(), found.gain.values)
        np.testing.assert_allclose(gain.get_xdata(), np.degrees(axes["yaw"]))
        assert fixed.get_ydata()[0] == found.attrs["fixed_gain"]
    else:
        shown = found.gain if len(axes) == 2 else found.gain.isel(z=1)  # of more axes, the middle of the others
        np.testing.assert_array_equal(figure.axes[0].collections[0].get_array().reshape(-1), shown.values.T.ravel())


def test_a_schedule_over_a_list_of_poses_counts_them():
    poses = np.array([[0, 0, 2.3, 0, 0, 0], [0, 0, 2.5, 0, 0, 0.1]])
    found = fx.control.gain_schedule(plain_machine("motion-base"), poses, "velocity", damping=0.3)
    left, _ = control.schedule(found).axes
    assert left.get_xlabel() == "pose"
    np.testing.assert_array_equal(left.lines[0].get_xdata(), [0, 1])
