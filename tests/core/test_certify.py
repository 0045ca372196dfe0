"""Certificates of the core against samples, corners, sweeps and 50-digit arithmetic: nothing that is proved may be false."""

import itertools
import os
import subprocess
import sys

import numpy as np
import pytest
from scipy.interpolate import BSpline, PPoly
from scipy.optimize import brentq, minimize
from tests.helpers.drawn import machine, sprung, with_law
from tests.helpers.plain import plain_machine
from tests.helpers.support import JOINTS, size
from tests.oracles.exact_modes import exact_modes

import flexapod as fx
from flexapod import _core
from flexapod.mechanics.joint_limits import neutral_directions
from flexapod.workspace.quantities import kernel_limits

INDEX, REGULAR, CONDITION, LIMITS = _core.CertificateKind
PROVED, REFUTED, UNDECIDED = _core.CertificateStatus
UNIVERSAL = _core.Joint.universal


@pytest.fixture
def rng():
    return np.random.default_rng(15)


def options(**given):
    made = _core.CertificateOptions()
    for name, value in given.items():
        setattr(made, name, value)
    return made


def around(hexapod, share: float, angle: float) -> np.ndarray:
    """The box (1, 6, 2) about home: half a side is a share of the legs' mean length, or an angle in degrees."""
    home = fx.home_pose(hexapod)
    half = np.r_[3 * [share * fx.inverse_kinematics(hexapod, home).mean()], 3 * [np.radians(angle)]]
    middle = np.r_[home.position, home.rpy]
    return np.stack([middle - half, middle + half], axis=-1)[None]


def certify(hexapod, boxes, kind, level=np.nan, progress=None, joint=UNIVERSAL, **given):
    return _core.certify(hexapod.packed, joint, np.ascontiguousarray(boxes), kind, level, options(**given), progress)


def samples(boxes, n: int, rng) -> np.ndarray:
    """Poses of boxes: n in each, the corners among them."""
    share = np.concatenate([rng.random((n, 6)), list(itertools.product((0.0, 1.0), repeat=6))])[-n:]
    low, high = boxes[:, None, :, 0], boxes[:, None, :, 1]
    return np.ascontiguousarray((low * (1 - share) + high * share).reshape(-1, 6))


def swept(hexapod, poses, quantity="omega_1", joint=UNIVERSAL, limits=None) -> np.ndarray:
    asked = _core.SweepQuantity[quantity]
    return _core.sweep(hexapod.packed, joint, np.ascontiguousarray(poses), asked, limits or _core.SweepLimits(), 1)[
        quantity
    ]


def least(hexapod, box, rng, joint=UNIVERSAL) -> tuple[float, np.ndarray]:
    """The least omega_1 of a box that samples, corners and descents find, and where."""
    poses = samples(box, 2000, rng)
    omega = np.nan_to_num(swept(hexapod, poses, joint=joint))
    low, side = box[0, :, 0], box[0, :, 1] - box[0, :, 0]
    found = (omega.min(), poses[omega.argmin()])
    for start in poses[np.argsort(omega)[:2]]:
        descent = minimize(
            lambda share: np.nan_to_num(swept(hexapod, (low + share * side)[None], joint=joint)[0]),
            (start - low) / side,
            bounds=[(0, 1)] * 6,
        )
        found = min(found, (float(descent.fun), low + descent.x * side), key=lambda each: each[0])
    return found


def volume(boxes) -> float:
    return float(np.prod(boxes[..., 1] - boxes[..., 0], axis=-1).sum())


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("name", ["motion-base", "cubic-isolator", "mukherjee-ii"])
def test_a_gap_of_one_per_cent_is_closed_and_nothing_lies_below(name, joint, rng):
    hexapod, model = plain_machine(name), _core.Joint[joint]
    box = around(hexapod, 0.03, 3)
    true, where = least(hexapod, box, rng, model)
    found = certify(hexapod, box, INDEX, true, gap=0.01, joint=model)
    assert found.status == PROVED
    assert found.level == pytest.approx(0.99 * true, rel=1e-9)
    assert len(found.remaining) == 0
    assert found.proved == pytest.approx(1.0, abs=1e-9)
    assert swept(hexapod, samples(box, 20000, rng), joint=model).min() > found.level
    assert exact_modes(hexapod, where, joint == "universal").omega[0] > found.level


