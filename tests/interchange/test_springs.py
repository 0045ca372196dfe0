"""Springs of joints, laws and losses in files for other tools: these tools find the library's frequencies."""

import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from scipy.io import loadmat
from tests.helpers.drawn import machine
from tests.helpers.plain import file, plain_machine
from tests.helpers.support import away
from tests.interchange.test_interchange import FORMATS, opened
from tests.oracles.reduced import tangent

import flexapod as fx

BOTH = ("mjcf", "urdf")  # SDF has no springs in ball joints


def sprung(seed: int, **changes) -> fx.Hexapod:
    """A drawn machine whose joints have springs that matter, all of them different."""
    hexapod = machine(seed)
    rng = np.random.default_rng(seed)
    scale = hexapod.legs.stiffness.mean() * np.linalg.norm(hexapod.base_joints, axis=1).mean() ** 2
    joints = {
        "universal": 0.02 * scale * rng.uniform(0.5, 2, (6, 2)),
        "spherical": 0.02 * scale * rng.uniform(0.5, 2, 6),
        "torsion": 0.05 * scale * rng.uniform(0.5, 2, 6),
    }
    return hexapod.replace({"legs.joint_stiffness": joints, **changes})


@pytest.mark.parametrize("gravity", [False, True])
@pytest.mark.parametrize("kind", BOTH)
@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_frequencies_at_rest_agree(tmp_path, kind, seed, gravity):
    hexapod = sprung(seed)
    found = tangent(opened(tmp_path, kind, hexapod, hexapod.home, gravity)).omega
    if gravity:
        expected = fx.linearise(hexapod.replace({"legs.damping": None}), hexapod.home).modes().omega
    else:
        expected = fx.natural_modes(hexapod, hexapod.home).omega
    plain = fx.natural_modes(machine(seed), hexapod.home).omega
    assert np.abs(found / expected - 1).max() < 1e-8
    assert np.abs(expected / plain - 1).max() > 0.05  # the springs matter


@pytest.mark.parametrize("kind", BOTH)
@pytest.mark.parametrize("seed", [0, 1])
def test_a_machine_whose_joints_are_bent_is_at_rest(tmp_path, kind, seed):
    """Away from the rest pose the moments of the springs are the library's: no force is left."""
    hexapod = sprung(seed)
    pose = away(hexapod)
    found = tangent(opened(tmp_path, kind, hexapod, pose))
    weight = hexapod.platform_mass * np.linalg.norm(hexapod.gravity)
    size = np.linalg.norm(hexapod.base_joints, axis=1).mean()
    moment = np.abs(fx.joint_moments(hexapod, pose).bending_moment).max()
    assert moment > 0.01 * weight * size  # they are bent
    assert np.abs(found.residual / np.repeat([1, size], 3)).max() < 1e-9 * max(weight, moment / size)
    text = (tmp_path / f"machine{FORMATS[kind][0]}").read_text()
    assert "Not in this file: how the moments of bent platform joints change in large turns" in text


@pytest.mark.parametrize("kind", BOTH)
def test_damping_of_hinges_is_that_of_the_ball(tmp_path, kind):
    hexapod = sprung(2)
    found, expected = tangent(opened(tmp_path, kind, hexapod, hexapod.home)), fx.linearise(hexapod, hexapod.home)
    scale = np.sqrt(np.outer(np.diag(expected.C), np.diag(expected.C)))
    assert np.abs((found.C - expected.C) / scale).max() < 1e-8


@pytest.mark.parametrize("kind", FORMATS)
def test_universal_springs_and_laws_in_all_formats(tmp_path, kind):
    """Series springs and a law count as they do at the pose."""
    law = {"kind": "screw", "fixed": 5e7, "axial_rigidity": 2e7, "zero_length": 0.01}
    plain = plain_machine("precision-positioner")
    hexapod = plain.replace(
        {
            "legs.stiffness_law": law,
            "legs.series_stiffness": [9e7, 8e7],
            "legs.joint_stiffness": {"universal": [3000.0, 1500.0]},
            "legs.damping": None,
        }
    )
    hexapod = fx.interchange.nearest_physical(hexapod)
    found = tangent(opened(tmp_path, kind, hexapod, hexapod.home)).omega
    assert np.abs(found / fx.linearise(hexapod, hexapod.home).modes().omega - 1).max() < 1e-8
    text = (tmp_path / f"machine{FORMATS[kind][0]}").read_text()
    assert "Not in this file: legs.stiffness_law" in text


