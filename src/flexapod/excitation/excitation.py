"""What drives the machine in time: base motions, wrenches and leg commands, with exact derivatives.

An `Excitation` is a sum of terms on named channels. The same kit serves three uses: a base motion has the channels
x, y, z (m) and roll, pitch, yaw (rad), in inertial axes and measured from the base's pose at rest; a force (N) or
moment (N m) has x, y, z in the platform's axes; a leg command (m, change of unstretched length) has legs "1" to "6".
The functions of time are evaluated in the compiled core, with their first and second derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod._core import TermKind
from flexapod.checks import instance, not_negative, number, numbers, one_of, positive
from flexapod.conventions import AXES, LEGS, ROTATIONS, TRANSLATIONS, Array
from flexapod.errors import ArgumentError, PoseError, shown
from flexapod.pose import Motion, PoseLike, as_pose
from flexapod.showing import in_notebooks

#: One of the pieces of a term of `TermKind.pieces`, behind a number that says whether they meet with corners.
PIECE = np.dtype(_core.PIECE)

Use = Literal["", "motion", "force", "moment"]
#: What `simulate` takes: the channels of each argument, and what its terms may be.
USES: dict[str, tuple[tuple[str, ...], Use]] = {
    "base_motion": (AXES, "motion"),
    "force": (TRANSLATIONS, "force"),
    "moment": (TRANSLATIONS, "moment"),
    "leg_command": (LEGS, "motion"),
}


@dataclass(frozen=True, eq=False)
class Term:
    """One function of time on one channel; it begins at `start`, may rise smoothly, and may end after `stop`.

    use: what it can drive, where its units or its spectrum say so. origin: where a recording is from, in words; remark:
    what there is to say of it, in words that follow "the recording of force x".
    """

    channel: str
    kind: TermKind
    numbers: Array
    use: Use = ""
    start: float = 0.0
    rise: float = 0.0
    stop: float = np.inf
    fall: float = 0.0
    sampled: float = 0.0  # s between samples of a recording, 0 for a formula
    last: float = np.inf  # s, end of a recording
    origin: str = ""
    remark: str = ""

    def packed(self) -> Array:
        """As the core takes it: seven numbers, then those of the function."""
        index = (AXES if self.channel in AXES else LEGS).index(self.channel)
        header = [index, self.kind.value, self.start, self.rise, self.stop, self.fall, self.numbers.size]
        return np.concatenate([header, self.numbers])

    def scaled(self, factor: float) -> Term:
        """The same function of time times a number."""
        scaled = self.numbers.copy()
        if self.kind == TermKind.sinusoids:
            scaled[::3] *= factor
        elif self.kind == TermKind.chirp:
            scaled[0] *= factor
        else:
            pieces = scaled[1:].view(PIECE)
            pieces["coefficients"] *= factor
            pieces["sine"] *= factor
        return replace(self, numbers=scaled)


@in_notebooks
@dataclass(frozen=True, eq=False)
class Excitation:
    """A function of time on one or more axes: a base motion, a load, or a leg command.

    Made by `harmonic`, `sine_sweep`, `read_time_series` and the like. Excitations add, and a number times one scales
    it. A base motion has the axes x, y, z (m) and roll, pitch, yaw (rad), measured from the pose of the base at rest; a
    force (N) or moment (N m) has x, y, z in the platform's axes; a leg command (m, change of unstretched length) has
    the legs "1" to "6".

    Parameters
    ----------
    terms : tuple of Term
        The functions of time.
    rotation : {"rpy", "vector"}
        How roll, pitch and yaw of a base motion turn the base: about the fixed axes x, y, z in this order, or as the
        components of a rotation vector. Excitations that turn it in different ways cannot be added (ArgumentError).

    Raises
    ------
    ArgumentError
        For another word for the rotation, or what is no tuple of terms.

    See Also
    --------
    simulate : The machine driven by excitations.

    Examples
    --------
    >>> base = (fx.harmonic("z", 1e-3, 20.0) + 0.5 * fx.harmonic("roll", 0.02, 10.0)).ramped(0.5)
    >>> base.channels
    ('z', 'roll')
    >>> value, rate, acceleration = base.evaluate([1.0, 2.0])
    >>> value.shape, round(float(value[0, 2]), 6)
    ((2, 6), 0.000913)
    """

    terms: tuple[Term, ...] = ()
    rotation: Literal["rpy", "vector"] = "rpy"

    def __post_init__(self) -> None:
        one_of(self.rotation, "rotation", ("rpy", "vector"))
        if not isinstance(self.terms, tuple) or not all(isinstance(term, Term) for term in self.terms):
            raise ArgumentError(
                f"terms is {shown(self.terms)}; it must be a tuple of terms. Make an excitation with harmonic, "
                "sine_sweep, read_time_series and the like, and add them."
            )

    def __add__(self, other: Excitation) -> Excitation:
        if not isinstance(other, Excitation):
            return NotImplemented
        if self.rotation != other.rotation and self._turns() and other._turns():
            raise ArgumentError(
                "one excitation turns by roll, pitch, yaw and the other by a rotation vector; they have no sum. "
                "Give both in the same way."
            )
        return Excitation(self.terms + other.terms, self.rotation if self._turns() else other.rotation)

    def __mul__(self, factor: float) -> Excitation:
        factor = number(factor, "the factor of an excitation")
        return replace(self, terms=tuple(term.scaled(factor) for term in self.terms))

    __rmul__ = __mul__

    def _turns(self) -> bool:
        return any(term.channel in ROTATIONS for term in self.terms)

    def ramped(self, duration: float) -> Excitation:
        """Return the excitation with every term rising smoothly from its start, with three continuous derivatives.

        Parameters
        ----------
        duration : float
            Time in which a term rises, s, > 0.
        """
        rise = positive(duration, "ramp duration", "s")
        return replace(self, terms=tuple(replace(term, rise=rise) for term in self.terms))

    def stopped(self, time: float, fall: float) -> Excitation:
        """Return the excitation with every term falling smoothly to zero.

        Parameters
        ----------
        time : float
            When the terms begin to fall, s; after every term has risen.
        fall : float
            Time in which they fall, s, > 0.
        """
        stop, fall = positive(time, "stop time", "s"), positive(fall, "fall", "s")
        if any(term.start + term.rise > stop for term in self.terms):
            raise ArgumentError(f"stop time is {stop:.6g} s, before a term has risen; stop later or shorten the ramp.")
        return replace(self, terms=tuple(replace(term, stop=stop, fall=fall) for term in self.terms))

    def delayed(self, delay: float) -> Excitation:
        """Return the excitation with every term later, and zero before its start.

        Parameters
        ----------
        delay : float
            Delay, s, >= 0.
        """
        delay = not_negative(delay, "delay", "s")
        moved = (
            replace(term, start=term.start + delay, stop=term.stop + delay, last=term.last + delay)
            for term in self.terms
        )
        return replace(self, terms=tuple(moved))

    def as_rotation_vector(self) -> Excitation:
        """Return the excitation with roll, pitch, yaw read as the three components of a rotation vector."""
        return replace(self, rotation="vector")

    def on(self, axes: Mapping[str, str]) -> Excitation:
        """Return the same functions of time on other axes.

        Parameters
        ----------
        axes : dict
            Old axis to new axis.
        """
        instance(axes, Mapping, "axes", "from old axis to new axis")
        missing = [channel for channel in self.channels if not _is_axis(axes.get(channel))]
        if missing:
            raise ArgumentError(
                f"axes takes {missing[0]!r} to {shown(axes.get(missing[0]))}; give each axis a new one."
            )
        return replace(self, terms=tuple(replace(term, channel=axes[term.channel]) for term in self.terms))

    def for_use(self, use: Use) -> Excitation:
        """Return the excitation as one that drives nothing but a motion, a force or a moment.

        Parameters
        ----------
        use : {"motion", "force", "moment", ""}
            What it may drive; "" for all.
        """
        one_of(use, "use", get_args(Use))
        return replace(self, terms=tuple(replace(term, use=use) for term in self.terms))

    @property
    def channels(self) -> tuple[str, ...]:
        """The axes driven, each once."""
        return tuple(dict.fromkeys(term.channel for term in self.terms))

    @property
    def packed(self) -> Array:
        """The terms as the core takes them, one after another, (n,)."""
        if not self.terms:
            return np.zeros(0)
        return np.concatenate([term.packed() for term in self.terms])

    def evaluate(self, times: ArrayLike) -> tuple[Array, Array, Array]:
        """Return values and their first and second time derivatives.

        Parameters
        ----------
        times : array_like, shape (...)
            Times, s.

        Returns
        -------
        value, rate, acceleration : ndarray, shape (..., 6)
            In the axes x, y, z, roll, pitch, yaw, or the legs; zero for those that are not driven.
        """
        t = numbers(times, "times", None)
        found = _core.excitation(self.packed, np.ascontiguousarray(t.ravel()))
        value, rate, acceleration = np.moveaxis(found, 1, 0).reshape(3, *t.shape, 6)
        return value, rate, acceleration

    def motion(self, times: ArrayLike, base: PoseLike | None = None) -> Motion:
        """Return how a base that is driven by this moves in the inertial frame.

        Parameters
        ----------
        times : array_like, shape (...)
            Times, s.
        base : Pose or array_like, optional
            Pose of the base at rest. Default: the origin.

        Returns
        -------
        Motion
            With the batch axes of `times`.
        """
        check_use(self, "base_motion")
        t = numbers(times, "times", None)
        rest = Motion.fixed(None if base is None else as_pose(base, "base"))
        if rest.shape:
            raise PoseError(f"base has batch axes {rest.shape}; this takes one pose. Index it first.")
        rows = _core.base_motion(self.packed, self.rotation == "rpy", rest.packed, np.ascontiguousarray(t.ravel()))
        return Motion.unpacked(rows.reshape(*t.shape, _core.motion_size))

    def __repr__(self) -> str:
        return f"<Excitation of {', '.join(self.channels) or 'nothing'}, {len(self.terms)} terms>"


def check_use(excitation: Excitation, argument: str) -> None:
    """Raises ArgumentError for a channel that an argument of `simulate` does not have, or a quantity that it is not."""
    channels, use = USES[argument]
    for term in excitation.terms:
        if term.channel not in channels:
            raise ArgumentError(f"{argument} drives {term.channel!r}; its channels are {', '.join(channels)}.")
        if term.use not in ("", use):
            where = f" ({term.origin})" if term.origin else ""
            raise ArgumentError(
                f"{argument} drives {term.channel!r} by what is a {term.use}{where}; it takes a {use}. Give it as the "
                f"{term.use} of the {'base or a leg' if term.use == 'motion' else 'platform'}, or correct its unit."
            )


def _is_axis(name: Any) -> bool:
    return isinstance(name, str) and name in AXES + LEGS


def one_term(axis: str, kind: TermKind, numbers: Array, **given: Any) -> Excitation:
    """An excitation of one function of time; given: fields of `Term`. Raises ArgumentError for an unknown axis."""
    if not _is_axis(axis):
        raise ArgumentError(f"axis is {shown(axis)}; it must be one of {', '.join(AXES)}, or a leg '1' to '6'.")
    return Excitation((Term(axis, kind, numbers, **given),))
