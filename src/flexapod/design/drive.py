"""What drives the legs: a motor, a gear and a screw in each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from flexapod.conventions import TWO_PI, Array
from flexapod.design.key import Key
from flexapod.design.schema import KEYS
from flexapod.design.value import Value
from flexapod.errors import DesignError, shown, told_apart

TABLE = "drive"
_MOTOR = f"{TABLE}.motor"


def _zero() -> Array:
    return np.zeros(6)


def _one() -> Array:
    return np.ones(6)


@dataclass(frozen=True, eq=False, repr=False)
class Motor(Value):
    """The torque-speed curve of a motor, the same for all six legs.

    Parameters
    ----------
    speeds : array_like
        Speeds at which the torques are given, rising from 0, rad/s, (n,), n at least 2.
    peak_torques : array_like
        Torque that the motor gives for a short time at each of the speeds, N m, (n,).
    continuous_torques : array_like
        Torque that it bears for ever at each of the speeds, N m, (n,).
    max_speed : array_like, optional
        Greatest speed allowed, such as that of the screw seen at the motor's shaft, rad/s, one or six, stored as (6,);
        the last of the speeds where left out.

    Raises
    ------
    DesignError
        For speeds that do not rise from 0, another number of torques than of speeds, a continuous torque above the
        peak one, or a greatest speed beyond the last of the speeds.

    Notes
    -----
    Torques are interpolated linearly between the speeds. They are taken to be the same in both directions of rotation,
    and where the motor brakes.

    Examples
    --------
    >>> motor = fx.design.Motor([0, 300, 400], [9.0, 9.0, 6.0], [3.0, 2.5, 2.0])
    >>> motor.peak([350.0, 500.0]).tolist()
    [7.5, 0.0]
    """

    speeds: Array
    peak_torques: Array
    continuous_torques: Array
    max_speed: Array | None = None

    def __post_init__(self) -> None:
        for name in ("speeds", "peak_torques", "continuous_torques"):
            self.set_checked(name, getattr(self, name), f"{_MOTOR}.{name}")
        _check_curve(self)
        if self.max_speed is not None:
            self.set_checked("max_speed", self.max_speed, f"{_MOTOR}.max_speed", (6,))
            if self.max_speed.max() > self.speeds[-1]:
                told, last = told_apart(float(self.max_speed.max()), float(self.speeds[-1]), (6, 6))
                raise DesignError(
                    f"{_MOTOR}.max_speed is {told} rad/s, beyond {last} rad/s, the last of {_MOTOR}.speeds; no torque "
                    "is known there. Give the curve up to it, or a lower speed."
                )

    @property
    def fastest(self) -> Array:
        """Greatest speed of the motor of each leg, rad/s, (6,)."""
        return np.full(6, self.speeds[-1]) if self.max_speed is None else self.max_speed

    def peak(self, speed: Any) -> Any:
        """Torque for a short time at speeds of any shape and sign, rad/s, N m; 0 beyond the curve."""
        return np.interp(np.abs(speed), self.speeds, self.peak_torques, right=0.0)

    def continuous(self, speed: Any) -> Any:
        """Torque for ever at speeds of any shape and sign, rad/s, N m; 0 beyond the curve."""
        return np.interp(np.abs(speed), self.speeds, self.continuous_torques, right=0.0)


@dataclass(frozen=True, eq=False, repr=False)
class Drive(Value):
    """Screw, gear and motor of the legs. Each number is one for all legs or six, stored as (6,).

    Parameters
    ----------
    lead : array_like
        Travel of the leg for one turn of the screw, m.
    efficiency : array_like
        Share of the screw's work that reaches the leg where the motor drives it, > 0 and at most 1.
    back_efficiency : array_like, optional
        Share of the leg's work that reaches the screw's shaft where the leg's force drives it, at most 1. At <= 0 the
        screw locks itself: it holds without torque, and must be driven both ways. Left out: 2 - 1 / efficiency.
    gear_ratio : array_like
        Turns of the motor for one turn of the screw.
    gear_efficiency : array_like
        Share of the work that passes the gear, in both directions.
    rotor_inertia, gear_inertia, screw_inertia : array_like
        Moments of inertia about their own axes, kg m2: of the rotor, of the gear at the motor's shaft, and of what
        turns at the screw's speed.
    motor : Motor, optional
        The motor's torque-speed curve; without it there is nothing to compare torques with.

    Raises
    ------
    DesignError
        For numbers of another shape, or out of range.

    See Also
    --------
    flexapod.paths.motor_loads : speeds and torques of the motors along a path.

    Notes
    -----
    Friction in proportion to the axial force costs F lead / (2 pi) (1 / efficiency - 1) of torque when the screw drives
    the load; with the same friction the load drives the screw with F lead / (2 pi) (2 - 1 / efficiency). What turns is
    no part of the machine's dynamics: modes are those of held motors, and leg forces those that the screws must give.

    Examples
    --------
    >>> drive = fx.design.Drive(lead=0.01, efficiency=0.9, rotor_inertia=2e-4)
    >>> drive.backwards.round(4).tolist()[:1], drive.reflected_mass.round(1).tolist()[:1]
    ([0.8889], [79.0])
    """

    lead: Array
    efficiency: Array
    back_efficiency: Array | None = None
    gear_ratio: Array = field(default_factory=_one)
    gear_efficiency: Array = field(default_factory=_one)
    rotor_inertia: Array = field(default_factory=_zero)
    gear_inertia: Array = field(default_factory=_zero)
    screw_inertia: Array = field(default_factory=_zero)
    motor: Motor | None = None

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if item.name != "motor" and not (item.name == "back_efficiency" and value is None):
                self.set_checked(item.name, value, f"{TABLE}.{item.name}", (6,))
        if self.motor is not None and not isinstance(self.motor, Motor):
            raise DesignError(f"{_MOTOR} is {shown(self.motor)}; it must be a Motor.")

    @property
    def backwards(self) -> Array:
        """Efficiency of each screw where the leg's force drives it, (6,); <= 0: it locks itself."""
        return 2.0 - 1.0 / self.efficiency if self.back_efficiency is None else self.back_efficiency

    @property
    def turning(self) -> Array:
        """Angle of each motor for a travel of its leg, rad/m, (6,)."""
        return TWO_PI * self.gear_ratio / self.lead

    @property
    def inertia(self) -> Array:
        """Moment of inertia of all that turns with each motor, at its shaft, kg m2, (6,)."""
        return self.rotor_inertia + self.gear_inertia + self.screw_inertia / self.gear_ratio**2

    @property
    def reflected_mass(self) -> Array:
        """The mass along each leg that the rotating parts stand for, kg, (6,)."""
        return self.inertia * self.turning**2


