"""Pages whose text is elsewhere in the repository, and links that leave docs/ as they do where the files are read."""

from __future__ import annotations

import ast
import posixpath
import re
from pathlib import Path
from posixpath import normpath, relpath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

ROOT = Path(__file__).parents[2]

#: File of the repository -> page of the site.
PAGES = {"benchmarks/README.md": "benchmarks.md", "CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md"}
LINK = re.compile(r"(\]\()(?![a-z]+:|#|/)([^)\s#]+)(#[^)\s]*)?(\))")


def in_site(path: str) -> str:
    """Path in docs/ (or of the page that stands for it) of a file of the repository."""
    if path in PAGES:
        return PAGES[path]
    if path.startswith("docs/"):
        return path.removeprefix("docs/")
    if path.startswith("examples/") and path.endswith((".py", ".toml")):
        return f"examples.md#{Path(path).stem}"
    if path.startswith("src/core/"):
        return f"{path.removeprefix('src/')}.md"
    return "index.md" if path == "README.md" else path


def mended(markdown: str, folder: str, page: str = "") -> str:
    """Text of a file in `folder` of the repository, its links made those of a page in the site's folder `page`."""

    def target(match: re.Match[str]) -> str:
        place = relpath(in_site(normpath(f"{folder}/{match[2]}")), page or ".")
        return f"{match[1]}{place}{match[3] or ''}{match[4]}"

    return LINK.sub(target, markdown)


def examples() -> str:
    """A page of all examples: their own introduction, what each answers, and its lines; then the designs."""
    folder = ROOT / "examples"
    parts = [mended((folder / "README.md").read_text(encoding="utf-8"), "examples")]
    for path in sorted(folder.glob("[!_]*.py")):
        source = path.read_text(encoding="utf-8")
        tree = ast.parse(source)
        title, _, more = (ast.get_docstring(tree) or path.stem).partition("\n")
        code = "".join(source.splitlines(keepends=True)[tree.body[0].end_lineno :]).strip()
        head = f"## {title.rstrip('.')} {{ #{path.stem} }}"
        parts.append(f'{head}\n\n{more.strip()}\n\n```python title="examples/{path.name}"\n{code}\n```')
    for path in sorted(folder.glob("machines/*.toml")):
        head = f"## The design {path.stem} {{ #{path.stem} }}"
        text = path.read_text(encoding="utf-8").strip()
        parts.append(f'{head}\n\n```toml title="examples/machines/{path.name}"\n{text}\n```')
    return "\n\n".join(parts) + "\n"


def images(markdown: str, folder: str) -> list[str]:
    """Pictures in the repository, outside docs/, that a text shows."""
    paths = [normpath(f"{folder}/{match[2]}") for match in LINK.finditer(markdown)]
    return [path for path in paths if Path(path).suffix in {".png", ".svg"} and not path.startswith("docs/")]


def on_files(files: Files, config: MkDocsConfig) -> Files:
    from mkdocs.structure.files import File

    files.append(File.generated(config, "examples.md", content=examples()))
    files.append(File.generated(config, "assets/icon.svg", abs_src_path=str(ROOT / "web" / "public" / "icon.svg")))
    for source, name in PAGES.items():
        if not (ROOT / source).exists():
            continue  # the navigation names it, so the build says that it is missing
        text, folder = (ROOT / source).read_text(encoding="utf-8"), Path(source).parent.as_posix()
        files.append(File.generated(config, name, content=mended(text, folder)))
        for image in images(text, folder):
            files.append(File.generated(config, image, abs_src_path=str(ROOT / image)))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    if page.file.generated_by:
        return markdown
    return leaving(markdown, posixpath.dirname(page.file.src_uri))


def leaving(markdown: str, page: str) -> str:
    """Markdown of a page in a folder of docs/, with those of its links mended that leave docs/."""
    folder = f"docs/{page}"

    def target(match: re.Match[str]) -> str:
        inside = normpath(f"{folder}/{match[2]}").startswith("docs/")
        return match[0] if inside else mended(match[0], folder, page)

    return LINK.sub(target, markdown)
