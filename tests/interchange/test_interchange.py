"""Files for other tools, opened by these tools: the machine they hold is the library's."""

import json
import re
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.io import loadmat
from scipy.linalg import expm
from tests.helpers.drawn import machine
from tests.helpers.plain import file, plain_machine
from tests.helpers.support import MACHINES, away, center, size
from tests.oracles import loaded
from tests.oracles.reduced import tangent

import control
import flexapod as fx

DESIGNS = range(20)
FORMATS = {
    "mjcf": (".xml", fx.interchange.write_mjcf, loaded.Mujoco),
    "urdf": (".urdf", fx.interchange.write_urdf, loaded.urdf),
    "sdf": (".sdf", fx.interchange.write_sdf, loaded.sdf),
}
NO_FRICTION = {"legs.damping": None}
CORNERS = {"base": [0, 120, 240], "platform": [60, 180, 300]}  # of an octahedron, degrees


def opened(folder, kind, hexapod, pose, gravity=True):
    """The machine as the other tool has it."""
    suffix, write, read = FORMATS[kind]
    written = folder / f"machine{suffix}"
    write(written, hexapod, pose)
    return read(written, size(hexapod), gravity)


@pytest.mark.parametrize("kind", FORMATS)
def test_frequencies_of_drawn_machines_agree(tmp_path, kind):
    """The deviations that docs/interchange.md quotes; `pytest -s` prints them."""
    still, heavy = [], []
    for seed in DESIGNS:
        hexapod = machine(seed)
        pose = away(hexapod)
        natural = fx.natural_modes(hexapod, pose).omega
        undamped = fx.linearise(hexapod.replace(NO_FRICTION), pose).modes().omega
        without, under = (tangent(opened(tmp_path, kind, hexapod, pose, gravity)).omega for gravity in (False, True))
        still.append(np.abs(without / natural - 1).max())
        heavy.append(np.abs(under / undamped - 1).max())
    print(f"\n{kind}: largest deviation without gravity {max(still):.1e}, with gravity {max(heavy):.1e}")
    assert max(still) < 1e-9
    assert max(heavy) < 1e-8


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_whole_tangent_agrees_and_the_machine_is_at_rest(tmp_path, kind, seed):
    hexapod = machine(seed)
    pose = away(hexapod)
    found = tangent(opened(tmp_path, kind, hexapod, pose))
    if kind == "sdf":  # it cannot hold the friction of ball joints
        hexapod = hexapod.replace({"legs.damping.spherical": 0.0})
    expected = fx.linearise(hexapod, pose)
    for name in "MCK":
        matrix, reference = getattr(found, name), getattr(expected, name)
        scale = np.sqrt(np.outer(np.diag(reference), np.diag(reference)))
        assert np.abs((matrix - reference) / scale).max() < 1e-8, name
    weight = hexapod.platform_mass * np.linalg.norm(hexapod.gravity)
    assert np.abs(found.residual / np.repeat([1, size(hexapod)], 3)).max() < 1e-11 * weight


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("name", MACHINES)
def test_packaged_machines_agree_at_home(tmp_path, kind, name):
    hexapod = fx.interchange.nearest_physical(plain_machine(name))
    found = tangent(opened(tmp_path, kind, hexapod, center(hexapod), gravity=False)).omega
    assert found == pytest.approx(fx.natural_modes(hexapod, center(hexapod)).omega, rel=1e-8)


@pytest.mark.parametrize("kind", FORMATS)
def test_legs_that_meet_at_common_joints(tmp_path, kind):
    """An octahedron: every joint is shared by two legs."""
    corners = {plate: np.repeat(np.radians(angles), 2) for plate, angles in CORNERS.items()}
    angles = {"base.circle.angles": np.roll(corners["base"], -1), "platform.circle.angles": corners["platform"]}
    hexapod = machine(3).replace({"base.circle.radius": 0.5, "platform.circle.radius": 0.3, **angles})
    hexapod = hexapod.replace({"home.position": [0.02, 0.01, 0.6], "legs.damping": None})
    assert "Joints coincide" in hexapod.warnings[0]
    found = tangent(opened(tmp_path, kind, hexapod, hexapod.home)).omega
    expected = fx.linearise(hexapod, hexapod.home).modes().omega
    assert np.abs(found / expected - 1).max() < 1e-8


