"""Draws the pictures of the manual anew: python docs/images/draw.py [NAME ...], without names all of them.

A picture is drawn with the others of its script. Those of the page, of the view and of the tutorial need chromium.
"""

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent

#: Picture -> the script beside this one that draws it.
PICTURES = {
    "better.png": "draw_guides.py",
    "certificates.png": "draw_certificates.py",
    "envelope.png": "draw_guides.py",
    "flexures.png": "draw_flexures.py",
    "frames.svg": "draw_conventions.py",
    "house.svg": "draw_architecture.py",
    "importance.png": "draw_guides.py",
    "isolation.png": "draw_decisions.py",
    "leg.svg": "draw_conventions.py",
    "locus.png": "draw_decisions.py",
    "map.png": "draw_guides.py",
    "modes.png": "draw_guides.py",
    "paper-corrections.png": "draw_paper.py",
    "paper-frequencies.png": "draw_paper.py",
    "motors.png": "draw_motors.py",
    "plan-index.png": "draw_decisions.py",
    "plan.png": "draw_decisions.py",
    "response.png": "draw_guides.py",
    "robust.png": "draw_guides.py",
    "shock.png": "draw_guides.py",
    "signs.svg": "draw_conventions.py",
    "statics.png": "draw_guides.py",
    "tutorial-better.png": "draw_tutorial.py",
    "tutorial-map.png": "draw_tutorial.py",
    "tutorial-report.png": "draw_tutorial.py",
    "two-columns.png": "draw_guides.py",
    "view-dark.png": "draw_view.py",
    "view-light.png": "draw_view.py",
    "web-dark.png": "draw_page.py",
    "web-light.png": "draw_page.py",
}


def draw(names: list[str]) -> None:
    if unknown := sorted(set(names) - set(PICTURES)):
        sys.exit(f"There is no picture {', '.join(unknown)}; give some of {', '.join(PICTURES)}.")
    for script in dict.fromkeys(PICTURES[name] for name in names):
        subprocess.run([sys.executable, HERE / script], check=True)


if __name__ == "__main__":
    draw(sys.argv[1:] or list(PICTURES))
