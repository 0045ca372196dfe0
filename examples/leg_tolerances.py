"""Does my machine keep its frequency if its legs are up to 10 % softer than ordered and the payload is not known well?

Legs stray on their own, the payload's mass and place too; the worst of all combinations is searched, not only drawn.
"""

import numpy as np

import flexapod as fx

WANTED_HZ = 80.0


def main() -> float:
    """The least lowest frequency within the tolerances, Hz."""
    machine = fx.load("precision-positioner")
    tolerances = [
        fx.Uncertain("legs.stiffness_law.fixed", 0.10),  # bearings and nuts
        fx.Uncertain("legs.series_stiffness", 0.10),  # the joints
        fx.optimisation.Payload(mass=(0.0, 4.0), position=((-0.03, 0.03), (-0.03, 0.03), (0.10, 0.15))),
    ]
    found = fx.robustness(machine, tolerances, samples=2**11)
    hertz = 1 / (2 * np.pi)
    print(f"as designed: {found.nominal * hertz:.1f} Hz")
    print(f"drawn at random: {found.mean * hertz:.1f} Hz, give or take {found.deviation * hertz:.1f} Hz")
    print(f"one machine in a hundred has less than {found.quantiles[0.01] * hertz:.1f} Hz")
    print(f"the worst has {found.worst * hertz:.1f} Hz, with")
    for name, value in found.worst_at.items():
        print(f"  {name} = {value:.6g}")
    print("answer:", "yes" if found.worst * hertz >= WANTED_HZ else "no", f"({WANTED_HZ:.0f} Hz are wanted)")
    return found.worst * hertz


if __name__ == "__main__":
    main()
