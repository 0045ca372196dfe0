"""Random forces and moments on the platform: closed forms of one mass, the Lyapunov equation, sources that add up."""

import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov
from tests.vibration.test_frequency_response import vertical_mass

import flexapod as fx

MACHINE = fx.load("cubic-isolator").replace({"legs.damping.prismatic": 20.0})
HOME = fx.home_pose(MACHINE)
AT, TOLD = np.array([0.02, -0.03, 0.05]), np.array([-0.04, 0.01, 0.1])


@pytest.mark.parametrize("damping", [320.0, 0.32, 3.2e-6])
def test_a_white_force_on_one_mass_has_the_closed_form(damping):
    """Mean square pi G / (2 c k), with G one-sided per rad/s: pi S / (c k) with the two-sided density S."""
    hexapod, pose, m, c, k = vertical_mass(damping)
    natural, level = np.sqrt(k / m), 2.5
    band = [1e-5 * natural, 1e5 * natural]
    load = fx.vibration.RandomLoad([level, level], omega=band, axis="force_z")
    found = fx.random_response(hexapod, pose, loads=load)
    expected = np.sqrt(np.pi * level / (2 * c * k))
    left_out = 2e-5 * c / np.sqrt(k * m)  # of the mean square, below the band
    assert float(found.rms_displacement.sel(output="z")) == pytest.approx(expected, rel=1e-9 + left_out)
    assert float(found.rms_relative.sel(output="z")) == float(found.rms_displacement.sel(output="z"))


def test_a_loss_factor_alone_has_its_closed_form():
    """Integral of dw / |k (1 + i eta) - m w^2|^2 over w > 0 = pi Re(1/sqrt(1 + i eta)) / (2 eta w_0^3 m^2)."""
    hexapod, pose, m, _, k = vertical_mass(0.0)
    natural, eta, level = np.sqrt(k / m), 1e-3, 4.0
    band = [1e-6 * natural, 1e6 * natural]
    expected = np.sqrt(level * np.pi * (1 / np.sqrt(1 + 1j * eta)).real / (2 * eta * natural**3 * m**2))
    load = fx.vibration.RandomLoad([level, level], omega=band, axis="force_z")
    for given in ({"loss_factor": eta}, {}):
        machine = hexapod if given else hexapod.replace({"legs.loss_factor": eta})
        found = fx.random_response(machine, pose, loads=load, **given)
        assert float(found.rms_displacement.sel(output="z")) == pytest.approx(expected, rel=1e-6)


def lever(machine, point):
    """The motion of a point from that of the reference point, from the definition of a small rotation."""
    r = HOME.matrix @ point
    T = np.eye(6)
    for k in range(3):
        T[:3, 3 + k] = np.cross(np.eye(3)[k], r)
    return T


def lyapunov(machine, density, at, told):
    """RMS displacement of one point for a white wrench at another, one-sided density (6, 6) per rad/s."""
    linear = fx.linearise(machine, HOME)
    M, C, K = linear.M, linear.C, linear.K
    root = np.sqrt(np.abs(np.linalg.eigvals(np.linalg.solve(M, K))).max())  # rates in units that make A even
    A = np.block([[np.zeros((6, 6)), root * np.eye(6)], [-np.linalg.solve(M, K) / root, -np.linalg.solve(M, C)]])
    B = np.vstack([np.zeros((6, 6)), np.linalg.solve(M, lever(machine, at).T) / root])
    P = solve_continuous_lyapunov(A, -np.pi * B @ density @ B.T)[:6, :6]
    T = lever(machine, told)
    return np.sqrt(np.diag(T @ P @ T.T))


@pytest.mark.parametrize("joints", [0.0, 0.5])
def test_rms_at_another_point_is_that_of_the_lyapunov_equation(joints):
    machine = MACHINE.replace({"legs.joint_stiffness.universal": joints, "legs.damping.universal": 1e-3})
    root = np.random.default_rng(3).normal(size=(6, 6)) * np.repeat([1.0, 0.1], 3)[:, None]
    density = root @ root.T
    load = fx.vibration.RandomLoad(np.tile(density, (2, 1, 1)), omega=[1e-6, 1e9], point=AT)
    found = fx.random_response(machine, HOME, loads=load, point=TOLD)
    np.testing.assert_allclose(found.rms_displacement, lyapunov(machine, density, AT, TOLD), rtol=1e-8)
    here = fx.random_response(machine, HOME, loads=fx.vibration.RandomLoad(load.psd, omega=load.omega), point=TOLD)
    assert abs(here.rms_displacement / found.rms_displacement - 1).max() > 0.01  # the point of the load matters


