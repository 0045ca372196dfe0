"""Draws the figures of the how-to pages, and that of modes.md in README.md: python docs/images/draw_guides.py"""

from __future__ import annotations

import sys
from contextlib import chdir
from pathlib import Path
from shutil import copy
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import flexapod as fx
from flexapod import plots
from flexapod.plots import optimisation, response, style, sweep
from flexapod.plots import simulation as plots_simulation

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1]))

from tests.helpers.documents import blocks  # noqa: E402


def save(made: style.Drawn, name: str) -> None:
    figure = style.figure_of(made)
    figure.savefig(HERE / name, dpi=110)
    plt.close(figure)


def modes() -> None:
    """docs/modes.md: a motion base, and its six modes."""
    hexapod = fx.load("motion-base")
    pose = fx.home_pose(hexapod)
    found = fx.natural_modes(hexapod, pose)
    words = [mode.dominant for mode in fx.describe_modes(hexapod, pose)]
    figure = plt.figure(figsize=(12, 5.4), facecolor="white")
    left, right = figure.subfigures(1, 2, width_ratios=(5, 7))
    for part in (left, right):
        part.set_facecolor("white")
    plots.machine(hexapod, pose, ax=left.add_subplot(projection="3d", position=(0.02, 0.02, 0.77, 0.96)))
    for i, hz in enumerate(found.omega / (2 * np.pi)):
        place = (i % 3 / 3, 0.49 - 0.49 * (i // 3), 1 / 3, 0.44)
        ax = right.add_subplot(projection="3d", position=place)
        plots.mode(hexapod, pose, found, i + 1, ax=ax)
        ax.set_title(f"{hz:.2f} Hz, {words[i]}", y=1.04, fontsize=11, color=style.INK)
    save(figure, "modes.png")


def workspace() -> None:
    """docs/workspace.md: manipulator I over x and y, at the height and orientation of home."""
    machine = fx.load("mukherjee-i")
    home = fx.home_pose(machine)
    grid = fx.pose_grid(np.linspace(-0.1, 0.3, 121), np.linspace(0, 0.4, 121), home.position[2], *home.rpy)
    sweep.save(sweep.index_map(fx.sweep(machine, grid)), HERE / "map.png")


def envelope() -> None:
    """docs/envelope.md: a motion base along two axes at once."""
    machine = fx.load("motion-base")
    save(plots.envelope.pairs(fx.envelope(machine), machine.name), "envelope.png")


def figures() -> None:
    """docs/figures.md: its own example."""
    every = blocks((HERE.parent / "figures.md").read_text(encoding="utf-8"))
    (drawing,) = (block for block in every if "two-columns" in block.text)
    with TemporaryDirectory() as folder, chdir(folder):
        exec(drawing.text, {})
        copy("two-columns.png", HERE)


def statics() -> None:
    """docs/statics.md: a motion base that tilts."""
    elevation = np.radians(np.linspace(90, 15, 31))
    machine, gravity = fx.load("motion-base"), fx.mechanics.gravity_at(elevation)
    cases = fx.load_cases(machine, gravity=gravity, point=[0, 0, 0.5], reference=0)
    save(plots.statics.load_cases(cases, elevation), "statics.png")


def simulation() -> None:
    """docs/simulation.md: the positioner after a shock of its base."""
    machine = fx.load("precision-positioner")
    pose = fx.Pose.from_rpy(0.002, 0, 0.244, 0, 0, np.radians(2))
    shock = fx.half_sine_shock("z", 5.0, 0.005, recovery=0.02)
    run = fx.simulate(machine, pose, base_motion=shock, duration=0.1)
    save(plots_simulation.displacements(run.time.values, run.relative_displacement.values), "shock.png")


def vibration() -> None:
    """docs/vibration.md: how much of the base's x reaches the positioner."""
    machine = fx.load("precision-positioner")
    pose = fx.Pose.from_rpy(0.002, 0, 0.244, 0, 0, np.radians(2))
    passed = fx.transmissibility(machine, pose, omega=np.geomspace(100, 5000, 1500), loss_factor=0.01)
    natural = fx.natural_modes(machine, pose).omega
    save(response.frequency_response(passed, given="x", natural=natural), "response.png")


def robustness() -> None:
    """docs/robustness.md: how the positioner's index strays."""
    machine = fx.load("precision-positioner")
    uncertain = [
        fx.Uncertain("legs.stiffness_law.fixed", 0.1),
        fx.optimisation.Payload((0, 5), ((-0.05, 0.05), (-0.05, 0.05), (0.1, 0.2))),
    ]
    found = fx.robustness(machine, uncertain, samples=2**14, sensitivity=1024)
    save(optimisation.spread(found), "robust.png")
    save(optimisation.importance(found), "importance.png")


def optimal_design() -> None:
    """docs/optimal-design.md: manipulator II before and after the search of the guide."""
    machine = fx.load("mukherjee-ii")
    better = fx.optimise(
        machine,
        [
            fx.optimisation.JointCircle("base", radius=(0.02, 0.032), half_angle=(0.1, 0.95)),
            fx.optimisation.JointCircle("platform", radius=(0.03, 0.06), half_angle=(0.1, 0.95)),
            fx.Variable("home.position_mm[2]", 70, 100),
        ],
        fx.LeastIndex(fx.Workspace.about_home(0.005, np.radians(5))),
        [fx.optimisation.Footprint(), fx.optimisation.Stroke()],
    )
    print(f"{better.start_index:.4g} -> {better.index:.4g} rad/s")
    save(optimisation.plan(better), "better.png")


if __name__ == "__main__":
    for draw in (modes, workspace, envelope, figures, statics, simulation, vibration, robustness, optimal_design):
        draw()
