"""Load cases at rest as a study."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from flexapod import plots
from flexapod.conventions import AXES, LEGS, Array, Unit, in_unit, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.point_motion import in_columns, point_words
from flexapod.report.numbers import DASH, brief, without_rounding
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table
from flexapod.tables import written_table
from flexapod.workspace.quantities import titled

_ROUNDING = 1e-14  # of a leg's length: what is moved by less is not moved, and the force of such a change is none


@dataclass(frozen=True)
class StaticsFindings:
    """What was computed: cases by name; elevation (rad) of each, where it varies; reference: the case of lengths."""

    cases: xr.Dataset
    names: list[str]
    elevation: Array | None
    reference: int | None


def study(hexapod: Hexapod, f: StaticsFindings) -> Study:
    """The study of load cases."""
    lengths = "without weight and load" if f.reference is None else f"in case {f.names[f.reference]}"
    point = point_words(f.cases.attrs["point_m"], f.cases.attrs["point"]) or "the platform's origin"
    cases = f"{len(f.names)} load case{'s' * (len(f.names) > 1)}"
    drawing = Drawing(
        "statics", "Forces and deflections", lambda: plots.statics.load_cases(f.cases, f.elevation), "", wide=True
    )
    return Study(
        hexapod=hexapod,
        subject="statics",
        about=f"{cases} at rest. Leg lengths are held as they are {lengths}; the point is {point}.",
        data=_data(hexapod, f),
        rows=_rows(f),
        sections=[
            Section("Cases", [drawing, _cases(f)]),
            Section("Legs", [_legs(f)]),
            Section("Stiffness", [_matrix(f, "stiffness"), _matrix(f, "compliance")], [_first(f)]),
            Section("What the deflection depends on", [_sensitivity(f)], [_worst_words(f)]),
        ],
        cautions=_cautions(hexapod, f),
        files={
            "statics.png": drawing.draw,
            "statics.csv": lambda: table(f),
            "statics-stiffness.csv": lambda: matrices(f),
            "statics.nc": lambda: _named(f),
            "statics.html": None,
        },
        dataset=_named(f),
    )


def _named(f: StaticsFindings) -> xr.Dataset:
    """The cases with their names, and their elevations where they have some."""
    named = f.cases.assign_coords(name=("case", f.names))
    if f.elevation is None:
        return named
    return named.assign_coords(elevation=("case", f.elevation, in_unit("rad", "elevation")))


def _least(f: StaticsFindings) -> tuple[float, float]:
    """The displacement (m) and the force (N) that rounding of a leg's length makes of nothing."""
    length = _ROUNDING * float(np.nanmax(f.cases.leg_length.values, initial=0.0))
    return length, length * float(np.nanmax(f.cases.attrs["leg_stiffness"], initial=0.0))


def _forces(f: StaticsFindings) -> Array:
    """Leg forces without rounding, which would be told as a force that turns its sign."""
    force = without_rounding(f.cases.leg_force.values)
    return np.where(np.abs(force) < _least(f)[1], 0.0, force)


def _moved(f: StaticsFindings, name: str) -> Array:
    """Deflection or rotation without rounding."""
    values = without_rounding(f.cases[name].values)
    return np.where(np.abs(values) < _least(f)[0], 0.0, values)


def _degrees(angle: Array) -> Array:
    """Degrees without what radians have rounded."""
    rounded: Array = np.round(np.degrees(angle), 10).astype(np.float64)
    return rounded


def table(f: StaticsFindings) -> str:
    """The cases as the text of a CSV file: SI units, elevation in degrees."""
    cases = f.cases
    columns: dict[str, Any] = {"case": np.array(f.names)}
    if f.elevation is not None:
        columns["elevation_deg"] = _degrees(f.elevation)
    for name in ("gravity", "deflection", "rotation"):
        for k, axis in enumerate("xyz"):
            of = in_columns(cases.attrs) if name == "deflection" else ""
            columns[titled(f"{name}{of}_{axis}", cases[name].attrs["units"])] = cases[name].values[:, k]
    for name in ("leg_force", "leg_length"):
        for k, leg in enumerate(LEGS):
            columns[titled(f"{name}_{leg}", cases[name].attrs["units"])] = cases[name].values[:, k]
    for name in ("spherical_force", "universal_force", "leg_moment", "universal_moment"):
        size = np.linalg.norm(cases[name].values, axis=-1)
        for k, leg in enumerate(LEGS):
            columns[titled(f"{name}_{leg}", cases[name].attrs["units"])] = size[:, k]
    columns["force_within_limits"] = cases.force_within_limits.values.astype(int)
    columns["status"] = np.array(["ok" if word == "ok" else "no_equilibrium" for word in cases.status.values])
    return written_table(columns)


