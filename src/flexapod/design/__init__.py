"""Designs of hexapods: read from files and tables, checked, changed, and written.

May import: no other package.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
