"""Certificates: bounds that are proved at every pose of a region, not sampled.

May import: design, mechanics, workspace.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
