"""The stepped sine on the non-linear machine against the tangent, a settled run, a fitted run from rest, and laws."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.states import CENTER

import flexapod as fx
from flexapod.linear import AXES
from flexapod.trajectory import Method, Run, integrate

II = fx.Pose(CENTER["mukherjee-ii"])
STRONG = {"legs.damping.prismatic": 2e5, "legs.damping.universal": 3.0, "legs.damping.spherical": 2.0}


@pytest.fixture(scope="module")
def paper():
    return fx.load("mukherjee-ii")


def apart(dataset) -> np.ndarray:
    """Distance of the non-linear response from the tangent's, all outputs together."""
    difference = np.linalg.norm(dataset.response - dataset.linear, axis=1)
    return difference / np.linalg.norm(dataset.linear, axis=1)


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_small_motion_is_the_tangents(paper, axis, joint):
    # Away from resonances (492, 493, 762, 8635, 16159, 16208 rad/s). What remains is of the order of the amplitude
    # squared over the leg's length squared, 1e-9, and the tolerance of shooting, 1e-7.
    found = fx.stepped_sine(paper, II, [100.0, 430.0, 550.136, 700.0, 900.0], 1e-6, axis, joint=joint)
    assert (found.status == "found").all()
    assert apart(found).max() < 1e-6
    each = np.abs(found.response - found.linear) / np.abs(found.linear)
    assert each.max() < 1e-3  # every single output, though some are 1e-4 of the largest


def test_linear_is_the_transmissibility(paper):
    omega = [200.0, 600.0]
    found = fx.stepped_sine(paper, II, omega, 1e-6, "pitch")
    expected = fx.transmissibility(paper, II, omega).absolute.sel(base="pitch")
    np.testing.assert_array_equal(found.linear, expected)
    np.testing.assert_array_equal(found.ratio, np.abs(found.response))
    np.testing.assert_array_equal(found.harmonics.sel(harmonic=1), found.ratio)


def test_difference_from_the_tangent_grows_with_the_amplitude_squared(paper):
    """Three amplitudes: the fundamental of a motion x has no second-order part, so it differs by x^2."""
    amplitude = np.array([2.5e-5, 5e-5, 1e-4])
    steps = [fx.stepped_sine(paper, II, [550.136, 755.0], a, "z") for a in amplitude]
    differences = np.array([np.linalg.norm(d.response - d.linear, axis=1) for d in steps])
    assert (differences[-1] > 1e-7).all()  # well above the tolerance of 1e-7 of a motion that is about 1
    order = np.log(differences[1:] / differences[:-1]) / np.log(2)
    # The next term is of fourth order: a hundredth of the second where the difference is a hundredth.
    np.testing.assert_allclose(order, 2.0, atol=0.02)
    second = [np.linalg.norm(d.harmonics.sel(harmonic=2), axis=1) for d in steps]
    np.testing.assert_allclose(np.log2(second[1:] / np.array(second[:-1])), 1.0, atol=0.02)  # per amplitude


def test_peaks_lie_at_the_tangents_damped_frequencies(paper):
    poles = fx.linearise(paper, II).modes().pole
    for mode, output in ((0, "x"), (1, "y"), (2, "yaw")):
        damped = poles[mode].imag
        # 0.01 % apart; so small an amplitude that the motion of some 1e4 times it stays small beside a leg
        omega = damped * (1 + np.arange(-10, 11) * 1e-4 + 3e-6)
        found = fx.stepped_sine(paper, II, omega, 1e-9, "z")
        assert (found.status == "found").all()
        peak = float(found.omega[int(found.ratio.sel(output=output).argmax())])
        assert abs(peak / damped - 1) < 1e-3
        assert abs(peak / damped - 1) < 1e-4  # in fact the nearest frequency of the grid


def settled(hexapod, omega: float, amplitude: float, axis: str) -> np.ndarray:
    """Complex response (6,) per amplitude of a run from rest, in the last of so many periods that all else died out."""
    slowest = -fx.linearise(hexapod, II).modes().pole.real.max()
    periods = int(np.ceil(25 / slowest * omega / (2 * np.pi)))  # e^-25 is 1e-11
    period = 2 * np.pi / omega
    times = (periods + np.arange(64) / 64) * period
    run = Run(hexapod, II, base_motion=fx.harmonic(axis, amplitude, omega))
    x = integrate([run], times, method=Method(rtol=1e-11), motions=False).displacement[0]
    return 1j * np.exp(-1j * omega * times) @ x * 2 / 64 / amplitude


