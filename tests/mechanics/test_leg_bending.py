"""The first bending frequency of a leg: closed forms, the exact solution of stepped beams, and a long chain of masses."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import eigsh
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.mechanics.leg_bending import NEAR
from flexapod.report.studies.machine import study
from flexapod.report.study import Table

MACHINE = plain_machine("motion-base").replace(
    {"legs.lower.rod.bending_stiffness": 3.54e6, "legs.upper.rod.bending_stiffness": 2.83e5}
)
LENGTH = float(fx.inverse_kinematics(MACHINE)[0])


def exact(parts):
    """First frequency of a pinned beam in parts (length, mass for each length, bending stiffness).

    Sines and hyperbolic functions in each part, deflection, slope, moment and shear force continuous between them.
    """

    def ends(omega):
        state = np.zeros((4, 2))
        state[1, 0], state[3, 1] = 1, 1  # slope and shear force at the first pin are free
        for length, mass, bending in parts:
            k = (omega**2 * mass / bending) ** 0.25
            x = k * length
            a, b = (np.cosh(x) + np.cos(x)) / 2, (np.sinh(x) + np.sin(x)) / 2
            c, d = (np.cosh(x) - np.cos(x)) / 2, (np.sinh(x) - np.sin(x)) / 2
            p = [a, b / k, c / k**2 / bending, d / k**3 / bending]
            step = np.array(
                [
                    p,
                    [k * d, a, p[1] / bending, p[2]],
                    [k**2 * c * bending, k * d * bending, a, p[1]],
                    [k**3 * b * bending, k**2 * c * bending, k * d, a],
                ]
            )
            state = step @ state
        return np.linalg.det(state[[0, 2]])  # no deflection and no moment at the last pin

    grid = np.linspace(1.0, 2000.0, 20_000)
    signs = np.sign([ends(omega) for omega in grid])
    first = int(np.flatnonzero(np.diff(signs))[0])
    return brentq(ends, grid[first], grid[first + 1], xtol=1e-11)


def chained(parts, n=3000):
    """The same by second differences of the moment on a fine grid: a chain of masses and hinges with springs."""
    total = sum(length for length, _, _ in parts)
    h = total / n
    edges = np.cumsum([0.0, *(length for length, _, _ in parts)])
    x = h * np.arange(1, n)
    which = np.clip(np.searchsorted(edges, x) - 1, 0, len(parts) - 1)
    mass, bending = (np.array([part[i] for part in parts])[which] for i in (1, 2))
    curve = diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(n - 1, n - 1)) / h**2
    stiffness = csc_matrix(curve.T @ diags(bending) @ curve)
    return np.sqrt(eigsh(stiffness, 1, diags(mass).tocsc(), sigma=0.0)[0][0])


def in_parts(lower, upper, length=LENGTH):
    """Rods (length, mass, bending) as the parts of a beam of this length."""
    over = lower[0] + upper[0] - length
    one, other = ((mass / long, bending) for long, mass, bending in (lower, upper))
    return [
        (length - upper[0], *one),
        (over, one[0] + other[0], one[1] + other[1]),
        (length - lower[0], *other),
    ]


def test_uniform_beam_is_the_closed_form():
    rod = {"mass": 30.0, "length": LENGTH / 2, "bending_stiffness": 4e5}
    keys = {f"legs.{part}.rod.{key}": value for part in ("lower", "upper") for key, value in rod.items()}
    found = fx.mechanics.leg_bending(MACHINE.replace(keys))
    assert found.omega == pytest.approx(np.full(6, (np.pi / LENGTH) ** 2 * np.sqrt(4e5 * LENGTH / 60.0)), rel=1e-5)
    assert found.unknown == ""


@pytest.mark.parametrize(
    ("lower", "upper"),
    [
        ((1.7, 120.0, 3.54e6), (1.7, 40.0, 2.83e5)),
        ((2.2, 80.0, 1e6), (0.9, 15.0, 9e4)),
        ((2.6, 50.0, 1e6), (2.5, 40.0, 5e5)),
    ],
)
def test_stepped_beams_are_exact(lower, upper):
    names = ("length", "mass", "bending_stiffness")
    keys = {
        f"legs.{part}.rod.{key}": value
        for part, values in (("lower", lower), ("upper", upper))
        for key, value in zip(names, values, strict=True)
    }
    found = fx.mechanics.leg_bending(MACHINE.replace(keys)).omega
    parts = in_parts(lower, upper)
    assert found == pytest.approx(np.full(6, exact(parts)), rel=1e-5)
    assert chained(parts) == pytest.approx(found[0], rel=2e-3)


def test_legs_that_get_longer_bend_at_lower_frequencies():
    low, high = (fx.mechanics.leg_bending(MACHINE, [0, 0, z, 0, 0, 0]).lowest for z in (2.0, 2.9))
    assert high < 0.6 * low


def test_one_of_six():
    stiffer = MACHINE.replace({"legs.upper.rod.bending_stiffness": [2.83e5] * 5 + [2e6]})
    found = fx.mechanics.leg_bending(stiffer).omega
    assert found[:5] == pytest.approx(np.full(5, found[0]))
    assert found[5] > 1.2 * found[0]


@pytest.mark.parametrize(
    ("machine", "words"),
    [
        (plain_machine("motion-base"), r"the design gives no legs\.lower\.rod\.bending_stiffness"),
        (fx.load("mukherjee-ii"), r"the design gives no \[legs\.lower\.rod\]"),
        (MACHINE.replace({"legs.lower.mass": 100.0}), r"the design gives no \[legs\.lower\.rod\]"),
        (MACHINE.replace({"legs.upper.rod.length": 3.0}), "a rod of leg 1 is 3 m long, and the leg 2.706"),
        (MACHINE.replace({"legs.upper.rod.length": 0.5}), r"the rods of leg 1 are 2\.2 m long together"),
    ],
)
def test_what_is_not_known_is_said(machine, words):
    found = fx.mechanics.leg_bending(machine)
    assert np.isnan(found.omega).all()
    assert np.isnan(found.lowest)
    with pytest.raises(AssertionError, match=words):
        raise AssertionError(found.unknown)


def test_legs_that_do_not_meet_at_a_pose_leave_the_others_known():
    tilted = fx.mechanics.leg_bending(MACHINE.replace({"legs.upper.rod.length": 1.05}), [0, 0, 2.39, 0.1, 0, 0])
    known = np.isfinite(tilted.omega)
    assert known.any()
    assert not known.all()
    assert "long together" in tilted.unknown


def test_the_caution_names_the_leg_and_both_frequencies():
    state = fx.mechanics.pose_state(MACHINE)
    (found,) = [caution for caution in state.cautions if caution.code == "leg_bends"]
    assert found.numbers["omega"] == fx.mechanics.leg_bending(MACHINE).lowest
    assert found.numbers["omega"] < NEAR * state.modes.omega[-1] == NEAR * found.numbers["highest"]
    stiff = MACHINE.replace({f"legs.{part}.rod.bending_stiffness": 1e8 for part in ("lower", "upper")})
    assert all(caution.code != "leg_bends" for caution in fx.mechanics.pose_state(stiff).cautions)


def test_the_report_says_it_beside_mode_6():
    known = "".join(table.note for table in _frequency_tables(MACHINE))
    assert "by itself the first does at 161.94 rad/s; mode 6 is at 108.58" in known
    unknown = "".join(table.note for table in _frequency_tables(plain_machine("motion-base")))
    assert "not known: the design gives no legs.lower.rod.bending_stiffness." in unknown


def _frequency_tables(machine):
    sections = [one for one in study(fx.report.gather(machine)).sections if one.title == "Natural frequencies"]
    return [part for part in sections[0].items if isinstance(part, Table)]
