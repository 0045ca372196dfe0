"""The natural frequencies behind the paper's figures: both test manipulators, both masses, both joint models."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import pandas as pd

from flexapod.conventions import TWO_PI, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.loading import load
from flexapod.mechanics.kinematics import condition_number, home_pose
from flexapod.mechanics.modes import advised_sampling_time, natural_modes
from flexapod.paper import Claim, Part, Settings, agrees
from flexapod.paper.charts import FAINT, Dots, rows_of_dots
from flexapod.paper.vibration import PRINTED
from flexapod.plots.style import BLUE, ORANGE, letters, wide
from flexapod.pose import Pose

MODES = [f"omega_{mode}" for mode in range(1, 7)]
R_U0_OF_I = {"legs.upper.mass_center": [-0.6, -0.08, 0.08]}
MASSLESS = {"legs.lower": None, "legs.upper": None}


def home(hexapod: Hexapod) -> Pose:
    """The home pose, which both test manipulators have."""
    pose = home_pose(hexapod)
    assert pose is not None
    return pose


class Case(NamedTuple):
    """A machine at its home pose, as it is read."""

    name: str
    design: str
    changes: Mapping[str, Any] = {}
    joint: JointModel = "spin_free"

    def omega(self) -> Array:
        """(6,) rad/s, Eq. 5."""
        hexapod = load(self.design).replace(self.changes)
        return natural_modes(hexapod, home(hexapod), joint=self.joint).omega


CASES = (
    Case("I, 40 kg", "mukherjee-i"),
    Case("I, 40 kg, exact joints", "mukherjee-i", joint="universal"),
    Case("I, 4000 kg", "mukherjee-i", {"platform.mass": 4000.0}),
    Case("II, 4 kg", "mukherjee-ii"),
    Case("II, 4 kg, exact joints", "mukherjee-ii", joint="universal"),
    Case("II, 4 kg, mass centre r_u0 of I", "mukherjee-ii", R_U0_OF_I),
    Case("II, 400 kg", "mukherjee-ii", {"platform.mass": 400.0}),
    Case("II, 4 kg, massless legs", "mukherjee-ii", MASSLESS),
)


def draw(name: str, _: Settings) -> Part:
    """The table, and the paper's one printed frequency read in rad/s and in Hz."""
    table = pd.DataFrame([case.omega() for case in CASES], columns=MODES, index=pd.Index([c.name for c in CASES]))
    table = table.rename_axis("manipulator").add_suffix("_rad_s")
    table["cond_H"] = [_cond(case) for case in CASES]
    table["sampling_time_s"] = [advised_sampling_time(omega) for omega in table["omega_6_rad_s"]]
    second = float(table.loc["II, 4 kg", "omega_3_rad_s"])
    of_one = float(table.loc["II, 4 kg, mass centre r_u0 of I", "omega_3_rad_s"])
    claims = (
        Claim(
            "A flexible 6-UPS platform has six natural frequencies at a pose, the solutions of Eq. 5.",
            "Six in every row, of which the first two of manipulator II are a near-repeated pair.",
            agrees(bool((table[table.columns[:6]] > 0).all(axis=None))),
        ),
        Claim(
            f"Manipulator II at (0, 0, 0.085): the second is {PRINTED:g}.",
            f"{second:.3f} rad/s, {second / PRINTED - 1:+.1%}; {of_one:.3f} rad/s, {of_one / PRINTED - 1:+.2%}, with "
            "r_u0 of manipulator I.",
            agrees(abs(second / PRINTED - 1) < 1e-3),
            "The paper prints no other frequency.",
        ),
    )
    caption = (
        "Natural frequencies by Eq. 5 at the home poses, base fixed, legs that do not spin but where said. Dashed: the "
        f"paper's {PRINTED:g} in rad/s, where the third mode of manipulator II is near; dotted: the same number as Hz."
    )
    numbers = {"second_resonance_rad_s": second, "with_r_u0_of_I_rad_s": of_one, "printed": PRINTED}
    title = "Natural frequencies of the test manipulators"
    return Part(name, title, _figure(table), caption, numbers, claims, table, _words(table))


def _cond(case: Case) -> float:
    hexapod = load(case.design)
    return float(condition_number(hexapod, home(hexapod)))


def _figure(table: pd.DataFrame) -> Any:
    rows = list(table[table.columns[:6]].values)
    figure, ax = rows_of_dots(list(table.index), [Dots("Eq. 5", rows, BLUE)], "natural frequency, rad/s")
    ax.axvline(PRINTED, color=ORANGE, lw=wide(1.4), ls=(0, (5, 2)))
    ax.axvline(TWO_PI * PRINTED, color=FAINT, lw=wide(1.4), ls=(0, (1, 2)))
    place: dict[str, Any] = {
        "xycoords": ("data", "axes fraction"),
        "fontsize": letters(),
        "textcoords": "offset points",
        "va": "bottom",
    }
    ax.annotate("749.715 rad/s", (PRINTED, 1.0), (0, 2), color=ORANGE, ha="center", **place)
    ax.annotate("749.715 Hz", (TWO_PI * PRINTED, 1.0), (0, 2), color=FAINT, ha="center", **place)
    return figure


def _words(table: pd.DataFrame) -> pd.DataFrame:
    shown = pd.DataFrame(index=table.index)
    for mode in range(6):
        shown[f"ω{mode + 1}, rad/s"] = [f"{value:.3f}" for value in table.iloc[:, mode]]
    shown["cond(H)"] = [f"{value:.4f}" for value in table.cond_H]
    shown["2π/(20 ω6), ms"] = [f"{1e3 * value:.4f}" for value in table.sampling_time_s]
    return shown
