"""Bounds proved by `fx.certify`: against samples and descents, over every kind of region, with every option."""

import time
from dataclasses import replace

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.certificates import largest
from flexapod.certificates.question import place_of, rotated
from flexapod.report.studies.certificate import study
from flexapod.workspace import proof
from flexapod.workspace.proof import Boxes, six_of

BASE, CUBIC, II, I = (plain_machine(name) for name in ("motion-base", "cubic-isolator", "mukherjee-ii", "mukherjee-i"))
HOME = fx.home_pose(BASE)
SMALL = fx.Box.about(HOME, 0.05, np.radians(2))


def around(design, share, degrees):
    """The box about home of so many per cent of the mean leg length and so many degrees."""
    home = fx.home_pose(design)
    length = float(np.mean(fx.inverse_kinematics(design, home)))
    return fx.Box.about(home, share / 100 * length, np.radians(degrees))


def least(design, box, samples=20_000, joint="universal", **options):
    found = fx.sweep(design, fx.random_poses(box, samples, seed=3, **options), quantities="omega_1", joint=joint)
    return float(found.omega_1.min())


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize("design", [BASE, CUBIC, II, I], ids=lambda design: design.name)
def test_the_bound_is_below_every_sample_and_close_to_a_pose(design, joint):
    box = around(design, 1, 1)
    found = fx.certify(design, box, joint=joint)
    assert found.status == "proved"
    assert found.proved
    assert found.lower <= least(design, box, joint=joint)
    assert found.lower == pytest.approx(0.99 * found.upper, rel=1e-12)
    assert found.upper == pytest.approx(float(fx.stability_index(design, found.pose, joint=joint)), rel=1e-9)
    assert ((box.low <= found.pose) & (found.pose <= box.high)).all()
    assert len(found.left) == 0
    assert found.share_left == 0


def test_the_known_least_of_the_motion_base_is_found_at_a_corner_and_proved():
    box = around(BASE, 5, 5)
    worst = fx.worst_pose(BASE, box, certified=True)
    assert worst.omega_1 == pytest.approx(26.769419, rel=1e-7)  # not 26.773138, the local minimum beside it
    middle = (box.low + box.high) / 2
    assert np.sign(worst.pose - middle).tolist() in ([-1, 1, 1, -1, -1, -1], [-1, -1, 1, 1, -1, 1])
    assert 0.99 * worst.omega_1 <= worst.proved * (1 + 1e-12) < worst.omega_1
    assert np.isnan(fx.worst_pose(BASE, SMALL, samples=64).proved)
    with pytest.raises(fx.ArgumentError, match="certified is for a box"):
        fx.worst_pose(BASE, HOME, certified=True)


def test_a_bound_is_proved_below_the_least_index_and_never_above():
    upper = fx.certify(BASE, SMALL).upper
    assert fx.certify(BASE, SMALL, at_least=0.9999 * upper).status == "proved"
    above = fx.certify(BASE, SMALL, at_least=upper * (1 + 1e-6))
    assert above.status == "refuted"
    assert above.upper < above.wanted
    assert above.lower == 0
    far = fx.certify(BASE, SMALL, at_least=1e9)  # above what any pose has
    assert far.status == "refuted"


def test_a_region_with_a_singular_pose_is_refuted_with_the_pose():
    box = around(I, 10, 20)
    found = fx.certify(I, box)
    assert (found.status, found.lower) == ("refuted", 0.0)
    assert found.upper < 1e-6
    assert "refuted" in found.words
    regular = fx.certify_regular(I, box, time_limit=60)
    assert regular.status == "refuted"
    assert float(fx.condition_number(I, regular.pose)) > 1e6
    assert ((box.low <= regular.pose) & (regular.pose <= box.high)).all()
    assert fx.certify_regular(I, around(I, 1, 1)).status == "proved"


def test_the_page_says_where_a_bound_is_reached_to_rounding():
    found = fx.certify(BASE, SMALL)
    assert found.stuck is None
    middle = (SMALL.low + SMALL.high) / 2
    tiny = np.stack([middle, middle + 1e-9], axis=-1)[None]
    open_ = replace(found, status="undecided", left=np.concatenate([found.place.parts, tiny]), share_left=0.1)
    assert open_.stuck == pytest.approx(middle, abs=1e-8)
    (caution,) = (one for one in study(open_).cautions if one.code == "undecided")
    assert "more time decides nothing there" in caution.text
    wide = replace(open_, left=found.place.parts)
    assert wide.stuck is None
    (caution,) = (one for one in study(wide).cautions if one.code == "undecided")
    assert "Go on with --resume" in caution.text


