"""The report of a machine at a pose as a study: what the findings hold, in the order in which it is read."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flexapod import plots
from flexapod.conventions import LEGS, TWO_PI, Array
from flexapod.mechanics.cautions import Tangent, grows, other_than_vibration
from flexapod.mechanics.joint_limits import limit_excess
from flexapod.mechanics.modes import NaturalModes
from flexapod.mechanics.viscous_losses import has_losses
from flexapod.plots.style import SHORTENED, STRETCHED
from flexapod.report import springs
from flexapod.report.findings import Findings
from flexapod.report.influence import MOVE, leading
from flexapod.report.numbers import DASH, brief, file_name, percent, pose_words, shown, without_rounding
from flexapod.report.studies import inputs
from flexapod.report.studies.inputs import limits
from flexapod.report.study import Bars, Column, Drawing, Row, Section, Study, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODES = [str(number) for number in range(1, 7)]
ON_PAGE = {"geometry": 7, "mass": 5, "stiffness": 4}  # so many sensitivities of each kind
IN_TERMINAL = {"geometry": 2, "mass": 2, "stiffness": 1}

MEANING = (
    "The dynamic stability index is the lowest natural frequency: near zero, the machine cannot hold a load or follow "
    "a path.",
    "The condition number of the force transformation H compares the largest and the least leg force for loads of one "
    "size. H mixes forces and moments, so the number depends on the unit of length: in metres it is that of the "
    "literature, with moments divided by a characteristic length it has none.",
    "The sampling time of a controller should be at most 2\u03c0/(20 \u03c9), with \u03c9 the highest natural "
    "frequency; closed-loop poles should keep away from all six.",
    "The equations are those of P. Mukherjee, B. Dasgupta and A. K. Mallik, \u201cDynamic stability index and "
    "vibration analysis of a flexible Stewart platform\u201d, Journal of Sound and Vibration (2007), corrected.",
)
ENERGY = (
    "A leg or joint that stores much of a mode's strain energy is the one to stiffen for it; a body that carries much "
    "of its kinetic energy is the one to lighten."
)


def study(f: Findings) -> Study:
    """The report of a machine at a pose."""
    sections = (_machine(f), _frequencies(f), _modes(f), _legs(f), _shares(f), _influences(f))
    model = "exact universal joints" if f.joint == "universal" else "legs that do not spin (the paper's W\u00b7s = 0)"
    meaning = (f"{MEANING[0]} {springs.assumptions(f.hexapod)}", *MEANING[1:])
    changed = f", with {', '.join(f.changes)}" if f.changes else ""
    return Study(
        hexapod=f.hexapod,
        subject="dynamic stability",
        about=f"Dynamic stability of a flexible hexapod at {pose_words(f.pose)}; {model}{changed}.",
        data=f.to_dict(),
        rows=_rows(f),
        sections=[*filter(None, sections), inputs.section(f.hexapod), Section("What the numbers mean", (), meaning)],
        cautions=f.cautions,
        files={f"{file_name(f.hexapod.name)}.html": None},
    )


def _rows(f: Findings) -> list[Row]:
    c = f.conditioning
    force = None if f.rest is None else float(np.abs(f.rest.leg_force).max())
    scaled = f"in metres, {shown(c.scaled)} with moments over {shown(c.length, 3)} m"
    index = [
        Row("Dynamic stability index", f.omega[0], "rad/s", 5, f"= {_hertz(f.omega[0])}", on="page"),
        Row("Dynamic stability index", f.omega[0], "rad/s", 6, f"= {_hertz(f.omega[0])}", on="terminal"),
    ]
    beside = _with_weight(f)
    return [
        Row("At rest here", f.stability),
        *((*beside, *index) if f.tangent_differs else (*index, *beside)),
        Row("Limits at this pose", *_verdict(f)),
        Row("Condition number of H", c.metres, "in metres", on="page"),
        Row("Condition number of H", c.metres, "", 5, scaled, on="terminal"),
        Row("Largest static leg force", force, "not available" if force is None else "N", on="page"),
        Row("Sampling time at most", 1e3 * f.sampling_time, "ms", 3),
    ]


def _hertz(omega: float) -> str:
    return f"{shown(omega / TWO_PI, 5)} Hz"


def _with_weight(f: Findings) -> list[Row]:
    """The lowest frequency that weight and preload leave, first of all numbers where it is not the index."""
    if f.damped is None:
        return []
    label = "Lowest frequency with weight and preload"
    if f.unstable:
        return [Row(label, "none", note="not stable at rest")]
    lowest = float(f.damped.omega.min())
    return [Row(label, lowest, "rad/s", 5, f"= {_hertz(lowest)}")]


def _verdict(f: Findings) -> tuple[str, str]:
    if not limits(f.hexapod):
        return "none set", ""
    exceeded = sum(int(caution.numbers["times"]) for caution in f.cautions if caution.code == "limit")
    return (f"{exceeded} exceeded", "") if exceeded else ("kept", "")


def _machine(f: Findings) -> Section:
    h, c = f.hexapod, f.conditioning
    facts = {
        "Platform with payload": f"{brief(h.platform_mass)} kg",
        "Legs, each": springs.spread(h.legs.lower.mass + h.legs.upper.mass, 1.0, "kg"),
        **springs.facts(h, f.leg_length),
        "Leg length here": springs.spread(f.leg_length, 1e3, "mm"),
        "Least distance of leg axes": f"{shown(1e3 * f.leg_distance)} mm",
        "Condition number of H, in metres": shown(c.metres),
        f"the same, moments over {shown(c.length, 3)} m": shown(c.scaled),
        "Gravity": f"{brief(float(np.linalg.norm(h.gravity)))} m/s\u00b2",
    }
    caption = (
        "Legs by number, their lower parts thick; x, y, z: frames of base and platform; +: the platform's mass centre."
    )
    draw = partial(_in_3d, partial(plots.machine, h, f.pose), (7, 6))
    table = Table([Column("", list(facts)), Column("", list(facts.values()))], on="page")
    return Section("The machine", [Drawing("machine", "The machine in 3-D", draw, caption), table], style="pair")


def _frequencies(f: Findings) -> Section:
    tangent = f.tangent
    columns = [Column("mode", MODES), Column("rad/s", f.omega, digits=6), Column("Hz", f.omega / TWO_PI, digits=5)]
    if tangent is not None:
        damped, pairs = tangent.modes, tangent.pairs
        turning = np.where(damped.pole.imag > 0, damped.pole.imag, np.nan)
        columns += [
            Column(
                "tangent", [_beside(tangent, j) for j in pairs.damped], "rad/s", 6, pairs.beside(grows(damped)) == 1
            ),
            Column("alike", [percent(share) for share in pairs.overlap], on="page"),
            Column("damped", pairs.beside(turning), "rad/s", 6, on="page"),
            Column("damped", pairs.beside(turning) / TWO_PI, "Hz", 5, on="page"),
            Column("damping ratio", pairs.beside(damped.damping_ratio), digits=3),
        ]
    columns += [
        Column("mostly", [one.dominant for one in f.descriptions], on="page"),
        Column("motion", [one.text.split(", turning")[0] for one in f.descriptions], on="terminal"),
    ]
    note = (
        "First columns: Eq. 5, undamped, without weight or preload. Tangent: the exact linearisation at static "
        "equilibrium with gravity, preload and damping, each mode beside the one of Eq. 5 that moves alike: at least "
        "half of its kinetic energy is in that shape, or in those nearly repeated with it."
    )
    if tangent is None:
        note = "Eq. 5, undamped, without weight or preload. The exact tangent needs a static equilibrium; here is none."

    if has_losses(f.hexapod):
        note += (
            " Damping ratios are of viscous friction; loss factors are not in them: one of all springs adds half of it."
        )
    note = f"{note} {_bending(f)}"

    def draw() -> Figure:
        from matplotlib.figure import Figure

        figure = Figure(figsize=(7, 2.7))
        labels = [description.dominant for description in f.descriptions]
        beside = None if tangent is None else tangent.pairs.beside(tangent.modes.pole)
        plots.frequencies(f.omega, ax=figure.add_subplot(), tangent=beside, labels=labels)
        return figure

    drawing = Drawing("frequencies", "Natural frequencies", draw, wide=True)
    return Section("Natural frequencies", [drawing, Table(columns, note), *_alone(f)])


def _bending(f: Findings) -> str:
    """What the frequencies leave out: legs that bend, with the number beside which they stand."""
    lowest, unknown = f.bending.lowest, f.bending.unknown
    if np.isnan(lowest):
        return f"Legs are taken not to bend; at which frequency they do is not known: {unknown}."
    more = f" (of all legs it is not known: {unknown})" if unknown else ""
    return (
        f"Legs are taken not to bend: by itself the first does at {shown(lowest, 5)} rad/s{more}; mode 6 is at "
        f"{shown(f.omega[-1], 5)} rad/s."
    )


def _beside(tangent: Tangent, mode: int) -> float | str:
    """The frequency of a damped mode, rad/s, or that it has none."""
    damped = tangent.modes
    if mode < 0:
        return DASH
    return other_than_vibration(damped.pole[mode], grows(damped)[mode]) or float(damped.omega[mode])


def _alone(f: Findings) -> list[Table]:
    """The damped modes that are like none of Eq. 5, with words of their own."""
    tangent = f.tangent
    if tangent is None or not tangent.pairs.alone:
        return []
    alone = tangent.pairs.alone
    columns = [
        Column("tangent mode", [str(j + 1) for j in alone]),
        Column("frequency", [_beside(tangent, j) for j in alone], "rad/s", 6),
        Column("damping ratio", tangent.modes.damping_ratio[alone], digits=3),
        Column("motion", [tangent.words[j].text for j in alone]),
    ]
    return [Table(columns, "Modes of the exact tangent by modulus.", "Tangent modes that are like none of Eq. 5")]


def _modes(f: Findings) -> Section:
    modes = NaturalModes(f.omega, f.shape)
    drawings = [
        Drawing(
            f"mode{number}",
            f"Mode {number}",
            partial(_in_3d, partial(plots.mode, f.hexapod, f.pose, modes, number), (4, 4)),
            one.text[:1].upper() + one.text[1:],
            f"{shown(f.omega[number - 1] / TWO_PI)} Hz",
            tight=True,
        )
        for number, one in enumerate(f.descriptions, start=1)
    ]
    legend = [
        ("Dashed: at rest. Legs by strain:", ""),
        ("stretched", STRETCHED),
        (
            "shortened; the wider, the more. Motion is enlarged, and its sign is arbitrary. Percentages are parts of "
            "the kinetic energy by motion of the mass centre (x, y, z) and turning about it (roll, pitch, yaw).",
            SHORTENED,
        ),
    ]
    return Section("The six modes", drawings, legend=legend, style="modes")


def _legs(f: Findings) -> Section:
    """Leg by leg: length, static force and joint angles; what is beyond a limit is marked."""
    beyond: dict[str, NDArray[np.bool_]] = {}
    for quantity in limit_excess(f.hexapod, f.pose, joint=f.joint):
        if np.size(quantity.value) == 6:
            beyond[f"{quantity.name} {quantity.unit}"] = ~quantity.kept
    columns = [Column("leg", LEGS), Column("length", 1e3 * f.leg_length, "mm", 6, beyond.get("length m"))]
    if f.rest is not None:
        columns += [
            Column("unstretched", 1e3 * f.rest.unstretched_length, "mm", 6, on="page"),
            Column("static force", without_rounding(f.rest.leg_force), "N", marked=beyond.get("force at rest N")),
        ]
    for name, angles in (("universal", f.angles.universal), ("spherical", f.angles.spherical)):
        words = [f"{x:.2f}" for x in np.degrees(angles)]
        columns.append(Column(f"{name} joint", words, "deg", marked=beyond.get(f"{name} joint angle deg")))
    neutral = "its direction at home" if f.hexapod.home is not None else "the z axis"
    note = (
        f"Forces hold the machine at rest under its weight; positive is compression. Angles are from {neutral}. "
        f"{_limits(f)}"
    )
    return Section("Legs", [Table(columns, note), *springs.moments(f.hexapod, f.pose, f.joint, beyond)])


def _limits(f: Findings) -> str:
    found = limits(f.hexapod)
    return f"Limits: {'; '.join(found)}." if found else "The design sets no limits."


def _shares(f: Findings) -> Section:
    def heat(kind: str, names: list[str], shares: Array, note: str = "") -> Table:
        by_mode = [Column(f"mode {number}", shares[:, i]) for i, number in enumerate(MODES)]
        return Table([Column(f"{kind} energy", names), *by_mode], note, style="heat", on="page")

    legs = [f"leg {leg}" for leg in LEGS]
    odd = (f.shares.kinetic < -5e-4).any()
    note = "A part below zero comes from a leg inertia that no rigid body has." if odd else ""
    names, strain = legs, f.shares.strain
    if f.hexapod.legs.joint_stiffness.any:
        names = [*names, *(f"joints of leg {leg}" for leg in LEGS)]
        strain = np.concatenate([strain, f.shares.joints])
    if f.hexapod.suspension is not None:
        names, strain = [*names, "suspension"], np.concatenate([strain, f.shares.suspension[None]])
    tables = [heat("strain", names, strain), heat("kinetic", ["platform", *legs], f.shares.kinetic, note)]
    return Section("Where the energy is", tables, [ENERGY])


def _influences(f: Findings) -> Section | None:
    if not f.influences:
        return None
    lowest = f.clusters[0]
    which = f"the mean of modes 1 to {lowest[-1] + 1}, nearly repeated," if len(lowest) > 1 else "the index"
    words = (
        f"What small changes do to {which} from exact derivatives, largest first. Joints are moved by {percent(MOVE)} "
        "of the platform's size in the direction that raises it most; the other way lowers it as much."
    )
    found = leading(f.influences, ON_PAGE)
    bars = Bars(
        names=[one.change for one in found],
        effects=[one.effect for one in found],
        details=["" if one.direction is None else f"along ({_along(one.direction)})" for one in found],
        title="What matters most for the index",
        brief=[found.index(one) for one in leading(f.influences, IN_TERMINAL)],
    )
    return Section("What matters most", [bars], [words])


def _along(direction: tuple[float, float, float]) -> str:
    return ", ".join(f"{x + 0.0:.2f}" for x in np.round(direction, 2))


def _in_3d(draw: Callable[..., Any], size: tuple[float, float]) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=size)
    draw(ax=figure.add_subplot(projection="3d"))
    return figure
