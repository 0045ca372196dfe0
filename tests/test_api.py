"""The public names: they resolve, say what they do and in which units, and importing them is light."""

import inspect
import re
import subprocess
import sys

import pytest

import flexapod as fx

NAMES = [name for name in fx.__all__ if name != "__version__"]
FUNCTIONS = [name for name in NAMES if inspect.isfunction(getattr(fx, name))]
WITHOUT_NUMBERS = {
    "check_limits",
    "cluster",
    "describe_modes",
    "load",
    "near_repeated",
    "open_sweep",
    "packaged_designs",
    "template",
}
UNIT_OR_SHAPE = re.compile(r"\b(m|rad|kg|N|J|W|s|m/s2?|N/m|rad/s2?|SI)\b|\(\.\.\.|\(\d")


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_resolves_and_is_documented(name):
    thing = getattr(fx, name)
    assert thing.__module__.startswith("flexapod.")
    doc = thing.__doc__ or ""
    assert len(doc.split()) >= 4, f"{name} has no docstring worth the name"
    assert not doc.startswith(f"{name}("), f"{name} has only the docstring that NamedTuple or dataclass makes"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_says_units_or_shapes_and_is_typed(name):
    function = getattr(fx, name)
    assert name in WITHOUT_NUMBERS or UNIT_OR_SHAPE.search(inspect.getdoc(function))
    signature = inspect.signature(function)
    assert signature.return_annotation is not signature.empty
    assert all(p.annotation is not p.empty for p in signature.parameters.values())
    named = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]  # ** is a typed bundle
    assert len(named) <= 8


@pytest.mark.parametrize("name", [n for n in NAMES if inspect.isclass(getattr(fx, n))])
def test_every_public_method_is_documented(name):
    members = vars(getattr(fx, name))
    public = [m for m in members if not m.startswith("_") and inspect.isfunction(inspect.unwrap(members[m]))]
    own = [m for m in public if members[m].__qualname__.startswith(name)]
    assert all(members[m].__doc__ for m in own), [m for m in own if not members[m].__doc__]


def test_dir_is_all_and_unknown_names_are_attribute_errors():
    assert sorted(fx.__all__) == list(fx.__all__)
    assert set(fx.__all__) <= set(dir(fx))
    with pytest.raises(AttributeError, match="no_such_thing"):
        fx.no_such_thing  # noqa: B018


def modules_after(code: str) -> set[str]:
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\nimport sys\nprint(*sys.modules)"], capture_output=True, text=True, check=True
    )
    return {name.split(".")[0] for name in done.stdout.split()}


HEAVY = {"matplotlib", "scipy", "xarray", "pandas", "control", "tomlkit", "click", "rich"}


def test_import_is_light():
    assert not modules_after("import flexapod") & (HEAVY | {"numpy"})


def test_natural_modes_need_no_heavy_module():
    code = "import flexapod as fx\nfx.natural_modes(fx.load('mukherjee-ii'), fx.Pose([0, 0, 0.085]))"
    assert not modules_after(code) & HEAVY


def test_names_for_type_checkers_are_the_names_at_run_time():
    """What is imported under TYPE_CHECKING and the table of homes are the same names of the same modules."""
    source = inspect.getsource(fx)
    named = set(re.findall(r"from flexapod\.([\w.]+) import (\w+) as \2", source))
    assert named == {(home, name) for home, names in fx._HOMES.items() for name in names}
