"""Published numbers with complete data, each to the digits its source prints."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.support import apart
from tests.oracles.exact import natural_frequencies

import flexapod as fx

# --- natural frequencies of the paper's manipulator II at (0, 0, 0.085) ---------------------------------------------

UPRIGHT = fx.Pose([0.0, 0.0, 0.085])
MASSLESS = {"legs.lower": None, "legs.upper": None}
TABLE = {
    "as read, spin_free": ({}, "spin_free", [492.233, 493.049, 761.408, 8636.400, 16141.207, 16233.745]),
    "as read, universal": ({}, "universal", [492.239, 493.119, 762.076, 8634.964, 16158.869, 16208.143]),
    "r_u0 of manipulator I": (
        {"legs.upper.mass_center": [-0.6, -0.08, 0.08]},
        "spin_free",
        [485.996, 489.707, 750.441, 8689.980, 15923.983, 16749.283],
    ),
    "M = 400": (
        {"platform.mass": 400.0},
        "spin_free",
        [119.656, 119.933, 727.679, 1103.613, 14505.732, 14576.578],
    ),
    "massless legs": (MASSLESS, "universal", [1226.969, 1229.873, 9819.538, 16564.807, 67114.551, 67248.287]),
}


@pytest.mark.parametrize("row", TABLE)
def test_frequencies_of_manipulator_two(row, measured):
    changes, joint, printed = TABLE[row]
    hexapod = fx.load("mukherjee-ii").replace(changes)
    omega = fx.natural_modes(hexapod, UPRIGHT, joint=joint).omega
    # One unit of the third printed decimal: 50-digit arithmetic gives 119.655489 and 67248.286464 where the table has
    # 119.656 and 67248.287.
    measured("published/appendix", omega - printed, 1e-3)
    exact = [float(w) for w in natural_frequencies(hexapod, UPRIGHT, joint)]
    measured("published/appendix-digits", apart(omega, exact), 1e-12)
    assert fx.stability_index(hexapod, UPRIGHT, joint=joint) == omega[0]
    measured("published/condition", fx.condition_number(hexapod, UPRIGHT) - 136.7985, 5.001e-5)


def test_massless_legs_have_one_joint_model():
    hexapod = fx.load("mukherjee-ii").replace(MASSLESS)
    both = [fx.natural_modes(hexapod, UPRIGHT, joint=joint).omega for joint in ("universal", "spin_free")]
    np.testing.assert_array_equal(*both)


# --- compliance of a 20 N/um hexapod (Dehaeze, stewart-simscape, org/dynamics-study.org) ----------------------------

BODY = """
gravity = [0.0, 0.0, 0.0]
[platform]
mass = 1.0
mass_center = [0.0, 0.0, 0.0]
inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
"""


def test_compliance_at_a_point(measured):
    text = f"""{BODY}
    [base.circle]
    radius_mm = 115
    angles_deg = [-10, 10, 110, 130, 230, 250]
    [platform.circle]
    radius_mm = 90
    angles_deg = [-50, 50, 70, 170, 190, -70]
    height_mm = -60           # the platform's frame is where the compliance is seen
    [legs]
    stiffness_N_per_um = 20
    """
    hexapod = fx.Hexapod.from_toml(text)
    # Without gravity and load the exact tangent is the stiffness of the legs alone.
    compliance = np.linalg.inv(fx.linearise(hexapod, fx.Pose([0, 0, 0.06 + 0.06])).K)
    translations = (np.diag(compliance)[:3] - [4.750e-8, 4.750e-8, 2.099e-8]) / 5e-12
    rotations = (np.diag(compliance)[3:] - [5.186e-6, 5.186e-6, 1.707e-6]) / 5e-10
    coupling = (compliance[[0, 1], [4, 3]] - [3.209e-7, -3.209e-7]) / 5e-11
    measured("published/compliance", [*translations, *rotations, *coupling], 1.0002)


# --- stiffness of cubic hexapods, k = 1 N/m (same author, org/cubic-configuration.org) ------------------------------

CUBES = {  # H, MO_B, Hc, FOc in mm; K_thx = K_thy, K_thz, K15 as printed
    "centre at the point": ((100, -50, 100, 50), ("0.015", "0.06", "0")),
    "point above the centre": ((100, 20, 100, 50), ("0.025", "0.06", "-0.14")),
    "lower platform": ((80, -30, 100, 50), ("0.015", "0.06", "0")),
    "larger cube": ((100, -50, 150, 60), ("0.034", "0.14", "0.02")),
}


def half_unit(printed: str) -> float:
    """Half a unit of the last printed digit, and a part in 10^9 for what rounds exactly there."""
    decimals = len(printed.partition(".")[2])
    return (0.5 + 1e-9) * 10.0**-decimals if decimals else 1e-12


@pytest.mark.parametrize("row", CUBES)
def test_stiffness_of_a_cube(row, measured):
    (height, point, cube, cube_center), (k_thx, k_thz, k_15) = CUBES[row]
    d = (cube_center - (height + point)) / 1000
    text = f"{BODY}\n[cubic]\nheight_mm = {cube}\nmiddle = 0.6\ncenter_in_base_mm = [0, 0, {cube_center}]\n"
    hexapod = fx.Hexapod.from_toml(f"{text}center_in_platform = [0, 0, {d}]\n[legs]\nstiffness = 1\n")
    K = fx.linearise(hexapod, fx.home_pose(hexapod)).K
    np.testing.assert_allclose(np.diag(K)[:3], 2, rtol=1e-14)
    for found, printed in ((K[3, 3], k_thx), (K[4, 4], k_thx), (K[5, 5], k_thz), (K[0, 4], k_15), (-K[1, 3], k_15)):
        measured("published/cube", (found - float(printed)) / half_unit(printed), 1)
    height_m = cube / 1000  # the formulas that fit every row, exactly
    expected = [1.5 * height_m**2 + 2 * d**2, 6 * height_m**2, 2 * d]
    np.testing.assert_allclose([K[3, 3], K[5, 5], K[0, 4]], expected, rtol=1e-13, atol=1e-15)


# --- leg lengths (ROBOOP, conf/stewart.conf and source/bench.cpp) ---------------------------------------------------

ROBOOP_LENGTHS = [3.0508, 3.2324, 3.2997, 3.4560, 3.5797, 3.6935]


def roboop() -> fx.Hexapod:
    text = f"""{BODY.replace("[platform]", "")}
    joints = [[0.225, 0, -0.228], [0.1125, 0.1949, -0.228], [-0.1125, 0.1949, -0.228], [-0.225, 0, -0.228],
              [-0.1125, -0.1949, -0.228], [0.1125, -0.1949, -0.228]]
    [base]
    joints = [[1.758, 2.8, -1.015], [1.6021, 3.07, -0.925], [-1.758, 2.8, -1.015], [-1.6021, 3.07, -0.925],
              [0, 2.8, 2.03], [0, 3.07, 1.85]]
    [legs]
    stiffness = 1
    """
    return fx.Hexapod.from_toml(text.replace("mass = 1.0", "[platform]\nmass = 1.0"))


def euler_pose(x, y, z, *angles) -> fx.Pose:
    return fx.Pose([x, y, z], Rotation.from_euler("ZXZ", angles))


def test_leg_lengths(measured):
    lengths = fx.inverse_kinematics(roboop(), euler_pose(0.2, 0.3, -0.4, 0.1, -1.4, 0.1))
    # One unit of the fourth decimal: the joints are printed with four, and leg 2 comes out as 3.23234 against 3.2324.
    measured("published/lengths", lengths - ROBOOP_LENGTHS, 1e-4)


def test_forward_kinematics_from_the_published_start():
    hexapod, pose = roboop(), euler_pose(0.2, 0.3, -0.4, 0.1, -1.4, 0.1)
    found = fx.forward_kinematics(
        hexapod, fx.inverse_kinematics(hexapod, pose), start=euler_pose(0.25, 0.25, -0.45, 0.07, -1.7, 0.07)
    )
    # Lengths are met to 1e-11 of 3.7 m; cond(H) of this machine, about 40, stands between lengths and pose.
    np.testing.assert_allclose(found.position, pose.position, atol=1e-9)
    np.testing.assert_allclose(found.matrix, pose.matrix, atol=1e-9)


def test_forward_kinematics_of_the_printed_lengths(measured):
    hexapod = roboop()
    found = fx.forward_kinematics(hexapod, ROBOOP_LENGTHS, start=euler_pose(0.25, 0.25, -0.45, 0.07, -1.7, 0.07))
    # The lengths are printed to 5e-5 m; the pose can be no better than that times cond(H), about 40.
    turned = euler_pose(0, 0, 0, 0.1, -1.4, 0.1).matrix
    measured("published/pose", [*(found.position - [0.2, 0.3, -0.4]), *(found.matrix - turned).ravel()], 2e-3)


def test_forward_kinematics_without_a_start():
    hexapod, pose = roboop(), euler_pose(0.2, 0.3, -0.4, 0.1, -1.4, 0.1)
    lengths = fx.inverse_kinematics(hexapod, pose)
    found = fx.forward_kinematics(hexapod, lengths)  # some assembly: the lengths have several
    np.testing.assert_allclose(fx.inverse_kinematics(hexapod, found), lengths, rtol=1e-10)
