"""The machine at a pose: kinematics, dynamics, statics, natural modes, and the linearised dynamics.

May import: design and what lies below it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
