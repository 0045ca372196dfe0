"""Draws the figure of docs/motor-sizing.md, from what that page says: python docs/images/draw_motors.py"""

import io
import re
from pathlib import Path

import numpy as np

import flexapod as fx
from flexapod.plots import path

HERE = Path(__file__).parent


def block(page: str, title: str) -> str:
    """The text of a block of the page, by its title."""
    found = re.search(rf'title="{re.escape(title)}"\n(.*?)```', page, re.DOTALL)
    assert found is not None
    return found[1]


def main() -> None:
    page = (HERE.parent / "motor-sizing.md").read_text(encoding="utf-8")
    machine = fx.Hexapod.from_toml(fx.design.template("my-machine") + block(page, "my-machine.toml"))
    time, *rows = np.loadtxt(io.StringIO(block(page, "motion.csv")), delimiter=",", skiprows=1).T
    waypoints = np.column_stack([*rows[:3], *np.radians(rows[3:])])
    loads = fx.paths.path_loads(machine, fx.Trajectory(waypoints, time, origin=machine.home))
    path.motors(fx.paths.motor_loads(machine, loads, hold=1.5)).figure.savefig(HERE / "motors.png", dpi=110)


if __name__ == "__main__":
    main()