def simulated(hexapod, displacement, periods):
    """MuJoCo's motion (n, 6) after a constant wrench is put on the machine at home, the wrench, and the times."""
    pose, expected = fx.home_pose(hexapod), fx.linearise(hexapod, fx.home_pose(hexapod))
    wrench = expected.K @ displacement
    from flexapod.interchange.mjcf import mjcf

    model = mujoco.MjModel.from_xml_string(mjcf(hexapod))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    platform = model.body("platform").id
    arm = data.xipos[platform] - pose.position  # MuJoCo's external force acts at the mass centre
    data.xfrc_applied[platform] = np.concatenate([wrench[:3], wrench[3:] - np.cross(arm, wrench[:3])])
    at, step = model.joint("platform").qposadr[0], model.opt.timestep
    motion = np.empty((round(periods * 2 * np.pi / expected.modes().omega[0] / step), 6))
    matrix = np.empty(9)
    for row in motion:
        mujoco.mj_step(model, data)
        mujoco.mju_quat2Mat(matrix, data.qpos[at + 3 : at + 7])
        turn = matrix.reshape(3, 3) @ pose.matrix.T
        row[:3] = data.qpos[at : at + 3] - pose.position
        row[3:] = (turn - turn.T)[[2, 0, 1], [1, 2, 0]] / 2
    return motion, wrench, step


def test_mujoco_moves_as_the_tangent_says(tmp_path):
    """All frictions on: three periods of the lowest mode, every sample."""
    hexapod = machine(1)
    motion, wrench, step = simulated(hexapod, 1e-5 * np.repeat([size(hexapod), 1], 3), 3)
    system = fx.linearise(hexapod, fx.home_pose(hexapod)).state_space()
    forced = np.zeros((13, 13))
    forced[:12, :12], forced[:12, 12] = system.A, system.B[:, 12:18] @ wrench
    forward, state = expm(forced * step), np.eye(13)[12]
    expected = np.empty_like(motion)
    for row in expected:
        state = forward @ state
        row[:] = state[:6]
    scale = np.abs(expected).max(axis=0)
    assert np.linalg.norm((motion - expected) / scale) < 0.01 * np.linalg.norm(expected / scale)


@pytest.mark.parametrize("mode", [0, 5])
def test_a_frequency_read_off_mujocos_motion(mode):
    hexapod = machine(3).replace(NO_FRICTION)
    modes = fx.linearise(hexapod, fx.home_pose(hexapod)).modes()
    shape = modes.shape[:, mode].real
    motion, wrench, step = simulated(hexapod, 1e-5 * size(hexapod) * shape / np.abs(shape).max(), 6)
    seen = motion @ wrench
    seen -= seen.mean()
    up = np.flatnonzero((seen[:-1] < 0) & (seen[1:] >= 0))
    crossing = up - seen[up] / (seen[up + 1] - seen[up])
    found = 2 * np.pi * (up.size - 1) / ((crossing[-1] - crossing[0]) * step)
    assert up.size > 4
    assert found == pytest.approx(modes.omega[mode], rel=1e-3)


def test_legs_without_mass_can_be_simulated():
    legs = {"legs.lower": None, "legs.upper": None}
    hexapod = fx.interchange.nearest_physical(plain_machine("motion-base").replace(legs))
    motion, _, _ = simulated(hexapod, np.full(6, 1e-6), 1)
    assert np.abs(motion).max() < 1e-4  # it does not fly apart


def test_motors_push_and_limits_stop(tmp_path):
    hexapod = machine(4).replace({"limits.leg_length": [0.001, 50.0]})
    file = fx.interchange.write_mjcf(tmp_path / "m.xml", hexapod, timestep=1e-4)
    model = mujoco.MjModel.from_xml_path(str(file))
    assert model.opt.timestep == 1e-4
    data = mujoco.MjData(model)
    data.ctrl[2] = 1.0
    mujoco.mj_forward(model, data)
    slide = model.joint("leg3_slide")
    assert data.qfrc_actuator[slide.dofadr[0]] == 1.0
    assert np.count_nonzero(data.qfrc_actuator) == 1
    length = fx.inverse_kinematics(hexapod, fx.home_pose(hexapod))[2]
    assert slide.range == pytest.approx([0.001 - length, 50.0 - length], rel=1e-12)


