"""How do I describe my own machine in Python, and is it within its limits?

A design is a TOML text with units in its keys; `replace` changes numbers by the same keys, and `save` writes the file
that the command line and `fx.load` read.
"""

import sys

import numpy as np

import flexapod as fx

RADIUS, HEIGHT, MASS, STIFFNESS = 0.30, 0.40, 25.0, 5e6  # m, m, kg, N/m


def main(path: str | None = None) -> float:
    """The frequency of the vertical mode, Hz. path: where to save the design."""
    machine = fx.Hexapod.from_toml(fx.design.template("first machine")).replace(
        {
            "base.circle": {"radius": RADIUS, "angles_deg": [50, 70, 170, 190, 290, 310]},
            "platform.circle": {"radius": RADIUS, "angles_deg": [10, 110, 130, 230, 250, 350]},
            "platform.mass": MASS,
            "platform.mass_center": [0, 0, 0],
            "platform.inertia": np.diag([0.6, 0.6, 1.1]),
            "legs.stiffness": STIFFNESS,
            "legs.lower": None,  # legs without mass
            "legs.upper": None,
            "limits.leg_length_mm": [400, 520],
            "home.position": [0, 0, HEIGHT],
        }
    )
    home = fx.home_pose(machine)
    print(machine)
    print("leg lengths:", np.round(1e3 * fx.inverse_kinematics(machine, home), 1), "mm")
    for low in (0.0, 0.1):
        pose = fx.Pose([0, 0, HEIGHT - low])
        check = fx.check_limits(machine, pose)
        print(f"{100 * low:2.0f} cm below home:", "within limits" if check.ok else check.exceeded[0])
    vertical = next(i for i, mode in enumerate(fx.describe_modes(machine, home)) if mode.dominant == "z")
    hertz = fx.natural_modes(machine, home).omega[vertical] / (2 * np.pi)
    print(f"it bounces up and down at {hertz:.2f} Hz")
    if path is not None:
        machine.save(path)
        print(f"saved as {path}; see it with: flexapod report {path}")
    return float(hertz)


if __name__ == "__main__":
    main(*sys.argv[1:2])