@pytest.mark.parametrize("name", ["motion-base", "cubic-isolator"])
def test_a_target_above_the_true_least_is_never_proved(name, rng):
    hexapod = plain_machine(name)
    box = around(hexapod, 0.05, 5)
    true, _ = least(hexapod, box, rng)
    for factor in (1 + 1e-6, 1 + 1e-3):
        found = certify(hexapod, box, INDEX, true * factor, max_boxes=20000)
        assert found.status != PROVED
        assert len(found.remaining) > 0
    refuted = certify(hexapod, box, INDEX, true * 1.02)
    assert refuted.status == REFUTED
    assert refuted.value < true * 1.02
    assert swept(hexapod, refuted.at[None])[0] == pytest.approx(refuted.value, rel=1e-12)
    pose = fx.Pose(refuted.at[:3], refuted.at[3:].reshape(3, 3))
    assert fx.stability_index(hexapod, pose) == pytest.approx(refuted.value, rel=1e-11)


def test_what_is_proved_and_what_remains_make_up_the_box(rng):
    hexapod = fx.load("mukherjee-ii")
    box = around(hexapod, 0.05, 5)
    true, _ = least(hexapod, box, rng)
    part = certify(hexapod, box, INDEX, 0.99 * true, max_boxes=1500)
    assert part.status == UNDECIDED
    assert part.boxes >= 1500
    assert volume(part.remaining) / volume(box) == pytest.approx(1 - part.proved, abs=1e-9)
    assert 0.05 < part.proved < 0.95
    rest = certify(hexapod, part.remaining, INDEX, 0.99 * true)
    assert rest.status == PROVED
    # Poses of the box that lie in no box that remained were proved: none of them is below.
    poses = samples(box, 20000, rng)
    inside = np.zeros(len(poses), bool)
    for low, high in np.moveaxis(part.remaining, -1, 1):
        inside |= ((poses >= low) & (poses <= high)).all(axis=1)
    assert inside.mean() == pytest.approx(1 - part.proved, abs=0.02)
    assert swept(hexapod, poses[~inside]).min() > 0.99 * true


def drawn(seed: int, rng) -> fx.Hexapod:
    """A machine, every other one with springs in its joints and beside its legs, or a law of their stiffness."""
    hexapod = machine(seed)
    if rng.random() < 0.5:
        hexapod = sprung(hexapod, rng, suspension=rng.random() < 0.5)
    return with_law(hexapod, rng) if rng.random() < 0.4 else hexapod


SEEDS = os.environ.get("FLEXAPOD_CERTIFY_SEEDS")  # of `make contradictions`


@pytest.mark.parametrize("seed", range(int(SEEDS or 16)))
def test_drawn_machines_and_boxes_give_no_contradiction(seed):
    contradiction_free(seed, 40000 if SEEDS else 2000)


def contradiction_free(seed: int, count: int = 2000) -> str:
    """A drawn machine, box and gap: what is proved against samples, corners and descents. The status in words."""
    rng = np.random.default_rng(1000 + seed)
    hexapod, model = drawn(seed, rng), _core.Joint[JOINTS[seed % 2]]
    middle = around(hexapod, 0, 0)[0, :, 0] + np.r_[0.05 * size(hexapod) * rng.normal(size=3), 0.1 * rng.normal(size=3)]
    half = 10.0 ** rng.uniform(-2.5, -0.8) * np.r_[size(hexapod) * rng.random(3), rng.random(3)]
    box = np.stack([middle - half, middle + half], axis=-1)[None]
    poses = samples(box, count, rng)
    omega = swept(hexapod, poses, joint=model)
    if np.isnan(omega).any():  # beyond the law's range
        assert certify(hexapod, box, INDEX, 1e-3, joint=model, max_boxes=2000).status != PROVED
        return "beyond"
    found = certify(hexapod, box, INDEX, omega.min(), gap=float(rng.choice([0.01, 0.05, 0.2])), joint=model, seconds=10)
    if found.status == PROVED:
        assert omega.min() >= found.level
        assert least(hexapod, box, rng, model)[0] >= found.level
    sure = certify(hexapod, box, INDEX, omega.min() * (1 + 1e-6), joint=model, max_boxes=2000)
    assert sure.status != PROVED
    condition = swept(hexapod, poses, "cond_H").max()
    assert certify(hexapod, box, CONDITION, condition * (1 - 1e-6), max_boxes=500).status != PROVED
    return found.status.name


