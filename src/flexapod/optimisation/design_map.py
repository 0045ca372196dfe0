"""From the variables of a search to a design and back, with exact derivatives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexapod.checks import number
from flexapod.conventions import Array
from flexapod.design import layout
from flexapod.design.form_numbers import Makers, with_numbers
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, DesignError, shown, told_apart
from flexapod.optimisation.design_results import VariableRange
from flexapod.optimisation.parameters import Parameter
from flexapod.optimisation.variables import JointCircle, Variable

_STEP = 1e-200  # of the complex step: no difference is taken, so nothing cancels


class DesignMap:
    """From variables x (n,), SI units, to the numbers of a design (see layout.py) and back to a `Hexapod`."""

    def __init__(self, hexapod: Hexapod, variables: Sequence[Variable | JointCircle]) -> None:
        variables = [variables] if isinstance(variables, Variable | JointCircle) else list(variables)
        wrong = [v for v in variables if not isinstance(v, Variable | JointCircle)]
        if wrong or not variables:
            what = f"holds {shown(wrong[0])}" if wrong else "is empty"
            raise ArgumentError(f"variables {what}; give at least one Variable or JointCircle.")
        self.hexapod = hexapod
        self.parts = [part for variable in variables for part in variable.parts(hexapod)]
        self.parameters = [p for part in self.parts for p in part.parameters]
        if not self.parameters:
            raise ArgumentError("variables holds nothing that varies; give at least one pair of bounds (least, most).")
        self._every = np.zeros(layout.FULL, dtype=bool)
        for part in self.parts:
            self._every[part.touched] = True
        self._makers = Makers(hexapod, self._every.copy())
        self._check_apart()
        for form in self._makers.forms:
            self._every[self._makers.touched(form)] = True
        self.changed = self._every[: layout.SIZE]
        self._axes = layout.PLACES["base.universal_axes"]
        self._turned = self.changed[self._axes].any(axis=1)
        self._numbers = layout.with_short_forms(hexapod)

    def _check_apart(self) -> None:
        owner: dict[int, str] = {}
        names: set[str] = set()
        for part in self.parts:
            title = ", ".join(p.name for p in part.parameters) or "a joint circle"
            for place in part.touched.tolist():
                if place in owner:
                    raise ArgumentError(
                        f"{owner[place]} and {title} both set {layout.describe(place)}. Leave one of them out."
                    )
                owner[place] = title
            for p in part.parameters:
                if p.name in names:
                    raise ArgumentError(f"two variables are named {p.name!r}. Give one of them another name.")
                names.add(p.name)
        if made := self._makers.made_twice():
            place, table = made
            raise ArgumentError(
                f"{owner[place]} and [{table}] both set {layout.describe(place)}. Leave one of them out."
            )

    @property
    def names(self) -> list[str]:
        return [p.name for p in self.parameters]

    @property
    def low(self) -> Array:
        return np.array([p.low for p in self.parameters])

    @property
    def high(self) -> Array:
        return np.array([p.high for p in self.parameters])

    @property
    def logarithmic(self) -> NDArray[np.bool_]:
        return np.array([p.log for p in self.parameters])

    def own(self) -> Array:
        """Where the design itself has the variables; they may lie outside the bounds."""
        return np.concatenate([part.start() for part in self.parts])

    def numbers(self, x: Any) -> Any:
        """The design's numbers, real or complex as x is, without those of short forms."""
        return self._all_numbers(x)[: layout.SIZE]

    def _all_numbers(self, x: Any) -> Any:
        x = np.asarray(x)
        found = self._numbers.astype(np.result_type(x, np.float64))
        first = 0
        for part in self.parts:
            count = len(part.parameters)
            part.put(x[first : first + count], found)
            first += count
        self._makers.make(found)
        for axis in self._axes[self._turned]:
            with np.errstate(invalid="ignore"):  # an axis of length zero is NaN, which makes no hexapod
                found[axis] = found[axis] / np.sqrt((found[axis] ** 2).sum())
        return found

    def jacobian(self, x: Array) -> Array:
        """(m, n): derivatives of the numbers by the variables."""
        n = len(self.parameters)
        columns = [self.numbers(x + 1j * _STEP * np.eye(n)[k]).imag / _STEP for k in range(n)]
        return np.stack(columns, axis=1)

    def hexapod_at(self, x: Array) -> Hexapod:
        """Raises DesignError where the numbers are no hexapod."""
        numbers = self._all_numbers(x)
        if not np.isfinite(numbers[self._every]).all():
            raise DesignError("the variables give numbers that are not finite")
        return with_numbers(self.hexapod, numbers, self._every)

    def values(self, x: Array) -> dict[str, float]:
        """The variables by name, in the unit of their keys."""
        return {p.name: float(v / p.unit) for p, v in zip(self.parameters, x, strict=True)}

    def ranges(self) -> dict[str, VariableRange]:
        """Where the design has the variables, and their bounds, by name, in the units of their keys."""
        own = self.values(self.own())
        return {
            p.name: VariableRange(p.unit_name, own[p.name], p.low / p.unit, p.high / p.unit) for p in self.parameters
        }

    def from_values(self, values: Mapping[str, float]) -> Array:
        """The variables from values by name (as `values` gives them); those left out as the design has them."""
        x = np.clip(self.own(), self.low, self.high)
        if not isinstance(values, Mapping):
            raise ArgumentError(f"start is {shown(values)}; give a mapping of variables to values.")
        for name, given in values.items():
            if name not in self.names:
                raise ArgumentError(f"start names {name!r}, which is no variable. There are: {', '.join(self.names)}.")
            k = self.names.index(name)
            p = self.parameters[k]
            value = number(given, f"the start of {name}", p.unit_name)
            if not p.low <= value * p.unit <= p.high:
                low, high = p.low / p.unit, p.high / p.unit
                told = told_apart(value, low if value * p.unit < p.low else high, (6, 6))[0]
                raise ArgumentError(
                    f"the start has {name} = {told}, outside its bounds {low:.6g} to {high:.6g}. Move the start, or "
                    "widen the bounds."
                )
            x[k] = value * p.unit
        return x

    def unit(self, x: Array) -> Array:
        """From 0 to 1 between the bounds (of the logarithms, where they are searched)."""
        low, high, x = self._searched(self.low), self._searched(self.high), self._searched(x)
        return (x - low) / (high - low)

    def from_unit(self, u: Array) -> tuple[Array, Array]:
        """The variables at u, and dx/du (n,)."""
        low, high = self._searched(self.low), self._searched(self.high)
        x = low + np.clip(u, 0.0, 1.0) * (high - low)
        x = np.where(self.logarithmic, np.exp(np.where(self.logarithmic, x, 0.0)), x)
        slope = (high - low) * np.where(self.logarithmic, x, 1.0)
        return np.clip(x, self.low, self.high), slope

    def _searched(self, x: Array) -> Array:
        return np.where(self.logarithmic, np.log(np.where(self.logarithmic, x, 1.0)), x)

    def describe(self) -> list[dict[str, Any]]:
        """Everything that makes this map and no other, in plain numbers and words."""
        found = []
        for part in self.parts:
            plain: dict[str, Any] = {"part": type(part).__name__}
            for name, value in vars(part).items():
                plain[name] = _plain(value)
            found.append(plain)
        return found


def _plain(value: Any) -> Any:
    if isinstance(value, Parameter):
        return {"name": value.name, "low": value.low, "high": value.high, "log": value.log}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return value.tolist() if isinstance(value, np.ndarray) else value
