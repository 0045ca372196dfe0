"""Transmissibility and random response: closed forms, laws, python-control, a published table, brute force."""

import mpmath
import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov
from tests.helpers.plain import plain_machine
from tests.helpers.states import CENTER
from tests.helpers.support import apart

import flexapod as fx
from flexapod.conventions import AXES
from flexapod.vibration.harmonic import complex_poles, steady_response

II = fx.Pose(CENTER["mukherjee-ii"])
DAMPED = {"legs.damping.prismatic": 2000.0, "legs.damping.universal": 0.3, "legs.damping.spherical": 0.2}
NO_GRAVITY = {"gravity": [0.0, 0.0, 0.0]}


@pytest.fixture(scope="module")
def paper():
    return fx.load("mukherjee-ii")


@pytest.fixture(scope="module")
def damped(paper):
    return paper.replace(DAMPED)


def vertical_mass(damping: float = 32.0) -> tuple[fx.Hexapod, fx.Pose, float, float, float]:
    """A symmetric machine with massless legs and no gravity, whose z motion is one mass on a spring: m, c, k."""
    hexapod = plain_machine("cubic-isolator").replace(
        {**NO_GRAVITY, "legs.lower": None, "legs.upper": None, "legs.damping.prismatic": damping}
    )
    pose = fx.home_pose(hexapod)
    rise = fx.force_transformation(hexapod, pose)[2]
    return hexapod, pose, hexapod.platform_mass, damping * (rise**2).sum(), hexapod.legs.stiffness @ rise**2


# --- transmissibility ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [0.0, 0.05])
def test_one_degree_of_freedom_has_the_textbook_response(eta, measured):
    hexapod, pose, m, c, k = vertical_mass()
    omega = np.array([0.0, 1.0, 30.0, np.sqrt(k / m), 100.0, 1e4])
    response = fx.transmissibility(hexapod, pose, omega=omega, loss_factor=eta)
    leg = k * (1 + 1j * eta) + 1j * omega * c
    z = {"output": "z", "base": "z"}
    # The home pose closes the symmetry to rounding, which cond(H) of a few raises to 1e-14.
    expected = leg / (leg - m * omega**2)
    measured("frequency/textbook", apart(response.absolute.sel(z), expected), 1e-12)
    np.testing.assert_allclose(response.relative.sel(z), expected - 1, rtol=1e-12, atol=1e-14)
    compliance = 1 / (leg - m * omega**2)
    np.testing.assert_allclose(response.compliance.sel(output="z", wrench="z"), compliance, rtol=1e-12)
    # Each leg's command pushes with its spring alone; six equal commands lift by sum(rise) / sum(rise^2).
    rise = fx.force_transformation(hexapod, pose)[2]
    push = hexapod.legs.stiffness @ rise * (1 + 1j * eta) * compliance
    np.testing.assert_allclose(response.command.sel(output="z").sum("leg"), push, rtol=1e-12)
    forces = response.leg_force.sel(base="z") @ response.leg_force.leg.copy(data=np.arange(6.0) * 0 + rise)
    np.testing.assert_allclose(forces, -k * (1 + 1j * eta) * (expected - 1), rtol=1e-12, atol=1e-10 * k)


def brute_force(linear: fx.mechanics.Linearisation, omega: float, eta: float, digits: int = 40):
    """Relative motion per base motion from the matrices, in many digits."""
    with mpmath.workdps(digits):
        M, C, K, M_b, C_b, K_b = (
            mpmath.matrix(m.tolist()) for m in (linear.M, linear.C, linear.K, linear.M_b, linear.C_b, linear.K_b)
        )
        H, carry = mpmath.matrix(linear.H.tolist()), mpmath.matrix(linear.carry.tolist())
        spring = H * mpmath.diag(linear.leg_stiffness.tolist()) * H.T
        w, loss = mpmath.mpf(omega), mpmath.mpc(0, eta)
        Z = K + loss * spring + 1j * w * C - w**2 * M
        right = -(K_b - loss * spring * carry + 1j * w * C_b - w**2 * M_b) - Z * carry
        X = Z**-1 * right
        return np.array([[complex(X[i, j]) for j in range(6)] for i in range(6)])


