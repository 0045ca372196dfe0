"""Summaries and the worst pose: against NumPy and SciPy, by blocks as in one go, and true minima."""

import numpy as np
import pytest
from scipy.optimize import differential_evolution
from scipy.stats import spearmanr
from tests.helpers.plain import plain_machine
from tests.helpers.stores import BOX, I, stored
from tests.helpers.support import MACHINES

import flexapod as fx
from flexapod.conventions import AXES
from flexapod.workspace import descents, distribution
from flexapod.workspace import summary as module
from flexapod.workspace.box_minimum import constrained_minimum, smooth_minimum

POSES = fx.random_poses(BOX, 20_000, seed=1)
FOUND = fx.sweep(I, POSES)


def test_summary_is_what_numpy_and_scipy_find():
    summary = fx.summarise(FOUND, at_least=200.0)
    omega, cond = FOUND.omega_1.values, FOUND.cond_H.values
    assert summary.poses == 20_000
    assert summary.statuses == {"ok": 20_000}
    assert summary.worst.number == omega.argmin()
    assert summary.worst.omega_1 == omega.min()
    assert summary.worst.cond_H == cond[omega.argmin()]
    assert np.array_equal(summary.worst.pose, POSES.rows(omega.argmin(), omega.argmin() + 1)[0])
    assert summary.best.omega_1 == omega.max()
    assert summary.best_conditioned.omega_1 == omega[cond.argmin()]
    assert summary.worst_conditioned.cond_H == cond.max()
    assert list(summary.quantiles.values()) == np.quantile(omega, list(summary.quantiles)).tolist()
    assert summary.correlation == pytest.approx(spearmanr(omega, cond).statistic, rel=1e-12)
    assert summary.above.fraction == (omega >= 200).mean()
    assert summary.above.volume == pytest.approx(summary.above.fraction * 0.16**3 * 0.3**3)
    assert summary.above.volume_unit == "m3 rad3"


@pytest.mark.filterwarnings("ignore::scipy.stats.ConstantInputWarning")
@pytest.mark.parametrize("cond", [[3.0, 1.0, np.inf, 1.0, 2.0], [1.0] * 5, [5.0, 4.0, 3.0, 2.0, 1.0]])
def test_equal_values_share_their_rank_and_keep_their_order(cond):
    omega = np.array([2.0, 7.0, 7.0, 1.0, 3.0])
    found = distribution.exactly(iter([[omega[:2], np.array(cond[:2])], [omega[2:], np.array(cond[2:])]]))
    assert found.correlation == pytest.approx(spearmanr(omega, cond).statistic, nan_ok=True)
    repeated = np.tile(cond, 2000)
    assert np.array_equal(distribution._ranked(repeated)[0], np.argsort(repeated, kind="stable"))


def test_standard_error_is_that_of_repeated_draws():
    fractions = []
    for seed in range(30):
        found = fx.summarise(fx.sweep(I, fx.random_poses(BOX, 500, seed=seed), quantities=("omega_1",)), at_least=200.0)
        fractions.append(found.above.fraction)
    assert 0.6 < np.std(fractions) / found.above.standard_error < 1.5  # 30 draws: their spread is known to 13 %


def test_many_poses_are_summarised_by_bins_as_well(monkeypatch):
    exact = fx.summarise(FOUND, at_least=200.0)
    monkeypatch.setattr(module, "EXACT", 1000)
    binned = fx.summarise(FOUND, at_least=200.0)
    assert binned.worst.number == exact.worst.number
    assert binned.above == exact.above
    bins = np.log(exact.best.omega_1 / exact.worst.omega_1) / distribution._BINS
    for level, value in exact.quantiles.items():  # a bin's width, or the gap to the next of 20 000 poses
        assert binned.quantiles[level] == pytest.approx(value, rel=bins + 1e-3)
    assert binned.correlation == pytest.approx(exact.correlation, abs=1e-3)  # ranks to a thousandth
    assert binned.spread == pytest.approx(exact.spread, rel=0.02)  # bands of 400 poses with other edges


