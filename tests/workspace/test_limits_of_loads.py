"""Limits of leg forces, of moments and of motions in sweeps, searches, plans and checks: what is judged at rest, and what not."""

import dataclasses

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.helpers.support import JOINTS

import flexapod as fx
from flexapod.design.layout import FULL, with_short_forms
from flexapod.mechanics.inputs import as_joint
from flexapod.mechanics.load_limits import motion_limits_words
from flexapod.optimisation.derivatives import DesignDerivatives
from flexapod.paths import LegSpeed, path_loads
from flexapod.workspace.limit_margins import LimitMargins
from flexapod.workspace.quantities import evaluate

SPRUNG = {
    "legs.joint_stiffness.universal": 400.0,
    "legs.joint_stiffness.spherical": 300.0,
    "suspension.stiffness": np.diag([1e4, 1e4, 2e4, 3e3, 3e3, 3e3]).tolist(),
}
FORCES = {"limits.leg_compression": 9000.0, "limits.leg_tension": 500.0}
MOMENTS = {"limits.universal_moment": 60.0, "limits.spherical_moment": 45.0}
HOME = np.concatenate([plain_machine("motion-base").home.position, np.zeros(3)])


def drawn(count, scale=0.3, seed=1):
    return HOME + np.random.default_rng(seed).uniform(-scale, scale, (count, 6))


def weights(machine, rows):
    """Static forces from the gradient of the potential energy by leg lengths: virtual work, by central differences."""

    def energy(six):
        # platform and legs (their mass centres lie where the parts do), and the springs beside the legs
        e = fx.mechanics.energy(machine, fx.Pose.from_rpy(*six), unstretched_length=lengths(six))
        return float(e.gravitational + e.elastic)

    def lengths(six):
        return fx.inverse_kinematics(machine, fx.Pose.from_rpy(*six))

    found = []
    for six in rows:
        step = 1e-5
        ahead, behind = six + step * np.eye(6), six - step * np.eye(6)
        slope = np.array([(energy(a) - energy(b)) / (2 * step) for a, b in zip(ahead, behind, strict=True)])
        by = np.array([(lengths(a) - lengths(b)) / (2 * step) for a, b in zip(ahead, behind, strict=True)])
        found.append(np.linalg.solve(by, slope))
    return np.array(found)


@pytest.mark.parametrize("springs", [{}, SPRUNG], ids=["plain", "sprung"])
def test_static_forces_of_sweeps_are_those_of_virtual_work(springs):
    machine = plain_machine("motion-base").replace(springs)
    rows = drawn(12)
    expected = weights(machine, rows)
    found = evaluate(machine, rows, ("leg_compression", "leg_tension"), "universal", 1)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(found["leg_compression"], expected.max(axis=1), atol=2e-7 * scale)
    np.testing.assert_allclose(found["leg_tension"], -expected.min(axis=1), atol=2e-7 * scale)
    bare = evaluate(machine, rows, ("within_limits",), "universal", 1)["within_limits"]
    most, pull = np.median(expected[bare].max(axis=1)) * 1.0001, np.quantile(-expected[bare].min(axis=1), 0.8) * 1.0001
    limits = {"limits.leg_compression": most, "limits.leg_tension": max(pull, 1.0)}
    within = evaluate(machine.replace(limits), rows, ("within_limits",), "universal", 1)["within_limits"]
    kept = ((expected <= most) & (expected >= -max(pull, 1.0))).all(axis=1)
    assert 0 < (bare & kept).sum() < bare.sum()
    np.testing.assert_array_equal(within, bare & kept)


