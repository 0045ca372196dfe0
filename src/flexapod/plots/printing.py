"""Figures for print: as wide as a column, without titles where a caption tells them; files say what they show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from os import PathLike
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from flexapod.checks import positive
from flexapod.errors import ArgumentError
from flexapod.output_files import write_figure
from flexapod.plots.style import PRINTING, Printing, changed, figure_of

if TYPE_CHECKING:
    from flexapod.plots.style import Drawn

INCH = 0.0254
_WIDTHS = 0.01, 1.0  # m: from where words have room to where the pixels of print take gigabytes
_SIZES = 1.0, 100.0  # points
_DPI = {"screen": 160, "vectors": 300, "print": 600}  # of pixels; among vectors: of what is shaded
_FONT = 8.0  # points, of figures with a width
_LINE = 1.5  # points: Matplotlib's own width of lines, beside words of 10
_NARROW = 7.5  # inches: figures up to this may have labels that are too long


@contextmanager
def for_print(*, width: float | None = None, font_size: float | None = None, title: bool = True) -> Iterator[None]:
    """Draw figures for a page: new figures made meanwhile are so wide, their words so large.

    Parameters
    ----------
    width : float, optional
        Width of new figures, m, such as 0.088 for a column. Panels that are too narrow beside one another stand below
        one another, so that the height follows. Default: that of each figure, or of Matplotlib's ``figure.figsize``
        where that is changed.
    font_size : float, optional
        Size of axis labels in points; other words are a tenth smaller or larger, and lines are as wide in proportion.
        Default: Matplotlib's ``font.size`` where that is changed, else 8 with a width and 10 without.
    title : bool, optional
        If False, figures have no title above them, for papers that tell it in a caption.

    Yields
    ------
    None
        Figures that are made within the block are for print.

    Raises
    ------
    ArgumentError
        If the width is not from 10 mm to 1 m, or the size not from 1 to 100 points.

    See Also
    --------
    flexapod.plots.save : Write a figure to a file.

    Notes
    -----
    All other rcParams of Matplotlib hold as well, such as those of a style sheet of a journal.

    Examples
    --------
    >>> with fx.plots.for_print(width=0.088, font_size=8, title=False):
    ...     ax = fx.plots.frequencies(fx.natural_modes(fx.load("motion-base")).omega)
    >>> round(25.4 * float(ax.figure.get_figwidth()), 6)
    88.0
    """
    from matplotlib import rc_context

    check_sizes(width, font_size)
    inches = None if width is None else width / INCH
    words: Any = {}
    if font_size is not None:
        words["font.size"] = font_size
    elif inches is not None and changed("font.size") is None:
        words["font.size"] = _FONT
    if words and changed("lines.linewidth") is None:
        words["lines.linewidth"] = _LINE * words["font.size"] / 10
    token = PRINTING.set(Printing(inches, title, PRINTING.get().managed))
    try:
        with rc_context(words):
            yield
    finally:
        PRINTING.reset(token)


def check_sizes(width: float | None, font_size: float | None) -> None:
    """Raises ArgumentError for a width (m) or a size of words (points) that no figure for print has."""
    for value, name, unit, (least, most) in (
        (width, "width", "m", _WIDTHS),
        (font_size, "font_size", "pt", _SIZES),
    ):
        if value is not None and not least <= (found := positive(value, name, unit)) <= most:
            raise ArgumentError(f"{name} is {found:.6g} {unit}; it must be from {least:g} to {most:g} {unit}.")


def save(made: Drawn, path: str | PathLike[str], *, design: str = "") -> None:
    """Write a figure to a file whose words are text and whose metadata say what it shows.

    Parameters
    ----------
    made : Figure, SubFigure or Axes
        The figure, or a part of it: the whole figure is written.
    path : str or Path
        The file; its name says the format, such as .svg, .pdf or .png.
    design : str, optional
        Name of the design, for the metadata. Default: the title of the figure says it.

    Returns
    -------
    None
        Nothing; the file is written.

    Raises
    ------
    OutputError
        If the file cannot be written, or its format is unknown.

    See Also
    --------
    flexapod.plots.for_print : Draw figures for a page.

    Notes
    -----
    SVG and PDF hold words as text, PDF with its fonts. The metadata are the title, the design, the labels of all axes
    with their units, and the version of Flexapod; no date, so that the same figure is the same file. PNG has 160 dots
    per inch, or 600 within `for_print` with a width, unless Matplotlib's ``savefig.dpi`` is changed.

    Examples
    --------
    >>> fx.plots.save(fx.plots.frequencies(np.arange(1.0, 7.0)), "six.svg", design="no machine")
    """
    figure = figure_of(made)
    kind = str(path).rpartition(".")[2].lower()
    dpi = _DPI["print" if PRINTING.get().width else "vectors" if kind in ("svg", "pdf") else "screen"]
    _fit_words(figure)
    given = changed("savefig.dpi")
    write_figure(figure, path, dpi=dpi if given is None else given, metadata=_metadata(figure, kind, design))


def _fit_words(figure: Any) -> None:
    """In narrow figures: labels that are longer than their axes in two lines or three, and fewer numbers than touch."""
    if figure.get_figwidth() > _NARROW:
        return
    engine = figure.get_layout_engine()
    if engine is None:
        figure.draw_without_rendering()
    else:
        engine.execute(figure)  # a drawing would do no more for what is measured here
    for ax in figure.axes:
        if not hasattr(ax, "get_zlabel"):
            _thin_numbers(ax.xaxis)
        for axis, side in ((ax.xaxis, "width"), (ax.yaxis, "height")):
            words, room = axis.label.get_text(), getattr(ax.bbox, side)
            for lines in (2, 3):
                if getattr(axis.label.get_window_extent(), side) > room and " " in words:
                    axis.label.set_text(
                        "\n".join(wrap(words, math.ceil(len(words) / lines) + 2, break_long_words=False))
                    )


def _thin_numbers(axis: Any) -> None:
    """Fewer numbers below an axis whose numbers would touch one another."""
    from matplotlib.ticker import MaxNLocator

    for most in (6, 5, 4, 3, 2):
        if not isinstance(axis.get_major_locator(), MaxNLocator) or not numbers_touch(axis):
            return
        axis.set_major_locator(MaxNLocator(most))


def numbers_touch(axis: Any) -> bool:
    """Whether the numbers below an axis leave less than half the width of a letter between them."""
    low, high = sorted(axis.get_view_interval())
    axis.get_majorticklabels()  # brings the ticks up to date
    ticks = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high and tick.label1.get_visible()]
    boxes = [tick.label1.get_window_extent() for tick in ticks if tick.label1.get_text()]
    boxes.sort(key=lambda box: box.x0)
    room = 0.25 * max((box.height for box in boxes), default=0.0)
    return any(right.x0 - left.x1 < room for left, right in pairwise(boxes))


def _metadata(figure: Any, kind: str, design: str) -> dict[str, Any] | None:
    """What a file of a kind says of a figure; None for kinds that say nothing."""
    from flexapod import __version__

    axes = dict.fromkeys(text for ax in figure.axes for text in _labels(ax) if text)
    title = str(figure.get_label() or "") or design
    about = ". ".join(
        filter(None, (f"design: {design or title.partition(':')[0]}", f"axes and units: {'; '.join(axes)}"))
    )
    made = f"Flexapod {__version__}"
    keys: dict[str, dict[str, Any]] = {
        "svg": {"Title": title, "Description": about, "Creator": made, "Date": None},
        "pdf": {"Title": title, "Subject": about, "Creator": made, "CreationDate": None},
        "png": {"Title": title, "Description": about, "Software": made},
        "eps": {"Creator": made},
        "ps": {"Creator": made},
    }
    return keys.get(kind)


def _labels(ax: Any) -> list[str]:
    """The labels of one pair of axes, or of three, as plain text."""
    names = [getattr(ax, f"get_{name}label")() for name in "xyz" if hasattr(ax, f"get_{name}label")]
    return [" ".join(name.replace(r"$\omega_1$", "omega_1").split()) for name in names]
