"""What each error of the print does: the machine's accelerations with it, beside those of an independent engine.

The engine's answers are stored (answers.py). An error is switched on as what it adds to the core's terms
(misprints.py); with none on, the core is what disagrees with the engine, by rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.linalg import eig
from scipy.spatial.transform import Rotation

from flexapod.conventions import TWO_PI, Array, JointModel
from flexapod.design.loading import load
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.modes import natural_modes
from flexapod.paper import Claim, Part, Settings, agrees
from flexapod.paper.charts import Dots, percent, rows_of_dots
from flexapod.paper.frequencies import home
from flexapod.paper.printed_errors import MISPRINTS, State, acceleration, legs_at
from flexapod.paper.reference_answers import Answer, answers, disagreement
from flexapod.paper.scatter import CASES
from flexapod.paper.vibration import PRINTED
from flexapod.plots.style import BLUE, ORANGE
from flexapod.pose import Motion, Pose
from flexapod.rotations import rpy_matrix
from flexapod.workspace.sampling import random_poses
from flexapod.workspace.sweeping import sweep

_SMALL = 1e-6  # rad, a turn as of the paper's vibrations
_LOW_MODES = 3  # where gravity shows
_POSES, _WELL_CONDITIONED = 20_000, 500.0  # over which legs that spin are compared with legs that do not
_FLOOR = 1e-17  # of a disagreement that is drawn: none


class Row(NamedTuple):
    """A correction: what is printed, what holds, and the relative disagreements (n,) with and without the error.

    shown: what disagrees. more: a sentence with further numbers.
    """

    number: str
    where: str
    printed: str
    holds: str
    shown: str
    wrong: Array
    right: Array
    more: str = ""


def draw(name: str, _: Settings) -> Part:
    """All corrections, each with a number that shows it."""
    rows = found()
    names = [f"{row.number}   {row.where}" for row in rows]
    dots = [
        Dots("as printed", [np.maximum(row.wrong, _FLOOR) for row in rows], ORANGE, "x"),
        Dots("corrected", [np.maximum(row.right, _FLOOR) for row in rows], BLUE),
    ]
    figure, ax = rows_of_dots(names, dots, "relative disagreement")
    figure.legend(*ax.get_legend_handles_labels(), loc="outside upper right", ncols=2, frameon=False)
    pieces = [pd.DataFrame({"correction": row.number, "as_printed": row.wrong, "corrected": row.right}) for row in rows]
    table = pd.concat(pieces).rename_axis("case")
    numbers = {
        row.number: {"as_printed": row.wrong.tolist(), "corrected": row.right.tolist(), "more": row.more}
        for row in rows
    }
    caption = (
        "Relative disagreement, with the error switched on and without it. E1 to E7, B: accelerations, linear or "
        "angular, whichever is farther off, against Pinocchio (the machine as a closed chain of rigid bodies), a mark "
        "for each state; in the moving states base and platform move at about 1 m/s and 1 rad/s. E8: the printed "
        "frequency against the nearest mode. C: the lowest three frequencies against those by differences of "
        "Pinocchio's accelerations."
    )
    return Part(name, "Corrections", _finished(figure), caption, numbers, _claims(rows), table, _words(rows))


def _finished(figure: Figure) -> Figure:
    figure.axes[0].set_xlim(right=50.0)
    return figure


def found() -> list[Row]:
    """Every correction with its numbers."""
    return [*_terms(), _e7(), _e8(), _spin(), _gravity()]


_PRINT = {
    "E1": ("Eqs 24, 25", "(m_d r_d² + m_u r_u²)/L · E₃", "… / L² · E₃: a mass, as Q is", "moving"),
    "E2": ("Eq. 25", "m_u (s·r_u)/L in the s sᵀ term", "2 m_u (s·r_u)/L", "moving"),
    "E3": ("Eq. 19", "U₄ ends at ω_b×(ω_b×q_b)", "and (s·U₁ + L W·W) s, the leg's lengthening", "moving"),
    "E4": ("Eq. 22", "friction C_u W", "C_u (W − ω_b): the joint lies between leg and base", "spinning base"),
    "E5": ("Eqs 32, 33", "Q_b multiplies ẗ_p, α_p", "Q_b multiplies ẗ_b, α_b, as in Eq. 34", "moving"),
    "E6": ("Eq. 2", "F = +K (L − L₀)", "F = −K (L − L₀): a stretched leg pulls", "moving"),
}
_STATES = {
    "moving": "12 moving states",
    "spinning base": "manipulator I on a base that spins with it, C_u = 2 N m s/rad",
}


def _terms() -> list[Row]:
    """E1 to E6: errors in the terms of Eq. 34."""
    extra: dict[str, Callable[[], str]] = {"E2": _mass, "E4": _braking, "E6": _growth}
    rows = []
    for number, (where, printed, holds, kind) in _PRINT.items():
        cases = answers(kind)
        more = extra[number]() if number in extra else ""
        wrong, right = _off(cases, (number,)), _off(cases)
        rows.append(Row(number, where, printed, holds, _STATES[kind], wrong, right, more))
    everything = tuple(name for name in MISPRINTS if name != "E6")
    wrong, right = _off(answers("moving"), everything), _off(answers("moving"))
    last = Row("E1–E5", "Eqs 19–33", "all five", "none of them", _STATES["moving"], wrong, right)
    return [*rows[:5], last, rows[5]]


def _off(cases: list[Answer], errors: tuple[str, ...] = (), joint: JointModel = "universal") -> Array:
    """(n,) relative disagreement of the accelerations with the engine's, linear or angular, the larger."""
    pairs = [disagreement(acceleration(case.state, errors, joint), case.engine) for case in cases]
    return np.max(pairs, axis=1)


