"""Packages that only a part of Flexapod needs: imported where it is used, missed with a word on how to get them."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from importlib import import_module
from typing import Any

from flexapod.errors import MissingExtraError

#: Packages that xarray and pandas load to ask every array whether it is one of theirs: that takes a second.
ASKED_OF_ARRAYS = ("dask", "pint", "pyarrow")


def spare(packages: Iterable[str]) -> None:
    """Have packages that are not loaded yet taken for not installed, for as long as this process runs."""
    for name in packages:
        sys.modules.setdefault(name, None)  # type: ignore[arg-type]  # so Python marks what is not to be had


def needed(module: str, extra: str, why: str) -> Any:
    """A module of an optional package, for a reason such as "planning a path needs OMPL". Raises MissingExtraError."""
    try:
        return import_module(module)
    except ImportError as error:
        raise MissingExtraError(f"{why}. Install it with: pip install 'flexapod[{extra}]'") from error