@pytest.mark.parametrize("eta", [0.0, 0.02])
def test_general_machine_against_many_digits(damped, eta, measured):
    linear = fx.linearise(damped, fx.Pose.from_rpy(0.003, 0.002, 0.085, 0.05, 0.1, -0.05), force=[30.0, 10.0, -50.0])
    omega = np.array([3.0, 492.0, 761.0, 5000.0, 16000.0, 1e5])
    found = steady_response(linear, omega, eta).relative
    for w, X in zip(omega, found, strict=True):
        # Rounding of K is seen at low frequency, where the relative motion is of the order of omega^2.
        measured("frequency/digits", apart(X, brute_force(linear, w, eta), floor=np.abs(X).max()), 1e-9)


def test_base_moved_slowly_carries_the_platform_and_its_weight_tilts(damped):
    response = fx.transmissibility(damped, II, omega=[0.0])
    linear = fx.linearise(damped, II)
    absolute = response.absolute.values[0]
    np.testing.assert_allclose(absolute[:, :3], np.eye(6)[:, :3], atol=1e-15)
    # A tilted base under gravity is the same machine under tilted gravity: legs give by their holding forces' change.
    tilt = 1e-6
    turned = fx.Pose.from_rpy(0, 0, 0, tilt, 0, 0)
    start = fx.Pose(turned.matrix @ II.position, turned.matrix)
    settled = fx.static_equilibrium(damped, linear.rest.unstretched_length, start=start, base=turned)
    moved = np.concatenate([settled.pose.position - II.position, settled.pose.rpy]) / tilt
    assert np.abs(moved - linear.carry[:, 3]).max() > 1e-6  # there is something to see
    np.testing.assert_allclose(absolute[:, 3], moved, atol=1e-6)  # tilt itself is the relative curvature


def test_rigid_motion_with_the_base_meets_nothing_but_turned_gravity():
    """K carry + K_b has a closed form, which the response uses to keep slow motion's digits."""
    hexapod = fx.load("mukherjee-i").replace({"gravity": [1.0, 2.0, -9.0], **DAMPED})
    base, loads = fx.Pose.from_rpy(0.1, 0.05, 0.01, 0.2, 0.1, 0.1), {"force": [30, 20, 10], "moment": [1, 2, 3]}
    linear = fx.linearise(hexapod, fx.Pose.from_rpy(0.02, 0.03, 0.9, 0.1, -0.1, 0.2), base=base, **loads)
    turned = np.cross(linear.gravity, (linear.M + linear.M_b)[:, :3])
    found = linear.K @ linear.carry + linear.K_b
    rounding = 10 * 2.0**-52 * np.abs(linear.K).max()
    np.testing.assert_allclose(found, np.hstack([np.zeros((6, 3)), turned]), atol=rounding)
    carried = linear.C @ linear.carry + linear.C_b
    np.testing.assert_allclose(carried, 0.0, atol=10 * 2.0**-52 * np.abs(linear.C).max())


def test_reciprocity_and_output_points(damped, measured):
    response = fx.transmissibility(damped, II, omega=[10.0, 700.0, 9000.0], loss_factor=0.01)
    compliance = response.compliance.values
    size = np.abs(compliance).max(axis=(1, 2), keepdims=True)
    # No wrench at rest: K is symmetric, and so is the machine's compliance (Maxwell-Betti).
    measured("frequency/reciprocity", (compliance - compliance.transpose(0, 2, 1)) / size, 1e-10)
    point = np.array([0.01, -0.02, 0.03])
    away = fx.transmissibility(damped, II, omega=[10.0, 700.0, 9000.0], loss_factor=0.01, point=point)
    for name in ("absolute", "relative", "command"):
        here, there = response[name].values, away[name].values
        shifted = here[:, :3] + np.cross(here[:, 3:], point, axisa=1, axisb=0, axisc=1)
        np.testing.assert_allclose(there[:, :3], shifted, rtol=1e-12, atol=1e-12 * np.abs(shifted).max())
        np.testing.assert_array_equal(there[:, 3:], here[:, 3:])
    assert np.abs(away.compliance.values - away.compliance.values.transpose(0, 2, 1)).max() < 1e-10 * size.max()


