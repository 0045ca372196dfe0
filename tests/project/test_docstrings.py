"""Public docstrings are in numpydoc form: what goes in, what comes out, what is raised, the source, and an example that runs."""

import dataclasses
import doctest
import inspect

import numpy as np
import pytest
from numpydoc.docscrape import NumpyDocString
from numpydoc.validate import validate
from tests.helpers.public import CLASSES, FUNCTIONS, PUBLIC, call_name

import flexapod as fx

#: What numpydoc's validation must not find: no summary or one without a full stop; parameters that are missing, unknown,
#: in another order, without a type or without a description; no section Returns; sections that are unknown or in
#: another order; no example.
CODES = {"GL06", "GL07", "GL08", "SS01", "SS02", "SS03", "PR01", "PR02", "PR03", "PR04", "PR07", "RT01", "RT03", "EX01"}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_function_is_described_in_full(name):
    thing = PUBLIC[name]
    found = validate(f"{thing.__module__}.{thing.__qualname__}")
    assert not [error for error in found["errors"] if error[0] in CODES]
    doc = NumpyDocString(inspect.getdoc(thing))
    assert doc["Notes"] or doc["References"], f"{name}: the section Notes gives the source, and what a user must know"


def fields_of(thing: type) -> list[str]:
    if dataclasses.is_dataclass(thing):
        return [item.name for item in dataclasses.fields(thing) if not item.name.startswith("_")]
    return list(getattr(thing, "_fields", ()))


@pytest.mark.parametrize("name", [name for name in CLASSES if not issubclass(PUBLIC[name], BaseException)])
def test_class_describes_its_fields_and_methods(name):
    thing = PUBLIC[name]
    doc = NumpyDocString(inspect.getdoc(thing))
    described = {
        word.strip() for part in ("Parameters", "Attributes") for item in doc[part] for word in item.name.split(",")
    }
    assert not set(fields_of(thing)) - described
    for member, value in vars(thing).items():
        made_by_hand = inspect.isfunction(value) or isinstance(value, classmethod | property)
        if not member.startswith("_") and made_by_hand and member not in getattr(tuple, "__dict__", {}):
            text = inspect.getdoc(getattr(thing, member) if not isinstance(value, property) else value)
            assert text, f"{name}.{member} has no docstring"
            assert text.split("\n\n")[0].rstrip().endswith("."), f"{name}.{member}: the summary ends with a full stop"


@pytest.mark.parametrize("name", [*FUNCTIONS, *CLASSES])
def test_example_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    finder = doctest.DocTestFinder(recurse=inspect.isclass(PUBLIC[name]))
    options = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
    for test in finder.find(PUBLIC[name], call_name(name), globs={"fx": fx, "np": np}):
        said: list[str] = []
        result = doctest.DocTestRunner(optionflags=options).run(test, out=said.append)
        assert result.failed == 0, "".join(said)
