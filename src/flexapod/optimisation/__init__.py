"""Better designs, trade-offs between wishes, and the robustness of a design.

May import: paths and what lies below it.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
