"""Robustness: the kernel for many designs against single machines, and distributions with a closed form."""

import numpy as np
import pytest
from tests.helpers.plain import file, plain_machine
from tests.helpers.support import apart

import flexapod as fx
from flexapod import _core
from flexapod.design.packing import PLACES
from flexapod.optimisation.ensemble import Ensemble


def rows_of(poses):
    return poses.packed


@pytest.mark.parametrize("joint", _core.Joint)
def test_many_designs_at_once_are_as_one_by_one(joint, measured):
    rng = np.random.default_rng(2)
    machine = fx.load("mukherjee-i")
    designs = machine.packed * (1 + 0.02 * rng.standard_normal((37, _core.design_size)))  # no multiple of the lanes
    six = np.concatenate([machine.home.position, machine.home.rpy]) + 0.05 * rng.standard_normal((37, 6))
    poses = fx.Pose.from_rpy(*six.T)
    still = fx.Motion.fixed().packed[None]
    motions = fx.Motion(poses).packed

    def alone(design, k):
        return _core.natural_modes(design, joint, motions[k : k + 1], still)[0][0]

    paired = _core.sweep_designs(designs, joint, rows_of(poses), True, 6, 2)
    expected = np.array([alone(design, k) for k, design in enumerate(designs)])
    measured("design/ensemble", apart(paired[:, 0], expected), 1e-10)  # eps times the root of cond(J), with room
    every = _core.sweep_designs(designs, joint, rows_of(poses)[:5], False, 1, 1)
    assert every.shape == (37, 5, 1)
    np.testing.assert_allclose(every[3, :, 0], [alone(designs[3], k)[0] for k in range(5)], rtol=1e-10)


def test_many_designs_at_repeated_frequencies_and_impossible_poses():
    machine = plain_machine("cubic-isolator").replace({"legs.lower": None, "legs.upper": None})
    designs = np.tile(machine.packed, (20, 1))
    designs[7, PLACES["platform.mass"]] = np.nan
    home = fx.home_pose(machine)
    at_home = rows_of(fx.Pose(home.position[None], home.matrix[None]))
    omega = _core.sweep_designs(designs, _core.Joint.universal, at_home, False, 6, 1)
    expected = fx.natural_modes(machine, home).omega
    assert np.isnan(omega[7]).all()
    np.testing.assert_allclose(np.delete(omega[:, 0], 7, axis=0), np.tile(expected, (19, 1)), rtol=1e-12)


def test_a_stiffness_common_to_all_legs_has_the_closed_form(measured):
    """omega is proportional to sqrt(K): quantiles, mean and worst case follow from those of K."""
    machine = plain_machine("motion-base")
    found = fx.robustness(machine, fx.Uncertain("legs.stiffness", 0.2, each=False), samples=2**12)
    nominal = fx.stability_index(machine, fx.home_pose(machine))
    assert found.nominal == pytest.approx(nominal, rel=1e-12)
    assert found.worst == pytest.approx(nominal * np.sqrt(0.8), rel=1e-12)
    assert found.worst_at["legs.stiffness"] == pytest.approx(0.8 * 8e6)
    mean = nominal * (1.2**1.5 - 0.8**1.5) / (1.5 * 0.4)
    measured("design/uncertain", apart(found.mean, mean), 1e-5)  # a Sobol sequence of 4096 points in one dimension
    for q, value in found.quantiles.items():
        assert value == pytest.approx(nominal * np.sqrt(0.8 + 0.4 * q), rel=1e-3)


@pytest.mark.parametrize(
    ("distribution", "deviation"), [("normal", 0.05), ("triangular", 0.05 / np.sqrt(6)), ("lognormal", 0.05)]
)
def test_distributions_have_their_mean_and_deviation(distribution, deviation):
    machine = plain_machine("motion-base")
    uncertain = [fx.Uncertain("platform.mass", 0.05, distribution), fx.Uncertain("legs.stiffness", 0.05, distribution)]
    found = fx.robustness(machine, uncertain, samples=2**13)
    mass = found.samples["platform.mass"].values / 4000
    mean = np.exp(0.05**2 / 2) if distribution == "lognormal" else 1.0
    assert mass.mean() == pytest.approx(mean, abs=1e-4)
    assert mass.std() == pytest.approx(deviation, rel=0.01)  # the tails beyond four deviations are cut: 0.1 %
    legs = np.array([found.samples[f"legs.stiffness[{k}]"].values for k in range(6)])
    assert np.abs(np.corrcoef(legs) - np.eye(6)).max() < 0.05  # each leg strays on its own


