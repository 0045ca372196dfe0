"""Corners of optimal design: designs that are none, searches that died, fronts that hold nothing."""

import json
import os
import socket
import sqlite3
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.design.layout import PLACES
from flexapod.errors import InfeasibleError
from flexapod.optimisation import constraint_quantities, design_search, pareto, study_file, verification
from flexapod.optimisation import local_search as finishing
from flexapod.optimisation.global_search import Study, _at_work, _conflict
from flexapod.optimisation.local_search import finish
from flexapod.optimisation.problem import Problem
from flexapod.plots import optimisation
from flexapod.plots.style import new_figure
from flexapod.report import page
from flexapod.report.studies import optimisation as studies

BOX = fx.Box(x=(-0.01, 0.01), y=0, z=0.25, roll=0, pitch=0, yaw=0)


@pytest.fixture(scope="module")
def positioner():
    return plain_machine("precision-positioner")


def problem(hexapod, *variables, aim=None, constraints=()):
    return Problem(hexapod, list(variables), aim or fx.LeastIndex(), list(constraints), "universal", 1)


def heavier(low=20, high=30):
    return fx.Variable("platform.mass", low, high)


def test_values_that_make_no_hexapod_keep_nothing(positioner):
    """An axis of length zero: the search goes on, a start is refused."""
    axis = fx.Variable("base.universal_axes[0][:]", 0, 1, kind="scale")
    asked = problem(positioner, axis, constraints=[fx.optimisation.TotalMass()])
    found = asked.assess_at(np.zeros(1), 16)
    assert found.index == 0.0
    assert not found.feasible
    assert np.isnan(found.values).all()
    with pytest.raises(InfeasibleError, match="the start breaks"):
        fx.optimise(positioner, axis, start={axis.targets: 0.0}, trials=0, samples=16, verify=32)
    held = []
    finishing._hold(asked, np.zeros(1), held, 16, 0)
    assert held == []


@pytest.mark.parametrize(
    ("wrong", "error", "words"),
    [
        ({"joint": "spin-free"}, fx.ArgumentError, "joint is 'spin-free'"),
        ({"threads": 0}, fx.ArgumentError, "threads is 0"),
        ({"objective": "index"}, fx.ArgumentError, "objective is 'index'; give a LeastIndex"),
        ({"objective": fx.LeastIndex}, fx.ArgumentError, "give a LeastIndex"),
        ({"seed": -1}, fx.ArgumentError, "seed is -1"),
        ({"samples": 0}, fx.ArgumentError, "samples is 0"),
        ({"verify": 16}, fx.ArgumentError, "verify is 16; it must be at least 32"),
        ({"hexapod": "precision-positioner"}, fx.DesignError, "must be a flexapod Hexapod"),
        ({"constraints": [fx.optimisation.Stroke(region="here")]}, fx.PoseError, "region is 'here'"),
        ({"sed": 1}, TypeError, r"optimise\(\) got an unexpected keyword argument 'sed'"),
    ],
)
def test_a_wrong_argument_is_not_taken_for_a_bad_design(positioner, wrong, error, words):
    given = {"hexapod": positioner, "variables": heavier(), "trials": 3, "samples": 16, "verify": 32, **wrong}
    with pytest.raises(error, match=words):
        fx.optimise(**given)


def test_a_start_that_only_breaks_one_constraint_names_that_one(positioner):
    bounds = [fx.optimisation.TotalMass(30.0), fx.optimisation.LegLength(most=10.0)]
    with pytest.raises(InfeasibleError) as error:
        fx.optimise(positioner, heavier(), constraints=bounds, start={"platform.mass": 25}, trials=0)
    assert "total mass is" in str(error.value)
    assert "longest leg" not in str(error.value)


def test_a_start_that_no_leg_can_take_has_no_index(positioner):
    """A platform in its own base: legs of no length."""
    flat = positioner.replace({"platform.joints": positioner.base_joints.tolist(), "home.position": [0, 0, 0]})
    with pytest.raises(InfeasibleError, match="the index is zero: a pose is singular, or out of the legs' reach"):
        fx.optimise(flat, heavier(), start={"platform.mass": 25}, trials=0)


