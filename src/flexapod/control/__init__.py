"""Controllers on the linearised machine and on the complete one.

May import: paths and what lies below it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
