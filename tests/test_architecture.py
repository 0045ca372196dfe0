"""The house keeps its shape: imports only point down, files and functions stay small."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).parent.parent / "src" / "flexapod"
CORE = SOURCE.parent / "core"

# From the ground up; a module may import from lower floors only, so modules of one floor do not know one another.
# A module that is named nowhere is a study, which is what most new ones are.
STUDIES = "studies"
FLOORS = [
    ["_core", "errors", "units"],
    ["pose", "schema", "extras"],
    ["jointfile"],
    ["shorthands"],
    ["designfile"],
    ["hexapod"],
    ["states"],
    ["kinematics", "dynamics"],
    ["statics", "modal"],
    ["linear", "excitation", "posesets", "waypoints"],
    ["steady", "spectra", "recordings", "trajectory", "quantities"],
    ["requirements", "freespace", "feedback"],
    ["assessment", "smoothing"],
    ["laws", "sweeps"],
    ["optimal"],
    [STUDIES],
    ["plots", "interchange"],
    [
        "plots_response",
        "plots_sweep",
        "plots_simulation",
        "plots_control",
        "plots_path",
        "plots_optimise",
        "animate",
    ],
    ["paper"],
    ["report"],
    ["cli"],
    ["__main__"],
]
FLOOR = {name: number for number, names in enumerate(FLOORS) for name in names}

FILES = sorted(SOURCE.rglob("*.py"))
IDS = [str(path.relative_to(SOURCE)) for path in FILES]


def unit(path: Path) -> str:
    """The module or package directly below flexapod that a file belongs to."""
    return path.relative_to(SOURCE).parts[0].removesuffix(".py")


def floor(name: str) -> int:
    return FLOOR.get(name, FLOOR[STUDIES])


def imported(tree: ast.Module) -> set[str]:
    """Names directly below flexapod that a file imports, those for types and inside functions too."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names if alias.name.startswith("flexapod.")}
        elif isinstance(node, ast.ImportFrom) and node.module == "flexapod":
            names |= {f"flexapod.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            names |= {node.module} if node.module and node.module.startswith("flexapod.") else set()
    return {name.split(".")[1] for name in names} - {"__version__"}


@pytest.mark.parametrize("path", FILES, ids=IDS)
def test_imports_only_point_down(path):
    here = unit(path)
    if here == "__init__":
        return  # the front door names everything, lazily
    above = {name for name in imported(ast.parse(path.read_text())) if name != here and floor(name) >= floor(here)}
    assert not above, f"{here} (floor {floor(here)}) imports {sorted(above)}, which do not lie below it"


def test_the_rule_sees_a_wrong_import():
    tree = ast.parse("from flexapod import cli, errors\nimport flexapod.report.page\nfrom flexapod.pose import Pose")
    assert imported(tree) == {"cli", "errors", "report", "pose"}
    assert floor("kinematics") == floor("dynamics") < floor("some_new_study") < floor("cli")


@pytest.mark.parametrize("path", FILES, ids=IDS)
def test_files_and_functions_are_small(path):
    text = path.read_text()
    assert len(text.splitlines()) < 600
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            lines = (node.end_lineno or 0) - node.lineno + 1
            assert lines < 50, f"{node.name} has {lines} lines"


@pytest.mark.parametrize("path", sorted(CORE.iterdir()), ids=lambda path: path.name)
def test_the_core_knows_python_in_its_modules_only(path):
    text = path.read_text()
    assert len(text.splitlines()) < 600
    if path.name != "arrays.hpp" and not path.stem.endswith("module"):
        assert "nanobind" not in text
        assert "arrays.hpp" not in text
