"""Trajectories through the workspace: their stability, their loads, and how to plan them.

May import: design, mechanics, workspace, certificates.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
