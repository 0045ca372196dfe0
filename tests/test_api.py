"""The public names: they resolve, say what they do, in which units, with which errors, after whom; importing is light.

The rule for docstrings, which the messages below repeat. Prose first, with shapes such as (..., 6) and SI units of what
goes in and comes out; every parameter and every field of a result by its name. Then, as the last paragraph,

    Raises: PoseError at a pose that no leg can take; KinematicsError where no equilibrium is found.
    Source: Eq. 34; E1 to E5, part B.

`Raises:` stands in every function, in every class that checks what it is made of, and in methods that check something.
It names the errors of its own checks and no error that cannot happen, or says "nothing of its own.". (DesignError for
a `hexapod` that is none goes without saying.) `Source:` stands in every function and class: equation, section, figure,
appendix or conclusion of the paper, E1 to E8 or part A to D of its corrections (docs/theory.md), an author with the
year, a standard, or "own".
"""

import builtins
import dataclasses
import inspect
import re
import subprocess
import sys

import pytest

import flexapod as fx
import raising
from docstrings import FUNCTIONS, KINDS, METHODS, NAMES, doc_of, errors_in, names, part, place_of, prose_of

WITHOUT_NUMBERS = {"packaged_designs"}
UNIT_OR_SHAPE = re.compile(
    r"(?<!['\w.])(m|rad|kg|N|J|W|s|Hz|m/s2?|N/m|rad/s2?|N s/m|N m|SI)\b|\bunits?\b|\bmetres\b|\(\.\.\.|\(\d|\([mn][,)]"
)
#: Parameters that mean the same everywhere.
COMMON = {"base", "hexapod", "joint", "options", "platform", "pose", "progress", "rest", "seed", "settings", "threads"}
SOURCE = re.compile(
    r"\bEqs?\.? \d|\bSection \d|\bFigs? \d|\bFig\. \d|\bAppendix A|\bconclusion [123]\b|\bE[1-8]\b|\bpart [A-D]\b"
    r"|[A-Z]\w+.*\((18|19|20)\d\d\)|, (18|19|20)\d\d\)|\b(ISO|IEC|IEST)[ -]|^own\b"
)


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_resolves_and_is_documented(name):
    thing = getattr(fx, name)
    assert thing.__module__.startswith("flexapod.")
    doc = thing.__doc__ or ""
    assert len(doc.split()) >= 4, f"{name} has no docstring worth the name"
    assert not doc.startswith(f"{name}("), f"{name} has only the docstring that NamedTuple or dataclass makes"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_says_units_or_shapes_and_is_typed(name):
    assert name in WITHOUT_NUMBERS or UNIT_OR_SHAPE.search(prose_of(name)), (
        f"the docstring of {name} names neither a unit (m, rad/s, N, ...) nor a shape ((..., 6), (n,), ...)"
    )
    signature = inspect.signature(getattr(fx, name))
    silent = [p for p in signature.parameters if p not in COMMON and not names(doc_of(name), p)]
    assert not silent, f"the docstring of {name} must say what {silent} are, with their units"
    assert signature.return_annotation is not signature.empty
    assert all(p.annotation is not p.empty for p in signature.parameters.values())
    named = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]  # ** is a typed bundle
    assert len(named) <= 8


@pytest.mark.parametrize("name", [*FUNCTIONS, *KINDS])
def test_every_function_and_class_says_after_whom(name):
    source = part(doc_of(name), "Source")
    assert source, f'the docstring of {name} must end with a line such as "Source: Eq. 34; E1 to E5." or "Source: own."'
    assert SOURCE.search(source), (
        f"{name}: {source!r} is no source. Give Eq. N, Section N, Fig. N, Appendix A, conclusion N, E1 to E8, part A "
        'to D, an author with the year in brackets, a standard (ISO, IEC, IEST), or "own"'
    )
    for number in re.findall(r"Eqs?\.? (\d+)(?:(?: to |-)(\d+))?", source):
        assert all(1 <= int(n) <= 35 for n in number if n), f"{name}: the paper's equations are 1 to 35"
    assert all(int(n) <= 6 for n in re.findall(r"Section (\d)", source)), f"{name}: the paper has sections 1 to 6"
    assert doc_of(name).rstrip().endswith("."), f"{name}: the source ends with a full stop"


