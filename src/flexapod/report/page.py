"""The report as one HTML file that needs nothing else: no network, no script, figures inline."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np

from flexapod.conventions import TWO_PI, Array
from flexapod.mechanics.joint_limits import limit_excess
from flexapod.plots.style import SHORTENED, STRETCHED
from flexapod.report import figures
from flexapod.report.findings import Findings
from flexapod.report.html import foot, frame, table
from flexapod.report.influence import MOVE, Influence, leading
from flexapod.report.numbers import DASH, brief, percent, pose_words, shown

SHOWN = {"geometry": 7, "mass": 5, "stiffness": 4}  # so many sensitivities of each kind

MEANING = (
    "The <b>dynamic stability index</b> is the lowest natural frequency: near zero, the machine cannot hold a load or "
    "follow a path. Legs are axial springs, the plates are rigid, the base is fixed.",
    "The <b>condition number</b> of the force transformation H compares the largest and the least leg force for loads "
    "of one size. H mixes forces and moments, so the number depends on the unit of length: in metres it is that of the "
    "literature, with moments divided by a characteristic length it has none.",
    "The <b>sampling time</b> of a controller should be at most 2\u03c0/(20 \u03c9), with \u03c9 the highest natural "
    "frequency; closed-loop poles should keep away from all six.",
    "The equations are those of P. Mukherjee, B. Dasgupta and A. K. Mallik, \u201cDynamic stability index and "
    "vibration analysis of a flexible Stewart platform\u201d, Journal of Sound and Vibration (2007), corrected.",
)


def page(f: Findings) -> str:
    """The whole page."""
    name = f.hexapod.name
    sections = (_head, _cautions, _machine, _frequencies, _modes, _legs, _shares, _sensitivities, _meaning, _foot)
    body = "\n".join(section(f) for section in sections)
    return frame(f"{name}: dynamic stability", body)


def _head(f: Findings) -> str:
    model = "exact universal joints" if f.joint == "universal" else "legs that do not spin (the paper's W\u00b7s = 0)"
    changed = f", with <code>{escape(', '.join(f.changes))}</code>" if f.changes else ""
    force = "" if f.rest is None else shown(float(np.abs(f.rest.leg_force).max()))
    cards = [
        ("Dynamic stability index", shown(f.omega[0], 5), "rad/s", "first"),
        ("which is", shown(f.omega[0] / TWO_PI, 5), "Hz", ""),
        ("Condition number of H", shown(f.conditioning.metres), "in metres", ""),
        ("Largest static leg force", force or DASH, "N" if force else "not available", ""),
        ("Sampling time at most", shown(1e3 * f.sampling_time, 3), "ms", ""),
    ]
    key = "".join(
        f'<div class="{kind}"><dt>{title}</dt><dd>{value} <span>{unit}</span></dd></div>'
        for title, value, unit, kind in cards
    )
    return (
        f'<header>\n<h1>{escape(f.hexapod.name)}</h1>\n<p class="quiet">Dynamic stability of a flexible hexapod at '
        f'{escape(pose_words(f.pose))}; {model}{changed}.</p>\n</header>\n<dl class="key">{key}</dl>'
    )


def _cautions(f: Findings) -> str:
    if not f.cautions:
        return ""
    items = "".join(f"<li>{escape(caution.text)}</li>" for caution in f.cautions)
    return f'<section class="warnings"><h3>To beware of</h3><ul>{items}</ul></section>'


def _machine(f: Findings) -> str:
    h = f.hexapod
    stiffness = h.legs.stiffness
    leg_mass = h.legs.lower.mass + h.legs.upper.mass
    rows = [
        ("Platform with payload", f"{brief(h.platform_mass)} kg"),
        ("Legs, each", _range(leg_mass, 1.0, "kg")),
        ("Leg stiffness", _range(stiffness, 1e-6, "N/\u00b5m")),
        ("Leg length here", _range(f.leg_length, 1e3, "mm")),
        ("Least distance of leg axes", f"{shown(1e3 * f.leg_distance)} mm"),
        ("Condition number of H, in metres", shown(f.conditioning.metres)),
        (f"the same, moments over {shown(f.conditioning.length, 3)} m", shown(f.conditioning.scaled)),
        ("Gravity", f"{brief(float(np.linalg.norm(h.gravity)))} m/s\u00b2"),
    ]
    rows_shown = table((), [(escape(a), b) for a, b in rows])
    caption = (
        "Legs by number, their lower parts thick; x, y, z: frames of base and platform; +: the platform's mass centre."
    )
    return (
        f'<h2>The machine</h2>\n<div class="pair"><figure>{figures.machine(f)}'
        f"<figcaption>{caption}</figcaption></figure><div>{rows_shown}</div></div>"
    )


def _frequencies(f: Findings) -> str:
    head = ["mode", "rad/s", "Hz"]
    tangent = f.damped
    if tangent is not None:
        head += ["tangent, rad/s", "damped, rad/s", "damped, Hz", "damping ratio"]
    rows = []
    for i in range(6):
        row = [f"{i + 1}", shown(f.omega[i], 6), shown(f.omega[i] / TWO_PI, 5)]
        if tangent is not None:
            turning = abs(tangent.pole[i].imag)
            ratio = shown(tangent.damping_ratio[i], 3)
            row += [shown(tangent.omega[i], 6), shown(turning, 6), shown(turning / TWO_PI, 5), ratio]
        rows.append([*row, escape(f.descriptions[i].dominant)])
    note = (
        "First columns: Eq. 5, undamped, without weight or preload. Tangent: the exact linearisation at static "
        "equilibrium with gravity, preload and damping; modes in ascending order."
    )
    if tangent is None:
        note = "Eq. 5, undamped, without weight or preload. The exact tangent needs a static equilibrium; here is none."
    rows_shown = table([*head, "mostly"], rows, note)
    return f"<h2>Natural frequencies</h2>\n<figure class='wide'>{figures.frequencies(f)}</figure>\n{rows_shown}"


def _modes(f: Findings) -> str:
    cards = []
    for i, description in enumerate(f.descriptions):
        hz = f'<span class="hz">{shown(f.omega[i] / TWO_PI)} Hz</span>'
        words = escape(description.text[:1].upper() + description.text[1:])
        cards.append(
            f"<figure><h3>Mode {i + 1} {hz}</h3>{figures.mode(f, i + 1)}<figcaption>{words}</figcaption></figure>"
        )
    legend = (
        '<p class="quiet">Dashed: at rest. Legs by strain: '
        f"{_swatch(STRETCHED)}stretched {_swatch(SHORTENED)}shortened; the wider, the more. "
        "Motion is enlarged, and its sign is arbitrary. Percentages are parts of the kinetic energy by motion of the "
        "mass centre (x, y, z) and turning about it (roll, pitch, yaw).</p>"
    )
    return f'<h2>The six modes</h2>\n{legend}<div class="modes">{"".join(cards)}</div>'


def _legs(f: Findings) -> str:
    """Leg by leg: length, static force and joint angles; what is beyond a limit is marked."""
    beyond = {}
    for quantity in limit_excess(f.hexapod, f.pose):
        low, high = np.broadcast_to(quantity.least, 6), np.broadcast_to(quantity.most, 6)
        if np.size(quantity.value) == 6:
            beyond[quantity.what] = (quantity.value < low) | (quantity.value > high)
    none = np.zeros(6, dtype=bool)
    columns: list[tuple[str, Sequence[str], np.ndarray]] = [
        ("length, mm", [shown(1e3 * x, 6) for x in f.leg_length], beyond.get("length m", none)),
    ]
    if f.rest is not None:
        columns += [
            ("unstretched, mm", [shown(1e3 * x, 6) for x in f.rest.unstretched_length], none),
            ("static force, N", [shown(x) for x in f.rest.leg_force], none),
        ]
    for name, angles in (("universal", f.angles.universal), ("spherical", f.angles.spherical)):
        words = [f"{x:.2f}" for x in np.degrees(angles)]
        columns.append((f"{name} joint, deg", words, beyond.get(f"{name} joint angle deg", none)))
    head = ["leg", *(title for title, _, _ in columns)]
    rows = [
        [f"{i + 1}", *(f'<td class="over">{words[i]}</td>' if over[i] else words[i] for _, words, over in columns)]
        for i in range(6)
    ]
    neutral = "its direction at home" if f.hexapod.home is not None else "the z axis"
    note = (
        f"Forces hold the machine at rest under its weight; positive is compression. Angles are from {neutral}. "
        f"{_limits(f)}"
    )
    return f"<h2>Legs</h2>\n{table(head, rows, note)}"


def _limits(f: Findings) -> str:
    limits = f.hexapod.limits
    found = []
    if limits.leg_length is not None:
        pairs = np.reshape(limits.leg_length, (-1, 2)) * 1e3
        found.append("length " + ", ".join(f"{brief(low)} to {brief(high)} mm" for low, high in pairs))
    for name, most in (("universal", limits.universal_angle), ("spherical", limits.spherical_angle)):
        if most is not None:
            found.append(f"{name} joint {brief(float(np.degrees(most)), 3)}\u00b0")
    if limits.leg_distance is not None:
        found.append(f"distance of leg axes at least {brief(1e3 * limits.leg_distance)} mm")
    return f"Limits: {'; '.join(found)}." if found else "The design sets no limits."


def _shares(f: Findings) -> str:
    modes = [f"mode {i + 1}" for i in range(6)]
    legs = [f"leg {i + 1}" for i in range(6)]
    strain = _heat(["strain energy", *modes], legs, f.shares.strain)
    kinetic = _heat(["kinetic energy", *modes], ["platform", *legs], f.shares.kinetic)
    note = ""
    if (f.shares.kinetic < -5e-4).any():
        note = '<p class="quiet">A part below zero comes from a leg inertia that no rigid body has.</p>'
    return (
        "<h2>Where the energy is</h2>\n<p>A leg that stores much of a mode's strain energy is the one to stiffen for "
        f"it; a body that carries much of its kinetic energy is the one to lighten.</p>\n{strain}{kinetic}{note}"
    )


def _sensitivities(f: Findings) -> str:
    if f.influences is None:
        return ""
    lowest = f.clusters[0]
    which = f"the mean of modes 1 to {lowest[-1] + 1}, nearly repeated," if len(lowest) > 1 else "the index"
    largest = max((abs(one.effect) for one in f.influences), default=1.0)
    bars = "".join(_bar(one, largest) for one in leading(f.influences, SHOWN))
    return (
        f"<h2>What matters most</h2>\n<p>What small changes do to {which} from exact derivatives, largest first. "
        f"Joints are moved by {percent(MOVE)} of the platform's size in the direction that raises it most; the other "
        f'way lowers it as much.</p>\n<div class="bars">{bars}</div>'
    )


def _bar(one: Influence, largest: float) -> str:
    width = 50 * abs(one.effect) / largest
    left = 50.0 if one.effect > 0 else 50 - width
    kind = "bar" if one.effect > 0 else "bar less"
    towards = ""
    if one.direction is not None:
        towards = f"<small>along ({', '.join(f'{x + 0.0:.2f}' for x in np.round(one.direction, 2))})</small>"
    return (
        f'<div>{escape(one.change)}{towards}</div><div class="track"><div class="{kind}" '
        f'style="left:{left:.2f}%;width:{width:.2f}%"></div></div><div class="value">{100 * one.effect:+.3f} %</div>'
    )


def _meaning(f: Findings) -> str:
    return "<h2>What the numbers mean</h2>\n" + "\n".join(f"<p>{text}</p>" for text in MEANING)


def _foot(f: Findings) -> str:
    return foot(f.hexapod)


def _heat(head: Sequence[str], names: Sequence[str], shares: Array) -> str:
    """Shares of 1, each cell tinted by its share."""

    def cell(share: float) -> str:
        tint = f' style="--share:{max(0.0, 60 * share):.0f}%"' if np.isfinite(share) else ""
        return f"<td{tint}>{percent(share)}</td>"

    rows = [[name, *map(cell, row)] for name, row in zip(names, shares, strict=True)]
    return table(head, rows).replace("<table>", '<table class="heat">')


def _swatch(color: str) -> str:
    return f'<span class="swatch" style="background:{color}"></span>'


def _range(values: Array, scale: float, unit: str) -> str:
    low, high = brief(scale * float(values.min())), brief(scale * float(values.max()))
    return f"{low} {unit}" if low == high else f"{low} to {high} {unit}"