@pytest.mark.parametrize("joint", JOINTS)
def test_sweeps_and_checks_agree_on_what_is_within(joint):
    free = plain_machine("motion-base").replace(SPRUNG | {"gravity": [4.0, 2.0, -5.0], "limits.leg_length": None})
    rows = drawn(1500, 0.2)
    poses = fx.Pose.from_rpy(*rows.T)
    force, moments = fx.hold(free, poses, joint=joint).leg_force, fx.joint_moments(free, poses, joint=joint)
    extremes = {
        "leg_compression": force.max(axis=1),
        "leg_tension": -force.min(axis=1),
        "universal_moment": np.linalg.norm(moments.universal_moment, axis=-1).max(axis=1),
        "spherical_moment": moments.bending_moment.max(axis=1),
    }
    bounds = {f"limits.{name}": float(np.quantile(values, 0.8)) for name, values in extremes.items()}
    assert min(bounds.values()) > 0
    machine = free.replace(bounds)
    swept = evaluate(machine, rows, ("within_limits",), joint, 1)["within_limits"]
    ways = [poses.packed, (poses.position, poses.matrix.reshape(-1, 9)), (poses.position, poses.rotation.as_quat())]
    checked = fx.check_limits(machine, poses, joint=joint).ok
    assert 10 < checked.sum() < len(rows) - 10
    np.testing.assert_array_equal(swept, checked)
    for way in ways:
        np.testing.assert_array_equal(evaluate(machine, way, ("within_limits",), joint, 1)["within_limits"], checked)
    for left_out in bounds:  # each of them matters
        assert fx.check_limits(machine.replace({left_out: None}), poses, joint=joint).ok.sum() > checked.sum()


@pytest.mark.parametrize("joint", JOINTS)
def test_margins_are_those_of_hold_and_moments_in_either_joint_model(joint):
    machine = plain_machine("motion-base").replace(SPRUNG | FORCES | MOMENTS)
    margins = LimitMargins(machine, joint=joint)
    six = drawn(1, 0.2, 3)[0]
    pose = fx.Pose.from_rpy(*six)
    value, slope = margins(six)
    named = dict(zip(margins.names, value, strict=True))
    force = fx.hold(machine, pose, joint=joint).leg_force
    moments = fx.joint_moments(machine, pose, joint=joint)
    bend = np.linalg.norm(moments.universal_moment, axis=-1)
    for i in range(6):
        compression, tension = named[f"greatest compression of leg {i + 1}"], named[f"greatest tension of leg {i + 1}"]
        assert compression == pytest.approx((9000 - force[i]) / np.hypot(9000, force[i]), abs=1e-10)
        assert tension == pytest.approx((500 + force[i]) / np.hypot(500, force[i]), abs=1e-10)
        assert named[f"moment of the universal joint of leg {i + 1}"] == pytest.approx(
            1 - (bend[i] / 60) ** 2, abs=1e-9
        )
    numbers = np.array([(margins(six + h)[0] - margins(six - h)[0]) / 2e-5 for h in 1e-5 * np.eye(6)]).T
    np.testing.assert_allclose(slope, numbers, atol=1e-7 * np.abs(numbers).max())


def test_joint_models_differ_where_moments_are_limited():
    machine = plain_machine("motion-base").replace(SPRUNG)
    six = HOME + np.array([0.2, 0.3, 0.1, 0.3, 0.2, 0.5])
    bends = [np.linalg.norm(fx.joint_moments(machine, six, joint=joint).universal_moment, axis=-1) for joint in JOINTS]
    leg = int(np.argmax(np.abs(bends[0] - bends[1])))
    between = machine.replace({"limits": None, "limits.universal_moment": float(max(b.max() for b in bends)) - 1e-9})
    assert bends[0][leg] != pytest.approx(bends[1][leg], rel=1e-6)
    oks = [bool(fx.check_limits(between, six, joint=joint).ok) for joint in JOINTS]
    assert oks == [b.max() < max(c.max() for c in bends) - 1e-9 for b in bends]
    assert oks.count(True) == 1


def test_a_worst_pose_is_within_limits_of_forces():
    machine = plain_machine("motion-base")
    box = fx.Workspace.about_home(0.15, 0.08)
    free = fx.worst_pose(machine, box, samples=2**11, starts=3)
    force = float(fx.hold(machine, fx.Pose.from_rpy(*free.pose)).leg_force.max())
    limited = machine.replace({"limits.leg_compression": 0.97 * force})
    found = fx.worst_pose(limited, box, samples=2**11, starts=3)
    assert found.omega_1 > free.omega_1
    assert fx.hold(machine, fx.Pose.from_rpy(*found.pose)).leg_force.max() <= 0.97 * force * (1 + 1e-9)
    assert found.share_within_limits < 1
    rows = box.rows(HOME, 4096, seed=5)
    swept = evaluate(limited, rows, ("omega_1", "within_limits"), "universal", 1)
    assert swept["omega_1"][swept["within_limits"]].min() >= found.omega_1 * (1 - 1e-9)
    with pytest.raises(fx.ArgumentError, match=r"limits leg forces .* nothing can be proved yet"):
        fx.worst_pose(limited, box, certified=True)
    with pytest.raises(fx.ArgumentError, match="limits leg forces"):
        fx.certify_limits(limited, box)


