"""Numbers that a search changes, and what they make of the design's other numbers (see layout.py): the one place."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.design.derived_numbers import Derived
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import PLACES, SHORT, WORDED
from flexapod.design.packing import DERIVED
from flexapod.design.short_forms import ShortForm
from flexapod.design.shorthands import cube_centers, make
from flexapod.design.stiffness_laws import TableLaw
from flexapod.design.universal_axes import keeps_tangents


class Makers:
    """What follows from numbers of a design that are `changed`, by its short forms and in the core's words."""

    def __init__(self, hexapod: Hexapod, changed: NDArray[np.bool_]) -> None:
        self.changed = changed
        self.forms = [form for form in hexapod.short_forms if any(changed[SHORT[key]].any() for key in _keys(form))]
        tangent = keeps_tangents(hexapod.base_joints, hexapod.platform_joints, hexapod.home)
        self._axes = PLACES["base.universal_axes"][tangent]  # which they are does not change within a search
        self._tangent = tangent
        every = changed.copy()
        for form in self.forms:
            every[self.touched(form)] = True
            every[PLACES["home.position"]] |= "home.position" in form.made
        self._derived = Derived(hexapod, every)

    def __bool__(self) -> bool:
        return bool(self.forms or self._derived)

    def touched(self, form: ShortForm) -> NDArray[np.int64]:
        """The numbers that one of the short forms makes."""
        places = [PLACES[key].ravel() for key in form.made if key != "base.universal_axes"]
        return np.concatenate([*places, self._axes.ravel()] if "base.universal_axes" in form.made else places)

    def made_twice(self) -> tuple[int, str] | None:
        """A changed number that one of the short forms makes as well, and the table of this form; None without one."""
        for form in self.forms:
            made = self.touched(form)
            for number in made[self.changed[made]].tolist():
                return number, form.table
        return None

    def make(self, numbers: Any) -> None:
        """Write what follows into `FULL` numbers, which may be complex."""
        for form in self.forms:
            given = given_to(form, numbers, self.changed)
            for key, value in make(form.table, given).items():
                numbers[PLACES[key]] = value
            if "home.position" in form.made:
                in_base, in_platform = cube_centers(given)
                numbers[PLACES["home.position"]] = in_base - in_platform
            if "base.universal_axes" in form.made:
                out = numbers[PLACES["base.joints"]]
                out = (out - out.mean(axis=0))[self._tangent]
                length = np.sqrt(out[:, 0] ** 2 + out[:, 1] ** 2)
                numbers[self._axes] = np.stack([-out[:, 1] / length, out[:, 0] / length, 0 * length], axis=1)
        self._derived.make(numbers)


def given_to(form: ShortForm, numbers: Any, changed: NDArray[np.bool_]) -> dict[str, Any]:
    """The numbers of a short form by key, without those left out of it."""
    keys = [key for key in _keys(form) if key.rpartition(".")[2] in form.given or changed[SHORT[key]].any()]
    return {key.rpartition(".")[2]: numbers[SHORT[key]] for key in keys}


def changed_form(form: ShortForm, numbers: Array, changed: NDArray[np.bool_]) -> ShortForm:
    """A short form with its numbers as they are now, and what they stand for."""
    if not any(changed[SHORT[key]].any() for key in _keys(form)):
        return form
    given = {key: np.asarray(value) for key, value in given_to(form, numbers, changed).items()}
    made = {key: numbers[PLACES[key]] for key in form.made if key != "home.orientation"}
    return ShortForm(form.table, given, {**form.made, **made, **make(form.table, given)})


def _keys(form: ShortForm) -> list[str]:
    return [key for key in SHORT if key in form]


def with_numbers(hexapod: Hexapod, given: Array, changed: NDArray[np.bool_]) -> Hexapod:
    """The design with the entries that are `changed` taken from `FULL` numbers. Raises DesignError if it is none."""
    values = dict(hexapod.values())
    for key, place in (PLACES | WORDED).items():
        if changed[place].any() and key not in DERIVED:
            values[key] = given[place]
    if changed[WORDED["legs.series_stiffness"]].any():
        values["legs.series_stiffness"] = given[WORDED["legs.series_stiffness"]][
            :, : hexapod.legs.series_stiffness.shape[1]
        ]
    if isinstance(hexapod.legs.stiffness_law, TableLaw):
        for key in ("legs.stiffness_law.lengths", "legs.stiffness_law.stiffnesses"):
            values[key] = values[key][: len(hexapod.legs.stiffness_law.lengths)]
    forms = [changed_form(form, given, changed) for form in hexapod.short_forms]
    return Hexapod.from_values(values, forms)