@pytest.mark.parametrize("name", [*FUNCTIONS, *KINDS, *METHODS])
def test_raises_names_the_errors_that_can_happen(name):
    raises, place = part(doc_of(name), "Raises"), place_of(name)
    named, own, reachable = errors_in(raises), raising.own(*place), raising.reachable(*place)
    makes = name in KINDS and reachable
    if name in FUNCTIONS or makes or (name in METHODS and own):
        assert raises, f'the docstring of {name} needs a line "Raises: ...", which names {sorted(own or reachable)}'
    if name in FUNCTIONS or raises:
        assert named or raises == "nothing of its own.", f'{name}: name errors, or write "Raises: nothing of its own."'
    assert own <= named, f"{name} checks and raises {sorted(own - named)}, which its docstring does not name"
    foreign = {error for error in named if error not in raising.ERRORS}
    assert all(hasattr(builtins, error) for error in foreign), f"{name} names {sorted(foreign)}, which do not exist"
    never = named - foreign - own - reachable
    assert not never, f"{name} cannot raise {sorted(never)}, which its docstring names"


@pytest.mark.parametrize("name", KINDS)
def test_every_field_is_explained(name):
    kind = getattr(fx, name)
    fields = getattr(kind, "_fields", ())
    if dataclasses.is_dataclass(kind):
        fields = [item.name for item in dataclasses.fields(kind)]
    silent = [item for item in fields if not names(prose_of(name), item)]
    assert not silent, f"the docstring of {name} must name its fields {silent}, with shape and unit"
    unitless = {"ConditionNumber"}
    assert not fields or name in unitless or UNIT_OR_SHAPE.search(prose_of(name)), f"{name}: say shapes and units"


@pytest.mark.parametrize("name", METHODS)
def test_every_public_method_is_documented(name):
    doc = doc_of(name)
    assert len(doc.split()) >= 2, f"{name} has no docstring"
    assert doc.rstrip().endswith(".")


@pytest.mark.parametrize("name", [*NAMES, *METHODS])
def test_docstrings_are_sound_markdown(name):
    """What Markdown would take for emphasis, links, tags, mathematics, lists or headings stands in backticks."""
    doc = doc_of(name)
    assert doc.count("`") % 2 == 0, f"{name} has a backtick without its twin"
    lines = re.sub(r"`[^`]*`", "code", doc).splitlines()
    for above, line in zip(["", *lines], lines, strict=False):
        wrong = re.search(r"\*\w|\w\*|(?<!\w)_\w|\]\[|\]\(|<[a-zA-Z/]|[$\\]|~~", line)
        assert not wrong, f"{name}: put {wrong[0]!r} in backticks: {line!r}"
        other = re.match(r"(#|>|\||=+$|-{3}|\d+[.)] |\+ |\* |    )", line)
        assert not other, f"{name}: Markdown takes {line!r} for a heading, a list, a quotation or code"
        in_list = above.startswith(("- ", "  ")) or not above
        assert not line.startswith("- ") or in_list, f"{name}: an empty line must stand before a list"


def test_the_rules_see_what_is_missing():
    assert part("A thing.\n\nRaises: PoseError\nfor NaN.\nSource: Eq. 3.", "Raises") == "PoseError for NaN."
    assert part("A thing.\n\nRaises: PoseError for NaN.\nSource: Eq. 3.", "Source") == "Eq. 3."
    assert part("It raises: eyebrows.", "Raises") is None
    assert not SOURCE.search("known to everybody")
    assert raising.own("statics", "static_equilibrium") == {"KinematicsError", "SingularPoseError"}
    assert raising.own("hexapod", "Limits") == {"DesignError"}
    assert "PoseError" in raising.reachable("modal", "stability_index")
    assert "PathError" not in raising.reachable("modal", "stability_index")


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
