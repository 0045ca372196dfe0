"""Which of Flexapod's errors a function can raise, read off the source: what its docstring has to name.

`own(...)`: errors that it raises itself, or that helpers of its module raise for it. These are its checks, and
its docstring names them. `reachable(...)`: errors of everything that it calls, by name; it names no other.
Calls of methods count for every class that has a method of the name, so that `reachable` is rather too large.
"""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import flexapod
import flexapod.errors

SOURCE = Path(flexapod.errors.__file__).parent
ERRORS = {name for name, thing in vars(flexapod.errors).items() if isinstance(thing, type)} - {"Any"}
CONSTRUCTORS = ("__init__", "__post_init__")


class Place(NamedTuple):
    """A function: its module below flexapod, with dots, and its name there, as `Pose.from_rpy`."""

    module: str
    name: str


@cache
def functions() -> dict[Place, ast.FunctionDef]:
    """Every function and method of the library."""
    found = {}
    for path in SOURCE.rglob("*.py"):
        module = ".".join(path.relative_to(SOURCE).with_suffix("").parts)
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef):
                found[Place(module, node.name)] = node
            elif isinstance(node, ast.ClassDef):
                for item in node.body:
                    if isinstance(item, ast.FunctionDef):
                        found[Place(module, f"{node.name}.{item.name}")] = item
    return found


@cache
def imports(module: str) -> dict[str, tuple[str, str]]:
    """Names that a module imports from the library -> (module, name there; "" for the module itself)."""
    tree = ast.parse(SOURCE.joinpath(*module.split(".")).with_suffix(".py").read_text(encoding="utf-8"))
    found = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "flexapod":
            home = node.module.removeprefix("flexapod").removeprefix(".")
            for alias in node.names:
                whole = f"{home}.{alias.name}".removeprefix(".")
                is_module = SOURCE.joinpath(*whole.split(".")).with_suffix(".py").exists()
                found[alias.asname or alias.name] = (whole, "") if is_module else (home, alias.name)
    return found


@cache
def methods(name: str) -> frozenset[Place]:
    return frozenset(place for place in functions() if place.name.endswith(f".{name}"))


def _made(module: str, name: str) -> set[Place]:
    """A function by its name in a module, or what runs when a class is made."""
    candidates = {Place(module, name), *(Place(module, f"{name}.{constructor}") for constructor in CONSTRUCTORS)}
    return candidates & functions().keys()


def called(place: Place) -> set[Place]:
    """The library's functions that a function calls, or takes the name of."""
    owner, _, _ = place.name.rpartition(".")
    known = imports(place.module)
    found: set[Place] = set()
    for node in ast.walk(functions()[place]):
        if isinstance(node, ast.Name):
            module, name = known.get(node.id, (place.module, node.id))
            found |= _made(module, name) if name else set()
            found |= _made(place.module, owner) if node.id == "cls" else set()
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            found |= _method(place.module, owner, node.func, known)
    return found - {place}


def _method(module: str, owner: str, call: ast.Attribute, known: dict[str, tuple[str, str]]) -> set[Place]:
    """What `thing.name()` may call."""
    thing = call.value.id if isinstance(call.value, ast.Name) else ""
    home, name = known.get(thing, ("", ""))
    if home and not name:
        return _made(home, call.attr)
    if thing in ("self", "cls"):
        here = {place for place in methods(call.attr) if place.module == module}
        return here & {Place(module, f"{owner}.{call.attr}")} or here
    if name and Place(home, f"{name}.{call.attr}") in functions():
        return {Place(home, f"{name}.{call.attr}")}
    return set(methods(call.attr))


def raised(place: Place) -> set[str]:
    """Errors in the raise statements of one function."""
    found = set()
    for node in ast.walk(functions()[place]):
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call) and isinstance(node.exc.func, ast.Name):
            found |= {node.exc.func.id} & ERRORS
    return found


def _closure(starts: set[Place], own_only: bool) -> Iterator[Place]:
    seen, waiting = set(starts), list(starts)
    while waiting:
        place = waiting.pop()
        yield place
        for other in called(place) - seen:
            helper = other.module == place.module and other.name.split(".")[0] not in flexapod.__all__
            if helper or not own_only:
                seen.add(other)
                waiting.append(other)


def own(module: str, name: str) -> set[str]:
    """Errors that a function, or making a class, raises by its own checks."""
    return set().union(*(raised(place) for place in _closure(_made(module, name), own_only=True)))


def reachable(module: str, name: str) -> set[str]:
    """Errors of everything that a function, or making a class, calls."""
    return set().union(*(raised(place) for place in _closure(_made(module, name), own_only=False)))