@pytest.mark.parametrize("write", [fx.interchange.write_mjcf, fx.interchange.write_urdf, fx.interchange.write_sdf])
def test_bodies_that_do_not_exist_are_refused_with_the_remedy(tmp_path, write):
    hexapod = fx.load("mukherjee-ii")
    with pytest.raises(fx.DesignError, match=r"legs.lower of leg 1 .* -2.84e-06 kg m2.*nearest_physical"):
        write(tmp_path / "a", hexapod)
    massless = plain_machine("motion-base").replace({"legs.lower": None, "legs.upper": None})
    with pytest.raises(fx.DesignError, match="its mass is 0"):
        write(tmp_path / "a", massless)
    assert not list(tmp_path.iterdir())


def test_nearest_physical_is_near_and_changes_only_what_it_must():
    fine = machine(0)
    assert fx.interchange.nearest_physical(fine) is fine
    thin = fine.replace({"legs.upper.rod": {"mass": 1.0, "length": 0.2}})
    mended = fx.interchange.nearest_physical(thin)
    assert mended != thin
    assert mended.legs.lower == thin.legs.lower
    assert mended.legs.upper.inertia == pytest.approx(thin.legs.upper.inertia, abs=1e-8)
    assert fx.interchange.nearest_physical(mended) is mended
    pose = fx.home_pose(thin)
    assert fx.natural_modes(mended, pose).omega == pytest.approx(fx.natural_modes(thin, pose).omega, rel=1e-4)


@pytest.mark.parametrize("name", MACHINES)
def test_nearest_physical_bodies_are_solid(name):
    hexapod = fx.interchange.nearest_physical(plain_machine(name))
    assert not hexapod.warnings
    parts = [hexapod.platform_inertia, *hexapod.legs.lower.inertia, *hexapod.legs.upper.inertia]
    for a, b, c in map(np.linalg.eigvalsh, parts):
        assert 0 < a <= b <= c < a + b
    assert (hexapod.legs.lower.mass > 0).all()
    assert (hexapod.legs.upper.mass > 0).all()


def massless(size, friction=0.0):
    """A motion base of another size, of the same density, whose legs have no mass; friction: of its spherical joints."""
    given = plain_machine("motion-base")
    return given.replace(
        {
            "base.joints": given.base_joints * size,
            "platform.joints": given.platform_joints * size,
            "home.position": given.home.position * size,
            "platform.mass": given.platform_mass * size**3,
            "platform.mass_center": given.platform_mass_center * size,
            "platform.inertia": given.platform_inertia * size**5,
            "legs.stiffness": given.legs.stiffness * size,
            "limits": None,
            "legs.damping": None,
            "legs.damping.spherical": friction * size**4,
            "legs.lower": None,
            "legs.upper": None,
        }
    )


@pytest.mark.filterwarnings("ignore:MuJoCo takes no moments")
@pytest.mark.parametrize("friction", [0.0, 100.0])
@pytest.mark.parametrize("size", [1.0, 0.1, 1e-2, 1e-3, 1e-4])
def test_mujoco_takes_legs_that_had_no_mass(tmp_path, size, friction):
    """Machines of metres to tenths of millimetres, their frequencies alike, with and without sockets of friction."""
    given = massless(size, friction)
    solid = fx.interchange.nearest_physical(given)
    pose = fx.home_pose(solid)
    assert fx.natural_modes(solid).omega == pytest.approx(fx.natural_modes(given).omega, rel=1e-3)
    found = tangent(opened(tmp_path, "mjcf", solid, pose))
    expected = fx.linearise(solid, pose)
    scale = found.M[0, 0] / expected.M[0, 0]  # of the units of mass
    assert scale == pytest.approx(1000.0 ** round(np.log(scale) / np.log(1000)), rel=1e-9)
    for name in "MCK":
        matrix, reference = getattr(found, name) / scale, getattr(expected, name)
        bound = np.sqrt(np.outer(*2 * [np.diag(reference)])) if reference.any() else 1.0
        assert np.abs((matrix - reference) / bound).max() < 1e-8, name


def test_other_units_are_said_and_motors_take_newtons(tmp_path):
    small = fx.interchange.nearest_physical(massless(1e-3, 100.0))
    with pytest.warns(UserWarning, match="masses in its model are in ug and forces in nN"):
        file = fx.interchange.write_mjcf(tmp_path / "small.xml", small)
    assert "m, s, ug, nN" in file.read_text()
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    assert model.body_mass.sum() == pytest.approx(1e9 * (4e-6 + 12 * 4e-10), rel=1e-6)
    data.ctrl[2] = 2e-6  # N
    mujoco.mj_forward(model, data)
    assert data.qfrc_actuator[model.joint("leg3_slide").dofadr[0]] == pytest.approx(2e3)  # nN
    with pytest.raises(fx.DesignError, match="MuJoCo takes none below 1e-14, even with masses in pg"):
        fx.interchange.write_mjcf(tmp_path / "none.xml", fx.interchange.nearest_physical(massless(1e-5, 100.0)))