def test_a_payload_is_a_point_mass():
    machine = plain_machine("motion-base")
    ensemble = Ensemble(
        machine,
        [
            fx.optimisation.Payload((100, 100), (0.3, -0.2, (1.5, 1.5))),
            fx.Uncertain("legs.stiffness", 1e-9, each=False),
        ],
    )
    packed = ensemble.designs(np.full((1, 1), 0.5))[0]
    M, R = 4000.0, np.array([0.0, 0.0, 1.0])
    at = np.array([0.3, -0.2, 1.5])
    center = (M * R + 100 * at) / (M + 100)

    def about(m, d):
        return m * (d @ d * np.eye(3) - np.outer(d, d))

    inertia = machine.platform_inertia + about(M, R - center) + about(100.0, at - center)
    loaded = machine.replace(
        {"platform.mass": M + 100, "platform.mass_center": center.tolist(), "platform.inertia": inertia.tolist()}
    )
    np.testing.assert_allclose(packed, loaded.packed, rtol=1e-12, atol=1e-9)


def test_worst_case_is_below_every_sample_and_at_a_corner():
    machine = plain_machine("precision-positioner")
    uncertain = [fx.Uncertain("legs.stiffness", 0.1), fx.Uncertain("platform.mass_center_mm[2]", 20, relative=False)]
    box = fx.Workspace.about_home(0.005, np.radians(1))
    found = fx.robustness(machine, uncertain, box, samples=512, pose_samples=32)
    assert found.worst <= found.samples["index"].min()
    assert found.worst_at["legs.stiffness[3]"] == pytest.approx(0.9 * 5e7)
    assert found.worst_at["platform.mass_center_mm[2]"] == pytest.approx(118.07, rel=1e-6)  # higher is worse
    changed = machine.replace({"legs.stiffness": 0.9 * 5e7, "platform.mass_center_mm": [0, 0, 118.07]})
    home = np.concatenate([machine.home.position, machine.home.rpy])
    assert found.worst == pytest.approx(
        float(fx.sweep(changed, box.rows(home, 32), quantities="omega_1").omega_1.min()), rel=1e-9
    )


def test_sobol_indices_of_a_sum_of_known_parts(measured):
    """For small spreads ln(omega) is linear: with all stiffnesses K and all masses strayed alike, omega ~ sqrt(K/M), so
    the shares of the variance are those of K and M; friction has none."""
    machine = plain_machine("motion-base").replace(
        {"legs.lower": None, "legs.upper": None, "platform.mass_center": [0, 0, 0]}
    )
    uncertain = [
        fx.Uncertain("legs.stiffness", 0.02, each=False),
        fx.Uncertain("legs.damping.prismatic", 0.5, each=False),
        fx.Uncertain("platform.mass", 0.01),
        fx.Uncertain("platform.inertia[0][0]", 1e-6),
    ]
    found = fx.robustness(machine, uncertain, samples=64, sensitivity=512)
    total = found.sensitivity.total.values
    by_mass = (
        np.log(fx.stability_index(machine.replace({"platform.mass": 4040}), fx.home_pose(machine)) / found.nominal)
        / 0.01
    )
    parts = np.array([(0.5 * 0.02) ** 2, 0.0, (by_mass * 0.01) ** 2, 0.0])
    measured("design/sobol", total - parts / parts.sum(), 0.01)
    assert (found.sensitivity.total_confidence.values >= 0).all()


def test_the_numbers_do_not_depend_on_threads():
    machine = fx.load("mukherjee-i")
    one, two = (fx.robustness(machine, fx.Uncertain("legs.stiffness", 0.1), samples=3000, threads=n) for n in (1, 2))
    np.testing.assert_array_equal(one.samples["index"], two.samples["index"])


