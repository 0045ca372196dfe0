"""How figures are written: --format, --width, --font-size and --no-title of every command that writes some."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common
from flexapod.cli.options.quantities import POSITIVE_LENGTH

if TYPE_CHECKING:
    from flexapod.plots.style import Drawn

_KEPT = "flexapod.figures"  # in a context's meta
_POINTS = common.Finite(min=1, max=100)


def _keep(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    context.meta.setdefault(_KEPT, {})[parameter.name] = value


def _given() -> dict[str, Any]:
    context = click.get_current_context(silent=True)
    return {} if context is None else context.meta.get(_KEPT, {})


def options(needed: str = "") -> Callable[[Any], Any]:
    """The four options. needed: the option without which the command writes no figure, as --out."""

    def decorate(function: Any) -> Any:
        @wraps(function)
        def checked(*args: Any, **given: Any) -> Any:
            asked = [name for name, value in _given().items() if value not in (None, False)]
            if asked and needed and given[needed.lstrip("-")] is None:
                option = {"figure_format": "--format"}.get(asked[0], f"--{asked[0].replace('_', '-')}")
                raise click.UsageError(f"{option} is of figures, and none is written. Give {needed} as well.")
            if asked:
                _check_sizes()
            return function(*args, **given)

        return _stack(checked)

    return decorate


def _option(*names: str, **settings: Any) -> Any:
    return click.option(*names, expose_value=False, callback=_keep, **settings)


_stack = common.stack(
    _option(
        "--format",
        "figure_format",
        type=click.Choice(("png", "pdf", "svg")),
        default=None,
        help="Format of the figures.  [default: png]",
    ),
    _option(
        "--width",
        type=POSITIVE_LENGTH,
        default=None,
        metavar="M",
        help="Width of the figures, as 88mm for a column. Panels without room stand below one another.",
    ),
    _option(
        "--font-size",
        type=_POINTS,
        default=None,
        metavar="PT",
        help="Size of the words in figures, points.  [default: 10, with --width 8]",
    ),
    _option("--no-title", is_flag=True, help="Figures without a title, for papers whose captions tell it."),
)


def endings(usual: tuple[str, ...]) -> tuple[str, ...]:
    """The formats of figures, without the dot: that of --format, else the usual ones."""
    given = _given().get("figure_format")
    return usual if given is None else (given,)


def named(path: Path) -> Path:
    """The file of a figure with the ending of --format."""
    return path.with_suffix(f".{endings((path.suffix[1:],))[0]}")


def check(path: Path) -> None:
    """Raises UsageError where the name of a figure's file has another ending than --format says."""
    (ending,) = endings((path.suffix[1:].lower(),))
    if path.suffix[1:].lower() != ending:
        raise click.UsageError(f"{path} ends in {path.suffix!r}, and --format is {ending}. Leave --format out.")


def _check_sizes() -> None:
    """Raises ArgumentError for a width or a size of words that cannot be, before anything is computed."""
    from flexapod.plots.printing import check_sizes

    check_sizes(_given().get("width"), _given().get("font_size"))


def printed() -> AbstractContextManager[None]:
    """Figures that are made meanwhile are as the options say."""
    from flexapod.plots.printing import for_print

    given = _given()
    return for_print(width=given.get("width"), font_size=given.get("font_size"), title=not given.get("no_title"))


def write(make: Callable[[], Drawn], path: Path, design: str = "") -> None:
    """Draw a figure as the options say, and write it. Raises OutputError."""
    from flexapod.plots.printing import save
    from flexapod.plots.shared import shared
    from flexapod.plots.style import unshown

    with printed(), unshown():
        save(shared(make), path, design=design)
