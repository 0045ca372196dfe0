"""Draws the folders of docs/architecture.md in their order: `python docs/images/draw_architecture.py`.

The order, the folders and what each is for are read from the sources, so that the picture cannot be out of date.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from flexapod.plots.style import BASE, INK

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT))
from tests.project.test_architecture import CORE_ORDER, ORDER  # noqa: E402

#: Bands from the top: colour, name, what it is for, and its lowest folder in the order.
BANDS = (
    ("#0072b2", "Faces", "show what the library returns; the library does not know them", "interchange"),
    ("#009e73", "Studies", "take a design, poses and numbers, and return plain results", "workspace"),
    ("#cc79a7", "The machine at a pose", "checks input, spreads batch axes, calls the core", "design"),
    ("#8a929b", "What all share", "errors, types and names, checks of arguments, poses", "errors"),
)
CORE_BAND = ("#d55e00", "Core, C++20", "the mechanics, each piece once, over any scalar: numbers, derivatives, lanes")
WIDTH, ROW = 10.0, 0.6


def bands() -> list[tuple[str, str, str, list[str]]]:
    """Colour, name, words, and folders of every band, from the top."""
    names, found = [name for name in ORDER if not name.startswith("_")], []
    for color, name, words, first in BANDS:
        inside = names[names.index(first) :]
        names = names[: names.index(first)]
        found.append((color, name, words, inside))
    return [*found, (*CORE_BAND, list(CORE_ORDER))]


def house() -> plt.Figure:
    figure, ax = plt.subplots(figsize=(10.6, 5.8), facecolor="white")
    ax.set_axis_off()
    ax.set_xlim(-0.6, WIDTH + 0.1)
    top = 0.0
    for color, name, words, rooms in bands():
        height = 0.5 + ROW
        box = FancyBboxPatch((0, top - height), WIDTH, height - 0.08, boxstyle="round,pad=0,rounding_size=0.06")
        box.set(facecolor=color, alpha=0.1, linewidth=0)
        ax.add_patch(box)
        ax.text(0.12, top - 0.28, name, fontsize=12.5, fontweight="bold", color=color, va="center")
        ax.text(WIDTH - 0.12, top - 0.28, words, fontsize=9.5, color=INK, va="center", ha="right")
        _row(ax, rooms, top - 0.5, color)
        top -= height + 0.06
    ax.set_ylim(top, 0.1)
    ax.add_patch(
        FancyArrowPatch((-0.22, -0.2), (-0.22, top + 0.2), arrowstyle="-|>", mutation_scale=18, lw=2.2, color=BASE)
    )
    ax.text(-0.42, top / 2, "imports only point down", rotation=90, va="center", ha="center", color=BASE)
    return figure


def _row(ax: Axes, rooms: list[str], top: float, color: str) -> None:
    """Rooms side by side, as wide as their names; each may use those left of it, and all below."""
    wide = [max(len(name), 7) + 2.2 for name in rooms]
    left, scale = 0.1, (WIDTH - 0.2 - 0.08 * (len(rooms) - 1)) / sum(wide)
    for name, width in zip(rooms, wide, strict=True):
        room = FancyBboxPatch(
            (left, top - ROW + 0.14), width * scale, ROW - 0.2, boxstyle="round,pad=0,rounding_size=0.05"
        )
        room.set(facecolor="white", edgecolor=color, linewidth=1.1)
        ax.add_patch(room)
        ax.text(
            left + width * scale / 2,
            top - ROW / 2 + 0.04,
            name,
            family="monospace",
            fontsize=9 if len(rooms) < 10 else 7.8,
            ha="center",
            va="center",
        )
        left += width * scale + 0.08


def main() -> None:
    plt.rcParams |= {"svg.hashsalt": "flexapod", "svg.fonttype": "path"}
    house().savefig(HERE / "house.svg", bbox_inches="tight", pad_inches=0.06, metadata={"Date": None})


if __name__ == "__main__":
    main()
