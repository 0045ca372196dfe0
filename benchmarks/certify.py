"""Bounds proved to 1 % of the least index, over boxes about home of the packaged machines, with all cores.

Half widths are in per cent of the mean leg length and in degrees. "sampled" says by how much the least index of a
million random poses is above what some pose has.
"""

import time
from pathlib import Path

import numpy as np

import flexapod as fx
from benchmarks._contest import OURS, Contender, Contest, Plan, cpu_seconds

#: Machine, half width of the box, and the seconds in which two cores are to prove it.
CASES = (
    ("motion-base", 10, 1.0),
    ("cubic-isolator", 10, 1.5),
    ("mukherjee-ii", 10, 10.0),
    ("mukherjee-i", 10, 10.0),
    ("motion-base", 20, 12.0),
    ("mukherjee-ii", 20, 60.0),
)
IN_TABLE = CASES[:2]  # the others take too long for many turns
SAMPLES = 10**6
PLAIN = Path(__file__).parents[1] / "tests" / "data" / "machines"


def machine_of(name: str) -> fx.Hexapod:
    """The machine with joints that turn freely and one constant spring a leg, as calls and bounds are measured."""
    file = PLAIN / f"{name}.toml"
    return fx.load(file if file.exists() else name)


def box_of(machine: fx.Hexapod, size: float) -> fx.Box:
    """The box about home of so many per cent of the mean leg length and so many degrees."""
    home = fx.home_pose(machine)
    return fx.Box.about(home, size / 100 * float(np.mean(fx.inverse_kinematics(machine, home))), np.radians(size))


def contests(plan: Plan) -> list[Contest]:
    """The proofs that take seconds, on one core: no other tool bounds natural frequencies over poses."""
    contenders = []
    for name, size, _ in IN_TABLE:
        machine = machine_of(name)
        box = box_of(machine, plan.size(size, 2))
        words = f"{name}, {plan.size(size, 2)} % and degrees, to 1 %"
        run = cpu_seconds(lambda machine=machine, box=box: proved(machine, box, 1))
        contenders.append(Contender(OURS, "flexapod", words, run))
    return [Contest("Proved bound over a box", "box", "", contenders)]


def proved(machine: fx.Hexapod, box: fx.Box, threads: int | None) -> fx.Certificate:
    found = fx.certify(machine, box, threads=threads)
    if not found.proved:
        raise AssertionError(found.words)
    return found


def main() -> None:
    titles = f"{'proved':>9s} {'least':>9s} {'boxes':>8s} {'s':>7s} {'wanted':>6s} {'sampled':>8s}"
    print(f"{'machine':16s} {'box':>6s} {titles}")
    for name, size, wanted in CASES:
        machine = machine_of(name)
        box = box_of(machine, size)
        began = time.perf_counter()
        found = proved(machine, box, None)
        seconds = time.perf_counter() - began
        least = float(fx.sweep(machine, fx.random_poses(box, SAMPLES), quantities="omega_1").omega_1.min())
        print(
            f"{name:16s} {size:3d}/{size:<3d}{found.lower:9.4f} {found.upper:9.4f} {found.boxes:8d} {seconds:7.2f} "
            f"{wanted:6.1f} {least / found.upper - 1:8.1%}",
            flush=True,
        )


if __name__ == "__main__":
    main()
