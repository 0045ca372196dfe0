"""Damped modes beside undamped ones: by what moves, followed from no gravity and no friction to all of both."""

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment
from tests.helpers.plain import file, plain_machine
from tests.helpers.support import MACHINES, away

import flexapod as fx
from flexapod.mechanics.at_rest import pose_state
from flexapod.mechanics.linearisation import DampedModes
from flexapod.mechanics.modes import NaturalModes

HEAVY = plain_machine("cubic-isolator").replace({"platform.mass": 200})
TILTED = fx.Pose.from_rpy(0.004, 0, 0.0346, 0, 2, 0, degrees=True)


def followed(hexapod, pose, steps=200):
    """For each undamped mode the damped one that it becomes as gravity and friction grow: an independent pairing."""
    square, shape, order = None, None, np.arange(6)
    for share in np.linspace(0, 1, steps + 1):
        changes = {"gravity": share * hexapod.gravity}
        changes |= {
            f"legs.damping.{name}": share * getattr(hexapod.legs.damping, name)
            for name in ("prismatic", "universal", "spherical")
        }
        linear = fx.linearise(hexapod.replace(changes), pose)
        modes = linear.modes()
        if shape is not None:
            near = np.abs(shape.conj().T @ linear.M @ modes.shape)
            _, step = linear_sum_assignment(-near)
            order = step[order]
        square, shape = modes.pole**2, modes.shape
    assert square is not None
    return order


def test_pairs_are_those_that_growing_gravity_leads_to():
    pairs = fx.mechanics.pair_modes(fx.natural_modes(HEAVY, TILTED), fx.linearise(HEAVY, TILTED).modes())
    assert pairs.damped.tolist() == followed(HEAVY, TILTED).tolist() == [2, 0, 1, 4, 3, 5]
    assert (pairs.overlap > 0.8).all()


def test_among_repeated_modes_the_one_that_moves_alike():
    """At home x, y and z have one frequency; heave stays, and x and y are what falls over."""
    state = pose_state(HEAVY)
    tangent = state.tangent
    assert [mode.dominant for mode in state.descriptions[:3]] == ["y", "x", "z"]
    growing = tangent.pairs.beside(tangent.modes.pole.real > 0)
    assert growing.tolist() == [1, 1, 0, 0, 0, 0]
    assert tangent.pairs.overlap[2] == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("name", MACHINES)
def test_without_gravity_and_friction_every_mode_is_its_own(name):
    hexapod = plain_machine(name).replace({"gravity": [0, 0, 0], "legs.damping": None})
    pose = away(hexapod)
    pairs = fx.mechanics.pair_modes(fx.natural_modes(hexapod, pose), fx.linearise(hexapod, pose).modes())
    assert pairs.damped.tolist() == list(range(6))
    assert pairs.overlap == pytest.approx(1, abs=1e-9)
    assert not pairs.alone


def test_a_mode_that_is_like_none_stands_alone():
    """Two undamped modes are mixed with a third in equal parts: none of them has half of either."""
    omega = np.array([1.0, 2, 3, 4, 5, 6])
    mixed = np.eye(6, dtype=complex)
    mixed[:3, :3] = np.exp(2j * np.pi / 3 * np.outer(range(3), range(3))) / np.sqrt(3)
    pairs = fx.mechanics.pair_modes(NaturalModes(omega, np.eye(6)), DampedModes(1j * omega, omega, 0 * omega, mixed))
    assert pairs.damped.tolist() == [-1, -1, -1, 3, 4, 5]
    assert pairs.alone == [0, 1, 2]
    assert np.isnan(pairs.beside(omega)[:3]).all()


def test_mixtures_of_repeated_modes_are_no_strangers():
    omega = np.array([1.0, 1.0001, 3, 4, 5, 6])
    turn = np.eye(6, dtype=complex)
    turn[:2, :2] = np.array([[1, 1], [1, -1]]) / np.sqrt(2)
    pairs = fx.mechanics.pair_modes(NaturalModes(omega, np.eye(6)), DampedModes(1j * omega, omega, 0 * omega, turn))
    assert pairs.damped.tolist() == list(range(6))
    assert pairs.overlap == pytest.approx(1)


