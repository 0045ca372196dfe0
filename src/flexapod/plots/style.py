"""Colours, axes and titles of all figures.

The colours of curves are those of Okabe and Ito: colour-blind readers tell them apart, on light and dark paper.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure
    from numpy.typing import NDArray

    Drawn = Figure | SubFigure | Axes  # what the functions of the plots give

INK = "#20262d"  # words and numbers
FAINT = "#8a929b"  # what is there for orientation only
NO_VALUE = "#d5d9de"
BASE = "#6b7785"
LEG = "#4a5460"

BLUE, ORANGE, GREEN = "#0072b2", "#d55e00", "#009e73"
PURPLE, SKY, AMBER = "#cc79a7", "#56b4e9", "#e69f00"
SIX = (BLUE, ORANGE, GREEN, PURPLE, SKY, AMBER)  # modes, legs
PLATFORM, STRETCHED, SHORTENED = BLUE, ORANGE, SKY
TRIAD = (("x", ORANGE), ("y", GREEN), ("z", BLUE))
DASHED = (0, (5, 2))

VALUES = "viridis"  # even in lightness
VIEW = {"elev": 20.0, "azim": -62.0}
#: Sizes of words beside `font.size`, where the user's rcParams do not say another.
_SIZES = {
    "xtick.labelsize": 0.9,
    "legend.fontsize": 0.9,
    "axes.titlesize": 1.0,
    "figure.titlesize": 1.1,
    "axes.labelsize": 1.0,
}
_LEGEND = 0.15  # of a figure's height: what a legend may take of it
LEAST = 2.0  # inches: panels narrower than this stand below one another,
NARROW = 4.0  # inches: axes of space below this need more room for their words
LOW = 0.68  # and are then so high, at most, beside their width

#: Of the largest curve beside it: what is smaller is symmetry broken by rounding, and is not drawn.
ROUNDING = 1e-9
_PREFIXES = {-15: "f", -12: "p", -9: "n", -6: "\u00b5", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}

#: Titles of the panels of the platform's six motions.
OUTPUT_NAMES = {
    "x": "translation x",
    "y": "translation y",
    "z": "translation z",
    "roll": "rotation about x",
    "pitch": "rotation about y",
    "yaw": "rotation about z",
}


class Printing(NamedTuple):
    """What `for_print` asks for: a width in inches, and whether figures have titles. managed: whether pyplot may show
    them."""

    width: float | None = None
    title: bool = True
    managed: bool = True


_USUAL = Printing()
PRINTING: ContextVar[Printing] = ContextVar("flexapod.plots.printing", default=_USUAL)


def changed(key: Any) -> Any:
    """What the user, or a style sheet, has changed one of Matplotlib's rcParams to; None where it is as always."""
    from matplotlib import rcParams, rcParamsDefault

    return rcParams[key] if rcParams[key] != rcParamsDefault[key] else None


@contextmanager
def unshown() -> Iterator[None]:
    """Figures that are made meanwhile are for a page or a file; pyplot does not show them."""
    token = PRINTING.set(PRINTING.get()._replace(managed=False))
    try:
        yield
    finally:
        PRINTING.reset(token)


def figure_of(drawn: Drawn) -> Figure:
    """The whole figure of what a function of the plots gives."""
    found: Figure = drawn.get_figure(root=True)  # type: ignore[assignment]
    return found


def ink() -> str:
    """The colour of words."""
    return str(changed("text.color") or INK)


def wide(points: float) -> float:
    """The width of a line, beside the user's `lines.linewidth`."""
    from matplotlib import rcParams, rcParamsDefault

    return points * float(rcParams["lines.linewidth"] / rcParamsDefault["lines.linewidth"])


def letters(key: str = "legend.fontsize") -> float:
    """The size of words of a kind in points: the user's, or a share of `font.size`. Notes are as those of legends."""
    from matplotlib import rcParams
    from matplotlib.font_manager import FontProperties

    given = changed(key)
    if given is not None:
        return float(FontProperties(size=given).get_size_in_points())
    return _SIZES[key] * float(rcParams["font.size"])


def _room(width: float, height: float) -> tuple[float, float]:
    """The size of a new figure, inches: the one asked for, or the same shape as wide as a page needs it."""
    asked = PRINTING.get().width
    if asked is None:
        given = changed("figure.figsize")
        return (width, height) if given is None else (given[0], given[1])
    return asked, max(height * asked / width, min(height, 2.2))


