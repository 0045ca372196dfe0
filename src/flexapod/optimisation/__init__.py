"""Better designs, trade-offs between wishes, and the robustness of a design.

May import: design, mechanics, workspace, certificates.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