def test_several_boxes_are_proved_together():
    boxes = [SMALL, fx.Box.about(HOME, 0.02, np.radians(3)), fx.Workspace.about_home(0.06, 0.01)]
    found = fx.certify(BASE, boxes)
    assert found.lower == pytest.approx(0.99 * found.upper)
    assert found.upper == pytest.approx(min(fx.certify(BASE, box).upper for box in boxes), rel=1e-9)
    assert [box.free for box in found.region] == [("x", "y", "z", "roll", "pitch", "yaw")] * 3


def test_boxes_of_some_coordinates_and_single_poses():
    line = fx.Box(z=(2.3, 2.5), yaw=0.1)
    found = fx.certify(BASE, line)
    assert found.proved
    assert found.lower <= least(BASE, line, 2000)
    one = fx.certify(BASE)
    assert one.upper == pytest.approx(float(fx.stability_index(BASE, HOME)))
    assert "at the pose: proved" in one.words
    rows = fx.random_poses(SMALL, 5).rows(0, 5)
    several = fx.certify(BASE, rows, gap=1e-6)
    assert several.proved
    assert several.upper == pytest.approx(float(fx.stability_index(BASE, fx.Pose.from_rpy(*rows.T)).min()))


@pytest.mark.parametrize("ends", ["rest", "free", "periodic"])
def test_a_path_is_proved_as_it_is_run(ends):
    rows = [[0, 0, 2.4, 0, 0, 0], [0.2, 0.1, 2.45, 0.2, 0, 0.3], [0.1, -0.2, 2.3, 0, 0.25, -0.2], [0, 0, 2.4, 0, 0, 0]]
    path = fx.Trajectory(rows, [0, 1, 2.5, 3], ends=ends)
    pieces, middle, spans = path.polynomials()
    assert (spans[:, 2] - spans[:, 1]).sum() == pytest.approx(3)
    at = np.cumsum([0, *spans[:, 2]])[:-1, None] + spans[:, 2:] * np.linspace(0, 1, 7)
    for number, times in enumerate(at):
        six = [np.polynomial.polynomial.polyval(times - times[0], one) for one in pieces[number]]
        run = path(np.clip(times, 0, 3)).pose
        assert np.allclose(rotated(np.stack(six, axis=-1), middle), run.packed, atol=1e-12)
    found = fx.certify(BASE, path)
    assert found.proved
    assert found.on_path
    assert found.region == []
    exact = fx.path_index(BASE, path).minimum
    assert 0.99 * exact * (1 - 1e-4) < found.lower < exact
    assert fx.certify(BASE, path, at_least=exact * (1 + 1e-6)).status == "refuted"
    assert fx.certify(BASE, path, at_least=exact * (1 - 1e-4)).status == "proved"
    assert fx.certify_regular(BASE, path).proved
    assert fx.certify_limits(BASE, path).status in ("proved", "refuted")


def test_uncertain_numbers_are_proved_at_their_worst():
    stiffness, mass = fx.Uncertain("legs.stiffness", 0.1), fx.Uncertain("platform.mass", 0.05)
    payload = fx.optimisation.Payload((0, 200), (0, 0, 0.8))
    found = fx.certify(BASE, SMALL, uncertain=[stiffness, mass, payload])
    assert found.proved
    assert found.nominal == BASE.digest != found.hexapod.digest
    assert found.assumed == (
        "legs.stiffness +-10 % (uniform)",
        "platform.mass +-5 % (uniform)",
        "a payload of 0 to 200 kg at (0, 0, 0.8) m",
    )
    rng = np.random.default_rng(2)
    poses = fx.random_poses(SMALL, 200)
    for _ in range(50):
        design = BASE.replace(
            {
                "legs.stiffness": BASE.legs.stiffness * rng.uniform(0.9, 1.1, 6),
                "platform.mass": BASE.platform_mass * rng.uniform(0.95, 1.05),
            }
        )
        loaded = fx.optimisation.Payload((0, rng.uniform(0, 200)), (0, 0, 0.8)).at_worst(design)
        assert float(fx.sweep(loaded, poses, quantities="omega_1").omega_1.min()) >= found.lower
    assert found.upper < 0.96 * fx.certify(BASE, SMALL).upper


def test_uncertain_numbers_without_a_worst_end_are_refused():
    for wrong in (
        fx.Uncertain("legs.upper.mass_center[0][0]", 0.01),
        fx.Uncertain("platform.inertia[0][1]", 1.0, relative=False),
    ):
        with pytest.raises(fx.ArgumentError, match="neither rises nor falls"):
            fx.certify(BASE, SMALL, uncertain=wrong)
    with pytest.raises(fx.ArgumentError, match=r"give fx\.Uncertain"):
        fx.certify(BASE, SMALL, uncertain=[0.1])


