"""The core's stub, `_core.pyi`, says what the compiled module has: its names, arguments and types."""

import ast
import enum
import re
from importlib import resources

import pytest

from flexapod import _core

STUB = ast.parse((resources.files("flexapod") / "_core.pyi").read_text(encoding="utf-8"))
ALL_CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}
ENUMS = {name: node for name, node in ALL_CLASSES.items() if node.bases}
CLASSES = {name: node for name, node in ALL_CLASSES.items() if name not in ENUMS}
FUNCTIONS = {node.name: node for node in STUB.body if isinstance(node, ast.FunctionDef)}
VALUES = {node.target.id: node for node in STUB.body if isinstance(node, ast.AnnAssign)}
METHODS = {
    f"{name}.{item.name}": item
    for name, node in CLASSES.items()
    for item in node.body
    if isinstance(item, ast.FunctionDef)
}

# What the stub says -> what the compiled module says, which has no words for arrays that it makes, nor for callables.
SAME = {"_A": "ndarray", "list[_A]": "Sequence[ndarray]", "Callable[[float], object] | None": "object | None"}


def compiled(name: str) -> ast.FunctionDef:
    """The signature that a compiled function has, read as the stub is."""
    here = _core
    for part in name.split("."):
        here = getattr(here, part)
    here = here.fget if isinstance(here, property) else here
    ((signature, *_),) = here.__nb_signature__
    plain = re.sub(r"ndarray\[[^\]]*\]", "ndarray", signature).replace("collections.abc.", "")
    plain = plain.replace("flexapod._core.", "").replace("def (", "def get(")
    return ast.parse(f"{plain}: ...").body[0]


def arguments(function: ast.FunctionDef) -> list[str | None]:
    named = [argument.arg for argument in function.args.args + function.args.kwonlyargs]
    assert named in ([], ["self"]), f"{function.name} takes arguments by position only"
    types = [argument.annotation and ast.unparse(argument.annotation) for argument in function.args.posonlyargs]
    types += [None] * len(named)
    return [SAME.get(kind, kind) for kind in types]


def result(function: ast.FunctionDef) -> str:
    kind = ast.unparse(function.returns)
    return "object" if kind == "_A" else kind.split("[")[0]


def public(thing) -> set[str]:
    return {name for name in vars(thing) if not name.startswith("_")}


def test_the_names_are_those_of_the_module():
    assert {*ALL_CLASSES, *FUNCTIONS, *VALUES} == public(_core)
    for name, node in CLASSES.items():
        assert {item.name for item in node.body if isinstance(item, ast.FunctionDef)} - {"__init__"} == public(
            getattr(_core, name)
        )


@pytest.mark.parametrize("name", ENUMS)
def test_an_enumeration_has_its_members(name):
    stub = {item.targets[0].id: item.value.value for item in ENUMS[name].body if isinstance(item, ast.Assign)}
    found = getattr(_core, name)
    assert issubclass(found, {"Enum": enum.Enum, "Flag": enum.Flag}[ast.unparse(ENUMS[name].bases[0])])
    assert stub == {member.name: member.value for member in found}


@pytest.mark.parametrize("name", [*FUNCTIONS, *METHODS])
def test_a_signature_is_that_of_the_function(name):
    stub, found = {**FUNCTIONS, **METHODS}[name], compiled(name)
    assert arguments(stub) == arguments(found)
    if not stub.decorator_list or result(found) != "object":  # a property that makes its value is just an object
        assert result(stub) == result(found)


@pytest.mark.parametrize("name", VALUES)
def test_a_value_has_its_type(name):
    kind = ast.unparse(VALUES[name].annotation).split("[")[0]
    assert type(getattr(_core, name)).__name__ == kind
