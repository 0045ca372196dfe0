"""Conclusion 2: gains whose closed-loop poles fall near natural frequencies can make the machine vibrate more.

Manipulator II under a sampled PID controller over a map of gains, by how near the poles of the closed loop come to the
natural frequencies and by how much the shaken platform moves. The paper's friction hardly damps at all; here the legs
have some, so that the machine without control has a stationary vibration to compare with.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from flexapod.control.closed_loop_poles import assess
from flexapod.control.controllers import PID
from flexapod.control.linear_controller import Controller, static
from flexapod.control.plant import Plant, held, joined
from flexapod.control.sampled_simulation import simulate_control
from flexapod.conventions import Array, JointModel
from flexapod.design.loading import load
from flexapod.excitation.piecewise import half_sine_shock
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.modes import advised_sampling_time
from flexapod.paper import Claim, Part, Settings, agrees
from flexapod.paper.frequencies import home
from flexapod.plots.style import ORANGE, dress, new_figure, wide
from flexapod.rotations import skew

DESIGN = "mukherjee-ii"
FRICTION = 3000.0  # N s/m in each leg: damping ratios of 1 to 30 %
KP = 1e4  # 1/s2
KI = np.geomspace(1e5, 1e8, 19)  # 1/s3
KD = np.geomspace(1.0, 1e3, 17)  # 1/s
NEAR = 0.1  # relative distance of a pole to a natural frequency
RUNS = {"near": (2e6, 1.0), "far": (2e6, 300.0)}  # gains run on the complete machine
DURATION = 0.3  # s, after a shock
SHOCK = half_sine_shock("z", 10.0, 1e-4)  # of the base, short against every mode but the fastest
_MOST = 3.0  # ratio at which the colours end
_UNSTABLE, _LINE = "#3b434c", "#11161c"  # on the map: these do not follow light and dark paper


class _Loop(NamedTuple):
    ki: float
    kd: float
    distance: float  # least, of a vibrating pole to a natural frequency, relative
    least_damping: float
    ratio: float  # RMS displacement over that without control; infinite where unstable


def draw(name: str, settings: Settings) -> Part:
    """The map of gains, and two of them beside no control on the complete machine."""
    bench = _Bench(settings.joint)
    loops = [bench.measured(ki, kd) for ki in KI for kd in KD]
    table = pd.DataFrame(loops).rename(columns={"ki": "ki_1_s3", "kd": "kd_1_s", "ratio": "rms_over_no_control"})
    near, far = (np.array([x.ratio for x in loops if (x.distance < NEAR) is side]) for side in (True, False))
    runs = {word: bench.run(ki, kd) for word, (ki, kd) in RUNS.items()}
    numbers = {
        "dt_s": bench.dt,
        "loops_near": near.size,
        "loops_near_vibrate_more": int((near > 1).sum()),
        "loops_near_unstable": int(np.isinf(near).sum()),
        "loops_far": far.size,
        "loops_far_vibrate_more": int((far > 1).sum()),
        "rms_over_no_control": runs,
        "predicted": {word: bench.measured(*gains)._asdict() for word, gains in RUNS.items()},
    }
    caption = (
        "RMS displacement of manipulator II's platform joints relative to the base over that without control, base "
        f"shaken by white acceleration along z; task-space PID, kp = {KP:g} 1/s², sampled every "
        f"{1e6 * bench.dt:.3g} µs (conclusion 3's rule) with one sample of delay; {FRICTION:g} N s/m in each leg. "
        f"Dark: unstable. Line: to its left a pole lies within {NEAR:.0%} of a natural frequency. Dots: run on the "
        "complete machine."
    )
    title = "Conclusion 2: gains and natural frequencies"
    return Part(name, title, _figure(table), caption, numbers, _claims(numbers), table, _words(numbers))


class _Bench:
    """The machine, its tangent, and its vibration without control."""

    def __init__(self, joint: JointModel) -> None:
        self.hexapod = load(DESIGN).replace({"legs.damping.prismatic": FRICTION})
        self.pose, self.joint = home(self.hexapod), joint
        self.plant = Plant(linearise(self.hexapod, self.pose, joint=joint))
        self.dt = advised_sampling_time(float(self.plant.omega[-1]))
        self.shaken = held(self.plant, self.dt)[2][:, 2]
        arms = self.hexapod.platform_joints @ self.pose.matrix.T
        self.joints = np.vstack([np.hstack([np.eye(3), skew(arm).T]) for arm in arms])
        idle = replace(static(np.zeros((6, 6)), ("leg_rate",), "no control"), dt=self.dt)
        self.passive = self.rms(idle)

    def controller(self, ki: float, kd: float) -> Controller:
        return PID(KP, kd, ki, space="task").on(self.plant.linear).sampled(self.dt, delay=1)

    def measured(self, ki: float, kd: float) -> _Loop:
        controller = self.controller(ki, kd)
        loop = assess(self.plant, controller, NEAR)
        vibrating = loop.pole.imag > 1e-6 * self.plant.omega_0
        distance = float(loop.distance[vibrating].min(initial=np.inf))
        ratio = self.rms(controller) / self.passive if loop.stable else np.inf
        return _Loop(ki, kd, distance, loop.worst_damping, ratio)

    def rms(self, controller: Controller) -> float:
        """Of the joints' displacement relative to the base (a common factor left out), base acceleration along z white
        from sample to sample: the covariance P of the closed loop's state solves P = A P A^T + b b^T."""
        A = joined(self.plant, controller)
        b = np.concatenate([self.shaken, np.zeros(len(A) - 12)])
        y = self.plant.C[self.plant.measured(("position",))]
        return self._of_joints(y @ _stationary(A, np.outer(b, b))[:12, :12] @ y.T)

    def _of_joints(self, covariance: Array) -> float:
        return float(np.sqrt(np.trace(self.joints @ covariance @ self.joints.T) / 6))

    def run(self, ki: float, kd: float) -> float:
        """The same ratio of the complete machine, after a shock of the base."""
        controller = self.controller(ki, kd)
        found = simulate_control(
            self.hexapod, self.pose, controller=controller, base_motion=SHOCK, duration=DURATION, joint=self.joint
        )
        controlled, passive = (found.relative.sel(case=case).values for case in ("controlled", "passive"))
        return self._of_joints(controlled.T @ controlled) / self._of_joints(passive.T @ passive)


