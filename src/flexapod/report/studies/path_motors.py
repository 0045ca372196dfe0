"""What the motors of the legs do along a path, as tables, results and cautions of a study."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from flexapod.conventions import TWO_PI
from flexapod.design.drive import Drive
from flexapod.design.hexapod import Hexapod
from flexapod.errors import told_apart
from flexapod.mechanics.cautions import Caution
from flexapod.report.numbers import shown, without_rounding
from flexapod.report.study import Column, Row, Table

SERIES = ("motor_speed", "motor_torque", "motor_power")
_RPM = 60.0 / TWO_PI
_YIELD = 0.05  # of the fastest leg rate: springs that give way faster are told of
#: Ratios of what the motor can to what it must: their titles.
_FACTORS = {"peak_factor": "peak torque", "continuous_factor": "continuous torque", "speed_factor": "speed"}


def rows(hexapod: Hexapod, motors: xr.Dataset) -> list[Row]:
    """The largest of all legs, and the least room beside the motor's curve."""
    torque, speed, thermal = (float(motors[name].max()) for name in ("peak_torque", "peak_speed", "rms_torque"))
    what = f"up to {torque:.4g} N m and {_RPM * speed:.4g} rpm, RMS torque up to {thermal:.4g} N m"
    found = [Row("motors:", what, on="terminal"), Row("taken for granted:", words(hexapod, motors), on="terminal")]
    if "peak_factor" in motors:
        told = "; ".join(f"{title} {_least(motors[name])}" for name, title in _FACTORS.items())
        found.append(Row("motors can, of what they must:", told, on="terminal"))
        for name, title in _FACTORS.items():
            found.append(Row(f"Motors' {title}, can / must", float(motors[name].min()), digits=3, on="page"))
    return found


def _least(factor: xr.DataArray) -> str:
    """The least of a ratio, and of which leg."""
    return f"{shown(float(factor.min()), 3)} (leg {factor.leg.values[np.argmin(factor.values)]})"


def tables(hexapod: Hexapod, motors: xr.Dataset) -> list[Table]:
    """Speed, torque and energy of each motor, and the room beside its curve."""
    assert hexapod.drive is not None
    legs = Column("leg", [str(leg) for leg in motors.leg.values])
    columns = [
        Column("peak speed", _RPM * without_rounding(motors.peak_speed.values), "rpm"),
        Column("RMS speed", _RPM * without_rounding(motors.rms_speed.values), "rpm"),
        Column("peak torque", motors.peak_torque.values, "N m"),
        Column("RMS torque", motors.rms_torque.values, "N m"),
        Column("drives with", motors.driving_energy.values, "J"),
        Column("gets back", without_rounding(motors.returned_energy.values), "J"),
    ]
    found = [Table([legs, *columns], words(hexapod, motors), title="Motors")]
    if "peak_factor" in motors:
        room = [
            Column(title, motors[name].values, digits=3, marked=motors[name].values < 1)
            for name, title in _FACTORS.items()
        ]
        room.insert(1, Column("at", motors.peak_time.values, "s"))
        note = "What the motor can, divided by what it must: at least 1. Continuous torque is that at the RMS speed."
        found.append(Table([legs, *room], note, title="Motors beside their curve: can / must"))
    return found


def case_tables(motors: xr.Dataset) -> list[Table]:
    """The motor that has most to do with each payload; the worst is marked."""
    most: dict[str, tuple[NDArray[np.float64], str]] = {
        "peak speed": (_RPM * motors.peak_speed.max("leg").values, "rpm"),
        "peak torque": (motors.peak_torque.max("leg").values, "N m"),
        "RMS torque": (motors.rms_torque.max("leg").values, "N m"),
    }
    cases = Column("case", [str(name) for name in motors.case.values])
    columns = [Column(title, values, unit, marked=_is(values, np.argmax)) for title, (values, unit) in most.items()]
    found = [Table([cases, *columns], "Of the motor that has most to do.", title="Motors with the payloads")]
    if "peak_factor" in motors:
        least = {title: motors[name].min("leg").values for name, title in _FACTORS.items()}
        room = [Column(title, values, digits=3, marked=_is(values, np.argmin)) for title, values in least.items()]
        found.append(Table([cases, *room], title="Motors with the payloads beside their curve: can / must"))
    return found


def _is(values: NDArray[np.float64], pick: Callable[[NDArray[np.float64]], Any]) -> NDArray[np.bool_]:
    """Which of the values is the one that is picked."""
    return np.arange(values.size) == pick(values)