def new_figure(width: float, height: float, layout: Any = "constrained") -> Figure:
    """A figure of a size in inches, without pyplot; notebooks show it where it is what a cell gives."""
    from matplotlib.figure import Figure

    if "ipykernel" in sys.modules:
        _teach_notebook(Figure)
    return Figure(figsize=_room(width, height), layout=layout, dpi=changed("figure.dpi") or 130)


def _teach_notebook(kind: type[Figure]) -> None:
    """Make a kernel show figures as pictures, where pyplot has not done so yet."""
    from IPython import get_ipython
    from IPython.core.pylabtools import select_figure_formats

    shell = get_ipython()
    known = shell is None or any(kind in one.type_printers for one in shell.display_formatter.formatters.values())
    if not known:
        select_figure_formats(shell, {"png"}, bbox_inches="tight")


def new_axes(width: float, height: float, **given: Any) -> Axes:
    """Axes in a figure of their own; pyplot shows it in notebooks, and in scripts that use pyplot."""
    layout = None if given.get("projection") == "3d" else "constrained"  # which makes axes of space too small
    if PRINTING.get().managed and ("matplotlib.pyplot" in sys.modules or "ipykernel" in sys.modules):
        import matplotlib.pyplot as plt

        figure = plt.figure(figsize=_room(width, height), layout=layout)
    else:
        figure = new_figure(width, height, layout)
    ax: Axes = figure.add_subplot(**given)
    return ax


def fitting(figure: Figure | SubFigure | None, inches: tuple[float, float], columns: int, least: float = LEAST) -> int:
    """How many of so many panels have room beside one another, each as wide as `least` inches."""
    room = _room(*inches)[0] if figure is None else figure.bbox.width / figure.dpi
    return max(1, min(columns, int(room / least + 1e-9)))


def stage(
    figure: Figure | SubFigure | None,
    inches: tuple[float, float],
    shape: tuple[int, int],
    *,
    least: float = LEAST,
    **shares: Any,
) -> tuple[Any, NDArray[Any]]:
    """The figure given, or a new one, and its panels in a flat array, in `shape` or, where that is too narrow, below
    one another.

    inches, shape: width and height, rows and columns where there is room. least: inches, of a panel's width.
    """
    rows, columns = shape
    beside = fitting(figure, inches, columns, least)
    lines = math.ceil(rows * columns / beside)
    if beside < columns:
        for ratios in ("width_ratios", "height_ratios"):
            shares.pop(ratios, None)
    if figure is None:
        figure = new_figure(*inches)
        if beside < columns and changed("figure.figsize") is None:
            wide, high = (float(size) for size in figure.get_size_inches() / (beside, rows))
            figure.set_figheight(lines * min(max(LOW * wide, 1.4), high * columns / beside))
    axes = figure.subplots(lines, beside, squeeze=False, **shares).ravel()
    for ax in axes[rows * columns :]:
        ax.remove()
    return figure, axes[: rows * columns]


def entitle(drawn: Any, title: str) -> None:
    """The title above a figure, or above one pair of axes, unless it is to have none; files say it in any case."""
    figure_of(drawn).set_label(title.split("\n")[0])
    if not PRINTING.get().title:
        return
    if hasattr(drawn, "set_title"):
        drawn.set_title(title, color=ink(), fontsize=letters("axes.titlesize"), wrap=True)
    else:
        drawn.suptitle(title, color=ink(), fontsize=letters("figure.titlesize"), wrap=True)


def legend(ax: Axes, **given: Any) -> None:
    """What the lines of some axes mean, beside them."""
    ax.legend(**{"fontsize": letters(), "framealpha": 0.9, "edgecolor": "none", **given})


def legend_of(ax: Axes, below: bool, ncols: int) -> None:
    """What lines mean: below the axes where the figure is theirs alone, else inside them."""
    if below:
        legend_below(ax.figure, ncols)
        _make_room(ax.figure)
    else:
        legend(ax)


def _make_room(figure: Any) -> None:
    """A page as narrow as it is asked to be is higher by what the legend takes of the axes."""
    if PRINTING.get().width is None:
        return
    taken = figure.legends[-1].get_window_extent().height / figure.bbox.height
    figure.set_figheight(figure.get_figheight() * (1 + max(0.0, taken - _LEGEND)))


