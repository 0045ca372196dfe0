"""`flexapod designs`: the designs that come with Flexapod."""

from __future__ import annotations

from itertools import takewhile

import click

from flexapod.cli.options import common


@click.command()
@click.option("--search", metavar="WORDS", help="Only designs with all of these words in their names or descriptions.")
@common.json_option
def command(search: str | None, as_json: bool) -> None:
    """List the packaged designs; each name can stand for DESIGN in the other commands.

    \b
    flexapod designs --search "motion payload"
    """
    from flexapod.design.design_file import find, packaged_designs

    about = {name: _about(find(name).read_text(encoding="utf-8")) for name in packaged_designs()}
    words = (search or "").lower().split()
    if search is not None and not words:
        raise click.UsageError("--search has no word. Give one, such as isolator, or leave it out.")
    about = {name: text for name, text in about.items() if all(word in f"{name} {text}".lower() for word in words)}
    if not about:
        raise click.UsageError(
            f"no packaged design has all of the words {', '.join(words)} in its name or description. `flexapod "
            "designs` lists them all."
        )
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
