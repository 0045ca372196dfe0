"""What drives a machine in time: base motions, loads, leg commands, recordings, and random spectra.

May import: design.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
