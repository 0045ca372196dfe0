"""`flexapod designs`: the designs that come with Flexapod."""

from __future__ import annotations

from itertools import takewhile

import click

from flexapod.cli.options import common


@click.command()
@common.json_option
def command(as_json: bool) -> None:
    """List the packaged designs; each name can stand for DESIGN in the other commands."""
    from flexapod.design.design_file import find, packaged_designs

    about = {name: _about(find(name).read_text(encoding="utf-8")) for name in packaged_designs()}
    if as_json:
        common.print_json({name: {"about": about[name], "file": str(find(name))} for name in about})
        return
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    for name, text in about.items():
        table.add_row(f"[bold]{name}[/bold]", text)
    common.console().print(table)


def _about(text: str) -> str:
    """The first paragraph of the comment at the head of a design file."""
    lines = takewhile(lambda line: line.startswith("# "), text.splitlines())
    return " ".join(line.removeprefix("# ") for line in lines)
