"""Tables of the packaged designs and of their sources, from their files."""

from __future__ import annotations

from flexapod.design.catalogue import catalogue


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
