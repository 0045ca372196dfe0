"""The short report of a control law on a machine at a pose."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from flexapod.control.closed_loop_poles import ClosedLoop
from flexapod.conventions import TWO_PI
from flexapod.design.hexapod import Hexapod
from flexapod.plots import control
from flexapod.pose import Pose
from flexapod.report import html
from flexapod.report.numbers import DASH, pose_words, shown


class ControlFindings(NamedTuple):
    """All that is said about a control law. continuous, sampled: its closed loops; gains, locus, run: where made."""

    pose: Pose
    continuous: ClosedLoop
    sampled: ClosedLoop
    recommended: float
    response: xr.Dataset
    gains: xr.Dataset | None = None
    locus: xr.Dataset | None = None
    run: xr.Dataset | None = None
    axis: str = "z"


def page(hexapod: Hexapod, f: ControlFindings) -> str:
    """The page as HTML."""
    cards = [
        ("Worst damping ratio, sampled", shown(f.sampled.worst_damping, 3), ""),
        ("without sampling", shown(f.continuous.worst_damping, 3), ""),
        ("Sampling time", shown(1e3 * (f.sampled.controller.dt or np.nan), 3), "ms"),
        ("at most", shown(1e3 * f.recommended, 3), "ms"),
        ("RMS acceleration, control over none", *_lowered(f)),
    ]
    subtitle = f"{f.continuous.controller.name} at {pose_words(f.pose)}, on the exact tangent."
    sections = [html.beware(cautions(f)), _poles(f), _gains(f), _locus(f), _response(f), _run(f)]
    return html.short(hexapod, "control", subtitle, cards, sections)


def figures(f: ControlFindings) -> dict[str, Callable[[], Figure]]:
    """The report's figures by name, each as a function that draws it."""
    found: dict[str, Callable[[], Figure]] = {}
    gains, locus, run = f.gains, f.locus, f.run
    if gains is not None:
        found["gains"] = lambda: control.gain_map(gains)
    if locus is not None:
        found["locus"] = lambda: control.root_locus(locus)
    found["transmissibility"] = lambda: control.isolation(f.response, ("x", "z"))
    if run is not None:
        found["run"] = lambda: control.controlled_run(run, f.axis)
    return found


def cautions(f: ControlFindings) -> list[str]:
    """What to beware of in the loop."""
    found = []
    dt = f.sampled.controller.dt
    if dt is not None and dt > f.recommended * (1 + 1e-9):
        found.append(
            f"The sampling time of {1e3 * dt:.4g} ms is above 2\u03c0/(20 \u03c9) = {1e3 * f.recommended:.4g} ms, with "
            "\u03c9 the highest natural frequency; sample faster."
        )
    if f.sampled.near:
        found.append(
            f"{len(f.sampled.near)} poles of the closed loop lie within 10 % of a natural frequency; there the machine "
            "may vibrate more than without control."
        )
    if f.run is not None and f.run.attrs["saturated"] > 0:
        found.append(f"The actuators were at their limit in {f.run.attrs['saturated']:.1%} of the samples.")
    return found


def _lowered(f: ControlFindings) -> tuple[str, str]:
    if f.run is None:
        return DASH, "not run"
    rms = f.run.rms_acceleration.sel(axis=f.axis)
    return shown(float(rms.sel(case="controlled") / rms.sel(case="passive")), 3), f"along {f.axis}"


def _poles(f: ControlFindings) -> str:
    rows = []
    upper = [k for k, p in enumerate(f.sampled.pole) if p.imag >= 0]
    for number, k in enumerate(upper, start=1):
        pole = f.sampled.pole[k]
        near = f'<td class="over">{shown(f.sampled.distance[k], 3)}</td>'
        far = shown(f.sampled.distance[k], 3)
        rows.append(
            [
                f"{number}",
                shown(pole.real, 5),
                shown(pole.imag, 5),
                shown(abs(pole) / TWO_PI, 4),
                shown(f.sampled.damping_ratio[k], 3),
                near if k in f.sampled.near else far,
            ]
        )
    head = ["pole", "real, rad/s", "imaginary, rad/s", "|p|, Hz", "damping ratio", "distance to a natural frequency"]
    omega = ", ".join(shown(w, 5) for w in f.sampled.omega)
    note = (
        f"Poles of the sampled loop as s = log(z)/dt, upper half plane. Natural frequencies without control: {omega} "
        "rad/s. Distances are relative; those below 0.1 are marked."
    )
    return "<h2>Closed loop</h2>\n" + html.table(head, rows, note)


def _gains(f: ControlFindings) -> str:
    words = "Each pair of gains by the distance of its poles to the natural frequencies and by its worst damping."
    return _drawn(f, "gains", "Which gains", words)


def _locus(f: ControlFindings) -> str:
    words = "Poles over the gain, from the machine's own (crosses) to the zeros (circles), and the least damping."
    return _drawn(f, "locus", "Root locus", words)


def _response(f: ControlFindings) -> str:
    words = "Displacement of the platform per displacement of the base, of the tangent, with the sampled controller."
    return _drawn(f, "transmissibility", "Transmissibility", words)


def _run(f: ControlFindings) -> str:
    if f.run is None:
        return ""
    words = (
        "The full equations of motion on a shaking base, with sampled measurement, held forces and what the hardware "
        "leaves of them. Bars: root mean squares over those without control; marks: what the tangent predicts."
    )
    rows = []
    for axis in f.run.axis.values:
        at = f.run.sel(axis=axis)
        unit = str(at.acceleration_unit.values).replace("2", "\u00b2")
        values = [
            at[n].sel(case=c)
            for c in ("passive", "controlled")
            for n in ("rms_acceleration", "predicted_rms_acceleration")
        ]
        rows.append([str(axis), *(f"{shown(float(v), 3)} {unit}" for v in values)])
    head = ["axis", "no control", "tangent", "control", "tangent"]
    return _drawn(f, "run", "On the moving base", words) + html.table(
        head, rows, "Root mean square absolute acceleration."
    )


def _drawn(f: ControlFindings, name: str, heading: str, words: str) -> str:
    draw = figures(f).get(name)
    return html.drawing(draw, name, heading, words) if draw else ""
