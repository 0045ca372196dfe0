"""Vibration in the frequency domain: transmissibility, random response, and the stepped sine.

May import: simulation and what lies below it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
