"""Closed forms and measured workspaces that others have published, in tests/data/cases."""

import json

import numpy as np
import pytest
from tests.helpers.cases import case

import flexapod as fx

# --- frequencies of symmetric machines --------------------------------------------------------------------------------

BASE_ANGLES = np.array([-12, 12, 108, 132, 228, 252])
SIGNS = np.tile([-1, 1], 3)


def symmetric(rb, rp, turn, rise, above, k, m, inertia):
    """Massless legs from a circle of radius rb to one of rp, `rise` above it, their angles apart by +-turn deg; the mass
    centre lies `above` the platform's joints."""
    return fx.load(case("closed-forms", "isotropic.toml")).replace(
        {
            "base.circle.radius": rb,
            "platform.circle.radius": rp,
            "platform.circle.angles_deg": BASE_ANGLES + SIGNS * turn,
            "platform.circle.height": -above,
            "platform.mass": m,
            "platform.inertia": np.diag(inertia),
            "legs.stiffness": k,
            "home.position": [0, 0, rise + above],
        }
    )


def closed_form(rb, rp, turn, rise, above, k, m, inertia):
    """The six frequencies by the formulas of expected.json: heave, yaw, and two planes of surge with pitch."""
    cos, sin = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    d2 = rp**2 + rb**2 - 2 * rp * rb * cos
    f = 3 * k / (d2 + rise**2)
    surge, heave, yaw = f * d2, 2 * f * rise**2, 2 * f * rp**2 * rb**2 * sin**2
    lean = rp - rb * cos
    pitch = f * (rp**2 * rise**2 + 2 * rp * rise * above * lean + above**2 * d2)
    both = -f * (above * d2 + rise * rp * lean)
    plane = np.array(
        [[surge / m, both / np.sqrt(m * inertia[0])], [both / np.sqrt(m * inertia[0]), pitch / inertia[0]]]
    )
    squares = [heave / m, yaw / inertia[2], *np.repeat(np.linalg.eigvalsh(plane), 2)]
    return np.sqrt(np.sort(squares))


MACHINES = [
    (0.4, 0.2, 60, 0.245, 0.0, 2e6, 25.0, (0.5, 0.5, 2.0)),
    (0.4, 0.2, 60, 0.245, 0.07, 2e6, 25.0, (0.5, 0.5, 0.8)),
    (0.5, 0.35, 35, 0.6, -0.05, 8e7, 140.0, (4.0, 4.0, 7.0)),
    (1.6, 1.1, 75, 2.1, 0.4, 3e6, 4000.0, (2000.0, 2000.0, 3600.0)),
]


@pytest.mark.parametrize("numbers", MACHINES)
def test_six_frequencies_of_a_symmetric_machine(numbers):
    found = fx.natural_modes(symmetric(*numbers)).omega
    np.testing.assert_allclose(found, closed_form(*numbers), rtol=1e-12)


def test_a_dynamically_isotropic_machine():
    hexapod = fx.load(case("closed-forms", "isotropic.toml"))
    np.testing.assert_allclose(fx.natural_modes(hexapod).omega, np.full(6, 400.0), rtol=1e-12)


def test_fichters_singular_pose():
    """Turned by 90 degrees about its axis from the symmetric pose, whatever its height."""
    hexapod = symmetric(*MACHINES[1]).replace({"platform.circle.angles_deg": BASE_ANGLES + SIGNS * 60})
    for rise in (0.1, 0.3, 0.7):
        pose = fx.Pose.from_rpy(0, 0, rise, yaw=90, degrees=True)
        assert fx.natural_modes(hexapod, fx.Pose(pose.position[None], pose.matrix[None])).omega[0, 0] < 1e-5
        assert fx.condition_number(hexapod, pose) > 1e12


# --- the workspace of a real machine ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def nairck():
    return fx.load(case("nairck", "nairck.toml")), json.loads(case("nairck", "expected.json").read_text())


def moving(place_mm, angles_deg):
    return fx.Pose.from_angles(np.asarray(place_mm) / 1e3, angles_deg, "XYZ", degrees=True)


def test_lengths_of_a_real_machine(nairck):
    hexapod, expected = nairck
    pose = moving(expected["pose"]["position_mm"], expected["pose"]["rpy_deg"])
    found = 1e3 * fx.inverse_kinematics(hexapod, pose)
    # The source prints angles with three decimals: 5e-4 degrees on 1.5 m.
    np.testing.assert_allclose(found, expected["lengths_mm"], atol=0.0135)
    back = fx.forward_kinematics(hexapod, np.array(expected["lengths_mm"]) / 1e3)
    np.testing.assert_allclose(1e3 * back.position, expected["pose"]["position_mm"], atol=0.02)


@pytest.mark.parametrize("kind", ["mm", "deg"])
def test_boundary_of_a_real_workspace(nairck, kind):
    """Points that its author found by bisection lie inside, and the boundary less than 0.0006 mm or degrees outside."""
    hexapod, expected = nairck
    points = np.array(expected[f"boundary_{kind}"])
    outward = points / np.linalg.norm(points, axis=1, keepdims=True)
    for step, inside in ((-1e-6, True), (0.0006, False)):  # the file's six decimals
        moved = points + step * outward
        zero = np.zeros_like(moved)
        poses = moving(moved, zero) if kind == "mm" else moving(zero, moved)
        assert (fx.check_limits(hexapod, poses).ok == inside).all()
