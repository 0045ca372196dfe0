"""The sweep's kernel, for every instruction set of this machine: exact to what float64 allows, or a status says not."""

import os
import pickle
import subprocess
import sys
from functools import reduce
from operator import or_

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.plain import plain_machine
from tests.helpers.states import CENTER
from tests.helpers.support import apart
from tests.oracles.exact_modes import exact_modes

import flexapod as fx
from flexapod import _core
from flexapod.mechanics.joint_limits import limit_excess, neutral_directions

EPS = np.finfo(float).eps
ALL = reduce(or_, _core.SweepQuantity)
OK, SINGULAR, NO_LEG, NOT_FINITE, NO_INERTIA, OUTSIDE = (status.value for status in _core.SweepStatus)

# An instruction set is chosen at import, so each has a process of its own that computes what it is sent.
WORKER = """
import pickle, sys
from flexapod import _core
pickle.dump(_core.simd(), sys.stdout.buffer)
sys.stdout.buffer.flush()
while True:
    try:
        arguments = pickle.load(sys.stdin.buffer)
    except EOFError:
        break
    *given, limits, threads = arguments
    pickle.dump(_core.sweep(*given, _core.SweepLimits(**limits), threads), sys.stdout.buffer)
    sys.stdout.buffer.flush()
"""


