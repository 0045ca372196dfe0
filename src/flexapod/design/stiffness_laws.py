"""Laws of a leg's axial stiffness by its length, in place of a constant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np

from flexapod import _core
from flexapod.conventions import Array
from flexapod.design.schema import KEYS
from flexapod.design.value import Value
from flexapod.errors import DesignError, shown, told_apart

TABLE = "legs.stiffness_law"
MOST_NODES = 24  #: of a table, as the core has room for


class _Law(Value):
    """A law with numbers of each leg."""

    kind: ClassVar[_core.Law]

    def __post_init__(self) -> None:
        for item in fields(self):  # type: ignore[arg-type]
            self.set_checked(item.name, getattr(self, item.name), f"{TABLE}.{item.name}", (6,))


@dataclass(frozen=True, eq=False, repr=False)
class ScrewLaw(_Law):
    """A screw or rod that gets softer as it gets longer: 1/k = 1/fixed + (L - zero_length) / axial_rigidity.

    Parameters
    ----------
    fixed : array_like
        Stiffness of nut, bearings and all else that does not change with the length, N/m, one or six, stored as (6,).
    axial_rigidity : array_like
        Young's modulus times cross section of the part that gets longer, N, one or six, stored as (6,).
    zero_length : array_like
        Distance between the leg's joints at which nothing of that part is out, m, one or six, stored as (6,).

    Raises
    ------
    DesignError
        For numbers of another shape, or not > 0.

    Notes
    -----
    Two springs in series: the axial stiffness of a bar is E A / l (ISO 3408-4 calculates ball screws so). L is the
    leg's commanded (unstretched) length. The law holds from `zero_length` on.

    Examples
    --------
    >>> law = fx.design.ScrewLaw(fixed=80e6, axial_rigidity=2.1e11 * 2e-4, zero_length=0.4)
    >>> law.range[0].tolist()
    [0.4, inf]
    """

    kind = _core.Law.screw
    fixed: Array
    axial_rigidity: Array
    zero_length: Array

    @property
    def range(self) -> Array:
        """Least and greatest length at which the law holds, m, (6, 2)."""
        return np.stack([self.zero_length, np.full(6, np.inf)], axis=1)


@dataclass(frozen=True, eq=False, repr=False)
class HydraulicLaw(_Law):
    """Two columns of oil: k = bulk_modulus (area_1 / (x + dead_1) + area_2 / (stroke - x + dead_2)), x = L - shortest.

    Parameters
    ----------
    bulk_modulus : array_like
        Of the oil with its air and hoses, Pa, one or six, stored as (6,).
    area_1, area_2 : array_like
        Areas of the piston in the chamber that lengthens the leg and in the one that shortens it, m2, one or six;
        `area_2` 0 is a cylinder with one chamber.
    dead_1, dead_2 : array_like
        Length of the column that is left in each chamber at its end of the stroke, with ports and hoses, m, one or six.
    stroke : array_like
        Difference between the longest and the shortest leg, m, one or six.
    shortest : array_like
        Distance between the leg's joints with the piston at its lower end, m, one or six.

    Raises
    ------
    DesignError
        For numbers of another shape, or out of range.

    Notes
    -----
    H. E. Merritt, Hydraulic Control Systems (1967), Section 6-2: both chambers closed by the valve are springs side by
    side. L is the leg's commanded (unstretched) length. The law holds for 0 <= x <= stroke.

    Examples
    --------
    >>> law = fx.design.HydraulicLaw(1.4e9, 2e-3, 1.2e-3, 0.05, 0.05, stroke=1.0, shortest=1.6)
    >>> law.range[0].tolist()
    [1.6, 2.6]
    """

    kind = _core.Law.hydraulic
    bulk_modulus: Array
    area_1: Array
    area_2: Array
    dead_1: Array
    dead_2: Array
    stroke: Array
    shortest: Array

    @property
    def range(self) -> Array:
        """Least and greatest length at which the law holds, m, (6, 2)."""
        return np.stack([self.shortest, self.shortest + self.stroke], axis=1)


@dataclass(frozen=True, eq=False, repr=False)
class TableLaw(_Law):
    """Stiffnesses at given lengths, measured or from finite elements, the same for all legs.

    Parameters
    ----------
    lengths : array_like
        Distances between a leg's joints, rising, m, (n,), n from 2 to 24.
    stiffnesses : array_like
        Axial stiffness at each length, N/m, (n,).

    Raises
    ------
    DesignError
        For lengths that do not rise, another number of stiffnesses than of lengths, and too few or too many of them.

    Notes
    -----
    Between the lengths the monotone cubic of F. N. Fritsch and R. E. Carlson, SIAM Journal on Numerical Analysis 17
    (1980), as `scipy.interpolate.PchipInterpolator` has it. L is the leg's commanded (unstretched) length. The law
    holds from the first length to the last.

    Examples
    --------
    >>> law = fx.design.TableLaw([0.5, 0.6, 0.7], [9e7, 7e7, 6e7])
    >>> law.range[5].tolist()
    [0.5, 0.7]
    """

    kind = _core.Law.table
    lengths: Array
    stiffnesses: Array

    def __post_init__(self) -> None:
        for item in fields(self):
            self.set_checked(item.name, getattr(self, item.name), f"{TABLE}.{item.name}")
        n = len(self.lengths)
        if not 2 <= n <= MOST_NODES:
            raise DesignError(
                f"{TABLE}.lengths has {n} lengths; it must have from 2 to {MOST_NODES}. "
                + ("Give the ends of the range at least." if n < 2 else "Leave out those between which little changes.")
            )
        if len(self.stiffnesses) != n:
            raise DesignError(
                f"{TABLE}.stiffnesses has {len(self.stiffnesses)} numbers and {TABLE}.lengths {n}; give one stiffness "
                "for each length."
            )
        falling = np.flatnonzero(np.diff(self.lengths) <= 0)
        if falling.size:
            i = int(falling[0])
            one, other = told_apart(float(self.lengths[i]), float(self.lengths[i + 1]), (6, 6))
            raise DesignError(
                f"{TABLE}.lengths[{i + 1}] is {other} m, after {one} m; lengths must rise. Sort the table by length."
            )

    @property
    def range(self) -> Array:
        """Least and greatest length at which the law holds, m, (6, 2)."""
        return np.tile(self.lengths[[0, -1]], (6, 1))


StiffnessLaw = ScrewLaw | HydraulicLaw | TableLaw
LAWS: dict[str, type[StiffnessLaw]] = {law.kind.name: law for law in (ScrewLaw, HydraulicLaw, TableLaw)}


def keys_of(law: type[StiffnessLaw]) -> tuple[str, ...]:
    """The keys of a law's numbers below its table."""
    return tuple(item.name for item in fields(law))


