"""What a design search gives: the design, its verification, and every constraint with its margin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from flexapod.certificates.certificate import Certificate
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import told_apart
from flexapod.showing import drawn, in_notebooks

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


@in_notebooks
@dataclass(frozen=True)
class Check:
    """One constraint of a design as verified.

    Attributes
    ----------
    name, unit : str
        Name and unit of what is bounded.
    side : {"least", "most"}
        Whether the bound is a lower or an upper one.
    value, bound : float
        The extreme value and the bound.
    margin : float
        Relative margin, >= 0 where the bound is kept.
    kept : bool
        Whether the bound is kept, but for rounding.
    """

    name: str
    unit: str
    side: str
    value: float
    bound: float
    margin: float
    kept: bool

    @property
    def words(self) -> str:
        """Value and bound as a sentence's part: "longest leg is 0.5 m, must be at most 0.45 m"."""
        value, bound = (f"{told} {self.unit}".rstrip() for told in told_apart(self.value, self.bound, (6, 6)))
        return f"{self.name} is {value}, must be at {self.side} {bound}"


@in_notebooks
class VariableRange(NamedTuple):
    """Where a variable began and between what it was searched, in its own unit.

    Attributes
    ----------
    unit : str
        Its unit; "" for a pure number.
    before : float
        Where the design to start from has it.
    low, high : float
        Its bounds.
    """

    unit: str
    before: float
    low: float
    high: float

    @property
    def outside(self) -> bool:
        """Whether the design to start from has it outside the bounds."""
        room = 1e-9 * max(abs(self.low), abs(self.high))
        return not self.low - room <= self.before <= self.high + room


@in_notebooks
@dataclass(frozen=True)
class Verification:
    """A sweep of every region at poses that the search has not seen, and descents from the worst of them.

    Attributes
    ----------
    points : int
        Number of poses of the sweep.
    index : float
        The smallest index found, rad/s.
    pose : ndarray, shape (6,), or None
        Where: x, y, z in m, roll, pitch, yaw in rad. None for a mean.
    checks : tuple of Check
        Every constraint there.
    certificate : Certificate or None
        What is proved of the index over the region, where that was asked for.
    """

    points: int
    index: float
    pose: Array | None
    checks: tuple[Check, ...]
    certificate: Certificate | None = None

    @property
    def holds(self) -> bool:
        """Whether every constraint is kept."""
        return all(check.kept for check in self.checks)


@in_notebooks
@dataclass(frozen=True, eq=False)
class OptimalDesign:
    """The design that `flexapod.optimise` found: the design to start from itself where none is better.

    Attributes
    ----------
    hexapod : Hexapod
        The design.
    variables : dict of str to float
        Its variables by name, in the units of their keys.
    ranges : dict of str to VariableRange
        Where the variables began and their bounds, by name.
    at_bounds : tuple of str
        Names of the variables that are on a bound.
    index : float
        Its objective as verified: rad/s, or 1/cond(H) for `Dexterity`.
    start : Hexapod
        The design to start from.
    start_index : float
        Its objective, verified alike.
    searched_index : float
        The best objective of the trials, before the local search; NaN without trials.
    coincident : int
        Number of natural frequencies within 0.1 % of the lowest at the worst pose. More than one means that the optimum
        lies where modes meet.
    verification : Verification
        The verification of the design.
    start_checks : tuple of Check
        Every constraint of the design to start from.
    start_breaks : tuple of str
        What the design to start from breaks, in words; empty where it keeps every constraint.
    unmoved : tuple of str
        Names of the constraints, or of the objective, that no variable moves.
    failures : tuple of str
        What went wrong on the way, in words, such as a local search that did not converge.
    stopped : bool
        Whether `stop` ended the search early.
    history : xarray.Dataset
        The finished trials.
    evaluations : int
        Number of designs that the local search evaluated.
    seconds : float
        Duration of the search, s.
    """

    hexapod: Hexapod
    variables: dict[str, float]
    ranges: dict[str, VariableRange]
    at_bounds: tuple[str, ...]
    index: float
    start: Hexapod
    start_index: float
    searched_index: float
    coincident: int
    verification: Verification
    start_checks: tuple[Check, ...]
    start_breaks: tuple[str, ...]
    unmoved: tuple[str, ...]
    failures: tuple[str, ...]
    stopped: bool
    history: xr.Dataset
    evaluations: int
    seconds: float

    @property
    def improved(self) -> bool:
        """Whether the design keeps every constraint, and has a higher index than `start` or `start` breaks one."""
        better = self.index > self.start_index or bool(self.start_breaks)
        return self.hexapod is not self.start and self.verification.holds and better

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the search, trial by trial: `plots.optimisation.search`."""
        return drawn(self, ax=ax)

    @property
    def gain(self) -> float:
        """Relative gain, index / start_index - 1; infinite for a start of index zero, if it is left."""
        if self.index == self.start_index:
            return 0.0
        return self.index / self.start_index - 1 if self.start_index > 0 else float("inf")