def test_a_start_that_keeps_everything_is_taken(positioner):
    found = fx.optimise(positioner, heavier(), start={"platform.mass": 25.0}, trials=0)
    assert found.variables["platform.mass"] == pytest.approx(20.0)
    assert found.at_bounds == ("platform.mass",)


def test_a_design_without_home_is_improved_in_a_box(positioner):
    free = positioner.replace({"home": None})
    found = fx.optimise(free, heavier(), fx.LeastIndex(BOX), trials=0, samples=64, verify=128)
    assert found.index > found.start_index
    assert found.hexapod.home is None


def test_the_sweeps_own_poses_are_held_where_no_descent_is_possible(positioner, monkeypatch):
    def refused(*given, **options):
        raise fx.PoseError("no pose could be computed")

    monkeypatch.setattr(finishing, "worst_pose", refused)
    held = []
    finishing._hold(problem(positioner, heavier(), aim=fx.LeastIndex(BOX)), np.array([25.0]), held, 32, 0)
    assert len(held[0].rows) == 16
    index = fx.stability_index(positioner, fx.Pose.from_rpy(*held[0].rows.T))
    corner = fx.stability_index(positioner, fx.Pose.from_rpy(*np.array([0.01, 0, 0.25, 0, 0, 0])))
    assert index.min() <= corner


def test_a_finish_from_nothing_returns_the_start(positioner):
    axis = fx.Variable("base.universal_axes[0][:]", 0, 1, kind="scale")
    asked = problem(positioner, axis)
    ended = finish(asked, np.zeros(1), 16, stop=lambda: True)
    assert ended.assessment.index == 0.0
    assert ended.x == [0.0]


@pytest.mark.parametrize(
    "aim", [fx.LeastIndex(BOX), fx.optimisation.MeanIndex([[0, 0, 0.25, 0, 0, 0]]), fx.optimisation.Dexterity(BOX)]
)
def test_objectives_tell_themselves_apart(positioner, aim):
    others = [fx.LeastIndex(), fx.optimisation.MeanIndex([[0, 0, 0.26, 0, 0, 0]]), fx.optimisation.Dexterity()]
    told = json.dumps(problem(positioner, heavier(), aim=aim).describe()["objective"])
    assert told not in [
        json.dumps(problem(positioner, heavier(), aim=other).describe()["objective"]) for other in others
    ]


def test_limits_that_begin_at_nothing_bound_one_side(positioner):
    limited = positioner.replace({"limits.leg_length": [0.0, 0.5]})
    asked = problem(limited, heavier(), constraints=[fx.optimisation.DesignLimits()])
    names = [r.name for r in asked.requirements]
    assert "longest leg" in names
    assert "shortest leg" not in names


class PlatformMass(fx.optimisation.ConstraintQuantity):
    unit = "kg"

    def columns(self, found, numbers):
        return numbers[PLACES["platform.mass"]].reshape(1, 1)

    def derivatives(self, at):
        place = PLACES["platform.mass"].reshape(1)
        return fx.optimisation.Values(at.numbers[place], at.jacobian[place], np.zeros(1, int))


class Ballast(fx.optimisation.Constraint):
    def requirements(self, hexapod, region, measure):
        return [fx.optimisation.Requirement("ballast", PlatformMass(), "least", np.array(25.0), None)]


class HalfIndex:
    quantity, unit, label = "omega_1", "rad/s", "half the index"
    whole = fx.LeastIndex()
    region, worst_poses, derivatives = whole.region, whole.worst_poses, whole.derivatives

    def index(self, found):
        return 0.5 * self.whole.index(found)

    def describe(self):
        return {"half": self.whole.describe()}


def test_an_objective_and_a_constraint_of_ones_own(positioner):
    found = fx.optimise(positioner, heavier(20, 30), HalfIndex(), Ballast(), trials=3, samples=8, verify=16)
    assert found.variables["platform.mass"] == pytest.approx(25.0)
    assert found.index == pytest.approx(0.5 * fx.stability_index(found.hexapod, fx.home_pose(found.hexapod)))
    assert found.verification.checks[0].name == "ballast"