def test_compliance_of_a_published_hexapod():
    """T. Dehaeze's stewart-simscape, dynamics study: legs of 20 N/um, compliance 60 mm above the platform joints."""
    hexapod = fx.Hexapod.from_toml("""
        gravity = [0.0, 0.0, 0.0]
        [base.circle]
        radius_mm = 115
        angles_deg = [-10, 10, 110, 130, 230, 250]
        [platform.circle]
        radius_mm = 90
        angles_deg = [-50, 50, 70, 170, 190, -70]
        [platform]
        mass = 10
        mass_center = [0, 0, 0]
        inertia = [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]
        [legs]
        stiffness_N_per_um = 20
    """)
    response = fx.transmissibility(hexapod, fx.Pose((0, 0, 0.06)), omega=[0.0], point=(0, 0, 0.06))
    C = response.compliance.values[0].real
    # Printed digits of the recomputation, half a unit of the last.
    np.testing.assert_allclose(
        np.diag(C), [4.750e-8, 4.750e-8, 2.099e-8, 5.186e-6, 5.186e-6, 1.707e-6], rtol=0.0005 / 1.707
    )
    assert C[0, 4] == pytest.approx(3.209e-7, rel=2e-4)
    assert C[1, 3] == pytest.approx(-3.209e-7, rel=2e-4)


def test_python_control_gives_the_same_frequency_response(damped, measured):
    hexapod = damped.replace(NO_GRAVITY)  # tilted gravity is what twelve states cannot hold
    omega = np.array([50.0, 492.5, 761.0, 8000.0, 20000.0])
    system = fx.linearise(hexapod, II).to_control()
    response = fx.transmissibility(hexapod, II, omega=omega)

    def block(output: str, given: str) -> np.ndarray:
        values = system(1j * omega)
        rows = [i for i, name in enumerate(system.output_labels) if name.startswith(output + "_")]
        columns = [i for i, name in enumerate(system.input_labels) if name.startswith(given + "_")]
        return np.moveaxis(values[np.ix_(rows, columns, range(omega.size))], -1, 0)

    square = omega[:, None, None] ** 2
    pairs = [
        (response.absolute, block("acceleration", "base_acceleration")),  # the same ratio for displacements
        (response.relative, block("position", "base_acceleration") * -square),
        (response.leg_force, block("leg_force", "base_acceleration") * -square),
        (response.compliance, block("position", "wrench")),
        (response.command, block("position", "leg_command")),
    ]
    for ours, theirs in pairs:
        size = np.abs(theirs).max(axis=(1, 2), keepdims=True)
        # python-control solves with states in m and m/s, 1e4 apart: cond(A) of 1e8 leaves it about 1e-8.
        measured("frequency/control", (ours.values - theirs) / size, 1e-7)


def test_sharpest_resonances_keep_their_digits(paper):
    linear = fx.linearise(paper, II)
    poles = complex_poles(linear)
    omega = poles.imag + np.array([0.0, 1.0, -2.0, 0.5, 0.0, 1.0]) * np.abs(poles.real)
    found = steady_response(linear, omega).relative
    for w, sigma, X in zip(omega, np.abs(poles.real), found, strict=True):
        # The pole's place rounds by about 2^-52 of the largest frequency squared, against the peak's width.
        shift = 3e-8 / (2 * w * sigma)
        np.testing.assert_allclose(X, brute_force(linear, w, 0.0), atol=(1e-7 + 10 * shift) * np.abs(X).max())


def test_undamped_resonance_is_infinite():
    hexapod, pose, m, _, k = vertical_mass(0.0)
    z = np.sqrt(k / m)
    omega = np.array([0.5 * z, *(z * (1 + np.arange(-8, 9) * 2.0**-52)), 2 * z])
    peak = np.abs(fx.transmissibility(hexapod, pose, omega=omega).absolute.sel(output="z", base="z").values)
    assert peak[0] == pytest.approx(4 / 3)
    assert peak[-1] == pytest.approx(1 / 3)
    assert peak[1:-1].max() > 1e12


def test_loss_factor_of_single_legs_adds_up(damped):
    one = [fx.transmissibility(damped, II, omega=[480.0], loss_factor=1e-6 * np.eye(6)[i]).absolute for i in range(6)]
    none = fx.transmissibility(damped, II, omega=[480.0]).absolute
    both = fx.transmissibility(damped, II, omega=[480.0], loss_factor=1e-6).absolute
    change = sum(each - none for each in one)
    np.testing.assert_allclose(change, both - none, atol=1e-4 * np.abs(both - none).max())  # second order: 1e-6 of peak


def test_many_frequencies_are_the_same_as_few(damped):
    omega = np.linspace(0.0, 2e4, 10001)
    many = fx.transmissibility(damped, II, omega=omega).absolute
    few = fx.transmissibility(damped, II, omega=omega[::1000]).absolute
    np.testing.assert_allclose(many[::1000], few, rtol=1e-13, atol=1e-13)


