"""What several parts of the paper share: rows of dots on one axis, a row for each case; shares in words."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from matplotlib.figure import Figure

from flexapod.conventions import Array
from flexapod.plots.style import FAINT, dress, new_figure, wide

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ROW = 0.3  # inches


class Dots(NamedTuple):
    """Dots of one kind: for each row its values."""

    label: str
    rows: Sequence[Array]
    colour: str
    marker: str = "o"


def rows_of_dots(names: Sequence[str], dots: Iterable[Dots], label: str) -> tuple[Figure, Axes]:
    """Values on a logarithmic axis, a named row for each case, the first on top."""
    figure = new_figure(9.0, 1.1 + _ROW * len(names))
    ax = figure.add_subplot()
    ax.hlines(range(len(names)), 0, 1, transform=ax.get_yaxis_transform(), color=FAINT, lw=wide(0.4), alpha=0.5)
    for kind in dots:
        place = [i for i, row in enumerate(kind.rows) for _ in row]
        values = [float(value) for row in kind.rows for value in row]
        ax.semilogx(values, place, kind.marker, color=kind.colour, ms=6, mew=1.6, alpha=0.75, label=kind.label)
    ax.set_yticks(range(len(names)), list(names))
    ax.set_ylim(len(names) - 0.5, -0.5)
    ax.set_xlabel(label)
    dress(ax)
    ax.grid(False, axis="y")
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="y", length=0)
    return figure, ax


def percent(share: float) -> str:
    """A share of 1 in percent, two digits where it is small."""
    return f"{100 * share:.0f} %" if share >= 1 else f"{100 * share:.2g} %"
