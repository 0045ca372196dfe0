"""Can I promise that my motion base stays above 4 Hz everywhere in its workspace, with oil that is only known to 5 %?

A sweep finds no pose below it, but a promise needs a proof: a certificate bounds the lowest natural frequency at every
pose of the box at once, and for every bulk modulus in the range.
"""

import numpy as np

import flexapod as fx

PROMISED = 4.0  # Hz


def main() -> float:
    """The bound that is proved, Hz."""
    machine = fx.load("motion-base")
    box = fx.Box.about(fx.home_pose(machine), 0.05, np.radians(3))
    tolerance = fx.Uncertain("legs.stiffness_law.bulk_modulus", 0.05)
    lowest = float(fx.sweep(machine, box, samples=2**12).omega_1.min()) / (2 * np.pi)
    print(f"the lowest of {2**12} poses has {lowest:.3f} Hz, with oil as stiff as drawn")

    promise = fx.certify(machine, box, at_least=2 * np.pi * PROMISED, uncertain=tolerance)
    print(f"{PROMISED} Hz everywhere, with oil 5 % softer: {promise.status}")
    closest = fx.certify(machine, box, uncertain=tolerance)
    proved, known = closest.lower / (2 * np.pi), closest.upper / (2 * np.pi)
    print(f"proved: {proved:.4f} Hz; some pose and bulk modulus have {known:.4f} Hz")
    print(f"{closest.boxes} boxes in {closest.seconds:.2f} s")
    return proved


if __name__ == "__main__":
    main()