@pytest.mark.parametrize("omega", [300.0, 492.5, 1500.0])
def test_with_strong_damping_it_is_what_a_long_run_settles_to(paper, omega):
    hexapod = paper.replace(STRONG)
    for amplitude in (1e-6, 1e-4):
        found = fx.stepped_sine(hexapod, II, [omega], amplitude, "x")
        expected = settled(hexapod, omega, amplitude, "x")
        size = np.linalg.norm(expected)
        np.testing.assert_allclose(found.response[0], expected, atol=3e-7 * size)  # tolerance of shooting, and e^-25
        nonlinear = np.linalg.norm(found.response[0] - found.linear[0])
        assert amplitude < 1e-5 or nonlinear > 1e-6 * size  # the larger one tells the model from its tangent


def test_with_the_papers_friction_it_is_the_driven_part_of_a_run_from_rest(paper):
    """A transient of 1/e in minutes: fitted together with the driven motion by least squares over a second."""
    omega, amplitude = 550.136, 1e-6
    times = np.linspace(0.0, 1.0, 20001)
    run = Run(paper, II, base_motion=fx.harmonic("z", amplitude, omega))
    x = integrate([run], times, method=Method(rtol=1e-11), motions=False).displacement[0]
    rates = np.append(1j * omega, fx.linearise(paper, II).modes().pole)
    waves = np.exp(np.outer(times, rates))
    fitted = np.linalg.lstsq(np.hstack([waves.real, -waves.imag]), x, rcond=None)[0]
    driven = (fitted[0] + 1j * fitted[7]) * 1j / amplitude
    found = fx.stepped_sine(paper, II, [omega], amplitude, "z")
    # The fit leaves the motion's second-order part, 1e-5 of it, which is nearly orthogonal to what is fitted.
    np.testing.assert_allclose(found.response[0], driven, atol=1e-6 * np.abs(driven).max())


def test_what_it_finds_is_periodic(paper):
    """A large motion, started on what was found, comes back: checked on the second period, with another tolerance."""
    found = fx.stepped_sine(paper, II, [640.0], 3e-4, "x", tolerance=1e-9)
    assert apart(found)[0] > 1e-5
    omega = 640.0
    harmonics = settle_start(paper, found, omega)
    times = np.concatenate([[0.0], 2 * np.pi / omega * (1 + np.arange(64) / 64)])
    run = Run(paper, II, base_motion=fx.harmonic("x", 3e-4, omega), start=harmonics)
    x = integrate([run], times, method=Method(rtol=1e-12), motions=False).displacement[0, 1:]
    again = 1j * np.exp(-1j * omega * times[1:]) @ x * 2 / 64 / 3e-4
    # Only the fundamental is started with: the rest of the motion, 1e-3 of it, is left out of the start.
    np.testing.assert_allclose(again, found.response[0], atol=0.02 * np.abs(found.response[0]).max())


def settle_start(hexapod, found, omega: float) -> fx.Motion:
    """The fundamental's state at the start of a period."""
    x = np.asarray(found.response[0]) * found.attrs["amplitude"]
    turned = Rotation.from_rotvec(x.imag[3:]).as_matrix() @ II.matrix
    rate = (1j * omega * x).imag
    return fx.Motion(fx.Pose(II.position + x.imag[:3], turned), rate[:3], rate[3:])


def test_too_large_a_motion_is_data_and_the_rest_completes(paper):
    resonance = fx.linearise(paper, II).modes().pole[2].imag
    found = fx.stepped_sine(paper, II, [550.0, resonance], 1e-3, "yaw")
    assert list(found.status.values) == ["found", "too_large"]
    assert np.isnan(found.ratio[1]).all()
    assert np.isfinite(found.ratio[0]).all()


def test_frequencies_do_not_know_one_another(paper):
    many = fx.stepped_sine(paper, II, np.linspace(500, 700, 7), 1e-6, "y")
    one = fx.stepped_sine(paper, II, [many.omega.values[3]], 1e-6, "y")
    # Products of many small matrices at once round otherwise than of one.
    np.testing.assert_allclose(many.response[3], one.response[0], atol=1e-12)


def test_progress_ends_at_one(paper):
    seen: list[float] = []
    fx.stepped_sine(paper, II, [500.0, 600.0], 1e-6, "z", progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"omega": []}, fx.ArgumentError, "non-empty"),
        ({"omega": [-1.0]}, fx.ArgumentError, "negative"),
        ({"omega": [np.nan]}, fx.ArgumentError, "nan"),
        ({"omega": [0.0, 1.0]}, fx.ArgumentError, "zero"),
        ({"axis": "up"}, fx.ArgumentError, "'up'"),
        ({"amplitude": 0.0}, fx.ArgumentError, "amplitude"),
        ({"amplitude": np.nan}, fx.ArgumentError, "amplitude"),
        ({"pose": fx.Pose([[0, 0, 0.08]])}, fx.PoseError, "batch"),
        ({"joint": "ball"}, fx.PoseError, "'ball'"),
    ],
)
def test_bad_arguments(paper, change, error, message):
    arguments = {"pose": II, "omega": [500.0], "amplitude": 1e-6, "axis": "z"} | change
    with pytest.raises(error, match=message):
        fx.stepped_sine(paper, **arguments)
