"""Controllers on the linearised machine and on the complete one.

May import: paths and what lies below it.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
