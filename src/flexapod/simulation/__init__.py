"""The complete machine in time, on a moving base.

May import: design, mechanics, excitation.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
