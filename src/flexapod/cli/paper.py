"""`flexapod paper`: the figures of the paper, drawn anew."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli import common

if TYPE_CHECKING:
    from flexapod.states import JointModel


class FigureNumber(click.ParamType):
    """A number of a figure that can be drawn."""

    name = "number"

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> int:
        from flexapod.paper import FIGURES

        text = str(value)
        if not text.isdigit() or int(text) not in FIGURES:
            self.fail(f"{text!r} is no figure that can be drawn; there are {', '.join(map(str, sorted(FIGURES)))}.")
        return int(text)


@click.command()
@click.option(
    "--figure",
    "figures",
    type=FigureNumber(),
    multiple=True,
    help="Number of a figure in the paper. Repeatable.  [default: all]",
)
@click.option("--points", type=click.IntRange(min=100), default=None, metavar="N", help="Poses in a scatter figure.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of the poses.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("out"),
    show_default=True,
    help="Directory for figure-N.png, figure-N.json (caption and numbers) and figure-N.csv (what is drawn).",
)
@click.option(
    "--joint",
    type=click.Choice(common.JOINT_MODELS),
    default="spin_free",
    show_default=True,
    help="Model of the base joints: the paper's legs that do not spin, or exact.",
)
@common.json_option
def command(
    figures: tuple[int, ...], points: int | None, seed: int, out: Path, joint: JointModel, as_json: bool
) -> None:
    """Draw figures of Mukherjee, Dasgupta and Mallik (2007) with the packaged test manipulators.

    What the paper leaves open, such as the ranges of the poses, is chosen here and told in the caption.
    """
    import json

    from flexapod.paper import FIGURES, Settings, draw

    common.output_directory(out)
    told = {}
    for number in figures or sorted(FIGURES):
        drawn = draw(number, Settings(points, seed, joint))
        path = out / f"figure-{number}.png"
        common.save_figure(drawn.figure, path)
        record = {"caption": drawn.caption, "numbers": common.plain(drawn.numbers)}
        common.write_file(out / f"figure-{number}.json", json.dumps(record, indent=2) + "\n")
        if drawn.table is not None:
            common.write_file(out / f"figure-{number}.csv", drawn.table.to_csv())
        told[str(number)] = {"file": str(path), **record}
        if not as_json:
            click.echo(f"{path}\n  {drawn.caption}")
            for name, value in drawn.numbers.items():
                click.echo(f"  {name}: {value}")
    if as_json:
        common.print_json(told)
