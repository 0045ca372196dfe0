"""P. Mukherjee, B. Dasgupta, A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible Stewart
platform", Journal of Sound and Vibration (2007), done anew: its figures, its frequencies, its conclusions, its errors.

Each part of it is a module here with `draw(name, settings)`, which gives a `Part`: a figure, the numbers behind it, and
what the paper says beside what is found.

May import: design, mechanics, workspace, excitation, simulation, vibration, optimisation, control, interchange,
plots.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from flexapod.conventions import JointModel

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

_MANY = 1500  # points of a line
_MARGIN = 0.08  # inches round a figure: words are a little wider at some resolutions

#: Number of the figure -> module of this package that draws it.
FIGURES = {2: "scatter", 3: "scatter", 4: "scatter", 5: "scatter", 7: "vibration", 8: "vibration", 9: "vibration"}

#: Name of a part -> the module that makes it, in the order of the report.
PARTS = {
    **{f"figure-{number}": module for number, module in FIGURES.items()},
    "natural-frequencies": "frequencies",
    "conclusion-1": "criteria",
    "conclusion-2": "gains",
    "conclusion-3": "sampling_rate",
    "corrections": "corrections",
    "readings": "data_interpretation",
}


class Settings(NamedTuple):
    """What may be chosen; each part takes what concerns it. None is the part's own default."""

    points: int | None = None
    seed: int = 0
    joint: JointModel = "spin_free"
    threads: int | None = None


Verdict = Literal["agrees", "differs", "open"]


class Claim(NamedTuple):
    """What the paper says, what is found here, and how they compare: "open" where the paper tells too little."""

    paper: str
    ours: str
    verdict: Verdict
    why: str = ""


def agrees(holds: bool) -> Verdict:
    """The verdict on a statement that holds here or not."""
    return "agrees" if holds else "differs"


class Part(NamedTuple):
    """A figure, what it shows in words (with the choices the paper leaves open), and the numbers behind it.

    name: of its files. claims: the paper beside what is found. table: what is drawn, as numbers. shown: a table for
    readers, all words, where the part has one.
    """

    name: str
    title: str
    figure: Figure
    caption: str
    numbers: dict[str, Any]
    claims: tuple[Claim, ...]
    table: DataFrame
    shown: DataFrame | None = None


def draw(name: str, settings: Settings) -> Part:
    """Make a part of the paper by its name in `PARTS`."""
    import matplotlib

    from flexapod.plots.style import INK, unshown

    module = import_module(f"flexapod.paper.{PARTS[name]}")
    words = dict.fromkeys(("text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color"), INK)
    with matplotlib.rc_context(words), unshown():  # type: ignore[arg-type]
        found: Part = module.draw(name, settings)
        _ready(found.figure)
    return found


def _ready(figure: Figure) -> None:
    """Laid out once for the files to come; lines of very many points as pixels, or vector files would be megabytes."""
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    from flexapod.plots.shared import laid_out

    engine = figure.get_layout_engine()
    if isinstance(engine, ConstrainedLayoutEngine):
        engine.set(w_pad=_MARGIN, h_pad=_MARGIN)
    figure.draw_without_rendering()
    laid_out(figure)
    for ax in figure.axes:
        for line in ax.get_lines():
            line.set_rasterized(np.size(line.get_xdata()) > _MANY)
