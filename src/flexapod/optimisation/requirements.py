"""What a constraint is to a search: bounds of quantities, and the class from which constraints are derived."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flexapod.checks import positive
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.optimisation.constraint_quantities import ConstraintQuantity, DesignProperty, Side, Values
from flexapod.optimisation.derivatives import DesignDerivatives
from flexapod.showing import in_notebooks
from flexapod.workspace.region import Region, as_region

#: The extreme values of a quantity over a region that the design to start from has.
Measure = Callable[[ConstraintQuantity, Side, Region | None], Array]


@in_notebooks
@dataclass(frozen=True)
class Requirement:
    """A bound of a quantity, as a search uses it.

    Parameters
    ----------
    name : str
        Name in messages and reports.
    quantity : ConstraintQuantity
        What is bounded.
    side : {"least", "most"}
        Whether the bound is a lower or an upper one.
    bound : ndarray, shape () or (6,)
        The bound, in the unit of the quantity: one number, or one for each leg.
    region : Region or None
        Where it holds; None for a property of the design.
    own : bool, optional
        Whether the bound is what the design to start from has, so that this design keeps it by definition.
    """

    name: str
    quantity: ConstraintQuantity
    side: Side
    bound: Array
    region: Region | None
    own: bool = False

    def margins(self, value: Array, column: Array | None = None) -> Array:
        """Return the relative margins of values, >= 0 where the bound is kept."""
        bound = (
            np.broadcast_to(self.bound, value.shape) if column is None or not self.bound.ndim else self.bound[column]
        )
        sign = 1.0 if self.side == "most" else -1.0
        if self.quantity.log:
            with np.errstate(divide="ignore"):
                return np.asarray(sign * np.log(bound / value))
        return np.asarray(sign * (1 - value / bound))

    def margin_derivatives(self, at: DesignDerivatives) -> tuple[Array, Array]:
        """Return the margins at the poses of `at`, and their derivatives by the variables."""
        found: Values = self.quantity.derivatives(at)
        margin = self.margins(found.value, found.column)
        bound = self.bound[found.column] if self.bound.ndim else np.broadcast_to(self.bound, found.value.shape)
        sign = -1.0 if self.side == "most" else 1.0
        scale = found.value if self.quantity.log else bound
        return margin, sign * found.slope / scale[:, None]

    def describe(self) -> dict[str, Any]:
        """Return the requirement in plain numbers and words."""
        return {
            "name": self.name,
            "kind": self.quantity.describe(),
            "side": self.side,
            "bound": self.bound.tolist(),
            "over": None if self.region is None else self.region.describe(),
        }


class Constraint:
    """Base class of all constraints: an extension point.

    To add a constraint, derive a class that writes `requirements`; `flexapod.optimise` then takes it.
    """

    def requirements(self, hexapod: Hexapod, region: Region, measure: Measure) -> list[Requirement]:
        """List what a design has to keep.

        Parameters
        ----------
        hexapod : Hexapod
            The design to start from.
        region : Region
            The region of the objective, for constraints without one of their own.
        measure : callable
            Gives the extreme values of a quantity over a region that the design to start from has.

        Returns
        -------
        list of Requirement
            The bounds.

        Raises
        ------
        ArgumentError
            If a bound is invalid.
        """
        raise NotImplementedError


def requirement(
    name: str, quantity: ConstraintQuantity, side: Side, bound: float | None, region: Region | None, measure: Measure
) -> Requirement:
    """One bound of a quantity; None is what the design to start from has."""
    own = bound is None
    if bound is None:
        values = measure(quantity, side, region)
        bound = float(values.max() if side == "most" else values.min())
    positive(bound, f"{name}: the bound", quantity.unit)
    return Requirement(name, quantity, side, np.array(float(bound)), region, own)


class OneBound(Constraint):
    """A constraint that bounds one quantity on one side, by its field `most` or `least`."""

    side: ClassVar[Side] = "most"

    def quantity(self, hexapod: Hexapod) -> tuple[str, ConstraintQuantity]:
        """Return the name and the quantity that is bounded."""
        raise NotImplementedError

    def requirements(self, hexapod: Hexapod, region: Region, measure: Measure) -> list[Requirement]:
        """List what a design has to keep; see `Constraint.requirements`."""
        name, quantity = self.quantity(hexapod)
        where = None if isinstance(quantity, DesignProperty) else own_region(self, region)
        return [requirement(name, quantity, self.side, getattr(self, self.side), where, measure)]


def own_region(constraint: Any, default: Region) -> Region:
    """The region that a constraint names, or else that of the objective."""
    return default if constraint.region is None else as_region(constraint.region)
