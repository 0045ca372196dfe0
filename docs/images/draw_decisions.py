"""Draws the figures of docs/paths.md and docs/control.md: python docs/images/draw_decisions.py"""

from pathlib import Path

import numpy as np

import flexapod as fx
from flexapod.plots import control as plots_control
from flexapod.plots import path

HERE = Path(__file__).parent


def plan() -> None:
    """Manipulator I: a straight line through a weak region, and the plan round it."""
    machine = fx.load("mukherjee-i")
    start = fx.Pose.from_rpy(0, 0, 0.89, *np.radians([0, -33, -10]))
    goal = fx.Pose.from_rpy(0, 0, 0.89, *np.radians([0, 45, 53]))
    found = fx.plan_path(machine, start, goal, 110.0, timing=2.0)
    path.plan_map(fx.paths.plan_slice(machine, found)).figure.savefig(HERE / "plan.png", dpi=110)
    along = fx.path_index(machine, found.path, bound=110.0)
    straight = fx.path_index(machine, found.straight, bound=110.0, singular="keep")
    path.index_along(along, straight).figure.savefig(HERE / "plan-index.png", dpi=110)


def control() -> None:
    """The soft isolator: damping by force feedback, and LQG on a shaken base."""
    machine = fx.load("cubic-isolator")
    pose = fx.home_pose(machine)
    plots_control.root_locus(fx.control.root_locus(machine, pose, "force", leak=3.0)).figure.savefig(
        HERE / "locus.png", dpi=110
    )
    law = fx.control.lqg(machine, pose).sampled(2e-3)
    base = fx.random_motion("z", fx.excitation.flat_spectrum(0.01, 5.0, 200.0), seed=1)
    run = fx.control.simulate_control(machine, pose, controller=law, base_motion=base, duration=10.0)
    plots_control.controlled_run(run).figure.savefig(HERE / "isolation.png", dpi=110)


if __name__ == "__main__":
    plan()
    control()
