"""A certificate as a study: one page that says what is proved, of what, what it leaves out, and how to check it."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexapod.certificates.certificate import Certificate
from flexapod.certificates.largest import CertifiedBox
from flexapod.conventions import AXES, TWO_PI
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import Caution
from flexapod.report.numbers import brief, file_name, percent, shown, six_words
from flexapod.report.studies import least_index
from flexapod.report.study import Column, Row, Section, Study, Table
from flexapod.workspace.proof import Boxes

MOST = 12  # boxes that the page lists
_TITLES = {
    "index": "Least natural frequency",
    "regular": "No singular pose",
    "condition": "Condition number",
    "limits": "Limits kept",
}
_OTHER = {
    "index": "Other poses than those of the region, other modes than the lowest, and what happens in fast motion. What "
    "the model leaves out: plates are rigid, joints have no play, and the frequency is that of the undamped small "
    "vibration about a pose, in which weight and preload do not count.",
    "limits": "Other poses than those of the region, forces in the legs, and limits of a motion (rates, accelerations, "
    "power). What the model leaves out: plates and legs are rigid, and joints have no play.",
}
_GEOMETRY = (
    "Other poses than those of the region, and stiffness and mass, on which this does not depend. What the model "
    "leaves out: plates and legs are rigid, and joints have no play."
)
_LEAVES_OUT = (
    "How well the numbers of the design fit the machine: they count as exact, but for what is said to be uncertain.",
    "Faults of the processor or the compiler. The proof allows for the rounding of every operation.",
)


def study(found: Certificate, *, checked: bool = False, largest: CertifiedBox | None = None) -> Study:
    """The study of a certificate. checked: it is that of a check. largest: where the box was sought."""
    name = f"{file_name(found.hexapod.name)}-certificate"
    what = "A certificate checked by other boxes" if checked else "A certificate"
    return Study(
        hexapod=found.hexapod,
        subject="certificate",
        about=f"{what}. {found.words}",
        data=_data(found, checked, largest),
        rows=_rows(found, largest),
        sections=_sections(found, name, checked),
        cautions=[*_given_up(largest), *_cautions(found)],
        files={f"{name}-check.html" if checked else f"{name}.html": None},
    )


def _rows(found: Certificate, largest: CertifiedBox | None) -> list[Row]:
    rows = [Row(_TITLES[found.claim], found.status, on="page"), *_bounds(found)]
    if largest is not None:
        beyond = f"a pose below the bound is known at {largest.refuted:.4g}" if np.isfinite(largest.refuted) else ""
        rows.append(Row("Size", f"{largest.scale:.4g}", "times the shape", note=beyond))
    if found.within_limits:
        rows.append(Row("Beyond the limits", percent(found.share_outside, 1), "of the volume, left out"))
    if found.status == "undecided":
        parts = f"{len(found.left)} part{'' if len(found.left) == 1 else 's'}"
        rows.append(Row("Not decided", percent(found.share_left, 2), f"of the volume, {parts}"))
    rows.append(Row("Looked at", str(found.boxes), f"{_parts(found)} in {brief(found.seconds, 3)} s"))
    return rows


def _parts(found: Certificate) -> str:
    return "pieces of the path" if found.on_path else "box" if found.boxes == 1 else "boxes"


def _bounds(found: Certificate) -> list[Row]:
    where = "" if found.pose is None else f"at {six_words(found.pose)}"
    if found.claim == "index" and found.broken:
        return [Row("Refuted", f"outside the range of the {found.broken}", note=where)]
    if found.claim == "index":
        proved = f"rad/s = {brief(found.lower / TWO_PI, 5)} Hz"
        known = f"rad/s, {where}" if where else "rad/s"
        return [
            Row("Proved at every pose", found.lower or None, proved if found.lower else "nothing", 6),
            Row("Least that is known", found.upper, known, 6),
            *([Row("Gap between them", percent(found.reached, 2))] if found.lower else []),
        ]
    if found.claim == "condition":
        most = found.upper if np.isfinite(found.upper) else None
        return [
            Row("Proved at every pose: at most", most, "" if most else "nothing", 6),
            Row("Greatest that is known", found.lower, where, 6),
        ]
    if found.status != "refuted":
        return []
    what = f"the {found.broken} breaks its limit" if found.claim == "limits" else "singular"
    return [Row("Refuted", what, note=where)]


def _sections(found: Certificate, name: str, checked: bool) -> list[Section]:
    model = _model(found)
    assumed = f"It is about every design in the ranges of {'; '.join(found.assumed)}." if found.assumed else ""
    words = [model, *filter(None, [" ".join(filter(None, [assumed, _straying(found)]))])]
    listed = found.status == "undecided" and not found.on_path
    left = [Table(_box_columns(found.left), _more(found.left), on="page")] if listed else []
    again = (
        f"With Flexapod installed, the command \u201cflexapod certify --check {name}.json\u201d proves the same anew "
        "by boxes that are cut elsewhere. The file holds the design, the region, the model and the bound, and a sum "
        "over them."
    )
    sections = [
        Section("What is claimed", [_facts(found)], words),
        Section("The region", [_region(found)]),
        *([Section("What is not decided", left)] if left else []),
        Section("What it does not cover", [], [" ".join((_OTHER.get(found.claim, _GEOMETRY), *_LEAVES_OUT))]),
    ]
    return sections if checked else [*sections, Section("Check it again", [], [again])]


def _model(found: Certificate) -> str:
    if found.claim in ("regular", "condition"):
        return "Rigid plates and legs, joints without play; what is claimed depends on their geometry alone."
    if found.claim == "limits":
        return "Rigid plates and legs, joints without play, springs in the joints as the design has them."
    joint = {"universal": "exact universal joints", "spin_free": "legs that do not spin (the paper's)"}[found.joint]
    legs = found.hexapod.legs
    law = "" if legs.stiffness_law is None else f", stiff by a law of their length ({legs.stiffness_law.kind.name})"
    others = [
        *(["springs in series with the legs"] if legs.series_compliance.any() else []),
        *(["springs in the joints"] if legs.joint_stiffness.any else []),
        *(["a suspension"] if found.hexapod.suspension is not None else []),
    ]
    beside = f", {', '.join(others)}" if others else ""
    return (
        f"Rigid plates, legs that are axial springs with mass{law}{beside}, {joint}, a base at rest; the lowest "
        "natural frequency is that of Eq. 5 of the paper."
    )


def _straying(found: Certificate) -> str:
    if not found.strays:
        return ""
    furthest = max(max(one.reach) for one in found.strays)
    ends = " The most adverse value known is of one with coordinates at the ends of their ranges."
    return (
        f"{len(found.strays)} coordinates stray independently, by {furthest * 1000:.4g} mm at most; the design with "
        f"the digest is in the middle.{ends if found.strayed else ''}"
    )


def _facts(found: Certificate) -> Table:
    nominal = [("Digest of the design as it is", found.nominal)] if found.assumed else []
    rows = [
        ("Design", found.hexapod.name),
        ("Digest of the design that is proved", found.hexapod.digest),
        *nominal,
        ("Joint model", found.joint),
        ("Poses that count", "those within the design's limits" if found.within_limits else "all of the region"),
        *([("Bound asked for", _wanted(found))] if found.wanted is not None else []),
    ]
    return Table([Column("", [a for a, _ in rows]), Column("", [b for _, b in rows])], style="facts", on="page")


def _wanted(found: Certificate) -> str:
    assert found.wanted is not None
    if found.claim == "index":
        return f"at least {shown(found.wanted, 6)} rad/s = {shown(found.wanted / TWO_PI, 5)} Hz"
    return f"at most {shown(found.wanted, 6)}"


def _region(found: Certificate) -> Table:
    if isinstance(found.place, Boxes):
        return Table(_box_columns(found.place.parts), _more(found.place.parts), on="page")
    spans = found.place.parts
    rows = [("Pieces (polynomials)", str(len(spans))), ("Duration", f"{(spans[:, 2] - spans[:, 1]).sum():.6g} s")]
    return Table([Column("", [a for a, _ in rows]), Column("", [b for _, b in rows])], style="facts", on="page")


def _box_columns(boxes: Any) -> list[Column]:
    scale = np.repeat([1.0, 180 / np.pi], 3)[:, None]
    columns = [Column("box", [str(k + 1) for k in range(min(MOST, len(boxes)))])]
    for k, axis in enumerate(AXES):
        ends = boxes[:MOST, k] * scale[k]
        words = [brief(a, 6) if a == b else f"{brief(a, 6)} to {brief(b, 6)}" for a, b in ends]
        columns.append(Column(axis, words, "m" if k < 3 else "deg"))
    return columns


def _more(boxes: Any) -> str:
    return f"and {len(boxes) - MOST} more, which are in the file." if len(boxes) > MOST else ""


def _given_up(largest: CertifiedBox | None) -> list[Caution]:
    """That larger boxes were given up, where the search did not come to the size that a pose refutes."""
    if largest is None or np.isinf(largest.given_up):
        return []
    text = (
        f"Boxes from {largest.given_up:.4g} times the shape on were given up undecided: the bound may hold in a larger "
        f"one than {largest.scale:.4g}. A longer --time-limit tries for longer, as does --resume."
    )
    return [Caution("given_up", text, {"scale": largest.given_up})]


def _cautions(found: Certificate) -> list[Caution]:
    cautions = []
    if found.status == "undecided":
        nothing = found.claim == "index" and found.lower == 0
        more = " Nothing is proved of the whole region yet." if nothing else ""
        text = f"The proof ended with {percent(found.share_left, 2)} of the region left.{more} {_going_on(found)}"
        cautions.append(Caution("undecided", text, {"share": found.share_left}))
    if found.claim != "index" or found.pose is None or found.broken:
        return cautions
    return [*cautions, *least_index.cautions(found.hexapod, found.pose, found.joint)]


def _going_on(found: Certificate) -> str:
    if found.strays:
        return (
            "What is uncertain may keep the bound from coming closer, however small the boxes are: if --resume adds "
            "nothing, ask for less, or lessen the ranges."
        )
    if found.stuck is None:
        return "Go on with --resume."
    return (
        f"At {six_words(found.stuck)} the bound is reached, or a limit, or the pose is singular, as near as rounding "
        "lets it be told: more time decides nothing there. Ask for less, or leave it out of the region."
    )


def _data(found: Certificate, checked: bool, largest: CertifiedBox | None) -> dict[str, Any]:
    boxes = isinstance(found.place, Boxes)
    data: dict[str, Any] = {
        **origin(found.hexapod),
        "nominal_digest": found.nominal,
        "claim": found.claim,
        "status": found.status,
        "checked": checked,
        "joint": found.joint,
        "within_limits": found.within_limits,
        "uncertain": list(found.assumed),
        "wanted": found.wanted,
        **_bounds_data(found),
        "pose_m_rad": found.pose,
        "broken": found.broken or None,
        "boxes": found.boxes,
        "seconds": found.seconds,
        "share_left": found.share_left,
        "share_outside": found.share_outside,
        "parts_left": len(found.left),
        "region": found.place.parts if boxes else None,
        "path_s": None if boxes else float((found.place.parts[:, 2] - found.place.parts[:, 1]).sum()),
    }
    if largest is not None:
        data |= {
            "scale": largest.scale,
            "refuted_scale": largest.refuted,
            "given_up_scale": largest.given_up,
        }
    return data


def _bounds_data(found: Certificate) -> dict[str, Any]:
    if found.claim == "index":
        return {"lower_rad_s": found.lower, "upper_rad_s": found.upper, "gap": found.reached}
    if found.claim == "condition":
        return {"lower": found.lower, "upper": found.upper, "gap": found.reached}
    return {}


def certificate_data(found: Certificate | None) -> dict[str, Any] | None:
    """A certificate as plain data, for other studies."""
    return None if found is None else {**_data(found, False, None)}


def one_line(found: Certificate) -> str:
    """A certificate in a few words, for other studies."""
    if found.claim == "index" and found.lower > 0:
        return f"at least {shown(found.lower, 6)} rad/s, to {percent(found.reached, 2)} of what is found"
    return f"nothing ({found.status})"
