"""Draws the figures of docs/paper.md: python docs/images/draw_paper.py"""

from pathlib import Path

from flexapod.paper import Settings, draw

HERE = Path(__file__).parent

if __name__ == "__main__":
    for part, name in (("natural-frequencies", "frequencies"), ("corrections", "corrections")):
        draw(part, Settings()).figure.savefig(HERE / f"paper-{name}.png", dpi=160)
