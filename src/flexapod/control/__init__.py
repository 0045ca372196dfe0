"""Controllers on the linearised machine and on the complete one.

May import: design, mechanics, workspace, excitation, simulation, vibration, paths.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
