"""An optimal design, and a Pareto front, as studies."""

from __future__ import annotations

import numpy as np

from flexapod import plots
from flexapod.conventions import TWO_PI, JointModel
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.load_limits import motion_limits_words
from flexapod.optimisation.design_results import Check, OptimalDesign, VariableRange
from flexapod.optimisation.pareto import ParetoFront
from flexapod.report.numbers import DASH, brief, file_name, percent, shown, six_words
from flexapod.report.studies import least_index
from flexapod.report.studies.certificate import certificate_data, one_line
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table


def optimal(found: OptimalDesign, objective: str, joint: JointModel = "universal") -> Study:
    """What was found, from what, and how it was verified. objective: in words."""
    worst = found.verification.pose
    where = "" if worst is None else f" It is least at {six_words(worst)}."
    plan = Drawing("plan", "The two designs", lambda: plots.optimisation.plan(found),
                   f"Both at home. Raised: {objective}.{where}")  # fmt: skip
    search = Drawing("search", "The search", lambda: plots.optimisation.search(found),
                     "One mark a trial; constraints as above.")  # fmt: skip
    sections = [Section(plan.title, [plan]), Section("Variables", [_variables(found)])]
    if found.verification.checks:
        sections.append(Section("Constraints", [_constraints(found)]))
    kept = found.hexapod is found.start
    name = file_name(f"{found.start.name}-optimised")
    return Study(
        hexapod=found.hexapod,
        subject="optimal design",
        about=f"{_about(found)}: {objective}.",
        data=_optimal_data(found, objective),
        rows=_optimal_rows(found),
        sections=[*sections, Section(search.title, [search])],
        cautions=[*_cautions(found), *least_index.cautions(found.hexapod, worst, joint)],
        files={
            **({} if kept else {f"{name}.toml": found.hexapod.to_toml}),
            f"{name}.html": None,
            f"{name}.png": plan.draw,
        },
    )


def _about(found: OptimalDesign) -> str:
    """What the design is to the one begun with, said first."""
    start = found.start.name
    if found.hexapod is found.start:
        return f"No design better than {start} was found"
    if not found.improved:
        return f"Begun with {start}, and not verified"
    if found.start_breaks:
        return f"{start} itself is not allowed ({'; '.join(found.start_breaks)}); this design keeps every constraint"
    return f"Better than {start}"


def _optimal_rows(found: OptimalDesign) -> list[Row]:
    by = f" ({100 * found.gain:+.3g} %)" if np.isfinite(found.gain) else ""
    gain = f"rad/s{by}, verified at {found.verification.points} poses"
    start = "rad/s, but it breaks a constraint" if found.start_breaks else "rad/s"
    proof = found.verification.certificate
    proved = [] if proof is None else [Row("Index, proved", one_line(proof))]
    return [
        Row("Index, verified", found.index, f"rad/s = {shown(found.index / TWO_PI, 4)} Hz", 5, on="page"),
        Row("Design begun with", found.start_index, start, 5, on="page"),
        Row("Gain", percent(found.gain) if np.isfinite(found.gain) else DASH, "of the index", on="page"),
        Row("Trials", str(found.history.sizes["trial"]), f"in {brief(found.seconds, 3)} s", on="page"),
        Row("index", f"{found.start_index:.6g} -> {found.index:.6g}", gain, on="terminal"),
        *proved,
    ]


def _cautions(found: OptimalDesign) -> list[Caution]:
    cautions = _begun(found, found.start.name)
    if words := motion_limits_words(found.hexapod.limits):
        cautions.append(Caution("motion_limits", words))
    if not found.verification.holds:
        broken = ", ".join(check.name for check in found.verification.checks if not check.kept)
        cautions.append(Caution("broken", f"The dense sweep breaks: {broken}. Search with more poses."))
    if found.coincident > 1:
        text = f"{found.coincident} frequencies meet at the worst pose: to raise the index, all of them must rise."
        cautions.append(Caution("coincident", text, {"frequencies": found.coincident}))
    if found.at_bounds:
        text = f"On their bounds: {', '.join(found.at_bounds)}. Wider bounds may give more."
        cautions.append(Caution("at_bounds", text))
    return cautions


def _begun(found: OptimalDesign | ParetoFront, start: str) -> list[Caution]:
    """What both kinds of search say of their beginning and of their way."""
    cautions = []
    if found.start_breaks:
        text = f"The design begun with is not allowed: {'; '.join(found.start_breaks)}."
        cautions.append(Caution("start_breaks", text))
    outside = [_outside(name, one) for name, one in found.ranges.items() if one.outside]
    if outside:
        text = f"The search cannot reach {start} itself: {'; '.join(outside)}. Widen the bounds to begin there."
        cautions.append(Caution("outside", text))
    if found.unmoved:
        cautions.append(Caution("unmoved", f"No variable moves: {', '.join(found.unmoved)}."))
    cautions += [Caution("failure", text) for text in found.failures]
    if found.stopped:
        trials = found.history.sizes["trial"]
        cautions.append(Caution("stopped", f"The search was cut short after {trials} trials: its best so far.",
                                {"trials": trials}))  # fmt: skip
    return cautions


