"""The public names by kind, and the parts of their docstrings."""

import functools
import inspect
import re
from typing import Any

import flexapod as fx

NAMES = [name for name in fx.__all__ if name != "__version__"]
FUNCTIONS = [name for name in NAMES if inspect.isfunction(getattr(fx, name))]
CLASSES = [name for name in NAMES if inspect.isclass(getattr(fx, name))]
CONDITIONS = [name for name in CLASSES if issubclass(getattr(fx, name), Exception)]  # errors and warnings
KINDS = [name for name in CLASSES if name not in CONDITIONS]
METHODS = [
    f"{name}.{member}"
    for name in KINDS
    for member, value in vars(getattr(fx, name)).items()
    if not member.startswith("_")
    and (isinstance(value, property | functools.cached_property | classmethod) or inspect.isfunction(value))
]


def thing_of(name: str) -> Any:
    """What stands behind a name such as `Pose` or `Pose.from_rpy`."""
    return functools.reduce(inspect.getattr_static, name.split("."), fx) if "." in name else getattr(fx, name)


def doc_of(name: str) -> str:
    """Its docstring, without indentation."""
    thing = thing_of(name)
    return inspect.getdoc(thing.__func__ if isinstance(thing, classmethod) else thing) or ""


def place_of(name: str) -> tuple[str, str]:
    """Its module below flexapod and its name there."""
    first, _, member = name.partition(".")
    thing = getattr(fx, first)
    return thing.__module__.removeprefix("flexapod."), f"{thing.__qualname__}.{member}".removesuffix(".")


def part(doc: str, name: str) -> str | None:
    """What stands behind "Raises:" or "Source:", on one line; None where there is no such line."""
    found = re.search(rf"^{name}: (.*?)(?=^Source: |\Z)", doc, re.M | re.S)
    return " ".join(found[1].split()) if found else None


def prose_of(name: str) -> str:
    """What its docstring says before "Raises:" and "Source:"."""
    return doc_of(name).partition("\nRaises:")[0].partition("\nSource:")[0]


def names(text: str, word: str) -> bool:
    """Whether a text speaks of a parameter or field."""
    return re.search(rf"(?<![\w.]){word}(?!\w)", text) is not None


def errors_in(text: str | None) -> set[str]:
    """Names of errors in a text."""
    return set(re.findall(r"\b[A-Z]\w*Error\b", text or ""))