BAD = {
    "may go down to": [fx.Uncertain("legs.stiffness", 1.5)],
    "the spread is -1": [fx.Uncertain("legs.stiffness", -1)],
    "'gauss'": [fx.Uncertain("legs.stiffness", 0.1, "gauss")],
    "is given twice": [fx.Uncertain("platform.mass", 0.1), fx.Uncertain("platform.mass", 0.2)],
    "the least first": [fx.optimisation.Payload((5, 1))],
    "is empty": [],
    "is zero, so a share of it is nothing": [fx.Uncertain("platform.mass_center[0]", 0.1)],
    "not an uncertain number": [fx.Uncertain("home.position[2]", 0.1)],
    "every range is one number": [fx.optimisation.Payload((5, 5))],
    "Did you mean": [fx.Uncertain("legs.stifness", 0.1)],
}


@pytest.mark.parametrize("words", BAD)
def test_bad_input_is_told_by_name(words):
    with pytest.raises(fx.ArgumentError) as error:
        fx.robustness(plain_machine("motion-base"), BAD[words], samples=16)
    assert words in str(error.value)
    with pytest.raises(fx.ArgumentError, match="power of two"):
        fx.robustness(plain_machine("motion-base"), [fx.Uncertain("legs.stiffness", 0.1)], samples=16, sensitivity=100)


def test_the_same_seed_gives_the_same_shares_and_confidence():
    parts = [fx.Uncertain("legs.stiffness", 0.1), fx.Uncertain("platform.mass", 0.1)]
    first, again = (
        fx.robustness(plain_machine("motion-base"), parts, samples=16, sensitivity=16, seed=0).sensitivity
        for _ in range(2)
    )
    assert first.identical(again)


