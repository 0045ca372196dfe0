"""--point: a place on the platform, as three numbers or by its name in the design."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import click
from click.shell_completion import CompletionItem

from flexapod.cli.options.quantities import LENGTH, NUMBER

_BETWEEN = "\x1f"  # the words of a point within one, which nobody types
#: What an option of a point gives: x, y, z in m, or a name.
PointGiven = tuple[float, float, float] | str


class Point(click.ParamType):
    """x, y, z (m, or with units) or the name of a point of the design; completes the names."""

    name = "point"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> PointGiven:
        if not isinstance(value, str):
            return tuple(value)
        words = value.split(_BETWEEN)
        if not NUMBER.fullmatch(words[0].strip()):
            return value
        if len(words) != 3:
            self.fail(f"{' '.join(words)} is no point; it takes three numbers X Y Z, or a NAME.", param, ctx)
        x, y, z = (LENGTH.convert(each, param, ctx) for each in words)
        return x, y, z

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from flexapod.design.loading import load
        from flexapod.errors import FlexapodError

        words = (ctx.params.get("design"), *ctx.args)  # among the latter while the point itself is missing
        try:
            names = load(next(word for word in words if word)).points
        except (FlexapodError, StopIteration):  # nothing is typed yet that can be read
            return []
        return [CompletionItem(name) for name in names if name.startswith(incomplete)]


def one_word(command: click.Command, given: Sequence[str]) -> list[str]:
    """The words of a command line, those of each point together: an option of click takes one word, or always three."""
    names = {name for one in command.params if isinstance(one.type, Point) for name in one.opts}
    found: list[str] = []
    left = list(given)
    while left:
        word = left.pop(0)
        if word == "--":
            return [*found, word, *left]
        name, equals, value = word.partition("=")
        if name in names and (equals or left):
            value = value if equals else left.pop(0)
            if NUMBER.fullmatch(value.strip()):
                value = _BETWEEN.join([value, *left[:2]])
                del left[:2]
            word = f"{name}={value}"
        found.append(word)
    return found


def point_option(help: str, name: str = "--point", multiple: bool = False) -> Callable[[Any], Any]:
    """--point X Y Z or --point NAME, a `PointGiven`; the platform's origin where it is not given. multiple: several."""
    return click.option(
        name,
        type=Point(),
        multiple=multiple,
        default=() if multiple else (0.0, 0.0, 0.0),
        metavar="X Y Z | NAME",
        help=f"{help}: in the platform's frame, m, or a name of the design's [points]. Default: its origin.",
    )
