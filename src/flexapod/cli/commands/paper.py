"""`flexapod paper`: the paper done anew, as figures, tables and one page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.output.stages import stages
from flexapod.conventions import JOINT_MODELS
from flexapod.output_files import make_directory, write_file

if TYPE_CHECKING:
    from flexapod.conventions import JointModel
    from flexapod.paper import Part

PAGE = "index.html"
_MANY = 50_000  # rows from which five digits must do, more than a drawing shows
_SUBJECT = "test manipulators of Mukherjee, Dasgupta and Mallik (2007)"


class FigureNumber(click.ParamType):
    """A number of a figure that can be drawn."""

    name = "number"

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> int:
        from flexapod.paper import FIGURES

        text = str(value)
        if not (text.isascii() and text.isdecimal() and len(text) < 9) or int(text) not in FIGURES:
            self.fail(f"{text!r} is no figure that can be drawn; there are {', '.join(map(str, sorted(FIGURES)))}.")
        return int(text)


@click.command()
@click.option(
    "--figure",
    "numbers",
    type=FigureNumber(),
    multiple=True,
    help="Number of a figure in the paper, for this figure without the page. Repeatable.  [default: everything]",
)
@click.option("--points", type=common.count(100), default=None, metavar="N", help="Poses in a scatter figure.")
@click.option("--seed", type=common.SEED, default=0, show_default=True, help="Seed of the poses.")
@click.option(
    "--out",
    type=common.DIRECTORY,
    default=Path("out"),
    show_default=True,
    help=f"Directory for {PAGE}, comparison.csv, and of each part NAME.png, .svg, .csv (what is drawn), .json.",
)
@click.option(
    "--joint",
    type=click.Choice(JOINT_MODELS),
    default="spin_free",
    show_default=True,
    help="Model of the base joints: the paper's legs that do not spin, or exact.",
)
@figures.options()
@common.json_option
def command(
    numbers: tuple[int, ...], points: int | None, seed: int, out: Path, joint: JointModel, as_json: bool
) -> None:
    """Do the work of Mukherjee, Dasgupta and Mallik (2007) anew with the packaged test manipulators.

    The figures that can be computed, the natural frequencies, the three conclusions, and the errors of the printed
    equations, each with a number; on one page, beside what the paper says. What the paper leaves open, such as the
    ranges of the poses, is chosen here and told in the captions.
    """
    from flexapod.paper import PARTS, Settings, draw

    make_directory(out)
    settings = Settings(points, seed, joint)
    names = [f"figure-{number}" for number in numbers] or list(PARTS)
    parts, files = [], dict[str, Path]()
    with stages(quiet=as_json) as report:
        for name in names:
            report(name, 0.0)
            with figures.printed():
                parts.append(draw(name, settings))
            files[name] = _write(parts[-1], out)
            report(name, 1.0)
        told = {part.name.removeprefix("figure-"): {"file": str(files[part.name]), **_record(part)} for part in parts}
        if not numbers:
            report("page", 0.0)
            told["page"] = _page(parts, out)
    if as_json:
        common.print_json(told)
        return
    for part in parts:
        _print(part, files[part.name])
    if not numbers:
        page = told["page"]
        counts = ", ".join(f"{count} {verdict}" for verdict, count in page["statements"].items())
        click.echo(f"{page['file']}\n  the paper's statements: {counts}")


def _write(part: Part, out: Path) -> Path:
    """The part's files; returns that of its figure."""
    endings = figures.endings(("png", "svg"))
    for ending in endings:
        figures.write(lambda: part.figure, out / f"{part.name}.{ending}", _SUBJECT)
    write_file(out / f"{part.name}.json", json.dumps(_record(part), indent=2, ensure_ascii=False) + "\n")
    digits = "%.9g" if len(part.table) < _MANY else "%.5g"
    write_file(out / f"{part.name}.csv", part.table.to_csv(float_format=digits))
    if part.shown is not None:
        write_file(out / f"{part.name}-table.csv", part.shown.to_csv())
    return out / f"{part.name}.{endings[0]}"


def _record(part: Part) -> dict[str, Any]:
    claims = [claim._asdict() for claim in part.claims]
    return {"caption": part.caption, "numbers": common.plain(part.numbers), "claims": claims}


def _page(parts: list[Part], out: Path) -> dict[str, Any]:
    from flexapod.report import paper_page

    write_file(out / PAGE, paper_page.page(parts))
    write_file(out / "comparison.csv", paper_page.comparison(parts).to_csv())
    return {"file": str(out / PAGE), "statements": dict(paper_page.verdicts(parts))}


def _print(part: Part, file: Path) -> None:
    click.echo(f"{file}\n  {part.caption}")
    for claim in part.claims:
        click.echo(f"  [{claim.verdict}] {claim.paper}\n      {claim.ours}")
