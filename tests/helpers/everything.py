"""A machine with all that a design may say: law, springs in series and in joints, suspension, drive, points, limits."""

import numpy as np

import flexapod as fx


def machine_with_everything() -> fx.Hexapod:
    """The precision positioner as packaged, and what it lacks."""
    positioner = fx.load("precision-positioner")
    motor = {
        "speeds_rpm": [0, 3000, 5000],
        "peak_torques": [0.95, 0.95, 0.6],
        "continuous_torques": [0.32, 0.32, 0.2],
        "max_speed_rpm": 4000,
    }
    drive = {"lead_mm": 1, "efficiency": 0.9, "gear_ratio": 2, "rotor_inertia_kg_cm2": 0.06, "motor": motor}
    stiffness, damping = np.diag([2e4, 2e4, 5e4, 1e3, 1e3, 1e3]), np.diag([10, 10, 20, 1, 1, 1])
    return positioner.replace(
        {
            "legs.loss_factor": 0.01,
            "legs.joint_rest": {"position": [0, 0, 0.2441]},
            "suspension": {"stiffness": stiffness, "damping": damping, "point": [0, 0, 0.01]},
            "drive": drive,
            "points": {"vertex_mm": [0, 0, 100], "eye": [0.05, 0, 0.1]},
            "limits.leg_compression": 500,
            "limits.leg_tension": 500,
            "limits.leg_rate": 0.1,
            "limits.leg_acceleration": 5,
            "limits.leg_power": 100,
        }
    )