def test_boxes_with_singular_poses_are_never_proved():
    """Turned by 90 deg about z, a symmetric machine is singular; the sign of det H changes there."""
    hexapod = plain_machine("motion-base")
    box = around(hexapod, 0.01, 1)
    box[0, 5] = np.radians([60, 120])
    mid = box.mean(axis=-1)
    turns = np.repeat(mid, 61, axis=0)
    turns[:, 5] = np.radians(np.linspace(60, 120, 61))
    signs = np.sign([np.linalg.det(fx.force_transformation(hexapod, pose)) for pose in turns])
    assert {-1.0, 1.0} <= set(signs), "the box has singular poses"
    for kind, level in ((REGULAR, np.nan), (INDEX, 1e-3), (CONDITION, 1e6)):
        found = certify(hexapod, box, kind, level, max_boxes=3000)
        assert found.status == REFUTED
        at = fx.Pose(found.at[:3], found.at[3:].reshape(3, 3))
        assert fx.condition_number(hexapod, at) > (1e8 if kind == REGULAR else 1e4)
    with_gap = certify(hexapod, box, INDEX, np.inf, gap=0.01, max_boxes=3000)
    assert with_gap.status != PROVED


def test_no_pose_is_singular_where_none_is():
    found = certify(plain_machine("motion-base"), around(plain_machine("motion-base"), 0.1, 10), REGULAR)
    assert found.status == PROVED
    assert found.boxes < 1000


@pytest.mark.parametrize("name", ["motion-base", "mukherjee-ii"])
def test_the_condition_of_h(name, rng):
    hexapod = plain_machine(name)
    box = around(hexapod, 0.01, 1)
    greatest = swept(hexapod, samples(box, 5000, rng), "cond_H").max()
    assert certify(hexapod, box, CONDITION, 1.02 * greatest).status == PROVED
    assert certify(hexapod, box, CONDITION, greatest * (1 - 1e-9), max_boxes=3000).status != PROVED
    with_gap = certify(hexapod, box, CONDITION, greatest, gap=0.02)
    assert with_gap.status == PROVED
    assert with_gap.level >= greatest
    refuted = certify(hexapod, box, CONDITION, 0.98 * greatest)
    assert refuted.status == REFUTED
    assert swept(hexapod, refuted.at[None], "cond_H")[0] > 0.98 * greatest


SPRUNG = {
    "joints": lambda rng: sprung(plain_machine("cubic-isolator"), rng, suspension=False),
    "suspension": lambda rng: sprung(plain_machine("motion-base"), rng),
    "screw": lambda rng: with_law(plain_machine("motion-base"), rng, "screw"),
    "hydraulic": lambda rng: with_law(sprung(plain_machine("motion-base"), rng), rng, "hydraulic"),
    "table": lambda rng: with_law(plain_machine("mukherjee-ii"), rng, "table"),
}


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("kind", SPRUNG)
def test_springs_beside_the_legs_and_laws_are_in_the_proof(kind, joint, rng):
    hexapod, model = SPRUNG[kind](rng), _core.Joint[joint]
    box = around(hexapod, 0.03, 3)
    true, where = least(hexapod, box, rng, model)
    found = certify(hexapod, box, INDEX, true, gap=0.01, joint=model)
    assert found.status == PROVED
    assert found.level == pytest.approx(0.99 * true, rel=1e-9)
    assert swept(hexapod, samples(box, 20000, rng), joint=model).min() > found.level
    assert certify(hexapod, box, INDEX, true * (1 + 1e-6), joint=model, max_boxes=5000).status != PROVED
    refuted = certify(hexapod, box, INDEX, true * 1.02, joint=model)
    assert refuted.status == REFUTED
    assert swept(hexapod, refuted.at[None], joint=model)[0] == pytest.approx(refuted.value, rel=1e-9)
    if hexapod.legs.stiffness_law is None:
        assert exact_modes(hexapod, where, joint == "universal").omega[0] > found.level


