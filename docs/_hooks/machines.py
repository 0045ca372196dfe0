"""The packaged designs and their sources, from their files: `<!-- machines -->` and `<!-- sources -->` of a page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flexapod.design.catalogue import catalogue

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page


def table() -> str:
    """The designs of others first, then Flexapod's own."""
    rows = ["| name | what it is | kind | by | a published number, found again by the tests |", "|---|---|---|---|---|"]
    for name, one in sorted(catalogue().items(), key=lambda item: item[1].by.startswith("Flexapod")):
        by = ", ".join(filter(None, (one.by, one.year)))
        rows.append(f"| `{name}` | {one.about} | {one.kind} | {by} | {one.published} |")
    return "\n".join(rows)


def sources() -> str:
    """Where the numbers of each are from, and what is assumed."""
    lines = []
    for name, one in catalogue().items():
        assumed = f" Assumed: {one.assumed}" if one.assumed else ""
        lines += [f"- `{name}`: {one.source}{assumed}"] if one.source else []
    return "\n".join(lines)


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    for mark, made in (("<!-- machines -->", table), ("<!-- sources -->", sources)):
        if mark in markdown:
            markdown = markdown.replace(mark, made())
    return markdown
