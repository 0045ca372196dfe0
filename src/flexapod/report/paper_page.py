"""The page of the paper done anew: each part with its figure, its tables, and the paper's statements beside ours."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from datetime import date
from html import escape

import pandas as pd

from flexapod import __version__
from flexapod.design.loading import load
from flexapod.paper import Claim, Part
from flexapod.report import figures, html

TITLE = "The paper reproduced"
_SOURCE = (
    "P. Mukherjee, B. Dasgupta, A. K. Mallik, \u201cDynamic stability index and vibration analysis of a flexible "
    "Stewart platform\u201d, Journal of Sound and Vibration (2007): what of it can be computed, computed anew."
)
_MARKS = {"agrees": "\u2713 agrees", "differs": "\u2260 differs", "open": "? open"}
_CHAPTERS = {
    "figure-2": "Figures",
    "natural-frequencies": "Natural frequencies",
    "conclusion-1": "The three conclusions",
    "corrections": "Corrections and readings",
}
_CORRECTED = (
    "The printed equations have errors. Each is switched on here as the term that it adds to the correct equations, "
    "and the accelerations that follow are compared with those of an independent engine. Appendix A has slips of the "
    "print as well, and leaves data out; what each reading does to the natural frequencies is in the second table."
)


def page(parts: Sequence[Part]) -> str:
    """The whole page."""
    return html.frame(TITLE, "\n".join([_head(parts), _contents(parts), *(_section(part) for part in parts), _foot()]))


def comparison(parts: Sequence[Part]) -> pd.DataFrame:
    """All statements of the paper beside what is found, a row each."""
    rows = [{"part": part.name, **claim._asdict()} for part in parts for claim in part.claims]
    return pd.DataFrame(rows, columns=["part", *Claim._fields]).set_index("part")


def verdicts(parts: Sequence[Part]) -> Counter[str]:
    """How many statements agree, differ, stay open."""
    return Counter(claim.verdict for part in parts for claim in part.claims)


def _head(parts: Sequence[Part]) -> str:
    count = verdicts(parts)
    words = {"agrees": "agree with the paper", "differs": "differ, with the reason", "open": "left open by the print"}
    boxes = f'<div class="first"><dt>Statements compared</dt><dd>{sum(count.values())}</dd></div>'
    boxes += "".join(f"<div><dt>{text}</dt><dd>{count[verdict]}</dd></div>" for verdict, text in words.items())
    return f'<header>\n<h1>{TITLE}</h1>\n<p class="quiet">{_SOURCE}</p>\n</header>\n<dl class="key">{boxes}</dl>'


def _contents(parts: Sequence[Part]) -> str:
    rows = []
    for part in parts:
        count = verdicts([part])
        link = f'<a href="#{part.name}">{escape(part.title)}</a>'
        rows.append([link, *(str(count[verdict] or "") for verdict in _MARKS)])
    return f'<div class="contents">{html.rows_table(["part", *_MARKS], rows)}</div>'


def _section(part: Part) -> str:
    chapter = _CHAPTERS.get(part.name)
    top = f"<h2>{chapter}</h2>\n" if chapter else ""
    if part.name == "corrections":
        top += f"<p>{_CORRECTED}</p>\n"
    svg = figures.drawn(lambda: part.figure, part.name, part.title)
    links = ", ".join(f'<a href="{part.name}.{kind}">{kind.upper()}</a>' for kind in ("png", "svg", "csv", "json"))
    caption = f"{escape(part.caption)} {links}."
    return (
        f'{top}<section class="part" id="{part.name}">\n<h3>{escape(part.title)}</h3>\n'
        f"<figure>{svg}<figcaption>{caption}</figcaption></figure>\n{_shown(part)}{_claims(part)}</section>"
    )


def _shown(part: Part) -> str:
    if part.shown is None:
        return ""
    frame = part.shown
    wordy = [_in_words(list(frame[column])) for column in frame.columns]
    rows = [
        [escape(str(name)), *(_cell(text, words) for text, words in zip(row, wordy, strict=True))]
        for name, row in zip(frame.index, frame.values, strict=True)
    ]
    titles = zip(frame.columns, wordy, strict=True)
    head = [escape(str(frame.index.name or "")), *(_cell(str(title), words, "span") for title, words in titles)]
    return html.rows_table(head, rows)


def _in_words(column: list[str]) -> bool:
    """Whether a column holds words, which stand to the left in lines, rather than numbers."""
    return any(sum(letter.isalpha() for letter in text) > 8 for text in column)


def _cell(text: str, words: bool, tag: str = "td") -> str:
    return f'<{tag} class="words">{escape(text)}</{tag}>' if words else escape(text)


def _claims(part: Part) -> str:
    head = '<th scope="col">The paper</th><th scope="col">Here</th><th scope="col"></th>'
    rows = ""
    for claim in part.claims:
        why = f' <span class="quiet">{escape(claim.why)}</span>' if claim.why else ""
        mark = f'<td class="verdict {claim.verdict}">{_MARKS[claim.verdict]}</td>'
        rows += f"<tr><td>{escape(claim.paper)}</td><td>{escape(claim.ours)}{why}</td>{mark}</tr>"
    return f'<table class="claims"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>'


def _foot() -> str:
    designs = ", ".join(f"{name} <code>{load(name).digest}</code>" for name in ("mukherjee-i", "mukherjee-ii"))
    return f'<footer class="quiet">Flexapod {__version__}, {date.today().isoformat()}. Designs {designs}.</footer>'
