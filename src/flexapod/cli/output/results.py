"""What a command does with a study: its files, and then the terminal's text or JSON."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.output.interrupt import exit_code
from flexapod.output_files import make_directory, write_file, write_netcdf

if TYPE_CHECKING:
    from flexapod.report.study import Study


def emit(study: Study, out: Path | None, as_json: bool, *, listed: str = "files", more: Sequence[Path] = ()) -> None:
    """Print the study, and write its files to a directory, none where it is None; as JSON the results after them.

    listed: how JSON names the files: "files", "html" where a page is the only one, or "" for not at all. more: files
    that are written already.
    """
    unread = None if as_json else _shown(study)  # before figures are drawn, which takes longer than most studies
    files = [*([] if out is None else write(study, make_directory(out))), *more]
    if unread is not None:
        raise unread
    if as_json:
        names = [str(file) for file in files]
        told: dict[str, object] = {"files": names, "html": next(iter(names), None)}
        context = click.get_current_context(silent=True)
        cut_short = {"cut_short": True} if context is not None and exit_code(context) else {}
        common.print_json({**study.to_dict(), **cut_short, **({listed: told[listed]} if listed else {})})
        return
    for file in files:
        click.echo(f"Wrote {file}")


def _shown(study: Study) -> OSError | SystemExit | None:
    """Print the study. Returns what Python or rich raises where nobody reads it: its files are wanted all the same."""
    from flexapod.report.terminal import show

    try:
        show(study, common.console())
    except (OSError, SystemExit) as error:
        return error
    return None


def write(study: Study, directory: Path) -> list[Path]:
    """Write the study's files, each of the kind that its name ends with, figures as the options say."""
    from flexapod.plots.shared import drawn_for_all

    with drawn_for_all():
        return [_written(study, make, directory / name) for name, make in study.files.items()]


def _written(study: Study, make: Callable[[], Any] | None, path: Path) -> Path:
    if make is None:
        from flexapod.report.html import page

        write_file(path, page(study))
    elif path.suffix == ".nc":
        write_netcdf(make(), path)
    elif path.suffix in (".png", ".svg"):
        path = figures.named(path)
        figures.write(make, path, study.hexapod.name)
    else:
        write_file(path, make())
    return path


def emit_or_csv(compute: Callable[[], Study], out: Path | None, as_json: bool, table: str | None) -> None:
    """The same for a study that is still to be computed. table: its file that is printed instead, as --csv asks."""
    if table is not None and as_json:
        raise click.UsageError("--csv and --json both say what is printed. Give one of them.")
    found = compute()
    if table is None:
        emit(found, out, as_json)
        return
    click.echo(found.files[table](), nl=False)  # type: ignore[misc]
    if out is not None:
        write(found, make_directory(out))