def _mass() -> str:
    """E2: by how much Q_p - Q_b misses what a rigid translation demands."""
    state = answers("moving")[0].state
    legs = legs_at(state, "universal")
    off = np.abs(state.hexapod.legs.upper.mass * np.sum(legs.s * legs.r_u, axis=1) / legs.L)
    return (
        f"In a rigid translation the inertia of a leg of manipulator I along its axis is {off.min():.2f} to "
        f"{off.max():.2f} kg off."
    )


def _braking() -> str:
    state = answers("spinning base")[0].state
    apart = acceleration(state, ("E4",)) - acceleration(state)
    spin = float(state.base.angular_velocity[2])
    return f"At {spin:g} rad/s the platform is braked by {-apart[5]:.2f} rad/s² about z though no joint moves."


def _growth() -> str:
    hexapod = load("mukherjee-ii")
    first = natural_modes(hexapod, home(hexapod), joint="universal").omega[0]
    return (
        f"With it, manipulator II does not vibrate but leaves its equilibrium, e-fold in {1e3 / first:.1f} ms. Eq. 3 "
        "has the right sign."
    )


def _e7() -> Row:
    """Eq. 35 takes the angular velocity for the rate of the three angles."""
    (case,) = answers("carried")
    state, motion = case.state, case.state.platform
    turn = np.array(state.base.angular_velocity)  # for 1 s from upright
    as_angles = Pose(motion.pose.position, rpy_matrix(turn))
    printed = state._replace(platform=Motion(as_angles, motion.velocity, motion.angular_velocity))
    wrong, right = (max(disagreement(acceleration(at), case.engine)) for at in (printed, state))
    size = float(np.linalg.norm(turn))
    more = (
        f"After a turn of {np.degrees(size):.1f}° the orientation is {np.degrees(_angle(turn)):.1f}° off; after one of "
        f"{1e6 * _SMALL:g} µrad, as in Figs 7 to 9, {_angle(_SMALL / size * turn):.1g} rad."
    )
    shown = "manipulator I carried by a base that has turned for 1 s"
    holds = "the orientation is integrated on SO(3)"
    return Row("E7", "Eq. 35", "ω is the rate of θ", holds, shown, np.array([wrong]), np.array([right]), more)


def _angle(vector: Array) -> float:
    """Between a turn by a rotation vector and the same three numbers as angles, rad."""
    return float((Rotation.from_rotvec(vector).inv() * Rotation.from_matrix(rpy_matrix(vector))).magnitude())


def _e8() -> Row:
    hexapod = load("mukherjee-ii")
    omega = natural_modes(hexapod, home(hexapod), joint="spin_free").omega
    as_hertz, as_printed = (float(np.abs(value / omega - 1).min()) for value in (TWO_PI * PRINTED, PRINTED))
    more = (
        f"As Hz, {TWO_PI * PRINTED:.0f} rad/s, it lies {as_hertz:.0%} from the nearest mode of manipulator II; as "
        f"rad/s, {as_printed:.1%} from the third. Figure 8's 550.136 carries no unit."
    )
    holds = "rad/s; the second distinct resonance, as modes 1 and 2 are nearly one"
    shown = "distance to the nearest natural frequency"
    return Row("E8", "Fig. 7", "ω = 749.715 Hz", holds, shown, np.array([as_hertz]), np.array([as_printed]), more)


