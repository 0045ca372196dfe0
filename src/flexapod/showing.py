"""How designs and results show themselves in notebooks.

The library knows none of its faces: the package `flexapod` names the module that knows how each type looks, and it is
imported when something is first shown.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, TypeVar

T = TypeVar("T")

#: The module with `html(thing)`; `flexapod` names it.
FACE: list[str] = []


def in_notebooks(kind: type[T]) -> type[T]:
    """Give a type the method by which notebooks show it: a small table of its values with their units."""
    kind._repr_html_ = _html  # type: ignore[attr-defined]
    return kind


def _html(self: Any) -> str:
    return str(import_module(FACE[0]).html(self))
