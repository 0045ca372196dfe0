"""The same machine written for other tools: MuJoCo, URDF, SDF, and the state space for MATLAB and python-control."""
