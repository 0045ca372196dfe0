"""The machine in notebooks: 3-D, with sliders of the pose and modes that move, drawn by the code of the page.

    view = fx.view(hexapod)      # shows itself where a cell ends with it
    view.pose = [0, 0, 0.5, 0, 0.1, 0]

May import: design, mechanics, report, web.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
