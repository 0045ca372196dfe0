"""The envelope of a machine as a study: its table as in a specification, pairs of axes, the largest box."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexapod import plots
from flexapod.conventions import AXES, TRANSLATIONS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.point_motion import point_words
from flexapod.report.numbers import DASH, pose_numbers, pose_words, six_words
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table
from flexapod.tables import written_table
from flexapod.workspace.axis_speeds import Fastest
from flexapod.workspace.envelope import AxisTravel, Envelope, PairTravel


def study(hexapod: Hexapod, found: Envelope, bounded: bool) -> Study:
    """The study of an envelope. bounded: whether the index or cond(H) was bounded."""
    words = point_words(found.point, found.point_name)
    point = f" of the platform's point {words}" if words else ""
    captions = (
        "Straight motions from home end on the blue line, at the first pose that a limit or a singular pose stops."
    )
    drawing = Drawing(
        "pairs", "Two axes at once", lambda: plots.envelope.pairs(found, hexapod.name), captions, wide=True
    )
    return Study(
        hexapod=hexapod,
        subject="envelope",
        about=f"Motions{point} from {pose_words(found.home)}.",
        data=_data(hexapod, found),
        rows=rows(found),
        sections=[
            Section("Each axis", tables(found)),
            Section("Two axes at once", [drawing, _pairs(found)]),
        ],
        cautions=_cautions(hexapod, found, bounded),
        files={
            "envelope-pairs.png": drawing.draw,
            "envelope.csv": lambda: table(found),
            "envelope-pairs.csv": lambda: pair_table(found),
            "envelope.html": None,
        },
    )


def table(found: Envelope) -> str:
    """The specification of each axis as the text of a CSV file: m and rad."""
    axes = found.axes
    columns: dict[str, Any] = {"axis": np.array([axis.axis for axis in axes]), "unit": np.array(_units())}
    columns |= {"least": np.array([axis.least for axis in axes]), "most": np.array([axis.most for axis in axes])}
    columns["stopped_at_least"] = np.array([" and ".join(axis.stopped_at_least) for axis in axes])
    columns["stopped_at_most"] = np.array([" and ".join(axis.stopped_at_most) for axis in axes])
    columns["half_range_in_box"] = found.box.half
    columns["least_index_rad_per_s"] = np.array([axis.least_index for axis in axes])
    for name in ("velocity", "acceleration"):
        speeds: list[Fastest] = [getattr(axis, name) for axis in axes]
        columns[f"{name}_per_s{'2' * (name != 'velocity')}"] = np.array([_finite(speed.value) for speed in speeds])
        columns[f"{name}_stopped_by"] = np.array([speed.stops for speed in speeds])
        columns[f"least_{name}_on_the_axis"] = np.array([_finite(speed.least) for speed in speeds])
    return written_table(columns)


def pair_table(found: Envelope) -> str:
    """The boundaries of all pairs of axes as the text of a CSV file: m and rad."""
    pairs = [(pair, row, stops) for pair in found.pairs for row, stops in zip(pair.boundary, pair.stopped, strict=True)]
    columns = {
        "first": np.array([pair.axes[0] for pair, _, _ in pairs]),
        "second": np.array([pair.axes[1] for pair, _, _ in pairs]),
        "first_m_or_rad": np.array([row[0] for _, row, _ in pairs]),
        "second_m_or_rad": np.array([row[1] for _, row, _ in pairs]),
        "stopped_by": np.array([" and ".join(stops) for _, _, stops in pairs]),
    }
    return written_table(columns)


def _units() -> list[str]:
    return ["m" if axis in TRANSLATIONS else "rad" for axis in AXES]


def _finite(value: float) -> float:
    return value if np.isfinite(value) else float("nan")


def _shown(values: Array) -> Array:
    """Six numbers in mm and degrees."""
    return np.concatenate([1e3 * values[:3], np.degrees(values[3:])])


def rows(found: Envelope) -> list[Row]:
    """The largest box."""
    box = found.box
    half = f"\u00b1 {six_words(box.half)}"
    stops = f"stopped by {_words(box.stopped)}" if box.stopped else "nothing stops it"
    return [
        Row("Largest box", half, "", note=f"{stops}", on="page"),
        Row("Least index in the box", box.least_index, "rad/s", on="page"),
        Row("largest box in combination:", half, on="terminal"),
        Row("  stopped by", f"{_words(box.stopped)} at {six_words(box.at)}", on="terminal"),
        Row("  least index in it", f"{box.least_index:.5g}", "rad/s", on="terminal"),
    ]


def _words(stops: tuple[str, ...]) -> str:
    """Limits in words, the legs of the same limit together: "greatest length of legs 2, 5"."""
    if not stops:
        return DASH
    legs: dict[str, list[str]] = {}
    for stop in stops:
        kind, _, leg = stop.rpartition(" of leg ")
        legs.setdefault(kind or stop, []).extend([leg] if kind else [])
    return "; ".join(
        f"{kind} of leg{'s' * (len(of) > 1)} {', '.join(sorted(of))}" if of else kind for kind, of in legs.items()
    )


def tables(found: Envelope) -> list[Table]:
    """Motions along each axis, and how fast they may be."""
    axes = found.axes
    units = ["mm" if axis in TRANSLATIONS else "deg" for axis in AXES]
    travel = [
        Column("axis", [axis.axis for axis in axes]),
        Column("from", _shown(np.array([axis.least for axis in axes]))),
        Column("to", _shown(np.array([axis.most for axis in axes]))),
        Column("unit", units),
        Column("stopped below by", [_words(axis.stopped_at_least) for axis in axes]),
        Column("stopped above by", [_words(axis.stopped_at_most) for axis in axes]),
        Column("least index", [axis.least_index for axis in axes], "rad/s"),
    ]
    shown = [Table(travel, "Each axis alone, from home. The index is the least over the travel.")]
    speeds = [_speed(axes, name) for name in ("velocity", "acceleration")]
    if any(np.isfinite(getattr(axis, name).value) for axis in axes for name in ("velocity", "acceleration")):
        columns = [travel[0], *(column for pair in speeds for column in pair)]
        note = (
            "At home, the lesser of both ways: velocity is steady, acceleration from rest. Least: over the travel "
            "along the axis."
        )
        shown.append(Table(columns, note, title="How fast"))
    return shown


def _speed(axes: tuple[AxisTravel, ...], name: str) -> list[Column]:
    found: list[Fastest] = [getattr(axis, name) for axis in axes]
    unit = "mm/s, deg/s" if name == "velocity" else "mm/s\u00b2, deg/s\u00b2"
    return [
        Column(name, _shown(np.array([speed.value for speed in found])), unit),
        Column("least", _shown(np.array([speed.least for speed in found])), unit),
        Column(f"{name} stopped by", [speed.stops or DASH for speed in found]),
    ]


def _pairs(found: Envelope) -> Table:
    def ends(pair: PairTravel) -> str:
        return _words(tuple(dict.fromkeys(stop for stops in pair.stopped for stop in stops)))

    columns = [
        Column("pair", [f"{pair.axes[0]}, {pair.axes[1]}" for pair in found.pairs]),
        Column("part that combines", [100 * pair.share for pair in found.pairs], "%", 3),
        Column("stopped by", [ends(pair) for pair in found.pairs], on="page"),
    ]
    note = "The part of both travels, each to both sides, that may be combined in any way."
    return Table(columns, note, title="Two axes at once")


def _cautions(hexapod: Hexapod, found: Envelope, bounded: bool) -> list[Caution]:
    told = []
    if not hexapod.limits.given and not bounded:
        text = (
            "The design limits neither leg lengths nor joint angles nor distances: only singular poses stop motions. "
            "Give [limits], or a bound of the index or of cond(H)."
        )
        told.append(Caution("no_limits", text, {}))
    loose = [axis.axis for axis in found.axes if not (axis.stopped_at_least and axis.stopped_at_most)]
    if loose:
        text = (
            f"Nothing stops {', '.join(loose)} within half a turn, or four leg lengths; there it is no longer followed."
        )
        told.append(Caution("not_stopped", text, {"axes": len(loose)}))
    return told


def _data(hexapod: Hexapod, found: Envelope) -> dict[str, Any]:
    def speed(one: Fastest) -> dict[str, Any]:
        return {"value": one.value, "stopped_by": one.stops, "least_on_the_axis": one.least}

    axes = {
        axis.axis: {
            "unit": unit,
            "least": axis.least,
            "most": axis.most,
            "stopped_at_least": list(axis.stopped_at_least),
            "stopped_at_most": list(axis.stopped_at_most),
            "least_index_rad_s": axis.least_index,
            "velocity_per_s": speed(axis.velocity),
            "acceleration_per_s2": speed(axis.acceleration),
        }
        for axis, unit in zip(found.axes, _units(), strict=True)
    }
    box = found.box
    return {
        **origin(hexapod),
        "home_m_deg": pose_numbers(found.home),
        "point_m": found.point,
        "point": found.point_name,
        "axes": axes,
        "box": {
            "half_ranges_m_rad": box.half,
            "share_of_proportions": box.share,
            "stopped_at_m_rad": box.at,
            "stopped_by": list(box.stopped),
            "least_index_rad_s": box.least_index,
        },
        "pairs": [
            {"axes": list(pair.axes), "share": pair.share, "boundary_m_rad": pair.boundary} for pair in found.pairs
        ],
    }
