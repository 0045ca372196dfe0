"""A control law on a machine at a pose, as a study."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from flexapod import plots
from flexapod.control.closed_loop_poles import ClosedLoop, creep_words, near_words
from flexapod.conventions import TWO_PI, printed_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import told_apart
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.point_motion import of_point
from flexapod.pose import Pose
from flexapod.report.numbers import pose_numbers, pose_words, shown
from flexapod.report.studies import random
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table

RMS = ("rms_acceleration", "predicted_rms_acceleration", "rms_displacement")


class Fact(NamedTuple):
    """A number of the law or of the shaking: its key in JSON, what it is, its value and its unit."""

    key: str
    words: str
    value: float | str
    unit: str = ""


class RandomWithControl(NamedTuple):
    """Random responses with control, and without it where there is one."""

    controlled: xr.Dataset
    passive: xr.Dataset | None


@dataclass(frozen=True)
class ControlFindings:
    """What was computed about a control law.

    assumptions: what its model leaves out. ideal, sampled: its closed loops; gains, locus, run: where made. law,
    shaking: what was given or chosen. random: under the spectra that were given; notes: on their files. gain: of a
    decentralised law. axis: the one drawn in time.
    """

    pose: Pose
    assumptions: str
    ideal: ClosedLoop
    sampled: ClosedLoop
    recommended: float
    response: xr.Dataset
    gains: xr.Dataset | None = None
    locus: xr.Dataset | None = None
    run: xr.Dataset | None = None
    axis: str = "z"
    law: Sequence[Fact] = ()
    shaking: Sequence[Fact] = ()
    gain: float | None = None
    random: RandomWithControl | None = None
    notes: Sequence[str] = ()

    @property
    def dt(self) -> float:
        """Sampling time, s."""
        return self.sampled.controller.dt or np.nan


def study(hexapod: Hexapod, f: ControlFindings) -> Study:
    """The study of a control law."""
    drawings = [
        _drawing("gains", "Which gains", "gain_map", f.gains, "Each pair of gains by the distance of its poles to the "
                 "natural frequencies and by its worst damping."),
        _drawing("locus", "Root locus", "root_locus", f.locus, "Poles over the gain, from the machine's own (crosses) "
                 "to the zeros (circles), and the least damping. Square: the gain chosen.", chosen=f.gain),
        _drawing("transmissibility", "Transmissibility", "isolation", f.response, "Displacement of the platform per "
                 "displacement of the base, of the tangent, with the sampled controller.", axes=("x", "z")),
        _drawing("run", "On the moving base", "controlled_run", f.run, "The full equations of motion on a shaking "
                 "base, with sampled measurement, held forces and what the hardware leaves of them. Bars: root mean "
                 "squares over those without control; marks: what the tangent predicts.", axis=f.axis),
        _random_drawing(f),
    ]  # fmt: skip
    there = [drawing for drawing in drawings if drawing is not None]
    sections = [Section(drawing.title, [drawing, *_tables(f, drawing.name)]) for drawing in there]
    law = Section("The law", [_facts(f.law, "The law")])
    return Study(
        hexapod=hexapod,
        subject="control",
        about=f"{f.ideal.controller.name} at {pose_words(f.pose)}, on the exact tangent{of_point(f.response.attrs)}.",
        data=_data(hexapod, f),
        rows=_rows(f),
        sections=[law, *sections, Section("Closed loop", [_poles(f)])],
        cautions=cautions(f),
        files={**{f"control-{drawing.name}.png": drawing.draw for drawing in there}, **_files(f), "control.html": None},
    )


def _drawing(name: str, title: str, plot: str, data: xr.Dataset | None, words: str, **given: Any) -> Drawing | None:
    if data is None:
        return None
    return Drawing(name, title, lambda: getattr(plots.control, plot)(data, **given), words)


def _random_drawing(f: ControlFindings) -> Drawing | None:
    if f.random is None:
        return None
    words = "Densities and the RMS of all that lies below each frequency, of the tangent, with the sampled controller."
    draw = partial(plots.response.random_spectra, f.random.controlled, random.quantity(f.random.controlled))
    return Drawing("random", "Random vibration", partial(draw, f.random.passive), words)


def _files(f: ControlFindings) -> dict[str, Callable[[], str | xr.Dataset]]:
    """Spectra with control and without it."""
    if f.random is None:
        return {}
    cases = {"control-random": f.random.controlled, "control-random-passive": f.random.passive}
    files: dict[str, Callable[[], str | xr.Dataset]] = {}
    for name, dataset in ((name, dataset) for name, dataset in cases.items() if dataset is not None):
        files |= {f"{name}.csv": partial(random.csv, dataset), f"{name}.nc": dataset.copy}
    return files


def cautions(f: ControlFindings) -> list[Caution]:
    """What to beware of in the loop."""
    found = [Caution("model", f.assumptions)]
    if f.response.attrs["caution"]:
        found.insert(0, Caution("unstable", f.response.attrs["caution"]))
    if f.dt > f.recommended * (1 + 1e-9):
        told, advised = told_apart(1e3 * f.dt, 1e3 * f.recommended)
        text = (
            f"The sampling time of {told} ms is above {advised} ms, which is 2\u03c0/(20 \u03c9) with \u03c9 the "
            "highest natural frequency, or less where the loop needs it to keep its damping; sample faster."
        )
        found.append(Caution("sampling", text, {"dt": f.dt, "recommended": f.recommended}))
    if near := near_words(f.sampled):
        found.append(Caution("near_frequency", near, {"poles": len(f.sampled.near)}))
    if creeping := creep_words(f.sampled):
        found.append(Caution("creep", creeping))
    found += [Caution("spectrum", text) for text in f.notes]
    found += random.cautions(None if f.random is None else f.random.controlled)
    if f.run is not None and f.run.attrs["saturated"] > 0:
        share = f.run.attrs["saturated"]
        found.append(Caution("saturated", f"The actuators were at their limit in {share:.1%} of the samples.",
                             {"share": share}))  # fmt: skip
    return found


def _rows(f: ControlFindings) -> list[Row]:
    loop = f.sampled
    advised = f"ms (at most {1e3 * f.recommended:.4g} ms advised), order {loop.controller.order}"
    rows = [
        Row("Worst damping ratio, sampled", loop.worst_damping, digits=3, on="page"),
        Row("if the law acted without sampling and delay", f.ideal.worst_damping, digits=3, on="page"),
        Row("Sampling time", 1e3 * f.dt, "ms", 3, on="page"),
        Row("at most", 1e3 * f.recommended, "ms", 3, on="page"),
        *_lowered(f),
        Row("natural frequencies", "  ".join(f"{w:.5g}" for w in loop.omega), "rad/s", on="terminal"),
        Row("sampled every", f"{1e3 * f.dt:.4g}", advised, on="terminal"),
        Row("worst damping ratio", f"{loop.worst_damping:.4g}",
            note=f"(if the law acted without sampling and delay {f.ideal.worst_damping:.4g})", on="terminal"),
    ]  # fmt: skip
    if f.locus is not None:
        best, at = f.locus.attrs["best_damping"], f.locus.attrs["best_gain"]
        note = f"at gain {at:.5g} {f.locus.gain.attrs['units']}"
        rows.append(Row("most damping without sampling", f"{best:.4g}", note=note, on="terminal"))
    return rows


def _lowered(f: ControlFindings) -> list[Row]:
    if f.run is None:
        return []
    rms = f.run.rms_acceleration.sel(axis=f.axis)
    ratio = float(rms.sel(case="controlled") / rms.sel(case="passive"))
    return [Row("RMS acceleration, control over none", ratio, digits=3, note=f"along {f.axis}", on="page")]


def _facts(facts: Sequence[Fact], title: str) -> Table:
    values = [fact.value if isinstance(fact.value, str) else f"{fact.value:.6g}" for fact in facts]
    texts = [" ".join(filter(None, (value, fact.unit))) for value, fact in zip(values, facts, strict=True)]
    return Table([Column("", [fact.words for fact in facts]), Column("", texts)], title=title, style="facts")


def _poles(f: ControlFindings) -> Table:
    loop = f.sampled
    upper = [k for k, pole in enumerate(loop.pole) if pole.imag >= 0]
    pole = loop.pole[upper]
    omega = ", ".join(shown(w, 5) for w in loop.omega)
    note = (
        f"Poles of the sampled loop as s = log(z)/dt, upper half plane. Natural frequencies without control: {omega} "
        "rad/s. Distances are relative; those below 0.1 are marked."
    )
    near = [k in loop.near for k in upper]
    columns = [
        Column("pole", [str(number + 1) for number in range(len(upper))]),
        Column("real", pole.real, "rad/s", 5),
        Column("imaginary", pole.imag, "rad/s", 5),
        Column("|p|", np.abs(pole) / TWO_PI, "Hz"),
        Column("damping ratio", loop.damping_ratio[upper], digits=3),
        Column("distance to a natural frequency", loop.distance[upper], digits=3, marked=near),
    ]
    return Table(columns, note, on="page")


def _tables(f: ControlFindings, name: str) -> list[Table]:
    if name == "random" and f.random is not None:
        return random.tables(f.random.controlled, f.random.passive)
    if name != "run" or f.run is None:
        return []
    units = [printed_unit(str(unit)) for unit in f.run.acceleration_unit.values]

    def rms(variable: str, case: str) -> list[str]:
        values = f.run[variable].sel(case=case).values  # type: ignore[index]
        return [f"{shown(float(value), 3)} {unit}" for value, unit in zip(values, units, strict=True)]

    columns = [Column("axis", [str(axis) for axis in f.run.axis.values])]
    for case, title in (("passive", "no control"), ("controlled", "control")):
        columns.append(Column(title, rms("rms_acceleration", case)))
        columns.append(Column("tangent", rms("predicted_rms_acceleration", case)))
    found = Table(
        columns, f"Root mean square absolute acceleration{of_point(f.run.attrs)}.", "RMS absolute acceleration"
    )
    return [_facts(f.shaking, "The shaking"), found]


def _data(hexapod: Hexapod, f: ControlFindings) -> dict[str, Any]:
    loop = f.sampled
    data: dict[str, Any] = {
        **origin(hexapod),
        "pose_m_deg": pose_numbers(f.pose),
        "point_m": f.response.attrs["point_m"],
        "point": f.response.attrs["point"],
        "controller": loop.controller.name,
        "order": loop.controller.order,
        "natural_frequencies_rad_s": loop.omega,
        "sampling_time_s": loop.controller.dt,
        "recommended_sampling_time_s": f.recommended,
        "poles_rad_s": [[p.real, p.imag] for p in loop.pole],
        "damping_ratio": loop.damping_ratio,
        "distance": loop.distance,
        "near": [int(k) for k in loop.near],
        "worst_damping": loop.worst_damping,
        "worst_damping_continuous": f.ideal.worst_damping,
        "law": {fact.key: fact.value for fact in f.law},
        "files": [],
    }
    if f.locus is not None:
        data |= {key: f.locus.attrs[key] for key in ("best_gain", "best_damping", "leak_rad_s")}
    if f.random is not None:
        data |= random.data(f.random.controlled)
        if f.random.passive is not None:
            data |= {f"passive_{name}": values for name, values in random.data(f.random.passive).items()}
    if f.run is not None:
        run = f.run
        data["run"] = {
            "shaking": {fact.key: fact.value for fact in f.shaking},
            "axis": run.axis.values.tolist(),
            "saturated": run.attrs["saturated"],
            **{f"{name}_{case}": run[name].sel(case=case).values for name in RMS for case in ("controlled", "passive")},
        }
    return data