def words(hexapod: Hexapod, motors: xr.Dataset) -> str:
    """What is taken for granted of screws, gears and motors."""
    drive = hexapod.drive
    assert drive is not None
    hold = motors.attrs["hold_s"]
    cycle = (
        f"Means are over the path and {hold:.4g} s at rest at its end." if hold else "Means are over the path alone."
    )
    lost = f" {_locked(drive)}" if (drive.backwards <= 0).any() else ""
    friction = " Friction along the legs (damping.prismatic) is in the leg forces besides."
    return (
        "The motors turn with the leg lengths of the path. Rotors, gears and screws are accelerated by the motors and "
        f"are no part of the machine's dynamics; they stand for {_masses(drive)} along each leg. Friction in screw and "
        f"gear is in proportion to the load, and helps to hold at rest.{lost}"
        f"{friction if hexapod.legs.damping.prismatic.any() else ''} {cycle} Losses in the motors are not counted."
    )


def _masses(drive: Drive) -> str:
    least, most = drive.reflected_mass.min(), drive.reflected_mass.max()
    return f"{least:.4g} kg" if least == most else f"{least:.4g} to {most:.4g} kg"


def _locked(drive: Drive) -> str:
    which = np.flatnonzero(drive.backwards <= 0) + 1
    legs = "" if len(which) == 6 else f" of leg{'s' if len(which) > 1 else ''} {', '.join(map(str, which))}"
    return f"The screws{legs} lock themselves: they hold without torque, and are driven in both directions."


def data(motors: xr.Dataset) -> dict[str, Any]:
    """Results of each motor by name, with what cases there are before."""
    units = {"rad/s": "rad_s", "N m": "N_m", "J": "J", "kg": "kg", "m/s": "m_s", "s": "s", "1": ""}
    found: dict[str, Any] = {"hold_s": motors.attrs["hold_s"]}
    for name, values in motors.data_vars.items():
        if "time" not in values.dims and "leg" in values.dims:
            unit = units[values.attrs["units"]]
            finite = np.where(np.isfinite(values.values), values.values, np.nan)
            found[f"{name}_{unit}" if unit else str(name)] = finite
    total = motors.total_power
    return found | {"least_total_power_W": total.min("time").values, "greatest_total_power_W": total.max("time").values}


def cautions(hexapod: Hexapod, loads: xr.Dataset, motors: xr.Dataset) -> list[Caution]:
    """What a motor cannot do, and what the model leaves out."""
    found = []
    if "peak_factor" in motors:
        found += [caution for one in (_beyond_speed, _beyond_peak, _beyond_continuous) for caution in one(motors)]
    rate, spring = float(np.abs(loads.leg_rate).max()), float(motors.yield_rate.max())
    if spring > _YIELD * rate:
        text = (
            f"The springs of the legs give way at up to {spring:.3g} m/s under the changing forces, beside leg rates "
            f"of up to {rate:.3g} m/s. The motors' speeds are those of the path's leg lengths, without that."
        )
        found.append(Caution("motor_spring", text, {"spring": spring, "rate": rate}))
    return found


def _beyond_speed(motors: xr.Dataset) -> list[Caution]:
    i = int(np.argmin(motors.speed_factor.values))
    if motors.speed_factor[i] >= 1:
        return []
    speed, limit = _RPM * float(motors.peak_speed[i]), _RPM * float(motors.max_speed[i])
    told, most = told_apart(speed, limit)
    text = (
        f"The motor of leg {motors.leg.values[i]} turns at up to {told} rpm, beyond {most} rpm, its greatest speed"
        f"{_others(motors, 'speed_factor')}."
    )
    return [Caution("motor_speed", text, {"value": speed, "limit": limit})]


def _beyond_peak(motors: xr.Dataset) -> list[Caution]:
    factor = motors.peak_factor.where(motors.speed_factor >= 1, np.inf)  # those that turn too fast are told already
    i = int(np.argmin(factor.values))
    if factor[i] >= 1:
        return []
    at = float(motors.peak_time[i])
    torque = float(np.abs(motors.motor_torque[:, i]).sel(time=at))
    told, most = told_apart(torque, torque * float(factor[i]))
    text = (
        f"The motor of leg {motors.leg.values[i]} needs {told} N m at {at:.4g} s, beyond {most} N m, its peak torque "
        f"at that speed{_others(motors, 'peak_factor')}."
    )
    return [Caution("motor_peak", text, {"value": torque, "limit": torque * float(factor[i])})]


def _beyond_continuous(motors: xr.Dataset) -> list[Caution]:
    i = int(np.argmin(motors.continuous_factor.values))
    if motors.continuous_factor[i] >= 1:
        return []
    torque = float(motors.rms_torque[i])
    told, most = told_apart(torque, torque * float(motors.continuous_factor[i]))
    text = (
        f"The motor of leg {motors.leg.values[i]} has an RMS torque of {told} N m, beyond {most} N m, its continuous "
        f"torque at {_RPM * float(motors.rms_speed[i]):.4g} rpm: it gets too hot{_others(motors, 'continuous_factor')}."
    )
    return [Caution("motor_continuous", text, {"value": torque, "limit": torque * float(motors.continuous_factor[i])})]


def _others(motors: xr.Dataset, name: str) -> str:
    which = [str(leg) for leg in motors.leg.values[motors[name].values < 1]]
    return f"; motors beyond it: those of legs {', '.join(which)}" if len(which) > 1 else ""