def test_sdf_says_that_it_has_no_springs_in_ball_joints(tmp_path):
    file = fx.interchange.write_sdf(tmp_path / "m.sdf", sprung(0))
    assert "Not in this file: the stiffness of the platform joints (bending and torsion)" in file.read_text()
    springs = [
        axis for axis in ET.parse(file).getroot().iter("axis2") if axis.find("dynamics/spring_stiffness") is not None
    ]
    assert len(springs) == 6


def test_the_command_says_what_is_not_in_the_file(run, tmp_path):
    suspension = {"stiffness": np.diag([1e3] * 6).tolist(), "damping": np.zeros((6, 6)).tolist()}
    lossy = ("--set", "legs.loss_factor=0.02", "--set", f"suspension={{stiffness={suspension['stiffness']}}}")
    out = " ".join(
        run("export", file("cubic-isolator"), "--to", "mjcf", "--out", tmp_path / "a.xml", *lossy)[1].split()
    )
    assert "Not in the file: loss factors" in out
    assert "the suspension." in out
    state = run("export", file("cubic-isolator"), "--to", "mat", "--out", tmp_path / "a.mat", *lossy, "--json")[1]
    assert [words.split(" (")[0] for words in json.loads(state)["left_out"]] == ["loss factors"]
    assert "loss factors" in str(loadmat(tmp_path / "a.mat")["left_out"])
    assert (
        "Not in the file" not in run("export", file("cubic-isolator"), "--to", "mjcf", "--out", tmp_path / "b.xml")[1]
    )


def test_files_of_machines_without_springs_hold_none(tmp_path):
    file = fx.interchange.write_mjcf(tmp_path / "m.xml", machine(0))
    hinges = [joint for joint in ET.parse(file).getroot().iter("joint") if joint.get("type") == "hinge"]
    assert all("stiffness" not in joint.attrib for joint in hinges)
    assert "Not in this file" not in file.read_text()


def test_smaller_units_of_mass_are_those_of_the_springs_too(tmp_path):
    """A machine of some millimetres, which MuJoCo takes in g or mg: the joints' springs are scaled as the legs' are."""
    small, light = 2e-3, 1e-9
    plain = sprung(1)
    joints = plain.legs.joint_stiffness
    parts = {
        f"legs.{name}": {
            "mass": light * part.mass,
            "mass_center": small * part.mass_center,
            "inertia": light * small**2 * part.inertia,
        }
        for name, part in (("lower", plain.legs.lower), ("upper", plain.legs.upper))
    }
    hexapod = plain.replace(
        {
            "gravity": [0, 0, 0],
            "base.joints": small * plain.base_joints,
            "platform.joints": small * plain.platform_joints,
            "platform.mass": light * plain.platform_mass,
            "platform.mass_center": small * plain.platform_mass_center,
            "platform.inertia": light * small**2 * plain.platform_inertia,
            "home.position": small * plain.home.position,
            "legs.stiffness": light * plain.legs.stiffness,
            "legs.damping": None,
            "legs.joint_stiffness.universal": light * small**2 * joints.universal,
            "legs.joint_stiffness.spherical": light * small**2 * joints.spherical,
            "legs.joint_stiffness.torsion": light * small**2 * joints.torsion,
            **parts,
        }
    )
    with pytest.warns(UserWarning, match="MuJoCo takes no moments of inertia as small"):
        found = tangent(opened(tmp_path, "mjcf", hexapod, hexapod.home, False)).omega
    assert np.abs(found / fx.natural_modes(hexapod, hexapod.home).omega - 1).max() < 1e-6
