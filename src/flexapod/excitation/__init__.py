"""What drives a machine in time: base motions, loads, leg commands, recordings, and random spectra.

May import: pose and what lies below it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
