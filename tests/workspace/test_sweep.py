"""`fx.sweep`: the numbers of the single-pose functions, as a Dataset; laws of mechanics; bad poses are data."""

import time

import numpy as np
import pytest
import xarray as xr
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.conventions import AXES
from flexapod.workspace.quantities import QUANTITIES, evaluate

I = fx.load("mukherjee-i")
BASE = plain_machine("motion-base")
BOX = fx.Box.about(fx.home_pose(I), 0.08, 0.15)


def status(found, word):
    codes = found.status.attrs["flag_values"]
    return int(codes[found.status.attrs["flag_meanings"].split().index(word)])


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize("name", fx.packaged_designs())
def test_every_quantity_is_that_of_the_single_pose_function(name, joint):
    design = plain_machine(name)
    reach = np.ptp(design.base_joints, axis=0).max()
    box = fx.Box.about(fx.home_pose(design), 0.05 * reach, 0.1)
    found = fx.sweep(design, fx.random_poses(box, 37), quantities=QUANTITIES, joint=joint)
    pose = fx.Pose.from_rpy(*(found[name].values for name in AXES))
    omega = fx.natural_modes(design, pose, joint=joint).omega
    angles = fx.joint_angles(design, pose)
    stiffness = design.legs.stiffness
    H = fx.force_transformation(design, pose)
    moments = fx.joint_moments(design, pose, joint=joint)
    compliance = np.linalg.inv((H * stiffness) @ np.swapaxes(H, -1, -2))[..., :3, :3]
    expected = {
        "omega": omega,
        "omega_1": omega[:, 0],
        "cond_H": fx.condition_number(design, pose),
        "leg_length": fx.inverse_kinematics(design, pose),
        "universal_angle": angles.universal,
        "spherical_angle": angles.spherical,
        "leg_distance": fx.mechanics.leg_distance(design, pose),
        "leg_force": np.abs(fx.inverse_dynamics(design, pose, joint=joint)).max(axis=1),
        "lowest_stiffness": 1 / np.linalg.eigvalsh(compliance)[:, -1],
        "universal_moment": np.linalg.norm(moments.universal_moment, axis=-1),
        "spherical_moment": np.abs(moments.bending_moment),
        "leg_compression": fx.inverse_dynamics(design, pose, joint=joint).max(axis=1),
        "leg_tension": -fx.inverse_dynamics(design, pose, joint=joint).min(axis=1),
        "within_limits": fx.check_limits(design, pose).ok,
    }
    assert set(expected) == set(QUANTITIES)
    assert (found.status == 0).all()
    for quantity, values in expected.items():
        # eps times cond(H), here below 1e3, with room for the oracles' own rounding; angles near zero are arc cosines
        # of numbers near one, good to the root of eps
        close = {"atol": 1e-7} if "angle" in quantity else {"rtol": 1e-11, "atol": 0}
        assert np.allclose(found[quantity].values, values, **close), quantity
    assert set(found.data_vars) == {*QUANTITIES, "status"}


def test_dataset_tells_units_and_provenance():
    found = fx.sweep(I, fx.random_poses(BOX, 5, seed=3), quantities=("omega", "leg_force"), joint="spin_free")
    assert found.omega.dims == ("pose", "mode")
    assert found.omega.attrs["units"] == "rad/s"
    assert found.leg_force.attrs["units"] == "N"
    assert found.yaw.attrs["units"] == "rad"
    assert found.attrs["design_digest"] == I.digest
    assert found.attrs["joint"] == "spin_free"
    assert found.attrs["source"] == f"flexapod {fx.__version__}"
    assert '"seed": 3' in found.attrs["poses"]
    assert found.status.attrs["flag_meanings"].split()[:4] == ["ok", "singular", "no_leg", "not_finite"]


def test_axes_of_a_grid_are_dimensions():
    found = fx.sweep(I, fx.pose_grid(x=[0.0, 0.1, 0.2], y=0.2, z=[0.8, 0.9]))
    assert found.omega_1.dims == ("x", "z")
    assert float(found.y) == 0.2
    one = fx.stability_index(I, fx.Pose.from_rpy(0.1, 0.2, 0.9))
    assert float(found.omega_1.sel(x=0.1, z=0.9)) == pytest.approx(one, rel=1e-12)


def test_a_batch_of_poses_keeps_its_axes():
    rows = fx.random_poses(BOX, 6).rows(0, 6)
    pose = fx.Pose.from_rpy(*rows.T.reshape(6, 2, 3))
    found = fx.sweep(I, pose)
    assert found.omega_1.shape == (2, 3)
    assert np.allclose(found.omega_1.values.ravel(), fx.sweep(I, rows).omega_1, rtol=1e-12)
    assert np.allclose(found.pitch.values.ravel(), rows[:, 4], atol=1e-15)
    assert fx.sweep(I, rows.reshape(3, 2, 6)).omega_1.shape == (3, 2)


