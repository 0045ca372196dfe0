"""Packages that only a part of Flexapod needs: imported where it is used, missed with a word on how to get them."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from flexapod.errors import MissingExtraError


def needed(module: str, extra: str, why: str) -> Any:
    """A module of an optional package, for a reason such as "planning a path needs OMPL". Raises MissingExtraError."""
    try:
        return import_module(module)
    except ImportError as error:
        raise MissingExtraError(f"{why}. Install it with: pip install 'flexapod[{extra}]'") from error