def test_dataset_names_its_units(damped):
    response = fx.transmissibility(damped, II, omega=[1.0, 2.0])
    assert response.omega.attrs["units"] == "rad/s"
    assert dict(zip(response.output.values, response.output_unit.values, strict=True))["yaw"] == "rad"
    assert list(response.wrench_unit.values) == ["N"] * 3 + ["N m"] * 3
    assert response.compliance.attrs["mixed_units"] == "output_unit/wrench_unit"
    assert response.attrs["digest"] == damped.digest


@pytest.mark.parametrize(
    ("omega", "message"),
    [
        ([], "non-empty"),
        ([1.0, -2.0], r"omega\[1\] is -2.0"),
        ([np.nan], r"omega\[0\] is nan"),
        ([np.inf], "finite"),
        ([[1.0]], "shape"),
        (["fast"], "rad/s"),
    ],
)
def test_bad_frequencies(damped, omega, message):
    with pytest.raises(fx.ArgumentError, match=message):
        fx.transmissibility(damped, II, omega=omega)


def test_bad_arguments(damped):
    with pytest.raises(fx.ArgumentError, match="loss_factor"):
        fx.transmissibility(damped, II, omega=[1.0], loss_factor=-0.1)
    with pytest.raises(fx.ArgumentError, match="loss_factor"):
        fx.transmissibility(damped, II, omega=[1.0], loss_factor=[0.1, 0.2])
    with pytest.raises(fx.PoseError, match="batch"):
        fx.transmissibility(damped, fx.Pose([[0, 0, 0.08], [0, 0, 0.09]]), omega=[1.0])
    with pytest.raises(fx.ArgumentError, match="point"):
        fx.transmissibility(damped, II, omega=[1.0], point=[[0, 0, 1], [0, 0, 2]])
    regular = plain_machine("cubic-isolator").replace({})
    flat = regular.replace(
        {"base.joints": regular.platform_joints * [2, 2, 0], "platform.joints": regular.platform_joints * [1, 1, 0]}
    )
    with pytest.raises(fx.SingularPoseError):
        fx.transmissibility(flat, fx.Pose((0, 0, 0.3)), omega=[1.0])


# --- random response -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("damping", [320.0, 0.32, 3.2e-6])
def test_white_base_acceleration_of_one_mass_has_the_closed_form(damping, measured):
    hexapod, pose, m, c, k = vertical_mass(damping)
    natural, level = np.sqrt(k / m), 2.5
    zeta = c / (2 * np.sqrt(k * m))
    low, high = 1e-5 * natural, 1e5 * natural
    found = fx.random_response(hexapod, pose, psd=[level, level], omega=[low, high], axis="z")
    # Mean square of relative displacement: pi G / (4 zeta omega^3); the band leaves out low * G / omega^4 and less.
    expected = np.sqrt(np.pi * level / (4 * zeta * natural**3))
    left_out = low / natural * zeta
    rms = float(found.rms_relative.sel(output="z"))
    measured("frequency/white", (rms / expected - 1) / (1e-9 + left_out), 1)
    legs = np.sqrt((found.rms_leg_force**2).sum())
    rise = fx.force_transformation(hexapod, pose)[2]
    stretch = np.sqrt((hexapod.legs.stiffness**2 * rise**2).sum())
    assert legs == pytest.approx(stretch * expected, rel=1e-9 + left_out)


def lyapunov(linear: fx.mechanics.Linearisation, density: np.ndarray) -> np.ndarray:
    """RMS of relative displacement for white base acceleration with the one-sided density (6, 6) per rad/s."""
    system = linear.state_space()
    scale = np.repeat([1.0, 1 / np.sqrt(np.abs(system.A).max())], 6)  # displacements against rates
    A, B = system.A * scale[:, None] / scale, system.B[:, :6] * scale[:, None]
    return np.sqrt(np.diag(solve_continuous_lyapunov(A, -np.pi * B @ density @ B.T))[:6] / scale[:6] ** 2)


@pytest.mark.parametrize("share", [1.0, 1e-3, 1e-5])
def test_rms_agrees_with_the_lyapunov_equation(paper, share, measured):
    hexapod = paper.replace({**NO_GRAVITY, **{key: share * value for key, value in DAMPED.items()}})
    rng = np.random.default_rng(5)
    root = rng.normal(size=(6, 6)) * np.repeat([1.0, 10.0], 3)[:, None]
    density = root @ root.T
    omega = [1e-6, 1e9]
    found = fx.random_response(hexapod, II, psd=np.tile(density, (2, 1, 1)), omega=omega)
    # Quadrature is good to 1e-9; the Lyapunov solver loses cond(A) eps over the damping ratio.
    expected = lyapunov(fx.linearise(hexapod, II), density)
    measured("frequency/lyapunov", apart(found.rms_relative, expected) / (1e-8 + 1e-11 / share), 1)


