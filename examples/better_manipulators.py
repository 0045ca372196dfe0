"""How much better can the paper's two manipulators be within the footprint and leg stroke they have?

Every base and platform joint may move by a little in its plane. The index is the least over a workspace about home, and
the best-conditioned design within the same limits is found as well: the paper's point is that it is not the best one.
"""

import numpy as np

import flexapod as fx

#: How far a joint may move (m), half the workspace (m), and how near legs may come (m).
MACHINES = {"mukherjee-i": (0.10, 0.05, 0.02), "mukherjee-ii": (0.01, 0.005, 0.005)}


def main(trials: int = 0, points: int = 2**12, verify: int = 2**17) -> dict[str, dict[str, float]]:
    told = {}
    for name, (reach, half, clearance) in MACHINES.items():
        machine = fx.load(name)
        workspace = fx.Workspace.about_home(half, np.radians(5))
        variables = [
            fx.Variable(f"{plate}.joints[{leg}][{axis}]", -reach, reach, kind="add")
            for plate in ("base", "platform")
            for leg in range(6)
            for axis in (0, 1)
        ]
        limits = [
            fx.optimisation.Footprint(),
            fx.optimisation.Footprint(plate="platform"),
            fx.optimisation.Stroke(region=workspace),
            fx.optimisation.LegClearance(clearance, region=workspace),
        ]
        options = {"trials": trials, "samples": points, "verify": verify}
        best = fx.optimise(machine, variables, fx.LeastIndex(workspace), limits, **options)
        dexterous = fx.optimise(machine, variables, fx.optimisation.Dexterity(workspace), limits, **options)
        box = workspace.box(np.concatenate([machine.home.position, machine.home.rpy]))
        told[name] = {
            "as printed": best.start_index,
            "best": best.index,
            "best conditioned": fx.worst_pose(dexterous.hexapod, box).omega_1,
            "cond(H) as printed": 1 / dexterous.start_index,
            "cond(H) best": float(
                fx.sweep(best.hexapod, fx.workspace.low_discrepancy(box, points), quantities="cond_H").cond_H.max()
            ),
            "cond(H) best conditioned": 1 / dexterous.index,
        }
        print(f"{name}, over {workspace!r}, least index and largest cond(H):")
        for design in ("as printed", "best conditioned", "best"):
            print(f"  {design:16} {told[name][design]:8.4g} rad/s {told[name][f'cond(H) {design}']:8.4g}")
    return told


if __name__ == "__main__":
    main()
