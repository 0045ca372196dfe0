"""The machine in the formats of other tools: MuJoCo, URDF, SDF, MATLAB.

May import: design, mechanics.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
