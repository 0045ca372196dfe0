"""A path, planned or given, as a study."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from flexapod import plots
from flexapod.certificates.certificate import Certificate
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import told_apart
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.load_limits import load_excess
from flexapod.paths.analysis import PathIndex
from flexapod.paths.plan import Plan
from flexapod.paths.trajectory import Trajectory
from flexapod.report.numbers import DASH, pose_numbers, pose_words, shown
from flexapod.report.studies import least_index, path_legs, path_motors, path_point
from flexapod.report.studies.certificate import certificate_data, one_line
from flexapod.report.study import Drawing, Row, Section, Study

#: What is said of the figure of motors.
_PLANE = (
    "Each line is a motor along the path, and each dot its RMS torque at its RMS speed. The motor drives where speed "
    "and torque have one sign, and brakes where they have not. Peak torque bounds lines, continuous torque dots."
)


_NUMBERS = re.compile(r"\bleg \d|[-+]?\d[\d.e+-]*")


@dataclass(frozen=True)
class PathFindings:
    """What was computed about a path. size: m that a radian counts as. beside, plan, plane: of a planned path.

    cases: with each payload. motors, case_motors: of a design with a drive, as it is and with each payload."""

    path: Trajectory
    along: PathIndex
    loads: xr.Dataset
    size: float
    beside: PathIndex | None = None
    plan: Plan | None = None
    plane: xr.Dataset | None = None
    certificate: Certificate | None = None
    cases: xr.Dataset | None = None
    motors: xr.Dataset | None = None
    case_motors: xr.Dataset | None = None


def study(hexapod: Hexapod, f: PathFindings, waypoints: str | None = None) -> Study:
    """The study of a path. waypoints: a planned path as the text of a file."""
    ends, given = (pose_words(f.path.waypoints[which]) for which in (0, -1)), len(f.path.times[_given(f.path)])
    what = f"planned from {' to '.join(ends)}" if f.plan else "as given"
    drawings = _drawings(f)
    files: dict[str, Any] = {f"path-{one.name}.png": one.draw for one in sorted(drawings, key=_order)}
    motors = _motors(hexapod, f)
    files |= {f"path-{one.name}.png": one.draw for part in motors for one in part.items if isinstance(one, Drawing)}
    if waypoints is not None:
        files["waypoints.csv"] = lambda: waypoints
    return Study(
        hexapod=hexapod,
        subject="path",
        about=f"A path of {given} waypoints, {what}. One radian counts as {shown(f.size, 3)} m of length.",
        data=_data(hexapod, f),
        rows=_rows(hexapod, f),
        sections=[
            *(Section(one.title, [one]) for one in drawings),
            Section("Legs", path_legs.tables(f.loads)),
            Section("Motion", [path_point.table(f.loads)]),
            *motors,
            *_cases(f),
        ],
        cautions=[
            *least_index.cautions(hexapod, f.along.minimum_pose, f.along.samples.attrs["joint"]),
            *cautions(f),
            *leg_cautions(hexapod, f.loads, f.motors),
            *_case_cautions(hexapod, f),
        ],
        files={
            **files,
            "path.csv": lambda: _series(f),
            "path.html": None,
        },
    )


def _given(path: Trajectory) -> slice:
    """The waypoints that were given: not the home poses that a path is joined to."""
    return slice(None) if path.joined is None else slice(1, -1)


def _motors(hexapod: Hexapod, f: PathFindings) -> list[Section]:
    """The motors, of a design with a drive."""
    if (motors := f.motors) is None:
        return []
    drawn, said = _hardest(motors, f.case_motors, "motor_torque")
    plane = Drawing("motors", "Torque and speed of the motors", lambda: plots.path.motors(drawn), f"{_PLANE}{said}")
    return [Section("Motors", [plane, *path_motors.tables(hexapod, motors)])]


def _hardest(own: xr.Dataset, cases: xr.Dataset | None, variable: str) -> tuple[xr.Dataset, str]:
    """What a figure shows, of the payload with the largest of a variable if it is more than the design's, and words."""
    if cases is None:
        return own, ""
    peaks = [float(np.abs(cases[variable].sel(case=name)).max()) for name in cases.case.values]
    name = str(cases.case.values[int(np.argmax(peaks))])
    if name == str(cases.case.values[0]):
        return own, " Drawn is the design without payloads, which needs most."
    return cases.sel(case=name), f" Drawn is the payload {name}, which needs most of all."


