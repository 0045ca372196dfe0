"""The reference of the command line, from the commands themselves."""

from __future__ import annotations

import inspect
import re
from typing import TYPE_CHECKING

import click

from flexapod.cli import group

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files

ABOUT = """# Commands

Exit codes: 0; 1 where `certify` finds a claim refuted; 3 where it leaves one undecided, and where the time limit of
`sweep` is up; 2 for a wrong command line or design, or what cannot be computed or written, with what is wrong on
standard error; 130 after Ctrl-C, 143 after SIGTERM. With `--json` results and errors are JSON, in SI units. `DESIGN` is
a packaged design (`flexapod designs` lists them) or the path of a `.toml` file.

A number is in the unit that its option names, m and degrees of a pose. Another unit of the same dimension may stand
right behind it: `--pose 0 0 550mm 0 0.1rad 0`, `--around 50mm 10deg`, `--bound 20Hz`. One of another dimension is
refused.
"""


def escaped(text: str) -> str:
    """Words of a help text, safe in Markdown and in tables; what stands in backquotes stays code."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(
        part.replace("|", "\\|") if i % 2 else re.sub(r"([\\*_\[\]<>|{}#])", r"\\\1", part)
        for i, part in enumerate(parts)
    )


def paragraphs(text: str) -> Iterator[str]:
    """A help text as Markdown: what Click is told not to wrap is shown as commands."""
    for paragraph in inspect.cleandoc(text).split("\n\n"):
        if paragraph.startswith("\b"):
            yield "```sh\n" + paragraph.removeprefix("\b\n") + "\n```"
        else:
            yield escaped(paragraph.replace("\n", " "))


def section(name: str, command: click.Command, parent: click.Context) -> Iterator[str]:
    context = click.Context(command, info_name=name, parent=parent)
    yield f"## flexapod {name} {{ #{name} }}"
    yield from paragraphs(command.help or "")
    yield f"```\n{context.get_usage().removeprefix('Usage: ')}\n```"
    records = [param.get_help_record(context) for param in command.get_params(context)]
    rows = [f"| {options(record[0])} | {escaped(record[1])} |" for record in records if record and record[1]]
    yield "\n".join(["| option | meaning |", "|---|---|", *rows])


def options(written: str) -> str:
    """How an option is written, as code that may be broken between its words."""
    return " ".join(f"`` {word} ``" if "`" in word else f"`{word}`".replace("|", "\\|") for word in written.split())


def page() -> str:
    with click.Context(group, info_name="flexapod", **group.context_settings) as context:
        names = group.list_commands(context)
        listed = [f"- [`{name}`](#{name}): {escaped(command(context, name).get_short_help_str(200))}" for name in names]
        parts = [ABOUT, "\n".join(listed)]
        for name in names:
            parts += section(name, command(context, name), context)
    return "\n\n".join(parts) + "\n"


def command(context: click.Context, name: str) -> click.Command:
    found = group.get_command(context, name)
    assert found is not None
    return found


def on_files(files: Files, config: MkDocsConfig) -> Files:
    from mkdocs.structure.files import File

    files.append(File.generated(config, "cli.md", content=page()))
    return files