def test_threads_change_nothing():
    poses = fx.random_poses(BOX, 10_001)
    one, three = (fx.sweep(I, poses, quantities=("omega", "cond_H"), threads=n) for n in (1, 3))
    assert one.identical(three)


def test_a_bad_pose_is_data():
    rows = fx.random_poses(BOX, 40).rows(0, 40)
    rows[7, 2] = np.nan
    rows[8, 5] = np.inf
    rows[9] = 0.0
    rows[9, :3] = I.base_joints[0] - I.platform_joints[0]  # leg 1 has no length
    found = fx.sweep(I, rows)
    assert found.status.values[[7, 8, 9]].tolist() == [status(found, "not_finite")] * 2 + [status(found, "no_leg")]
    assert np.isnan(found.omega_1.values[[7, 8, 9]]).all()
    rest = np.delete(np.arange(40), [7, 8, 9])
    assert (found.status.values[rest] == 0).all()
    assert np.array_equal(found.omega_1.values[rest], fx.sweep(I, rows[rest]).omega_1)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"region": np.full((3, 6), np.nan)}, "all 3 poses hold NaN"),
        ({"region": np.zeros((0, 6))}, "empty"),
        ({"quantities": ("omega_2",)}, "quantity is 'omega_2'; it must be one of 'omega_1'"),
        ({"quantities": "condition_number"}, "no quantity 'condition_number'. Did you mean 'cond_H'?"),
        ({"region": BOX, "samples": 0}, "samples is 0"),
        ({"quantities": ()}, "no quantity"),
        ({"joint": "loose"}, "joint is 'loose'"),
        ({"threads": 0}, "threads is 0"),
    ],
)
def test_bad_arguments_are_told(arguments, words):
    wrong_poses = not isinstance(arguments.get("region", BOX), fx.Box)
    with pytest.raises(fx.PoseError if wrong_poses else fx.ArgumentError) as caught:
        fx.sweep(I, **{"region": fx.random_poses(BOX, 5), **arguments})
    assert words in str(caught.value)


def moved(design, poses, turn, shift):
    """The design and its poses as seen from a world turned by `turn` and moved by `shift`."""
    base = design.base_joints @ turn.T + shift
    changes = {
        "gravity": (turn @ design.gravity).tolist(),
        "base.joints": base.tolist(),
        "base.universal_axes": (design.universal_axes @ turn.T).tolist(),
    }
    return design.replace(changes), fx.Pose(poses.position @ turn.T + shift, turn @ poses.matrix)


def test_moving_the_world_changes_nothing():
    rows = fx.random_poses(BOX, 50).rows(0, 50)
    poses = fx.Pose.from_rpy(*rows.T)
    turn = fx.Pose.from_rpy(0, 0, 0, 0.7, -0.4, 1.1).matrix
    names = ("omega", "cond_H", "leg_length", "leg_force", "lowest_stiffness", "leg_distance")
    here, there = (
        fx.sweep(I, poses, quantities=names),
        fx.sweep(*moved(I, poses, turn, np.array([0.3, -0.2, 0.5])), quantities=names),
    )
    for name in names:  # coordinates of about 1 m are rounded anew: eps times cond(H), with room
        assert np.allclose(here[name], there[name], rtol=1e-10, atol=0), name


def test_renumbering_the_legs_changes_nothing():
    order = [3, 1, 5, 0, 2, 4]
    changes = {
        "base.joints": I.base_joints[order].tolist(),
        "base.universal_axes": I.universal_axes[order].tolist(),
        "platform.joints": I.platform_joints[order].tolist(),
    }
    poses = fx.random_poses(BOX, 50)
    names = ("omega", "cond_H", "leg_length", "leg_force")
    one, other = fx.sweep(I, poses, quantities=names), fx.sweep(I.replace(changes), poses, quantities=names)
    assert np.array_equal(one.leg_length.values[:, order], other.leg_length.values)
    for name in ("omega", "cond_H", "leg_force"):
        assert np.allclose(one[name], other[name], rtol=1e-10, atol=0), name


