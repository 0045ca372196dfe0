"""A simulation in time, as a study."""

from __future__ import annotations

import io
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from flexapod import plots
from flexapod.conventions import AXES, Unit, printed_unit, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.point_motion import in_columns, of_point, point_words
from flexapod.plots.style import ROUNDING, entitle
from flexapod.pose import Pose
from flexapod.report.numbers import pose_numbers, pose_words, without_rounding
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table
from flexapod.simulation.notes import BALANCE

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def study(
    hexapod: Hexapod, pose: Pose, dataset: xr.Dataset, took: float = np.nan, cautions: Sequence[Caution] = ()
) -> Study:
    """The study of a simulation. took: s."""
    force = dataset.leg_force.values
    cautions = [
        *(Caution("simulation", f"{text[0].upper()}{text[1:]}") for text in dataset.attrs["warnings"]),
        *cautions,
    ]
    steps = f"{dataset.attrs['steps']} steps in {took:.2f} s; energy balance error"
    summary = _summary(dataset)
    point = point_words(dataset.attrs["point_m"], dataset.attrs["point"])
    drawings = [
        Drawing("displacement", "Displacement from rest", partial(_displacement, dataset, "displacement")),
        Drawing("relative_displacement", "Displacement seen from the base",
                partial(_displacement, dataset, "relative_displacement")),
        Drawing("leg_forces", "Leg forces", lambda: plots.simulation.leg_forces(dataset)),
    ]  # fmt: skip
    return Study(
        hexapod=hexapod,
        subject="simulation",
        about=f"From rest at {pose_words(pose)}, joint model {dataset.attrs['joint']}{of_point(dataset.attrs)}.",
        data={**_data(hexapod, pose, dataset, took), **summary},
        rows=[
            Row("Leg forces from", f"{force.min():.5g} to {force.max():.5g}", "N", note="(positive: compression)"),
            Row(steps, f"{dataset.attrs['energy_error']:.1e}", note=_of_what(dataset)),
        ],
        sections=[Section("Motion", [*drawings, _displacements(summary, point), _rates(summary)])],
        cautions=cautions,
        files={
            "simulation.nc": partial(_stored, dataset),
            "simulation.csv": partial(_csv, dataset),
            **{f"{drawing.name}.png": drawing.draw for drawing in drawings},
        },
        dataset=dataset,
    )


def _displacement(dataset: xr.Dataset, name: str) -> Figure:
    figure = plots.simulation.displacements(dataset.time.values, dataset[name].values)
    if words := point_words(dataset.attrs["point_m"], dataset.attrs["point"]):
        entitle(figure, f"{dataset.attrs['design']}: {name.replace('_', ' ')} of {words}")
    return figure


def _stored(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset as NetCDF can hold it."""
    return dataset.assign_attrs(warnings="; ".join(dataset.attrs["warnings"]))


def _displacements(summary: dict[str, dict[str, list[float]]], point: str) -> Table:
    columns = [Column("", AXES)]
    for name, words in (("displacement", "largest displacement"), ("relative_displacement", "seen from the base")):
        columns += [
            _column(words, summary[name]["largest"], "m", "rad"),
            _column("RMS", summary[name]["rms"], "m", "rad"),
        ]
    return Table(columns, title=f"Motion of {point or 'the platform'}")


def _rates(summary: dict[str, dict[str, list[float]]]) -> Table:
    columns = [Column("", AXES)]
    units: dict[str, tuple[Unit, Unit]] = {"velocity": ("m/s", "rad/s"), "acceleration": ("m/s^2", "rad/s^2")}
    for name, (linear, angular) in units.items():
        columns += [
            _column(name, summary[name]["rms"], linear, angular),
            _column("seen from the base", summary[f"relative_{name}"]["rms"], linear, angular),
        ]
    return Table(columns, title="RMS of velocity and acceleration")


def _column(title: str, values: Sequence[float], linear: Unit, angular: Unit) -> Column:
    kept = without_rounding(np.asarray(values), ROUNDING)
    units = (printed_unit(unit_of(axis, linear, angular)) for axis in AXES)
    return Column(title, [f"{value:.4g} {unit}" if value else "0" for value, unit in zip(kept, units, strict=True)])


def _csv(dataset: xr.Dataset) -> str:
    """Displacements, leg lengths and forces as CSV, one line a sample."""
    names = ["time_s"]
    columns = [dataset.time.values[:, None]]
    for variable in ("displacement", "relative_displacement"):
        columns.append(dataset[variable].values)
        names += [f"{variable}{in_columns(dataset.attrs)}_{axis}_{unit_of(axis)}" for axis in AXES]
    for variable, unit in (("leg_length", "m"), ("leg_force", "N")):
        columns.append(dataset[variable].values)
        names += [f"{variable}_{leg}_{unit}" for leg in dataset.leg.values]
    text = io.StringIO()
    np.savetxt(text, np.hstack(columns), fmt="%.12g", delimiter=",", header=",".join(names), comments="")
    return text.getvalue()


def _summary(dataset: xr.Dataset) -> dict[str, dict[str, list[float]]]:
    """Largest and RMS values of displacements, velocities and accelerations, by axis."""
    parts = {name: dataset[name].values for name in ("displacement", "relative_displacement")}
    for name in ("velocity", "acceleration"):
        parts[name] = np.hstack([dataset[name].values, dataset[f"angular_{name}"].values])
        parts[f"relative_{name}"] = dataset[f"relative_{name}"].values
    return {
        name: {"largest": np.abs(part).max(axis=0).tolist(), "rms": np.sqrt((part**2).mean(axis=0)).tolist()}
        for name, part in parts.items()
    }


def _of_what(dataset: xr.Dataset) -> str:
    """What the error of the energy balance is a part of, and whether it is one of the motion."""
    of = "of the largest of kinetic energy and works"
    if (
        np.abs(dataset.energy_error).max() > dataset.attrs["energy_rounding"]
        or dataset.attrs["energy_error"] <= BALANCE
    ):
        return of
    return f"{of}: these are so small that the rounding of the energy stored in springs and height hides them"


def _data(hexapod: Hexapod, pose: Pose, dataset: xr.Dataset, took: float) -> dict[str, Any]:
    force = dataset.leg_force.values
    return {
        **origin(hexapod),
        "pose_m_deg": pose_numbers(pose),
        "joint": dataset.attrs["joint"],
        "point_m": dataset.attrs["point_m"],
        "point": dataset.attrs["point"],
        "duration_s": float(dataset.time[-1]),
        "samples": dataset.sizes["time"],
        "axes": list(AXES),
        "leg_force_N": {"least": force.min(axis=0), "largest": force.max(axis=0)},
        "energy_error": dataset.attrs["energy_error"],
        "steps": dataset.attrs["steps"],
        "evaluations": dataset.attrs["evaluations"],
        "seconds": took,
    }