def test_independent_axes_one_axis_and_a_matrix_agree(damped):
    omega = np.geomspace(10, 2e4, 20)
    level = omega**-1.0
    one = fx.random_response(damped, II, psd=level, omega=omega, axis="y", of="velocity")
    six = fx.random_response(damped, II, psd=level[:, None] * np.eye(6)[1], omega=omega, of="velocity")
    np.testing.assert_array_equal(one.rms_displacement, six.rms_displacement)
    function = fx.random_response(damped, II, psd=lambda w: 1 / w, omega=omega, axis="y", of="velocity")
    np.testing.assert_allclose(function.rms_acceleration, one.rms_acceleration, rtol=1e-12)  # 1/w is a power law

    def matrix(w: np.ndarray) -> np.ndarray:
        return np.einsum("n,i,j->nij", 1 / w, np.eye(6)[1], np.eye(6)[1])

    full = fx.random_response(damped, II, psd=matrix, omega=omega, of="velocity")
    for name in ("displacement", "relative", "acceleration", "leg_force"):
        np.testing.assert_allclose(full[f"rms_{name}"], one[f"rms_{name}"], rtol=1e-10)


def test_what_the_spectrum_is_of_does_not_matter(damped):
    omega = np.geomspace(10, 2e4, 30)
    by = {
        "displacement": fx.random_response(damped, II, psd=omega**-4.0, omega=omega, axis="z", of="displacement"),
        "velocity": fx.random_response(damped, II, psd=omega**-2.0, omega=omega, axis="z", of="velocity"),
        "acceleration": fx.random_response(damped, II, psd=np.ones(30), omega=omega, axis="z"),
    }
    for name in ("displacement", "acceleration", "leg_force"):
        for found in by.values():
            np.testing.assert_allclose(found[f"rms_{name}"], by["velocity"][f"rms_{name}"], rtol=1e-12)


def test_coherent_axes_interfere(damped):
    """x and y moving together are one motion along the diagonal; opposite phases are the other diagonal."""
    omega = np.geomspace(100, 1e4, 10)
    for sign in (1, -1, 1j):
        mix = np.array([1, sign, 0, 0, 0, 0])
        density = np.broadcast_to(np.outer(mix, mix.conj()), (10, 6, 6))
        found = fx.random_response(damped, II, psd=density, omega=omega)
        H = fx.transmissibility(damped, II, omega=found.omega).absolute.values @ mix
        np.testing.assert_allclose(found.psd_acceleration, np.abs(H) ** 2, rtol=1e-10, atol=1e-13)


def test_spectra_show_every_peak_and_cumulate_to_the_rms(paper):
    found = fx.random_response(paper, II, psd=np.ones((2, 6)), omega=[100.0, 2e4])
    for pole in complex_poles(fx.linearise(paper, II)):
        assert np.abs(found.omega - pole.imag).min() <= 0.51 * abs(pole.real)
    for name in ("displacement", "leg_force"):
        np.testing.assert_array_equal(found[f"cumulative_{name}"][-1], found[f"rms_{name}"])
        assert (np.diff(found[f"cumulative_{name}"], axis=0) >= 0).all()
    assert {100.0, 2e4} <= set(found.omega.values)


def test_structural_damping_alone_has_its_closed_form(measured):
    """One mass with a loss factor: the mean square of the relative motion is an elementary integral."""
    hexapod, pose, m, _, k = vertical_mass(0.0)
    natural, eta = np.sqrt(k / m), 1e-3
    found = fx.random_response(
        hexapod, pose, psd=[1.0, 1.0], omega=[1e-6 * natural, 1e6 * natural], axis="z", loss_factor=eta
    )
    # Integral of dw / |w_0^2 (1 + i eta) - w^2|^2 from zero = pi Re(1/sqrt(1 + i eta)) / (2 eta w_0^3).
    expected = np.sqrt(np.pi / (2 * eta * natural**3) * (1 / np.sqrt(1 + 1j * eta)).real)
    measured("frequency/structural", apart(found.rms_relative.sel(output="z"), expected), 1e-6)  # band starts at 1e-6