def _cases(f: PathFindings) -> list[Section]:
    """The payloads, where there are any."""
    if f.cases is None:
        return []
    motors = [] if f.case_motors is None else path_motors.case_tables(f.case_motors)
    return [Section("Payloads", [*path_legs.case_tables(f.cases), *motors])]


def _series(f: PathFindings) -> str:
    loads, motors = (f.loads, f.motors) if f.cases is None else (f.cases, f.case_motors)
    return path_legs.series(f.path, loads if motors is None else loads.merge(motors[list(path_motors.SERIES)]))


def _drawings(f: PathFindings) -> list[Drawing]:
    where = f"The least, {shown(f.along.minimum)} rad/s, is at {f.along.minimum_time:.4g} s. "
    note = "Dashed: the straight line between the same poses." if f.beside else ""
    words = (
        "The plane through start, goal and the point of the path that lies farthest from the straight line; elsewhere "
        "the path is shown projected on it. Rotations count as length."
    )
    forces = (
        "Forces from the full dynamics; positive pushes the platform from the base. Thin lines: the forces at rest."
    )
    title = "The stability index along the path"
    drawings = [Drawing("index", title, lambda: plots.path.index_along(f.along, f.beside), where + note)]
    if (plane := f.plane) is not None:
        drawings.append(Drawing("plane", "Round the weak region", lambda: plots.path.plan_map(plane), words))
    hardest, said = _hardest(f.loads, f.cases, "leg_force")
    return [*drawings, Drawing("loads", "Leg forces and travel", lambda: plots.path.loads(hardest), f"{forces}{said}")]


def _order(drawing: Drawing) -> int:
    return ("index", "loads", "plane").index(drawing.name)


def cautions(f: PathFindings) -> list[Caution]:
    """What to beware of on the path."""
    rest = f.loads.attrs["caution"] if f.plan is None else ""
    found = [Caution("rest", f"{rest} On the command line: --ends free, --ends periodic.")] if rest else []
    if f.along.below and f.along.bound is not None:
        spans = ", ".join(f"{a:.4g} to {b:.4g} s" for a, b in f.along.below)
        text = f"The index lies below the bound of {f.along.bound:.5g} rad/s from {spans}."
        found.append(Caution("below_bound", text, {"bound": f.along.bound}))
    outside = ~f.loads.within_limits.values
    if outside.any():
        first = float(f.loads.time.values[outside][0])
        text = f"The path leaves the design's limits for {outside.mean():.0%} of it, first at {first:.4g} s."
        found.append(Caution("limit", text, {"share": float(outside.mean()), "first": first}))
    return found


def leg_cautions(hexapod: Hexapod, loads: xr.Dataset, motors: xr.Dataset | None) -> list[Caution]:
    """What legs and motors exceed."""
    found = load_cautions(hexapod, loads)
    return found if motors is None else [*found, *path_motors.cautions(hexapod, loads, motors)]


def load_cautions(hexapod: Hexapod, loads: xr.Dataset) -> list[Caution]:
    """Which legs exceed limits of force, speed, acceleration and power on the way, and by how much at most."""
    found = []
    values = (loads[name].values for name in ("leg_force", "leg_rate", "leg_acceleration"))
    for name, unit, value, least, most in load_excess(hexapod, *values):
        for side, over, bound in (("below", least - value, least), ("above", value - most, most)):
            if over.max() <= 0:
                continue
            at, leg = np.unravel_index(int(np.argmax(over)), over.shape)
            told, limit = told_apart(float(value[at, leg]), float(bound))
            legs = ", ".join(str(one) for one in loads.leg.values[(over > 0).any(axis=0)])
            when = f"{loads.time.values[at]:.4g} s"
            text = (
                f"The {name} of leg {loads.leg.values[leg]} is {told} {unit} at {when}, {side} the limit of {limit} "
                f"{unit}; legs beyond it on the path: {legs}."
            )
            found.append(Caution("load_limit", text, {"value": float(value[at, leg]), "limit": float(bound)}))
    return found


def _case_cautions(hexapod: Hexapod, f: PathFindings) -> list[Caution]:
    """The same with each payload."""
    if f.cases is None:
        return []
    told: dict[tuple[str, str], list[tuple[str, Caution]]] = {}
    for name in map(str, f.cases.case.values[1:]):
        motors = None if f.case_motors is None else f.case_motors.sel(case=name)
        own = [Caution("payload", text)] if (text := str(f.cases.warning.sel(case=name).values)) else []
        for one in [*own, *leg_cautions(hexapod, f.cases.sel(case=name), motors)]:
            alike = _NUMBERS.sub("", one.text).partition(";")[0] if one.numbers else one.text
            told.setdefault((one.code, alike), []).append((name, one))
    return [_of_payloads(each) for each in told.values()]


