"""Limits that every design of a range of places keeps, or one of them breaks."""

import itertools

import numpy as np
import pytest
from tests.certificates.test_certify_strays import BASE, HOME, uncertain
from tests.helpers.drawn import sprung

import flexapod as fx
from flexapod.certificates import checking
from flexapod.design.strays import strayed
from flexapod.workspace.limit_margins import LimitMargins

REACH = 5e-4  # m
JOINTS = ("base.joints", "platform.joints")
SPRUNG = sprung(BASE, np.random.default_rng(14))
SMALL = fx.Box.about(HOME.displaced([0.3, 0.2, 0.1, 0.1, 0.05, 0.2]), 0.002, 0.002)
CORNERS = np.array(list(itertools.product(*zip(SMALL.low, SMALL.high, strict=True))))
POSES = np.concatenate([CORNERS, fx.random_poses(SMALL, 200, seed=5).rows(0, 200)])


def drawn_designs(design, count, amount=REACH):
    strays = [one for each in uncertain(amount, *JOINTS) for one in each.strays(design)]
    rng = np.random.default_rng(6)
    return [
        strayed(design, strays, rng.choice([-1.0, 1.0], 36) if k % 2 else rng.uniform(-1, 1, 36)) for k in range(count)
    ]


def extremes(designs, quantity):
    """Least and largest of a quantity at all poses of some designs."""
    values = np.array([quantity(design) for design in designs])
    return float(values.min()), float(values.max())


def lengths(design):
    return fx.inverse_kinematics(design, POSES)


def angles(kind):
    return lambda design: getattr(fx.mechanics.joint_angles(design, POSES), kind)


def moments(kind):
    def of(design):
        found = fx.joint_moments(design, POSES)
        return np.linalg.norm(found.universal_moment, axis=-1) if kind == "universal" else found.bending_moment

    return of


def bound(key, design, of, designs, share):
    """The design with a limit beyond what it has itself by a share of how far the drawn designs go beyond that."""
    own, all_of_them = extremes([design], of), extremes(designs, of)
    if key == "leg_length":
        ends = [a + share * (b - a) for a, b in zip(own, all_of_them, strict=True)]
        return design.replace({"limits": {"leg_length": ends}})
    side = 0 if key == "leg_distance" else 1
    value = own[side] + share * (all_of_them[side] - own[side])
    return design.replace({"limits": {key: value}})


CASES = {
    "leg_length": (BASE, lengths),
    "universal_angle": (BASE, angles("universal")),
    "spherical_angle": (BASE, angles("spherical")),
    "leg_distance": (BASE, lambda design: fx.mechanics.leg_distance(design, POSES)),
    "universal_moment": (SPRUNG, moments("universal")),
    "spherical_moment": (SPRUNG, moments("spherical")),
}


@pytest.mark.parametrize("key", CASES)
def test_limits_that_all_designs_keep_are_proved_and_others_refuted_by_one(key, tmp_path):
    design, of = CASES[key]
    designs, path = drawn_designs(design, 60), tmp_path / "proof.json"
    given = {"uncertain": uncertain(REACH, *JOINTS), "time_limit": 60.0}
    wide = bound(key, design, of, designs, 3.0)
    found = fx.certify_limits(wide, SMALL, path=path, **given)
    assert found.proved
    assert len(found.strays) == 36
    assert checking.check_certificate(path).proved
    limits = {"limits": {key: getattr(wide.limits, key)}}
    for other in designs:
        assert fx.check_limits(other.replace(limits), POSES).ok.all()
    narrow = bound(key, design, of, designs, 0.4)
    assert fx.check_limits(narrow, POSES).ok.all(), "the design itself keeps them"
    refuted = fx.certify_limits(narrow, SMALL, path=path, **given)
    assert refuted.status == "refuted"
    assert not fx.check_limits(refuted.adverse, refuted.pose).ok
    assert refuted.broken
    assert np.abs(refuted.adverse.base_joints - design.base_joints).max() <= REACH * (1 + 1e-12)
    assert checking.check_certificate(path).status == "refuted"
    again = fx.certify_limits(narrow, SMALL, path=path, resume=True, **given)
    assert again.broken == refuted.broken


def test_what_is_proved_of_a_path_holds_for_drawn_designs():
    path = fx.Trajectory([[0, 0, 2.4, 0, 0, 0], [0.1, 0.05, 2.5, 0.1, 0, 0.1]], [0, 1])
    design = BASE.replace({"limits": {"leg_length": [2.0, 3.3], "universal_angle_deg": 30.0}})
    found = fx.certify_limits(design, path, uncertain=uncertain(REACH, *JOINTS))
    assert found.proved
    rows = path(np.linspace(0, 1, 200)).pose
    for other in drawn_designs(design, 20):
        assert fx.check_limits(other, rows).ok.all()


def test_margins_are_those_of_the_certificate():
    """The name of the limit that a strayed design breaks is that of its least margin."""
    designs = drawn_designs(BASE, 60)
    narrow = bound("leg_length", BASE, lengths, designs, 0.4)
    found = fx.certify_limits(narrow, SMALL, uncertain=uncertain(REACH, *JOINTS))
    margins = LimitMargins(found.adverse)
    values = margins(found.pose)[0]
    assert values.min() < 0
    assert found.broken == margins.names[int(values.argmin())]


@pytest.mark.parametrize(
    "wrong",
    [
        fx.Uncertain("legs.stiffness", 0.1),
        fx.Uncertain("platform.mass", 0.1),
        fx.optimisation.Payload((0, 5)),
        fx.optimisation.Payload((0, 5), (0.0, 0.0, (0.0, 0.1))),
    ],
    ids=["stiffness", "mass", "payload", "place of a payload"],
)
def test_what_is_no_place_of_a_joint_is_refused(wrong):
    with pytest.raises(fx.ArgumentError, match="places of joints alone"):
        fx.certify_limits(BASE, SMALL, uncertain=wrong)


def test_shared_joints_may_stray_together_only():
    design = fx.load("mukherjee-i")
    pairs = np.abs(design.base_joints[:, None] - design.base_joints).max(axis=-1) < 1e-9
    shared = (
        design if pairs.sum() > 6 else design.replace({"base.joints": np.repeat(design.base_joints[::2], 2, axis=0)})
    )
    shared = shared.replace({"limits": {"leg_distance": 1e-3}})
    small = fx.Box.about(fx.home_pose(shared), 0.001, 0.001)
    with pytest.raises(fx.ArgumentError, match="share a joint of the base"):
        fx.certify_limits(shared, small, uncertain=uncertain(1e-4, "base.joints"))
    together = fx.Uncertain("base.joints[:][2]", 1e-4, relative=False, each=False)
    assert fx.certify_limits(shared, small, uncertain=together).status in ("proved", "refuted")