def test_springs_hold_the_platform_at_a_singular_pose(rng):
    hexapod = sprung(plain_machine("motion-base"), rng)
    box = around(hexapod, 0.002, 0.2)
    box[0, 5] = np.radians([89, 91])
    assert certify(hexapod, box, REGULAR, max_boxes=3000).status == REFUTED
    true = swept(hexapod, samples(box, 5000, rng)).min()
    found = certify(hexapod, box, INDEX, true, gap=0.05)
    assert found.status == PROVED
    assert found.level > 1.0


@pytest.mark.parametrize("kind", ["screw", "hydraulic", "table"])
def test_a_pose_beyond_the_range_of_a_law_refutes_a_bound_or_does_not_count(kind, rng):
    hexapod = with_law(plain_machine("motion-base").replace({"limits": None}), rng, kind)
    box = around(hexapod, 0.0, 0.0)
    lengths = fx.inverse_kinematics(hexapod, box[0, :, 0])
    narrow = {
        "screw": {"zero_length": 0.95 * lengths},
        "hydraulic": {"shortest": 0.95 * lengths, "stroke": 0.3 * lengths},
        "table": {"lengths": lengths.mean() * np.linspace(0.95, 1.2, 20)},
    }[kind]
    hexapod = hexapod.replace({f"legs.stiffness_law.{name}": value for name, value in narrow.items()})
    law = hexapod.legs.stiffness_law
    box[0, 2] += [-0.1 * lengths.mean(), 0.02]
    box[0, 4] = [0.0, 0.05]
    beyond = certify(hexapod, box, INDEX, 1e-3)
    assert (beyond.status, beyond.broken) == (REFUTED, 6)
    assert np.isnan(beyond.value)
    assert np.isnan(swept(hexapod, beyond.at[None])[0])
    at = fx.Pose(beyond.at[:3], beyond.at[3:].reshape(3, 3))
    length = fx.inverse_kinematics(hexapod, at)[beyond.leg]
    assert not law.range[beyond.leg, 0] <= length <= law.range[beyond.leg, 1]
    with_gap = certify(hexapod, box, INDEX, 1e3, gap=0.1)
    assert (with_gap.status, with_gap.broken) == (REFUTED, 6)
    limits = kernel_limits(hexapod)
    poses = samples(box, 20000, rng)
    within = swept(hexapod, poses, "within_limits", limits=limits)
    omega = swept(hexapod, poses)
    assert 0.1 < within.mean() < 0.9
    found = certify(hexapod, box, INDEX, omega[within].min(), gap=0.02, limits=limits)
    assert found.status == PROVED
    assert found.outside < 1 - within.mean() + 0.02
    assert found.level <= omega[within].min()
    # up to the very end of the range
    low = law.range[:, 0].max()
    line = around(hexapod, 0.0, 0.0)
    height = brentq(
        lambda z: fx.inverse_kinematics(hexapod, [*line[0, :2, 0], z, 0, 0, 0]).min() - low, 0.1, line[0, 2, 0]
    )
    line[0, 2] = [height, height + 0.1]
    assert certify(hexapod, line, INDEX, 1e-3).status == PROVED
    line[0, 2, 0] = height - 1e-6
    assert certify(hexapod, line, INDEX, 1e-3, max_boxes=5000).status != PROVED


