"""What the legs do along a path, as tables of a study, as results, and instant by instant."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from flexapod.conventions import ROTATIONS, TRANSLATIONS
from flexapod.paths.loads import EXTREMES
from flexapod.paths.trajectory import Trajectory
from flexapod.report.numbers import without_rounding
from flexapod.report.studies.path_motors import SERIES
from flexapod.report.studies.path_point import point_columns
from flexapod.report.study import Column, Table
from flexapod.tables import written_table
from flexapod.workspace.quantities import titled

MOMENTS = ("universal_moment", "bending_moment", "torsion_moment")
_SERIES = ("leg_length", "leg_rate", "leg_acceleration", "leg_force", "static_force", "power", *MOMENTS, *SERIES)
#: Title and unit of what has extremes.
_WORDS = {"force": ("force", "N"), "rate": ("rate", "m/s"), "power": ("power", "W")}


def tables(loads: xr.Dataset) -> list[Table]:
    """Travel, and the extremes and root mean squares of force, rate and power of each leg."""
    legs = Column("leg", [str(leg) for leg in loads.leg.values])
    forces = [Column("travel", 1e3 * loads.stroke.values, "mm"), *_extremes(loads, "force")]
    acceleration = without_rounding(np.abs(loads.leg_acceleration.values).max(axis=0))
    forces.append(Column("acceleration", acceleration, "m/s\u00b2"))
    moments = [
        Column(name.removesuffix("_moment") + " moment", np.abs(loads[name].values).max(axis=0), "N m")
        for name in MOMENTS
        if name in loads
    ]
    words = "Forces are positive in compression, power where the actuator drives. RMS: over the time of the path."
    return [
        Table([legs, *forces, *moments], words, title="Forces of the legs"),
        Table([legs, *_extremes(loads, "rate"), *_extremes(loads, "power")], title="Rate and power of the legs"),
    ]


def _extremes(loads: xr.Dataset, name: str) -> list[Column]:
    words, unit = _WORDS[name]
    return [
        Column(f"{title} {words}", without_rounding(loads[f"{which}_{name}"].values), unit)
        for which, title in (("least", "least"), ("greatest", "greatest"), ("rms", "RMS"))
    ]


def case_tables(cases: xr.Dataset) -> list[Table]:
    """Payloads side by side, each with the most that any leg bears; the worst of a column is marked."""
    worst: dict[str, tuple[Any, str, Any]] = {
        "least index": (cases.least_index, "rad/s", np.argmin),
        "least force": (cases.least_force.min("leg"), "N", np.argmin),
        "greatest force": (cases.greatest_force.max("leg"), "N", np.argmax),
        "RMS force": (cases.rms_force.max("leg"), "N", np.argmax),
        "greatest power": (cases.greatest_power.max("leg"), "W", np.argmax),
        "least power": (cases.least_power.min("leg"), "W", np.argmin),
    }
    columns = [Column("case", [str(name) for name in cases.case.values]), Column("payload", cases.mass.values, "kg")]
    for title, (found, unit, pick) in worst.items():
        values = found.values
        columns.append(Column(title, values, unit, marked=np.arange(values.size) == pick(values)))
    legs = [Column("leg", [str(leg) for leg in cases.leg.values])]
    for which in ("least", "greatest", "rms"):
        found = cases[f"{which}_force"]
        pick = found.argmin("case") if which == "least" else found.argmax("case")
        title = f"{'RMS' if which == 'rms' else which} force"
        legs.append(Column(title, found.isel(case=pick).values, "N"))
        legs.append(Column("in case", [str(name) for name in cases.case.values[pick.values]]))
    words = "Of the six legs the one that has most; what is the worst of all cases is marked."
    return [Table(columns, words, title="Payloads"), Table(legs, title="The worst case of each leg")]


def data(loads: xr.Dataset) -> dict[str, Any]:
    """The extremes by name, of each leg, with what cases there are before."""
    found = {"leg_stroke_m": loads.stroke.values, "leg_peak_force_N": loads.peak_force.values}
    for name in EXTREMES:
        short = name.removeprefix("leg_")
        unit = {"force": "N", "rate": "m_s", "power": "W"}[short]
        found |= {f"leg_{which}_{short}_{unit}": loads[f"{which}_{short}"].values for which in _RANK}
    found["leg_peak_rate_m_s"] = np.abs(loads.leg_rate.values).max(axis=-2)
    found["leg_peak_acceleration_m_s2"] = np.abs(loads.leg_acceleration.values).max(axis=-2)
    found |= {f"leg_peak_{name}_N_m": np.abs(loads[name].values).max(axis=-2) for name in MOMENTS if name in loads}
    return found


_RANK = ("least", "greatest", "rms")


def series(path: Trajectory, loads: xr.Dataset) -> str:
    """Pose and legs at each instant as the text of a CSV file in SI units; cases below one another."""
    if "case" in loads.dims:
        names = [str(name) for name in loads.case.values]
        parts = [_columns(path, loads.sel(case=name)) for name in names]
        first = {"case": np.repeat(names, loads.time.size)}
        return written_table(first | {title: np.concatenate([part[title] for part in parts]) for title in parts[0]})
    return written_table(_columns(path, loads))


def _columns(path: Trajectory, loads: xr.Dataset) -> dict[str, Any]:
    pose = path(loads.time.values).pose
    columns: dict[str, Any] = {"time_s": loads.time.values}
    columns |= {f"{axis}_m": pose.position[:, k] for k, axis in enumerate(TRANSLATIONS)}
    columns |= {f"{axis}_rad": pose.rpy[:, k] for k, axis in enumerate(ROTATIONS)}
    columns |= point_columns(loads)
    for name in _SERIES:
        if name in loads:
            unit = loads[name].attrs["units"]
            columns |= {
                titled(f"{name}_{leg}", unit): loads[name].values[:, k] for k, leg in enumerate(loads.leg.values)
            }
    return columns