def _spin() -> Row:
    """Part B: legs that do not spin."""
    cases = answers("moving")
    more = []
    for name in ("mukherjee-i", "mukherjee-ii"):
        hexapod = load(name)
        exact, free = (natural_modes(hexapod, home(hexapod), joint=joint).omega for joint in ("universal", "spin_free"))
        more.append(f"{np.abs(free / exact - 1).max():.2%} of manipulator {'I' if name.endswith('-i') else 'II'}")
    return Row(
        "B",
        "Eqs 13–25",
        "W·s = 0: a universal joint keeps a leg from spinning",
        "W has a part along the leg, so that (W − ω_b)·n = 0",
        _STATES["moving"],
        _off(cases, joint="spin_free"),
        _off(cases),
        f"Natural frequencies at home change by at most {' and '.join(more)}; over the poses of Figure 2 with cond(H) "
        f"< {_WELL_CONDITIONED:g} by up to {_over_the_workspace():.1%}.",
    )


def _over_the_workspace() -> float:
    """B: the largest relative change of a natural frequency of manipulator I over well-conditioned poses."""
    hexapod, poses, names = load("mukherjee-i"), random_poses(CASES[2].box(), _POSES), ("omega", "cond_H")
    exact, free = (sweep(hexapod, poses, quantities=names, joint=joint) for joint in ("universal", "spin_free"))
    good = exact.cond_H.values < _WELL_CONDITIONED
    return float(np.nanmax(np.abs(free.omega.values[good] / exact.omega.values[good] - 1)))


def _gravity() -> Row:
    """Part C: Eq. 5 leaves out weight and preload."""
    cases = answers("soft legs")
    hexapod = cases[0].state.hexapod
    pose = home(hexapod)
    engine = _by_differences(cases, pose)[:_LOW_MODES]
    eq_5 = natural_modes(hexapod, pose, joint="universal").omega[:_LOW_MODES]
    tangent = linearise(hexapod, pose, joint="universal").modes().omega[:_LOW_MODES]
    stiff = load("mukherjee-ii")
    kept = linearise(stiff, pose, joint="universal").modes().omega
    share = np.abs(kept / natural_modes(stiff, pose, joint="universal").omega - 1).max()
    more = (
        f"The lowest is {engine[0]:.3f} rad/s, by Eq. 5 {eq_5[0]:.3f} rad/s; with the printed legs of "
        f"{1e-6 * stiff.legs.stiffness[0]:g} N/µm the two differ by {percent(float(share))}."
    )
    return Row(
        "C",
        "Eqs 3–5",
        "η and u are ignored: no gravity, no preload",
        "tangent of Eq. 34 at static equilibrium",
        f"lowest three frequencies of manipulator II on legs of {hexapod.legs.stiffness[0]:g} N/m",
        np.abs(eq_5 / engine - 1),
        np.abs(tangent / engine - 1),
        more,
    )


def _by_differences(cases: list[Answer], rest: Pose) -> Array:
    """(6,) frequencies, rad/s, of the engine: from its accelerations at poses displaced either way on each axis."""
    columns = []
    for ahead, behind in zip(cases[::2], cases[1::2], strict=True):
        step = max(_displaced(ahead.state, rest), key=abs) - max(_displaced(behind.state, rest), key=abs)
        columns.append((ahead.engine - behind.engine) / step)
    values = eig(-np.array(columns).T, right=False)
    return np.sort(np.sqrt(values.real))


def _displaced(state: State, rest: Pose) -> Array:
    pose = state.platform.pose
    turn = Rotation.from_matrix(pose.matrix @ rest.matrix.T).as_rotvec()
    return np.concatenate([pose.position - rest.position, turn])


def _claims(rows: list[Row]) -> tuple[Claim, ...]:
    against_engine = [row for row in rows if row.number not in ("E8", "C")]
    worst = max(float(row.right.max()) for row in against_engine)
    least = min(float(row.wrong.max()) for row in against_engine)
    return (
        Claim(
            "Eqs 6 to 34 are the equations of motion of a 6-UPS platform on a moving base.",
            f"Corrected, they agree with the independent engine to {worst:.1g}; each error of the print shows as a "
            f"disagreement of {least:.1%} or more in some state.",
            agrees(least < 1e-6),
            "Eqs 2, 19, 22, 24, 25, 32, 33 and 35 are misprinted, and W·s = 0 does not hold: see the table.",
        ),
    )


def _words(rows: list[Row]) -> pd.DataFrame:
    shown = pd.DataFrame(index=pd.Index([row.number for row in rows], name="no."))
    shown["where"] = [row.where for row in rows]
    shown["printed"] = [row.printed for row in rows]
    shown["what holds"] = [row.holds for row in rows]
    shown["as printed, off by"] = [_range(row.wrong) for row in rows]
    shown["corrected, off by"] = [
        f"{row.right.max():.1g}" if row.right.max() < 1e-3 else _range(row.right) for row in rows
    ]
    shown["in"] = [f"{row.shown[0].upper()}{row.shown[1:]}. {row.more}".strip() for row in rows]
    return shown


def _range(values: Array) -> str:
    low, high = percent(float(values.min())), percent(float(values.max()))
    return high if low == high else f"{low.removesuffix(' %')} to {high}"