def test_independent_sources_add_up_in_their_squares():
    wind = fx.excitation.flat_spectrum(3.0, 2.0, 400.0, quantity="force")
    twist = fx.excitation.flat_spectrum(0.2, 5.0, 90.0, quantity="moment")
    loads = [
        fx.vibration.RandomLoad({"force_x": wind, "moment_y": twist}, point=AT, name="wind"),
        fx.vibration.RandomLoad([1e-3, 1e-4], frequency=[1.0, 50.0], axis="moment_z", name="cable"),
    ]
    base = {"psd": fx.vc_curve("VC-A"), "axis": "z"}
    whole = fx.random_response(MACHINE, HOME, loads=loads, point=TOLD, **base)
    alone = [fx.random_response(MACHINE, HOME, loads=[load], point=TOLD) for load in loads]
    alone.insert(0, fx.random_response(MACHINE, HOME, point=TOLD, **base))
    for name in ("displacement", "relative", "acceleration", "leg_force"):
        squares = np.sum([one[f"rms_{name}"] ** 2 for one in alone], axis=0)
        np.testing.assert_allclose(whole[f"rms_{name}"] ** 2, squares, rtol=1e-8, atol=1e-12 * squares.max())
        each = np.array([one[f"rms_{name}"] for one in alone])
        np.testing.assert_allclose(whole[f"source_rms_{name}"], each, rtol=1e-8, atol=1e-12 * each.max())
        np.testing.assert_array_equal(whole[f"cumulative_{name}"][-1], whole[f"rms_{name}"])
    assert whole.source.values.tolist() == whole.attrs["sources"] == ["base", "wind", "cable"]
    assert float(whole.psd_displacement.sel(output="x").max()) > 0


def test_a_coherent_lever_is_a_force_and_its_moment():
    """A force at a point is the same force at the reference point and the moment r x F, wholly coherent."""
    omega = np.array([1.0, 1e4])
    force = np.array([0.3, -1.0, 0.5])
    there = np.zeros((2, 6, 6))
    there[:, :3, :3] = np.outer(force, force)
    wrench = np.concatenate([force, np.cross(HOME.matrix @ AT, force)])
    found = [
        fx.random_response(MACHINE, HOME, loads=fx.vibration.RandomLoad(psd, omega=omega, point=point))
        for psd, point in ((there, AT), (np.tile(np.outer(wrench, wrench), (2, 1, 1)), (0, 0, 0)))
    ]
    np.testing.assert_allclose(found[0].rms_displacement, found[1].rms_displacement, rtol=1e-9)
    np.testing.assert_allclose(found[0].rms_leg_force, found[1].rms_leg_force, rtol=1e-9)


FORCE = fx.excitation.flat_spectrum(1.0, 1.0, 100.0, quantity="force")


@pytest.mark.parametrize(
    ("loads", "words"),
    [
        ((), "psd and loads are both missing"),
        (3.0, "loads is 3.0; it must be"),
        ([3.0], "a load is 3.0; it must be a RandomLoad"),
        (fx.vibration.RandomLoad(FORCE), "the load 'load': axis is missing"),
        (fx.vibration.RandomLoad(FORCE, axis="y"), "the load 'load': axis is 'y'; it must be one of 'force_x'"),
        (fx.vibration.RandomLoad(FORCE, axis="moment_y"), "is a spectrum of force; it must be one of moment"),
        (fx.vibration.RandomLoad(fx.vc_curve("VC-A"), axis="force_y"), "is a spectrum of velocity; it must be one of force"),
        (fx.vibration.RandomLoad([1.0, 1.0], axis="force_y"), "omega is missing"),
        (fx.vibration.RandomLoad([1.0, -1.0], omega=[1.0, 2.0], axis="force_y"), "negative"),
        (fx.vibration.RandomLoad(FORCE, axis="force_y", name="base"), "psd and loads|called 'base', as the moving base"),
    ],
)  # fmt: skip
def test_wrong_loads_are_told(loads, words):
    with pytest.raises(fx.ArgumentError, match=words):
        fx.random_response(MACHINE, HOME, loads=loads)


def test_frequencies_without_a_base_and_machines_that_fall_are_refused():
    load = fx.vibration.RandomLoad(FORCE, axis="force_y")
    with pytest.raises(fx.ArgumentError, match="axis, omega and frequency belong to psd"):
        fx.random_response(MACHINE, HOME, loads=load, axis="z")
    soft = MACHINE.replace({"legs.stiffness": 5.0})
    with pytest.raises(fx.ArgumentError, match="the machine is not stable at rest"):
        fx.random_response(soft, HOME, loads=load)
    undamped = MACHINE.replace({f"legs.damping.{joint}": 0.0 for joint in ("prismatic", "universal", "spherical")})
    with pytest.raises(fx.ArgumentError, match="has no damping"):
        fx.random_response(undamped, HOME, loads=load)
    with pytest.raises(fx.ArgumentError, match="name of a load is ''"):
        fx.vibration.RandomLoad(FORCE, name="")