@pytest.mark.parametrize("joint", JOINTS)
def test_forces_and_moments_of_constraints_have_exact_derivatives_by_the_design(joint):
    machine = plain_machine("motion-base").replace(SPRUNG)
    keys = ("platform.mass", "platform.mass_center[2]", "base.joints[2][1]", "platform.joints[4][0]", "gravity[1]")
    keys += (
        "legs.upper.mass[3]",
        "legs.joint_stiffness.spherical[0]",
        "suspension.stiffness[0][0]",
    )
    rows = drawn(3, 0.15, 4)
    variables = [fx.Variable(key, -1.0, 1.0, kind="add") for key in keys]
    jacobian = np.zeros((FULL, len(keys)))
    for k, variable in enumerate(variables):
        for part in variable.parts(machine):
            jacobian[part.index, k] = 1.0
    at = DesignDerivatives(with_short_forms(machine), jacobian, rows, False, as_joint(joint))
    force, by = at.static_force
    poses = fx.Pose.from_rpy(*rows.T)
    np.testing.assert_allclose(force, fx.hold(machine, poses, joint=joint).leg_force, rtol=1e-9)
    step = 1e-5
    for k, key in enumerate(keys):
        now = np.asarray(machine.values()[key.partition("[")[0]], dtype=float)
        index = tuple(int(i) for i in key.replace("]", "").split("[")[1:])
        scale = step * max(1.0, abs(float(now[index])))
        moved = []
        for sign in (1, -1):
            changed = now.copy()
            changed[index] += sign * scale
            one = machine.replace({key.partition("[")[0]: changed.tolist()})
            one = dataclasses.replace(one, universal_axes=machine.universal_axes)
            moved.append(fx.hold(one, poses, joint=joint).leg_force)
        expected = (moved[0] - moved[1]) / (2 * scale)
        np.testing.assert_allclose(by[..., k], expected, atol=1e-6 * max(np.abs(expected).max(), 1.0), err_msg=key)


def test_a_path_of_a_given_time_is_refused_where_it_exceeds_what_motors_can_do():
    machine = plain_machine("motion-base").replace({"limits.leg_rate": 0.3, "limits.leg_acceleration": 1.0})
    goal = machine.home.displaced([0.2, 0.1, 0.05, 0, 0, 0.05])
    with pytest.raises(
        fx.errors.PathError, match=r"in 0.5 s the path exceeds .* leg rate and acceleration; it keeps them in"
    ):
        fx.plan_path(machine, machine.home, goal, 10.0, timing=0.5)
    try:
        fx.plan_path(machine, machine.home, goal, 10.0, timing=0.5)
    except fx.errors.PathError as error:
        needed = float(str(error).split("keeps them in ")[1].split(" s")[0])
    plan = fx.plan_path(machine, machine.home, goal, 10.0, timing=needed * (1 + 1e-5))
    loads = path_loads(machine, plan.path)
    assert bool(loads.loads_within_limits.all())
    assert max(abs(loads.leg_rate).max() / 0.3, abs(loads.leg_acceleration).max() / 1.0) == pytest.approx(1, abs=1e-3)
    quick = fx.plan_path(machine, machine.home, goal, 10.0, timing=LegSpeed(rate=5.0))
    assert quick.path.duration == pytest.approx(needed, rel=1e-3)
    free = fx.PathRequirements(10.0, limits=False)
    assert fx.plan_path(machine, machine.home, goal, free, timing=0.5).path.duration == 0.5


