"""Stored answers of an independent code: 24 states of both test manipulators, two joint models, the base moving."""

import json
from pathlib import Path

import numpy as np
import pytest
from tests.helpers.support import apart, relative

import flexapod as fx

CASES = json.loads((Path(__file__).parents[1] / "data" / "golden.json").read_text(encoding="utf-8"))["cases"]
NAMES = {"I": "mukherjee-i", "II": "mukherjee-ii"}


@pytest.fixture(params=CASES, ids=[f"{i}-{c['design']}-{c['joint']}" for i, c in enumerate(CASES)], scope="module")
def case(request):
    return request.param


def hexapod_of(case) -> fx.Hexapod:
    machine, mass = case["design"].split(" M=")
    return fx.load(NAMES[machine]).replace({"platform.mass": float(mass), "gravity": case["gravity"]})


def motion_of(body) -> fx.Motion:
    rates = ("velocity", "angular_velocity", "acceleration", "angular_acceleration")
    return fx.Motion(fx.Pose(body["position"], body["rotation"]), **{k: body[k] for k in rates if k in body})


def blocks(matrix):
    """Forces and moments, translations and rotations apart: they differ by orders of magnitude."""
    return [np.asarray(matrix)[rows, columns] for rows in (np.s_[:3], np.s_[3:]) for columns in (np.s_[:3], np.s_[3:])]


def test_there_are_24_states():
    assert len(CASES) == 24
    assert {case["joint"] for case in CASES} == {"universal", "spin_free"}


def test_equations_of_motion(case, measured):
    platform, base = motion_of(case["platform"]), motion_of(case["base"])
    found = fx.equations_of_motion(hexapod_of(case), platform, base=base, joint=case["joint"])
    for name in ("J_p", "J_b", "H"):
        for mine, stored in zip(blocks(getattr(found, name)), blocks(case[name]), strict=True):
            measured("motion/matrices", relative(mine, stored), 1e-10)  # promised; both codes round at about 1e-12


def test_accelerations(case, measured):
    loads = {"force": case["force_platform_frame"], "moment": case["moment_platform_frame"]}
    linear, angular = fx.forward_dynamics(
        hexapod_of(case),
        motion_of(case["platform"]),
        base=motion_of(case["base"]),
        leg_force=case["leg_force"],
        joint=case["joint"],
        **loads,
    )
    found = relative(linear, case["acceleration"]), relative(angular, case["angular_acceleration"])
    measured("motion/accelerations", found, 1e-10)  # promised


def test_leg_lengths_and_condition_number(case, measured):
    hexapod, pose, base = hexapod_of(case), motion_of(case["platform"]).pose, motion_of(case["base"]).pose
    # A length is a root of a sum of three squares of differences of numbers of its own order: a few eps.
    measured("geometry/stored", apart(fx.inverse_kinematics(hexapod, pose, base=base), case["leg_length"]), 1e-14)
    H = fx.force_transformation(hexapod, pose, base=base)
    # The smallest singular value errs by eps times the largest: relative eps times cond(H), which is below 1e3 here.
    assert np.linalg.cond(H) == pytest.approx(case["cond_H"], rel=1e-10)
    on_ground = fx.Pose(base.matrix.T @ (pose.position - base.position), base.matrix.T @ pose.matrix)
    assert fx.condition_number(hexapod, on_ground) == pytest.approx(case["cond_H"], rel=1e-10)


def test_natural_frequencies(case, measured):
    found = fx.natural_modes(
        hexapod_of(case), motion_of(case["platform"]).pose, joint=case["joint"], base=motion_of(case["base"]).pose
    )
    # Promised. The stored ones come from an eigenvalue problem, which loses eps times the square of the condition.
    measured("modes/stored", apart(found.omega, case["natural_frequency_rad_s"]), 1e-9)
