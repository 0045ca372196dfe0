"""Variables, objectives and constraints as a command line says them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import click
import numpy as np

from flexapod.cli.options.optimise import KEEPS
from flexapod.cli.options.poses import box_of, read_poses
from flexapod.cli.options.quantities import read
from flexapod.design.hexapod import Hexapod
from flexapod.design.units import UNITS, to_si
from flexapod.optimisation import constraints as c
from flexapod.optimisation.objectives import LeastIndex, MeanIndex, Objective
from flexapod.optimisation.payload_range import Payload
from flexapod.optimisation.requirements import Constraint
from flexapod.optimisation.uncertain_parameters import Uncertain
from flexapod.optimisation.variables import CIRCLE, JointCircle, Variable
from flexapod.workspace.box import Workspace
from flexapod.workspace.region import Region, as_region


def variables(texts: Iterable[str]) -> list[Variable | JointCircle]:
    """`--vary` options: KEY=LEAST:LARGEST, tied keys with commas, + to add, * to scale, PLATE.circle.PART."""
    found: list[Any] = []
    circles: dict[str, dict[str, Any]] = {}
    for text in texts:
        keys, low, high = _range("--vary", text)
        kind = {"+": "add", "*": "scale"}.get(keys[:1], "set")
        keys = keys.lstrip("+*")
        plate, _, part = keys.partition(".circle.")
        if part and kind == "set" and not part.startswith("angles"):
            name, unit = _named("--vary", part, CIRCLE)
            parts = circles.setdefault(plate, {"units": {}})
            parts[name] = low, high
            parts["units"] |= {name: unit} if unit else {}
            continue
        ties = {key.lstrip("-"): -1.0 if key.startswith("-") else 1.0 for key in keys.split(",")}
        found.append(Variable(ties, low, high, kind))  # type: ignore[arg-type]
    return [*(JointCircle(plate, **parts) for plate, parts in circles.items()), *found]  # type: ignore[arg-type]


def constraints(texts: Iterable[str]) -> list[Constraint]:
    """`--keep` options: NAME, as the design has it, or NAME=BOUND or NAME_UNIT=BOUND."""
    return [keep(text) for text in texts]


def keep(text: str) -> Constraint:
    """One of them."""
    given, equals, value = text.partition("=")
    name, unit = _named("--keep", given.strip(), KEEPS)
    bound = _number("--keep", text, value) if equals else None
    if unit and bound is not None:
        bound = float(to_si(bound, KEEPS[name] or "", unit))
    if name == "limits" and equals:
        raise click.UsageError("--keep limits takes no bound: it keeps the [limits] of the design.")
    makers = {
        "footprint": lambda: c.Footprint(bound),
        "platform-footprint": lambda: c.Footprint(bound, "platform"),
        "stroke": lambda: c.Stroke(bound),
        "shortest-leg": lambda: c.LegLength(least=bound),
        "longest-leg": lambda: c.LegLength(most=bound),
        "clearance": lambda: c.LegClearance(bound),
        "universal-angle": lambda: c.JointAngle("universal", bound),
        "spherical-angle": lambda: c.JointAngle("spherical", bound),
        "cond": lambda: c.ConditionNumber(bound),
        "mass": lambda: c.TotalMass(bound),
        "deflection": lambda: c.Deflection(bound),
        "limits": c.DesignLimits,
    }
    if name in ("shortest-leg", "longest-leg") and bound is None:
        raise click.UsageError(f"--keep {name} needs a bound, such as {name}_mm=120.")
    return makers[name]()


def where(
    hexapod: Hexapod,
    pose: tuple[float, ...] | None,
    box: Iterable[str],
    around: tuple[float, float] | None,
) -> Region | None:
    """The places of --pose, --box or --around (which moves with home); None for the home pose."""
    box = tuple(box)
    if sum((pose is not None, bool(box), around is not None)) > 1:
        raise click.UsageError("--pose, --box and --around each say where. Give one of them.")
    if around is not None:
        return Workspace.about_home(around[0], math.radians(around[1]))
    if box:
        return Workspace(box_of(hexapod, box, None))
    return None if pose is None else as_region(np.concatenate([pose[:3], np.radians(pose[3:])]))


def objective(
    hexapod: Hexapod,
    pose: tuple[float, ...] | None,
    box: Iterable[str],
    around: tuple[float, float] | None,
    poses: Path | None,
) -> Objective:
    """The least index over the places, or the mean over the poses of a file."""
    over = where(hexapod, pose, box, around)
    if poses is None:
        return LeastIndex(over)
    if over is not None:
        raise click.UsageError("--mean takes the poses of its file. Leave --pose, --box and --around out.")
    return MeanIndex(read_poses(poses))


def uncertain(texts: Iterable[str]) -> list[Any]:
    """`--uncertain` options: KEY=SPREAD or SPREAD%, then a distribution and `together` after commas."""
    found = []
    for text in texts:
        key, equals, value = text.partition("=")
        spread, *words = (word.strip() for word in value.split(","))
        if not equals or not spread:
            raise click.UsageError(
                f"--uncertain {text}: write KEY=SPREAD, such as legs.stiffness=10% or {key}=5%,normal."
            )
        together = "together" in words
        kinds = [word for word in words if word != "together"]
        if len(kinds) > 1:
            raise click.UsageError(f"--uncertain {text}: {' and '.join(kinds)} are two distributions. Give one.")
        kind = kinds[0] if kinds else "uniform"
        relative = spread.endswith("%")
        number = _number("--uncertain", text, spread.rstrip("%")) * (0.01 if relative else 1.0)
        found.append(Uncertain(key.strip(), number, kind, relative, not together))  # type: ignore[arg-type]
    return found


def payloads(mass: str | None, at: tuple[str, ...] | None) -> list[Payload]:
    """`--payload` and `--payload-at`, each number `LEAST:LARGEST` or one for both; none without the mass."""
    if mass is None:
        if at is not None:
            raise click.UsageError(
                "--payload-at is the place of a load, and there is none. Give its mass by --payload."
            )
        return []
    place: Any = tuple(_span("--payload-at", text, "length") for text in at or ("0", "0", "0"))
    return [Payload(_span("--payload", mass, "mass"), place)]


def _span(option: str, text: str, dimension: str) -> tuple[float, float]:
    low, colon, high = text.partition(":")
    return read(low, dimension, option), read(high if colon else low, dimension, option)


def _range(option: str, text: str) -> tuple[str, float, float]:
    keys, equals, bounds = text.rpartition("=")
    low, colon, high = bounds.partition(":")
    if not equals or not colon or not keys:
        raise click.UsageError(
            f"{option} {text}: write KEY=LEAST:LARGEST, such as platform.mass=20:40 or base.circle.radius_mm=100:200."
        )
    return keys.strip(), _number(option, text, low), _number(option, text, high)


def _number(option: str, text: str, number: str) -> float:
    try:
        return float(number)
    except ValueError:
        unit = " A unit stands at the end of the key, as in base.circle.radius_mm." if number[:1].isdigit() else ""
        raise click.UsageError(f"{option} {text}: {number!r} is no number.{unit}") from None


def _named(option: str, given: str, known: Mapping[str, str | None]) -> tuple[str, str]:
    """`stroke_mm` -> its name and its unit; "" where it names none."""
    for name in sorted(known, key=len, reverse=True):
        if given == name:
            return name, ""
        unit, dimension = given[len(name) + 1 :], known[name]
        if given.startswith(f"{name}_") and dimension and unit in UNITS[dimension]:
            return name, unit
    raise click.UsageError(
        f"{option}: there is no {given!r}. There are {', '.join(known)}; lengths, angles and masses may carry a unit, "
        "as in stroke_mm or universal-angle_deg."
    )