def test_a_store_has_the_summary_of_the_same_sweep(tmp_path):
    stored(tmp_path / "map.zarr", POSES, chunk=3000)
    one, other = fx.summarise(fx.open_sweep(tmp_path / "map.zarr"), 200.0), fx.summarise(FOUND, 200.0)
    assert np.array_equal(one.worst.pose, other.worst.pose)
    assert one._replace(worst=None, best=None, best_conditioned=None, worst_conditioned=None) == other._replace(
        worst=None, best=None, best_conditioned=None, worst_conditioned=None
    )


def test_a_store_in_part_is_summarised_in_part(tmp_path):
    store = fx.workspace.SweepStore.create(tmp_path / "map.zarr", I, POSES, chunk=2000)
    asked = iter(range(100))
    store.run(workers=1, stop=lambda: next(asked) > 3)
    summary = fx.summarise(fx.open_sweep(tmp_path / "map.zarr"), at_least=0.0)
    assert summary.statuses == {"ok": summary.statuses["ok"], "pending": 20_000 - summary.statuses["ok"]}
    assert 0 < summary.statuses["ok"] < 20_000
    assert summary.above.fraction == 1.0


def test_bad_poses_are_counted_and_left_out():
    rows = POSES.rows(0, 100).copy()
    rows[3, 0] = np.nan
    summary = fx.summarise(fx.sweep(I, rows))
    assert summary.statuses == {"ok": 99, "not_finite": 1}
    assert summary.worst.omega_1 == np.delete(fx.sweep(I, POSES.rows(0, 100)).omega_1.values, 3).min()


LIMITED = plain_machine("motion-base")
REGION = fx.random_poses(fx.Box.about(fx.home_pose(LIMITED), 0.67, 0.4), 5000, seed=2)


def test_poses_beyond_the_limits_do_not_count(tmp_path, monkeypatch):
    found = fx.sweep(LIMITED, REGION)
    omega, cond, inside = (found[name].values for name in ("omega_1", "cond_H", "within_limits"))
    assert np.array_equal(inside, fx.check_limits(LIMITED, fx.Pose.from_rpy(*REGION.rows(0, 5000).T)).ok)
    stored(tmp_path / "map.zarr", REGION, None, chunk=700, design=LIMITED)
    for sweep in (found, fx.open_sweep(tmp_path / "map.zarr")):
        summary = fx.summarise(sweep, at_least=27.0)
        assert summary.within_limits == inside.sum()
        assert summary.worst.number == np.where(inside, omega, np.inf).argmin()
        assert summary.best.number == np.where(inside, omega, -np.inf).argmax()
        assert summary.worst_conditioned.cond_H == cond[inside].max()
        assert list(summary.quantiles.values()) == np.quantile(omega[inside], list(summary.quantiles)).tolist()
        assert summary.correlation == pytest.approx(spearmanr(omega[inside], cond[inside]).statistic, rel=1e-12)
        assert summary.above.fraction == (omega[inside] >= 27).mean()
        assert summary.above.volume == pytest.approx((inside & (omega >= 27)).mean() * found.attrs["box_volume"])
        everything = fx.summarise(sweep, at_least=27.0, all_poses=True)
        assert everything.within_limits == inside.sum()
        assert everything.worst.omega_1 == omega.min() < summary.worst.omega_1
        assert everything.above.fraction == (omega >= 27).mean()
    monkeypatch.setattr(module, "EXACT", 10)
    binned = fx.summarise(found)
    assert binned.quantiles[0.5] == pytest.approx(np.median(omega[inside]), rel=1e-3)


def test_what_was_not_swept_does_not_limit():
    found = fx.sweep(LIMITED, REGION, quantities=["omega_1"])
    assert "within_limits" not in found
    assert fx.summarise(found).within_limits is None
    assert fx.summarise(found).worst.omega_1 == found.omega_1.values.min()
    assert "within_limits" not in FOUND  # a design without limits
    assert "within_limits" in fx.sweep(LIMITED, REGION.rows(0, 3))


def test_a_sweep_out_of_reach_is_told():
    found = fx.sweep(LIMITED, fx.pose_grid(z=[3.5, 3.6]))
    with pytest.raises(fx.PoseError, match="none of the 2 poses is within the design's limits"):
        fx.summarise(found)
    assert fx.summarise(found, all_poses=True).within_limits == 0