@pytest.mark.parametrize(
    "target", ["platform.inertia[1][1]", "legs.lower.mass", "legs.upper.mass", "legs.lower.inertia[:][2][2]"]
)
def test_masses_and_moments_of_inertia_lower_the_index_of_every_pose(target):
    poses = fx.random_poses(around(II, 10, 10), 300)
    before = fx.sweep(II, poses, quantities="omega_1").omega_1
    after = fx.sweep(fx.Uncertain(target, 0.2).at_worst(II), poses, quantities="omega_1").omega_1
    assert (after <= before * (1 + 1e-12)).all()
    assert (after < before * (1 - 1e-9)).any()


def test_gravity_and_damping_are_not_in_the_index():
    heavy = fx.Uncertain("gravity[2]", 0.5)
    assert fx.certify(BASE, SMALL, uncertain=heavy).upper == pytest.approx(fx.certify(BASE, SMALL).upper)
    assert fx.certify(BASE.replace({"gravity": [0, 0, 0]}), SMALL).lower == fx.certify(BASE, SMALL).lower


def test_only_poses_within_the_limits_count_where_that_is_asked():
    box = fx.Box(x=(-0.1, 0.1), z=(2.2, 3.6), pitch=(-0.1, 0.1))
    inside, everywhere = fx.certify(BASE, box, within_limits=True, gap=0.05), fx.certify(BASE, box, gap=0.05)
    assert inside.proved
    assert everywhere.proved
    assert inside.lower > everywhere.lower
    assert 0 < inside.share_outside < 1
    assert everywhere.share_outside == 0
    assert fx.check_limits(BASE, inside.pose).ok
    found = fx.sweep(BASE, fx.random_poses(box, 20_000))
    assert inside.lower <= float(found.omega_1.where(found.within_limits).min())
    with pytest.raises(fx.ArgumentError, match="has no limits"):
        fx.certify(II, around(II, 1, 1), within_limits=True)
    with pytest.raises(fx.PoseError, match="within the limits"):
        fx.certify(BASE, fx.Box(z=(3.5, 3.6)), within_limits=True)


def test_limits_are_proved_or_the_one_that_is_broken_is_named():
    assert fx.certify_limits(BASE, SMALL).proved
    found = fx.certify_limits(BASE, fx.Box(z=(2.4, 3.2)))
    assert found.status == "refuted"
    assert found.broken.startswith("length of leg")
    assert found.broken in found.words
    assert not fx.check_limits(BASE, found.pose).ok
    narrow = BASE.replace({"limits.spherical_angle": 0.01})
    assert "spherical joint" in fx.certify_limits(narrow, SMALL).broken


def test_the_condition_number_is_bounded():
    found = fx.certify_condition_number(BASE, SMALL)
    greatest = float(fx.sweep(BASE, fx.random_poses(SMALL, 20_000)).cond_H.max())
    assert found.proved
    assert greatest <= found.upper <= 1.0101 * found.lower
    assert fx.certify_condition_number(BASE, SMALL, at_most=found.lower * 1.001).proved
    below = fx.certify_condition_number(BASE, SMALL, at_most=greatest * (1 - 1e-3))
    assert below.status == "refuted"
    assert below.lower > below.wanted
    assert float(fx.condition_number(BASE, below.pose)) == pytest.approx(below.lower)


def test_the_largest_box_of_a_shape():
    shape = fx.Workspace.about_home(0.05, 0.05)
    found = fx.certified_box(BASE, shape, 27.0, tolerance=0.05)
    assert found.certificate.proved
    assert 0.95 * found.refuted <= found.scale < found.refuted
    assert float(fx.stability_index(BASE, found.pose)) < 27.0
    assert found.box.high[0] == pytest.approx(0.05 * found.scale)
    assert least(BASE, found.box) >= 27.0
    with pytest.raises(fx.ArgumentError, match="the middle of the box has an index of 28"):
        fx.certified_box(BASE, shape, 29.0)
    flat = fx.certified_box(BASE, fx.Box(x=(-0.01, 0.01), z=2.39), 26.5, tolerance=0.1, time_limit=60)
    assert flat.box.free == ("x",)
    assert flat.certificate.proved
    assert flat.scale >= 0.9 * flat.refuted


