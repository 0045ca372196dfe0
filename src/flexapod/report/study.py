"""A study as data: numbers with units, tables, figures and cautions, which one renderer each turns into text or a page.

`terminal.show` prints a study, `html.page` makes a page of it, `Study.to_dict` gives what `--json` prints. A new study
is a function that returns a `Study`; nothing else needs to know of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any, Literal

from flexapod.design.catalogue import assumed_of
from flexapod.mechanics.cautions import Caution

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from flexapod.design.hexapod import Hexapod
    from flexapod.plots.style import Drawn

Shown = Literal["both", "page", "terminal"]  # where something is shown


@dataclass(frozen=True)
class Row:
    """A number with its label: a card at the top of a page, a line in the terminal. `note` follows the unit."""

    label: str
    value: float | str | None
    unit: str = ""
    digits: int = 4
    note: str = ""
    on: Shown = "both"


@dataclass(frozen=True)
class Column:
    """A column of a table: words, or numbers with so many significant digits. `marked`: cells that break a limit."""

    title: str
    values: Sequence[float | str | None] | NDArray[Any]
    unit: str = ""
    digits: int = 4
    marked: Sequence[bool] | NDArray[Any] | None = None
    on: Shown = "both"


@dataclass(frozen=True)
class Table:
    """Columns, the first of them the names of the rows. style: heat tints shares of 1, facts are names and values,
    narrow has many columns."""

    columns: Sequence[Column]
    note: str = ""
    title: str = ""
    style: Literal["", "heat", "facts", "narrow"] = ""
    on: Shown = "both"


@dataclass(frozen=True)
class Bars:
    """Effects (shares of 1) by name, as bars to both sides; `details` stand small below the names."""

    names: Sequence[str]
    effects: Sequence[float]
    details: Sequence[str]
    title: str = ""
    brief: Sequence[int] = ()  # those that the terminal shows
    on: Shown = "both"


@dataclass(frozen=True)
class Drawing:
    """A figure: `draw` makes it when it is wanted. tight: cut to what its lines cover."""

    name: str
    title: str
    draw: Callable[[], Drawn]
    caption: str = ""
    tag: str = ""
    wide: bool = False
    tight: bool = False


@dataclass(frozen=True)
class Section:
    """A part of a page: a heading, words, and what is shown below them. legend: colours with their names."""

    title: str
    items: Sequence[Table | Bars | Drawing]
    words: Sequence[str] = ()
    legend: Sequence[tuple[str, str]] = ()
    style: Literal["", "pair", "modes"] = ""


@dataclass(frozen=True, eq=False)
class Study:
    """What a study found.

    data: the results by name, with units in the names, in SI units. sections: what a page shows below the main numbers,
    in order. files: what is written, by the file's name: a function that gives text, a figure or a dataset; None is the
    page.
    """

    hexapod: Hexapod
    subject: str
    about: str
    data: Mapping[str, Any]
    rows: Sequence[Row] = ()
    sections: Sequence[Section] = ()
    cautions: Sequence[Caution] = ()
    files: Mapping[str, Callable[[], str | Drawn | xr.Dataset] | None] = field(default_factory=dict)
    dataset: xr.Dataset | None = None

    def to_dict(self) -> dict[str, Any]:
        """The results by name, and the cautions as `warnings`; arrays stay arrays, what is not available is None.

        Of a packaged design for which numbers are assumed, `assumed` says which.
        """
        told = {**self.data, "warnings": [caution.text for caution in self.cautions]}
        return {**told, "assumed": self.assumed} if self.assumed else told

    @property
    def assumed(self) -> str:
        """What the design assumes, for want of data; "" where that is nothing."""
        return assumed_of(self.hexapod)

    def to_dataset(self) -> xr.Dataset | None:
        """The results as a Dataset, where the study has one."""
        return self.dataset

    def _repr_html_(self) -> str:
        """The page in a frame of its own, for a notebook."""
        from flexapod.report.html import page

        return f'<iframe srcdoc="{escape(page(self))}" style="width: 100%; height: 45em; border: 0"></iframe>'


def shown_on(items: Iterable[Any], place: Shown) -> list[Any]:
    """The items that are shown at a place."""
    return [item for item in items if getattr(item, "on", "both") in ("both", place)]