def values_of_law(law: StiffnessLaw | None) -> dict[str, Any]:
    """A law by dotted file key."""
    if law is None:
        return {}
    numbers = {f"{TABLE}.{name}": getattr(law, name) for name in keys_of(type(law))}
    return {f"{TABLE}.kind": law.kind.name, **numbers}


def law_of(values: Mapping[str, Any]) -> StiffnessLaw | None:
    """The law of a design by its values, where they have one. Raises DesignError for one that is not complete."""
    given = {key.rpartition(".")[2]: value for key, value in values.items() if key.startswith(f"{TABLE}.")}
    if not given:
        return None
    kind = given.pop("kind", None)
    known = ", ".join(f'"{name}"' for name in LAWS)
    if kind is None:
        raise DesignError(f"{TABLE}.kind is missing; it says which law the numbers are of. Give one of: {known}.")
    if kind not in LAWS:
        raise DesignError(f"{TABLE}.kind is {shown(kind)}; it must be one of: {known}.")
    names = keys_of(LAWS[kind])
    other = [name for name in given if name not in names]
    if other:
        raise DesignError(
            f"{TABLE}.{other[0]} is no number of the law {kind!r}, which has {', '.join(names)}. Leave it out, or give "
            "another kind."
        )
    missing = [name for name in names if name not in given]
    if missing:
        lines = "; ".join(f"{TABLE}.{name} ({KEYS[f'{TABLE}.{name}'].meaning})" for name in missing)
        both = " (area gives both areas)" if "area_1" in missing or "area_2" in missing else ""
        raise DesignError(f"missing: {lines}. The law {kind!r} needs {', '.join(names)}{both}.")
    return LAWS[kind](**given)
