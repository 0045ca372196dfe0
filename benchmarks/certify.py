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
QUICK = 2  # so many of them take one turn within seconds
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
    """The proofs on one core, and the smallest by ball arithmetic too: no other tool bounds frequencies over poses."""
    contenders = []
    for name, size, _ in CASES:
        machine = machine_of(name)
        box = box_of(machine, plan.size(size, 2))
        words = f"{name}, {plan.size(size, 2)} % and degrees, to 1 %"
        run = cpu_seconds(lambda machine=machine, box=box: proved(machine, box, 1))
        contenders.append(Contender(OURS, "flexapod", words, run))
    return [
        Contest("Proved bound over a box", "box", "", contenders[:QUICK]),
        Contest("Proved bound over a large box", "box", "", contenders[QUICK:], most_turns=1),
        smallest(plan),
    ]


def smallest(plan: Plan) -> Contest:
    """A box of 1 % and 1 degree to 10 %, by Taylor models and by the tests' balls with mean values."""
    machine = machine_of("motion-base")
    size = 0.2 if plan.quick else 1.0
    box = box_of(machine, size)
    level = 0.9 * fx.certify(machine, box).upper
    words = f"motion-base, {size:g} % and degrees, to 10 %"
    ours = cpu_seconds(lambda: proved(machine, box, 1, at_least=level))
    contenders = [Contender(OURS, "flexapod", words, ours)]
    if plan.has("python-flint"):
        from tests.oracles import exact_bounds

        sides = np.stack([box.low, box.high], axis=-1)
        balls = cpu_seconds(lambda: exact_bounds.proved(machine, sides, level))
        contenders.append(Contender("python-flint", "python-flint", f"{words}, mean value form in balls", balls))
    return Contest("Proved bound over the smallest box", "box", "", contenders, most_turns=3)


def proved(machine: fx.Hexapod, box: fx.Box, threads: int | None, at_least: float | None = None) -> fx.Certificate:
    found = fx.certify(machine, box, at_least=at_least, threads=threads)
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
