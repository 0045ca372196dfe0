"""The command line. Each command lives in a module of this package and is imported only when it is called.

May import: design, mechanics, workspace, excitation, simulation, vibration, paths, optimisation, control,
interchange, plots, paper, report, web.
"""

from __future__ import annotations

import json
import sys
from importlib import import_module
from pkgutil import iter_modules

import click

from flexapod.cli import commands
from flexapod.cli.output.encoding import speak_plainly
from flexapod.errors import FlexapodError

#: Names of the commands: the modules of `commands`.
COMMANDS = tuple(sorted(module.name for module in iter_modules(commands.__path__)))


class _Lazy(click.Group):
    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        if name not in COMMANDS:
            return None
        return import_module(f"flexapod.cli.commands.{name}").command


@click.group(cls=_Lazy, invoke_without_command=True, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="flexapod", prog_name="flexapod")
@click.pass_context
def group(ctx: click.Context) -> None:
    """Dynamic stability and vibration of flexible 6-UPS Stewart platforms (hexapods)."""
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())


def main(arguments: list[str] | None = None) -> int:
    """Run the command line and return its exit code: 0, or 2 for a wrong command line or design."""
    given = sys.argv[1:] if arguments is None else arguments
    speak_plainly()
    try:
        group.main(given, prog_name="flexapod", standalone_mode=False)
    except click.ClickException as error:
        usage = error.ctx.get_usage() if isinstance(error, click.UsageError) and error.ctx else ""
        return _fail(error.format_message(), given, type(error).__name__, usage)
    except FlexapodError as error:
        return _fail(str(error), given, type(error).__name__)
    except click.Abort:
        click.echo("Interrupted.", err=True)
        return 130
    return 0


def _fail(message: str, given: list[str], kind: str, usage: str = "") -> int:
    """Say what is wrong on standard error, as JSON where JSON was asked for."""
    if "--json" in given:
        click.echo(json.dumps({"error": message, "kind": kind}), err=True)
    else:
        click.echo((usage + "\n" if usage else "") + f"Error: {message}", err=True)
    return 2
