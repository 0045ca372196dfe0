"""Figures as inline SVG for a page: their words are text, and their neutral colours follow the page's."""

from __future__ import annotations

import io
import re
from html import escape
from typing import TYPE_CHECKING, Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from flexapod import plots
from flexapod.mechanics.modes import NaturalModes
from flexapod.plots import style
from flexapod.report.findings import Findings

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes

# Colours that change between light and dark paper, and the names they have in the page's style sheet.
FOLLOWS = {
    style.INK: "ink",
    style.FAINT: "faint",
    style.BASE: "base",
    style.LEG: "leg",
    style.PLATFORM: "platform",
}
_STYLE: Any = {"svg.fonttype": "none", "svg.hashsalt": "flexapod", "font.family": "sans-serif", "path.simplify": True}


def machine(f: Findings) -> str:
    """The machine in 3-D."""
    return _svg(lambda ax: plots.machine(f.hexapod, f.pose, ax), "machine", "The machine in 3-D", (7, 6))


def mode(f: Findings, number: int) -> str:
    """One mode, numbered from 1."""
    modes = NaturalModes(f.omega, f.shape)
    words = f"Mode {number}: {f.descriptions[number - 1].text}"
    return _svg(lambda ax: plots.mode(f.hexapod, f.pose, modes, number, ax), f"mode{number}", words)


def frequencies(f: Findings) -> str:
    """The six frequencies on a logarithmic scale."""
    labels = [description.dominant for description in f.descriptions]
    tangent = f.damped.omega if f.damped else None
    figure = Figure(figsize=(7, 2.7))
    with matplotlib.rc_context(_STYLE):
        plots.frequencies(f.omega, figure.add_subplot(), tangent, labels)
        return _inline(figure, "frequencies", "Six natural frequencies in Hz")


def drawn(draw: Callable[[], Figure], prefix: str, words: str) -> str:
    """A figure that a function of the plots makes; `prefix` tells its names from those of others on the page."""
    with matplotlib.rc_context(_STYLE):
        return _inline(draw(), prefix, words)


def _svg(draw: Callable[..., object], prefix: str, words: str, size: tuple[float, float] | None = None) -> str:
    """3-D axes drawn on: a figure of a size (inches) with its axes, or, without one, cut to what the lines cover."""
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=size or (4, 4))
        ax = figure.add_subplot(projection="3d")
        draw(ax)
        return _inline(figure, prefix, words, None if size else _extent(figure, ax))


def _extent(figure: Figure, ax: Axes) -> Bbox:
    """What the lines cover, in inches: 3-D axes would count their empty box."""
    figure.draw_without_rendering()
    box = Bbox.union([line.get_window_extent() for line in ax.lines])
    return box.transformed(figure.dpi_scale_trans.inverted()).padded(0.06)


def _inline(figure: Figure, prefix: str, words: str, box: Bbox | None = None) -> str:
    """The figure as an <svg> element with its own names, cut to what is drawn."""
    stream = io.StringIO()
    cut = "tight" if box is None else box
    figure.savefig(stream, format="svg", transparent=True, bbox_inches=cut, pad_inches=0.05, metadata={"Date": None})
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