def test_names_need_no_care(tmp_path):
    hexapod = machine(5).replace({"name": 'a "b" <c>\x07 & d'})
    assert mujoco.MjModel.from_xml_path(str(fx.interchange.write_mjcf(tmp_path / "m.xml", hexapod))).nbody > 20
    file, beside = fx.interchange.write_urdf(tmp_path / "m.urdf", hexapod)
    assert loaded.pin.buildModelFromUrdf(str(file)).name == 'a "b" <c> & d'
    assert json.loads(beside.read_text())["design"] == 'a "b" <c> & d'


@pytest.mark.parametrize(
    "write", [fx.interchange.write_mjcf, fx.interchange.write_urdf, fx.interchange.write_sdf, fx.interchange.write_mat]
)
def test_what_cannot_be_written_is_said(tmp_path, write):
    hexapod = machine(6)
    with pytest.raises(fx.errors.OutputError, match="cannot be written"):
        write(tmp_path / "no" / "such" / "folder.x", hexapod)
    homeless = hexapod.replace({"home": None})
    with pytest.raises(fx.PoseError, match=r"no home pose.*\[home\]"):
        write(tmp_path / "a", homeless)
    with pytest.raises(fx.PoseError, match="batch"):
        write(tmp_path / "a", homeless, fx.Pose(np.ones((2, 3))))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "write", [fx.interchange.write_mjcf, fx.interchange.write_urdf, fx.interchange.write_sdf, fx.interchange.write_mat]
)
def test_swapped_and_wrong_arguments_are_told(tmp_path, write):
    hexapod = machine(6)
    with pytest.raises(fx.ArgumentError, match=r"path is <Hexapod.*comes before the hexapod"):
        write(hexapod, tmp_path / "a")
    with pytest.raises(fx.DesignError, match="hexapod is 'motion-base'"):
        write(tmp_path / "a", "motion-base")
    with pytest.raises(TypeError):
        write(tmp_path / "a", hexapod, None, 1e-3)
    six = [*hexapod.home.position, *hexapod.home.rpy]
    assert write(tmp_path / "a.xml", hexapod, six) == write(tmp_path / "a.xml", hexapod)
    assert len(list(tmp_path.iterdir())) <= 2


def test_a_wrong_timestep_is_refused(tmp_path):
    with pytest.raises(fx.ArgumentError, match="timestep is 0 s; it must be finite and > 0"):
        fx.interchange.write_mjcf(tmp_path / "m.xml", machine(6), timestep=0)


def test_the_state_space_comes_back_from_a_mat_file(tmp_path):
    hexapod = machine(7)
    pose = away(hexapod)
    file = fx.interchange.write_mat(tmp_path / "tangent.mat", hexapod, pose, force=[1.0, 2.0, 3.0], joint="spin_free")
    read = loadmat(file, squeeze_me=True)
    tangent = fx.linearise(hexapod, pose, force=[1.0, 2.0, 3.0], joint="spin_free")
    expected = tangent.state_space()
    for name in "ABCD":
        assert (read[name] == getattr(expected, name)).all()
    assert tuple(read["state_names"]) == expected.states
    assert tuple(read["input_names"]) == expected.inputs
    assert tuple(read["output_names"]) == expected.outputs
    assert (read["pose_position"] == pose.position).all()
    assert (read["pose_rotation"] == pose.matrix).all()
    assert (read["rest_leg_force"] == tangent.rest.leg_force).all()
    assert (str(read["design"]), str(read["digest"]), str(read["joint"])) == ("drawn", hexapod.digest, "spin_free")
    plant = control.ss(*(read[name] for name in "ABCD"), inputs=list(read["input_names"]))
    same = tangent.to_control()
    assert plant.input_labels == same.input_labels
    s = 1j * tangent.modes().omega[2]
    assert plant(s) == pytest.approx(same(s), rel=1e-12)