@pytest.mark.parametrize("name", ["scattered", "on a line", "repeated"])
def test_the_least_circle_holds_all_points_and_no_smaller_one_does(name):
    rng = np.random.default_rng(3)
    points = {
        "scattered": rng.normal(size=(6, 2)),
        "on a line": np.outer(np.arange(5.0), [0.3, -0.1]),
        "repeated": np.tile(rng.normal(size=(3, 2)), (2, 1)),
    }[name]
    middle, radius = constraint_quantities.enclosing_circle(points)
    assert np.linalg.norm(points - middle, axis=1).max() == pytest.approx(radius, rel=1e-12)
    for turn in np.linspace(0, 2 * np.pi, 40):
        moved = middle + 1e-3 * np.array([np.cos(turn), np.sin(turn)])
        assert np.linalg.norm(points - moved, axis=1).max() > radius * (1 - 1e-12)


def test_the_dense_sweep_that_breaks_a_constraint_is_said_so(positioner):
    found = fx.optimise(positioner, heavier(), constraints=[fx.optimisation.TotalMass()], trials=0)
    check = replace(found.verification.checks[0], kept=False)
    broken = replace(found, verification=replace(found.verification, checks=(check,)))
    assert "The dense sweep breaks: total mass. Search with more poses." in page(studies.optimal(broken, "x"))
    assert "The dense sweep breaks" not in page(studies.optimal(found, "x"))
    figure = optimisation.search(found)  # no trial: the begin and the end alone
    assert len(figure.get_xticks()) == 0


@pytest.fixture(scope="module")
def front(positioner):
    lift = fx.Variable("home.position_mm[2]", 220, 280)
    return fx.pareto_front(positioner, [heavier(15, 40), lift], fx.optimisation.TotalMass(45.0), trials=30, refine=0)


def test_a_front_keeps_the_bound_of_what_it_trades(front, positioner):
    assert front.against.max() <= 45.0
    assert len(front.designs) >= 2
    for hexapod, mass, (own, height) in zip(front.designs, front.against, front.variables, strict=True):
        assert hexapod.platform_mass == pytest.approx(own)
        assert fx.home_pose(hexapod).position[2] == pytest.approx(1e-3 * height)  # in the unit of its key
        assert mass == pytest.approx(own + sum(hexapod.legs.lower.mass) + sum(hexapod.legs.upper.mass))


def test_a_front_is_named_after_the_design_begun_with(front, positioner):
    text = page(studies.front(front, "least index at home"))
    assert f"<h1>{positioner.name}</h1>" in text
    assert "total mass, kg" in text
    assert positioner.digest in text


def test_a_front_far_from_its_trials_has_a_logarithmic_axis(front):
    assert optimisation.front(front).get_xscale() == "linear"
    history = front.history.copy(deep=True)
    history["against"][0] = 1e4
    history["feasible"][0], history["index"][0] = True, 100.0
    assert optimisation.front(replace(front, history=history)).get_xscale() == "log"


def test_numbers_of_legs_stand_apart_where_they_can():
    points = np.arange(6.0)[:, None] * [3.0, 0.0]
    base, platform = points.copy(), points + np.array([0.0, 10.0])
    base[0, 0], platform[0, 0] = 5.0, 0.0  # crosses leg 2 at 0.4 of its length
    base[5], platform[5] = base[3], platform[3]  # lies behind leg 4
    ax = new_figure(4, 3).subplots()
    optimisation._number(ax, base, platform)
    assert sorted(text.get_text() for text in ax.texts) == ["1", "2", "3", "4, 6", "5"]
    at = np.array([text.get_position() for text in ax.texts])
    assert (np.linalg.norm(at[:, None] - at, axis=2) + 9 * np.eye(5)).min() > 0.5


def test_a_front_with_nothing_on_it_is_infeasible(positioner, monkeypatch):
    with pytest.raises(InfeasibleError, match="none of 6 trials keeps every constraint"):
        fx.pareto_front(
            positioner,
            [heavier(), fx.Variable("home.position_mm[2]", 220, 280)],
            fx.optimisation.TotalMass(),
            constraints=[fx.optimisation.LegLength(most=0.01)],
            trials=6,
        )
    real = pareto.verify
    monkeypatch.setattr(pareto, "verify", lambda *given: SimpleNamespace(holds=False, checks=real(*given).checks))
    with pytest.raises(InfeasibleError, match="on poses that the search has not seen"):
        fx.pareto_front(positioner, heavier(), fx.optimisation.TotalMass(), trials=6, refine=0)


