"""Vibration in the frequency domain: transmissibility, random response, and the stepped sine.

May import: design, mechanics, excitation, simulation.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
