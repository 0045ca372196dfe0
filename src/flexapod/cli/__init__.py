"""The command line. Each command lives in a module of this package and is imported only when it is called."""

from __future__ import annotations

import sys
from importlib import import_module

import click

from flexapod.errors import FlexapodError

COMMANDS = ("check", "modes", "new", "report", "serve")


class _Lazy(click.Group):
    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        if name not in COMMANDS:
            return None
        return import_module(f"flexapod.cli.{name}").command


@click.group(cls=_Lazy, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="flexapod", prog_name="flexapod")
def group() -> None:
    """Dynamic stability and vibration of flexible 6-UPS Stewart platforms (hexapods)."""


def main() -> None:
    """Run the command line: exit code 0, or 2 for a wrong command line or design."""
    try:
        group(standalone_mode=True)
    except FlexapodError as error:
        click.echo(f"Error: {error}", err=True)
        sys.exit(2)