def test_a_worker_that_cannot_be_asked_is_taken_to_be_there(monkeypatch):
    host = socket.gethostname()
    assert _at_work("another-machine:1")
    assert _at_work(f"{host}:{os.getpid()}")
    monkeypatch.setattr(os, "kill", lambda pid, number: (_ for _ in ()).throw(PermissionError))
    assert _at_work(f"{host}:1")  # another user's


def test_trials_of_a_dead_worker_are_closed(positioner, tmp_path):
    import optuna

    file = tmp_path / "search.db"
    first = Study(problem(positioner, heavier()), file)
    trial = first._study.ask()
    trial.set_user_attr("worker", f"{socket.gethostname()}:4194305")  # above the highest process number of Linux
    own = first._study.ask()
    own.set_user_attr("worker", f"{socket.gethostname()}:{os.getpid()}")
    again = Study(problem(positioner, heavier()), file)
    states = [t.state for t in again._study.get_trials()]
    assert states == [optuna.trial.TrialState.FAIL, optuna.trial.TrialState.RUNNING]


def test_a_broken_study_file_is_told(positioner, tmp_path):
    file = tmp_path / "search.db"
    file.write_bytes(b"SQLite format 3\0" + b"x" * 4096)
    with pytest.raises(fx.errors.OutputError, match=r"search\.db cannot be used as a study file"):
        Study(problem(positioner, heavier()), file)


def test_a_full_disk_is_told_where_sqlite_does_not_say_so(tmp_path, monkeypatch):
    pytest.importorskip("optuna")
    rooms = iter((2**30, 4096))
    monkeypatch.setattr("shutil.disk_usage", lambda place: SimpleNamespace(free=next(rooms)))
    for words in ("used as a study file: disk I/O error", r"used as a study file: its disk is full \(disk I/O error\)"):
        with pytest.raises(fx.errors.OutputError, match=words), study_file.told(tmp_path / "s.db"):
            raise sqlite3.OperationalError("disk I/O error")


def test_a_study_of_a_later_version_is_not_taken_for_ours(positioner):
    here = problem(positioner, heavier()).describe()
    assert _conflict({**here, "from the future": 1}, here) == "holds another search."


def failing(*given, **options):
    raise np.linalg.LinAlgError("SVD did not converge")


def test_a_search_whose_verification_fails_keeps_what_it_has(positioner, monkeypatch):
    monkeypatch.setattr(verification, "worst_pose", failing)
    found = fx.optimise(positioner, heavier(), fx.LeastIndex(BOX), trials=2, samples=64, verify=128)
    assert found.variables["platform.mass"] == pytest.approx(20.0)
    assert found.index > found.start_index > 0
    assert found.verification.points == 64
    assert [text for text in found.failures if "could not be verified at 128 poses (SVD did not converge)" in text]
    assert "could not be verified" in page(studies.optimal(found, "x"))


def test_a_local_search_that_fails_does_not_lose_the_trials(positioner, monkeypatch):
    monkeypatch.setattr(finishing._Local, "solve", failing)
    found = fx.optimise(positioner, heavier(20, 40), trials=12, samples=16, verify=32)
    assert found.index > found.start_index
    assert "A local search ended early: SVD did not converge." in found.failures
    front = fx.pareto_front(positioner, heavier(15, 40), fx.optimisation.TotalMass(), trials=6, refine=2, samples=16)
    assert len(front.designs) >= 1
    assert "A local search ended early: SVD did not converge." in front.failures


def test_a_design_of_a_front_that_cannot_be_verified_is_left_out(positioner, monkeypatch):
    real, count = pareto.verify, iter(range(100))
    monkeypatch.setattr(pareto, "verify", lambda *given: failing() if next(count) == 0 else real(*given))
    front = fx.pareto_front(positioner, heavier(15, 40), fx.optimisation.TotalMass(), trials=12, refine=0, samples=16)
    assert front.failures == ("A design of the front could not be verified: SVD did not converge.",)


