"""Designs with uncertain numbers, many at a time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexapod.conventions import TRANSLATIONS, Array
from flexapod.design.form_numbers import Makers
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import FULL, HOME, describe, with_short_forms
from flexapod.design.payload import add_payload
from flexapod.errors import ArgumentError, shown
from flexapod.mechanics.inputs import as_hexapod
from flexapod.optimisation.payload_range import Payload
from flexapod.optimisation.uncertain_parameters import Uncertain, UncertainRange, quantile


class Ensemble:
    """Designs whose uncertain parameters are functions of points in the unit cube."""

    def __init__(self, hexapod: Hexapod, uncertain: Sequence[Uncertain | Payload]) -> None:
        uncertain = [uncertain] if isinstance(uncertain, Uncertain | Payload) else list(uncertain)
        wrong = [u for u in uncertain if not isinstance(u, Uncertain | Payload)]
        if wrong or not uncertain:
            raise ArgumentError(
                f"uncertain {f'holds {shown(wrong[0])}' if wrong else 'is empty'}; give Uncertain or Payload."
            )
        self.hexapod = as_hexapod(hexapod)
        self.base = with_short_forms(hexapod)
        every = [p for u in uncertain for p in u.parameters(hexapod)]
        self.payload = [p for p in every if p.index is None]
        self.parameters = [p for p in every if not p.fixed]
        names = [p.name for p in self.parameters]
        if len(set(names)) < len(names) or len(self.payload) > 4:
            double = next((n for n in names if names.count(n) > 1), "the payload")
            raise ArgumentError(f"{double} is given twice. Leave one of them out.")
        if not names:
            raise ArgumentError("nothing is uncertain: every range is one number.")
        self.names = names
        changed = np.zeros(FULL, dtype=bool)
        for p in self.parameters:
            if p.index is not None:
                changed[p.index] = True
        self._makers = Makers(hexapod, changed)
        if twice := self._makers.made_twice():
            number, table = twice
            raise ArgumentError(f"{describe(number)} and [{table}], which makes it, are both uncertain. Take one.")

    def designs(self, u: Array) -> Array:
        """Designs (s, n) at points u (s, p) of the unit cube."""
        found = np.tile(self.base, (len(u), 1))
        load = {p.name: np.full(len(u), p.width[0]) for p in self.payload}
        for k, p in enumerate(self.parameters):
            if p.index is None:
                load[p.name] = self.value(k, u[:, k])
            else:
                away = quantile(p.distribution, u[:, k], p.spread)
                if p.distribution == "lognormal":
                    found[:, p.index] = self.base[p.index] * away[:, None]
                else:
                    found[:, p.index] += away[:, None] * p.width
        if self._makers:
            for row in found:
                self._makers.make(row)
        found = found[:, : HOME.start]
        if load:
            add_payload(
                found, load["payload.mass"], np.stack([load[f"payload.{axis}"] for axis in TRANSLATIONS], axis=1)
            )
        return found

    def value(self, k: int, u: Array) -> Array:
        """What parameter k is at u, SI: the number itself (the first of several that vary together)."""
        p = self.parameters[k]
        if p.index is None:
            return p.width[0] + (p.width[1] - p.width[0]) * u
        away, own = quantile(p.distribution, u, p.spread), self.base[p.index[0]]
        return own * away if p.distribution == "lognormal" else own + away * p.width[0]

    def told(self, k: int, u: Array) -> Array:
        """The same in the unit of the parameter's key."""
        return self.value(k, u) / self.parameters[k].unit

    def ranges(self) -> dict[str, UncertainRange]:
        """What is assumed of every parameter, and of what the payload holds fixed, by name."""
        found = {}
        for p in [*(p for p in self.parameters if p.index is not None), *self.payload]:
            if p.fixed:
                found[p.name] = UncertainRange(p.words, p.unit_name, "fixed", np.nan, p.width[0], p.width[0])
                continue
            low, high = self.told(self.names.index(p.name), np.array([0.0, 1.0])).tolist()
            nominal = np.nan if p.index is None else float(self.base[p.index[0]] / p.unit)
            found[p.name] = UncertainRange(p.words, p.unit_name, p.distribution, nominal, low, high)
        return found
