"""Public functions of the plots: described in numpydoc form, with examples that run."""

import doctest
import inspect
from importlib import import_module

import numpy as np
import pytest
from numpydoc.validate import validate
from tests.project.test_docstrings import CODES

import flexapod as fx

MODULES = (
    "control",
    "machine_3d",
    "natural_frequencies",
    "optimisation",
    "path",
    "response",
    "results",
    "simulation",
    "sweep",
    "sweep_surface",
)
FUNCTIONS = {
    f"{module.__name__}.{name}": thing
    for module in (import_module(f"flexapod.plots.{name}") for name in MODULES)
    for name, thing in vars(module).items()
    if inspect.isfunction(thing) and not name.startswith("_") and thing.__module__ == module.__name__
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_plot_is_described_and_its_example_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = validate(name)
    assert not [error for error in found["errors"] if error[0] in CODES]
    for test in doctest.DocTestFinder().find(FUNCTIONS[name], name, globs={"fx": fx, "np": np}):
        said: list[str] = []
        result = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test, out=said.append)
        assert result.failed == 0, "".join(said)
