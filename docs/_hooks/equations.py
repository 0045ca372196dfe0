"""Equations, set by KaTeX while the site is built: pages need no script, and a wrong equation is a warning."""

from __future__ import annotations

import html
import logging
import re
from pathlib import Path
from typing import TYPE_CHECKING

from py_mini_racer import JSEvalException, MiniRacer

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

log = logging.getLogger("mkdocs.hooks.equations")
KATEX = Path(__file__).with_name("katex.min.js")

#: What `pymdownx.arithmatex` leaves where $...$ and $$...$$ were.
EQUATION = re.compile(
    r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>',
    re.DOTALL,
)


def set_equations(text: str, where: str) -> str:
    """HTML with its equations set."""
    with MiniRacer() as engine:
        engine.eval(KATEX.read_text(encoding="utf-8"))

        def set_one(match: re.Match[str]) -> str:
            display = match[1] == "div"
            options = {"displayMode": display, "throwOnError": True, "strict": "error"}
            try:
                done = engine.call("katex.renderToString", html.unescape(match[2]).strip(), options)
            except JSEvalException as error:
                log.warning("%s: the equation %r: %s", where, match[2].strip(), str(error).splitlines()[0])
                return match[0]
            return f'<div class="equation">{done}</div>' if display else str(done)

        return EQUATION.sub(set_one, text)


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    return set_equations(html, page.file.src_uri) if 'class="arithmatex"' in html else html
