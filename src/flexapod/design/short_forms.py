"""The short forms that a design was given by: they stay its source until what they made is changed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from flexapod.conventions import Array
from flexapod.design.universal_axes import default_axes_of

#: What a short form also makes where the design does not say it; a value of one's own takes its place.
_BESIDE = ("base.universal_axes", "home.")


@dataclass(frozen=True, eq=False)
class ShortForm:
    """A table of short keys of a design.

    Parameters
    ----------
    table : str
        The table: base.circle, platform.circle, cubic, legs.lower.rod, legs.upper.rod or home.turned.
    given : mapping
        Its numbers by key, SI, and text.
    made : mapping
        What they stand for: values by plain key.
    """

    table: str
    given: Mapping[str, Any]
    made: Mapping[str, Array] = field(repr=False)

    def values(self) -> dict[str, Any]:
        """Its numbers by dotted key."""
        return {f"{self.table}.{key}": value for key, value in self.given.items()}

    def __contains__(self, key: str) -> bool:
        """Whether a dotted key is the table or one of its keys."""
        return key == self.table or key.startswith(f"{self.table}.")


def standing(forms: Iterable[ShortForm], values: Mapping[str, Any]) -> tuple[ShortForm, ...]:
    """The short forms that still make the values of a design, without what these have of their own."""
    found = []
    for form in forms:
        changed = [key for key, made in form.made.items() if key not in values or not _same(values[key], made)]
        if all(key.startswith(_BESIDE) for key in changed):
            own = tuple(beside for beside in _BESIDE if any(key.startswith(beside) for key in changed))
            if own:
                form = replace(form, made={key: made for key, made in form.made.items() if not key.startswith(own)})
            if form.made:
                found.append(form)
    return tuple(found)


def _same(one: Array, other: Array) -> bool:
    return one.shape == other.shape and one.tobytes() == other.tobytes()


def written(values: Mapping[str, Any], forms: Iterable[ShortForm]) -> dict[str, Any]:
    """The values as a file gives them: short forms in place of what they make, keys before the tables below them."""
    short = {key: form for form in forms for key in form.made}
    if "base.universal_axes" in short and not _same(default_axes_of(values), values["base.universal_axes"]):
        del short["base.universal_axes"]  # the default of another home pose or platform
    found: dict[str, Any] = {}
    for key, value in values.items():
        found |= short[key].values() if key in short else {key: value}
    tables = list(dict.fromkeys(key.partition(".")[0] if "." in key else "" for key in found))
    return dict(sorted(found.items(), key=lambda item: _place(item[0], tables)))


def _place(key: str, tables: list[str]) -> tuple[int, int]:
    return tables.index(key.partition(".")[0]) if "." in key else -1, key.count(".")
