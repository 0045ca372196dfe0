"""Load cases: an equilibrium solver of our own, finite differences, telescopes by hand, and what is refused."""

import numpy as np
import pytest
from scipy.optimize import root
from scipy.spatial.transform import Rotation
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.mechanics import gravity_at

POINT = np.array([0.03, -0.02, -0.15])
AT = np.array([0.1, 0.05, 0.2])


@pytest.fixture(scope="module")
def machine():
    """A soft machine on massless legs, so that deflections are large and a page of algebra solves it."""
    return fx.Hexapod.from_circles(
        0.5, 0.3, 0.5, base_half_angle=12, platform_half_angle=9, degrees=True, platform_mass=60.0,
        platform_inertia=[2, 2, 4], stiffness=np.array([2, 3, 2.5, 2, 4, 2.2]) * 1e4, platform_mass_center=[0.02, -0.03, 0.1],
    )  # fmt: skip


def forces(machine, six, lengths, gravity, force, moment, fixed):
    """Resultant and moment about the inertial origin of all that acts on the platform, and the leg forces."""
    p, R = six[:3], Rotation.from_rotvec(six[3:]).as_matrix()
    joints = p + machine.platform_joints @ R.T
    legs = joints - machine.base_joints
    length = np.linalg.norm(legs, axis=1)
    push = machine.legs.stiffness * (lengths - length)
    on_joint = push[:, None] * legs / length[:, None]
    turned = np.eye(3) if fixed else R
    parts = [(on_joint, joints), (machine.platform_mass * gravity, p + R @ machine.platform_mass_center)]
    parts.append((turned @ force, p + R @ AT))
    total = sum(np.atleast_2d(f).sum(axis=0) for f, _ in parts)
    turning = sum(np.cross(x, f).reshape(-1, 3).sum(axis=0) for f, x in parts) + turned @ moment
    return np.concatenate([total, turning - np.cross(p, total)]), push


def settled(machine, start, *arguments):
    scale = np.array([1e3] * 3 + [3e2] * 3)
    found = root(lambda six: forces(machine, six, *arguments)[0] / scale, start, tol=1e-14)
    assert np.abs(forces(machine, found.x, *arguments)[0]).max() < 1e-7
    return found.x


@pytest.mark.parametrize("axes", ["platform", "base"])
@pytest.mark.parametrize("reference", [None, 0])
def test_equilibria_are_those_of_our_own_solver(machine, axes, reference):
    gravity = gravity_at(np.radians([90, 60, 20]), np.radians([0, 10, 40]))
    force, moment = (
        np.array([[0, 0, 0], [30.0, -20, 10], [-50, 40, 20]]),
        np.array([[0, 0, 0], [1.0, 2, -3], [5, -4, 3]]),
    )
    found = fx.load_cases(
        machine, gravity=gravity, force=force, moment=moment, at=AT, axes=axes, point=POINT, reference=reference
    )
    home = np.concatenate([machine.home.position, np.zeros(3)])
    lengths = np.linalg.norm(home[:3] + machine.platform_joints - machine.base_joints, axis=1)
    if reference == 0:
        H = fx.force_transformation(machine)
        weight = machine.platform_mass * gravity[0]
        load = np.concatenate([weight, np.cross(machine.platform_mass_center, weight)])
        lengths = lengths + np.linalg.solve(H, -load) / machine.legs.stiffness
    assert list(found.status.values) == ["ok"] * 3
    np.testing.assert_allclose(found.unstretched_length, np.tile(lengths, (3, 1)), rtol=1e-12)
    for k in range(3):
        arguments = (lengths, gravity[k], force[k], moment[k], axes == "base")
        six = settled(machine, home, *arguments)
        R = Rotation.from_rotvec(six[3:]).as_matrix()
        deflection = six[:3] + R @ POINT - machine.home.position - POINT
        np.testing.assert_allclose(found.deflection[k], deflection, atol=1e-10)
        np.testing.assert_allclose(found.rotation[k], six[3:], atol=1e-10)
        np.testing.assert_allclose(found.leg_force[k], forces(machine, six, *arguments)[1], atol=1e-5)
    if reference == 0:
        np.testing.assert_allclose(found.deflection[0], 0, atol=1e-12)


