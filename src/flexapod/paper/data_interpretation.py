"""How Appendix A is read where it cannot be meant as printed or is silent, and what each reading does to Eq. 5."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.loading import load
from flexapod.interchange.rigid_bodies import nearest_physical
from flexapod.mechanics.dynamics import equations_of_motion
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.modes import natural_modes
from flexapod.paper import Claim, Part, Settings, agrees
from flexapod.paper.charts import Dots, percent, rows_of_dots
from flexapod.paper.frequencies import MODES, R_U0_OF_I, home
from flexapod.plots.style import BLUE, ORANGE

Changes = Mapping[str, Any]
_TURNED = np.diag([-1.0, -1.0, 1.0])  # half a turn about z: local x from the platform to the base
_FLOOR = 1e-9  # of a change that is drawn: none


class Reading(NamedTuple):
    """A datum of a manipulator, how it is read, the other reading, and the changes that this one means."""

    machine: str
    datum: str
    read: str
    other: str
    changes: Callable[[Hexapod], Changes]


def _always(changes: Changes) -> Callable[[Hexapod], Changes]:
    return lambda _: changes


def _axis(third: float) -> Callable[[Hexapod], Changes]:
    """k_1 with a third component; only its direction counts."""

    def changes(hexapod: Hexapod) -> Changes:
        axes = hexapod.universal_axes.copy()
        axes[0] = [-0.8141, 0.2714, third]
        return {"base.universal_axes": axes}

    return changes


def _tangential(hexapod: Hexapod) -> Changes:
    """Universal axes along the base circle."""
    x, y, _ = hexapod.base_joints.T
    return {"base.universal_axes": np.stack([-y, x, np.zeros(6)], axis=1)}


def _from_platform(hexapod: Hexapod) -> Changes:
    """Local axes turned so that x points from platform to base."""
    changes = {}
    for name in ("lower", "upper"):
        part = getattr(hexapod.legs, name)
        changes[f"legs.{name}.mass_center"] = part.mass_center @ _TURNED
        changes[f"legs.{name}.inertia"] = _TURNED @ part.inertia @ _TURNED
    return changes


def _from_base_joint(hexapod: Hexapod) -> Changes:
    """r_u0 measured from the base joint, as it then lies at the home pose."""
    length = inverse_kinematics(hexapod, home(hexapod))
    center = hexapod.legs.upper.mass_center.copy()
    center[:, 0] -= length
    return {"legs.upper.mass_center": center}


def _possible(hexapod: Hexapod) -> Changes:
    legs = nearest_physical(hexapod).legs
    return {f"legs.{n}.inertia": getattr(legs, n).inertia for n in ("lower", "upper")}


def _third_row(coupling: float) -> Callable[[Hexapod], Changes]:
    """I_u0 of manipulator II with the printed 300 and a coupling of rows 2 and 3, 1e-5 kg m2."""
    inertia = 1e-5 * np.array([[0.5, 0.2, 0.2], [0.2, 0.2, coupling], [0.2, coupling, 300.0]])
    return _always({"legs.upper.inertia": inertia})


_UNIT = "length 0.858, the others 1: normalised, which leaves (−0.949, 0.316, 0)"
_BODY = "as printed: no rigid body has them, the assembled J is positive definite"
_LOCAL = "not printed: from base to platform"
_FROM = "not printed: measured from the platform joint"
READINGS = (
    Reading(
        "I",
        "r_u0",
        "−0.6 m",
        "−6.0 m as printed, beyond the leg of 0.9 m",
        _always({"legs.upper.mass_center": [-6.0, -0.08, 0.08]}),
    ),
    Reading("I", "k̄₁", _UNIT, "as printed: only its direction counts", _axis(0.0)),
    Reading(
        "I", "k̄₁", _UNIT, "a third component, 0.5134, lost in print", _axis(float(np.sqrt(1 - 0.8141**2 - 0.2714**2)))
    ),
    Reading("I", "I_d0, I_u0", _BODY, "the nearest that a body can have", _possible),
    Reading("I", "local x axis", _LOCAL, "from platform to base", _from_platform),
    Reading("I", "r_u0", _FROM, "from the base joint", _from_base_joint),
    Reading("I", "M", "40 kg, a case of the paper", "4000 kg, the other", _always({"platform.mass": 4000.0})),
    Reading("II", "r_u0", "[−0.6, −0.008, 0.008] m as printed", "[−0.6, −0.08, 0.08] m, that of I", _always(R_U0_OF_I)),
    Reading(
        "II",
        "r_u0",
        "[−0.6, −0.008, 0.008] m as printed",
        "[−0.06, −0.008, 0.008] m: a tenth of I, as r_d0",
        _always({"legs.upper.mass_center": [-0.06, -0.008, 0.008]}),
    ),
    Reading(
        "II",
        "I_u0, row 3",
        "10⁻⁵·[0.2, 0.1, 0.3]: symmetric",
        "[0.2, 100, 300], 100 in row 2 too",
        _third_row(100.0),
    ),
    Reading(
        "II",
        "I_u0, row 3",
        "10⁻⁵·[0.2, 0.1, 0.3]: symmetric",
        "[0.2, 100, 300], symmetric part",
        _third_row(50.05),
    ),
    Reading("II", "I_d0, I_u0", _BODY, "the nearest that a body can have", _possible),
    Reading("II", "local x axis", _LOCAL, "from platform to base", _from_platform),
    Reading("II", "r_u0", _FROM, "from the base joint", _from_base_joint),
    Reading("II", "k̄", '"as in the previous section": those of I', "along the base circle", _tangential),
    Reading("II", "M", "4 kg, a case of the paper", "400 kg, the other", _always({"platform.mass": 400.0})),
    Reading("II", "legs", "with their masses", "massless", _always({"legs.lower": None, "legs.upper": None})),
)
_CASES = ("M", "legs")  # not in doubt: what the paper varies
_DESIGNS = {"I": "mukherjee-i", "II": "mukherjee-ii"}


def draw(name: str, settings: Settings) -> Part:
    """Each reading and the other one beside it."""
    as_read = {machine: _omega(load(design), settings.joint) for machine, design in _DESIGNS.items()}
    omega = [_under(reading, settings.joint) for reading in READINGS]
    gravity = {machine: _with_gravity(load(design), settings.joint) for machine, design in _DESIGNS.items()}
    rows = [(r.machine, r.datum, r.read, r.other, value) for r, value in zip(READINGS, omega, strict=True)]
    rows += [(m, "gravity", "9.81 m/s² along −z", "in the tangent: Eq. 5 has none", w) for m, w in gravity.items()]
    rows.sort(key=lambda row: row[0])
    table = pd.DataFrame([row[4] for row in rows], columns=[f"{mode}_rad_s" for mode in MODES])
    change = np.array([row[4] / as_read[row[0]] - 1 for row in rows])
    for place, column in enumerate(("machine", "datum", "read", "other_reading")):
        table.insert(place, column, [row[place] for row in rows])
    table["largest_change"] = np.abs(change).max(axis=1)
    table["change_of_omega_1"] = change[:, 0]
    caption = (
        "Change of the natural frequencies by Eq. 5 at the home poses when a datum of Appendix A is read the other "
        "way: of the lowest, and of the one that changes most. At the left edge: no change."
    )
    least = {m: float(np.linalg.eigvalsh(_inertia(load(design))).min()) for m, design in _DESIGNS.items()}
    numbers = {
        "as_read_rad_s": as_read,
        "least_eigenvalue_of_J": least,
        "largest_change": table.largest_change.tolist(),
    }
    return Part(
        name,
        "Readings of Appendix A",
        _figure(rows, change),
        caption,
        numbers,
        _claims(least, table),
        table,
        _words(rows, change),
    )


def _under(reading: Reading, joint: JointModel) -> Array:
    hexapod = load(_DESIGNS[reading.machine])
    return _omega(hexapod.replace(reading.changes(hexapod)), joint)


def _omega(hexapod: Hexapod, joint: JointModel) -> Array:
    return natural_modes(hexapod, home(hexapod), joint=joint).omega


def _with_gravity(hexapod: Hexapod, joint: JointModel) -> Array:
    return linearise(hexapod, home(hexapod), joint=joint).modes().omega


def _inertia(hexapod: Hexapod) -> Array:
    return equations_of_motion(hexapod, home(hexapod)).J_p


def _claims(least: dict[str, float], table: pd.DataFrame) -> tuple[Claim, ...]:
    doubtful = table[~table.datum.isin(_CASES)]
    weighty = doubtful.largest_change > 0.01
    return (
        Claim(
            "Appendix A gives the data of both manipulators.",
            f"It has to be read: of {len(doubtful)} other readings {int(weighty.sum())} change a natural frequency by "
            "more than 1 %.",
            agrees(not weighty.any()),
            "Slips of the print and data that it leaves out.",
        ),
        Claim(
            "The legs' parts have the inertias I_d0 and I_u0.",
            "No rigid body has them: I_d0 is not positive definite, and the largest principal moment of I_u0 exceeds "
            "the sum of the other two. The assembled J is positive definite all the same: least eigenvalue "
            f"{least['I']:.2g} (I) and {least['II']:.2g} (II).",
            "differs",
            "Kept as printed: they change little.",
        ),
    )


def _figure(rows: list[Any], change: Array) -> Any:
    names = [f"{machine}: {datum}, {other.split(':')[0]}" for machine, datum, _, other, _ in rows]
    size = np.maximum(np.abs(change), _FLOOR)
    dots = [
        Dots("largest change", list(size.max(axis=1)[:, None]), BLUE),
        Dots("of the lowest", list(size[:, :1]), ORANGE, "x"),
    ]
    figure, ax = rows_of_dots(names, dots, "relative change of a natural frequency")
    figure.legend(*ax.get_legend_handles_labels(), loc="outside upper right", ncols=2, frameon=False)
    return figure


def _words(rows: list[Any], change: Array) -> pd.DataFrame:
    shown = pd.DataFrame(index=pd.Index([row[0] for row in rows], name="manipulator"))
    for place, column in enumerate(("datum", "read here", "the other reading"), start=1):
        shown[column] = [row[place] for row in rows]
    shown["largest change"] = [percent(value) for value in np.abs(change).max(axis=1)]
    for mode in range(6):
        shown[f"ω{mode + 1}, rad/s"] = [f"{row[4][mode]:.1f}" for row in rows]
    return shown