def test_a_local_search_that_does_not_converge_is_told(positioner, monkeypatch):
    def stuck(self, u):
        self.message = "Inequality constraints incompatible"
        return u

    monkeypatch.setattr(finishing._Local, "solve", stuck)
    found = fx.optimise(positioner, heavier(20, 40), trials=0)
    assert found.hexapod is positioner
    assert len(found.failures) == 1
    assert "did not converge (Inequality constraints incompatible)" in found.failures[0]


def test_a_start_that_makes_no_hexapod_is_no_local_search(positioner):
    """Joints of a pair that would coincide with a leg of no length: nothing to descend from."""
    axis = fx.Variable("base.universal_axes[0][:]", -1, 1, kind="scale")
    ended = finish(problem(positioner, axis), np.zeros(1), 16)
    assert (ended.rounds, ended.message) == (0, "its start makes no hexapod")


def test_the_verification_uses_poses_of_its_own():
    """Whatever the seed of the search, those of the verification are others."""
    for seed in range(100):
        used = {seed + k for k in range(8)} | {seed + design_search._DENSE + k for k in range(8)}
        assert not used & {verification.SEED + k for k in range(4)}


HUGE = 10**400


@pytest.mark.parametrize("wrong", [HUGE, float("nan"), "a", 1j, [1, 2, 3]], ids=lambda x: str(x)[:9])
@pytest.mark.parametrize(
    "use",
    [
        lambda h, x: fx.optimise(h, fx.Variable("platform.mass", 1, x), trials=0),
        lambda h, x: fx.optimise(h, fx.Variable({"platform.mass": x}, 1, 2), trials=0),
        lambda h, x: fx.optimise(h, [heavier(), fx.optimisation.JointCircle("base", half_angle=x)], trials=0),
        lambda h, x: fx.optimise(h, fx.optimisation.JointCircle("base", half_angle=(0, x)), trials=0),
        lambda h, x: fx.optimise(h, fx.optimisation.JointCircle("base", radius=(1, 2), units={"radius": x}), trials=0),
        lambda h, x: fx.optimise(h, heavier(), start={"platform.mass": x}, trials=0),
        lambda h, x: fx.optimise(h, heavier(), constraints=[fx.optimisation.LegLength(0.1, x)], trials=0),
        lambda h, x: fx.optimise(h, heavier(), constraints=[fx.optimisation.ConditionNumber(x)], trials=0),
        lambda h, x: fx.optimise(h, heavier(), constraints=[fx.optimisation.JointAngle(x)], trials=0),
        lambda h, x: fx.optimise(h, heavier(), seed=-1 if x is HUGE else x, trials=0),
        lambda h, x: fx.pareto_front(h, heavier(), fx.optimisation.TotalMass(), trials=float("inf") if x is HUGE else x),
        lambda h, x: fx.optimisation.MeanIndex([[0, 0, 0.25, 0, 0, 0]], weights=[x]),
        lambda h, x: fx.robustness(h, fx.optimisation.Payload((0, x))),
        lambda h, x: fx.robustness(h, fx.optimisation.Payload((0, 1), (("a", 1), 0, x))),
        lambda h, x: fx.robustness(h, fx.Uncertain("legs.stiffness", x)),
    ],
)  # fmt: skip
def test_numbers_that_are_none_are_refused(positioner, use, wrong):
    with pytest.raises(fx.ArgumentError):
        use(positioner, wrong)


def test_a_search_takes_no_harm_from_strict_floating_point_errors(positioner):
    kept = [fx.optimisation.ConditionNumber(region=BOX), fx.optimisation.Deflection(force=1.0)]
    with np.errstate(all="raise"):
        found = fx.optimise(
            positioner, heavier(), fx.optimisation.Dexterity(BOX), kept, trials=0, samples=16, verify=32
        )
        better = fx.optimise(positioner, heavier(), fx.LeastIndex(BOX), kept, trials=0, samples=16, verify=32)
    assert not found.failures
    assert better.index > better.start_index
