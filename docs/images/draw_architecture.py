"""Draws the house of docs/architecture.md: `python docs/images/draw_architecture.py`. Every room must be a module."""

from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch, Polygon

from flexapod.plots import style

HERE = Path(__file__).parent
SOURCE = HERE.parents[1] / "src"

#: Floors from the top: colour, what it is, and its rows of rooms. A room: what it is about, and its modules.
FACES = ("#0072b2", "Faces", "show what the library returns; the library does not know them")
LIBRARY = ("#009e73", "Library, Python", "checks input, spreads batch axes, calls the core, gives results their shapes")
CORE = ("#d55e00", "Core, C++20", "the mechanics, each piece once, over any scalar: numbers, derivatives, lanes")
ROOMS = {
    FACES: [
        [
            ("figures", "plots* animate"),
            ("one machine", "report/ paper/"),
            ("command line", "cli/"),
            ("browser page", "web/"),
            ("other tools", "interchange/"),
        ]
    ],
    LIBRARY: [
        [
            ("studies: they do not know one another", ""),
            ("time", "simulation"),
            ("frequency", "response stepped"),
            ("uncertainty", "robust"),
            ("plans", "path planning"),
            ("control", "position_loops isolators\nsampled schedule"),
        ],
        [
            ("search", "optimal/"),
            ("workspace", "sweeps/ posesets\nquantities"),
            ("what drives it", "excitation spectra\nrecordings trajectory"),
            ("tangent", "linear steady"),
            ("loops", "feedback laws\nassessment"),
            ("paths", "waypoints smoothing\nfreespace requirements"),
        ],
        [
            ("one pose or many", "kinematics dynamics statics modal"),
            ("rows for the core", "states pose"),
            ("a design", "hexapod designfile shorthands\njointfile schema units errors extras"),
        ],
    ],
    CORE: [
        [
            ("the machine in time", "rig six_legs integrate\nsimulation control_loop"),
            ("poses in lanes", "stance sweep bidiagonal jacobi"),
            ("what follows", "modes statics reactions energy\nkinematics design_gradient"),
        ],
        [
            ("Eq. 34", "equations"),
            ("one leg", "leg"),
            ("numbers", "design motion"),
            ("algebra", "vec3 linear6 rotation dual pack"),
        ],
    ],
}


def check() -> None:
    """Every room's modules are there."""
    for floor, rows in ROOMS.items():
        folder, endings = (SOURCE / "core", (".hpp",)) if floor is CORE else (SOURCE / "flexapod", (".py", ""))
        for name in " ".join(modules for row in rows for _, modules in row).split():
            stem = name.rstrip("/*")
            if not any((folder / f"{stem}{ending}").exists() for ending in endings):
                raise SystemExit(f"{name} is no module of {folder}")


def house() -> plt.Figure:
    figure, ax = plt.subplots(figsize=(10.6, 7.2), facecolor="white")
    ax.set_axis_off()
    ax.set_xlim(-0.6, 10.6)
    ax.set_ylim(0.7, 8.9)
    top = 7.75
    ax.add_patch(
        Polygon([(-0.25, top + 0.12), (5.0, 8.75), (10.25, top + 0.12)], facecolor="#eef1f4", edgecolor=style.FAINT)
    )
    ax.text(5.0, 8.16, "import flexapod as fx", family="monospace", fontsize=12, ha="center", color=style.INK)
    for floor, rows in ROOMS.items():
        color, name, words = floor
        height = 0.52 + 0.82 * len(rows) + (0.36 if floor is LIBRARY else 0.0)
        bottom = top - height
        ax.add_patch(
            FancyBboxPatch(
                (0, bottom),
                10,
                height - 0.1,
                boxstyle="round,pad=0,rounding_size=0.06",
                facecolor=color,
                alpha=0.09,
                lw=0,
            )
        )
        ax.text(0.14, top - 0.32, name, fontsize=13, fontweight="bold", color=color, va="center")
        ax.text(9.86, top - 0.32, words, fontsize=9.5, color=style.INK, va="center", ha="right")
        level = top - 0.56
        for row in rows:
            level = _row(ax, row, level, color)
        top = bottom
    arrow = {"arrowstyle": "-|>", "mutation_scale": 18, "linewidth": 2.2, "color": style.BASE}
    ax.add_patch(FancyArrowPatch((-0.3, 7.6), (-0.3, top + 0.15), **arrow))
    ax.text(-0.48, (7.6 + top) / 2, "imports only point down", rotation=90, va="center", ha="center", color=style.BASE)
    return figure


def _row(ax: Axes, row: list[tuple[str, str]], top: float, color: str) -> float:
    """Rooms side by side, as wide as their words; returns where the next row begins."""
    if not row[0][1]:
        ax.text(0.14, top - 0.14, row[0][0], fontsize=9.5, style="italic", color=style.INK, va="center")
        row, top = row[1:], top - 0.32
    wide = [max(max(map(len, modules.split("\n"))) * 1.12, len(name) * 1.25) + 3.0 for name, modules in row]
    left, scale = 0.12, (9.76 - 0.1 * (len(row) - 1)) / sum(wide)
    for (name, modules), width in zip(row, wide, strict=True):
        box = FancyBboxPatch(
            (left, top - 0.74),
            width * scale,
            0.7,
            boxstyle="round,pad=0,rounding_size=0.05",
            fc="white",
            ec=color,
            lw=1.1,
        )
        ax.add_patch(box)
        middle = left + width * scale / 2
        two = "\n" in modules
        ax.text(middle, top - (0.17 if two else 0.22), name, fontsize=9.5, ha="center", va="center", color=style.INK)
        ax.text(
            middle, top - (0.49 if two else 0.51), modules, family="monospace", fontsize=8, ha="center", va="center",
            color=color, linespacing=1.25,
        )  # fmt: skip
        left += width * scale + 0.1
    return top - 0.82


FIGURES = (("house", house),)


def main() -> None:
    check()
    plt.rcParams |= {"svg.hashsalt": "flexapod", "svg.fonttype": "path"}
    for name, make in FIGURES:
        make().savefig(HERE / f"{name}.svg", bbox_inches="tight", pad_inches=0.06, metadata={"Date": None})


if __name__ == "__main__":
    main()
