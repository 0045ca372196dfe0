"""`flexapod new`: a commented design file to start from."""

from __future__ import annotations

from pathlib import Path

import click

from flexapod.cli.options import common
from flexapod.output_files import check_file, write_file


@click.command()
@click.argument("file", type=click.Path(path_type=Path), metavar="NAME.toml")
@click.option("--force", is_flag=True, help="Replace the file if it is there.")
@common.json_option
def command(file: Path, force: bool, as_json: bool) -> None:
    """Write a commented design file to start from; it is a complete machine, ready to be changed."""
    from flexapod.design.design_file import template
    from flexapod.design.tables import LONGEST_TEXT, is_text

    if file.name in ("", "..") or not is_text(file.name):
        raise click.UsageError(f"{str(file)!r} is no name of a file. Give one, such as machine.toml.")
    path = file if file.suffix else file.with_suffix(".toml")
    if path.suffix != ".toml":
        raise click.UsageError(f"{path} does not end in .toml; a design is a TOML file. Name it {path.stem}.toml.")
    if len(path.name.encode()) > LONGEST_TEXT:
        raise click.UsageError(
            f"{path.name[:40]}... is a name of more than {LONGEST_TEXT} bytes. Choose a shorter one."
        )
    if path.exists() and not force:
        raise click.UsageError(f"{path} is there already. Choose another name, or replace it with --force.")
    check_file(path)
    write_file(path, template(path.stem))
    if as_json:
        common.print_json({"file": str(path), "name": path.stem})
        return
    click.echo(f"Wrote {path}, a complete machine: change its numbers to those of yours. Then")
    for words in ("check  {}    is it a hexapod, within its limits?", "report {}    its dynamics, as a page"):
        click.echo("  flexapod " + words.format(path))