def test_moments_of_springs_in_joints_are_limited(rng):
    hexapod = sprung(plain_machine("motion-base"), rng)
    box = around(hexapod, 0.03, 3)
    poses = samples(box, 20000, rng)
    free = limits_of(hexapod, poses, (0.1, 0.1))
    at = _core.sweep(hexapod.packed, UNIVERSAL, poses, _core.SweepQuantity.joint_moment, free, 1)
    most = [at[f"{name}_moment"].max() for name in ("universal", "spherical")]

    def limits(universal, spherical):
        return limits_of(hexapod, poses, (0.1, 0.1), moments=(universal * most[0], spherical * most[1]))

    assert certify(hexapod, box, LIMITS, limits=limits(1.02, 1.02), max_boxes=200000).status == PROVED
    for which, given in ((4, limits(0.97, 2.0)), (5, limits(2.0, 0.97))):
        found = certify(hexapod, box, LIMITS, limits=given, max_boxes=200000)
        assert (found.status, found.broken) == (REFUTED, which)
        assert not swept(hexapod, found.at[None], "within_limits", limits=given)[0]
    half = limits(0.7, 0.8)
    within = swept(hexapod, poses, "within_limits", limits=half)
    omega = swept(hexapod, poses)
    assert 0.02 < within.mean() < 0.98
    found = certify(hexapod, box, INDEX, 0.97 * omega[within].min(), limits=half, max_boxes=200000)
    assert found.status == PROVED
    assert found.outside < 1 - within.mean() + 0.02
    plain = plain_machine("motion-base")  # without springs there are no moments
    assert certify(plain, box, LIMITS, limits=limits(1e-9, 1e-9)).status == PROVED


def limits_of(
    hexapod, poses, length=(0.0, 0.0), universal=None, spherical=None, distance=None, moments=(np.inf, np.inf)
):
    """Limits that hold by so much of what sampled poses have."""
    free = _core.SweepLimits(
        neutral=neutral_directions(hexapod),
        leg_length=np.tile([-np.inf, np.inf], (6, 1)),
        universal_angle=np.inf,
        spherical_angle=np.inf,
        leg_distance=-np.inf,
        universal_moment=np.inf,
        spherical_moment=np.inf,
    )
    at = {name: swept(hexapod, poses, name, limits=free) for name in ("leg_length", "leg_distance")}
    angles = _core.sweep(hexapod.packed, UNIVERSAL, poses, _core.SweepQuantity.joint_angle, free, 1)
    lengths = np.stack([at["leg_length"].min(axis=0) * (1 - length[0]), at["leg_length"].max(axis=0) * (1 + length[1])])
    return _core.SweepLimits(
        neutral=neutral_directions(hexapod),
        leg_length=np.ascontiguousarray(lengths.T),
        universal_angle=np.inf if universal is None else angles["universal_angle"].max() * (1 + universal),
        spherical_angle=np.inf if spherical is None else angles["spherical_angle"].max() * (1 + spherical),
        leg_distance=-np.inf if distance is None else at["leg_distance"].min() * (1 - distance),
        universal_moment=moments[0],
        spherical_moment=moments[1],
    )


@pytest.mark.parametrize("name", ["motion-base", "mukherjee-i", "cubic-isolator"])
def test_limits_are_kept_in_the_whole_box_or_a_pose_breaks_one(name, rng):
    hexapod = plain_machine(name)
    box = around(hexapod, 0.04, 4)
    poses = samples(box, 20000, rng)
    kept = limits_of(hexapod, poses, (0.005, 0.005), 0.02, 0.02, 0.03)
    assert certify(hexapod, box, LIMITS, limits=kept, max_boxes=100000).status == PROVED
    wrong = {
        0: {"length": (-0.01, 0.01)},
        1: {"length": (0.1, 0.1), "universal": -0.05},
        2: {"length": (0.1, 0.1), "spherical": -0.05},
    }
    for which, given in wrong.items():
        limits = limits_of(hexapod, poses, **given)
        found = certify(hexapod, box, LIMITS, limits=limits, max_boxes=100000)
        assert found.status == REFUTED
        assert found.broken == which
        assert not swept(hexapod, found.at[None], "within_limits", limits=limits)[0]


