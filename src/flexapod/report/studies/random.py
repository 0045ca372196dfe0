"""Random vibration in tables, as results and as a CSV file, with and without control."""

from __future__ import annotations

from typing import Any

import pandas as pd
import xarray as xr

from flexapod.conventions import AXES, LEGS, ROTATIONS, TRANSLATIONS, TWO_PI, Array, metric
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.point_motion import in_columns
from flexapod.report.numbers import shown, without_rounding
from flexapod.report.study import Column, Table

#: Quantities of the platform in tables, with what follows m or rad in their units.
_MOTIONS = {"displacement": "", "relative": "", "acceleration": "/s\u00b2"}
_QUANTITIES = (*_MOTIONS, "leg_force", "actuator_force")


def quantity(random: xr.Dataset) -> str:
    """What a figure of it shows: loads move the platform, a base shakes it."""
    return "acceleration" if random.attrs["sources"] == ["base"] else "displacement"


def cautions(random: xr.Dataset | None) -> list[Caution]:
    """What to beware of in it, if there is one."""
    text = "" if random is None else random.attrs["spectrum_caution"]
    return [Caution("spectrum", text)] if text else []


def tables(random: xr.Dataset, passive: xr.Dataset | None = None) -> list[Table]:
    """RMS values of all that is told, beside those without control where there is any; and by source, if several."""
    columns = [Column("", AXES)]
    for name, per in _MOTIONS.items():
        columns.append(Column(name, _motions(random[f"rms_{name}"].values, per)))
        if passive is not None and name != "relative":
            columns.append(Column("no control", _motions(passive[f"rms_{name}"].values, per)))
    forces = [Column("leg", LEGS)]
    for name, title in (("leg_force", "force"), ("actuator_force", "of its actuator")):
        if f"rms_{name}" in random:
            forces.append(Column(title, random[f"rms_{name}"].values, "N"))
    by = " and ".join(_sources(random))
    return [Table(columns, title=f"RMS by {by}"), Table(forces, title=f"RMS force by {by}"), *_by_source(random)]


def _motions(values: Array, per: str) -> list[str]:
    """Values over the axes with their units: translations in one, rotations in another."""
    values, texts = without_rounding(values), []
    for part, unit in ((values[:3], "m"), (values[3:], "rad")):
        factor, scaled = metric(float(part.max()), unit)
        texts += [f"{shown(float(factor * value))} {scaled}{per}" for value in part]
    return texts


def _sources(random: xr.Dataset) -> list[str]:
    """The sources in words."""
    return ["the base that moves at random" if name == "base" else str(name) for name in random.source.values]


def _by_source(random: xr.Dataset) -> list[Table]:
    """The RMS by each source alone, where there are several."""
    if random.source.size < 2:
        return []
    columns = [Column("source", [str(name) for name in random.source.values])]
    values = without_rounding(random.source_rms_displacement.values)
    for axes, unit in ((TRANSLATIONS, "m"), (ROTATIONS, "rad")):
        places = [AXES.index(axis) for axis in axes]
        factor, scaled = metric(float(values[:, places].max()), unit)
        columns += [Column(axis, factor * values[:, k], scaled) for axis, k in zip(axes, places, strict=True)]
    words = "RMS displacement by each source alone; independent sources add up in their squares."
    return [Table(columns, words, title="RMS displacement by source")]


def data(random: xr.Dataset) -> dict[str, Any]:
    """RMS values by name, altogether and by each source."""
    there = [name for name in _QUANTITIES if f"rms_{name}" in random]
    return {
        "random_rms": {name: random[f"rms_{name}"].values for name in there},
        "random_rms_by_source": {
            str(source): {name: random[f"source_rms_{name}"].values[k] for name in there}
            for k, source in enumerate(random.source.values)
        },
    }


def csv(random: xr.Dataset) -> str:
    """Densities, per rad/s, and the RMS of all that lies below each frequency, with their units in the titles."""
    omega = random.omega.values
    columns: dict[str, Any] = {"omega_rad_s": omega, "frequency_hz": omega / TWO_PI}
    for name in (name for name in _QUANTITIES if f"rms_{name}" in random):
        labels = AXES if (moves := name in _MOTIONS) else LEGS
        of = in_columns(random.attrs) if moves else ""
        for k, label in enumerate(labels):
            unit, squared = _units(name, label)
            columns[f"psd_{name}{of}_{label}_{squared}_per_rad_s"] = random[f"psd_{name}"].values[:, k]
            columns[f"cumulative_{name}{of}_{label}_{unit}"] = random[f"cumulative_{name}"].values[:, k]
    return pd.DataFrame(columns).set_index("omega_rad_s").to_csv()


def _units(name: str, label: str) -> tuple[str, str]:
    """The unit of a quantity and its square, as columns are titled."""
    if name not in _MOTIONS:
        return "N", "N2"
    unit = "rad" if label in ROTATIONS else "m"
    return (f"{unit}_s2", f"{unit}2_s4") if name == "acceleration" else (unit, f"{unit}2")
