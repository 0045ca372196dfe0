"""Options that stand on the command line and would count for nothing there."""

from __future__ import annotations

import click
from click.core import ParameterSource


def needed(there: object, words: str, *names: str) -> None:
    """Raise UsageError where one of some parameters was given and what it is for is not there.

    words: what they are for and how to have it, after "--option is for ".
    """
    context = click.get_current_context(silent=True)
    if there or context is None:
        return
    for parameter in context.command.params:
        source = context.get_parameter_source(parameter.name or "")
        if parameter.name in names and source is ParameterSource.COMMANDLINE:
            raise click.UsageError(f"{parameter.opts[0]} is for {words}. Leave it out.")


def others(*names: str) -> tuple[str, ...]:
    """The options of the command but these."""
    context = click.get_current_context(silent=True)
    parameters = [] if context is None else context.command.params
    return tuple(one.name for one in parameters if one.name and one.name not in names)
