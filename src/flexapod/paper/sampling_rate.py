"""Conclusion 3: the sampling time of a controller should be at most 2 pi/(20 omega_max).

Manipulator II under task-space velocity feedback that gives its highest mode a damping ratio of 10 %, sampled slower
and slower: the damping that is left of it, and the complete machine on a shaken base.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.optimize import brentq

from flexapod.control.closed_loop_poles import assess
from flexapod.control.controllers import PID
from flexapod.control.linear_controller import Controller
from flexapod.control.plant import Plant
from flexapod.control.sampled_simulation import simulate_control
from flexapod.conventions import Array, JointModel
from flexapod.design.loading import load
from flexapod.errors import UnstableError
from flexapod.excitation.excitation import Excitation
from flexapod.excitation.random_phases import random_motion
from flexapod.excitation.spectra import flat_spectrum
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.modes import advised_sampling_time
from flexapod.paper import Claim, Part, Settings, agrees
from flexapod.paper.frequencies import home
from flexapod.plots.style import BLUE, FAINT, INK, ORANGE, dress, letters, new_figure, wide

DESIGN = "mukherjee-ii"
DAMPING = 0.1  # of the highest mode, by the continuous controller
FACTORS = np.geomspace(0.1, 6.0, 61)  # of the rule's sampling time
RUN_FACTORS = (0.25, 0.5, 1.0, 2.0, 3.0, 4.0)
DURATION = 0.05  # s
_HIGHEST = 3  # modes 4 to 6 are the ones that a slow controller meets too late


def draw(name: str, settings: Settings) -> Part:
    """Damping and vibration over the sampling time."""
    bench = _Bench(settings.joint)
    damping = np.array([bench.least_damping(factor) for factor in FACTORS])
    edge = float(brentq(bench.least_damping, 1.0, FACTORS[-1], xtol=1e-4))
    kept = bench.least_damping(1.0) / bench.continuous
    runs = {factor: bench.run(factor, settings.seed) for factor in RUN_FACTORS}
    fastest = runs[RUN_FACTORS[0]]
    assert fastest is not None  # far on the stable side of the edge
    table = pd.DataFrame({"least_damping": damping}, index=pd.Index(FACTORS, name="sampling_time_over_rule"))
    numbers = {
        "rule_s": bench.dt,
        "continuous_damping": bench.continuous,
        "kept_at_the_rule": kept,
        "unstable_from": edge,
        "samples_per_period_at_the_edge": 20 / edge,
        "rms_over_fastest": {str(f): None if v is None else v / fastest for f, v in runs.items()},
    }
    caption = (
        "Least damping ratio of modes 4 to 6 of manipulator II under sampled velocity feedback (task space, "
        f"{bench.gain:.4g} 1/s, one sample of delay) against the sampling time over 2π/(20 ω₆) = "
        f"{1e6 * bench.dt:.4g} µs. Dashed: without sampling. Below zero the machine is unstable."
    )
    title = "Conclusion 3: the sampling time"
    return Part(name, title, _figure(damping, bench, edge), caption, numbers, _claims(numbers), table, _words(numbers))


class _Bench:
    """The machine, its tangent, its controller."""

    def __init__(self, joint: JointModel) -> None:
        self.hexapod, self.joint = load(DESIGN), joint
        self.pose = home(self.hexapod)
        self.plant = Plant(linearise(self.hexapod, self.pose, joint=joint))
        self.dt = advised_sampling_time(float(self.plant.omega[-1]))
        self.gain = 2 * DAMPING * float(self.plant.omega[-1])
        self.law = PID(0.0, self.gain, space="task").on(self.plant.linear)
        self.continuous = self._of_highest(self.law)

    def sampled(self, factor: float) -> Controller:
        return self.law.sampled(factor * self.dt, delay=1)

    def least_damping(self, factor: float) -> float:
        return self._of_highest(self.sampled(factor))

    def _of_highest(self, controller: Controller) -> float:
        """The least damping ratio of the poles that vibrate faster than half the fourth mode."""
        loop = assess(self.plant, controller)
        fast = np.abs(loop.pole.imag) > 0.5 * self.plant.omega[_HIGHEST]
        return float(loop.damping_ratio[fast].min(initial=1.0))

    def run(self, factor: float, seed: int) -> float | None:
        """RMS angular acceleration about x and y, rad/s2, of the complete machine; None where the loop is unstable."""
        try:
            found = simulate_control(
                self.hexapod,
                self.pose,
                controller=self.sampled(factor),
                base_motion=_base(seed),
                duration=DURATION,
                joint=self.joint,
            )
        except UnstableError:
            return None
        tilting: Array = found.rms_acceleration.sel(case="controlled", axis=["roll", "pitch"]).values
        return float(np.hypot(*tilting))


def _base(seed: int) -> Excitation:
    """Base acceleration along z, 0.01 m/s2, even over all modes."""
    return random_motion("z", flat_spectrum(0.01, 100.0, 20_000.0), seed=seed)


def _claims(numbers: dict[str, Any]) -> tuple[Claim, ...]:
    kept, edge = numbers["kept_at_the_rule"], numbers["unstable_from"]
    rms = numbers["rms_over_fastest"]
    slow = ", ".join(f"{f}: {'unstable' if v is None else format(v, '.2f')}" for f, v in rms.items())
    return (
        Claim(
            "For proper control the sampling time should be at most 2π/(20 ω) with ω the highest natural frequency.",
            f"{1e6 * numbers['rule_s']:.4g} µs for manipulator II. There {kept:.0%} of the highest modes' damping is "
            f"left; from {edge:.2f} times that time on, {20 / edge:.1f} samples in the shortest period, the machine is "
            "unstable.",
            agrees(kept > 0.8 and edge > 1),
            "A rule of thumb: it keeps a margin of about three.",
        ),
        Claim(
            '"A rough estimate": slower sampling harms.',
            "Complete machine on a shaken base, RMS tilting acceleration over that at a quarter of the rule's time, by "
            f"the sampling time over the rule's: {slow}.",
            agrees(rms["4.0"] is None and rms["3.0"] is not None and rms["3.0"] > rms["1.0"]),
        ),
    )


def _words(numbers: dict[str, Any]) -> pd.DataFrame:
    rms = numbers["rms_over_fastest"]
    rows = {
        f: {"samples in the shortest period": f"{20 / float(f):.3g}", "RMS tilting acceleration, relative": _or_not(v)}
        for f, v in rms.items()
    }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("sampling time over the rule's")


def _or_not(value: float | None) -> str:
    return "unstable" if value is None else f"{value:.3f}"


def _figure(damping: Array, bench: _Bench, edge: float) -> Figure:
    figure = new_figure(9.0, 3.8)
    ax = figure.add_subplot()
    ax.axhspan(-1, 0, color=ORANGE, alpha=0.12, lw=0)
    ax.semilogx(FACTORS, damping, color=BLUE, lw=wide(1.9))
    ax.axhline(bench.continuous, color=FAINT, lw=wide(1.2), ls=(0, (5, 2)))
    ax.axvline(1.0, color=INK, lw=wide(1.0))
    ax.annotate("the paper's rule", (1.0, 0.0), xytext=(4, 6), textcoords="offset points", fontsize=letters())
    ax.annotate("unstable", (FACTORS[0], 0.0), xytext=(6, -14), textcoords="offset points", fontsize=letters())
    ax.plot(edge, 0.0, "o", ms=7, color=ORANGE, mec="white", zorder=4)
    ax.annotate(f"{edge:.2f}", (edge, 0.0), xytext=(6, 6), textcoords="offset points", fontsize=letters())
    low = max(float(damping.min()), -0.6 * bench.continuous)
    ax.set(xlabel="sampling time over 2π/(20 ω₆)", ylabel="least damping ratio of modes 4 to 6", xlim=FACTORS[[0, -1]])
    ax.set_ylim(low - 0.01, 1.25 * bench.continuous)
    ax.set_xticks([0.1, 0.2, 0.5, 1, 2, 5], ["0.1", "0.2", "0.5", "1", "2", "5"])
    ax.minorticks_off()
    dress(ax)
    return figure
