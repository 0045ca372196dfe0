"""`flexapod designs`: the designs that come with Flexapod."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common

if TYPE_CHECKING:
    from rich.table import Table

    from flexapod.design.catalogue import Description


@click.command()
@click.option(
    "--search", metavar="WORDS", help="Only designs with all of these words in name, description, kind, maker or year."
)
@common.json_option
def command(search: str | None, as_json: bool) -> None:
    """List the packaged designs; each name can stand for DESIGN in the other commands.

    With --search, also where the numbers of those found are from, which of them are assumed, and a published number.

    \b
    flexapod designs --search telescope
    flexapod designs --search "dehaeze 2020"
    """
    from flexapod.design.catalogue import catalogue
    from flexapod.design.design_file import find

    words = (search or "").split()
    if search is not None and not words:
        raise click.UsageError("--search has no word. Give one, such as isolator, or leave it out.")
    found = catalogue(words)
    if not found:
        raise click.UsageError(
            f"no packaged design has all of the words {', '.join(words).lower()} in its name or description. `flexapod "
            "designs` lists them all."
        )
    if as_json:
        common.print_json({name: {**one._asdict(), "file": str(find(name))} for name, one in found.items()})
        return
    common.console().print(_in_full(found) if words else _listed(found))


def _listed(found: dict[str, Description]) -> Table:
    """One line for each: its name, what it is, and whose."""
    return _table((name, one.about, " ".join(filter(None, (one.by, one.year)))) for name, one in found.items())


def _in_full(found: dict[str, Description]) -> Table:
    """All that is said of each."""
    rows: list[tuple[str, ...]] = []
    for name, one in found.items():
        about, *more = one._asdict().items()
        rows += [(name, about[1]), *((f"  {key}", text) for key, text in more if text)]
    return _table(rows)


def _table(rows: Iterable[tuple[str, ...]]) -> Table:
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 2))
    for first, *rest in rows:
        table.add_row(Text(first, style="" if first.startswith(" ") else "bold"), *map(Text, rest))
    return table