def matrices(f: StaticsFindings) -> str:
    """Stiffness and compliance at the point in each case as the text of a CSV file: a line for each number."""
    size, count = len(AXES), len(f.names)
    columns: dict[str, list[Any]] = {
        "case": [name for name in f.names for _ in range(2 * size**2)],
        "matrix": [name for name in ("stiffness", "compliance") for _ in range(size**2)] * count,
        "of": [axis for axis in AXES for _ in AXES] * 2 * count,
        "by": list(AXES) * 2 * size * count,
        "value": np.stack([f.cases[name].values for name in ("stiffness", "compliance")], axis=1).ravel().tolist(),
    }
    moves: dict[str, tuple[Unit, Unit, Unit, Unit]] = {
        "stiffness": ("N", "N m", "m", "rad"),
        "compliance": ("m", "rad", "N", "N m"),
    }
    units = []
    for name, of, by in zip(columns["matrix"], columns["of"], columns["by"], strict=True):
        linear, angular, below, turned = moves[name]
        under = unit_of(by, below, turned)
        units.append(f"{unit_of(of, linear, angular)}/{f'({under})' if ' ' in under else under}")
    return written_table({name: np.array(values) for name, values in {**columns, "unit": units}.items()})


def reversals(f: StaticsFindings) -> list[tuple[str, list[float]]]:
    """Legs whose force changes between push and pull, and the elevations (degrees) between cases at which it does."""
    found = []
    for k, leg in enumerate(LEGS):
        force = _forces(f)[:, k]
        known = force[np.isfinite(force)]
        if not (known.size and known.min() < 0 < known.max()):
            continue
        places: list[float] = []
        if f.elevation is not None:
            order = np.argsort(f.elevation)
            at, along = np.degrees(f.elevation[order]), force[order]
            for i in np.flatnonzero(along[:-1] * along[1:] < 0):
                places.append(float(at[i] - along[i] * (at[i + 1] - at[i]) / (along[i + 1] - along[i])))
        found.append((leg, places))
    return found


def _ok(f: StaticsFindings) -> np.ndarray:
    return np.asarray(f.cases.status.values == "ok")


def _worst(f: StaticsFindings) -> int:
    """The case with the largest deflection."""
    size = np.linalg.norm(f.cases.deflection.values, axis=1)
    return int(np.nanargmax(size)) if np.isfinite(size).any() else 0


def _rows(f: StaticsFindings) -> list[Row]:
    force, worst = _forces(f), _worst(f)
    size = float(np.linalg.norm(_moved(f, "deflection")[worst]))
    least, most = (float(reduce(force)) if np.isfinite(force).any() else np.nan for reduce in (np.nanmin, np.nanmax))
    return [
        Row("Leg forces from", least, "N"),
        Row("to", most, "N", note="positive: compression"),
        Row("Largest deflection", 1e6 * size, "\u00b5m", note=f"in case {f.names[worst]}"),
    ]


def _cases(f: StaticsFindings) -> Table:
    c = f.cases
    columns = [Column("case", f.names)]
    if f.elevation is not None:
        columns.append(Column("elevation", _degrees(f.elevation), "deg"))
    moved, turned = (1e6 * _moved(f, name) for name in ("deflection", "rotation"))
    columns += [Column(axis, moved[:, k], "\u00b5m") for k, axis in enumerate("xyz")]
    columns += [Column(f"about {axis}", turned[:, k], "\u00b5rad") for k, axis in enumerate("xyz")]
    force = _forces(f)
    columns.append(Column("least leg force", force.min(axis=1), "N", marked=~c.force_within_limits.values))
    columns.append(Column("largest leg force", force.max(axis=1), "N", marked=~c.force_within_limits.values))
    return Table(
        columns,
        "Deflection and rotation of the point, base axes. Leg forces are positive in compression.",
        style="narrow",
    )


def _legs(f: StaticsFindings) -> Table:
    force, told = _forces(f), dict(reversals(f))
    moment = np.linalg.norm(f.cases.leg_moment.values, axis=-1)
    moment[moment < _least(f)[1] * f.cases.leg_length.values] = 0.0
    at = [
        DASH if leg not in told else ", ".join(f"{brief(place)} deg" for place in told[leg]) or "between cases"
        for leg in LEGS
    ]
    columns = [
        Column("leg", list(LEGS)),
        Column("least force", _or_nan(force, np.nanmin), "N"),
        Column("largest force", _or_nan(force, np.nanmax), "N"),
        Column("turns from pull to push at", at),
        Column("moment in the leg up to", _or_nan(moment, np.nanmax), "N m"),
    ]
    return Table(columns, "A leg that turns from tension to compression takes up the play of its joints.", title="Legs")


