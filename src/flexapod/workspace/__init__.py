"""Many poses: sets of poses, sweeps in memory, on disk and on clusters, summaries, and the worst pose.

May import: design, mechanics.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