def test_a_grid_names_its_worst_pose():
    found = fx.sweep(I, fx.pose_grid(x=[0.0, 0.1, 0.2], y=0.2, z=[0.7, 0.8]), quantities=("omega_1",))
    at = fx.summarise(found).worst
    place = np.unravel_index(found.omega_1.values.argmin(), (3, 2))
    assert at.pose.tolist() == [[0.0, 0.1, 0.2][place[0]], 0.2, [0.7, 0.8][place[1]], 0, 0, 0]
    assert np.isnan(at.cond_H)


def test_a_summary_needs_the_index():
    with pytest.raises(fx.ArgumentError, match="does not hold omega_1"):
        fx.summarise(fx.sweep(I, POSES.rows(0, 10), quantities=("cond_H",)))


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_derivatives_by_the_coordinates_are_exact(joint):
    square = descents.SquaredFrequency(I, joint, mode=1)
    six = POSES.rows(4, 5)[0]
    value, slope = square(six)
    for k, step in enumerate(np.full(6, 1e-5)):
        ends = [square(six + sign * step * np.eye(6)[k])[0] for sign in (1, -1)]
        # central differences: error of the order of step^2 and eps / step, both below 1e-7 of the value
        assert slope[k] == pytest.approx((ends[0] - ends[1]) / (2 * step), abs=1e-6 * value)


def _index(design, six):
    return float(fx.stability_index(design, fx.Pose.from_rpy(*six)))


@pytest.mark.parametrize("name", MACHINES)
def test_worst_pose_is_a_local_minimum_below_the_sweep(name, measured):
    design = plain_machine(name)
    reach = np.ptp(design.base_joints, axis=0).max()
    box = fx.Box.about(fx.home_pose(design), 0.05 * reach, 0.1)
    worst = fx.worst_pose(design, box, samples=4096, all_poses=True)
    dense = fx.sweep(design, fx.workspace.low_discrepancy(box, 2**17, seed=9), quantities=("omega_1",))
    measured("sweeps/worst", worst.omega_1 / float(dense.omega_1.min()), 1)
    assert worst.omega_1 < worst.sampled
    assert worst.omega_1 == pytest.approx(_index(design, worst.pose), rel=1e-12)
    assert ((worst.pose >= box.low) & (worst.pose <= box.high)).all()
    rng = np.random.default_rng(0)
    near = np.clip(worst.pose + 1e-3 * (box.high - box.low) * rng.normal(size=(500, 6)), box.low, box.high)
    assert float(fx.sweep(design, near).omega_1.min()) >= worst.omega_1 * (1 - 1e-12)
    for k, axis in enumerate(AXES):  # the conditions of Kuhn and Tucker
        if axis in worst.at_bounds:
            outward = 1 if worst.pose[k] == box.high[k] else -1
            assert outward * worst.gradient[k] <= 1e-6 * worst.omega_1
        else:
            assert abs(worst.gradient[k]) * (box.high - box.low)[k] < 1e-5 * worst.omega_1
    assert 1 <= worst.agreed <= worst.starts


def test_worst_pose_is_the_one_that_a_global_search_finds(measured):
    box = fx.Box(x=(0.0, 0.2), y=(0.1, 0.3), z=0.8, yaw=(-0.3, 0.3))
    worst = fx.worst_pose(I, box, samples=2048)

    def index(u):
        return _index(I, [u[0], u[1], 0.8, 0, 0, u[2]])

    other = differential_evolution(index, [(0, 0.2), (0.1, 0.3), (-0.3, 0.3)], rng=1, maxiter=40, popsize=8)
    measured("sweeps/global", max(worst.omega_1 / other.fun - 1, 0), 1e-9)
    assert worst.pose[[2, 3, 4]].tolist() == [0.8, 0, 0]


def test_a_singular_pose_in_the_box_is_found():
    worst = fx.worst_pose(I, fx.Box.about(fx.home_pose(I), 0.12, np.radians(25)), samples=4096)
    assert worst.singular
    assert worst.sampled > 0.01
    # 1e-9 of the largest frequency is what the descent calls zero
    assert worst.omega_1 < 1e-9 * fx.natural_modes(I, fx.Pose.from_rpy(*worst.pose)).omega[-1] * 10
    assert worst.agreed == worst.starts


