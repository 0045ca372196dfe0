"""A machine, a pose and a box of poses, as the tests ask the server for them."""

import numpy as np

import flexapod as fx
from flexapod.design import design_file

TEXT = design_file.find("mukherjee-ii").read_text(encoding="utf-8")
MACHINE = fx.load("mukherjee-ii")
ASKED = {"design": TEXT, "pose": [0.001, 0.0, 0.086, 1.0, 2.0, 3.0]}
POSE = fx.Pose.from_rpy(0.001, 0.0, 0.086, *np.radians([1.0, 2.0, 3.0]))
BOX = {"low": [-0.01, -0.01, 0.08, -5, -5, -5], "high": [0.01, 0.01, 0.09, 5, 5, 5]}
LONG = {  # a simulation that takes minutes: its base shakes far faster than any mode
    "design": design_file.find("mukherjee-i").read_text(encoding="utf-8"),
    "pose": [0.1, 0.2, 0.8, 0, 0, 0],
    "duration": 60.0,
    "frequency": 1e5,
    "amplitude": 1e-9,
}