def test_undamped_or_growing_modes_have_no_stationary_response(paper):
    free = paper.replace({f"legs.damping.{joint}": 0.0 for joint in ("prismatic", "universal", "spherical")})
    with pytest.raises(fx.ArgumentError, match=r"mode 1 .* damping"):
        fx.random_response(free, II, psd=[1.0, 1.0], omega=[100.0, 1e3], axis="z")
    below = fx.random_response(free, II, psd=[1.0, 1.0], omega=[10.0, 400.0], axis="z")
    assert np.isfinite(below.rms_displacement).all()


def test_spectra_by_axis(damped):
    """Ready-made spectra give what their numbers give, and independent axes add their mean squares."""
    floor = fx.vc_curve("VC-C")
    grid = np.geomspace(floor.omega_min, floor.omega_max, 50)
    by_name = fx.random_response(damped, II, psd=floor, axis="z")
    by_numbers = fx.random_response(damped, II, psd=floor.density(grid), omega=grid, of="velocity", axis="z")
    np.testing.assert_allclose(by_name.rms_leg_force, by_numbers.rms_leg_force, rtol=1e-10)
    below = fx.random_response(damped, II, psd=floor, omega=[floor.omega_min / 2, 100.0], axis="z")
    assert float(below.rms_acceleration.sel(output="z")) == pytest.approx(
        float(np.interp(100.0, by_name.omega, by_name.cumulative_acceleration.sel(output="z"))), rel=1e-6
    )
    both = fx.random_response(damped, II, psd={"z": floor, "x": floor})
    x = fx.random_response(damped, II, psd={"x": floor})
    np.testing.assert_allclose(both.rms_relative**2, by_name.rms_relative**2 + x.rms_relative**2, rtol=1e-10)


def test_bad_ready_made_spectra(damped):
    floor, ground = fx.vc_curve("VC-A"), fx.excitation.ground_noise()
    force = fx.excitation.flat_spectrum(1.0, 10.0, 20.0, quantity="force")
    cases = [
        ({"psd": floor}, "axis"),
        ({"psd": {"z": floor}, "axis": "z"}, "axis is 'z'"),
        ({"psd": {}}, "none"),
        ({"psd": {"up": floor}}, "'up'"),
        ({"psd": {"z": 1.0}}, "Spectrum"),
        ({"psd": {"x": floor, "z": ground}}, "acceleration and velocity"),
        ({"psd": {"z": floor}, "omega": [1e5, 1e6]}, "outside"),
        ({"psd": [1.0, 1.0], "axis": "z"}, "omega is missing"),
        ({"psd": floor, "axis": "roll"}, "in m; it must be one of rad"),
        ({"psd": {"roll": ground}}, "in m; it must be one of rad"),
        ({"psd": force, "axis": "z"}, "spectrum of force.*RandomLoad"),
        ({"psd": [1.0, 1.0], "omega": [10.0, 20.0], "axis": "z", "of": "force"}, "of is 'force'"),
    ]
    for arguments, message in cases:
        with pytest.raises(fx.ArgumentError, match=message):
            fx.random_response(damped, II, **arguments)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"omega": [1.0]}, "two frequencies"),
        ({"omega": [2.0, 1.0]}, "ascending"),
        ({"omega": [0.0, 1.0]}, "above zero"),
        ({"psd": [1.0, -1.0]}, "negative"),
        ({"psd": [1.0, np.nan]}, "NaN"),
        ({"psd": [1.0, 2.0, 3.0]}, "shape"),
        ({"axis": None}, "axis"),
        ({"axis": "up"}, "'up'"),
        ({"psd": np.ones((2, 6))}, "axis is 'z'"),
        ({"psd": ["a", "b"]}, "numbers"),
        ({"psd": 1j * np.ones((2, 6, 6)), "axis": None}, "Hermitian"),
        ({"psd": np.tile(np.ones((6, 6)) - np.eye(6), (2, 1, 1)), "axis": None}, "eigenvalue"),
        ({"of": "jerk"}, "jerk"),
    ],
)
def test_bad_spectra(damped, change, message):
    arguments = {"omega": [10.0, 100.0], "psd": [1.0, 1.0], "axis": "z"} | change
    with pytest.raises(fx.ArgumentError, match=message):
        fx.random_response(damped, II, **arguments)


def test_axes_are_the_six():
    assert AXES == ("x", "y", "z", "roll", "pitch", "yaw")