def test_a_symmetric_machine_has_a_symmetric_map():
    """Mirrored in the plane y = 0, motion-base is itself; so is its index, with y, roll and yaw turned over."""
    mirror = np.array([1.0, -1.0, 1.0])
    for joints in (BASE.base_joints, BASE.platform_joints):
        gaps = np.linalg.norm(joints[:, None] * mirror - joints[None], axis=-1)
        assert gaps.min(axis=1).max() < 1e-12
    rows = fx.random_poses(fx.Box.about(fx.home_pose(BASE), 0.2, 0.2), 200).rows(0, 200)
    mirrored = rows * [1, -1, 1, -1, 1, -1]
    one, other = (
        fx.sweep(BASE, rows, quantities=("omega", "cond_H")),
        fx.sweep(BASE, mirrored, quantities=("omega", "cond_H")),
    )
    assert np.allclose(one.omega, other.omega, rtol=1e-10, atol=0)
    assert np.allclose(one.cond_H, other.cond_H, rtol=1e-10, atol=0)


def test_massless_legs_leave_the_platform_on_springs():
    """Then J_p is the platform's own inertia and omega^2 are the eigenvalues of J_p^-1 H K H^T."""
    design = I.replace({"legs.lower": None, "legs.upper": None})
    rows = fx.random_poses(BOX, 20).rows(0, 20)
    pose = fx.Pose.from_rpy(*rows.T)
    r = pose.matrix @ design.platform_mass_center
    S = np.zeros((20, 3, 3))
    S[:, 0, 1], S[:, 0, 2], S[:, 1, 2] = -r[:, 2], r[:, 1], -r[:, 0]
    S -= np.swapaxes(S, 1, 2)
    m, own = design.platform_mass, pose.matrix @ design.platform_inertia @ np.swapaxes(pose.matrix, 1, 2)
    J = np.block([[np.broadcast_to(m * np.eye(3), (20, 3, 3)), -m * S], [m * S, own - m * S @ S]])
    H = fx.force_transformation(design, pose)
    square = np.linalg.eigvals(np.linalg.solve(J, (H * design.legs.stiffness) @ np.swapaxes(H, 1, 2)))
    expected = np.sqrt(np.sort(square.real, axis=1))
    assert np.allclose(
        fx.sweep(design, rows, quantities=("omega",)).omega, expected, rtol=1e-8, atol=0
    )  # eigenvalues: eps cond^2


def test_the_public_call_costs_little_more_than_the_kernel():
    """Checks in Python had made it a quarter of the kernel's rate; how near it is, the benchmark of poses says."""
    rows = fx.random_poses(BOX, 200_000).rows(0, 200_000)
    fx.sweep(I, rows[:1000])
    kernel, public = [], []
    for _ in range(7):
        start = time.perf_counter()
        evaluate(I, rows, ("omega_1", "cond_H"), "universal", 1)
        middle = time.perf_counter()
        fx.sweep(I, rows, threads=1)
        public.append(time.perf_counter() - middle)
        kernel.append(middle - start)
    assert min(kernel) / min(public) > 0.5


def test_coordinates_of_an_array_are_not_copied():
    rows = fx.random_poses(BOX, 10).rows(0, 10)
    assert np.shares_memory(fx.sweep(I, rows).x.values, rows)


@pytest.mark.parametrize("ending", [".nc", ".csv", ".parquet"])
def test_files_hold_the_numbers_and_where_they_come_from(tmp_path, ending):
    from flexapod.workspace.store.file_formats import save

    found = fx.sweep(I, fx.pose_grid(x=[0.0, 0.1], z=[0.8, 0.9, 1.0]), quantities=("omega_1", "omega", "within_limits"))
    path = tmp_path / f"sweep{ending}"
    save(found, path)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    if ending == ".nc":
        again = xr.load_dataset(path)
        assert again.omega.equals(found.omega)
        assert again.attrs["design_digest"] == I.digest
        assert again.omega.attrs["units"] == "rad/s"
        return
    import pandas

    table = pandas.read_parquet(path) if ending == ".parquet" else pandas.read_csv(path, comment="#")
    assert len(table) == 6
    titles = ["x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad", "omega_1_rad_per_s", "omega_mode_1_rad_per_s"]
    assert list(table)[:8] == titles
    assert list(table)[-2:] == ["within_limits", "status"]
    row = table[(table.x_m == 0.1) & (table.z_m == 0.9)]
    # CSV: pandas writes the shortest text that reads back as the same number, and reads it to an ulp by default
    assert row.omega_mode_6_rad_per_s.item() == pytest.approx(float(found.omega.sel(x=0.1, z=0.9, mode=6)), rel=1e-15)
    text = path.read_text(encoding="utf-8") if ending == ".csv" else str(_metadata(path))
    assert I.digest in text
    assert "omega rad/s" in text


def _metadata(path):
    import pyarrow.parquet

    return pyarrow.parquet.read_schema(path).metadata
