"""Many poses: sets of poses, sweeps in memory, on disk and on clusters, summaries, and the worst pose.

May import: mechanics and what lies below it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
