"""Figures 2-5: the lowest natural frequency against cond(H) over many poses, two manipulators with two masses each.

The paper prints neither the poses nor their ranges. The boxes here are chosen so that the poses reach from the best
conditioned ones near home into singular ones, as the paper's text says of its figures.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from flexapod.design.hexapod import Hexapod
from flexapod.design.loading import load
from flexapod.mechanics.kinematics import home_pose
from flexapod.paper import Claim, Part, Settings, agrees
from flexapod.plots import style
from flexapod.plots import sweep as plots_sweep
from flexapod.workspace.box import Box
from flexapod.workspace.sampling import random_poses
from flexapod.workspace.summary import SweepSummary, summarise
from flexapod.workspace.sweeping import sweep

if TYPE_CHECKING:
    import xarray as xr

POINTS = 200_000
_SHOWN = 0.99  # part of the poses inside the axis of cond(H); the rest lies beyond, with an index near zero


class Case(NamedTuple):
    """A manipulator, its platform's mass (kg) and the other mass of the pair; the box: home plus and minus m, rad."""

    name: str
    design: str
    mass: float
    other_mass: float
    position: float
    angle: float

    def hexapod(self, mass: float) -> Hexapod:
        return load(self.design).replace({"platform.mass": mass})

    def box(self) -> Box:
        home = home_pose(load(self.design))
        assert home is not None
        return Box.about(home, self.position, self.angle)


_I = ("manipulator I", "mukherjee-i")
_II = ("manipulator II", "mukherjee-ii")
CASES = {
    2: Case(*_I, 40.0, 4000.0, 0.15, np.radians(25)),
    3: Case(*_I, 4000.0, 40.0, 0.15, np.radians(25)),
    4: Case(*_II, 4.0, 400.0, 0.02, np.radians(60)),
    5: Case(*_II, 400.0, 4.0, 0.02, np.radians(60)),
}


def draw(name: str, settings: Settings) -> Part:
    """One of Figures 2-5, with the numbers behind what the paper says of it."""
    figure = int(name.removeprefix("figure-"))
    case = CASES[figure]
    poses = random_poses(case.box(), settings.points or POINTS, seed=settings.seed)
    own, other = (
        sweep(case.hexapod(mass), poses, joint=settings.joint, threads=settings.threads)
        for mass in (case.mass, case.other_mass)
    )
    summary = summarise(own)
    light, heavy = (own, other) if case.mass < case.other_mass else (other, own)
    light_omega, heavy_omega = light["omega_1"].values, heavy["omega_1"].values
    ratio = float(np.nanmedian(light_omega) / np.nanmedian(heavy_omega))
    numbers = {
        "poses": summary.poses,
        "mass_kg": case.mass,
        "omega_1_median_rad_s": summary.quantiles[0.5],
        "omega_1_least_rad_s": float(np.nanmin(own["omega_1"])),
        "omega_1_by_cond_H": _falls(own),
        "rank_correlation": summary.correlation,
        "spread_at_equal_cond_H": summary.spread,
        "least_cond_H": None if summary.best_conditioned is None else summary.best_conditioned.cond_H,
        "median_ratio_light_to_heavy": ratio,
        "part_of_poses_lower_with_larger_mass": float(np.mean(heavy_omega < light_omega)),
    }
    most_cond = float(np.nanquantile(own["cond_H"], _SHOWN))
    axes = plots_sweep.index_scatter(own, most_cond=most_cond)
    title = f"Figure {figure}: {case.name}, platform {case.mass:g} kg"
    style.entitle(axes, title)
    axes.text(
        0.98,
        0.97,
        _words(case, summary, ratio),
        transform=axes.transAxes,
        ha="right",
        va="top",
        fontsize=style.letters(),
        color=style.ink(),
    )
    table = pd.DataFrame({name: own[name].values for name in ("cond_H", "omega_1")}).rename_axis("pose")
    table = table[table.cond_H <= most_cond].rename(columns={"omega_1": "omega_1_rad_s"})
    claims = _claims(case, numbers)
    return Part(name, title, style.figure_of(axes), _caption(case, settings, summary), numbers, claims, table)


def _claims(case: Case, numbers: dict[str, Any]) -> tuple[Claim, ...]:
    bands = list(numbers["omega_1_by_cond_H"].values())
    spread, correlation = numbers["spread_at_equal_cond_H"], numbers["rank_correlation"]
    lower = numbers["part_of_poses_lower_with_larger_mass"]
    light, heavy = sorted((case.mass, case.other_mass))
    return (
        Claim(
            "The lowest natural frequency falls sharply as cond(H) grows; near singular poses it is very low.",
            f"Median of the best conditioned tenth {bands[0]:.4g} rad/s, of the worst hundredth {bands[-1]:.3g} rad/s; "
            f"least of all {numbers['omega_1_least_rad_s']:.2g} rad/s.",
            agrees(bands == sorted(bands, reverse=True) and bands[0] > 10 * bands[-1]),
        ),
        Claim(
            "At equal cond(H) poses differ much in their lowest frequency; still the two indices correlate.",
            f"At equal cond(H) the 95 % quantile is {spread:.2f} times the 5 % quantile; rank correlation "
            f"{correlation:.2f}.",
            agrees(spread > 1.2 and correlation < -0.5),
        ),
        Claim(
            "A heavier platform lowers the lowest frequency, which cond(H) cannot show.",
            f"Lower with {heavy:g} kg than with {light:g} kg at {lower:.0%} of the poses, in the median by a factor of "
            f"{numbers['median_ratio_light_to_heavy']:.2f}; cond(H) is the same.",
            agrees(lower == 1.0),
        ),
        Claim(
            "The cloud of poses itself, and its axes.",
            "Ranges chosen here, see the caption.",
            "open",
            "The paper prints neither the poses nor their ranges.",
        ),
    )


def _falls(own: xr.Dataset) -> dict[str, float]:
    """Median index, rad/s, of the poses in bands of cond(H)."""
    cond, omega = own["cond_H"].values, own["omega_1"].values
    edges = np.nanquantile(cond, [0, 0.1, 0.5, 0.9, 0.99, 1])
    bands = np.searchsorted(edges[1:-1], cond)
    return {
        f"{edges[k]:.4g} to {edges[k + 1]:.4g}": float(np.nanmedian(omega[bands == k]))
        for k in range(5)
        if (bands == k).any()
    }


def _words(case: Case, summary: SweepSummary, ratio: float) -> str:
    return (
        f"{summary.poses} poses\n"
        f"median $\\omega_1$ {summary.quantiles[0.5]:.4g} rad/s\n"
        f"rank correlation {summary.correlation:.2f}\n"
        f"spread at equal cond(H) {summary.spread:.2f}\n"
        f"median, {min(case.mass, case.other_mass):g} kg : {max(case.mass, case.other_mass):g} kg = {ratio:.2f}"
    )


def _caption(case: Case, settings: Settings, summary: SweepSummary) -> str:
    box = case.box()
    centre = (box.low + box.high)[:3] / 2
    return (
        f"Lowest natural frequency against cond(H) for the paper's {case.name} with a platform of {case.mass:g} kg, "
        f"{summary.poses} random poses, joint model {settings.joint}. The paper does not print its poses; here: "
        f"position ({', '.join(f'{c:g}' for c in centre)}) m, each coordinate plus and minus {case.position:g} m; "
        f"roll, pitch and yaw plus and minus {np.degrees(case.angle):.3g} degrees. The axis ends at the "
        f"{_SHOWN:.0%} quantile of cond(H). "
        "Spread at equal cond(H): 95 % over 5 % quantile of the index in bands of equal cond(H), their median."
    )