def _outside(name: str, one: VariableRange) -> str:
    before, low, high = (brief(number, 6) for number in (one.before, one.low, one.high))
    return f"{name} is {before}, its bounds are {low} to {high} {one.unit}".rstrip()


def _variables(found: OptimalDesign) -> Table:
    ranges = found.ranges.values()
    return Table(
        [
            Column("variable", list(found.ranges)),
            Column("unit", [one.unit for one in ranges]),
            Column("before", [one.before for one in ranges], digits=6, marked=[one.outside for one in ranges]),
            Column("least", [brief(one.low, 6) for one in ranges]),
            Column("largest", [brief(one.high, 6) for one in ranges]),
            Column("now", list(found.variables.values()), digits=6),
        ]
    )


def _constraints(found: OptimalDesign) -> Table:
    checks: tuple[Check, ...] = found.verification.checks
    columns = [
        Column("constraint", [check.name for check in checks]),
        Column("unit", [check.unit for check in checks]),
        Column("before", [check.value for check in found.start_checks], digits=5),
        Column("now", [check.value for check in checks], digits=5, marked=[not check.kept for check in checks]),
        Column("bound", [f"at {check.side} {shown(check.bound, 5)}" for check in checks]),
        Column("margin", [percent(check.margin, 1) for check in checks]),
    ]
    note = f"Extremes over {found.verification.points} poses of every workspace that the search has not seen."
    return Table(columns, note)


def _optimal_data(found: OptimalDesign, objective: str) -> dict[str, object]:
    return {
        **origin(found.hexapod),
        "objective": objective,
        **_begun_data(found),
        "improved": found.improved,
        "index_rad_s": found.index,
        "start_index_rad_s": found.start_index,
        "searched_index_rad_s": found.searched_index,
        "gain": found.gain,
        "variables": found.variables,
        "at_bounds": found.at_bounds,
        "coincident_frequencies": found.coincident,
        "verified_poses": found.verification.points,
        "worst_pose_m_rad": found.verification.pose,
        "constraints": [vars(check) for check in found.verification.checks],
        "trials": found.history.sizes["trial"],
        "gradient_evaluations": found.evaluations,
        "seconds": found.seconds,
        "certificate": certificate_data(found.verification.certificate),
    }


def _begun_data(found: OptimalDesign | ParetoFront) -> dict[str, object]:
    return {
        "start_breaks": found.start_breaks,
        "unmoved": found.unmoved,
        "failures": found.failures,
        "cut_short": found.stopped,
        "variable_ranges": {name: one._asdict() for name, one in found.ranges.items()},
    }


def front(found: ParetoFront, objective: str) -> Study:
    """A Pareto front, its figure and its designs. objective: in words."""
    best = int(np.argmax(found.index))
    by_name = dict(zip(found.names, found.variables.T, strict=True))
    columns = [
        Column("design", [str(k + 1) for k in range(len(found.designs))]),
        Column("index", found.index, "rad/s", 5),
        Column(found.name, found.against, found.unit, 5),
        *(Column(name, values, found.ranges[name].unit, 5) for name, values in by_name.items()),
    ]
    drawing = Drawing("front", f"Index against {found.name}", lambda: plots.optimisation.front(found),
                      "Of the designs on the line none is better in both.")  # fmt: skip
    name = file_name(found.hexapod.name)
    data = {
        "objective": objective,
        **_begun_data(found),
        "against": found.name,
        "unit": found.unit,
        "start": {"index_rad_s": found.start[0], "against": found.start[1]},
        "index_rad_s": found.index,
        "against_values": found.against,
        "variables": by_name,
        "trials": found.history.sizes["trial"],
    }
    return Study(
        hexapod=found.hexapod,
        subject="Pareto front",
        about=f"Index against {found.name}: {objective}.",
        data=data,
        rows=[
            Row("Highest index", found.index[best], f"rad/s at {shown(found.against[best], 4)} {found.unit}", 5),
            Row("Design begun with", found.start[0], f"rad/s at {shown(found.start[1], 4)} {found.unit}", 5),
            Row("Designs on the front", str(len(found.designs)), on="page"),
            Row("Trials", str(found.history.sizes["trial"]), on="page"),
        ],
        sections=[
            Section(drawing.title, [drawing]),
            Section("Designs", [Table(columns)]),
        ],
        cautions=_begun(found, found.hexapod.name),
        files={
            f"{name}-front.html": None,
            f"{name}-front.png": drawing.draw,
            **{f"{file_name(one.name)}.toml": one.to_toml for one in found.designs},
        },
    )