@pytest.mark.parametrize("axes", ["platform", "base"])
def test_stiffness_is_that_of_differences(machine, axes):
    """Small forces and moments at the point, that keep to the base's axes, on top of a large load."""
    gravity, force, moment = gravity_at(0.7, 0.2), np.array([40.0, -60, 30]), np.array([6.0, -8, 9])
    found = fx.load_cases(
        machine, gravity=gravity, force=force, moment=moment, at=AT, axes=axes, point=POINT
    ).isel(case=0)  # fmt: skip
    home = np.concatenate([machine.home.position, np.zeros(3)])
    lengths = found.unstretched_length.values
    arguments = (lengths, gravity, force, moment, axes == "base")
    six = settled(machine, home, *arguments)
    columns = []
    for column in np.eye(6):
        moved = []
        for sign in (1, -1):
            extra = sign * column * np.array([0.1] * 3 + [0.02] * 3)

            def residual(at, extra=extra):
                R = Rotation.from_rotvec(at[3:]).as_matrix()
                more = np.concatenate([extra[:3], extra[3:] + np.cross(R @ POINT, extra[:3])])
                return (forces(machine, at, *arguments)[0] + more) / 1e2

            at = root(residual, six, tol=1e-15).x
            R = Rotation.from_rotvec(at[3:])
            turn = (R * Rotation.from_rotvec(six[3:]).inv()).as_rotvec()
            moved.append(np.concatenate([at[:3] + R.apply(POINT), turn]))
        columns.append((moved[0] - moved[1]) / 2 / np.array([0.1] * 3 + [0.02] * 3)[np.argmax(column)])
    compliance = np.array(columns).T
    np.testing.assert_allclose(found.compliance, compliance, rtol=2e-5, atol=1e-6 * np.abs(compliance).max())
    np.testing.assert_allclose(
        found.stiffness @ found.compliance.rename(by="to", displacement="by"), np.eye(6), atol=1e-8
    )


@pytest.mark.parametrize("reference", [None, 0])
def test_derivatives_are_those_of_differences(reference):
    machine = plain_machine("precision-positioner")  # legs with mass
    given = {"gravity": gravity_at(np.radians([90, 25])), "force": [[0, 0, 0], [4.0, 3, 2]], "point": POINT / 10}
    found = fx.load_cases(machine, **given, reference=reference).isel(case=1)

    def displacement(changed):
        case = fx.load_cases(changed, **given, reference=reference).isel(case=1)
        return np.concatenate([case.deflection, case.rotation])

    def derivative(key, value, step):
        two = [displacement(machine.replace({key: value + sign * step})) for sign in (1, -1)]
        return (two[0] - two[1]) / (2 * step)

    for leg in (0, 3):
        k = machine.legs.stiffness[leg]
        expected = derivative(f"legs.stiffness[{leg}]", k, 1e-3 * k)
        got = found.deflection_by_stiffness[:, leg].values
        np.testing.assert_allclose(got, expected, rtol=1e-4, atol=1e-4 * np.abs(expected).max())
    mass = machine.platform_mass
    expected = derivative("platform.mass", mass, 1e-3 * mass)
    np.testing.assert_allclose(found.deflection_by_mass, expected, rtol=1e-4, atol=1e-4 * np.abs(expected).max())
    for axis in range(3):
        expected = derivative(f"platform.mass_center[{axis}]", machine.platform_mass_center[axis], 1e-3)
        got = found.deflection_by_mass_center[:, axis].values
        np.testing.assert_allclose(got, expected, rtol=1e-3, atol=1e-3 * np.abs(expected).max() + 1e-16)
    lengths = found.unstretched_length.values
    own = machine.replace({"gravity": given["gravity"][1]})
    two = []
    for sign in (1, -1):
        pose = fx.static_equilibrium(own, lengths + sign * 1e-7 * np.eye(6)[2], force=given["force"][1]).pose
        two.append(pose.position + pose.matrix @ (POINT / 10))
    expected = (two[0] - two[1]) / 2e-7
    np.testing.assert_allclose(found.deflection_by_leg_length[:3, 2], expected, rtol=1e-5, atol=1e-5)


def test_reactions_balance_the_weight_and_the_load():
    machine = plain_machine("motion-base")
    force = np.array([1000.0, 2000, -500])
    found = fx.load_cases(machine, gravity=gravity_at([1.2, 0.3]), force=force, axes="base")
    mass = machine.platform_mass + machine.legs.lower.mass.sum() + machine.legs.upper.mass.sum()
    on_base = found.universal_force.sum("leg").values
    np.testing.assert_allclose(on_base, mass * found.gravity.values + force, rtol=1e-9)
    by_legs = found.spherical_force.sum("leg").values
    np.testing.assert_allclose(by_legs, -machine.platform_mass * found.gravity.values - force, rtol=1e-9)


def test_gravity_of_a_tilted_base():
    """The base turned about z, then tilted about the level axis: gravity seen from it."""
    for elevation, roll in ((1.3, 0.0), (0.4, 0.9), (-0.2, -2.0)):
        tilt = Rotation.from_euler("x", elevation - np.pi / 2) * Rotation.from_euler("z", roll)
        seen = tilt.inv().apply([0, 0, -9.81])
        np.testing.assert_allclose(gravity_at(elevation, roll), seen, atol=1e-12)


