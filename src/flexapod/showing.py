"""How designs and results show themselves: in notebooks, and as figures.

The library knows none of its faces: the package `flexapod` names the modules that know how each type looks, and they
are imported when something is first shown.
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any, TypeVar

T = TypeVar("T")

#: The modules with `html(thing)` and with `plot(thing, ...)`; `flexapod` names them.
FACE: dict[str, str] = {}


def in_notebooks(kind: type[T]) -> type[T]:
    """Give a type the method by which notebooks show it: a small table of its values with their units."""
    kind._repr_html_ = _html  # type: ignore[attr-defined]
    return kind


def _html(self: Any) -> str:
    return str(import_module(FACE["html"]).html(self))


def teach_datasets() -> None:
    """Where IPython runs, let Datasets of results show what their numbers are, above what xarray shows of them."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    if shell is not None:
        shell.display_formatter.formatters["text/html"].for_type_by_name("xarray.core.dataset", "Dataset", _dataset)


def _dataset(found: Any) -> str:
    plain = str(found._repr_html_())
    ours = str(found.attrs.get("source", "")).startswith("flexapod ")
    return f"{_html(found)}{plain}" if ours else plain


def drawn(result: Any, **options: Any) -> Any:
    """Draw the figure of a result, as the method `plot` of its type promises it."""
    return import_module(FACE["plot"]).plot(result, **options)