def legend_below(figure: Any, ncols: int, handles: Any = None, labels: Any = None) -> None:
    """What the lines of a figure mean, below all axes, in as many columns as there is room for."""
    given = {} if handles is None else {"handles": handles, "labels": labels}
    for columns in range(ncols, 0, -1):
        made = figure.legend(loc="outside lower center", fontsize=letters(), frameon=False, ncols=columns, **given)
        if columns == 1 or made.get_window_extent().width <= figure.bbox.width:
            return
        made.remove()


def state_words(attributes: Mapping[str, Any]) -> str:
    """What the title of a response adds where the machine, or its loop, does not stay at rest."""
    state = attributes.get("stability", "stable")
    return "" if state == "stable" else f" ({state}: no motion approaches this)"


def dress(ax: Axes) -> None:
    """Quiet axes, as in all figures."""
    ax.set_axisbelow(True)
    ax.grid(True, which="major", color=FAINT, lw=0.3, alpha=0.6)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    ax.tick_params(which="both", color=FAINT, labelcolor=ink(), labelsize=letters("xtick.labelsize"))
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set(color=ink(), fontsize=letters("axes.labelsize"))


def across(ax: Axes) -> float:
    """The width of axes, inches; before the layout is made, about so much."""
    return float(ax.bbox.width / ax.figure.dpi)


def name_panel(ax: Axes, i: int, output: str) -> None:
    words = OUTPUT_NAMES[output] if across(ax) > 2.0 else output
    ax.set_title(f"({'abcdef'[i]}) {words}", loc="left", fontsize=letters("axes.titlesize"), color=ink())


def moves(curves: NDArray[Any]) -> NDArray[Any]:
    """Which of some curves, the columns of (n, k), are more than rounding beside the largest."""
    import numpy as np

    height = np.abs(curves)
    largest = np.where(np.isfinite(height), height, 0.0).max(axis=0, initial=0.0)
    return largest > ROUNDING * largest.max(initial=0.0)


def panels(figure: Figure | SubFigure | None, count: int, **shares: Any) -> tuple[Any, list[Axes]]:
    """A figure, new where none is given, and so many panels, in one row or in two, or below one another."""
    rows = 1 if count <= 3 else 2
    columns = math.ceil(max(count, 1) / rows)
    figure, axes = stage(figure, (10.5, 4.5 if rows == 1 else 6.2), (rows, columns), least=1.7, **shares)
    for ax in axes[max(count, 1) :]:
        ax.remove()
    shown = list(axes[: max(count, 1)])
    for ax in shown:  # with shared axes only the last row has ticks of its own
        below = [other for other in axes if other in shown and _column(other) == _column(ax)]
        ax.tick_params(labelbottom=ax is below[-1] or not shares.get("sharex"))
    return figure, shown


def _column(ax: Axes) -> int:
    return int(ax.get_subplotspec().colspan.start)  # type: ignore[union-attr]


def note_still(figure: Figure | SubFigure, names: Iterable[str], what: str = "no motion") -> None:
    """Names below all panels what has none because it does not move."""
    if names := list(names):
        figure.supxlabel(f"{what}: {', '.join(names)}", x=0.01, ha="left", fontsize=letters(), color=FAINT, wrap=True)


def prefixed(ax: Axes, unit: str) -> None:
    """Plain numbers along the vertical axis, and its unit with the prefix that makes them so beside it."""
    from matplotlib.ticker import FuncFormatter

    largest = max(map(abs, ax.get_ylim()))
    power = 3 * math.floor(math.log10(largest) / 3 + 1e-9) if largest > 0 else 0
    power = min(max(power, min(_PREFIXES)), max(_PREFIXES))
    ax.yaxis.set_major_formatter(
        FuncFormatter(lambda value, _: f"{value / 10.0**power + 0.0:.6g}".replace("-", "\N{MINUS SIGN}"))
    )
    ax.set_ylabel(f"{_PREFIXES[power]}{unit}")


def plain_decades(ax: Axes) -> None:
    """Plain numbers at 1, 2, 5 of every decade of the horizontal axis, where they have room."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    low, high = ax.get_xlim()
    ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if high / low < 3e3 else (1,)))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:.10g}"))
    ax.xaxis.set_minor_locator(NullLocator())
