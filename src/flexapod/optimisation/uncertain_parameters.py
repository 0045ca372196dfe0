"""Uncertain numbers of a design and their distributions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from flexapod.checks import one_of, positive
from flexapod.conventions import Array
from flexapod.design import layout
from flexapod.design.form_numbers import with_numbers
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import entries
from flexapod.design.strays import KEYS, Stray
from flexapod.errors import ArgumentError
from flexapod.optimisation.worst_ends import side_of
from flexapod.showing import in_notebooks

Distribution = Literal["uniform", "normal", "triangular", "lognormal"]
#: How many spreads below its value a number may come; a normal distribution is cut off at four.
_REACH = {"uniform": 1.0, "triangular": 1.0, "normal": 4.0, "lognormal": 0.0}


@in_notebooks
@dataclass(frozen=True)
class Uncertain:
    """A number of the design that is only known to lie about its value.

    Parameters
    ----------
    target : str
        A key of the design file with indices, as for `Variable`.
    spread : float
        Half the width of a uniform or triangular distribution, or the standard deviation of a normal or lognormal one.
    distribution : {"uniform", "normal", "triangular", "lognormal"}, optional
        The distribution. A normal one is cut off at four standard deviations.
    relative : bool, optional
        Whether the spread is a share of the design's value, or an amount in the unit of the key.
    each : bool, optional
        Whether several entries, such as those of legs.stiffness, vary independently or all together.

    Examples
    --------
    >>> tolerance = fx.Uncertain("legs.stiffness_law.bulk_modulus", 0.1)
    >>> len(tolerance.parameters(fx.load("motion-base")))
    6
    """

    target: str
    spread: float
    distribution: Distribution = "uniform"
    relative: bool = True
    each: bool = True

    def parameters(self, hexapod: Hexapod) -> list[UncertainParameter]:
        """Make the independent parameters for a design.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        list of UncertainParameter
            One for each number that varies independently.

        Raises
        ------
        ArgumentError
            If the range is one that a design cannot have.
        """
        positive(self.spread, f"{self.target}: the spread")
        one_of(self.distribution, f"{self.target}: the distribution", get_args(Distribution))
        if self.distribution == "lognormal" and self.spread > 2:
            raise ArgumentError(
                f"{self.target}: a lognormal spread of {self.spread} is of the logarithm; it must be at most 2."
            )
        index, rule, unit = entries(self.target)
        if self.target.startswith("home"):
            raise ArgumentError("the home pose is where the platform is told to stand, not an uncertain number.")
        index = layout.present(hexapod, index)
        value = layout.own(hexapod, index, self.target)
        if self.relative and not value.any():
            raise ArgumentError(
                f"{self.target} is zero, so a share of it is nothing. Give an amount (relative is False; on "
                "the command line it has no %)."
            )
        width = self.spread * np.abs(value) if self.relative else np.full(len(index), self.spread * unit)
        sets = [[k] for k in range(len(index))] if self.each else [list(range(len(index)))]
        stem, unit_name = self.target.partition("[")[0], layout.unit_name(self.target)
        found = []
        for chosen in sets:
            only = index[chosen[0]] if len(chosen) == 1 else None
            name = self.target if only is None else stem + "".join(f"[{i}]" for i in layout.indices(only))
            words = self.target if only is None else ", ".join(filter(None, (stem, layout.words(only))))
            low = (value - width * _REACH[self.distribution])[chosen].min()
            if rule.least is not None and (low < rule.least or (rule.open_ and low <= rule.least)):
                raise ArgumentError(
                    f"{words} may go down to {low / unit:.6g}; {rule.meaning} must be "
                    f"{'>' if rule.open_ else '>='} {rule.least:.6g}. Lessen the spread, or take another distribution."
                )
            found.append(
                UncertainParameter(
                    name, self.distribution, index[chosen], width[chosen], self.spread, words, unit, unit_name
                )
            )
        return found

    @property
    def words(self) -> str:
        """What is assumed, for readers: "legs.stiffness +-10 % (uniform)"."""
        spread = (
            f"{100 * self.spread:.6g} %"
            if self.relative
            else f"{self.spread:.6g} {layout.unit_name(self.target)}".strip()
        )
        cut = ", cut off at four of these" if self.distribution in ("normal", "lognormal") else ""
        return f"{self.target} +-{spread} ({self.distribution}{cut})"

    def strays(self, hexapod: Hexapod) -> list[Stray]:
        """Make the ranges of numbers that have no worst end, of which a certificate is for all.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        list of Stray
            One for each number that varies independently; none where the target is no place of joints or of the
            platform's mass centre.

        Raises
        ------
        ArgumentError
            If the range is one that a design cannot have.
        """
        found = []
        for parameter in self.parameters(hexapod):
            if any(layout.owner(number) not in KEYS for number in parameter.index):
                return []
            away = np.array([quantile(self.distribution, np.array(u), self.spread) for u in (0.0, 1.0)])
            if self.distribution == "lognormal":  # quantiles are factors of the design's value
                reach = np.abs(away - 1.0).max() * np.abs(layout.own(hexapod, parameter.index, self.target))
            else:
                reach = np.abs(away).max() * parameter.width
            found.append(Stray(parameter.words, tuple(parameter.index.tolist()), tuple(reach.tolist())))
        return found

    def at_worst(self, hexapod: Hexapod) -> Hexapod:
        """Make the design with these numbers at the ends of their ranges at which the index is least.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        Hexapod
            The design whose index is, at every pose, the least of all designs in the range.

        Raises
        ------
        ArgumentError
            If the index does not rise or fall with the numbers at every pose, such as with the places of joints.

        Notes
        -----
        omega_1^2 is the least of v^T K v / v^T J v (Rayleigh): it rises with every stiffness that adds v^T dK v >= 0,
        of legs, joints and on the diagonal of a suspension's, and falls with a mass or a moment of inertia that adds
        v^T dJ v >= 0 while mass centres stay. Of a screw's or an oil column's law it rises with what makes the leg
        stiffer at every length. A table's curve does not rise everywhere with each of its stiffnesses, and numbers that
        move the range in which a law holds have no worst end.
        """
        found = layout.with_short_forms(hexapod)
        changed = np.zeros(layout.FULL, dtype=bool)
        for parameter in self.parameters(hexapod):
            sides = np.array([side_of(number) for number in parameter.index])
            if not sides.all():
                name = layout.describe(int(parameter.index[int(np.argmin(np.abs(sides)))]))
                raise ArgumentError(
                    f"{name} is uncertain, and the index neither rises nor falls with it at every pose, so that no end "
                    "of its range is the worst. Stiffnesses of legs and joints, masses, moments of inertia and the "
                    "numbers of a stiffness law that do not move its range have one; places of joints and of the "
                    "platform's mass centre are proved over their ranges; for others certify several designs."
                )
            ends = np.array([quantile(self.distribution, np.array(u), self.spread) for u in (0.0, 1.0)])
            away = np.where(sides > 0, ends[0], ends[1])
            own = found[parameter.index]
            found[parameter.index] = own * away if self.distribution == "lognormal" else own + away * parameter.width
            changed[parameter.index] = True
        return with_numbers(hexapod, found, changed)


@in_notebooks
class UncertainRange(NamedTuple):
    """What was assumed of an uncertain parameter, in the unit of its key.

    Attributes
    ----------
    words : str
        Its name for readers, with legs counted from 1.
    unit : str
        Its unit; "" for a pure number.
    distribution : str
        Its distribution; "fixed" for a number of the payload that does not vary.
    nominal : float
        Where the design has it; NaN for the payload.
    low, high : float
        Its least and largest value. A normal or lognormal distribution is cut off at four standard deviations.
    """

    words: str
    unit: str
    distribution: str
    nominal: float
    low: float
    high: float


@in_notebooks
@dataclass(frozen=True)
class UncertainParameter:
    """A parameter that varies independently: numbers of the design with their widths, or a range of the payload.

    Attributes
    ----------
    name : str
        Its name.
    distribution : {"uniform", "normal", "triangular", "lognormal"}
        Its distribution.
    index : ndarray of int or None
        The numbers of the design; None for the payload.
    width : ndarray
        The spread of each number, SI; for the payload its smallest and largest value.
    spread : float
        The spread as given.
    words : str
        The name for readers, with legs counted from 1.
    unit, unit_name : float, str
        The unit of its key in SI units, and as people write it.
    """

    name: str
    distribution: Distribution
    index: Any
    width: Array
    spread: float
    words: str = ""
    unit: float = 1.0
    unit_name: str = ""

    @property
    def fixed(self) -> bool:
        """Whether its range is a single number."""
        return self.index is None and self.width[0] == self.width[1]


def quantile(distribution: str, u: Array, spread: float) -> Array:
    """The distribution of unit spread about 0 (lognormal: of the factor about 1), cut off where it has no end."""
    if distribution == "uniform":
        return 2 * u - 1
    if distribution == "triangular":
        return np.where(u < 0.5, np.sqrt(2 * u) - 1, 1 - np.sqrt(np.maximum(2 * (1 - u), 0.0)))
    from scipy.special import ndtr, ndtri

    cut = ndtr(-4.0)
    normal = np.asarray(ndtri(cut + u * (1 - 2 * cut)))
    return np.exp(spread * normal) if distribution == "lognormal" else normal
