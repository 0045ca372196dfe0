"""The machine in the formats of other tools: MuJoCo, URDF, SDF, MATLAB.

May import: mechanics and what lies below it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
