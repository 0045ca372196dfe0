"""The notebooks as pages: each is run by a kernel, and its cells, words, tables and figures are written in Markdown."""

from __future__ import annotations

import base64
import re
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

FOLDER = Path(__file__).parents[1] / "notebooks"


def run(path: Path) -> Any:
    """A notebook with its outputs, which a kernel of its own gives it."""
    import nbformat
    from nbclient import NotebookClient

    book = nbformat.read(path, as_version=4)
    with TemporaryDirectory() as folder:
        NotebookClient(book, timeout=600, startup_timeout=300, resources={"metadata": {"path": folder}}).execute()
    return book


def page(book: Any, name: str) -> tuple[str, dict[str, bytes]]:
    """The Markdown of a notebook that was run, and its pictures by their files' names."""
    parts, pictures = [], {}
    for number, cell in enumerate(book.cells):
        if cell.cell_type == "markdown":
            parts.append(cell.source)
            continue
        parts.append(f"```python\n{cell.source}\n```")
        for place, output in enumerate(cell.outputs):
            file = f"{name}-{number}-{place}.png"
            text, picture = _shown(output, file)
            parts += [text] if text else []
            pictures |= {file: picture} if picture else {}
    title, rest = parts[0].split("\n", 1)
    way = f"This page is a notebook: [{name}.ipynb]({name}.ipynb)."
    return "\n\n".join([title, way, rest.strip(), *parts[1:]]) + "\n", pictures


def _shown(output: Any, file: str) -> tuple[str, bytes]:
    """What a page shows of an output of a cell, and its picture."""
    if output.output_type == "stream":
        return f"```text\n{output.text.rstrip()}\n```", b""
    data = output.get("data", {})
    if "image/png" in data:
        return f"![What the cell above draws]({file})", base64.b64decode(data["image/png"])
    if html := data.get("text/html", ""):
        one_line = re.sub(r"\n\s*", " ", html)
        return f'<div class="result">{one_line}</div>', b""
    text = data.get("text/plain", "")
    drawn = text.startswith("<Axes")  # the figure comes after it
    return (f"<pre>{escape(text)}</pre>" if text and not drawn else ""), b""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    from mkdocs.structure.files import File

    for path in sorted(FOLDER.glob("*.ipynb")):
        text, pictures = page(run(path), path.stem)
        files.append(File.generated(config, f"notebooks/{path.stem}.md", content=text))
        for name, picture in pictures.items():
            files.append(File.generated(config, f"notebooks/{name}", content=picture))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Links to notebooks lead to their pages."""
    inside = page.file.src_uri.startswith("notebooks/")
    return markdown if inside else re.sub(r"\]\((notebooks/\w+)\.ipynb\)", r"](\1.md)", markdown)