def test_without_a_limit_of_time_a_size_is_given_up_after_some_work(monkeypatch):
    """Near a singular pose a proof may need more than anyone waits for."""
    monkeypatch.setattr(proof, "TURN", 0.05)
    monkeypatch.setattr(largest, "MOST_BOXES", 100)
    design, shape = fx.load("mukherjee-ii"), fx.Workspace.about_home(0.01, 0.01)
    bound = 0.7 * float(fx.stability_index(design))
    found = fx.certified_box(design, shape, bound, tolerance=0.3)
    assert found.certificate.proved
    assert found.scale < found.given_up < found.refuted
    told = study(found.certificate, largest=found)
    assert told.data["given_up_scale"] == found.given_up
    assert next(caution.code for caution in told.cautions) == "given_up"


def test_the_bound_that_only_the_middle_has_ends_the_search(monkeypatch):
    monkeypatch.setattr(proof, "TURN", 0.05)
    monkeypatch.setattr(largest, "MOST_BOXES", 10)
    bound = float(fx.stability_index(BASE))
    with pytest.raises(fx.ArgumentError, match=r"no box .* to keep 28.05\d+ rad/s; its middle has 28.05"):
        fx.certified_box(BASE, fx.Workspace.about_home(0.05, 0.05), bound)


@pytest.mark.parametrize("tolerance", [5e-324, 0.0, -1.0, 1.0, 2.0])
def test_a_tolerance_of_the_largest_box_that_no_search_reaches_is_told(tolerance):
    with pytest.raises(fx.ArgumentError, match=r"tolerance is .*; it must be at least 1e-09 and less than 1"):
        fx.certified_box(BASE, fx.Workspace.about_home(0.05, 0.05), 26.0, tolerance=tolerance)


def test_a_box_through_the_pole_of_pitch_is_a_set_of_poses_as_any():
    start = fx.Pose.from_rpy(0, 0, 0, 0, np.radians(89.9), 0).matrix
    turned = BASE.replace({"platform.joints": BASE.platform_joints @ start, "home": None})
    turned = turned.replace({"platform.mass_center": BASE.platform_mass_center @ start})
    turned = turned.replace({"platform.inertia": start.T @ BASE.platform_inertia @ start})
    box = fx.Box(z=(2.38, 2.42), pitch=np.radians((89.0, 91.0)), roll=(-0.02, 0.02))
    found = fx.certify(turned, box)
    assert found.proved
    assert found.lower <= least(turned, box, 5000)


def test_six_numbers_of_a_pose_lie_in_its_box():
    boxes = np.array([[[0, 1], [0, 1], [0, 1], [3.0, 3.4], [1.4, 1.8], [-7.0, -6.0]]], dtype=float)
    six = np.array([0.5, 0.5, 0.5, 3.2, 1.7, -6.5])
    assert np.allclose(six_of(fx.Pose.from_rpy(*six).packed, boxes), six, atol=1e-12)


def test_a_time_limit_gives_the_best_bound_so_far():
    began = time.monotonic()
    found = fx.certify(II, around(II, 12, 12), gap=1e-4, time_limit=1.0)
    assert time.monotonic() - began < 60
    assert found.status == "undecided"
    assert 0 < found.share_left <= 1
    assert len(found.left) > 0
    assert found.upper > 0
    assert found.lower < found.upper
    assert "% of it is left" in found.words


def test_progress_rises_to_one_and_stop_ends():
    shares = []
    assert fx.certify(BASE, around(BASE, 5, 5), progress=shares.append).proved
    assert shares[-1] == 1
    assert all(0 <= share <= 1 for share in shares)
    stopped = fx.certify(II, around(II, 10, 10), stop=lambda: True)
    assert stopped.status == "undecided"
    assert stopped.share_left == 1


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"at_least": 0.0}, "at_least is 0"),
        ({"at_least": np.nan}, "at_least is nan"),
        ({"gap": 0.0}, "gap is 0"),
        ({"gap": 1.5}, "gap is 1.5"),
        ({"time_limit": -1}, "time_limit is -1"),
        ({"joint": "Universal"}, "joint is 'Universal'"),
        ({"resume": True}, "no path is given"),
        ({"threads": 0}, "threads is 0"),
    ],
)
def test_wrong_arguments_are_told(given, match):
    with pytest.raises(fx.ArgumentError, match=match):
        fx.certify(BASE, SMALL, **given)


def test_wrong_regions_are_told():
    with pytest.raises(fx.ArgumentError, match="angles in rad"):
        fx.certify(BASE, fx.Box(z=(2.3, 2.4), yaw=(-180, 180)))
    with pytest.raises(fx.PoseError, match="region is"):
        fx.certify(BASE, "home")
    with pytest.raises(fx.PoseError, match="names no home pose"):
        fx.certify(BASE.replace({"home": None}))
    assert isinstance(place_of(BASE, SMALL), Boxes)
