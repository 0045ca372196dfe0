"""Trajectories through the workspace: their stability, their loads, and how to plan them.

May import: workspace and what lies below it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
