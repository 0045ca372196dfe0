"""The folders are the architecture: imports only point down, files and functions stay small."""

import ast
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "flexapod"
CORE = SOURCE.parent / "core"

#: Folders and modules directly below flexapod, from the ground up. Each may import those before it.
ORDER = [
    "_suggestions",
    "_core",
    "showing",
    "errors",
    "citation",
    "conventions",
    "progress",
    "checks",
    "optional",
    "tables",
    "output_files",
    "rotations",
    "pose",
    "design",
    "mechanics",
    "workspace",
    "certificates",
    "excitation",
    "simulation",
    "vibration",
    "paths",
    "optimisation",
    "control",
    "interchange",
    "plots",
    "paper",
    "report",
    "web",
    "notebook",
    "cli",
    "__main__",
]
#: The same for the folders of the core.
CORE_ORDER = (
    "numbers",
    "simd",
    "threads",
    "decomposition",
    "model",
    "sweep",
    "certify",
    "simulation",
    "one_pose",
    "kernels",
    "bench",
    "bindings",
)
#: And for those of the page.
PAGE_ORDER = ("state", "widgets", "charts", "machine3d", "snapshot", "notebook", "panels", "app")

FILES = sorted(SOURCE.rglob("*.py"))
IDS = [str(path.relative_to(SOURCE)) for path in FILES]
SOURCES = sorted(CORE.rglob("*.[hc]pp"))
PAGE = SOURCE.parents[1] / "web" / "src"
PAGE_SOURCES = sorted(PAGE.rglob("*.ts"))


def place(path: Path) -> str:
    """The module or folder directly below flexapod that a file belongs to."""
    return path.relative_to(SOURCE).parts[0].removesuffix(".py")


@cache
def nodes_of(path: Path) -> list[ast.AST]:
    """All of a file's syntax tree, its root first."""
    return list(ast.walk(ast.parse(path.read_text())))


def imported(nodes: Iterable[ast.AST]) -> set[str]:
    """Names directly below flexapod that a file imports: also for types, inside functions, and by import_module.

    A module that imports flexapod itself can reach every name, and counts as one that imports the top.
    """
    names = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names if alias.name.split(".")[0] == "flexapod"}
        elif isinstance(node, ast.ImportFrom) and node.module == "flexapod":
            names |= {f"flexapod.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            names |= {node.module} if node.module and node.module.startswith("flexapod.") else set()
        elif isinstance(node, ast.Call) and _called(node.func) == "import_module":
            names |= {text for text in _strings(node.args[0]) if text.split(".")[0] == "flexapod"}
    below = {name.split(".")[1] if "." in name else "flexapod" for name in names}
    return below - {"__version__", "_version"}


@cache
def imported_by(path: Path) -> set[str]:
    return imported(nodes_of(path))


def _called(function: ast.expr) -> str | None:
    """The last part of the name of what is called."""
    return getattr(function, "attr", getattr(function, "id", None))


def _strings(node: ast.expr) -> set[str]:
    """The constant beginnings of what may be an f-string."""
    if isinstance(node, ast.JoinedStr):
        node = node.values[0]
    return {str(node.value)} if isinstance(node, ast.Constant) else set()


def floor(name: str) -> int:
    return ORDER.index(name) if name != "flexapod" else len(ORDER)


def test_every_folder_has_its_place_in_the_order():
    there = {path.stem for path in SOURCE.iterdir() if path.name not in ("__pycache__", "__init__.py", "__init__.pyi")}
    assert {name.split(".")[0] for name in there} - {"py"} == set(ORDER)
    assert {path.name for path in CORE.iterdir()} - {"README.md"} == set(CORE_ORDER)
    assert {path.name for path in PAGE.iterdir()} == set(PAGE_ORDER)


@pytest.mark.parametrize("path", FILES, ids=IDS)
def test_imports_only_point_down(path):
    here = place(path)
    if here == "__init__":
        return  # it names everything, lazily, in its stub
    above = {name for name in imported_by(path) if name != here and floor(name) >= floor(here)}
    assert not above, f"{here} imports {sorted(above)}, which do not lie below it"


@pytest.mark.parametrize("name", [name for name in ORDER if (SOURCE / name).is_dir()])
def test_a_package_says_what_it_imports(name):
    files = sorted((SOURCE / name).rglob("*.py"))
    used = set().union(*map(imported_by, files)) - {name}
    packages = [other for other in ORDER if other in used and (SOURCE / other).is_dir()]
    doc = ast.get_docstring(nodes_of(SOURCE / name / "__init__.py")[0])
    said = " ".join(doc.partition("May import: ")[2].split())
    assert said == f"{', '.join(packages) or 'no other package'}."


def test_the_rule_sees_a_wrong_import():
    code = (
        "from flexapod import cli, errors\nimport flexapod.report.page\nfrom flexapod.pose import Pose\n"
        "def late():\n    import flexapod as fx\n    import_module(f'flexapod.web.{name}')\n"
    )
    assert imported(ast.walk(ast.parse(code))) == {"cli", "errors", "report", "pose", "flexapod", "web"}
    assert floor("mechanics") < floor("workspace") < floor("cli") < floor("flexapod")


@pytest.mark.parametrize("path", FILES, ids=IDS)
def test_files_and_functions_are_small(path):
    assert len(path.read_text().splitlines()) <= 450
    for node in nodes_of(path):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            first = node.body[1] if ast.get_docstring(node) and len(node.body) > 1 else node.body[0]
            lines = (node.end_lineno or 0) - first.lineno + 1
            assert lines < 50, f"the body of {node.name} has {lines} lines"


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(CORE)))
def test_the_core_includes_downwards_and_knows_python_in_its_bindings_only(path):
    text = path.read_text()
    assert len(text.splitlines()) <= 400
    here = CORE_ORDER.index(path.parent.name)
    for line in text.splitlines():
        if line.startswith('#include "'):
            folder = line.split('"')[1].split("/")[0]
            assert CORE_ORDER.index(folder) <= here, f"{path.parent.name} includes {line}"
    if path.parent.name != "bindings":
        assert "nanobind" not in text


def page_imports(text: str) -> list[str]:
    """The other folders of the page that a TypeScript file imports."""
    return re.findall(r"(?:from|import|import\()\s*'\.\./([\w-]+)/", text)


def test_the_rule_sees_imports_of_the_page():
    code = "import '../a/x'\nimport { b } from '../b/x'\nconst c = await import('../c/x')\nimport './d'\n"
    assert page_imports(code) == ["a", "b", "c"]


@pytest.mark.parametrize("path", PAGE_SOURCES, ids=lambda path: str(path.relative_to(PAGE)))
def test_the_page_imports_downwards(path):
    """Biome holds the sizes of its functions (`make web-check`)."""
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 250
    assert all(len(line) <= 120 for line in text.splitlines())
    here = PAGE_ORDER.index(path.parent.name)
    for target in page_imports(text):
        assert PAGE_ORDER.index(target) < here, f"{path.parent.name} imports {target}"
