"""Pages that show the sources of the core, and links to what they define: `[legs](core:model/leg.hpp#LegAxes)`."""

from __future__ import annotations

import logging
import re
from pathlib import Path
from posixpath import relpath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

log = logging.getLogger("mkdocs.hooks.core_sources")
CORE = Path(__file__).parents[2] / "src" / "core"
LINK = re.compile(r'href="core:([^"#]*)(?:#([^"]*))?"')

#: How the first line of a definition looks, the likelier form first. A line that ends in ; only declares or calls.
DEFINITIONS = (
    r"\b(?:struct|class|enum|union|concept|namespace)\s+(?:class\s+)?{name}\b(?![^{{]*;\s*(?://.*)?$)",
    r"\busing\s+{name}\s*=|#define\s+{name}\b",
    r"^(?!\s*(?:return|else|throw|if|for|while|case)\b)(?:\s*template <[^>]*>)?[\w\s:<>,&*~\[\]]*(?<![\w.>]){name}\s*\((?!.*;\s*(?://.*)?$)",
    r"^\s*(?:(?:inline|static|extern|const|constexpr|constinit)\s+)+[\w\s:<>,&*]*\b{name}\s*[=({{\[]",
    r"^\s*(?!return|struct|class|enum|using|else|throw)[A-Za-z_][\w:<>,\s]*[\s>&*,]{name}\s*[,;=\[]",  # a member
)


def definition(text: str, symbol: str) -> int | None:
    """Line (from 1) of a source text that defines a symbol, `name` or `Outer::name`; None where nothing does."""
    lines, first = text.splitlines(), 0
    for name in symbol.split("::"):
        found = _line(lines, first, re.escape(name))
        if found is None:
            return None
        first = found
    return first + 1


def _line(lines: list[str], first: int, name: str) -> int | None:
    for form in DEFINITIONS:
        pattern = re.compile(form.format(name=name))
        for number in range(first, len(lines)):
            if pattern.search(lines[number].split("//")[0]):
                return number
    return None


def page(path: Path) -> str:
    """Markdown of the page that shows a file."""
    front = "---\nhide: [navigation, toc]\nsearch: {exclude: true}\n---\n\n"
    title = f"# {path.name}\n\n`src/core/{path.relative_to(CORE).as_posix()}`\n\n"
    return f'{front}{title}```cpp linenums="1"\n{path.read_text(encoding="utf-8").rstrip()}\n```\n'


def on_files(files: Files, config: MkDocsConfig) -> Files:
    from mkdocs.structure.files import File

    for path in sorted(CORE.rglob("*.[hc]pp")):
        files.append(File.generated(config, f"core/{path.relative_to(CORE).as_posix()}.md", content=page(path)))
    return files


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    def target(match: re.Match[str]) -> str:
        name, symbol = match[1], match[2]
        file = files.get_file_from_path(f"core/{name}.md")
        if file is None:
            log.warning("%s links to core:%s, which is no file of src/core", page.file.src_uri, name)
            return match[0]
        url = relpath(file.url, Path(page.url).parent.as_posix())
        if not symbol:
            return f'href="{url}"'
        line = definition((CORE / name).read_text(encoding="utf-8"), symbol)
        if line is None:
            log.warning("%s links to core:%s#%s, which that file does not define", page.file.src_uri, name, symbol)
            return match[0]
        return f'href="{url}#__span-0-{line}"'

    return LINK.sub(target, html)
