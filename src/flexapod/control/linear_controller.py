"""Controllers as linear systems, and what makes one for a hexapod at a pose."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.checks import numbers, one_of, positive, whole
from flexapod.conventions import Array
from flexapod.errors import ArgumentError, shown
from flexapod.mechanics.linearisation import Linearisation
from flexapod.optional import needed
from flexapod.showing import in_notebooks

Measurement = Literal["leg_length", "leg_rate", "leg_force", "position", "velocity", "acceleration"]
_MOST_STATES = 700  # of a sampled controller: the loop has an eigenvalue for each
MEASUREMENTS = tuple(cast(Measurement, measure.name) for measure in _core.Measure)


def signals(*measurements: str) -> NDArray[np.int64]:
    """Where the signals of some kinds of measurement are among those of all kinds."""
    first = [6 * MEASUREMENTS.index(cast(Measurement, name)) for name in measurements]
    return np.add.outer(first, np.arange(6)).ravel()


@in_notebooks
@dataclass(frozen=True, eq=False)
class Controller:
    """A linear controller from measurements to six leg forces.

    In continuous time x_c' = A x_c + B y and f = C x_c + D y. With a sampling time dt,
    x_c[k+1] = A x_c[k] + B y[k] and f[k] = C x_c[k] + D y[k], and f is held from one sample to the next.

    Parameters
    ----------
    A : ndarray, shape (n, n)
        State matrix.
    B : ndarray, shape (n, m)
        Input matrix.
    C : ndarray, shape (6, n)
        Output matrix.
    D : ndarray, shape (6, m)
        Feedthrough matrix.
    measures : tuple of str
        Kinds of measurement in y, six numbers each, in this order: "leg_length" (m), "leg_rate" (m/s), "leg_force" (N),
        "position" (m, rad), "velocity" (m/s, rad/s) and "acceleration" (m/s2, rad/s2). All are changes from rest.
    name : str
        Name in messages and reports.
    dt : float or None
        Sampling time, s; None for a continuous controller.

    Raises
    ------
    ArgumentError
        For a measurement that there is not, matrices of other shapes, numbers that are not finite, or a sampling time
        that is not > 0.

    Examples
    --------
    A spring of 100 N/m beside each leg:

    >>> empty = np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0))
    >>> spring = fx.control.Controller(*empty, -100.0 * np.eye(6), ("leg_length",), "springs")
    >>> spring.sampled(1e-3).dt
    0.001
    """

    A: Array
    B: Array
    C: Array
    D: Array
    measures: tuple[Measurement, ...]
    name: str
    dt: float | None = None

    def __post_init__(self) -> None:
        for name in self.measures:
            one_of(name, "a measurement of the controller", MEASUREMENTS)
        n, m = np.shape(self.A)[0] if np.ndim(self.A) else 0, 6 * len(self.measures)
        for key, shape in (("A", (n, n)), ("B", (n, m)), ("C", (6, n)), ("D", (6, m))):
            object.__setattr__(self, key, numbers(getattr(self, key), f"{key} of the controller", shape))
        if self.dt is not None:
            positive(self.dt, "dt of the controller", "s")

    def on(self, linear: Linearisation) -> Controller:
        """Return the controller itself, which is already made for its hexapod."""
        return self

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.A)

    def sampled(self, dt: float, method: str = "tustin", delay: int = 0) -> Controller:
        """Discretise the controller.

        Parameters
        ----------
        dt : float
            Sampling time, s.
        method : str
            "tustin" for the bilinear rule, or another method of ``control.sample_system``, such as "zoh".
        delay : int
            Whole samples by which the computed force comes late.

        Returns
        -------
        Controller
            The sampled controller.

        Raises
        ------
        ArgumentError
            If the sampling time is not positive, the delay is not a whole number, or the controller is sampled already.
        MissingExtraError
            If python-control is not installed, for a method other than "tustin".
        """
        if self.dt is not None:
            raise ArgumentError(f"this controller is sampled already, every {self.dt:.6g} s; sample the continuous one")
        found = replace(self, dt=positive(dt, "dt", "s"))
        if self.order:
            found = found._bilinear(dt) if method == "tustin" else found._by_control(dt, method)
        late, order = whole(delay, "delay, in samples,", 0), found.order
        if order + 6 * late > _MOST_STATES:
            raise ArgumentError(
                f"delay is {shown(delay)} samples; each adds six states, and a controller of order {order} may have "
                f"{_MOST_STATES} in all. Give at most {(_MOST_STATES - order) // 6}, or sample more slowly."
            )
        for _ in range(late):
            found = found._late()
        return found

    def _bilinear(self, dt: float) -> Controller:
        """The matrices of Tustin's rule, without python-control, which takes a second to load."""
        half = 0.5 * dt * self.A
        try:
            states = np.linalg.solve(np.eye(self.order) - half, np.hstack([np.eye(self.order) + half, dt * self.B]))
        except np.linalg.LinAlgError:
            raise ArgumentError(
                f"dt is {dt:.6g} s and {self.name} has a pole at 2/dt, which Tustin's rule sends to infinity; give "
                "another dt"
            ) from None
        A, B = np.hsplit(states, [self.order])
        return replace(self, A=A, B=B, C=self.C @ (np.eye(self.order) + A) / 2, D=self.D + self.C @ B / 2)

    def _by_control(self, dt: float, method: str) -> Controller:
        control = needed("control", "control", f'sampling a controller by "{method}" needs python-control')
        system = control.sample_system(control.ss(self.A, self.B, self.C, self.D), dt, method=method)
        return replace(self, A=system.A, B=system.B, C=system.C, D=system.D)

    def _late(self) -> Controller:
        """The same with its force one sample later."""
        n = self.order
        A = np.block([[self.A, np.zeros((n, 6))], [self.C, np.zeros((6, 6))]])
        C = np.hstack([np.zeros((6, n)), np.eye(6)])
        return replace(self, A=A, B=np.vstack([self.B, self.D]), C=C, D=np.zeros_like(self.D))


class ControlLaw(Protocol):
    """Anything that makes a controller for a hexapod at a pose: the extension point of this package.

    `PID`, `ForceFeedback`, `VelocityFeedback` and `Controller` are control laws. To add one, write a class with the
    method ``on``; `closed_loop`, `controlled_transmissibility` and `gain_schedule` then take it.

    Examples
    --------
    Every leg is damped by a share of its critical damping:

    >>> class CriticalDamping:
    ...     def __init__(self, share):
    ...         self.share = share
    ...
    ...     def on(self, linear):
    ...         gain = 2 * self.share * linear.leg_stiffness.mean() / linear.modes().omega.mean()
    ...         return fx.control.VelocityFeedback(gain).on(linear)
    >>> hexapod = fx.load("cubic-isolator")
    >>> fx.control.closed_loop(hexapod, None, CriticalDamping(0.3), nearness=0).stable
    True
    """

    def on(self, linear: Linearisation) -> Controller:
        """Return the controller for the hexapod linearised at a pose."""


def controller_for(linear: Linearisation, law: ControlLaw) -> Controller:
    """The controller that a law makes; raises ArgumentError for what is not a law."""
    if not hasattr(law, "on"):
        raise ArgumentError(
            f"controller is {shown(law)}; it must be a PID, ForceFeedback, VelocityFeedback or Controller, or an "
            "object with a method on(linearisation)."
        )
    return law.on(linear)


def static(D: Array, measures: tuple[Measurement, ...], name: str) -> Controller:
    """A controller without states: f = D y."""
    return Controller(np.zeros((0, 0)), np.zeros((0, D.shape[1])), np.zeros((6, 0)), D, measures, name)
