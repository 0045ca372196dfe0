"""The command line. Each command lives in a module of this package and is imported only when it is called.

May import: design, mechanics, workspace, certificates, excitation, simulation, vibration, paths, optimisation, control,
interchange, plots, paper, report, web.
"""

from __future__ import annotations

import json
import signal
import sys
from importlib import import_module
from pkgutil import iter_modules

import click

from flexapod import output_files
from flexapod.cli import commands
from flexapod.cli.options.points import one_word
from flexapod.cli.output import failures, interrupt, streams
from flexapod.errors import FlexapodError
from flexapod.progress import silent

#: Names of the commands: the modules of `commands`.
COMMANDS = tuple(sorted(module.name for module in iter_modules(commands.__path__)))


class _Lazy(click.Group):
    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        if name not in COMMANDS:
            return None
        return import_module(f"flexapod.cli.commands.{name}").command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name, command, left = super().resolve_command(ctx, args)
        return name, command, left if command is None else one_word(command, left)

    def invoke(self, ctx: click.Context) -> int:
        try:
            super().invoke(ctx)
        except EOFError as error:  # click would take it for Ctrl-C
            raise click.ClickException(failures.sentence(error) or "") from error
        return interrupt.end_code(ctx)


@click.group(cls=_Lazy, invoke_without_command=True, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="flexapod", prog_name="flexapod")
@click.pass_context
def group(ctx: click.Context) -> None:
    """Dynamic stability and vibration of flexible 6-UPS Stewart platforms (hexapods)."""
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())


def main(arguments: list[str] | None = None) -> int:
    """Run the command line and return its exit code.

    0; 1 for a claim that is refuted, 3 for one that is undecided and for what is not finished in its time; 2 for a
    wrong command line or design, or what cannot be computed or written; 130 after Ctrl-C, 143 after SIGTERM.
    """
    given = sys.argv[1:] if arguments is None else arguments
    streams.speak_plainly()
    if any("\0" in text for text in given):
        return _fail("an argument holds a null character, which no name has. Leave it out.", given, "UsageError")
    try:
        with interrupt.terminable(), silent():  # commands show their own progress
            code = group.main(given, prog_name="flexapod", standalone_mode=False)
            sys.stdout.flush()
    except click.ClickException as error:
        usage = error.ctx.get_usage() if isinstance(error, click.UsageError) and error.ctx else ""
        return _fail(error.format_message(), given, type(error).__name__, usage)
    except FlexapodError as error:
        return _fail(str(error), given, type(error).__name__)
    except (click.Abort, KeyboardInterrupt):
        return _cut_short("Interrupted.", given, signal.SIGINT)
    except interrupt.Terminated:
        return _cut_short("Terminated.", given, signal.SIGTERM)
    except interrupt.CutShort as error:
        return _cut_short(str(error), given, error.number)
    except interrupt.OutOfTime as error:
        return _fail(str(error), given, "OutOfTime", code=3)
    except Exception as error:
        words = failures.sentence(error)
        if words is None:
            raise
        return _fail(words, given, type(error).__name__)
    return code if isinstance(code, int) else 0


def _cut_short(message: str, given: list[str], number: int) -> int:
    """Say that a signal ended a command. Returns the exit code."""
    output_files.remove_passing()
    return _fail(message, given, "Terminated" if number == signal.SIGTERM else "Interrupted", code=128 + number)


def _fail(message: str, given: list[str], kind: str, usage: str = "", code: int = 2) -> int:
    """Say what is wrong on standard error, as JSON where JSON was asked for. Returns the exit code."""
    cut_short = {} if code == 2 else {"cut_short": True}
    try:
        sys.stdout.flush()
    except OSError:
        streams.give_up(sys.stdout)
    try:
        if "--json" in given:
            click.echo(json.dumps({"error": message, "kind": kind, **cut_short}), err=True)
        else:
            click.echo((usage + "\n" if usage else "") + (f"Error: {message}" if code == 2 else message), err=True)
    except OSError:
        streams.give_up(sys.stderr)
    return code
