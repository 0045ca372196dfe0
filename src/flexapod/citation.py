"""How to cite Flexapod and the paper whose model it computes: the one place of it, from which CITATION.cff is made."""

from __future__ import annotations

from textwrap import wrap
from typing import Any

RELEASED: str | None = None  # the date of this version, as 2026-12-01; None until then

SOFTWARE: dict[str, Any] = {
    "title": "Flexapod: dynamics, stability and vibration of flexible 6-UPS Stewart platforms",
    "authors": ["The Flexapod developers"],
    "license": "MIT",
    "abstract": "A Python package with a C++20 core for the dynamic stability index, natural modes, vibration, "
    "workspace, design and control of six-legged parallel machines whose legs are axial springs with mass, on a base "
    "that may move.",
    "keywords": ["hexapod", "Stewart platform", "parallel robot", "vibration", "natural frequency"],
}
PAPER: dict[str, Any] = {
    "title": "Dynamic stability index and vibration analysis of a flexible Stewart platform",
    "authors": [("Mukherjee", "P."), ("Dasgupta", "B."), ("Mallik", "A. K.")],
    "journal": "Journal of Sound and Vibration",
    "volume": 307,
    "issue": "3-5",
    "pages": (495, 512),
    "year": 2007,
}
_NAMES = ("Stewart", "Flexapod", "6-UPS")  # whose letters BibTeX must keep


def entries() -> dict[str, dict[str, Any]]:
    """What is cited: the software, of this version, and the paper."""
    from flexapod import __version__

    released = {} if RELEASED is None else {"released": RELEASED}
    paper = {**PAPER, "authors": [f"{given} {family}" for family, given in PAPER["authors"]]}
    return {"software": {**SOFTWARE, "version": __version__, **released}, "paper": paper}


def bibtex() -> str:
    """Both as BibTeX."""
    software = entries()["software"]
    paper = {
        "author": " and ".join(f"{family}, {given}" for family, given in PAPER["authors"]),
        "title": _kept(PAPER["title"]),
        "journal": PAPER["journal"],
        "volume": PAPER["volume"],
        "number": PAPER["issue"].replace("-", "--"),
        "pages": "{}--{}".format(*PAPER["pages"]),
        "year": PAPER["year"],
    }
    own = {
        "author": " and ".join(f"{{{name}}}" for name in software["authors"]),
        "title": _kept(software["title"]),
        "version": software["version"],
        **({} if RELEASED is None else {"year": RELEASED[:4], "date": RELEASED}),
        "license": software["license"],
    }
    return "\n\n".join((_entry("article", "mukherjee2007", paper), _entry("software", "flexapod", own)))


def cff() -> str:
    """Both as the text of CITATION.cff, in the Citation File Format 1.2.0."""
    software = entries()["software"]
    people = [f"      - family-names: {family}\n        given-names: {given}" for family, given in PAPER["authors"]]
    lines = [
        "cff-version: 1.2.0",
        "message: If you use Flexapod in research, please cite it together with the paper whose model it computes.",
        "type: software",
        f'title: "{software["title"]}"',
        f"version: {software['version']}",
        *([] if RELEASED is None else [f"date-released: {RELEASED}"]),
        f"license: {software['license']}",
        "authors:",
        *(f"  - name: {name}" for name in software["authors"]),
        "abstract: >-",
        *wrap(software["abstract"], 118, initial_indent="  ", subsequent_indent="  "),
        "keywords:",
        *(f"  - {word}" for word in software["keywords"]),
        "references:",
        "  - type: article",
        f"    title: {PAPER['title']}",
        "    authors:",
        *people,
        f"    journal: {PAPER['journal']}",
        f"    volume: {PAPER['volume']}",
        f"    issue: {PAPER['issue']}",
        f"    start: {PAPER['pages'][0]}",
        f"    end: {PAPER['pages'][1]}",
        f"    year: {PAPER['year']}",
    ]
    return "\n".join(lines) + "\n"


def _entry(kind: str, key: str, fields: dict[str, Any]) -> str:
    width = max(map(len, fields))
    return "\n".join(
        [f"@{kind}{{{key},", *(f"  {name:<{width}} = {{{value}}}," for name, value in fields.items()), "}"]
    )


def _kept(title: str) -> str:
    for name in _NAMES:
        title = title.replace(name, f"{{{name}}}")
    return title