def test_a_timed_path_slows_down_for_forces_and_power():
    machine = plain_machine("motion-base")
    goal = machine.home.displaced([0.2, 0.1, 0.05, 0, 0, 0.05])
    quick = fx.plan_path(machine, machine.home, goal, 10.0, timing=LegSpeed(rate=2.0))
    loads = path_loads(machine, quick.path)
    rest = float(np.abs(loads.static_force).max())
    most = 0.5 * (rest + float(loads.leg_force.max()))
    assert most < float(loads.leg_force.max())
    limited = machine.replace({"limits.leg_compression": most})
    slow = fx.plan_path(limited, machine.home, goal, 10.0, timing=LegSpeed(rate=2.0))
    assert slow.path.duration > quick.path.duration
    found = path_loads(limited, slow.path)
    assert bool(found.loads_within_limits.all())
    assert float(found.leg_force.max()) == pytest.approx(most, rel=1e-3)


def test_a_search_keeps_forces_and_moments_of_the_design():
    machine = plain_machine("motion-base").replace(
        SPRUNG | {"limits": None, "limits.leg_compression": 12000.0, "limits.spherical_moment": 120.0}
    )
    limits = fx.optimisation.DesignLimits(region=fx.Workspace.about_home(0.1, 0.05))
    found = limits.requirements(machine, None, None)
    assert [(one.name, float(one.bound)) for one in found] == [
        ("moment of spherical joints", 120.0),
        ("compression of legs at rest", 12000.0),
    ]
    with pytest.raises(fx.ArgumentError, match=r"has no \[limits\] of poses \(those of leg_rate are of motions\)"):
        limits.requirements(machine.replace({"limits": None, "limits.leg_rate": 1.0}), None, None)
    with pytest.raises(fx.ArgumentError, match=r"limits\.leg_tension is 0 N"):
        limits.requirements(machine.replace({"limits.leg_tension": 0.0}), None, None)


def test_what_only_motions_exceed_is_said():
    machine = plain_machine("motion-base").replace({"limits": None, "limits.leg_rate": 1.0, "limits.leg_power": 10.0})
    assert not machine.limits.given
    assert machine.limits.of_motions == ("leg_rate", "leg_power")
    words = motion_limits_words(machine.limits)
    assert "limits.leg_rate, limits.leg_power: of a motion, and not judged at poses at rest" in words
    assert bool(fx.check_limits(machine).ok)


@pytest.mark.parametrize("form", ["angles", "matrices"])
def test_a_row_that_is_no_pose_does_not_end_a_sweep_of_forces(form):
    """The others are as they are alone; at home six equal legs carry the weight by their vertical parts."""
    machine = fx.load("motion-base").replace(FORCES)
    rows = drawn(3, 0.1)
    rows[0] = HOME
    turned = rows if form == "angles" else fx.Pose.from_rpy(*rows.T).packed
    given = turned.copy()
    given[1, 2] = np.nan
    given[2, 4] = np.inf
    names = ("leg_compression", "leg_tension", "within_limits")
    found, alone = (evaluate(machine, some, names, "universal", 1) for some in (given, turned[:1]))
    for name in names:
        assert found[name][0] == alone[name][0]
    assert np.isnan(found["leg_compression"][1:]).all()
    assert np.isnan(found["leg_tension"][1:]).all()
    assert found["within_limits"].tolist() == [True, False, False]
    length = fx.inverse_kinematics(machine)
    weight = machine.platform_mass * 9.81
    upright = np.abs(fx.force_transformation(machine)[2])
    assert found["leg_compression"][0] * upright.sum() > weight  # and the legs' own
    assert np.ptp(length) < 1e-12


def test_where_no_forces_hold_a_pose_a_limit_of_them_is_told():
    machine = fx.load("motion-base").replace({**FORCES, "limits.leg_length": None})
    singular = fx.Pose.from_rpy(*HOME[:3], 0, 0, np.pi / 2)  # hexagon over hexagon, turned
    found = fx.check_limits(machine, singular)
    assert not found.ok
    assert any("no force at rest holds the pose" in words for words in found.exceeded)
    both = fx.Pose(np.stack([singular.position] * 2), np.stack([singular.matrix, machine.home.matrix]))
    assert fx.check_limits(machine, both).ok.tolist() == [False, True]
