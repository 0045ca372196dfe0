"""Constraints that the variables cannot move, or only just keep: they must not stop the search."""

import numpy as np
import pytest

import flexapod as fx
from flexapod.design.layout import PLACES
from flexapod.optimisation import DesignLimits, Footprint, JointCircle, Stroke, TotalMass

OPTIONS = {"trials": 0, "samples": 512, "verify": 2**13}


@pytest.fixture(scope="module")
def positioner():
    return fx.load("precision-positioner")


def half_angles(low, high):
    return [JointCircle(plate, half_angle=(np.radians(low), np.radians(high))) for plate in ("base", "platform")]


def about_home(metres, degrees):
    return fx.LeastIndex(fx.Workspace.about_home(metres, np.radians(degrees)))


@pytest.fixture(scope="module")
def varied():
    return [*half_angles(3, 55), fx.Variable("home.position[2]", 0.2, 0.28)]


@pytest.mark.parametrize(
    "kept", [[], [Footprint()], [TotalMass()], [Footprint(), TotalMass()], [TotalMass(48.73)]], ids=repr
)
def test_a_constraint_that_no_variable_moves_costs_nothing(positioner, varied, kept):
    """The base's radius and the masses stay as they are: the optimum is the one without the constraint."""
    found = fx.optimise(positioner, varied, about_home(0.002, 1), [DesignLimits(), *kept], **OPTIONS)
    assert found.start_index == pytest.approx(826.159, rel=1e-6)
    assert found.index == pytest.approx(904.281, rel=1e-5)
    assert found.verification.holds


def test_a_constraint_that_is_kept_at_the_end_of_a_range_only_costs_nothing(positioner, varied):
    """The mass can only grow, and must not."""
    mass = fx.Variable("platform.mass", positioner.platform_mass, 2 * positioner.platform_mass)
    found = fx.optimise(positioner, [*varied, mass], about_home(0.002, 1), [DesignLimits(), TotalMass()], **OPTIONS)
    assert found.index == pytest.approx(904.281, rel=1e-5)
    assert found.verification.holds
    assert found.at_bounds == ("platform.mass",)


@pytest.mark.parametrize("kept", [[], [Footprint()], [Footprint(), Footprint(plate="platform")]], ids=len)
def test_the_template_gets_better_within_its_footprint(tmp_path, kept):
    from flexapod.cli import main

    assert main(["new", str(tmp_path / "own.toml")]) == 0
    own = fx.load(tmp_path / "own.toml")
    base, platform = half_angles(3, 57)
    platform = JointCircle("platform", radius=(0.15, 0.3), half_angle=platform.half_angle)
    height = fx.Variable("home.position[2]", 0.4, 0.6)
    found = fx.optimise(own, [base, platform, height], about_home(0.03, 8), [DesignLimits(), *kept], **OPTIONS)
    assert found.start_index == pytest.approx(463.563, rel=1e-5)
    assert found.index == pytest.approx(553.227, rel=1e-5)
    assert found.verification.holds


def test_legs_that_do_not_move_do_not_hold_up_those_that_do(positioner):
    """Two joints are varied: the strokes of the other legs, one of them at the bound, stay as they are."""
    varied = [fx.Variable(f"base.joints[{i}][{k}]", -0.02, 0.02, kind="add") for i in range(2) for k in range(3)]
    lifts = [[0, 0, 0.242, 0.01, 0, 0], [0, 0, 0.246, 0.01, 0, 0]]
    strokes = np.ptp(fx.inverse_kinematics(positioner, fx.Pose.from_rpy(*np.transpose(lifts))), axis=0)
    assert strokes.argmax() > 1
    free, held = (
        fx.optimise(positioner, varied, fx.LeastIndex(lifts[0]), c, **OPTIONS) for c in ([], [Stroke(region=lifts)])
    )
    assert free.gain > 0.04
    assert held.gain == pytest.approx(free.gain)
    assert held.verification.holds
    assert held.evaluations < 2 * free.evaluations  # no round in vain


class Offset(fx.optimisation.ConstraintQuantity):
    """1 + (10 z)^2 of the platform's mass centre: it has no slope where z is zero."""

    place = PLACES["platform.mass_center"][2:]

    def columns(self, found, numbers):
        return 1 + 100 * numbers[self.place][None] ** 2

    def derivatives(self, at):
        z = at.numbers[self.place]
        return fx.optimisation.Values(1 + 100 * z**2, 200 * z[:, None] * at.jacobian[self.place], np.zeros(1, int))


class Centred(fx.optimisation.Constraint):
    def requirements(self, hexapod, region, measure):
        return [fx.optimisation.Requirement("offset", Offset(), "most", np.array(1.0), None)]


def test_a_constraint_without_slope_at_the_start_alone_is_kept(positioner):
    start = positioner.replace({"platform.mass_center": [0.0, 0.0, 0.0]})
    varied = [fx.Variable("platform.mass_center[2]", -0.1, 0.1), fx.Variable("platform.mass", 20, 40)]
    free, kept = (fx.optimise(start, varied, constraints=kept, **OPTIONS) for kept in ([], [Centred()]))
    assert abs(free.variables["platform.mass_center[2]"]) > 0.01
    assert abs(kept.variables["platform.mass_center[2]"]) < 1e-4
    assert kept.variables["platform.mass"] == pytest.approx(20.0)
    assert kept.verification.holds