def test_an_interior_minimum_is_found_to_rounding():
    """In this box of cubic-isolator the index is least at the bounds of five coordinates and inside that of yaw."""
    design = plain_machine("cubic-isolator")
    worst = fx.worst_pose(design, fx.Box.about(fx.home_pose(design), 0.02, 0.15), samples=2**13, all_poses=True)
    assert worst.at_bounds == ("x", "y", "z", "roll", "pitch")
    yaw = worst.pose[5] + np.linspace(-1e-3, 1e-3, 41)
    line = fx.sweep(design, fx.pose_grid(*worst.pose[:5], yaw=yaw), quantities=("omega_1",)).omega_1.values
    curve = np.polynomial.Polynomial.fit(yaw, line, 2).convert()
    assert curve.coef[2] > 0
    # a parabola through an interval of 1e-3 has its least point to about the square of that
    assert worst.pose[5] == pytest.approx(-curve.coef[1] / (2 * curve.coef[2]), abs=2e-6)


def test_descent_passes_repeated_lowest_modes():
    """At the centre of motion-base the two lowest modes are one to rounding, with a ridge between them."""
    omega = fx.natural_modes(BASE := plain_machine("motion-base"), fx.home_pose(BASE)).omega
    assert omega[1] - omega[0] < 0.2 * omega[1]
    box = fx.Box.about(fx.home_pose(BASE), 0.1, 0.1)
    square = descents.SquaredFrequency(BASE, "universal", mode=1)
    home = (box.low + box.high) / 2
    pose = smooth_minimum(square, home, box.low, box.high)
    index = square.root(pose)
    assert index < 0.999 * _index(BASE, home)
    corner = np.isclose(pose, box.low) | np.isclose(pose, box.high)
    gradient = square.gradient(pose)
    assert np.abs(gradient[~corner] * (box.high - box.low)[~corner]).max(initial=0) < 1e-4 * index


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"starts": 0}, "starts is 0"),
        ({"samples": 0}, "samples is 0"),
        ({"joint": "loose"}, "joint is 'loose'"),
    ],
)
def test_bad_arguments_are_told(arguments, words):
    with pytest.raises(fx.ArgumentError, match=words):
        fx.worst_pose(I, BOX, **arguments)


def test_the_worst_of_poses_is_one_of_them():
    """A region that lists its poses, or that is one: none lies between them."""
    home = fx.home_pose(BASE := plain_machine("motion-base"))
    index = fx.stability_index(BASE, home)
    six = np.concatenate([home.position, home.rpy])
    for region in (None, home, six, fx.Box(*six)):
        assert fx.worst_pose(BASE, region).omega_1 == pytest.approx(index, rel=1e-12)
    poses = fx.random_poses(fx.Box.about(home, 0.1, 0.1), 100)
    worst = fx.worst_pose(BASE, poses)
    found = fx.sweep(BASE, poses)
    assert np.array_equal(worst.pose, poses.rows(0, 100)[found.omega_1.values.argmin()])
    assert worst.omega_1 == pytest.approx(float(found.omega_1.min()), rel=1e-12)
    fixed, moving = fx.Box.about(home, 0.1, 0.1), fx.Workspace.about_home(0.1, 0.1)
    assert fx.worst_pose(BASE, moving, samples=64).omega_1 == fx.worst_pose(BASE, fixed, samples=64).omega_1


@pytest.mark.parametrize("given", [fx.Pose((0.0, 0.0, 0.5)), np.arange(3), None, {"omega_1": [1.0]}])
def test_what_is_no_sweep_is_told(given):
    with pytest.raises(fx.errors.ArgumentError, match=r"sweep is .*; it must be a Dataset, as flexapod.sweep"):
        fx.summarise(given)


@pytest.mark.parametrize("descend", ["smooth", "constrained"])
def test_a_descent_begins_where_the_value_is_nothing(descend):
    """As the index is at a singular pose: there is no value then to measure others in."""

    def sloped(point):
        return float(point.sum()), np.ones(2)

    low, high, start = np.full(2, -1.0), np.full(2, 1.0), np.zeros(2)
    with np.errstate(all="raise"):
        if descend == "smooth":
            found = smooth_minimum(sloped, start, low, high)
        else:
            found = constrained_minimum(sloped, lambda p: (np.ones(1), np.zeros((1, 2))), start, low, high)
    assert found == pytest.approx(low)
