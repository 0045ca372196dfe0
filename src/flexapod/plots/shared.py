"""Figures that several files and pages show are drawn and laid out once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

from flexapod.plots.style import PRINTING, figure_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from flexapod.plots.style import Drawn

_MADE: ContextVar[dict[Any, Figure] | None] = ContextVar("flexapod.plots.shared", default=None)
#: Beginnings of rcParams that say how a figure is written or shown, not how it is drawn.
_OF_FILES = (
    "backend",
    "svg.",
    "pdf.",
    "ps.",
    "savefig.",
    "webagg.",
    "keymap.",
    "interactive",
    "toolbar",
    "path.simplify",
)


@contextmanager
def drawn_for_all() -> Iterator[None]:
    """What is asked of `shared` meanwhile is drawn once in each style."""
    token = _MADE.set({})
    try:
        yield
    finally:
        _MADE.reset(token)


def shared(draw: Callable[[], Drawn]) -> Figure:
    """What a function draws; within `drawn_for_all` as it was drawn, and laid out for a file, before."""
    made = _MADE.get()
    if made is None:
        return figure_of(draw())
    key = draw, PRINTING.get(), _style()
    if key in made:
        laid_out(made[key])
    else:
        made[key] = figure_of(draw())
    return made[key]


def laid_out(figure: Figure) -> None:
    """Keeps the layout that a figure has: the engine "none" does nothing, but has it drawn twice."""
    from matplotlib import rc_context

    with rc_context({"figure.autolayout": False, "figure.constrained_layout.use": False}):
        figure.set_layout_engine(None)


def _style() -> str:
    """All rcParams that the user, or a page, has changed, as far as they are drawn."""
    from matplotlib import rcParams, rcParamsDefault

    drawn = (key for key in rcParamsDefault if not key.startswith(_OF_FILES))
    return repr([(key, rcParams[key]) for key in drawn if rcParams[key] != rcParamsDefault[key]])