def test_every_signal_of_the_mat_file_has_its_unit(tmp_path):
    read = loadmat(fx.interchange.write_mat(tmp_path / "a.mat", machine(8)), squeeze_me=True)
    units = {}
    for kind in ("state", "input", "output"):
        assert len(read[f"{kind}_names"]) == len(read[f"{kind}_units"])
        units |= dict(zip(read[f"{kind}_names"], read[f"{kind}_units"], strict=True))
    assert units["position_x"] == "m"
    assert units["velocity_yaw"] == "rad/s"
    assert units["base_acceleration_roll"] == "rad/s^2"
    assert units["wrench_pitch"] == "N m"
    assert units["leg_force_3"] == "N"
    assert units["leg_command_6"] == units["leg_length_1"] == "m"
    assert all(units.values())


KINDS = {"mjcf": ["m.x"], "urdf": ["m.x", "m.loops.json"], "sdf": ["m.x"], "mat": ["m.x"]}


@pytest.mark.parametrize("kind", KINDS)
def test_export_writes_the_files(run, result, tmp_path, kind):
    out = tmp_path / "m.x"
    found = result("export", file("motion-base"), "--to", kind, "--out", out, "--set", "platform.mass=4000")
    assert found["files"] == [str(tmp_path / name) for name in KINDS[kind]]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(KINDS[kind])
    heavy = plain_machine("motion-base").replace({"platform.mass": 4000})
    assert found["omega_rad_s"] == fx.natural_modes(heavy, fx.home_pose(heavy)).omega.tolist()
    assert found["bodies_replaced"] is False
    code, text, _ = run("export", "motion-base", "--to", kind, "--out", out, "--pose", "0", "0", "2.5", "0", "5", "0")
    assert code == 0
    assert all(str(tmp_path / name) in text for name in KINDS[kind])
    assert "pitch=5" in text


def test_the_ending_of_a_file_says_its_format(run, result, tmp_path):
    for name, kind in {"m.xml": "mjcf", "m.URDF": "urdf", "m.sdf": "sdf", "m.mat": "mat"}.items():
        assert result("export", file("motion-base"), "--out", tmp_path / name)["format"] == kind
    code, _, err = run("export", "motion-base", "--out", tmp_path / "m.txt")
    assert code == 2
    assert "Give --to as well, or end it in .xml, .urdf, .sdf, .mat." in " ".join(err.split())
    code, _, err = run("export", "motion-base")
    assert code == 2
    assert "Missing option '--to'. Choose from: mjcf, urdf, sdf, mat." in " ".join(err.split())


def test_export_replaces_bodies_when_told_to(run, result, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, err = run("export", "mukherjee-ii", "--to", "mjcf")
    assert code == 2
    assert "--nearest-physical" in err
    found = result("export", "mukherjee-ii", "--to", "mjcf", "--nearest-physical")
    assert found["files"] == ["mukherjee-ii.xml"]
    assert found["bodies_replaced"] is True
    assert 0 < found["frequency_change"] < 1e-3
    assert "change by" in run("export", "mukherjee-ii", "--to", "mjcf", "--nearest-physical")[1]
    massless(1e-3, 100.0).save(tmp_path / "small.toml")
    small = ("export", str(tmp_path / "small.toml"), "--to", "mjcf", "--nearest-physical")
    assert "Warning: MuJoCo takes no moments" in run(*small)[1]
    assert "forces in nN" in result(*small)["warnings"][0]


def test_export_of_legs_that_do_not_spin(run, result, tmp_path):
    code, _, err = run("export", "motion-base", "--to", "urdf", "--joint", "spin_free", "--out", tmp_path / "a")
    assert code == 2
    assert "--joint spin_free" in err
    result("export", "motion-base", "--to", "mat", "--joint", "spin_free", "--out", tmp_path / "a.mat")
    assert str(loadmat(tmp_path / "a.mat", squeeze_me=True)["joint"]) == "spin_free"


def test_the_code_of_the_page_runs(tmp_path, monkeypatch):
    page = (Path(__file__).parents[2] / "docs" / "interchange.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    there: dict = {}
    for block in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(block, there)
    hexapod = fx.load("motion-base")
    law, x = hexapod.legs.stiffness_law, fx.hold(hexapod).unstretched_length - hexapod.legs.stiffness_law.shortest
    stiffness = law.bulk_modulus * (law.area_1 / (x + law.dead_1) + law.area_2 / (law.stroke - x + law.dead_2))
    still = hexapod.replace({"legs.stiffness": stiffness})  # as the weight leaves the oil
    assert np.sqrt(there["squares"]) == pytest.approx(fx.natural_modes(still).omega, rel=1e-9)
    assert there["plant"](1j) == pytest.approx(there["same"](1j), rel=1e-12)
