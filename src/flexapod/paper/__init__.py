"""The figures of P. Mukherjee, B. Dasgupta, A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
Stewart platform", Journal of Sound and Vibration (2007), drawn anew. Each module has `draw(figure, settings)`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

from flexapod.states import JointModel

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

#: Number of the figure -> module of this package that draws it.
FIGURES = {2: "scatter", 3: "scatter", 4: "scatter", 5: "scatter", 7: "vibration", 8: "vibration", 9: "vibration"}


class Settings(NamedTuple):
    """What may be chosen; each figure takes what concerns it. None is the figure's own default."""

    points: int | None = None
    seed: int = 0
    joint: JointModel = "spin_free"
    threads: int | None = None


class PaperFigure(NamedTuple):
    """A figure, what it shows in words (with the choices the paper leaves open), and the numbers to compare with it.

    table: what is drawn, where it is small enough to be written beside the figure.
    """

    number: int
    figure: Figure
    caption: str
    numbers: dict[str, Any]
    table: DataFrame | None = None


def draw(number: int, settings: Settings) -> PaperFigure:
    """Draw a figure by its number in the paper."""
    module = import_module(f"flexapod.paper.{FIGURES[number]}")
    found: PaperFigure = module.draw(number, settings)
    return found