def _or_nan(values: Array, reduce: Any) -> Array:
    return reduce(values, axis=0) if np.isfinite(values).any() else np.full(values.shape[1], np.nan)


def _first(f: StaticsFindings) -> str:
    k = f.reference or 0
    return f"At the point, in base axes, in case {f.names[k]}; loads that bend the platform change it little."


def _matrix(f: StaticsFindings, name: str) -> Table:
    values = without_rounding(f.cases[name].values[f.reference or 0])
    units = ("N/m, N; N, N m/rad" if name == "stiffness" else "m/N, 1/N; 1/N, rad/(N m)").replace("; ", " and ")
    columns = [Column("", list(AXES)), *(Column(axis, values[:, k]) for k, axis in enumerate(AXES))]
    return Table(columns, f"In {units}.", title=name.capitalize())


def _worst_words(f: StaticsFindings) -> str:
    return (
        f"Derivatives of deflection and rotation in case {f.names[_worst(f)]}, in which the deflection is largest: by "
        "1 \u00b5m of a leg's length, by 1 % of its stiffness, by 1 kg of platform mass and by 1 mm of its mass centre."
    )


def _sensitivity(f: StaticsFindings) -> Table:
    case, k = f.cases.isel(case=_worst(f)), "leg"
    mass, centre = case.deflection_by_mass.values, 1e-3 * case.deflection_by_mass_center.values
    rows: list[tuple[str, Array]] = []
    rows += [
        (f"length of {k} {leg}, 1 \u00b5m", 1e-6 * case.deflection_by_leg_length.values[:, i])
        for i, leg in enumerate(LEGS)
    ]
    stiff = case.deflection_by_stiffness.values * np.asarray(f.cases.attrs["leg_stiffness"]) / 100
    rows += [(f"stiffness of {k} {leg}, 1 %", stiff[:, i]) for i, leg in enumerate(LEGS)]
    rows += [("platform mass, 1 kg", mass)]
    rows += [(f"mass centre along {axis}, 1 mm", centre[:, i]) for i, axis in enumerate("xyz")]
    columns = [Column("change", [name for name, _ in rows])]
    for i, axis in enumerate(AXES):
        columns.append(
            Column(axis, [1e6 * without_rounding(values)[i] for _, values in rows], "\u00b5m" if i < 3 else "\u00b5rad")
        )
    return Table(columns, on="page", style="narrow")


def _cautions(hexapod: Hexapod, f: StaticsFindings) -> list[Caution]:
    told = []
    turned = reversals(f)
    if turned:
        legs = ", ".join(
            leg + (f" (near {', '.join(brief(p, 3) for p in at)} deg)" if at else "") for leg, at in turned
        )
        text = f"Legs turn from tension to compression, where play in their joints is taken up: leg {legs}."
        told.append(Caution("reversal", text, {"legs": len(turned)}))
    beyond = _ok(f) & ~f.cases.force_within_limits.values
    if beyond.any():
        first, several = f.names[int(np.argmax(beyond))], beyond.sum() > 1
        where = f"{beyond.sum()} cases, first in case {first}" if several else f"case {first}"
        text = f"Leg forces are beyond the design's limits in {where}."
        told.append(Caution("force_limit", text, {"cases": int(beyond.sum())}))
    for name, status in zip(f.names, f.cases.status.values, strict=True):
        if status != "ok":
            told.append(Caution("no_equilibrium", f"Case {name}: {status}", {}))
    if not (hexapod.gravity.any() or f.cases.gravity.values.any()):
        told.append(Caution("no_gravity", "There is no gravity in any case.", {}))
    return told


def _data(hexapod: Hexapod, f: StaticsFindings) -> dict[str, Any]:
    c = f.cases
    names = {
        **{f"{name}_N": name for name in ("leg_force", "spherical_force", "universal_force")},
        **{f"{name}_N_m": name for name in ("leg_moment", "universal_moment")},
        **{f"{name}_m": name for name in ("leg_length", "unstretched_length", "deflection")},
        **{f"{name}_m_rad_N": name for name in ("stiffness", "compliance")},
        **{str(name): str(name) for name in c.data_vars if str(name).startswith("deflection_by")},
        "gravity_m_s2": "gravity",
        "rotation_rad": "rotation",
    }
    return {
        **origin(hexapod),
        "point_m": c.attrs["point_m"],
        "point": c.attrs["point"],
        "reference": None if f.reference is None else f.names[f.reference],
        "case": f.names,
        "elevation_deg": None if f.elevation is None else _degrees(f.elevation),
        **{key: c[name].values for key, name in names.items()},
        "force_within_limits": c.force_within_limits.values,
        "status": c.status.values,
        "reversals": [{"leg": leg, "elevation_deg": at} for leg, at in reversals(f)],
    }
