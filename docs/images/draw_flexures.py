"""Draws the figure of docs/flexures.md: python docs/images/draw_flexures.py"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import flexapod as fx
from flexapod.plots import style

HERE = Path(__file__).parent
BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"  # of Okabe and Ito


def draw() -> None:
    flexures = fx.design.flexures
    steel = flexures.Material(200e9, 400e6)
    diameter = np.geomspace(0.4e-3, 2e-3, 60)
    necks = [flexures.round_notch(4e-3, d, steel) for d in diameter]
    machine = fx.load("cubic-isolator").replace({"gravity": [0, 0, 0], "limits": None})
    soft = [machine.replace(flexures.leg_keys(neck, neck)) for neck in necks]
    omega = np.array([fx.natural_modes(one).omega for one in soft])
    zero = np.array([fx.control.open_zeros(fx.linearise(one), "force") for one in soft])
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2), facecolor="white", layout="constrained")
    mm = 1e3 * diameter
    for name, values, colour, dash in (
        ("bending, N m/rad", [neck.bending[0] for neck in necks], BLUE, "-"),
        ("torsion, N m/rad", [neck.torsion for neck in necks], ORANGE, "--"),
        ("axial, N/\u00b5m", [neck.axial / 1e6 for neck in necks], GREEN, "-."),
        ("largest angle, mrad", [1e3 * neck.angle for neck in necks], style.INK, ":"),
    ):
        left.plot(mm, values, dash, color=colour, label=name)
    left.set(xscale="log", yscale="log", xlabel="least diameter, mm", title="A round notch of 4 mm radius")
    for name, values, colour in (("frequencies", omega, BLUE), ("zeros of force feedback", zero, ORANGE)):
        right.fill_between(mm, values[:, 0], values[:, -1], color=colour, alpha=0.35, label=name)
    right.set(xscale="log", xlabel="least diameter, mm", ylabel="rad/s", title="cubic-isolator on two of them a leg")
    for ax in (left, right):
        ax.set_xticks([0.4, 0.6, 1.0, 1.5, 2.0], ["0.4", "0.6", "1", "1.5", "2"])
        ax.minorticks_off()
        ax.grid(alpha=0.3)
        ax.legend(frameon=False)
    right.set_ylim(bottom=0)
    figure.savefig(HERE / "flexures.png", dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    draw()
