"""Numbers with units on the command line: each option has a dimension, and takes the units of that dimension only."""

from __future__ import annotations

import re
from typing import Any, Literal

import click

NUMBER = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)", re.ASCII | re.DOTALL)
_MOST = {"time": 1e9}  # of a dimension, in the unit of its option
Need = Literal["finite", "> 0", ">= 0"]


class Quantity(click.ParamType):
    """A number of a dimension, as 0.5, 1e-6, 500ms or 20Hz; without a unit it is in `unit`, and so is the result."""

    def __init__(self, dimension: str, unit: str = "", need: Need = "finite") -> None:
        self.dimension, self.unit, self.need = dimension, unit, need
        self.name = dimension

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        if not isinstance(value, str):
            return float(value)
        name = max(param.opts, key=len).lstrip("-") if param else self.dimension
        return self.number(value, name, lambda words: self.fail(words, param, ctx))

    def number(self, text: str, name: str, fail: Any) -> float:
        """The number in a text; `fail` is told what is wrong."""
        from flexapod.design.units import QUANTITIES, printed, si_unit  # no NumPy for help
        from flexapod.tables import unit_named

        match = NUMBER.fullmatch(text.strip())
        known, own = QUANTITIES[self.dimension], self.unit or si_unit(self.dimension)
        unit = unit_named(match[2], known) if match and match[2] else own
        if match is None or unit is None:
            units = ", ".join(map(printed, known))
            fail(
                f"{text!r} is not a number with a unit of {self.dimension}: {units}. Give a finite number and its unit "
                f"right behind it; without one it is in {printed(own)}."
            )
        number = float(match[1])  # type: ignore[index]
        if unit != own:
            (up, down), (own_up, own_down) = known[unit], known[own]  # type: ignore[index]
            number = number * up / down * own_down / own_up
        holds = {"finite": True, "> 0": number > 0, ">= 0": number >= 0}[self.need]
        most = _MOST.get(self.dimension, 1e30)
        if not (abs(number) <= most and holds):  # NaN too
            needed = "" if self.need == "finite" else f" and {self.need}"
            fail(f"{name} is {text}; it must be finite{needed}, and at most {most:g} {printed(own)}.")
        return number


LENGTH, POSITIVE_LENGTH, DEGREES = Quantity("length"), Quantity("length", need="> 0"), Quantity("angle", "deg")
TIME, FREQUENCY, HERTZ = (
    Quantity("time", need="> 0"),
    Quantity("frequency", need="> 0"),
    Quantity("frequency", "Hz", "> 0"),
)
SIX = (LENGTH,) * 3 + (DEGREES,) * 3  #: of a pose: m, then degrees


def read(text: str, dimension: str, option: str, unit: str = "", need: Need = "finite") -> float:
    """A number of an option whose dimension another word decides, in `unit`, else in SI units. Raises UsageError."""

    def fail(words: str) -> None:
        raise click.UsageError(f"{option}: {words}")

    return Quantity(dimension, unit, need).number(text, option, fail)


def dimension_of(text: str, dimensions: tuple[str, ...]) -> str:
    """The first of some dimensions whose unit stands in a text; the first of all where it has none that is known."""
    from flexapod.design.units import QUANTITIES
    from flexapod.tables import unit_named

    match = NUMBER.fullmatch(text.strip())
    unit = match[2] if match else ""
    return next((one for one in dimensions if unit and unit_named(unit, QUANTITIES[one])), dimensions[0])
