"""What the pages of all reports are made of: one HTML file each that needs nothing else."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from datetime import date
from html import escape
from pathlib import Path

from matplotlib.figure import Figure

from flexapod import __version__
from flexapod.design.hexapod import Hexapod
from flexapod.report import figures

Card = tuple[str, str, str]  # title, value, unit


def frame(title: str, body: str) -> str:
    """A page with a title around what is in it."""
    style = (Path(__file__).parent / "page.css").read_text(encoding="utf-8")
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>\n{style}</style>\n</head>\n"
        f"<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def short(hexapod: Hexapod, subject: str, subtitle: str, cards: Iterable[Card], sections: Iterable[str]) -> str:
    """A short report: a heading, the main numbers (the first marked), sections of HTML, what it was made from."""
    heading = f'<header>\n<h1>{escape(hexapod.name)}</h1>\n<p class="quiet">{escape(subtitle)}</p>\n</header>'
    boxes = ""
    for number, (title, value, unit) in enumerate(cards):
        kind = "" if number else ' class="first"'
        boxes += f"<div{kind}><dt>{escape(title)}</dt><dd>{value} <span>{escape(unit)}</span></dd></div>"
    parts = [heading, f'<dl class="key">{boxes}</dl>', *sections, foot(hexapod)]
    return frame(f"{hexapod.name}: {subject}", "\n".join(part for part in parts if part))


def foot(hexapod: Hexapod) -> str:
    """What a page was made with and from."""
    return (
        f'<footer class="quiet">Flexapod {__version__}, {date.today().isoformat()}. Design '
        f"{escape(hexapod.name)}, digest <code>{hexapod.digest}</code>.</footer>"
    )


def beware(messages: Sequence[str]) -> str:
    """Warnings in a box; nothing where there are none."""
    items = "".join(f"<li>{escape(text)}</li>" for text in messages)
    return f'<section class="warnings"><h3>To beware of</h3><ul>{items}</ul></section>' if messages else ""


def drawing(draw: Callable[[], Figure], name: str, heading: str, caption: str) -> str:
    """A section with one figure, drawn so that its words are text."""
    svg = figures.drawn(draw, name, heading)
    return f"<h2>{escape(heading)}</h2>\n<figure>{svg}<figcaption>{escape(caption)}</figcaption></figure>"


def table(head: Sequence[str], rows: Iterable[Sequence[str]], note: str = "") -> str:
    """Rows of HTML fragments; a cell may bring its own <td>."""
    top = "".join(f'<th scope="col">{title}</th>' for title in head)
    body = ""
    for name, *cells in rows:
        data = "".join(cell if cell.startswith("<td") else f"<td>{cell}</td>" for cell in cells)
        body += f'<tr><th scope="row">{name}</th>{data}</tr>'
    below = f'<p class="quiet">{note}</p>' if note else ""
    return f'<div class="scroll"><table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table></div>{below}'