@pytest.mark.parametrize(("amount", "worst"), [(0.0075, 20.787983), (0.01, 17.932368), (0.015, 11.304789)])
def test_the_worst_case_of_many_joints_is_the_corner_that_hundreds_of_descents_find(amount, worst):
    """The corner by 600 greedy descents; eight neighbouring starts ended up to 12 % above it."""
    machine = plain_machine("cubic-isolator")
    joints = [fx.Uncertain(f"{plate}.joints", amount, relative=False) for plate in ("base", "platform")]
    found = fx.robustness(machine, joints, samples=1024)
    assert found.worst == pytest.approx(worst, rel=1e-6)
    assert 1 < found.agreed < found.searches
    by_key = {}
    for name, value in found.worst_at.items():
        by_key[name.partition("[")[0]] = [*by_key.get(name.partition("[")[0], []), value]
    there = machine.replace({key: np.reshape(values, (6, 3)).tolist() for key, values in by_key.items()})
    assert fx.stability_index(there, fx.home_pose(machine)) == pytest.approx(found.worst, rel=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_the_worst_case_is_at_least_as_low_as_every_corner(seed):
    """Twelve parameters: too many for all corners, few enough to try them here."""
    machine = fx.load("mukherjee-i")
    straying = [fx.Uncertain("legs.stiffness", 0.3), fx.Uncertain("legs.upper.mass", 0.5)]
    found = fx.robustness(machine, straying, samples=64, seed=seed)
    ensemble = Ensemble(machine, straying)
    corners = np.array(np.meshgrid(*[[0.0, 1.0]] * 12)).reshape(12, -1).T
    rows = rows_of(fx.Pose(machine.home.position[None], machine.home.matrix[None]))
    every = _core.sweep_designs(ensemble.designs(corners), _core.Joint.universal, rows, False, 1, 1)[:, 0, 0]
    assert found.worst <= every.min() * (1 + 1e-9)


def test_few_parameters_have_all_their_corners():
    machine = plain_machine("precision-positioner")
    straying = [fx.Uncertain("base.joints_mm[:][2]", 20, relative=False), fx.Uncertain("platform.mass", 0.1)]
    found = fx.robustness(machine, straying, samples=2)
    corners = np.array(np.meshgrid(*[[0.0, 1.0]] * 7)).reshape(7, -1).T
    rows = rows_of(fx.Pose(machine.home.position[None], machine.home.matrix[None]))
    designs = Ensemble(machine, straying).designs(corners)
    every = _core.sweep_designs(designs, _core.Joint.universal, rows, False, 1, 1)[:, 0, 0]
    assert found.worst <= every.min() * (1 + 1e-9)


def test_values_are_in_the_units_of_their_keys_and_what_was_assumed_is_told():
    machine = plain_machine("motion-base")
    payload = fx.optimisation.Payload((0, 500), (0.0, (-0.5, 0.5), 1.2))
    straying = [
        fx.Uncertain("platform.mass_t", 0.5, "normal", relative=False),
        fx.Uncertain("legs.stiffness_N_per_um[2]", 0.1),
        fx.Uncertain("base.joints_mm", 2, relative=False),
        payload,
    ]
    found = fx.robustness(machine, straying, samples=64, seed=5)
    assert found.worst_at["platform.mass_t"] == pytest.approx(6.0)
    assert found.worst_at["legs.stiffness_N_per_um[2]"] == pytest.approx(7.2)
    assert abs(found.samples["platform.mass_t"].values.mean() - 4) < 0.5
    joint = found.ranges["base.joints_mm[3][1]"]
    assert (joint.words, joint.unit) == ("base.joints_mm, leg 4, y", "mm")
    assert joint[3:] == pytest.approx(1e3 * machine.base_joints[3, 1] + np.array([0, -2, 2]))
    assert found.ranges["legs.stiffness_N_per_um[2]"][:3] == ("legs.stiffness_N_per_um, leg 3", "N/um", "uniform")
    assert found.ranges["platform.mass_t"][:3] == ("platform.mass_t", "t", "normal")
    assert [name for name in found.ranges if name.startswith("payload")] == [f"payload.{p}" for p in ("mass", *"xyz")]
    assert found.ranges["payload.mass"][1:3] == ("kg", "uniform")
    assert found.ranges["payload.z"][2::2][0] == "fixed"
    assert found.samples.attrs["seed"] == 5
    again = machine.replace({name: value for name, value in found.worst_at.items() if name.startswith("platform")})
    assert again.platform_mass == pytest.approx(6000)


def test_poses_beyond_the_limits_do_not_count_unless_all_are_asked_for(result, run, tmp_path):
    """The least of a sweep over the same poses, whose legs are softer by a fifth at the worst."""
    machine = plain_machine("motion-base")
    workspace = fx.Workspace.about_home(0.3, np.radians(15))
    soft = fx.Uncertain("legs.stiffness", 0.2, each=False)
    swept = fx.sweep(machine, workspace.rows(np.concatenate([machine.home.position, machine.home.rpy]), 300, 0))
    kept = swept.within_limits.values.astype(bool)
    assert 0 < kept.sum() < kept.size
    least = {}
    for everywhere, counted in ((False, kept), (True, np.ones_like(kept))):
        found = fx.robustness(machine, soft, workspace, samples=8, pose_samples=300, all_poses=everywhere)
        least[everywhere] = swept.omega_1.values[counted].min()
        assert found.nominal == pytest.approx(least[everywhere], rel=1e-12)
        assert found.worst == pytest.approx(least[everywhere] * 0.8**0.5, rel=1e-9)
        assert found.samples.attrs["poses"] == counted.sum()
        assert found.samples.attrs["poses_beyond_limits"] == (~counted).sum()
    assert least[True] < least[False]
    with pytest.raises(fx.PoseError, match=r"none of the 1 poses is within the design's limits.*--all-poses"):
        fx.robustness(machine, soft, [0, 0, 3.6, 0, 0, 0], samples=8)
    given = (
        "robust",
        file("motion-base"),
        "--uncertain",
        "legs.stiffness=20%,together",
        "--around",
        "0.3",
        "15",
        "--samples",
        "8",
    )
    given += ("--sensitivity", "0", "--poses", "300")
    assert result(*given)["nominal_rad_s"] == pytest.approx(least[False], rel=1e-9)
    assert result(*given, "--all-poses")["nominal_rad_s"] == pytest.approx(least[True], rel=1e-9)
    assert "beyond them left out" in " ".join(run(*given, "--out", tmp_path)[1].split())


@pytest.mark.filterwarnings("error")
def test_what_the_index_does_not_depend_on_has_no_share(result):
    line = ["robust", "mukherjee-ii", "--samples", 64, "--sensitivity", 16, "--uncertain", "legs.damping.prismatic=10%"]
    found = result(*line)
    assert set(found["sobol_total"].values()) == {0.0}
    assert found["warnings"][0] == "The index does not depend on what is uncertain here: legs.damping.prismatic."
    some = result(*line, "--uncertain", "legs.stiffness=1e-6%,together")  # little, and much more than rounding
    assert not any("does not depend" in text for text in some["warnings"])
    shares = some["sobol_total"]
    assert shares.pop("legs.stiffness") > 0.5  # of few samples
    assert max(shares.values()) < 1e-9
