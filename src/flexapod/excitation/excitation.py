"""What drives the machine in time: base motions, wrenches and leg commands, with exact derivatives.

An `Excitation` is a sum of terms on named channels. The same kit serves three uses: a base motion has the channels
x, y, z (m) and roll, pitch, yaw (rad), in inertial axes and measured from the base's pose at rest; a force (N) or
moment (N m) has x, y, z in the platform's axes; a leg command (m, change of unstretched length) has legs "1" to "6".
The functions of time are evaluated in the compiled core, with their first and second derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod._core import TermKind
from flexapod.conventions import AXES, LEGS, Array
from flexapod.errors import ArgumentError
from flexapod.pose import Motion, Pose


@dataclass(frozen=True, eq=False)
class Term:
    """One function of time on one channel; it begins at `start`, may rise smoothly, and may end after `stop`."""

    channel: str
    kind: TermKind
    numbers: Array
    start: float = 0.0
    rise: float = 0.0
    stop: float = np.inf
    fall: float = 0.0
    sampled: float = 0.0  # s between samples of a recording, 0 for a formula
    last: float = np.inf  # s, end of a recording


@dataclass(frozen=True, eq=False)
class Excitation:
    """A sum of terms. Excitations add; a number times one scales it. Made by `harmonic` and its like.

    A base motion has the channels x, y, z (m) and roll, pitch, yaw (rad); a force (N) or moment (N m) has x, y, z; a
    leg command (m) has legs "1" to "6". terms: the functions of time. rotation: how roll, pitch and yaw of a base
    motion turn the base, "rpy" (about the fixed axes x, y, z in this order) or "vector" (a rotation vector);
    excitations that turn it in different ways have no sum (ArgumentError).

    Source: own.
    """

    terms: tuple[Term, ...] = ()
    rotation: Literal["rpy", "vector"] = "rpy"

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
        return replace(self, terms=tuple(_scaled(term, float(factor)) for term in self.terms))

    __rmul__ = __mul__

    def _turns(self) -> bool:
        return any(term.channel in AXES[3:] for term in self.terms)

    def ramped(self, duration: float) -> Excitation:
        """Every term rises smoothly (three derivatives continuous) from nothing over `duration` s from its start.

        Raises: ArgumentError for a time that is not > 0.
        """
        rise = _positive(duration, "ramp duration", "s")
        return replace(self, terms=tuple(replace(term, rise=rise) for term in self.terms))

    def stopped(self, time: float, fall: float) -> Excitation:
        """Every term falls smoothly to nothing over `fall` s from `time`.

        Raises: ArgumentError for times that are not > 0, or that end before a term has risen.
        """
        stop, fall = _positive(time, "stop time", "s"), _positive(fall, "fall", "s")
        if any(term.start + term.rise > stop for term in self.terms):
            raise ArgumentError(f"stop time is {stop:.6g} s, before a term has risen; stop later or shorten the ramp.")
        return replace(self, terms=tuple(replace(term, stop=stop, fall=fall) for term in self.terms))

    def delayed(self, delay: float) -> Excitation:
        """Every term later by `delay` s, and nothing before its start.

        Raises: ArgumentError for a delay below zero.
        """
        if not (np.isfinite(delay) and delay >= 0):
            raise ArgumentError(f"delay is {delay} s; it must be >= 0 and finite.")
        moved = (
            replace(term, start=term.start + delay, stop=term.stop + delay, last=term.last + delay)
            for term in self.terms
        )
        return replace(self, terms=tuple(moved))

    def as_rotation_vector(self) -> Excitation:
        """The same, with roll, pitch, yaw read as the three components of a rotation vector."""
        return replace(self, rotation="vector")

    def on(self, channels: Mapping[str, str]) -> Excitation:
        """The same functions of time on other channels, old to new."""
        return replace(self, terms=tuple(replace(term, channel=channels[term.channel]) for term in self.terms))

    @property
    def channels(self) -> tuple[str, ...]:
        """The channels driven, each once."""
        return tuple(dict.fromkeys(term.channel for term in self.terms))

    @property
    def packed(self) -> Array:
        """The terms as the core takes them, one after another, (n,)."""
        if not self.terms:
            return np.zeros(0)
        return np.concatenate([_packed(term) for term in self.terms])

    def evaluate(self, times: ArrayLike) -> tuple[Array, Array, Array]:
        """Values and their first and second time derivatives at `times` (...,), each (..., 6)."""
        t = np.asarray(times, dtype=float)
        found = _core.excitation(self.packed, np.ascontiguousarray(t.ravel()))
        value, rate, acceleration = np.moveaxis(found, 1, 0).reshape(3, *t.shape, 6)
        return value, rate, acceleration

    def motion(self, times: ArrayLike, base: Pose | None = None) -> Motion:
        """How a base driven by this moves in the inertial frame, at `times` (...), s.

        base: its pose at rest; default: the origin.

        Raises: ArgumentError for channels that no base has.
        """
        check_channels(self, "base_motion", AXES)
        t = np.asarray(times, dtype=float)
        rest = Motion.fixed(base).packed
        rows = _core.base_motion(self.packed, self.rotation == "rpy", rest, np.ascontiguousarray(t.ravel()))
        return Motion.unpacked(rows.reshape(*t.shape, -1))

    def __repr__(self) -> str:
        return f"<Excitation of {', '.join(self.channels) or 'nothing'}, {len(self.terms)} terms>"


def harmonic(channel: str, amplitude: ArrayLike, omega: ArrayLike, phase: ArrayLike = 0.0) -> Excitation:
    """Sum of A sin(omega t + phase) on a channel (x to yaw, or a leg "1" to "6"; see `Excitation`).

    amplitude in the channel's unit, m, rad, N or N m; omega rad/s; phase rad; each one or many.

    Raises: ArgumentError for an unknown channel, numbers that are not finite, or omega below zero.
    Source: own.
    """
    parts = np.broadcast_arrays(*(np.atleast_1d(np.asarray(v, dtype=float)) for v in (amplitude, omega, phase)))
    triples = np.stack([part.ravel() for part in parts], axis=1)
    _finite(triples, "amplitude, omega or phase")
    if np.any(triples[:, 1] < 0):
        raise ArgumentError(f"omega is {triples[:, 1].min():.6g} rad/s; it must be >= 0.")
    return _one(channel, TermKind.sinusoids, triples.ravel())


def sine_sweep(
    channel: str,
    amplitude: float,
    omega_start: float,
    omega_end: float,
    duration: float,
    law: Literal["log", "linear"] = "log",
    hold: Literal["displacement", "velocity", "acceleration"] = "displacement",
) -> Excitation:
    """A sine on a channel whose frequency goes from omega_start to omega_end (rad/s) in `duration` s, and stays there.

    amplitude: of the displacement at omega_start, m or rad. law: how the frequency goes, "log" or "linear". hold: what
    keeps its amplitude while the frequency changes; with "acceleration" the displacement's amplitude goes with
    1/omega^2, as shaker tests do.

    Raises: ArgumentError for an unknown channel, law or hold, and for frequencies or a duration not > 0.
    Source: own; logarithmic sweeps as in IEC 60068-2-6.
    """
    powers = {"displacement": 0.0, "velocity": 1.0, "acceleration": 2.0}
    if law not in ("log", "linear"):
        raise ArgumentError(f"law is {law!r}; it must be 'log' or 'linear'.")
    if hold not in powers:
        raise ArgumentError(f"hold is {hold!r}; it must be one of {', '.join(powers)}.")
    start, end = _positive(omega_start, "omega_start", "rad/s"), _positive(omega_end, "omega_end", "rad/s")
    numbers = [amplitude, start, end, _positive(duration, "duration", "s"), float(law == "log"), powers[hold]]
    _finite(np.array(numbers), "amplitude")
    return _one(channel, TermKind.chirp, np.array(numbers))


def half_sine_shock(channel: str, acceleration: float, duration: float, recovery: float | None = None) -> Excitation:
    """A base's half-sine pulse of acceleration (peak m/s2 or rad/s2, `duration` s), from rest, on a channel x to yaw.

    The pulse leaves the velocity 2 acceleration duration / pi. With `recovery` a second half sine of that duration (s),
    opposite and as strong as needed, brings it to rest again; without, the motion goes on at this speed.

    Raises: ArgumentError for an unknown channel, a peak that is not finite, or durations not > 0.
    Source: own; the pulse of IEC 60068-2-27.
    """
    _finite(np.array([acceleration]), "acceleration")
    T = _positive(duration, "duration", "s")
    speed = 2 * acceleration * T / np.pi
    pieces = [_half_sine(0.0, 0.0, 0.0, acceleration, T)]
    travel = acceleration * T**2 / np.pi
    if recovery is not None:
        T_2 = _positive(recovery, "recovery", "s")
        pieces.append(_half_sine(T, travel, speed, -acceleration * T / T_2, T_2))
        travel += speed * T_2 - acceleration * T * T_2 / np.pi
        T, speed = T + T_2, 0.0
    pieces.append(_piece(T, [travel, speed]))
    return _one(channel, TermKind.pieces, _pieces(pieces, corners=True))


def half_sine_pulse(channel: str, peak: float, duration: float) -> Excitation:
    """A half-sine pulse of a channel's value itself, as of a force.

    peak: in the channel's unit, such as N. duration: s; nothing after.

    Raises: ArgumentError for an unknown channel, a peak that is not finite, or a duration not > 0.
    Source: own.
    """
    _finite(np.array([peak]), "peak")
    T = _positive(duration, "duration", "s")
    pieces = [_piece(0.0, [0.0], peak, np.pi / T), _piece(T, [0.0])]
    return _one(channel, TermKind.pieces, _pieces(pieces, corners=True))


def polynomial(channel: str, coefficients: ArrayLike) -> Excitation:
    """c0 + c1 t + c2 t^2 + ... on a channel, with t in s, up to eight coefficients.

    In the channel's unit, such as m and rad: `("yaw", [0, rate])` spins the base at a rate in rad/s.

    Raises: ArgumentError for an unknown channel, or coefficients that are not one to eight finite numbers.
    Source: own.
    """
    c = np.atleast_1d(np.asarray(coefficients, dtype=float))
    _finite(c, "coefficients")
    if c.ndim != 1 or not 1 <= c.size <= 8:
        raise ArgumentError(f"coefficients have shape {c.shape}; one to eight numbers are needed.")
    return _one(channel, TermKind.pieces, _pieces([_piece(0.0, c)], corners=True))


def smooth_step(channel: str, change: float, duration: float) -> Excitation:
    """A channel goes from 0 to `change` in `duration` s with three continuous derivatives, and then rests there.

    change: in the channel's unit, such as m or rad.

    Raises: ArgumentError for an unknown channel, a change that is not finite, or a duration not > 0.
    Source: own.
    """
    _finite(np.array([change]), "change")
    T = _positive(duration, "duration", "s")
    rise = np.array([0, 0, 0, 0, 35, -84, 70, -20]) * change / T ** np.arange(8)
    return _one(channel, TermKind.pieces, _pieces([_piece(0.0, rise), _piece(T, [change])], corners=True))


def check_channels(excitation: Excitation, use: str, allowed: Sequence[str]) -> None:
    """Raises ArgumentError for a channel that a use does not have."""
    for channel in excitation.channels:
        if channel not in allowed:
            raise ArgumentError(f"{use} drives {channel!r}; its channels are {', '.join(allowed)}.")


def sampled_term(channel: str, knots: Array, coefficients: Array, spacing: float, end: float) -> Excitation:
    """A recording as smoothly joined polynomials: coefficients (n, <= 8) of powers of the time since each knot (n,).

    spacing: s between samples; end: s, the last one.
    """
    pieces = np.zeros((knots.size, 11))
    pieces[:, 0] = knots
    pieces[:, 1 : 1 + coefficients.shape[1]] = coefficients
    numbers = np.concatenate([[0.0], pieces.ravel()])
    return Excitation((Term(_channel(channel), TermKind.pieces, numbers, sampled=spacing, last=end),))


def _one(channel: str, kind: TermKind, numbers: Array) -> Excitation:
    return Excitation((Term(_channel(channel), kind, numbers),))


def _channel(channel: str) -> str:
    if channel in AXES + LEGS:
        return channel
    raise ArgumentError(f"channel is {channel!r}; it must be one of {', '.join(AXES)}, or a leg '1' to '6'.")


def _packed(term: Term) -> Array:
    index = (AXES if term.channel in AXES else LEGS).index(term.channel)
    header = [index, term.kind.value, term.start, term.rise, term.stop, term.fall, term.numbers.size]
    return np.concatenate([header, term.numbers])


def _scaled(term: Term, factor: float) -> Term:
    numbers = term.numbers.copy()
    if term.kind == TermKind.sinusoids:
        numbers[::3] *= factor
    elif term.kind == TermKind.chirp:
        numbers[0] *= factor
    else:
        pieces = numbers[1:].reshape(-1, 11)
        pieces[:, 1:10] *= factor
    return replace(term, numbers=numbers)


def _piece(start: float, coefficients: ArrayLike, sine: float = 0.0, omega: float = 0.0) -> Array:
    row = np.zeros(11)
    c = np.asarray(coefficients, dtype=float)
    row[0], row[1 : 1 + c.size], row[9], row[10] = start, c, sine, omega
    return row


def _half_sine(start: float, travel: float, speed: float, peak: float, duration: float) -> Array:
    """x'' = peak sin(pi t / duration) from the travel and speed given."""
    omega = np.pi / duration
    return _piece(start, [travel, speed + peak / omega], -peak / omega**2, omega)


def _pieces(pieces: list[Array], corners: bool) -> Array:
    return np.concatenate([[float(corners)], *pieces])


def _finite(numbers: Array, name: str) -> None:
    if not np.isfinite(numbers).all():
        raise ArgumentError(f"{name} holds NaN or infinity; all numbers must be finite.")


def _positive(value: float, name: str, unit: str) -> float:
    if not (np.isfinite(value) and value > 0):
        raise ArgumentError(f"{name} is {value} {unit}; it must be > 0 and finite.")
    return float(value)
