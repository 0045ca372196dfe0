"""Pages of studies: one HTML file each that needs nothing else, no network, no script, figures inline."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from datetime import date
from html import escape
from pathlib import Path

from flexapod import __version__
from flexapod.design.hexapod import Hexapod
from flexapod.report import figures
from flexapod.report.numbers import percent, shown
from flexapod.report.study import Bars, Column, Drawing, Section, Study, Table, shown_on


def page(study: Study) -> str:
    """A study as a whole page."""
    parts = [_head(study), _beware(study), *map(_section, study.sections), foot(study.hexapod)]
    return frame(f"{study.hexapod.name}: {study.subject}", "\n".join(part for part in parts if part))


def frame(title: str, body: str) -> str:
    """A page with a title around what is in it."""
    style = (Path(__file__).parent / "page.css").read_text(encoding="utf-8")
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>\n{style}{_running(title)}</style>\n</head>\n"
        f"<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _running(title: str) -> str:
    """The title at the top of every printed page but the first, as a rule of the style sheet."""
    text = "".join(f"\\{ord(letter):x} " if letter in '\\"<&\n\r\f' else letter for letter in title)
    return f'@page {{ @top-left {{ content: "{text}"; }} }}\n@page :first {{ @top-left {{ content: none; }} }}\n'


def foot(hexapod: Hexapod) -> str:
    """What a page was made with and from."""
    return (
        f'<footer class="quiet">Flexapod {__version__}, {date.today().isoformat()}. Design '
        f"{escape(hexapod.name)}, digest <code>{hexapod.digest}</code>.</footer>"
    )


def rows_table(
    head: Sequence[str], rows: Iterable[Sequence[str]], note: str = "", kind: str = "", caption: str = ""
) -> str:
    """Rows of HTML fragments, the first of each a row's name; a cell may bring its own <td>. No titles: no head."""
    top = "".join(f'<th scope="col">{title}</th>' for title in head)
    body = ""
    for name, *cells in rows:
        data = "".join(cell if cell.startswith("<td") else f"<td>{cell}</td>" for cell in cells)
        body += f'<tr><th scope="row">{name}</th>{data}</tr>'
    below = f'<p class="quiet">{escape(note)}</p>' if note else ""
    above = f"<thead><tr>{top}</tr></thead>" if any(head) else ""
    start = f'<table class="{kind}">' if kind else "<table>"
    over = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f'<div class="scroll">{start}{over}{above}<tbody>{body}</tbody></table></div>{below}'


def _head(study: Study) -> str:
    boxes = ""
    for number, row in enumerate(shown_on(study.rows, "page")):
        value = row.value if isinstance(row.value, str) else shown(row.value, row.digits)
        kind = "" if number else ' class="first"'
        words = escape(" ".join(filter(None, (row.unit, row.note))))
        boxes += f"<div{kind}><dt>{escape(row.label)}</dt><dd>{escape(value)} <span>{words}</span></dd></div>"
    about = f'<h1>{escape(study.hexapod.name)}</h1>\n<p class="quiet">{escape(study.about)}</p>'
    return f"<header>\n{about}\n</header>\n" + (f'<dl class="key">{boxes}</dl>' if boxes else "")


def _beware(study: Study) -> str:
    """Cautions, and what the design assumes, in a box; nothing where there are none."""
    texts = [*(caution.text for caution in study.cautions), study.assumed]
    items = "".join(f"<li>{escape(text)}</li>" for text in filter(None, texts))
    return f'<section class="warnings"><h3>To beware of</h3><ul>{items}</ul></section>' if items else ""


def _section(section: Section) -> str:
    words = "".join(f"<p>{escape(text)}</p>" for text in section.words)
    if section.legend:
        words += f'<p class="quiet">{"".join(_swatch(*one) for one in section.legend)}</p>'
    items = [_item(item, section) for item in shown_on(section.items, "page")]
    if section.style == "pair":
        items = [item if item.startswith("<figure") else f"<div>{item}</div>" for item in items]
    body = f'<div class="{section.style}">{"".join(items)}</div>' if section.style else "\n".join(items)
    return f"<h2>{escape(section.title)}</h2>\n{words}{body}"


def _item(item: Table | Bars | Drawing, section: Section) -> str:
    if isinstance(item, Drawing):
        return _figure(item, heading=item.title if item.title != section.title and section.style != "pair" else "")
    return _bars(item) if isinstance(item, Bars) else _table(item, item.title if item.title != section.title else "")


def _figure(drawing: Drawing, heading: str) -> str:
    tag = f' <span class="hz">{escape(drawing.tag)}</span>' if drawing.tag else ""
    top = f"<h3>{escape(heading)}{tag}</h3>" if heading else ""
    below = f"<figcaption>{escape(drawing.caption)}</figcaption>" if drawing.caption else ""
    kind = ' class="wide"' if drawing.wide else ""
    return f"<figure{kind}>{top}{figures.inline(drawing)}{below}</figure>"


def _table(table: Table, caption: str) -> str:
    columns = shown_on(table.columns, "page")
    head = [escape(", ".join(filter(None, (column.title, column.unit)))) for column in columns]
    cells = [[cell(column, i, table.style) for i in range(len(column.values))] for column in columns]
    return rows_table(head, zip(*cells, strict=True), table.note, table.style, caption)


def cell(column: Column, i: int, style: str = "") -> str:
    """A cell of a table as a fragment of HTML."""
    value = column.values[i]
    if isinstance(value, str):
        text = escape(value)
    elif style == "heat":
        share = float(value)  # type: ignore[arg-type]
        tint = f' style="--share:{max(0.0, 60 * share):.0f}%"' if math.isfinite(share) else ""
        return f"<td{tint}>{percent(share)}</td>"
    else:
        text = shown(value, column.digits)
    marked = column.marked is not None and column.marked[i]
    return f'<td class="over">{text}</td>' if marked else text


def _bars(bars: Bars) -> str:
    largest = max((abs(effect) for effect in bars.effects), default=1.0)
    made = ""
    for name, effect, detail in zip(bars.names, bars.effects, bars.details, strict=True):
        width = 50 * abs(effect) / largest
        left = 50.0 if effect > 0 else 50 - width
        kind = "bar" if effect > 0 else "bar less"
        small = f"<small>{escape(detail)}</small>" if detail else ""
        made += (
            f'<div>{escape(name)}{small}</div><div class="track"><div class="{kind}" '
            f'style="left:{left:.2f}%;width:{width:.2f}%"></div></div><div class="value">{100 * effect:+.3f} %</div>'
        )
    return f'<div class="bars">{made}</div>'


def _swatch(words: str, colour: str) -> str:
    mark = f'<span class="swatch" style="background:{colour}"></span>' if colour else ""
    return f"{mark}{escape(words)} "
