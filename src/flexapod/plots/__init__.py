"""Figures and animations of results. Nothing is computed here but where to draw.

    fx.plots.machine(hexapod, pose)
    fx.plots.save(fx.plots.mode(hexapod, pose, fx.natural_modes(hexapod, pose), 1), "mode-1.pdf")

What draws on one pair of axes takes `ax` and returns it; what draws on several takes `figure`, a Figure or a SubFigure,
and returns that. Without them a new figure is made. Matplotlib's rcParams hold where they are changed; `for_print`
draws for a page.

May import: design, mechanics, workspace, paths, optimisation.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
