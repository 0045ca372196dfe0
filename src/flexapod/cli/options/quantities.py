"""Numbers with units on the command line: each option has a dimension, and takes the units of that dimension only."""

from __future__ import annotations

import re
from typing import Any, Literal

import click

from flexapod.design.units import QUANTITIES, printed, si_unit
from flexapod.tables import unit_named

NUMBER = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)", re.ASCII | re.DOTALL)
_MOST = {"time": 1e9}  # of a dimension, in the unit of its option
Need = Literal["finite", "> 0", ">= 0"]


class Quantity(click.ParamType):
    """A number of a dimension, as 0.5, 1e-6, 500ms or 20Hz; without a unit it is in `unit`, and so is the result."""

    def __init__(self, dimension: str, unit: str = "", need: Need = "finite") -> None:
        self.dimension, self.unit, self.need = dimension, unit or si_unit(dimension), need
        self.name = dimension

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        if not isinstance(value, str):
            return float(value)
        name = max(param.opts, key=len).lstrip("-") if param else self.dimension
        return self.number(value, name, lambda words: self.fail(words, param, ctx))

    def number(self, text: str, name: str, fail: Any) -> float:
        """The number in a text; `fail` is told what is wrong."""
        match = NUMBER.fullmatch(text.strip())
        known = QUANTITIES[self.dimension]
        unit = unit_named(match[2], known) if match and match[2] else self.unit
        if match is None or unit is None:
            units = ", ".join(map(printed, known))
            fail(
                f"{text!r} is not a number with a unit of {self.dimension}: {units}. The unit follows at once; without "
                f"one the number is in {printed(self.unit)}."
            )
        number = float(match[1])  # type: ignore[index]
        if unit != self.unit:
            (up, down), (own_up, own_down) = known[unit], known[self.unit]  # type: ignore[index]
            number = number * up / down * own_down / own_up
        holds = {"finite": True, "> 0": number > 0, ">= 0": number >= 0}[self.need]
        most = _MOST.get(self.dimension, 1e30)
        if not (abs(number) <= most and holds):  # NaN too
            needed = "" if self.need == "finite" else f" and {self.need}"
            fail(f"{name} is {text}; it must be finite{needed}, and at most {most:g} {printed(self.unit)}.")
        return number


def read(text: str, dimension: str, option: str) -> float:
    """A number of an option whose dimension another word decides, in SI units. Raises UsageError."""

    def fail(words: str) -> None:
        raise click.UsageError(f"{option}: {words}")

    return Quantity(dimension).number(text, option, fail)


def dimension_of(text: str, dimensions: tuple[str, ...]) -> str:
    """The first of some dimensions whose unit stands in a text; the first of all where it has none that is known."""
    match = NUMBER.fullmatch(text.strip())
    unit = match[2] if match else ""
    return next((one for one in dimensions if unit and unit_named(unit, QUANTITIES[one])), dimensions[0])