def _of_payloads(alike: list[tuple[str, Caution]]) -> Caution:
    """Cautions that differ in numbers alone, as one: with which payloads, and that of the worst."""
    names = [name for name, _ in alike]
    worst, one = max(alike, key=lambda item: abs(item[1].numbers.get("value", 0.0)))
    if len(alike) == 1:
        return Caution(one.code, f"With the payload {worst}: {one.text}", one.numbers)
    which = f"; with {worst}, the worst" if one.numbers else ""
    return Caution(one.code, f"With the payloads {', '.join(names)}{which}: {one.text}", one.numbers)


def _rows(hexapod: Hexapod, f: PathFindings) -> list[Row]:
    index, bound, force = f.along, f.along.bound, float(f.loads.peak_force.max())
    where = f"rad/s at {index.minimum_time:.4g} s, {pose_words(index.minimum_pose)}"
    travel = f"{1e3 * float(f.loads.stroke.max()):.4g} mm, force up to {force:.5g} N"
    rows = [
        Row("Least index on the path", index.minimum, "rad/s", on="page"),
        Row("Bound", bound or DASH, "rad/s" if bound else "none given", on="page"),
        Row("Weighted mean index", index.weighted_mean, "rad/s", on="page"),
        Row("Duration", f.path.duration, "s", 3, on="page"),
        Row("Length", f.path.length(f.size), "m", 3, on="page"),
        Row("Largest leg force", force, "N", on="page"),
        Row("least index", f"{index.minimum:.5g}", where, on="terminal"),
        Row("weighted mean index", f"{index.weighted_mean:.5g}", "rad/s", on="terminal"),
        Row("legs: travel up to", travel, on="terminal"),
        *([] if f.motors is None else path_motors.rows(hexapod, f.motors)),
    ]
    if bound is not None:
        words = "above it all along" if index.above else "BELOW it in places"
        rows.insert(7, Row("bound", f"{bound:.5g}", f"rad/s: {words}", on="terminal"))
    if f.certificate is not None:
        rows.insert(-1, Row("proved all along", one_line(f.certificate)))
    if f.plan is not None:
        p = f.plan
        beside = f"m; the straight line has {p.straight_length:.4g} m and an index down to {p.straight_least_index:.4g}"
        rows.insert(-1, Row("length", f"{p.length:.4g}", f"{beside} rad/s", on="terminal"))
    return rows


def _data(hexapod: Hexapod, f: PathFindings) -> dict[str, Any]:
    index, loads, plan = f.along, f.loads, f.plan
    data: dict[str, Any] = {
        **origin(hexapod),
        "duration_s": f.path.duration,
        "length_m": f.path.length(f.size),
        "radian_as_m": f.size,
        "least_index_rad_s": index.minimum,
        "least_index_at_s": index.minimum_time,
        "least_index_pose_m_deg": pose_numbers(index.minimum_pose),
        "bound_rad_s": index.bound,
        "above_bound": None if index.bound is None else index.above,
        "below_bound_s": index.below,
        "weighted_mean_index_rad_s": index.weighted_mean,
        "within_limits": bool(loads.within_limits.all()),
        "loads_within_limits": bool(loads.loads_within_limits.all()),
        **path_legs.data(loads),
        **path_point.data(loads),
        "waypoints_s": f.path.times[_given(f.path)],
        "waypoints_m_deg": [pose_numbers(f.path.waypoints[i]) for i in range(len(f.path.times))][_given(f.path)],
        "files": [],
    }
    if f.cases is not None:
        data["payloads"] = {
            "case": [str(name) for name in f.cases.case.values],
            "mass_kg": f.cases.mass.values,
            "least_index_rad_s": f.cases.least_index.values,
            **path_legs.data(f.cases),
        }
    if f.motors is not None:
        data["motors"] = path_motors.data(f.motors)
    if f.case_motors is not None:
        data["payloads"]["motors"] = path_motors.data(f.case_motors)
    if f.certificate is not None:
        data["certificate"] = certificate_data(f.certificate)
    if plan is not None:
        data["plan"] = {
            "straight_length_m": plan.straight_length,
            "straight_least_index_rad_s": plan.straight_least_index,
            "least_margin": plan.margin,
            "batches": plan.batches,
        }
    return data
