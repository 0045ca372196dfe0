"""Writes the tables of the manual that are made from the sources into its pages: python docs/tables/write.py."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import keys
import machines

DOCS = Path(__file__).parents[1]
#: Page -> mark -> what makes the table that stands between `<!-- mark -->` and `<!-- end of mark -->`.
TABLES: dict[str, dict[str, Callable[[], str]]] = {
    "design-file.md": {"units": keys.units, "keys": keys.table},
    "machines.md": {"machines": machines.table, "sources": machines.sources},
}


def filled(page: str) -> str:
    """The text of a page with its tables as they must be."""
    text = (DOCS / page).read_text(encoding="utf-8")
    for mark, made in TABLES[page].items():
        start, end = f"<!-- {mark} -->", f"<!-- end of {mark} -->"
        text, count = re.subn(f"{start}.*?{end}", lambda _: f"{start}\n\n{made()}\n\n{end}", text, flags=re.DOTALL)  # noqa: B023
        assert count == 1, f"{page} has {count} places for {mark}"
    return text


if __name__ == "__main__":
    for name in TABLES:
        (DOCS / name).write_text(filled(name), encoding="utf-8")
