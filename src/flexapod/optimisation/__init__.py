"""Better designs, trade-offs between wishes, and the robustness of a design.

May import: paths and what lies below it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
