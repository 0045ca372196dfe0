"""Frequency response, stepped sine and random response of a machine at a pose, as a study."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray as xr

from flexapod import plots
from flexapod.conventions import AXES, TWO_PI, Array, Complex, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.point_motion import in_columns, of_point
from flexapod.pose import Pose
from flexapod.report.numbers import pose_numbers, pose_words, without_rounding
from flexapod.report.studies import random
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class ResponseFindings:
    """What was computed: the response to one input on an axis (or leg); of the base also by other means.

    options: output point, loss factor and joint model. source: "base", "wrench" or "command". poles: of the tangent.
    """

    hexapod: Hexapod
    pose: Pose
    options: dict[str, Any]
    source: str
    axis: str
    variable: str
    poles: Complex
    response: xr.Dataset
    stepped: xr.Dataset | None = None
    random: xr.Dataset | None = None
    notes: Sequence[str] = ()

    @property
    def dimension(self) -> str:
        """The dimension of the input in the response."""
        return {"base": "base", "wrench": "wrench", "command": "leg"}[self.source]

    @property
    def chosen(self) -> xr.DataArray:
        """The response to the input."""
        return self.response[self.variable].sel({self.dimension: self.axis})


def study(f: ResponseFindings, peaks: Array) -> Study:
    """The study of a response. peaks: (6 modes, 6 outputs), amplitudes at the modes' damped frequencies."""
    parts = {"response": f.response, "stepped": f.stepped, "random": f.random}
    there = {name: dataset for name, dataset in parts.items() if dataset is not None}
    drawings = {name: Drawing(name, title, partial(_figure, f, name)) for name, title in TITLES.items()}
    tables = {"response": [_peaks_table(f, peaks)], "random": [] if f.random is None else random.tables(f.random)}
    files: dict[str, Any] = {}
    for name, dataset in there.items():
        files[f"{name}.csv"] = partial(_csv, f, name)
        files[f"{name}.nc"] = partial(real_parts, dataset)
        files[f"{name}.png"] = drawings[name].draw
    sections = []
    for name in there:
        sections.append(Section(TITLES[name], [drawings[name], *tables.get(name, [])]))
    return Study(
        hexapod=f.hexapod,
        subject="response",
        about=f"Response to {f.source} {f.axis} at {pose_words(f.pose)}{of_point(f.response.attrs)}.",
        data=_data(f, peaks),
        rows=[] if f.stepped is None else [Row("Non-linear stepped sine,", stepped_words(f.stepped))],
        sections=sections,
        cautions=[*_stability(f), *(Caution("spectrum", text) for text in f.notes), *random.cautions(f.random)],
        files=files,
        dataset=f.response,
    )


TITLES = {"response": "Frequency response", "stepped": "Non-linear stepped sine", "random": "Random vibration"}


def _stability(f: ResponseFindings) -> list[Caution]:
    text = f.response.attrs["caution"]
    return [Caution("unstable", text)] if text else []


def _figure(f: ResponseFindings, name: str) -> Figure:
    natural = f.poles.imag
    if name == "response":
        return plots.response.frequency_response(f.response, f.variable, f.axis, natural=natural)
    if name == "random":
        assert f.random is not None
        return plots.response.random_spectra(f.random, random.quantity(f.random))
    assert f.stepped is not None
    linear = f.response.absolute.sel(base=f.axis)
    figure = plots.response.stepped_ratio(f.stepped, natural=natural, linear=linear, scale="log", unit="Hz")
    amplitude = f"{f.stepped.attrs['amplitude']:g} {f.stepped.attrs['amplitude_unit']}"
    title = (
        f"{f.hexapod.name}: non-linear stepped sine, base {f.axis}, amplitude {amplitude}{of_point(f.stepped.attrs)}"
    )
    plots.style.entitle(figure, title)
    return figure


