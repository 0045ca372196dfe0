"""What the text of a design may be at most, checked before it is read: the reader's time grows with its square."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flexapod.errors import DesignError

MOST_BYTES = 256 * 1024  # fifty times a long design with comments
MOST_KEYS = 250  # there are less than a hundred, and none may be given twice
_MOST_DOTS = 48  # of keys in one line, where a dot each goes one table deeper
_DECIMAL = re.compile(r"(?<![\w.])\d[\d_]*\.(?=\d)")
_DOTS = re.compile(r"\.[.\s]*")


def bytes_of_file(path: Path) -> bytes:
    """What is in a file, which must be one with an end, and a small one. Raises DesignError, OSError."""
    if not path.is_file():
        raise DesignError(
            "this is no regular file; a device or a pipe may have no end. Write the design to a .toml file first."
        )
    with path.open("rb") as file:
        found = file.read(MOST_BYTES + 1)
    check_size(len(found))
    return found


def check_size(size: int) -> None:
    """Raises DesignError for a text of too many bytes or characters."""
    if size > MOST_BYTES:
        raise DesignError(
            f"the text is longer than {MOST_BYTES // 1024} kB, which no design is. Is it another kind of file?"
        )


def check_depth(text: str) -> None:
    """Raises DesignError for a line whose keys have so many dots that reading it takes minutes."""
    for number, line in enumerate(text.split("\n"), 1):
        if line.count(".") > _MOST_DOTS and len(_DOTS.findall(_DECIMAL.sub("", line))) > _MOST_DOTS:
            raise DesignError(
                f"line {number} has more than {_MOST_DOTS} dots beside those of decimal numbers. Keys of a design are "
                "at most three tables deep, as legs.upper.rod.mass: shorten them, or break the line."
            )


def check_count(tables: Mapping[str, Any]) -> None:
    """Raises DesignError for tables with more keys than a design can have."""
    left, count = [tables], 0
    while left:
        table = left.pop()
        count += len(table)
        if count > MOST_KEYS:
            raise DesignError(
                f"there are more than {MOST_KEYS} keys, which no design has. Is it another kind of TOML file?"
            )
        left += [value for value in table.values() if isinstance(value, Mapping)]
