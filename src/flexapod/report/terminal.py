"""Studies in the terminal: the main numbers, the tables, and the cautions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.cells import cell_len
from rich.measure import Measurement
from rich.table import Table as Grid
from rich.text import Text

from flexapod.report.numbers import percent, shown
from flexapod.report.study import Bars, Column, Drawing, Row, Study, Table, shown_on

if TYPE_CHECKING:
    from rich.console import Console, JustifyMethod

_ENDLESS = 100_000  #: columns, more than any table has


def show(study: Study, out: Console) -> None:
    """Print a study."""
    out.print(Text.assemble((study.hexapod.name, "bold"), f": {study.about}"), soft_wrap=True)
    for row in shown_on(study.rows, "terminal"):
        out.print(Text(f"  {_words(row)}"), soft_wrap=True)
    for section in study.sections:
        for item in shown_on(section.items, "terminal"):
            if not isinstance(item, Drawing):
                _item(item, section.title, out)
    for caution in study.cautions:
        out.print(Text.assemble(("Warning: ", "bold yellow"), caution.text), soft_wrap=True)
    if study.assumed:
        out.print(Text(study.assumed), soft_wrap=True)


def _words(row: Row) -> str:
    value = row.value if isinstance(row.value, str) else shown(row.value, row.digits)
    return " ".join(filter(None, (row.label, value, row.unit, row.note)))


def _item(item: Table | Bars, title: str, out: Console) -> None:
    out.print(Text(item.title or title, style="bold"), soft_wrap=True)
    put(_bars(item) if isinstance(item, Bars) else _table(item), out)


def put(grid: Grid, out: Console) -> None:
    """Print a table as wide as its numbers need, however narrow the terminal: a number that is cut is another one."""
    needed = Measurement.get(out, out.options.update_width(_ENDLESS), grid).minimum
    before = out.width
    out.width = max(before, needed)
    try:
        out.print(grid, crop=False)
    finally:
        out.width = before


def _table(table: Table) -> Grid:
    grid = Grid(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    columns: Sequence[Column] = shown_on(table.columns, "terminal")
    for column in columns:
        wordy = any(isinstance(value, str) and any(map(str.isalpha, value)) for value in column.values)
        heading = "\n".join(filter(None, (column.title, column.unit)))
        words = [word for value in column.values if isinstance(value, str) for word in value.split()] if wordy else []
        least = max(map(cell_len, words), default=None)
        side: JustifyMethod = "left" if wordy else "right"
        grid.add_column(heading, justify=side, no_wrap=not wordy, min_width=least, vertical="top")
    for i in range(len(columns[0].values)):
        grid.add_row(*(_cell(column, i) for column in columns))
    return grid


def _cell(column: Column, i: int) -> Text:
    value = column.values[i]
    marked = column.marked is not None and bool(column.marked[i])
    return Text(value if isinstance(value, str) else shown(value, column.digits), style="bold red" if marked else "")


def _bars(bars: Bars) -> Grid:
    grid = Grid.grid(padding=(0, 2))
    for i in bars.brief:
        grid.add_row("  " + bars.names[i], Text(percent(bars.effects[i], 3), justify="right"))
    return grid
