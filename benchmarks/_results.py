"""The table of all tools: on the terminal, as Markdown, as JSON, and in README.md between two marks."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from itertools import groupby
from pathlib import Path

from rich.console import Console
from rich.table import Table

from benchmarks._contest import Record

BEGIN, END = "<!-- the table of all tools: written by `make bench-readme` -->", "<!-- end of that table -->"
FIGURE = "all-tools"
UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"))


@dataclass(frozen=True)
class Results:
    """One run of the command. absent: packages that were not installed. quick: sizes too small to mean anything."""

    machine: dict[str, str]
    one_core: bool
    quick: bool
    turns: int
    absent: list[str]
    records: list[Record]

    def tasks(self) -> list[tuple[str, list[Record]]]:
        """Records of each task, in order; Flexapod's first."""
        return [(task, list(found)) for task, found in groupby(self.records, key=lambda r: r.task)]

    def notes(self) -> list[str]:
        """What a reader of the numbers has to know."""
        where = "; ".join(f"{name}: {value}" for name, value in self.machine.items())
        clock = "processor time on one core" if self.one_core else "processor time"
        notes = [
            f"Machine: {where}.",
            f"Times are medians of {self.turns} turns, ratios medians of the turns' ratios to Flexapod's first line of "
            f"the task. {clock.capitalize()}; wall time and all cores for the page and for sweeps on all threads.",
        ]
        if self.absent:
            notes.append(f"Not installed, so not compared: {', '.join(self.absent)} (`pip install` these names).")
        if self.quick:
            notes.append("A quick run, to see that everything works: its numbers mean nothing.")
        return notes


def save(results: Results, path: Path) -> None:
    """Everything, with the times of every turn."""
    path.write_text(json.dumps(asdict(results), indent=1) + "\n")


def load(path: Path) -> Results:
    """What `save` wrote."""
    read = json.loads(path.read_text())
    return Results(**{**read, "records": [Record(**record) for record in read["records"]]})


def on_terminal(results: Results) -> None:
    """The table, and the notes."""
    console = Console()
    console = console if console.is_terminal else Console(width=120)
    table = Table(title="Flexapod and other tools")
    for name in ("task", "tool", "what is measured"):
        table.add_column(name, overflow="fold")
    for name in ("time", "ratio", "difference"):
        table.add_column(name, justify="right", no_wrap=True)
    for task, records in results.tasks():
        for i, r in enumerate(records):
            last = i == len(records) - 1
            table.add_row("" if i else f"{task}, a {r.unit}", tool(r), r.how, *numbers(r, bool(i)), end_section=last)
    console.print(table)
    for note in results.notes():
        console.print(note, highlight=False)


def markdown(results: Results) -> str:
    """The table and the notes."""
    lines = [
        "| task | tool | what is measured | time | ratio | difference |",
        "|---|---|---|---:|---:|---:|",
    ]
    for task, records in results.tasks():
        for i, r in enumerate(records):
            first = "" if i else f"**{task}**, a {r.unit}"
            lines.append(f"| {first} | {tool(r)} | {r.how} | {' | '.join(numbers(r, bool(i)))} |")
    return "\n".join([*lines, "", *_paragraphs(results.notes())]) + "\n"


def update(readme: Path, results: Results) -> None:
    """Write table and figure into README.md, between the marks; all else stays."""
    text = readme.read_text()
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise SystemExit(f"{readme} must have one line `{BEGIN}` and, below, one line `{END}`")
    before, rest = text.split(BEGIN)
    figure = f"![Time of each tool over Flexapod's, by task, on a logarithmic axis]({FIGURE}.png)"
    readme.write_text(f"{before}{BEGIN}\n\n{figure}\n\n{markdown(results)}\n{END}{rest.split(END)[1]}")


def tool(r: Record) -> str:
    return f"{r.tool} {r.version}"


def numbers(r: Record, compared: bool) -> tuple[str, str, str]:
    """Time, ratio and difference as they are shown; Flexapod's first line has no ratio."""
    return (
        duration(r.time),
        times(r.ratio) if compared else "1",
        "" if r.error is None else "0" if r.error == 0 else f"{r.error:.0e}",
    )


def duration(seconds: float) -> str:
    """Three digits with a unit."""
    scale, unit = next(((s, u) for s, u in UNITS if seconds >= s), UNITS[-1])
    return f"{_three(seconds / scale)} {unit}"


def times(ratio: float) -> str:
    """Two digits, three of large numbers."""
    return f"{ratio:.2f}" if ratio < 0.995 else f"{ratio:.1f}" if ratio < 9.95 else f"{float(f'{ratio:.3g}'):.0f}"


def _three(x: float) -> str:
    digits = 0 if x >= 99.95 else 1 if x >= 9.995 else 2
    return f"{x:.{digits}f}"


def _paragraphs(notes: Iterable[str]) -> list[str]:
    return "\n\n".join(notes).split("\n")
