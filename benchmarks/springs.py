"""What springs in joints, a suspension and stiffness laws cost a sweep: pairs with the plain machine in each turn."""

import time
from functools import reduce
from operator import or_
from statistics import median

import numpy as np

import flexapod as fx
from flexapod import _core

TURNS, POSES = 60, 4096
TASKS = {"omega_1": ("omega_1",), "omega_1 + cond_H": ("omega_1", "cond_H"), "all six": ("omega",)}
OIL = {"bulk_modulus": 1.2e9, "area_1": 5e-3, "area_2": 3e-3, "dead_1": 0.1, "dead_2": 0.1, "stroke": 1.6}
JOINTS = {f"legs.joint_stiffness.{name}": 2e4 for name in ("universal", "spherical", "torsion")}


def machines() -> dict[str, fx.Hexapod]:
    """The motion base as it is, and with each kind of spring."""
    plain = fx.load("motion-base").replace({"legs.series_stiffness": None})
    stiffness = plain.legs.stiffness if plain.legs.stiffness_law is None else np.full(6, 8e6)
    plain = plain.replace({"legs.stiffness_law": None, "legs.stiffness": stiffness})
    oil = {"kind": "hydraulic", "shortest": 1.9, **OIL}
    table = {"kind": "table", "lengths": [1.8, 2.0, 2.3, 2.6, 3.0, 3.4], "stiffnesses": [9e6, 8e6, 7e6, 5e6, 4e6, 3e6]}
    law, nodes = ({f"legs.stiffness_law.{key}": v for key, v in of.items()} for of in (oil, table))
    return {
        "plain": plain,
        "columns of oil": plain.replace({"legs.stiffness": None, **law}),
        "table": plain.replace({"legs.stiffness": None, **nodes}),
        "springs in joints": plain.replace(JOINTS),
        "suspension": plain.replace({"suspension.stiffness": np.diag([1e5] * 6)}),
        "oil, joints": plain.replace({"legs.stiffness": None, **law, **JOINTS}),
    }


def main() -> None:
    found = {name: hexapod.packed for name, hexapod in machines().items()}
    home = fx.load("motion-base").home
    middle = np.concatenate([home.position, home.rpy])
    poses = middle + np.random.default_rng(0).uniform(-0.2, 0.2, (POSES, 6))
    for task, names in TASKS.items():
        asked = reduce(or_, (_core.SweepQuantity[name] for name in names))

        def run(design, asked=asked) -> float:
            start = time.process_time()
            _core.sweep(design, _core.Joint.universal, poses, asked, _core.SweepLimits(), 1)
            return time.process_time() - start

        turns = [{name: run(design) for name, design in found.items()} for _ in range(TURNS)]
        rate = POSES / min(turn["plain"] for turn in turns)
        print(f"{task}: {rate:.3g} poses/s of the plain machine on one core ({_core.simd()})")
        for name in found:
            ratio = median(turn["plain"] / turn[name] for turn in turns)
            print(f"    {name:20s} {ratio:6.0%}")


if __name__ == "__main__":
    main()