def _stationary(A: Array, Q: Array) -> Array:
    """P = A P A^T + Q of a stable A, by doubling: after k rounds P is the sum of the first 2^k terms."""
    P, power = Q, A
    while np.abs(power).max() > 1e-9:
        P = P + power @ P @ power.T
        power = power @ power
    return P


def _claims(numbers: dict[str, Any]) -> tuple[Claim, ...]:
    more, near = numbers["loops_near_vibrate_more"], numbers["loops_near"]
    runs = numbers["rms_over_no_control"]
    return (
        Claim(
            "With closed-loop poles near the natural frequencies the machine may vibrate more than without control.",
            f"Of {near} pairs of gains with a pole within {NEAR:.0%} of a natural frequency {more} vibrate more, "
            f"{numbers['loops_near_unstable']} of them without end; of {numbers['loops_far']} pairs with all poles "
            f"farther away {numbers['loops_far_vibrate_more'] or 'none'}.",
            agrees(more > 0 and numbers["loops_far_vibrate_more"] == 0),
            f'"May": the other {near - more} near pairs vibrate less. What decides is damping: a pole near a natural '
            "frequency has little, and the integral takes it.",
        ),
        Claim(
            "Gains should be chosen so that the poles do not fall near the natural frequencies.",
            f"Complete machine in the {DURATION:g} s after a shock of the base, ki = {_power(RUNS['near'][0])} 1/s³: "
            f"with kd = {RUNS['near'][1]:g} 1/s (near) it moves {runs['near']:.2f} times as much as without control, "
            f"with kd = {RUNS['far'][1]:g} 1/s (far) {runs['far']:.2f} times.",
            agrees(runs["near"] > 1 > runs["far"]),
        ),
    )


def _power(value: float) -> str:
    return f"{value / 1e6:g}·10⁶"


def _words(numbers: dict[str, Any]) -> pd.DataFrame:
    rows = {}
    for word, gains in RUNS.items():
        loop = numbers["predicted"][word]
        rows[f"ki = {_power(gains[0])} 1/s³, kd = {gains[1]:g} 1/s"] = {
            "nearest pole to a natural frequency": f"{loop['distance']:.3f}",
            "least damping ratio": f"{loop['least_damping']:.5f}",
            "RMS displacement over no control, tangent": f"{loop['ratio']:.3f}",
            f"complete machine, {DURATION:g} s after a shock": f"{numbers['rms_over_no_control'][word]:.3f}",
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("gains")


def _figure(table: pd.DataFrame) -> Figure:
    figure = new_figure(9.0, 4.6)
    ax = figure.add_subplot()
    ratio, distance = (table[column].values.reshape(KI.size, KD.size) for column in ("rms_over_no_control", "distance"))
    ax.add_patch(Rectangle((0, 0), 1, 1, transform=ax.transAxes, color=_UNSTABLE, lw=0, zorder=0))
    finite = np.ma.masked_invalid(np.where(np.isinf(ratio), np.nan, ratio))
    shades = TwoSlopeNorm(1.0, 0.0, _MOST)
    mesh = ax.pcolormesh(KD, KI, finite, cmap="PuOr_r", norm=shades, shading="nearest", rasterized=True)
    ax.set(xscale="log", yscale="log", xlabel="derivative gain kd, 1/s", ylabel="integral gain ki, 1/s³")
    ax.contour(KD, KI, distance, levels=[NEAR], colors=[_LINE], linewidths=wide(1.8))
    for word, (ki, kd) in RUNS.items():
        ax.plot(kd, ki, "o", ms=8, color=ORANGE, mec="white", clip_on=False, zorder=4)
        box = {"boxstyle": "round,pad=0.2", "fc": "#ffffff", "ec": "none", "alpha": 0.85}
        ax.annotate(word, (kd, ki), xytext=(10, 0), textcoords="offset points", va="center", color=_LINE, bbox=box)
    figure.colorbar(mesh, ax=ax, label="RMS displacement over that without control", extend="max")
    dress(ax)
    ax.grid(False)
    return figure
