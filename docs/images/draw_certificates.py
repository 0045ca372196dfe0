"""Draws the figure of docs/certificates.md: python docs/images/draw_certificates.py"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import flexapod as fx
from flexapod.plots import style

HERE = Path(__file__).parent
SIZES = np.array([1, 2, 3, 4, 5, 6, 7, 8, 9, 10])  # per cent of the legs' length, and degrees
POSES = 1000


def main() -> None:
    """The isolator: least index of 1000 poses, the least that descents find, and what is proved, as the box grows."""
    machine = fx.load("cubic-isolator").replace({"legs.joint_stiffness": None, "legs.series_stiffness": None})
    home = fx.home_pose(machine)
    length = float(np.mean(fx.inverse_kinematics(machine, home)))
    sampled, found, proved = [], [], []
    for size in SIZES:
        box = fx.Box.about(home, size / 100 * length, np.radians(size))
        sampled.append(float(fx.sweep(machine, fx.random_poses(box, POSES)).omega_1.min()))
        certificate = fx.certify(machine, box)
        found.append(certificate.upper)
        proved.append(certificate.lower)
    figure, ax = plt.subplots(figsize=(7.5, 4.4), layout="constrained", facecolor="white")
    ax.plot(SIZES, sampled, "o", color=style.ORANGE, label=f"least of {POSES} random poses")
    ax.plot(SIZES, found, "-", color=style.INK, linewidth=1, label="least that is found")
    ax.plot(SIZES, proved, "s", color=style.BLUE, markersize=5, label="proved at every pose of the box")
    ax.fill_between(SIZES, proved, 0, color=style.BLUE, alpha=0.08, linewidth=0)
    ax.set_xlabel("half the width of the box: % of the length of the legs, and degrees")
    ax.set_ylabel("stability index, rad/s")
    ax.set_ylim(0.6 * min(proved), None)
    ax.set_xticks(SIZES)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    ax.legend(frameon=False)
    figure.savefig(HERE / "certificates.png", dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
