"""Conclusion 1: the three criteria for a machine's design that the paper names, each followed on manipulator II.

The lowest natural frequency is maximised at one pose; so that it stays above a bound all along a path; and in a
weighted mean over the path. Every joint may move by 10 mm in its plate, within the footprints of the printed machine.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.loading import load
from flexapod.mechanics.kinematics import condition_number
from flexapod.mechanics.modes import natural_modes
from flexapod.optimisation.constraints import Footprint
from flexapod.optimisation.design_search import optimise
from flexapod.optimisation.objectives import Dexterity, LeastIndex, MeanIndex, Objective
from flexapod.optimisation.variables import Variable
from flexapod.paper import Claim, Part, Settings, agrees
from flexapod.plots.style import BLUE, FAINT, GREEN, INK, ORANGE, dress, legend_below, letters, stage, wide
from flexapod.pose import Pose

DESIGN = "mukherjee-ii"
REACH = 0.01  # m, of a joint
POSES = 41  # that a search sees
_FINE = 401  # on which its result is judged
CRITICAL = (0.75, 1.0)  # the part of the path where the work is done, and its weight
WEIGHT = 10.0
_STYLES = {
    "as printed": (FAINT, "-"),
    "best conditioned": (FAINT, (0, (2, 1.5))),
    "best at one pose": (GREEN, (0, (6, 2))),
    "best least index on the path": (BLUE, "-"),
    "best weighted mean on the path": (ORANGE, (0, (6, 2, 1, 2))),
}
PRINTED, CONDITIONED, AT_POSE, LEAST, MEAN = _STYLES


class _Machine(NamedTuple):
    along: Array  # (_FINE,) index, rad/s
    home: float
    cond: float  # the largest on the path
    evaluations: int
    seconds: float


def path(count: int) -> Pose:
    """(count,) poses: a platform that crosses the workspace of manipulator II, tilting and turning as it goes."""
    s = np.linspace(-1.0, 1.0, count)
    return Pose.from_rpy(0.02 * s, 0.0, 0.085, 0.0, 0.4 * s, 0.6 * s)


def weights(count: int) -> Array:
    """(count,), one a pose: large where the work is done."""
    s = np.linspace(0.0, 1.0, count)
    return np.where((s >= CRITICAL[0]) & (s <= CRITICAL[1]), WEIGHT, 1.0)


def draw(name: str, settings: Settings) -> Part:
    """Five machines and what each criterion says of them."""
    found = _machines(settings.joint)
    rows = {
        name: {
            "at_one_pose_rad_s": m.home,
            "least_on_path_rad_s": float(m.along.min()),
            "weighted_mean_rad_s": float(np.average(m.along, weights=weights(_FINE))),
            "largest_cond_H_on_path": m.cond,
            "evaluations": m.evaluations,
            "seconds": m.seconds,
        }
        for name, m in found.items()
    }
    measured = pd.DataFrame.from_dict(rows, orient="index")
    table = pd.DataFrame({f"{n} (rad/s)": m.along for n, m in found.items()})
    table.insert(0, "weight", weights(_FINE))
    table.index = pd.Index(np.linspace(0, 1, _FINE), name="share_of_path")
    caption = (
        f"The index along a path of manipulator II (40 mm along x, pitch from -23 to 23 degrees, yaw from "
        "-34 to 34 degrees), for the machine as printed and four machines whose joints were moved by at most "
        f"{1e3 * REACH:g} mm each. Shaded: where the weight is {WEIGHT:g} instead of 1. Line: the bound that the third "
        "criterion can promise."
    )
    title = "Conclusion 1: the index as a criterion of design"
    numbers = {"machines": rows}
    return Part(name, title, _figure(found), caption, numbers, _claims(measured), table, _words(measured))


def _machines(joint: JointModel) -> dict[str, _Machine]:
    start, poses = load(DESIGN), path(POSES)
    aims: dict[str, Objective] = {
        CONDITIONED: Dexterity(poses),
        AT_POSE: LeastIndex(),
        LEAST: LeastIndex(poses),
        MEAN: MeanIndex(poses, weights(POSES)),
    }
    found = {PRINTED: _measured(start, joint)}
    for name, aim in aims.items():
        best = optimise(start, _variables(), aim, _limits(), trials=0, samples=256, verify=512, joint=joint)
        found[name] = _measured(best.hexapod, joint, best.evaluations, best.seconds)
    return found


def _variables() -> list[Variable]:
    plates = [(plate, leg, axis) for plate in ("base", "platform") for leg in range(6) for axis in (0, 1)]
    return [Variable(f"{plate}.joints[{leg}][{axis}]", -REACH, REACH, kind="add") for plate, leg, axis in plates]


def _limits() -> list[Footprint]:
    return [Footprint(), Footprint(plate="platform")]


def _measured(hexapod: Hexapod, joint: JointModel, evaluations: int = 0, seconds: float = 0.0) -> _Machine:
    poses = path(_FINE)
    index = natural_modes(hexapod, poses, joint=joint).omega[:, 0]
    cond = float(np.max(condition_number(hexapod, poses)))
    return _Machine(index, float(index[_FINE // 2]), cond, evaluations, seconds)


def _claims(measured: pd.DataFrame) -> tuple[Claim, ...]:
    home, least, mean = (measured[column] for column in measured.columns[:3])
    wins = home.idxmax() == AT_POSE and least.idxmax() == LEAST and mean.idxmax() == MEAN
    effort = measured.evaluations[LEAST] / measured.evaluations[MEAN]
    return (
        Claim(
            "Where dynamic stability matters, the lowest natural frequency can be maximised.",
            f"At the reference pose from {home[PRINTED]:.4g} to {home[AT_POSE]:.4g} rad/s, by a factor of "
            f"{home[AT_POSE] / home[PRINTED]:.2f}.",
            agrees(home[AT_POSE] > home[PRINTED]),
        ),
        Claim(
            "For a path: the lowest frequency above a bound all along it, or maximal in a weighted cumulative sense.",
            f"Bound kept all along: {least[LEAST]:.4g} rad/s (as printed {least[PRINTED]:.4g}). Weighted mean: "
            f"{mean[MEAN]:.4g} rad/s (as printed {mean[PRINTED]:.4g}). "
            f"{'Each' if wins else 'Not each'} criterion is best met by the machine made for it.",
            agrees(wins),
        ),
        Claim(
            "The condition number of H cannot point out the more stable machine.",
            f"The best conditioned machine keeps {least[CONDITIONED]:.4g} rad/s on the path, "
            f"{1 - least[CONDITIONED] / least[LEAST]:.0%} less than the best one.",
            agrees(least[CONDITIONED] < least[LEAST]),
        ),
        Claim(
            "The bound over a whole path asks for more computation than the weighted mean.",
            f"{measured.evaluations[LEAST]} against {measured.evaluations[MEAN]} evaluations, {effort:.2f} times as "
            "many.",
            agrees(effort > 1.2),
            "With exact gradients and few poses either is found within seconds.",
        ),
    )


def _words(measured: pd.DataFrame) -> pd.DataFrame:
    shown = pd.DataFrame(index=measured.index.rename("machine"))
    shown["index at the reference pose, rad/s"] = [f"{v:.1f}" for v in measured.at_one_pose_rad_s]
    shown["least on the path, rad/s"] = [f"{v:.1f}" for v in measured.least_on_path_rad_s]
    shown["weighted mean, rad/s"] = [f"{v:.1f}" for v in measured.weighted_mean_rad_s]
    shown["largest cond(H) on the path"] = [f"{v:.1f}" for v in measured.largest_cond_H_on_path]
    shown["evaluations"] = [str(v) if v else "" for v in measured.evaluations]
    return shown


def _figure(found: dict[str, _Machine]) -> Figure:
    """All machines, and those that were improved once more, closer."""
    share, bound = np.linspace(0, 1, _FINE), found[LEAST].along.min()
    figure, (whole, close) = stage(None, (10.0, 4.4), (1, 2), sharex=True, width_ratios=[1, 1.4])
    for name, machine in found.items():
        colour, style = _STYLES[name]
        whole.plot(share, machine.along, color=colour, ls=style, lw=wide(1.9), label=name)
        if name != PRINTED:
            close.plot(share, machine.along, color=colour, ls=style, lw=wide(1.9))
    for ax in (whole, close):
        ax.axhline(bound, color=INK, lw=wide(0.8))
        ax.axvspan(*CRITICAL, color=ORANGE, alpha=0.1, lw=0)
        ax.set(xlabel="share of the path", xlim=(0, 1))
        dress(ax)
    close.annotate(
        f"bound {bound:.4g} rad/s", (0.5, bound), xytext=(0, -12), textcoords="offset points", fontsize=letters()
    )
    whole.set_ylabel(r"lowest natural frequency $\omega_1$, rad/s")
    whole.set_ylim(bottom=0)
    legend_below(figure, 3, *whole.get_legend_handles_labels())
    return figure