def real_parts(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with every complex variable as two real ones, <name>_re and <name>_im, as netCDF wants it."""
    parts = {}
    for name, variable in dataset.data_vars.items():
        if np.iscomplexobj(variable):
            parts[f"{name}_re"], parts[f"{name}_im"] = variable.real, variable.imag
            parts[f"{name}_re"].attrs = parts[f"{name}_im"].attrs = variable.attrs
        else:
            parts[str(name)] = variable
    return dataset.drop_vars(list(dataset.data_vars)).assign(parts)


def _csv(f: ResponseFindings, name: str) -> str:
    if name == "random":
        assert f.random is not None
        return random.csv(f.random)
    return {"response": _response_frame, "stepped": _stepped_frame}[name](f).to_csv()


def _response_frame(f: ResponseFindings) -> pd.DataFrame:
    omega, of = f.response.omega.values, in_columns(f.response.attrs)
    table = pd.DataFrame({"omega_rad_s": omega, "frequency_hz": omega / TWO_PI})
    below = {"base": unit_of(f.axis), "wrench": unit_of(f.axis, "N", "N m"), "leg": "m"}[f.dimension].replace(" ", "_")
    for output in AXES:
        values = f.chosen.sel(output=output).values
        table[f"{output}_amplitude{of}_{unit_of(output)}_per_{below}"] = np.abs(values)
        table[f"{output}_phase{of}_deg"] = np.degrees(np.angle(values))
    return table.set_index("omega_rad_s")


def _stepped_frame(f: ResponseFindings) -> pd.DataFrame:
    assert f.stepped is not None
    of, below = in_columns(f.stepped.attrs), f.stepped.attrs["amplitude_unit"]
    titles = {axis: f"{axis}_ratio{of}_{unit_of(axis)}_per_{below}" for axis in AXES}
    return f.stepped.ratio.to_pandas().rename(columns=titles).rename_axis("omega_rad_s")


def stepped_words(stepped: xr.Dataset) -> str:
    """How far the non-linear response is from that of the tangent."""
    found = stepped.status.values == "found"
    words = f"amplitude {stepped.attrs['amplitude']:g} {stepped.attrs['amplitude_unit']}: "
    if not found.any():
        return words + "no periodic motion found at any frequency."
    linear, response = stepped.linear.values[found], stepped.response.values[found]
    apart = np.linalg.norm(response - linear, axis=1) / np.linalg.norm(linear, axis=1)
    words += f"{found.sum()} of {found.size} frequencies; apart from the tangent by {np.median(apart):.2g} (median), "
    return words + f"{apart.max():.2g} at most, at {stepped.omega.values[found][apart.argmax()]:.5g} rad/s."


def _peaks_table(f: ResponseFindings, peaks: Array) -> Table:
    unit = {"base": unit_of(f.axis), "wrench": "N (N m)", "leg": "m"}[f.dimension]
    columns = [
        Column("mode", [str(number) for number in range(1, 7)]),
        Column("rad/s", f.poles.imag, digits=5),
        Column("Hz", f.poles.imag / TWO_PI),
        Column("damping", -f.poles.real / np.abs(f.poles), digits=2),
        *(Column(axis, values, digits=2) for axis, values in zip(AXES, without_rounding(peaks).T, strict=True)),
    ]
    words = "response at each damped frequency, m and rad per"
    return Table(columns, title=f"{f.variable.capitalize()} {words} {unit} of {f.dimension} {f.axis}")


def _data(f: ResponseFindings, peaks: Array) -> dict[str, Any]:
    data: dict[str, Any] = {
        **origin(f.hexapod),
        "pose_m_deg": pose_numbers(f.pose),
        "joint": f.options["joint"],
        "loss_factor": f.response.attrs["loss_factor"],
        "joint_loss_factor": f.response.attrs["joint_loss_factor"],
        "point_m": f.response.attrs["point_m"],
        "point": f.response.attrs["point"],
        "from": f.source,
        "axis": f.axis,
        "variable": f.variable,
        "damped_omega_rad_s": f.poles.imag,
        "damping_ratio": -f.poles.real / np.abs(f.poles),
        "amplitude_at_modes": peaks,
        "omega_rad_s": f.response.omega.values,
        "amplitude": {name: np.abs(f.chosen.sel(output=name).values) for name in AXES},
        "phase_rad": {name: np.angle(f.chosen.sel(output=name).values) for name in AXES},
    }
    if f.stepped is not None:
        ratio = {name: f.stepped.ratio.sel(output=name).values for name in AXES}
        status = {"amplitude": f.stepped.attrs["amplitude"], "status": f.stepped.status.values}
        data["stepped"] = {"omega_rad_s": f.stepped.omega.values, "ratio": ratio, **status}
    if f.random is not None:
        data |= random.data(f.random)
    return data