def test_the_command_gives_the_library_s_numbers(run, result, tmp_path):
    (tmp_path / "wind.csv").write_text("frequency [Hz],force_y [N2/Hz],moment_x [(N m)2/Hz]\n0.5,4,0.1\n20,0.5,0.01\n")
    (tmp_path / "floor.csv").write_text("frequency_hz,z\n1,1e-6\n100,1e-7\n")
    line = ["response", "cubic-isolator", "--points", 20, "--load", tmp_path / "wind.csv", "--point", 0, 0, 0.1]
    found = result(*line, "--at", 0, 0, "50mm", "--psd", tmp_path / "floor.csv", "--out", tmp_path / "here")
    machine = fx.load("cubic-isolator")
    density = np.zeros((2, 6))
    density[:, 1], density[:, 3] = [4, 0.5], [0.1, 0.01]
    load = fx.vibration.RandomLoad(density, frequency=[0.5, 20], point=(0, 0, 0.05), name="wind")
    floor = {"psd": [1e-6, 1e-7], "frequency": [1, 100], "axis": "z"}
    expected = fx.random_response(machine, loads=load, point=(0, 0, 0.1), **floor)
    for name in ("displacement", "leg_force"):
        np.testing.assert_allclose(found["random_rms"][name], expected[f"rms_{name}"], rtol=1e-9, atol=1e-15)
    wind = expected.source_rms_displacement.sel(source="wind")
    np.testing.assert_allclose(found["random_rms_by_source"]["wind"]["displacement"], wind, rtol=1e-9, atol=1e-15)
    assert (tmp_path / "here" / "random.csv").read_text().count("\n") == expected.omega.size + 1
    named = result(*line, "--at", "vane", "--psd", tmp_path / "floor.csv", "--set", "points={vane=[0,0,0.05]}")
    assert named["random_rms"] == found["random_rms"]
    code, out, _ = run(*line)
    assert code == 0
    assert "RMS by wind" in out
    assert "by source" not in out


@pytest.mark.parametrize(
    ("text", "more", "words"),
    [
        (
            "frequency_hz,y\n1,1\n2,1\n",
            [],
            "column 'y' is unknown. It must have frequency_hz and one or more of force_x",
        ),
        ("frequency_hz,force_y_m2/Hz\n1,1\n2,1\n", [], "has the unit 'm2_per_Hz'; it may be"),
        ("frequency_hz,force_y\n1,1\n2,-1\n", [], "line 3, column force_y: -1 is negative"),
        (
            "frequency_hz,force_y\n1,1\n2,1\n",
            ["--at", 0, 0, 0, "--at", 0, 0, 1],
            "--at gives 2 places for 1 load. Give one for all",
        ),
    ],
)
def test_wrong_files_are_told(run, tmp_path, text, more, words):
    (tmp_path / "wind.csv").write_text(text)
    code, _, err = run("response", "cubic-isolator", "--load", tmp_path / "wind.csv", *more)
    assert code == 2
    assert words in err


def test_modes_outside_the_band_of_a_spectrum_are_told_with_the_result():
    """By both functions, and not of a motion that only creeps, whose frequency is rounding."""
    modes = np.sort(fx.linearise(MACHINE, HOME).modes().pole.imag)[-6:] / (2 * np.pi)
    low = 0.5 * (modes[0] + modes[-1])
    load = fx.vibration.RandomLoad([1.0, 1.0], frequency=[low, 60.0], axis="force_x", name="fan")
    given = {"psd": [1e-6, 1e-6], "frequency": [0.1, 60.0], "axis": "z", "loads": load}
    missed = ", ".join(f"{f:.4g}" for f in modes[modes < low])
    law = fx.control.VelocityFeedback(0.0)
    for found in (
        fx.random_response(MACHINE, HOME, **given),
        fx.control.controlled_random_response(MACHINE, HOME, controller=law, **given),
    ):
        assert f"The spectrum of fan is from {low:.4g} to 60 Hz" in found.attrs["spectrum_caution"]
        assert f"there lie modes, at {missed} Hz" in found.attrs["spectrum_caution"]
        assert "the base" not in found.attrs["spectrum_caution"]
    pump = fx.vibration.RandomLoad([1.0, 1.0], frequency=[low, 60.0], axis="force_y", name="pump")
    twice = fx.random_response(MACHINE, HOME, loads=[load, pump]).attrs["spectrum_caution"]
    assert f"The spectra of fan and pump are from {low:.4g} to 60 Hz" in twice
    assert twice.count("there lie modes") == 1
    stiff = fx.control.ForceFeedback(26.0, leak=2.9)
    wide = fx.vibration.RandomLoad([1.0, 1.0], frequency=[0.1, 60.0], axis="force_x")
    assert not fx.control.controlled_random_response(MACHINE, HOME, controller=stiff, loads=wide).attrs[
        "spectrum_caution"
    ]