def test_the_distance_of_legs_is_bounded(rng):
    hexapod = fx.load("mukherjee-ii")
    box = around(hexapod, 0.04, 4)
    poses = samples(box, 20000, rng)
    near = certify(hexapod, box, LIMITS, limits=limits_of(hexapod, poses, (0.1, 0.1), distance=-0.01), max_boxes=50000)
    assert near.status == REFUTED
    assert near.broken == 3
    free = limits_of(hexapod, poses, (0.1, 0.1))
    assert swept(hexapod, near.at[None], "leg_distance", limits=free)[0] < 1.01 * swept(
        hexapod, poses, "leg_distance", limits=free
    ).min() * (1 + 1e-9)


def test_boxes_outside_of_limits_are_left_out(rng):
    hexapod = plain_machine("motion-base")
    box = around(hexapod, 0.1, 10)
    poses = samples(box, 20000, rng)
    limits = limits_of(hexapod, poses, (-0.15, -0.15))
    within = swept(hexapod, poses, "within_limits", limits=limits)
    omega = swept(hexapod, poses)
    assert 0.01 < within.mean() < 0.9
    level = 0.97 * omega[within].min()
    assert level > omega.min(), "poses outside of the limits are below it"
    found = certify(hexapod, box, INDEX, level, limits=limits, max_boxes=200000)
    assert found.status == PROVED
    assert 0 < found.outside < 1 - within.mean() + 0.02
    assert found.proved + found.outside == pytest.approx(1.0, abs=1e-9)
    refuted = certify(hexapod, box, INDEX, 1.03 * omega[within].min(), limits=limits)
    assert refuted.status == REFUTED
    assert swept(hexapod, refuted.at[None], "within_limits", limits=limits)[0]


def path(hexapod, rng):
    """A trajectory, its pieces as the core takes them, and poses along it."""
    waypoints = (
        np.r_[fx.home_pose(hexapod).position, 0, 0, 0]
        + 0.08 * rng.uniform(-1, 1, (5, 6)) * np.r_[3 * [size(hexapod)], 1, 1, 1]
    )
    trajectory = fx.Trajectory(waypoints, np.arange(5.0))
    spline = trajectory._curve.splines[0]
    columns = [PPoly.from_spline(BSpline(spline.t, column, spline.k)) for column in spline.c.T]
    lengths = np.diff(columns[0].x)
    powers = np.stack([column.c[::-1, lengths > 0].T for column in columns], axis=1)
    spans = np.c_[np.arange(len(powers)), np.zeros(len(powers)), lengths[lengths > 0]]
    poses = trajectory(np.linspace(0, 4, 20001)).pose
    rows = np.concatenate([poses.position, poses.matrix.reshape(-1, 9)], axis=-1)
    return trajectory.chart.middle, np.ascontiguousarray(powers), spans, np.ascontiguousarray(rows)


@pytest.mark.parametrize("name", ["motion-base", "mukherjee-ii"])
def test_a_path_is_proved_by_pieces(name, rng):
    hexapod = plain_machine(name)
    middle, pieces, spans, rows = path(hexapod, rng)
    true = swept(hexapod, rows).min()

    def along(kind, level, **given):
        return _core.certify_path(hexapod.packed, UNIVERSAL, pieces, middle, spans, kind, level, options(**given), None)

    assert along(INDEX, true * (1 - 1e-5)).status == PROVED
    assert along(INDEX, true * (1 + 1e-6), max_boxes=10000).status != PROVED
    refuted = along(INDEX, true * 1.001)
    assert refuted.status == REFUTED
    assert swept(hexapod, refuted.at[None])[0] == pytest.approx(refuted.value, rel=1e-11)
    assert np.abs(rows - refuted.at).max(axis=1).min() < 1e-3, "the pose is on the path"
    few = along(INDEX, true, gap=0.01)
    assert few.status == PROVED
    assert few.boxes < 100
    part = along(INDEX, true * (1 - 1e-5), max_boxes=10)
    assert part.remaining.shape[1] == 3
    left = (part.remaining[:, 2] - part.remaining[:, 1]).sum() / (spans[:, 2] - spans[:, 1]).sum()
    assert left == pytest.approx(1 - part.proved, abs=1e-9)
    assert along(REGULAR, np.nan).status == PROVED


