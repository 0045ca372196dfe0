"""The table of the validation page, from what the tests measured (docs/validation.json)."""

from __future__ import annotations

import json
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

MARKER = "<!-- validation-table -->"
FILE = Path(__file__).parents[1] / "validation.json"


def number(value: float) -> str:
    """Two digits of a deviation, three of what is near one."""
    return f"{value:.3g}" if 0.1 <= value < 10 else f"{value:.2g}" if value < 100 else f"{value:.0f}"


def row(claim: dict[str, Any]) -> str:
    unit = "" if claim["unit"] == "relative" else f" {claim['unit']}"
    files = sorted({Path(test.split("::")[0]).stem for test in claim["tests"]})
    cells = [claim["claim"], claim["against"], number(claim["found"]), number(claim["bound"]) + unit, ", ".join(files)]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def tables(file: Path = FILE) -> str:
    """A heading and a table for each topic, in Markdown."""
    written = json.loads(file.read_text(encoding="utf-8"))
    parts = []
    for topic, claims in groupby(written["claims"], key=lambda claim: claim["topic"]):
        head = ["| claim | against | largest deviation | bound | test |", "|---|---|---|---|---|"]
        parts.append("\n".join([f"### {topic}\n", *head, *map(row, claims)]))
    on = written["measured_on"]
    parts.append(f"Deviations measured with Python {on['python']} and NumPy {on['numpy']} on {on['machine']}.")
    return "\n\n".join(parts)


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    return markdown.replace(MARKER, tables()) if MARKER in markdown else markdown
