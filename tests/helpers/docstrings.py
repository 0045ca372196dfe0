"""The parts of docstrings in numpydoc form."""

import inspect
import re

from tests.helpers.public import PUBLIC


def doc_of(name: str) -> str:
    """The docstring of a public name, without indentation."""
    return inspect.getdoc(PUBLIC[name]) or ""


def section(doc: str, title: str) -> str:
    """The text of a section, empty where there is none."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\w[\w ]+\n-+\n|\Z)", doc, re.M | re.S)
    return found[1] if found else ""


def errors_in(name: str) -> set[str]:
    """The errors that a docstring says a function raises."""
    doc = doc_of(name)
    return set(re.findall(r"\b[A-Z]\w*Error\b", section(doc, "Raises")))