def test_two_real_poles_of_one_mode_are_one_mode():
    """Overdamped along all directions: each of the six modes keeps its slower pole, and none is told twice."""
    hexapod = plain_machine("cubic-isolator").replace({"gravity": [0, 0, 0], "legs.damping": None})
    linear = fx.linearise(hexapod)
    omega, shape = fx.natural_modes(hexapod)
    over = np.array([1.2, 1.5, 1.1, 3.0, 1.0001, 2.0])  # damping ratios: poles -omega (ratio -+ sqrt(ratio^2 - 1))
    left = linear.M @ shape
    damped = fx.mechanics.Linearisation(
        **{**vars(linear), "C": left @ np.diag(2 * over * omega) @ left.T, "K": left @ np.diag(omega**2) @ left.T}
    ).modes()
    assert (damped.pole.imag == 0).all()
    slower = np.sort(omega * (over - np.sqrt(over**2 - 1)))
    assert np.sort(-damped.pole.real) == pytest.approx(slower, rel=1e-6)


@pytest.mark.parametrize("name", MACHINES)
def test_undamped_machines_have_damping_ratios_of_zero(name):
    hexapod = plain_machine(name).replace({"legs.damping": None})
    for pose in (away(hexapod), away(hexapod, 0.01)):
        modes = fx.linearise(hexapod, pose).modes()
        vibrates = modes.pole.imag > 0
        assert (modes.damping_ratio[vibrates] == 0).all()
        assert not np.signbit(modes.damping_ratio[vibrates]).any()


def test_a_machine_that_tips_over_says_how():
    state = pose_state(HEAVY, TILTED)
    assert state.stability == "falls over"
    first = state.cautions[0]
    assert first.code == "unstable"
    assert "tips over in roll" in first.text
    assert "tips over in pitch" in first.text
    assert first.numbers == {"modes": 2, "growth": state.tangent.modes.pole.real.max()}
    preload = next(one for one in state.cautions if one.code == "preload")  # of a mode that vibrates: heave
    mode = preload.numbers["mode"] - 1
    assert state.tangent.modes.pole[state.tangent.pairs.damped[mode]].imag > 0


def test_heave_that_falls_is_a_fall_along_z():
    """Legs that lie flat cannot hold the weight they are loaded with: the platform snaps through along z."""
    flat = fx.Hexapod.from_circles(
        1.0, 0.5, 0.1, platform_mass=5000.0, platform_inertia=[5e3, 5e3, 5e3], stiffness=1e6,
        base_half_angle=10, platform_half_angle=10, degrees=True, damping=100.0,
    )  # fmt: skip
    first = pose_state(flat).cautions[0]
    assert "falls away along z" in first.text


@pytest.mark.parametrize("name", ["motion-base", "precision-positioner"])
def test_a_singular_pose_is_one_thing_everywhere(name, result):
    hexapod = plain_machine(name)
    six = [*fx.home_pose(hexapod).position, 0.0, 0.0, 90.0]
    state = pose_state(hexapod, fx.Pose.from_rpy(*six[:3], 0, 0, np.pi / 2))
    assert (state.stability, state.condition, state.modes.omega[0], state.tangent) == ("singular", np.inf, 0, None)
    modes, check = (result(command, file(name), "--pose", *six) for command in ("modes", "check"))
    assert modes["stability"] == check["stability"] == "singular"
    assert modes["omega_rad_s"][0] == modes["stability_index_rad_s"] == 0
    assert modes["condition_number"] == check["condition_number"]
    assert modes["warnings"][0] == check["singularity"][0] == state.cautions[0].text
    pytest.importorskip("starlette")
    from flexapod.web.state import snapshot

    shown = snapshot(hexapod, six)
    assert (shown["stability"], shown["index"], shown["condition"]) == ("singular", 0, np.inf)
    assert np.isnan(shown["strain"][0]).all()


def test_a_sweep_tells_a_singular_pose_as_the_others_do():
    hexapod = plain_machine("precision-positioner")
    six = np.array([*fx.home_pose(hexapod).position, 0, 0, 0.0])
    poses = np.stack([six, six])
    poses[1, 5] = np.pi / 2
    found = fx.workspace.summarise(fx.sweep(hexapod, poses, quantities=["omega_1", "cond_H"]))
    assert (found.worst.omega_1, found.worst.cond_H) == (0.0, np.inf)
    assert found.best.omega_1 == pytest.approx(fx.stability_index(hexapod), rel=1e-12)