def test_another_splitting_and_more_threads_prove_the_same(rng):
    hexapod = plain_machine("cubic-isolator")
    box = around(hexapod, 0.05, 5)
    level = 0.99 * least(hexapod, box, rng)[0]
    found = [
        certify(hexapod, box, INDEX, level, cut=cut, threads=threads)
        for cut, threads in ((0.5, 1), (0.5, 3), (0.43, 1))
    ]
    assert [each.status for each in found] == 3 * [PROVED]
    assert found[0].boxes == found[1].boxes != found[2].boxes


def test_a_box_may_have_no_width_and_pass_through_a_pole():
    hexapod = plain_machine("motion-base")
    home = around(hexapod, 0.0, 0.0)
    point = certify(hexapod, home, INDEX, 0.999 * swept(hexapod, home[..., 0])[0])
    assert (point.status, point.boxes) == (PROVED, 1)
    pole = home.copy()
    pole[0, 4] += [np.radians(80), np.radians(100)]
    values = swept(hexapod, np.array([[*home[0, :4, 0], a, 0.0] for a in pole[0, 4, 0] + np.linspace(0, 0.349, 200)]))
    found = certify(hexapod, pole, INDEX, values.min(), gap=0.01, max_boxes=50000)
    assert found.status == PROVED or values.min() < 1e-6


def test_calls_end_on_time_and_when_they_are_told_to():
    hexapod = fx.load("mukherjee-i")
    box = around(hexapod, 0.2, 20)
    timed = certify(hexapod, box, REGULAR, seconds=0.2)
    assert timed.status != PROVED
    assert timed.seconds < 5
    told = []

    def enough(share):
        told.append(share)
        return len(told) < 3

    stopped = certify(hexapod, box, REGULAR, progress=enough)
    assert stopped.status == UNDECIDED
    assert len(told) == 3
    assert np.all(np.diff(told) >= 0)

    def failing(share):
        raise KeyError("from inside")

    with pytest.raises(KeyError, match="from inside"):
        certify(hexapod, box, REGULAR, progress=failing)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"boxes": np.zeros((1, 5, 2))}, "boxes"),
        ({"boxes": np.full((1, 6, 2), np.nan)}, "finite"),
        ({"boxes": np.tile([1.0, 0.0], (1, 6, 1))}, "order"),
        ({"threads": 0}, "threads"),
        ({"cut": 0.9}, "cut"),
        ({"gap": 1.5}, "gap"),
        ({"kind": LIMITS}, "limits"),
    ],
)
def test_wrong_input_is_refused(change, words):
    hexapod = plain_machine("motion-base")
    given = {"boxes": around(hexapod, 0.01, 1), "kind": INDEX, "level": 1.0, **change}
    with pytest.raises(ValueError, match=words):
        certify(hexapod, **given)


def test_every_instruction_set_proves_it():
    code = (
        "import numpy as np, flexapod as fx; from flexapod import _core; from tests.core.test_certify import *\n"
        "h = fx.load('motion-base')\n"
        "print(certify(h, around(h, 0.03, 3), INDEX, 27.0).status.name, _core.simd())"
    )
    for simd in _core.simd_available():
        run = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "FLEXAPOD_SIMD": simd},
            capture_output=True,
            text=True,
            check=True,
        )
        assert run.stdout.split() == ["proved", simd]


@pytest.mark.parametrize("kind", ["constant", *SPRUNG])
def test_ball_arithmetic_proves_the_same(kind, rng):
    """A second implementation, of other equations, on a small box."""
    exact_bounds = pytest.importorskip("tests.oracles.exact_bounds", reason="python-flint is not installed")
    hexapod = plain_machine("motion-base") if kind == "constant" else SPRUNG[kind](rng)
    half = {"constant": 0.005, "table": 0.0002}.get(kind, 0.001)
    box = around(hexapod, half, 100 * half)
    found = certify(hexapod, box, INDEX, least(hexapod, box, rng)[0], gap=0.05)
    assert found.status == PROVED
    assert exact_bounds.proved(hexapod, box[0], found.level, most=5) is not None
    assert exact_bounds.proved(hexapod, box[0], found.level / 0.95 * 1.001, most=2) is None
