"""Which leg, mass or dimension should I change first to raise the lowest frequency?

Exact derivatives of the frequencies by every number of the design, as percent of the frequency
for a percent of the number, or for a millimetre.
"""

import numpy as np

import flexapod as fx

SPRINGS = {
    "bearings": "legs.stiffness_law.fixed",
    "screws": "legs.stiffness_law.axial_rigidity",
    "joints": "legs.series_stiffness",
}


def main() -> float:
    """Percent of the lowest frequency for one percent more stiffness of the leg that matters most."""
    machine = fx.load("precision-positioner")
    pose = fx.Pose.from_rpy(0.001, 0.001, 0.2443, 0.02, -0.015, 0.01)
    omega = fx.natural_modes(machine, pose).omega
    by = fx.frequency_sensitivity(machine, pose)

    values = machine.values()
    springs = {  # for mode 1, leg by leg; each leg has its bearing, its screw and two joints in series
        name: (by.springs[key][0] * values[key]).reshape(6, -1).sum(axis=1) / omega[0] for name, key in SPRINGS.items()
    }
    legs = sum(springs.values())
    mass = by.platform_mass[0] * machine.platform_mass / omega[0]
    rods = (by.lower_mass[0] * machine.legs.lower.mass + by.upper_mass[0] * machine.legs.upper.mass).sum() / omega[0]
    height = by.platform_mass_center[0, 2] * 1e-3 / omega[0]  # one millimetre higher
    joints = by.base_joints[0] * 1e-3 / omega[0]
    leg, axis = np.unravel_index(np.abs(joints).argmax(), joints.shape)

    print(f"mode 1 at {omega[0]:.1f} rad/s; effect on its frequency:")
    print("  1 % stiffer leg:   ", ", ".join(f"leg {i}: {x:+.3f} %" for i, x in enumerate(legs, 1)))
    print("  1 % stiffer in all:", ", ".join(f"{name}: {each.sum():+.3f} %" for name, each in springs.items()))
    print(f"  1 % more platform:  {mass:+.3f} %, mass alone, with its inertia held")
    print(f"  1 % heavier rods:   {rods:+.3f} %")
    print(f"  mass centre 1 mm up: {100 * height:+.3f} %")
    print(f"  most of all joints: base joint {leg + 1} by 1 mm along {'xyz'[axis]}: {100 * joints[leg, axis]:+.3f} %")
    share = fx.mechanics.energy_shares(machine, pose).strain[:, 0]
    print(f"leg {share.argmax() + 1} holds {share.max():.1%} of the mode's strain energy: stiffen it first")
    return float(legs.max())


if __name__ == "__main__":
    main()
