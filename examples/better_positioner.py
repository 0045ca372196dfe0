"""Which joint circles and height make my positioner stiffest against vibration, on the same plates?

The joint circles keep their symmetry, the height may change, and the search may be stopped and run again: its trials
are in a file. Then the index is traded against the footprint; the better design is judged with uncertain legs and load.
"""

from pathlib import Path
from tempfile import mkdtemp

import numpy as np

import flexapod as fx
from flexapod.plots import optimisation


def main(trials: int = 200, points: int = 2**12, verify: int = 2**17, samples: int = 2**14) -> dict[str, float]:
    machine = fx.load("precision-positioner")
    folder = Path(mkdtemp(prefix="better-positioner-"))
    variables = [
        fx.optimisation.JointCircle("base", radius=(0.12, 0.20), half_angle=(0.05, 0.9)),
        fx.optimisation.JointCircle("platform", radius=(0.09, 0.15), half_angle=(0.05, 0.9)),
        fx.Variable("home.position_mm[2]", 200, 270),
    ]
    workspace = fx.Workspace.about_home(0.002, np.radians(0.5))
    limits = [fx.optimisation.DesignLimits(), fx.optimisation.Footprint(plate="platform")]
    options = {"samples": points, "trials": trials}

    better = fx.optimise(
        machine,
        variables,
        fx.LeastIndex(workspace),
        [*limits, fx.optimisation.Footprint()],
        study=folder / "study.db",
        verify=verify,
        **options,
    )
    better.hexapod.save(folder / "better.toml")
    optimisation.plan(better).savefig(folder / "plan.png")
    print(f"least index {better.start_index:.5g} -> {better.index:.5g} rad/s; files in {folder}")

    front = fx.pareto_front(
        machine, variables, fx.optimisation.Footprint(), fx.LeastIndex(workspace), limits, refine=5, **options
    )
    optimisation.front(front).figure.savefig(folder / "front.png")

    uncertain = [
        fx.Uncertain("legs.stiffness_law.fixed", 0.1),
        fx.optimisation.Payload((0, 5), ((-0.05, 0.05), (-0.05, 0.05), (0.1, 0.2))),
    ]
    strays = fx.robustness(better.hexapod, uncertain, samples=samples)
    print(f"with uncertain legs and load at home: {strays.nominal:.5g}, at worst {strays.worst:.5g} rad/s")
    return {"before": better.start_index, "after": better.index, "designs": len(front.designs), "worst": strays.worst}


if __name__ == "__main__":
    main()
