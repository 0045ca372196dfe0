"""One call for one pose takes a way of its own through the core: it answers as the way of many poses does."""

import numpy as np
import pytest
from tests.helpers.drawn import sprung
from tests.helpers.plain import plain_machine
from tests.helpers.states import draw_state
from tests.helpers.support import JOINTS, MACHINES, away, center

import flexapod as fx
from flexapod.mechanics.inputs import at_once, states

LAW = fx.design.TableLaw([0.05, 2.0, 5.0, 50.0], [9e7, 7e7, 5e7, 4e7])


def machines():
    rng = np.random.default_rng(8)
    plain = plain_machine("motion-base")
    by_law = fx.Hexapod.from_values(
        {key: value for key, value in plain.values().items() if key != "legs.stiffness"}
        | {"legs.stiffness_law.kind": "table", "legs.stiffness_law.lengths": LAW.lengths}
        | {"legs.stiffness_law.stiffnesses": LAW.stiffnesses}
    )
    packaged = {name: fx.load(name) for name in MACHINES}  # the packaged base's oil reaches no pose far from home
    return {**packaged, "motion-base": plain, "sprung": sprung(plain, rng), "by a law": by_law}


HEXAPODS = machines()


def many(pose):
    """The same as a batch of one, which takes the other way."""
    if isinstance(pose, fx.Motion):
        rates = (pose.velocity, pose.angular_velocity, pose.acceleration, pose.angular_acceleration)
        return fx.Motion(many(pose.pose), *(rate[None] for rate in rates))
    return fx.Pose(pose.position[None], pose.matrix[None])


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("name", HEXAPODS)
def test_it_answers_as_many_poses_do(name, joint):
    hexapod, rng = HEXAPODS[name], np.random.default_rng(3)
    for _ in range(5):
        s = draw_state(hexapod, rng)
        forces = {"force": s.force, "moment": s.moment}
        for base in (None, s.base.pose):
            pose, bases = s.platform.pose, None if base is None else many(base)
            for ask in (fx.natural_modes, fx.stability_index, fx.inverse_kinematics):
                more = {} if ask is fx.inverse_kinematics else {"joint": joint}
                one, row = ask(hexapod, pose, base=base, **more), ask(hexapod, many(pose), base=bases, **more)
                pairs = zip(one, row, strict=True) if isinstance(one, tuple) else [(one, row)]
                for a, b in pairs:
                    assert np.array_equal(a, np.asarray(b)[0])
        one = fx.inverse_dynamics(hexapod, s.platform, base=s.base, joint=joint, **forces)
        row = fx.inverse_dynamics(hexapod, many(s.platform), base=many(s.base), joint=joint, **forces)
        assert np.array_equal(one, row[0])
        given = {"leg_force": s.leg_force, "joint": joint, **forces}
        one = fx.forward_dynamics(hexapod, s.platform, base=s.base, **given)
        row = fx.forward_dynamics(hexapod, many(s.platform), base=many(s.base), **given)
        assert np.array_equal(one, np.reshape(row, (2, 3)))


@pytest.mark.parametrize("name", HEXAPODS)
def test_what_rests_is_what_holds_it(name):
    hexapod = HEXAPODS[name]
    pose, load = away(hexapod), {"force": [10.0, -20.0, 5.0], "moment": [1.0, 2.0, -3.0]}
    base = fx.Pose.from_rpy(0.1, 0.2, -0.1, 0.1, -0.2, 0.3)
    placed = fx.Pose(base.position + base.matrix @ pose.position, base.matrix @ pose.matrix)
    tangent, held = fx.linearise(hexapod, placed, base=base, **load), fx.hold(hexapod, placed, base=base, **load)
    assert tangent.rest.pose == placed
    assert np.array_equal(tangent.rest.leg_force, held.leg_force)
    assert np.array_equal(tangent.rest.unstretched_length, held.unstretched_length)
    terms = fx.equations_of_motion(hexapod, placed, base=base)
    for found, term in ((tangent.M, terms.J_p), (-tangent.M_b, terms.J_b), (tangent.H, terms.H)):
        assert np.abs(found - term).max() < 1e-13 * np.abs(term).max()
    lever = placed.position - base.position
    carried = tangent.carry @ [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]
    assert np.allclose(carried[:3], np.array([1.0, 2.0, 3.0]) + np.cross([0.1, 0.2, 0.3], lever), rtol=1e-14)
    assert np.array_equal(carried[3:], [0.1, 0.2, 0.3])


SIX = [0.05, 0.02, 2.4, 0.03, -0.02, 0.04]


@pytest.mark.parametrize(
    "pose",
    [
        np.array(SIX),
        tuple(SIX),
        np.array(SIX)[::-1].copy()[::-1],
        np.array(SIX, dtype=object),
        [np.float64(x) for x in SIX],
        fx.Pose.from_rpy(*SIX),
        fx.Motion(SIX),
        fx.Pose([SIX[:3]], fx.Pose.from_rpy(*SIX).matrix[None])[0],
    ],
    ids=["array", "tuple", "strides", "objects", "list", "Pose", "Motion", "one of many"],
)
def test_however_a_pose_is_written(pose):
    hexapod = fx.load("motion-base")
    expected = fx.natural_modes(hexapod, fx.Pose.from_rpy(*SIX)).omega
    assert np.array_equal(fx.natural_modes(hexapod, pose).omega, expected)


def test_whole_numbers_are_numbers():
    hexapod = fx.load("motion-base")
    lengths = [
        fx.inverse_kinematics(hexapod, pose)
        for pose in ([0, 0, 2, 0, 0, 0], np.array([0, 0, 2, 0, 0, 0]), np.array([0, 0, 2, 0, 0, 0], np.float32))
    ]
    assert np.array_equal(lengths[0], lengths[1])
    assert np.array_equal(lengths[0], lengths[2])


def test_the_usual_way_is_taken_by_what_is_usual_and_nothing_else():
    hexapod = fx.load("motion-base")
    collapsed = fx.Pose(hexapod.base_joints[0] - hexapod.platform_joints[0])

    def asked(pose, base=None, joint="universal", load=((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))):
        return at_once("inverse_dynamics", hexapod, pose, base, joint, *load)

    assert asked(None) is not None
    assert asked(SIX, fx.Motion(fx.Pose((0.0, 0.0, 0.0)), [0.1, 0, 0])) is not None
    for unusual in (
        asked([SIX]), asked("home"), asked(SIX[:5]), asked([*SIX[:5], np.nan]), asked(np.array(SIX, np.float32)),
        asked(np.ma.masked_array(SIX)), asked(collapsed), asked(SIX, joint="rigid"), asked(SIX, joint=[]),
        asked(SIX, base="floor"), asked(SIX, load=((0.0, 0.0), (0.0, 0.0, 0.0))), asked([True, *SIX[1:]]),
    ):  # fmt: skip
        assert unusual is None
    with pytest.raises(fx.PoseError, match="leg 1 has length"):
        fx.inverse_dynamics(hexapod, collapsed)


def test_answers_do_not_hang_together():
    hexapod, pose = fx.load("motion-base"), away(fx.load("motion-base"))
    first, second = fx.natural_modes(hexapod, pose), fx.natural_modes(hexapod, pose)
    first.omega[:] = 0.0
    assert second.omega.min() > 0
    assert states(hexapod, center(hexapod)).shape == ()
