"""Draws the picture of the README: `python docs/images/draw.py`."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import flexapod as fx
from flexapod import plots
from flexapod.plots import style


def main() -> None:
    """A motion base, and its six modes."""
    hexapod = fx.load("motion-base")
    pose = fx.home_pose(hexapod)
    modes = fx.natural_modes(hexapod, pose)
    words = [mode.dominant for mode in fx.describe_modes(hexapod, pose)]
    figure = plt.figure(figsize=(12, 5.4), facecolor="white")
    left, right = figure.subfigures(1, 2, width_ratios=(5, 7))
    for part in (left, right):
        part.set_facecolor("white")
    plots.machine(hexapod, pose, ax=left.add_subplot(projection="3d", position=(0.02, 0.02, 0.77, 0.96)))
    for i, hz in enumerate(modes.omega / (2 * np.pi)):
        place = (i % 3 / 3, 0.49 - 0.49 * (i // 3), 1 / 3, 0.44)
        ax = right.add_subplot(projection="3d", position=place)
        plots.mode(hexapod, pose, modes, i + 1, ax=ax)
        ax.set_title(f"{hz:.2f} Hz, {words[i]}", y=1.04, fontsize=11, color=style.INK)
    figure.savefig(Path(__file__).with_name("modes.png"), dpi=110)


if __name__ == "__main__":
    main()