class Kernel:
    def __init__(self, name: str) -> None:
        environment = {**os.environ, "FLEXAPOD_SIMD": name}
        self.process = subprocess.Popen(
            [sys.executable, "-c", WORKER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
        )
        assert pickle.load(self.process.stdout) == name

    def __call__(self, hexapod, poses, quantities=ALL, joint="universal", threads=1, limits=None) -> dict:
        poses = np.ascontiguousarray(poses)
        limits = limits_of(hexapod) if limits is None else limits
        arguments = (hexapod.packed, _core.Joint[joint], poses, quantities, limits, threads)
        pickle.dump(arguments, self.process.stdin)
        self.process.stdin.flush()
        return pickle.load(self.process.stdout)

    def close(self) -> None:
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()


@pytest.fixture(scope="module", params=_core.simd_available())
def kernel(request):
    kernel = Kernel(request.param)
    yield kernel
    kernel.close()


def limits_of(hexapod) -> dict:
    """What SweepLimits is made of, which another process is sent."""
    limits = hexapod.limits
    length = np.tile([-np.inf, np.inf], (6, 1)) if limits.leg_length is None else limits.leg_length
    bounds = {"universal_angle": np.inf, "spherical_angle": np.inf, "leg_distance": -np.inf}
    bounds |= {"universal_moment": np.inf, "spherical_moment": np.inf}
    bounds |= {name: getattr(limits, name) for name in bounds if getattr(limits, name) is not None}
    return {"neutral": neutral_directions(hexapod), "leg_length": np.broadcast_to(length, (6, 2)).copy(), **bounds}


def center(hexapod) -> np.ndarray:
    return np.array([*CENTER[hexapod.name], 0, 0, 0]) if hexapod.home is None else np.concatenate([*hexapod.home])


def box(hexapod, rng, n: int, travel: float = 0.15, turn: float = 0.3) -> np.ndarray:
    """Random poses about the middle of the workspace."""
    middle = center(hexapod)
    size = np.linalg.norm(hexapod.platform_joints + middle[:3] - hexapod.base_joints, axis=1).mean()
    return middle + rng.uniform(-1, 1, (n, 6)) * np.repeat([travel * size, turn], 3)


def near_singular(hexapod, rng, conditions) -> np.ndarray:
    """Poses at about the condition numbers wanted: on a line that crosses a singular pose, at its side."""

    def determinant(pose):
        return np.linalg.slogdet(fx.force_transformation(hexapod, fx.Pose.from_rpy(*pose)))[0]

    while True:
        near, far = box(hexapod, rng, 2, 0.5, 1.5)
        if determinant(near) != determinant(far):
            break
    low, high = 0.0, 1.0  # as fractions of the line
    for _ in range(60):
        middle = 0.5 * (low + high)
        same = determinant(near + middle * (far - near)) == determinant(near)
        low, high = (middle, high) if same else (low, middle)
    reference = fx.condition_number(hexapod, fx.Pose.from_rpy(*(near + (low - 1e-4) * (far - near))))
    return np.array([near + (low - 1e-4 * reference / c) * (far - near) for c in conditions])


def poses_for_accuracy(hexapod, rng) -> np.ndarray:
    """Ordinary poses, the centre and its vertical (double modes of symmetric machines), ill conditioned ones."""
    vertical = np.repeat(center(hexapod)[None], 4, axis=0)
    vertical[1:, 2] *= [0.95, 1.02, 1.1]
    twisted = vertical[:2] + np.array([0, 0, 0, 0, 0, 0.1])
    hard = near_singular(hexapod, rng, [1e3, 1e4, 1e6, 1e8, 1e10])
    return np.concatenate([box(hexapod, rng, 8), vertical, twisted, hard])


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii", "cubic-isolator", "precision-positioner"])
def test_exact_in_every_lane(name, joint, exact_results, measured):
    poses, exact, computed = exact_results(name, joint)
    assert max(e.cond_B for e in exact) > 1e9, "the test must hold poses at a condition of about 1e10"
    for quantities, found in computed:
        for i, e in enumerate(exact):
            # 100 eps cond(B): the bound of the singular values for any method in float64, with a factor for the sums
            omega = found["omega"][i] if quantities & _core.SweepQuantity.omega else found["omega_1"][i : i + 1]
            exact_omega = e.omega[: len(omega)]
            assert found["status"][i] == OK, poses[i]
            measured("sweeps/omega", (omega / exact_omega - 1) / (EPS * e.cond_B), 100)
            measured("sweeps/cond_H", (found["cond_H"][i] / e.cond_H - 1) / (EPS * e.cond_H), 100)


@pytest.fixture(scope="module")
def exact_results(kernel):
    def results(name, joint):
        key = name, joint
        if key not in EXACT:
            hexapod, rng = plain_machine(name), np.random.default_rng(7)
            poses = poses_for_accuracy(hexapod, rng)
            EXACT[key] = hexapod, poses, [exact_modes(hexapod, p, joint == "universal") for p in poses]
        hexapod, poses, exact = EXACT[key]
        masks = [_core.SweepQuantity.cond_H | _core.SweepQuantity[q] for q in ("omega_1", "omega")]
        return poses, exact, [(mask, kernel(hexapod, poses, mask, joint)) for mask in masks]

    return results


EXACT: dict = {}  # shared by the instruction sets


@pytest.mark.parametrize("name", ["mukherjee-i", "motion-base", "cubic-isolator"])
def test_same_as_single_poses(name, kernel, measured):
    hexapod = plain_machine(name)
    poses = box(hexapod, np.random.default_rng(3), 301)
    found = kernel(hexapod, poses)
    pose = fx.Pose.from_rpy(*poses.T)
    assert (found["status"] == OK).all()
    modes = fx.natural_modes(hexapod, pose)
    condition = modes.omega[:, 5] / modes.omega[:, 0]
    # Both are within 100 eps cond of the truth.
    measured("sweeps/single", (found["omega"] / modes.omega - 1) / (EPS * condition[:, None]), 200)
    assert np.array_equal(found["omega_1"], found["omega"][:, 0])
    cond_H = fx.condition_number(hexapod, pose)
    assert np.all(np.abs(found["cond_H"] / cond_H - 1) <= 200 * EPS * cond_H)
    # No subtraction but of coordinates: a few roundings.
    np.testing.assert_allclose(found["leg_length"], fx.inverse_kinematics(hexapod, pose), rtol=20 * EPS)
    np.testing.assert_allclose(found["leg_distance"], fx.mechanics.leg_distance(hexapod, pose), rtol=1e-12)
    angles = fx.joint_angles(hexapod, pose)
    np.testing.assert_allclose(found["universal_angle"], angles.universal, rtol=0, atol=20 * EPS)
    np.testing.assert_allclose(found["spherical_angle"], angles.spherical, rtol=0, atol=20 * EPS)
    # A linear system in H: its error is that of its condition.
    force = np.abs(fx.hold(hexapod, pose).leg_force).max(axis=-1)
    assert np.all(np.abs(found["leg_force"] / force - 1) <= 100 * EPS * cond_H)
    assert np.all(np.abs(found["lowest_stiffness"] / lowest_stiffness(hexapod, pose) - 1) <= 200 * EPS * cond_H)
    assert np.array_equal(found["within_limits"], fx.check_limits(hexapod, pose).ok)


def lowest_stiffness(hexapod, pose) -> np.ndarray:
    """Least force per displacement, from the singular values of K^-1/2 H^-1 [E; 0]."""
    H = fx.force_transformation(hexapod, pose)
    Y = np.linalg.inv(H)[..., :3] / np.sqrt(hexapod.legs.stiffness)[:, None]
    return np.linalg.svd(Y, compute_uv=False)[..., 0] ** -2


def test_limits_hold_somewhere_and_not_elsewhere(kernel):
    hexapod = fx.load("mukherjee-i").replace(
        {
            "limits.leg_length": [0.7, 1.1],
            "limits.universal_angle": 0.5,
            "limits.spherical_angle": 0.6,
            "limits.leg_distance": 0.1,
        }
    )
    poses = box(hexapod, np.random.default_rng(4), 400, 0.25, 0.5)
    pose = fx.Pose.from_rpy(*poses.T)
    within = kernel(hexapod, poses, _core.SweepQuantity.within_limits)["within_limits"]
    assert np.array_equal(within, fx.check_limits(hexapod, pose).ok)
    assert 20 < within.sum() < 380
    for what, _, value, least, most in limit_excess(hexapod, pose):  # each limit is met by some pose
        assert not ((value >= least) & (value <= most)).all(), what


@pytest.mark.parametrize("name", ["mukherjee-i", "cubic-isolator"])
def test_gradient(name, kernel, measured):
    hexapod = plain_machine(name)
    poses = box(hexapod, np.random.default_rng(5), 60)
    two = fx.natural_modes(hexapod, fx.Pose.from_rpy(*poses.T)).omega[:, :2]
    poses = poses[two[:, 1] > 1.05 * two[:, 0]][:19]  # near a crossing differences say nothing
    assert len(poses) == 19, "more than one pack's lanes"
    gradient = kernel(hexapod, poses, _core.SweepQuantity.omega_1_gradient)["omega_1_gradient"]
    step = 1e-5

    def omega_1(six):
        return fx.natural_modes(hexapod, fx.Pose.from_rpy(*six.T)).omega[:, 0]

    for i in range(6):
        d = step * np.eye(6)[i]
        rise = (8 * (omega_1(poses + d) - omega_1(poses - d)) - omega_1(poses + 2 * d) + omega_1(poses - 2 * d)) / (
            12 * step
        )
        # Differences of fourth order: step^4 times a fifth derivative, and rounding over the step.
        np.testing.assert_allclose(gradient[:, i], rise, rtol=1e-6, atol=1e-8 * np.abs(gradient).max())
    pose = fx.Pose.from_rpy(*poses.T)
    rows = np.concatenate([pose.position, pose.matrix.reshape(-1, 9)], axis=1)
    turned = kernel(hexapod, rows, _core.SweepQuantity.omega_1_gradient)["omega_1_gradient"]
    for i in range(19):
        exact = fx.frequency_sensitivity(hexapod, pose[i]).pose[0]
        measured("sweeps/gradient", apart(turned[i], exact, floor=0.1 * np.abs(exact).max()), 1e-9)


def test_pose_by_angles_or_matrix(kernel):
    """The same frequencies from 6 numbers and from 12, also after many turns."""
    hexapod = fx.load("mukherjee-i")
    poses = box(hexapod, np.random.default_rng(6), 40)
    poses[10:20, 3:] += 2 * np.pi * np.arange(10)[:, None]
    poses[20:30, 5] -= 1e5
    poses[30:, 5] += 3e7
    pose = fx.Pose.from_rpy(*poses.T)
    rows = np.concatenate([pose.position, pose.matrix.reshape(-1, 9)], axis=1)
    mask = _core.SweepQuantity.omega | _core.SweepQuantity.cond_H
    angles, matrix = kernel(hexapod, poses, mask), kernel(hexapod, rows, mask)
    ok = angles["status"] == OK
    assert ok.sum() >= 30
    condition = angles["omega"][:, 5] / angles["omega"][:, 0]
    error = np.abs(angles["omega"] / matrix["omega"] - 1).max(axis=1)
    assert np.all(error <= 200 * EPS * condition)


def test_any_threads_any_chunks_any_neighbours(kernel):
    """Bit for bit: a pose's result depends on the pose alone."""
    hexapod, rng = plain_machine("precision-positioner"), np.random.default_rng(8)
    poses = np.concatenate([box(hexapod, rng, 5001), np.tile(poses_for_accuracy(hexapod, rng), (3, 1))])
    poses[::97, 2] = np.nan
    rng.shuffle(poses)
    whole = kernel(hexapod, poses)
    for threads in (2, 5):
        assert_same_bits(kernel(hexapod, poses, threads=threads), whole, slice(None))
    order = rng.permutation(len(poses))
    assert_same_bits(kernel(hexapod, poses[order]), whole, order)
    cuts = np.unique(rng.integers(0, len(poses), 9))
    for first, last in zip([0, *cuts], [*cuts, len(poses)], strict=True):
        assert_same_bits(kernel(hexapod, poses[first:last]), whole, slice(first, last))
    for i in (0, 1, 97):
        assert_same_bits(kernel(hexapod, poses[i : i + 1]), whole, slice(i, i + 1))


def assert_same_bits(part, whole, index) -> None:
    for name, values in part.items():
        assert values.tobytes() == whole[name][index].tobytes(), name


def test_bad_poses_are_data(kernel):
    hexapod = fx.load("mukherjee-i")
    good = box(hexapod, np.random.default_rng(9), 20)
    poses = good.copy()
    poses[3, 1], poses[4, 5], poses[5, 0] = np.nan, np.inf, -np.inf
    poses[7] = [*(hexapod.base_joints[2] - hexapod.platform_joints[2]), 0, 0, 0]  # leg 3 without length
    found, clean = kernel(hexapod, poses), kernel(hexapod, good)
    expected = np.zeros(20, dtype=np.uint8)
    expected[3:6], expected[7] = NOT_FINITE, NO_LEG
    assert np.array_equal(found["status"], expected)
    for name, values in found.items():
        if name not in ("status", "within_limits"):
            assert name == "rpy" or np.isnan(values[expected > 0]).all(), name  # where it is, is not computed
            assert values[expected == 0].tobytes() == clean[name][expected == 0].tobytes(), name
    assert not found["within_limits"][expected > 0].any()


def test_leg_along_its_universal_axis(kernel):
    hexapod = fx.load("mukherjee-i")
    s = fx.force_transformation(hexapod, fx.home_pose(hexapod))[:3, 3]
    locked = hexapod.replace({"base.universal_axes[3]": s})
    home = center(hexapod)[None]
    mask = _core.SweepQuantity.omega_1 | _core.SweepQuantity.leg_length
    found = kernel(locked, home, mask, limits=limits_of(hexapod))
    assert found["status"][0] == NO_LEG
    assert np.isnan(found["omega_1"][0])


def test_singular_pose(kernel):
    """At a singular pose the lowest frequency is zero to rounding beside the highest, and the status tells."""
    hexapod = fx.load("mukherjee-ii")
    pose = near_singular(hexapod, np.random.default_rng(10), [1e17])
    found = kernel(hexapod, pose)
    assert found["status"][0] == SINGULAR
    assert found["omega_1"][0] <= 1e-12 * found["omega"][0, 5]
    assert found["cond_H"][0] > 1e13
    assert np.isnan([found["leg_force"][0], found["lowest_stiffness"][0]]).all()


def test_inertia_that_no_machine_has(kernel):
    hexapod = fx.load("mukherjee-i").replace({"legs.lower.inertia": -100 * np.eye(3)})
    found = kernel(hexapod, center(hexapod)[None])
    assert found["status"][0] == NO_INERTIA
    assert np.isnan(found["omega"]).all()
    assert np.isfinite(found["cond_H"]).all()


def test_no_pose_at_all(kernel):
    found = kernel(fx.load("mukherjee-i"), np.empty((0, 6)))
    assert found["omega"].shape == (0, 6)
    assert found["status"].shape == (0,)


# --- laws ------------------------------------------------------------------------------------------------------------


def assert_close_modes(found, expected) -> None:
    condition = expected["omega"][:, 5] / expected["omega"][:, 0]
    assert np.all(np.abs(found["omega"] / expected["omega"] - 1) <= 200 * EPS * condition[:, None])
    assert np.all(np.abs(found["cond_H"] / expected["cond_H"] - 1) <= 200 * EPS * expected["cond_H"])


def test_moving_the_world_changes_nothing(kernel):
    hexapod, rng = fx.load("mukherjee-i"), np.random.default_rng(11)
    turn, shift = Rotation.from_rotvec([0.4, -1.1, 0.7]), np.array([0.3, -0.2, 0.5])
    moved = hexapod.replace(
        {
            "gravity": turn.apply(np.array(hexapod.gravity)),
            "base.joints": turn.apply(np.array(hexapod.base_joints)) + shift,
            "base.universal_axes": turn.apply(np.array(hexapod.universal_axes)),
        }
    )
    pose = fx.Pose.from_rpy(*box(hexapod, rng, 100).T)
    carried = fx.Pose(turn.apply(np.array(pose.position)) + shift, turn.as_matrix() @ pose.matrix)
    one, other = (
        kernel(design, np.concatenate([p.position, p.matrix.reshape(-1, 9)], axis=1))
        for design, p in ((hexapod, pose), (moved, carried))
    )
    assert_close_modes(other, one)
    np.testing.assert_allclose(other["leg_length"], one["leg_length"], rtol=50 * EPS)
    np.testing.assert_allclose(other["leg_force"], one["leg_force"], rtol=200 * EPS * one["cond_H"].max())


def test_renumbering_legs_changes_nothing(kernel):
    hexapod, rng = fx.load("mukherjee-i"), np.random.default_rng(12)
    order = np.array([4, 2, 0, 5, 1, 3])
    uneven = hexapod.replace({"legs.stiffness": 2e8 * np.array([1, 1.5, 0.7, 2, 1.2, 0.9])})
    changes = {
        "base.joints": uneven.base_joints[order],
        "base.universal_axes": uneven.universal_axes[order],
        "platform.joints": uneven.platform_joints[order],
        "legs.stiffness": uneven.legs.stiffness[order],
    }
    poses = box(hexapod, rng, 100)
    one, other = kernel(uneven, poses), kernel(uneven.replace(changes), poses)
    assert_close_modes(other, one)
    assert np.array_equal(other["leg_length"], one["leg_length"][:, order])


def test_symmetric_machine_has_a_symmetric_map(kernel):
    """Three-fold symmetry: a third of a turn of the whole pose about the axis changes nothing."""
    hexapod, rng = plain_machine("precision-positioner"), np.random.default_rng(13)
    pose = fx.Pose.from_rpy(*box(hexapod, rng, 60).T)
    third = Rotation.from_rotvec([0, 0, 2 * np.pi / 3])
    turned = fx.Pose(third.apply(np.array(pose.position)), third.as_matrix() @ pose.matrix @ third.as_matrix().T)
    rows = [np.concatenate([p.position, p.matrix.reshape(-1, 9)], axis=1) for p in (pose, turned)]
    one, other = (kernel(hexapod, r) for r in rows)
    # The design's own numbers are symmetric to their rounding only, of the order of 1e-15 of its size.
    np.testing.assert_allclose(other["omega"], one["omega"], rtol=1e-12)
    np.testing.assert_allclose(other["cond_H"], one["cond_H"], rtol=1e-12)


def test_massless_legs(kernel, measured):
    """Legs without mass leave the platform on six springs: singular values of J_platform^-1/2 H K^1/2."""
    hexapod, rng = fx.load("mukherjee-i"), np.random.default_rng(14)
    part = {"mass": 0.0, "mass_center": np.zeros(3), "inertia": np.zeros((3, 3))}
    light = hexapod.replace({f"legs.{name}.{key}": value for name in ("lower", "upper") for key, value in part.items()})
    poses = box(hexapod, rng, 50)
    found = kernel(light, poses, _core.SweepQuantity.omega)["omega"]
    pose = fx.Pose.from_rpy(*poses.T)
    r = pose.matrix @ light.platform_mass_center
    shift = np.tile(np.eye(6), (50, 1, 1))  # to the mass centre, where the platform's inertia is two blocks
    shift[:, 3:, :3] = -np.cross(np.eye(3), r[:, None, :])
    values, axes = np.linalg.eigh(light.platform_inertia)
    H = shift @ fx.force_transformation(light, pose)
    top = H[:, :3] / np.sqrt(light.platform_mass)
    bottom = (np.swapaxes(pose.matrix @ axes, 1, 2) @ H[:, 3:]) / np.sqrt(values)[:, None]
    B = np.concatenate([top, bottom], axis=1) * np.sqrt(light.legs.stiffness)
    expected = np.linalg.svd(B, compute_uv=False)[:, ::-1]
    measured("sweeps/massless", (found / expected - 1) / (EPS * (expected[:, 5] / expected[:, 0])[:, None]), 200)


# --- choice of the kernel ---------------------------------------------------------------------------------------------


def test_unknown_instruction_set_is_refused():
    environment = {**os.environ, "FLEXAPOD_SIMD": "avx1024"}
    run = subprocess.run(
        [sys.executable, "-c", "import flexapod._core"], env=environment, capture_output=True, text=True, check=False
    )
    assert run.returncode != 0
    assert "FLEXAPOD_SIMD is 'avx1024'" in run.stderr
    assert "baseline" in run.stderr


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"threads": 0}, "threads is 0"),
        ({"poses": np.zeros((3, 5))}, "poses must have"),
        ({"leg_length": np.zeros(3)}, "leg_length"),
    ],
)
def test_wrong_call_is_refused(change, words):
    hexapod = fx.load("mukherjee-i")
    given = {"poses": np.zeros((3, 6)), "threads": 1} | limits_of(hexapod) | change
    poses, threads = given.pop("poses"), given.pop("threads")
    with pytest.raises(ValueError, match=words):
        _core.sweep(hexapod.packed, _core.Joint.universal, poses, ALL, _core.SweepLimits(**given), threads)
