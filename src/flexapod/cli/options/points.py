"""--point: a place on the platform, as three numbers or by its name in the design."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click
from click.shell_completion import CompletionItem

from flexapod.cli.options.quantities import LENGTH, NUMBER

#: What an option of a point gives: x, y, z in m, or a name.
PointGiven = tuple[float, float, float] | str


class Point(click.ParamType):
    """x, y, z (m, or with units) or the name of a point of the design; completes the names."""

    name = "point"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> PointGiven:
        if isinstance(value, str):
            return value
        if len(value) != 3:
            self.fail(f"{' '.join(value)} is no point; it takes three numbers X Y Z, or a NAME.", param, ctx)
        x, y, z = (LENGTH.convert(each, param, ctx) for each in value)
        return x, y, z

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from flexapod.design.loading import load
        from flexapod.errors import FlexapodError

        try:
            names = load(ctx.params["design"]).points
        except (FlexapodError, KeyError):  # nothing is typed yet that can be read
            return []
        return [CompletionItem(name) for name in names if name.startswith(incomplete)]


class _PointOption(click.Option):
    """An option that takes one word, or three where the first is a number."""

    def add_to_parser(self, parser: Any, ctx: click.Context) -> None:
        super().add_to_parser(parser, ctx)
        for name in self.opts:
            option = parser._long_opt[name]
            take = option.process

            def process(value: Any, state: Any, take: Callable[[Any, Any], None] = take) -> None:
                if isinstance(value, str) and NUMBER.fullmatch(value.strip()):
                    value = (value, *state.rargs[:2])
                    del state.rargs[:2]
                take(value, state)

            option.process = process


def point_option(help: str, name: str = "--point", multiple: bool = False) -> Callable[[Any], Any]:
    """--point X Y Z or --point NAME, a `PointGiven`; the platform's origin where it is not given. multiple: several."""
    return click.option(
        name,
        cls=_PointOption,
        type=Point(),
        multiple=multiple,
        default=() if multiple else (0.0, 0.0, 0.0),
        metavar="X Y Z | NAME",
        help=f"{help}: in the platform's frame, m, or a name of the design's [points]. Default: its origin.",
    )
