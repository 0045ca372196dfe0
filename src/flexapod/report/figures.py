"""Figures as inline SVG for a page: their words are text, and their neutral colours follow the page's."""

from __future__ import annotations

import io
import re
from html import escape
from typing import TYPE_CHECKING, Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from mpl_toolkits.mplot3d import proj3d

from flexapod.output_files import drawn_once
from flexapod.plots import style
from flexapod.plots.shared import shared
from flexapod.report.study import Drawing

if TYPE_CHECKING:
    from collections.abc import Callable

    from flexapod.plots.style import Drawn

# Colours that change between light and dark paper, and the names they have in the page's style sheet.
FOLLOWS = {
    style.INK: "ink",
    style.FAINT: "faint",
    style.BASE: "base",
    style.LEG: "leg",
    style.PLATFORM: "platform",
}
_STYLE: Any = {"svg.fonttype": "none", "svg.hashsalt": "flexapod", "font.family": "sans-serif", "path.simplify": True}


def inline(drawing: Drawing) -> str:
    """A drawing as an <svg> element whose words are text."""
    return drawn(drawing.draw, drawing.name, drawing.title, tight=drawing.tight)


def drawn(draw: Callable[[], Drawn], prefix: str, words: str, tight: bool = False) -> str:
    """A figure as <svg>; `prefix` tells its names from those of others on the page. tight: cut to what lines cover."""
    with matplotlib.rc_context(), style.unshown():
        matplotlib.rcdefaults()  # a page has a style of its own
        matplotlib.rcParams.update(_STYLE)
        figure = style.figure_of(draw()) if tight else shared(draw)  # which stays as it is
        return _inline(figure, prefix, words, _extent(figure, figure.axes[0]) if tight else None)


def _extent(figure: Figure, ax: Any) -> Bbox:
    """What the lines and words cover, in inches: 3-D axes would count their empty box."""
    ax.apply_aspect()
    for line in ax.lines:  # on the page, as a drawing of the whole would leave it
        line.set_data(*proj3d.proj_transform(*line.get_data_3d(), ax.get_proj())[:2])
    words = [proj3d.proj_transform(*text.get_position_3d(), ax.get_proj())[:2] for text in ax.texts]
    places = [Bbox([place, place]) for place in map(ax.transData.transform, words)]
    box = Bbox.union([*(line.get_window_extent() for line in ax.lines), *(place.padded(8) for place in places)])
    return box.transformed(figure.dpi_scale_trans.inverted()).padded(0.06)


def _inline(figure: Figure, prefix: str, words: str, box: Bbox | None = None) -> str:
    """The figure as an <svg> element with its own names, cut to what is drawn."""
    stream = io.StringIO()
    cut = "tight" if box is None else box
    with drawn_once(figure, tight=box is None):
        figure.savefig(
            stream, format="svg", transparent=True, bbox_inches=cut, pad_inches=0.05, metadata={"Date": None}
        )
    text = stream.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.DOTALL)
    text = re.sub(r'\bid="', f'id="{prefix}-', text)
    text = re.sub(r"url\(#", f"url(#{prefix}-", text)
    text = re.sub(r'href="#', f'href="#{prefix}-', text)
    for color, name in FOLLOWS.items():
        text = text.replace(color, f"var(--{name})")
    head = re.match(r"<svg[^>]*viewBox=\"([^\"]*)\"[^>]*>", text)
    assert head is not None  # every figure that Matplotlib saves has a view box
    label = escape(words, quote=True)
    links = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    return f'<svg {links} viewBox="{head[1]}" role="img" aria-label="{label}">' + text[head.end() :]
