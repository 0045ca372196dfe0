"""The core's stub, `_core.pyi`, says what the compiled module has: its names, arguments and types."""

import ast
import enum
import re
from importlib import resources
from typing import NamedTuple, get_args

import pytest

from flexapod import _core, conventions
from flexapod.control import linear_controller

STUB = ast.parse((resources.files("flexapod") / "_core.pyi").read_text(encoding="utf-8"))
ALL_CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}
ENUMS = {name: node for name, node in ALL_CLASSES.items() if node.bases}
CLASSES = {name: node for name, node in ALL_CLASSES.items() if name not in ENUMS}
VALUES = {node.target.id: node for node in STUB.body if isinstance(node, ast.AnnAssign)}


class Signature(NamedTuple):
    positional: list[str]  # types
    named: list[tuple[str, str]]  # names and types
    result: str


def functions(body: list[ast.stmt], before: str = "") -> dict[str, list[ast.FunctionDef]]:
    """Functions by name, overloads together."""
    found: dict[str, list[ast.FunctionDef]] = {}
    for node in body:
        if isinstance(node, ast.FunctionDef):
            found.setdefault(before + node.name, []).append(node)
    return found


FUNCTIONS = functions(STUB.body)
for _name, _node in CLASSES.items():
    FUNCTIONS |= functions(_node.body, f"{_name}.")


def signature(function: ast.FunctionDef) -> Signature:
    given = function.args
    plain = [argument for argument in given.posonlyargs + given.args if argument.arg != "self"]
    return Signature(
        [argument_type(argument) for argument in plain],
        [(argument.arg, argument_type(argument)) for argument in given.kwonlyargs],
        simple(ast.unparse(function.returns)).split("[")[0],
    )


def argument_type(argument: ast.arg) -> str:
    """As the compiled module says it, which has no words for callables, and takes any sequence for a list."""
    kind = simple(ast.unparse(argument.annotation)).replace("list[", "Sequence[")
    return kind.replace("Callable[[float], object]", "object")


def simple(kind: str) -> str:
    return re.sub(r"NDArray\[\w+\]|\b_A\b", "ndarray", kind)


def compiled(name: str) -> list[Signature]:
    """The signatures that a compiled function has, read as those of the stub are."""
    here = _core
    for part in name.split("."):
        here = getattr(here, part)
    here = here.fget if isinstance(here, property) else here
    found = []
    for text, *_ in here.__nb_signature__:
        plain = re.sub(r"(numpy\.)?ndarray\[[^\]]*\]", "ndarray", text).replace("collections.abc.", "")
        plain = plain.replace("flexapod._core.", "").replace("def (", "def get(")
        found.append(signature(ast.parse(f"{plain}: ...").body[0]))
    return found


def public(thing) -> set[str]:
    return {name for name in vars(thing) if not name.startswith("_")}


def test_the_names_are_those_of_the_module():
    names = {name for name in FUNCTIONS if "." not in name}
    assert {*ALL_CLASSES, *names, *VALUES} == public(_core)
    for name, node in CLASSES.items():
        attributes = {item.target.id for item in node.body if isinstance(item, ast.AnnAssign)}
        methods = {item.name for item in node.body if isinstance(item, ast.FunctionDef)} - {"__init__"}
        assert attributes | methods == public(getattr(_core, name))


@pytest.mark.parametrize("name", ENUMS)
def test_an_enumeration_has_its_members(name):
    stub = {item.targets[0].id: item.value.value for item in ENUMS[name].body if isinstance(item, ast.Assign)}
    found = getattr(_core, name)
    assert issubclass(found, {"Enum": enum.Enum, "Flag": enum.Flag}[ast.unparse(ENUMS[name].bases[0])])
    assert stub == {member.name: member.value for member in found}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_signature_is_that_of_the_function(name):
    stub, found = [signature(function) for function in FUNCTIONS[name]], compiled(name)
    # An array that a function makes is just an object to the compiled module.
    assert stub == [f._replace(result="ndarray") if f.result == "object" else f for f in found]


@pytest.mark.parametrize("name", CLASSES)
def test_an_attribute_has_its_type(name):
    for item in CLASSES[name].body:
        if isinstance(item, ast.AnnAssign):
            ((got,), set_) = compiled(f"{name}.{item.target.id}"), getattr(_core, name).__dict__[item.target.id].fset
            assert got.result == ast.unparse(item.annotation)
            assert set_ is not None, "an attribute of the stub may be set"


@pytest.mark.parametrize("name", VALUES)
def test_a_value_has_its_type(name):
    kind = ast.unparse(VALUES[name].annotation).split("[")[0]
    assert type(getattr(_core, name)).__name__ == kind


def test_names_written_for_type_checkers_are_those_of_the_core():
    assert conventions.JOINT_MODELS == get_args(conventions.JointModel) == tuple(_core.Joint.__members__)
    assert get_args(linear_controller.Measurement) == linear_controller.MEASUREMENTS == tuple(_core.Measure.__members__)
