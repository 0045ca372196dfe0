"""`flexapod cite`: how to cite Flexapod and the paper whose model it computes."""

from __future__ import annotations

import click

from flexapod.cli.options import common


@click.command()
@click.option("--cff", "as_cff", is_flag=True, help="In the Citation File Format, as CITATION.cff has it.")
@common.json_option
def command(as_cff: bool, as_json: bool) -> None:
    """Print how to cite Flexapod, of this version, and the paper whose model it computes, as BibTeX.

    \b
    flexapod cite >> references.bib
    """
    from flexapod import citation

    if as_json and as_cff:
        raise click.UsageError("--cff and --json are two forms of one answer. Give one of them.")
    if as_json:
        common.print_json({**citation.entries(), "bibtex": citation.bibtex()})
    else:
        click.echo(citation.cff().rstrip("\n") if as_cff else citation.bibtex())
