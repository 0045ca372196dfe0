"""Tables of the keys of a design file and of their units."""

from __future__ import annotations

from flexapod.design.key import Key
from flexapod.design.schema import KEYS, POINT, POINTS
from flexapod.design.units import UNITS, printed, si_unit


def table() -> str:
    rows = ["| key | meaning | is a | shape | range |", "|---|---|---|---|---|"]
    for name, key in {**KEYS, f"{POINTS}.NAME": POINT}.items():
        rows.append(f"| `{name}` | {key.meaning} | {key.dimension or 'number'} | {key.shape_text} | {bounds(key)} |")
    return "\n".join(rows)


def units() -> str:
    rows = ["| dimension | without a unit | with a unit at the end of the key |", "|---|---|---|"]
    for dimension, known in UNITS.items():
        endings = ", ".join(f"`_{unit}`" for unit in known)
        rows.append(f"| {dimension} | {printed(si_unit(dimension))} | {endings} |")
    return "\n".join(rows)


def bounds(key: Key) -> str:
    if key.symmetric:
        return "symmetric"
    least = "" if key.least is None else f"{'>' if key.open_ else '≥'} {key.least:g}"
    most = "" if key.most is None or key.most > 1e50 else f"≤ {key.most:g}"
    return ", ".join(filter(None, (least, most)))
