"""A load on the platform whose mass and place are known up to a range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import not_negative, number, numbers, several
from flexapod.conventions import TRANSLATIONS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.payload import with_payload
from flexapod.design.strays import AT_PAYLOAD, Stray
from flexapod.errors import ArgumentError
from flexapod.optimisation.uncertain_parameters import UncertainParameter
from flexapod.showing import in_notebooks


@in_notebooks
@dataclass(frozen=True)
class Payload:
    """A load on the platform beyond that of the design: a point mass, uniformly distributed.

    Parameters
    ----------
    mass : tuple of float
        Smallest and largest mass, kg.
    position : tuple, optional
        Three coordinates in the platform frame, m: each a number, or a pair (smallest, largest).

    Examples
    --------
    >>> payload = fx.optimisation.Payload((0, 5), (0.0, 0.0, (0.1, 0.2)))
    """

    mass: tuple[float, float]
    position: tuple[ArrayLike, ArrayLike, ArrayLike] = (0.0, 0.0, 0.0)

    def parameters(self, hexapod: Hexapod) -> list[UncertainParameter]:
        """Make the independent parameters for a design.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        list of UncertainParameter
            The mass and the three coordinates.

        Raises
        ------
        ArgumentError
            If the mass is negative, or a range does not ascend.
        """
        if not (several(self.mass) and several(self.position)) or len(self.mass) != 2 or len(self.position) != 3:
            raise ArgumentError("a payload has a mass (least, largest) in kg and a position of three coordinates in m.")
        low, high = (not_negative(mass, "the payload's mass", "kg") for mass in self.mass)
        if not low <= high:
            raise ArgumentError(f"the payload's mass is from {low} to {high} kg; it must be >= 0, the least first.")
        found = [_of_payload("mass", np.array([low, high], dtype=np.float64), "kg")]
        for axis, given in zip(TRANSLATIONS, self.position, strict=True):
            name = f"the payload's {axis}"
            pair = numbers(given, name, (2,)) if several(given) else np.full(2, number(given, name, "m"))
            if not pair[0] <= pair[1]:
                raise ArgumentError(f"the payload's {axis} is {given!r} m; it must be a number, or (least, most).")
            found.append(_of_payload(axis, np.array(pair), "m"))
        return found

    def strays(self, hexapod: Hexapod) -> list[Stray]:
        """Make the ranges of its coordinates, which have no worst end, so that a certificate is for all of them.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        list of Stray
            One for each coordinate that has a range.

        Raises
        ------
        ArgumentError
            If the mass is negative, or a range does not ascend.
        """
        ranges = [one.width for one in self.parameters(hexapod)[1:]]
        return [
            Stray(f"the payload's {axis}", (number,), (_half(pair),))
            for axis, number, pair in zip(TRANSLATIONS, AT_PAYLOAD, ranges, strict=True)
            if pair[0] < pair[1]
        ]

    def load(self, hexapod: Hexapod) -> tuple[float, ...]:
        """Make the load that a certificate over its place is about.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        tuple of float
            The largest mass, kg, under which the index is least at every pose and place, and the middle of its
            place, m.

        Raises
        ------
        ArgumentError
            If the mass is negative, or a range does not ascend.
        """
        mass, *place = (one.width for one in self.parameters(hexapod))
        return (float(mass[1]), *(_middle(pair) for pair in place))

    @property
    def words(self) -> str:
        """What is assumed, for readers: "a payload of 0 to 5 kg at (0, 0, 0.1 to 0.2) m"."""
        ends = [np.unique(np.asarray(axis, dtype=float)) for axis in self.position]
        place = ", ".join(" to ".join(f"{end:.6g}" for end in pair) for pair in ends)
        return f"a payload of {self.mass[0]:.6g} to {self.mass[1]:.6g} kg at ({place}) m"

    def at_worst(self, hexapod: Hexapod) -> Hexapod:
        """Make the design with the largest payload, under which the index is least at every pose.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        Hexapod
            The design whose platform carries the payload.

        Raises
        ------
        ArgumentError
            If its place is uncertain: the index neither rises nor falls with that at every pose. A certificate is for
            all of such a range, see `strays`.
        """
        mass, *place = self.parameters(hexapod)
        if moving := [one.words for one in place if not one.fixed]:
            raise ArgumentError(
                f"{moving[0]} is uncertain, and the index neither rises nor falls with it at every pose. Give one "
                "place, and certify several."
            )
        at = np.array([one.width[0] for one in place])
        return with_payload(hexapod, float(mass.width[1]), at, np.zeros((3, 3)))


def _middle(pair: Array) -> float:
    return float(pair[0] + (pair[1] - pair[0]) / 2)


def _half(pair: Array) -> float:
    """How far the ends are from the middle, rounded up."""
    middle = _middle(pair)
    return float(np.nextafter(max(pair[1] - middle, middle - pair[0]), np.inf))


def _of_payload(name: str, pair: Array, unit_name: str) -> UncertainParameter:
    name = f"payload.{name}"
    return UncertainParameter(name, "uniform", None, pair, 0.0, name, unit_name=unit_name)
