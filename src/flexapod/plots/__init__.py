"""Figures and animations of results. Nothing is computed here but where to draw.

    fx.plots.machine(hexapod, pose)
    fx.plots.mode(hexapod, pose, fx.natural_modes(hexapod, pose), 1).figure.savefig("mode-1.png")

Without `ax` a new figure is made.

May import: design, mechanics, workspace, paths, optimisation.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
