"""`flexapod paper`: the paper's figures again, from the machines of its appendix."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import click

from flexapod.cli import common

PAPER = {
    "7": "flexapod.paper_response:figure_7",
    "8": "flexapod.paper_response:figure_8",
    "9": "flexapod.paper_response:figure_9",
}


@click.command()
@click.option("--figure", "figures", type=click.Choice(sorted(PAPER)), multiple=True, help="Repeatable. Default: all.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("paper"),
    show_default=True,
    metavar="DIR",
    help="Where figures and their numbers go.",
)
@common.json_option
def command(figures: tuple[str, ...], out: Path, as_json: bool) -> None:
    """Reproduce figures of the paper: pictures and tables, with what the paper shows and what is the same."""
    from rich.console import Console
    from rich.progress import Progress

    directory = common.output_directory(out)
    results: dict[str, Any] = {}
    for number in figures or sorted(PAPER):
        home, name = PAPER[number].split(":")
        with Progress(console=Console(stderr=True), disable=as_json, transient=True) as bar:
            task = bar.add_task(f"figure {number}", total=1.0)
            draw = getattr(import_module(home), name)
            results[f"figure_{number}"] = draw(
                directory, progress=lambda done, t=task, b=bar: b.update(t, completed=done)
            )
        if not as_json:
            _show(number, results[f"figure_{number}"], directory)
    if as_json:
        common.print_json(results)


def _show(number: str, found: dict[str, Any], directory: Path) -> None:
    click.echo(f"Figure {number}: {directory / f'figure-{number}.png'}, {directory / f'figure-{number}.csv'}")
    for heading in ("paper", "same", "different"):
        click.echo(f"  {heading.capitalize() + ':':<11}{found[heading]}")
