"""Constraints that the variables cannot move, or only just keep: they must not stop the search."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.design.layout import PLACES
from flexapod.optimisation import DesignLimits, Footprint, JointCircle, Stroke, TotalMass

OPTIONS = {"trials": 0, "samples": 512, "verify": 2**13}


@pytest.fixture(scope="module")
def positioner():
    return plain_machine("precision-positioner")


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


def test_what_no_variable_moves_is_told_and_taken_out(positioner, varied):
    found = fx.optimise(positioner, varied, constraints=[DesignLimits(), Footprint(), TotalMass()], **OPTIONS)
    assert found.unmoved == ("footprint of the base", "total mass")
    assert [check.name for check in found.verification.checks[-2:]] == list(found.unmoved)
    assert found.verification.holds
    assert not found.failures


def test_what_is_moved_only_away_from_the_start_is_not_taken_out(positioner):
    start = positioner.replace({"platform.mass_center": [0.0, 0.0, 0.0]})
    moved = fx.optimise(start, fx.Variable("platform.mass_center[2]", -0.1, 0.1), constraints=[Centred()], **OPTIONS)
    assert moved.unmoved == ()
    still = fx.optimise(start, fx.Variable("platform.mass_center[1]", -0.1, 0.1), constraints=[Centred()], **OPTIONS)
    assert still.unmoved == ("offset",)


def test_an_objective_that_no_variable_moves_is_told(positioner):
    damping = fx.Variable("legs.damping.prismatic", 1, 100)
    found = fx.optimise(positioner, damping, **OPTIONS)
    assert found.unmoved == ("least index over home",)
    assert found.hexapod is found.start
    assert not found.improved


def test_a_broken_bound_that_no_variable_moves_is_refused_at_once(positioner, varied):
    with pytest.raises(fx.errors.InfeasibleError, match=r"no variable moves .* total mass is 48\.73 kg, .* 40 kg"):
        fx.optimise(positioner, varied, constraints=[TotalMass(40.0)], trials=1000)
    with pytest.raises(fx.errors.InfeasibleError, match="no variable moves"):
        fx.pareto_front(positioner, varied, fx.optimisation.ConditionNumber(), constraints=[TotalMass(40.0)])
    with pytest.raises(fx.ArgumentError, match="no variable moves the total mass, so that nothing can be traded"):
        fx.pareto_front(positioner, varied, TotalMass())


def test_a_bound_that_is_the_designs_own_is_kept_by_it_on_every_sweep(positioner):
    """The extremes of angles and of the condition number are inside the box: each sweep finds others."""
    over = fx.Workspace.about_home(0.01, 0.2)
    kept = [fx.optimisation.ConditionNumber(region=over), fx.optimisation.JointAngle("spherical", region=over)]
    found = fx.optimise(positioner, fx.Variable("platform.mass", 20, 30.31), constraints=kept, **OPTIONS)
    assert found.start_breaks == ()
    assert found.unmoved == ("condition number", "spherical joint angle")
    assert found.gain > 0.1
    assert found.verification.holds


def test_a_start_that_breaks_a_limit_is_said(tmp_path):
    from flexapod.cli import main

    main(["new", str(tmp_path / "own.toml")])
    own = fx.load(tmp_path / "own.toml")
    height = fx.Variable("home.position_mm[2]", 400, 600)
    found = fx.optimise(own, height, about_home(0.03, 8), [DesignLimits()], **OPTIONS)
    assert len(found.start_breaks) == 1
    assert found.start_breaks[0].startswith("shortest leg is 0.485")
    assert found.start_breaks[0].endswith("m, must be at least 0.5 m")
    assert found.improved  # a lower index, and allowed
    assert found.index < found.start_index
    assert found.verification.holds


def test_a_result_below_the_start_is_not_taken(positioner):
    """Twice the mass is worse at any height: the start is kept, though it lies outside the bounds."""
    heavier = [fx.Variable("platform.mass", 60, 80), fx.Variable("home.position_mm[2]", 240, 248)]
    found = fx.optimise(positioner, heavier, **{**OPTIONS, "trials": 3})
    assert found.hexapod is found.start is positioner
    assert not found.improved
    assert (found.index, found.gain) == (found.start_index, 0.0)
    assert found.variables == pytest.approx({"platform.mass": 30.31, "home.position_mm[2]": 244})
    assert [name for name, one in found.ranges.items() if one.outside] == ["platform.mass"]
    front = fx.pareto_front(positioner, heavier, fx.optimisation.ConditionNumber(), trials=6, refine=2, samples=16)
    assert front.index.max() < front.start[0]  # of machines within the bounds
    assert front.ranges["platform.mass"].outside


def test_a_front_is_not_below_the_design_begun_with(positioner):
    varied = [fx.Variable("platform.mass", 20, 60), fx.Variable("home.position_mm[2]", 210, 250)]
    front = fx.pareto_front(positioner, varied, TotalMass(), trials=2, refine=0, samples=16)
    index, mass = front.start
    assert (front.index[front.against <= mass * (1 + 1e-9)] >= index * (1 - 1e-9)).any()


def test_limits_of_each_leg_are_shown_with_the_value_of_that_leg(positioner):
    pairs = [[0.1, 0.5]] * 5 + [[0.1, 0.2]]
    limited = positioner.replace({"limits.leg_length": pairs})
    found = fx.optimise(limited, fx.Variable("home.position_mm[2]", 100, 250), constraints=[DesignLimits()], **OPTIONS)
    longest = {check.name: check for check in found.start_checks}["longest leg"]
    assert longest.bound == 0.2
    lengths = fx.inverse_kinematics(limited, fx.home_pose(limited))
    assert longest.value == pytest.approx(lengths[5])
