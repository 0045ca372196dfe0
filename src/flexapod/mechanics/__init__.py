"""The machine at a pose: kinematics, dynamics, statics, natural modes, and the linearised dynamics.

May import: design.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