def test_poses_of_cases_and_what_has_no_answer(machine):
    far = machine.home.position + np.array([0, 0, 0.01])
    poses = fx.Pose([machine.home.position, far, machine.home.position])
    found = fx.load_cases(machine, poses, force=[[0, 0, 0], [0, 0, -10.0], [0, 0, -1e7]])
    assert list(found.status.values[:2]) == ["ok", "ok"]
    assert "equilibrium" in found.status.values[2]
    assert np.isnan(found.leg_force.values[2]).all()
    assert list(found.force_within_limits.values) == [True, True, False]
    alone = fx.load_cases(machine, poses[1], force=[0, 0, -10.0])
    np.testing.assert_allclose(found.deflection[1], alone.deflection[0], rtol=1e-9)


def test_limits_of_push_and_pull(machine):
    found = fx.load_cases(machine, force=[[0, 0, -500.0], [0, 0, 1500.0]])
    push, pull = found.leg_force.max().item(), -found.leg_force.min().item()
    assert push > 0
    assert pull > 0
    for key, own, wanted in (("leg_compression", push, [False, True]), ("leg_tension", pull, [True, False])):
        limited = machine.replace({f"limits.{key}": 0.99 * own})
        assert list(fx.load_cases(limited, force=[[0, 0, -500.0], [0, 0, 1500.0]]).force_within_limits.values) == wanted


@pytest.mark.parametrize(
    ("more", "error", "words"),
    [
        ({"force": np.zeros((2, 3)), "gravity": np.zeros((3, 3))}, fx.ArgumentError, "one row, or one for each"),
        ({"pose": np.zeros((0, 6))}, fx.ArgumentError, "the same number for all, at least one"),
        ({"gravity": np.zeros((0, 3))}, fx.ArgumentError, "the same number for all, at least one"),
        ({"force": [1, 2]}, fx.ArgumentError, "force has shape"),
        ({"gravity": [0, 0, np.nan]}, fx.ArgumentError, "gravity holds NaN"),
        ({"reference": 1}, fx.ArgumentError, "number of one of 1 cases"),
        ({"reference": True}, fx.ArgumentError, "number of one of 1 cases"),
        ({"reference": np.zeros((2, 2))}, fx.ArgumentError, "number of one of 1 cases"),
        ({"axes": "world"}, fx.ArgumentError, "axes is 'world'"),
        ({"point": [0, 0]}, fx.ArgumentError, "point has shape"),
        ({"joint": "ball"}, fx.ArgumentError, "joint is 'ball'"),
    ],
)
def test_what_is_refused(machine, more, error, words):
    with pytest.raises(error, match=words):
        fx.load_cases(machine, **more)
    with pytest.raises(fx.PoseError, match="no home pose"):
        fx.load_cases(machine.replace({"home": None}))
    with pytest.raises(fx.ArgumentError, match="magnitude is -1"):
        gravity_at(1.0, magnitude=-1)
    with pytest.raises(fx.ArgumentError, match=r"elevation has shape \(2, 6\), base_roll \(2,\)"):
        gravity_at(np.zeros((2, 6)), [1, 2])


def test_derivatives_under_a_stiffness_law_and_springs_in_joints():
    """Legs of screws, whose stiffness depends on their commanded lengths, with stiff joints and springs in series."""
    machine = plain_machine("precision-positioner").replace(
        {
            "legs.stiffness": None,
            "legs.stiffness_law": {"kind": "screw", "fixed_N_per_um": 60, "axial_rigidity": 4e6, "zero_length": 0.1},
            "legs.series_stiffness_N_per_um": [94, 94],
            "legs.joint_stiffness": {"universal": 15, "spherical": 15, "torsion": 10},
        }
    )
    given = {"gravity": gravity_at(np.radians([90, 25])), "force": [[0, 0, 0], [4.0, 3, 2]], "point": POINT / 10}
    found = fx.load_cases(machine, **given, reference=0)
    np.testing.assert_allclose(found.deflection[0], 0, atol=1e-12)
    lengths = found.unstretched_length.values[1]
    own = machine.replace({"gravity": given["gravity"][1]})
    two = []
    for sign in (1, -1):
        pose = fx.static_equilibrium(own, lengths + sign * 1e-7 * np.eye(6)[2], force=given["force"][1]).pose
        two.append(pose.position + pose.matrix @ (POINT / 10))
    expected = (two[0] - two[1]) / 2e-7
    np.testing.assert_allclose(found.deflection_by_leg_length[1, :3, 2], expected, rtol=1e-5, atol=1e-5)
    mass, moved = machine.platform_mass, []
    for sign in (1, -1):
        case = fx.load_cases(machine.replace({"platform.mass": mass * (1 + sign * 1e-3)}), **given, reference=0).isel(
            case=1
        )
        moved.append(np.concatenate([case.deflection, case.rotation]))
    expected = (moved[0] - moved[1]) / (2e-3 * mass)
    np.testing.assert_allclose(found.deflection_by_mass[1], expected, rtol=1e-4, atol=1e-4 * np.abs(expected).max())
