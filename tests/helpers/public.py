"""The public names of the library: those of `flexapod` and of the packages of its subjects."""

import inspect
from importlib import import_module
from types import ModuleType
from typing import Any

import flexapod as fx

PACKAGES = [
    name for name in fx.__all__ if isinstance(getattr(fx, name), ModuleType) and name not in ("errors", "plots")
]


#: Modules that a package shows by name, with what they define: `design.flexures`.
MODULES = {
    f"{package}.{name}": getattr(getattr(fx, package), name)
    for package in PACKAGES
    for name in getattr(fx, package).__all__
    if isinstance(getattr(getattr(fx, package), name), ModuleType)
}


def defined_in(module: ModuleType) -> dict[str, Any]:
    """The functions and classes that a module defines for its users."""
    return {
        name: thing
        for name, thing in vars(module).items()
        if not name.startswith("_") and getattr(thing, "__module__", "") == module.__name__
    }


def _all() -> dict[str, Any]:
    found: dict[str, Any] = {}
    for place in (fx, *(import_module(f"flexapod.{name}") for name in PACKAGES)):
        for name in place.__all__:
            thing = getattr(place, name)
            if not isinstance(thing, ModuleType):
                assert found.setdefault(name, thing) is thing, f"{name} is two things"
    for module in MODULES.values():
        for name, thing in defined_in(module).items():
            assert found.setdefault(name, thing) is thing, f"{name} is two things"
    errors = {
        name: thing
        for name, thing in vars(fx.errors).items()
        if inspect.isclass(thing) and issubclass(thing, BaseException)
    }
    return found | errors


#: Name -> what it is, each name once. No name has two meanings.
PUBLIC = _all()
FUNCTIONS = sorted(name for name, thing in PUBLIC.items() if inspect.isfunction(thing))
CLASSES = sorted(name for name, thing in PUBLIC.items() if inspect.isclass(thing))


def call_name(name: str) -> str:
    """How a user writes a public name: `load`, `control.lqg`."""
    if name in fx.__all__:
        return name
    for place, module in MODULES.items():
        if name in defined_in(module):
            return f"{place}.{name}"
    (package,) = [place for place in [*PACKAGES, "errors"] if hasattr(getattr(fx, place), name)]
    return f"{package}.{name}"