def drive_of(values: Mapping[str, Any]) -> Drive | None:
    """The drive of a design by its values, where they have one. Raises DesignError for one that is not complete."""
    given = {key.removeprefix(f"{TABLE}."): value for key, value in values.items() if key.startswith(f"{TABLE}.")}
    if not given:
        return None
    motor = {key.removeprefix("motor."): given.pop(key) for key in [*given] if key.startswith("motor.")}
    _check_whole(_MOTOR, motor, ("speeds", "peak_torques", "continuous_torques") if motor else ())
    _check_whole(TABLE, given, ("lead", "efficiency"))
    return Drive(**given, motor=Motor(**motor) if motor else None)


def values_of_drive(drive: Drive | None) -> dict[str, Any]:
    """A drive by dotted file key, without what it leaves out."""
    if drive is None:
        return {}
    found: dict[str, Any] = {}
    for table, part in ((TABLE, drive), (_MOTOR, drive.motor)):
        if part is not None:
            found |= {f"{table}.{item.name}": getattr(part, item.name) for item in fields(part)}
    return {key: value for key, value in found.items() if value is not None and key != _MOTOR}


def _check_whole(table: str, given: Mapping[str, Any], needed: tuple[str, ...]) -> None:
    missing = [name for name in needed if name not in given]
    if missing:
        lines = "; ".join(f"{table}.{name} ({_rule(table, name).meaning})" for name in missing)
        raise DesignError(f"missing: {lines}. Add {'it' if len(missing) == 1 else 'them'}, or leave [{table}] out.")


def _rule(table: str, name: str) -> Key:
    return KEYS[f"{table}.{name}"]


def _check_curve(motor: Motor) -> None:
    """Raises DesignError for a torque-speed curve that no motor has."""
    speeds, n = motor.speeds, len(motor.speeds)
    if n < 2:
        raise DesignError(f"{_MOTOR}.speeds has one speed; it must have two or more, from 0 to the greatest.")
    if speeds[0] != 0:
        raise DesignError(
            f"{_MOTOR}.speeds[0] is {speeds[0]:.6g} rad/s; a curve begins at 0. Add the torques at a standstill."
        )
    falling = np.flatnonzero(np.diff(speeds) <= 0)
    if falling.size:
        i = int(falling[0])
        one, other = told_apart(float(speeds[i]), float(speeds[i + 1]), (6, 6))
        raise DesignError(f"{_MOTOR}.speeds[{i + 1}] is {other} rad/s, after {one} rad/s; speeds must rise. Sort them.")
    for name in ("peak_torques", "continuous_torques"):
        if len(getattr(motor, name)) != n:
            raise DesignError(
                f"{_MOTOR}.{name} has {len(getattr(motor, name))} numbers and {_MOTOR}.speeds {n}; give one torque for "
                "each speed."
            )
    above = np.flatnonzero(motor.continuous_torques > motor.peak_torques)
    if above.size:
        i = int(above[0])
        one, other = told_apart(float(motor.continuous_torques[i]), float(motor.peak_torques[i]), (6, 6))
        raise DesignError(
            f"{_MOTOR}.continuous_torques[{i}] is {one} N m, above {other} N m of {_MOTOR}.peak_torques; what a motor "
            "bears for ever it bears for a short time. Exchange the two, or correct a unit."
        )
