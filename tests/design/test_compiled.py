"""The handle for loops answers as the functions that check everything, and says what shapes it needs."""

import pickle

import numpy as np
import pytest
from tests.helpers.drawn import sprung
from tests.helpers.plain import plain_machine
from tests.helpers.states import draw_state
from tests.helpers.support import JOINTS, MACHINES, away, relative

import flexapod as fx
from flexapod.design import CompiledHexapod

PLAIN = plain_machine("motion-base")  # the packaged one's oil reaches no pose far from home
HEXAPODS = {name: fx.load(name) for name in MACHINES} | {
    "motion-base": PLAIN,
    "sprung": sprung(PLAIN, np.random.default_rng(8)),
}
BASE = fx.Pose.from_rpy(0.1, 0.2, -0.1, 0.1, -0.2, 0.3)


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("name", HEXAPODS)
def test_it_answers_as_the_functions_do(name, joint):
    hexapod, rng = HEXAPODS[name], np.random.default_rng(5)
    handle = hexapod.compiled(base=BASE, joint=joint)
    for _ in range(5):
        s = draw_state(hexapod, rng)
        seen = s.platform.pose
        pose = fx.Pose(BASE.position + BASE.matrix @ seen.position, BASE.matrix @ seen.matrix)
        motion = fx.Motion(pose, s.platform.velocity, s.platform.angular_velocity, [1.0, -2.0, 0.5], [0.3, 0.2, 0.1])
        twist = np.concatenate([motion.velocity, motion.angular_velocity])
        acceleration = np.concatenate([motion.acceleration, motion.angular_acceleration])
        wrench, load = np.concatenate([s.force, s.moment]), {"force": s.force, "moment": s.moment}
        given = {"base": BASE, "joint": joint}
        omega = fx.natural_modes(hexapod, pose, **given).omega
        for numbers in (pose.packed, np.concatenate([pose.position, pose.rpy])):
            assert np.abs(handle.natural_frequencies(numbers) - omega).max() < 1e-13 * omega[5]
            assert abs(handle.stability_index(numbers) - omega[0]) < 1e-13 * omega[5]
            assert relative(handle.leg_lengths(numbers), fx.inverse_kinematics(hexapod, pose, base=BASE)) < 1e-14
            H = fx.equations_of_motion(hexapod, pose, **given).H
            assert relative(handle.jacobian(numbers), H.T) < 1e-14
            forces = fx.inverse_dynamics(hexapod, motion, **given, **load)
            assert relative(handle.inverse_dynamics(numbers, twist, acceleration, wrench), forces) < 1e-9
            moved = np.concatenate(fx.forward_dynamics(hexapod, motion, leg_force=s.leg_force, **given, **load))
            assert relative(handle.forward_dynamics(numbers, twist, s.leg_force, wrench), moved) < 1e-11
            tangent, found = fx.linearise(hexapod, pose, **given, **load), handle.linearised(numbers, wrench)
            for part in ("M", "C", "K", "H"):
                expected = getattr(tangent, part)
                assert np.abs(getattr(found, part) - expected).max() <= 1e-9 * np.abs(expected).max()


def test_loads_left_out_are_zero():
    hexapod = fx.load("motion-base")
    handle, pose = hexapod.compiled(), away(hexapod)
    assert relative(handle.inverse_dynamics(pose.packed), fx.hold(hexapod, pose).leg_force) < 1e-13
    free = handle.forward_dynamics(pose.packed, np.zeros(6), np.zeros(6))
    assert np.array_equal(free, np.concatenate(fx.forward_dynamics(hexapod, pose)))


def test_values_are_not_checked():
    hexapod = fx.load("motion-base")
    handle, met = hexapod.compiled(), hexapod.base_joints[0] - hexapod.platform_joints[0]
    nothing = np.full(6, np.nan)
    assert np.isnan(handle.stability_index(nothing))
    assert np.isnan(handle.natural_frequencies(nothing)).all()
    assert np.isnan(handle.leg_lengths(nothing)).all()
    assert np.isnan(handle.inverse_dynamics(nothing)).all()
    assert np.isnan(handle.natural_frequencies(np.concatenate([met, np.zeros(3)]))).all()


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda h: h.stability_index(np.zeros(5)), r"pose is an array of float64 \(5,\); it must be a float64 array \(6,\)"),
        (lambda h: h.natural_frequencies(np.zeros((1, 6))), r"pose is an array of float64 \(1, 6\)"),
        (lambda h: h.leg_lengths(np.zeros(6, np.float32)), r"pose is an array of float32 \(6,\)"),
        (lambda h: h.jacobian("home"), "pose is 'home'"),
        (lambda h: h.inverse_dynamics(np.zeros(6), np.zeros(3)), r"twist is an array of float64 \(3,\).*angular velocity"),
        (lambda h: h.forward_dynamics(np.zeros(6), np.zeros(6), [1.0] * 5), r"leg_force is \[1.0.*forces, N"),
        (lambda h: h.linearised(np.zeros(6), None), "wrench is None"),
    ],
)  # fmt: skip
def test_wrong_shapes_are_told(call, words):
    with pytest.raises(fx.errors.ArgumentError, match=words):
        call(fx.load("motion-base").compiled())


@pytest.mark.parametrize("kind", [float, np.float64, np.float32, int, np.int64])
def test_lists_of_numbers_of_any_kind_are_numbers(kind):
    handle = fx.load("motion-base").compiled()
    pose, twist, force = np.array([0, 0, 2, 0, 0, 0]), np.arange(6), np.array([9, 8, 7, 6, 5, 4])
    numbers = [[kind(x) for x in given] for given in (pose, twist, force)]
    known = handle.forward_dynamics(*(given.astype(np.float64) for given in (pose, twist, force)))
    assert (handle.forward_dynamics(*numbers) == known).all()
    assert (handle.linearised(tuple(numbers[0])).K == handle.linearised(pose.astype(np.float64)).K).all()
    with pytest.raises(fx.errors.ArgumentError, match="twist is"):
        handle.forward_dynamics(numbers[0], [*numbers[1][:5], "0"], numbers[2])
    with pytest.raises(fx.errors.ArgumentError, match="leg_force is"):
        handle.forward_dynamics(numbers[0], numbers[1], [*numbers[2][:5], 10**400])


def test_what_it_cannot_be_made_of_is_told():
    hexapod = fx.load("motion-base")
    with pytest.raises(fx.errors.ArgumentError, match="joint is 'rigid'"):
        hexapod.compiled(joint="rigid")
    with pytest.raises(fx.PoseError, match=r"base has batch axes \(2,\)"):
        hexapod.compiled(base=fx.Pose(np.zeros((2, 3))))


def test_it_can_be_sent_to_another_process():
    handle = fx.load("motion-base").compiled(base=BASE, joint="spin_free")
    again = pickle.loads(pickle.dumps(handle))
    assert isinstance(again, CompiledHexapod)
    assert (again.joint, again.base) == ("spin_free", BASE)
    assert again.stability_index([0, 0, 2.4, 0, 0, 0]) == handle.stability_index([0, 0, 2.4, 0, 0, 0])
    assert "motion-base" in repr(handle)
