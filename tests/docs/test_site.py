"""What the documentation site is made of: its generated pages, and the check of the built pages."""

import importlib.util
import re
from pathlib import Path

import pytest
from tests.helpers.public import PUBLIC, call_name

import flexapod as fx
from flexapod.cli import COMMANDS, group
from flexapod.design.schema import KEYS

DOCS = Path(__file__).parents[2] / "docs"
CORE = DOCS.parent / "src" / "core"


def module(path: str):
    """A script of docs/, which is no package."""
    spec = importlib.util.spec_from_file_location(Path(path).stem, DOCS / path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


reference = module("_hooks/reference.py")
commands = module("_hooks/commands.py")
core_sources = module("_hooks/core_sources.py")
tables = module("tables/write.py")
outside = module("_hooks/outside.py")
check_site = module("check_site.py")
pictures = module("images/draw.py").PICTURES


def test_every_public_name_is_on_one_page_of_the_reference():
    pages = dict(reference.pages())
    shown = re.findall(r"^::: flexapod\.([\w.]+)$", "\n".join(pages.values()), re.MULTILINE)
    modules = {name for name in shown if name.startswith("plots.") and name.removeprefix("plots.") in fx.plots.__all__}
    assert sorted(set(shown) - modules) == sorted(call_name(name) for name in PUBLIC)
    assert len(shown) == len(set(shown))
    assert all(f"[flexapod.{name}]" in pages["api/index.md"] for name in set(shown) - modules)
    navigation = (DOCS.parent / "mkdocs.yml").read_text(encoding="utf-8")
    assert all(path in navigation for path in pages)


def test_every_command_and_option_is_in_the_reference():
    text = commands.page()
    for name in COMMANDS:
        section = text[text.index(f"## flexapod {name} {{") :].split("\n## ")[0]
        for param in group.get_command(None, name).params:
            if param.param_type_name == "option" and not param.hidden:
                assert f"`{param.opts[0]}" in section


def test_help_texts_are_safe_in_tables():
    assert commands.escaped("a|b `x|y` legs[2] m_u <n>") == r"a\|b `x\|y` legs\[2\] m\_u \<n\>"


def test_every_key_of_a_design_is_in_the_table():
    table = tables.keys.table()
    assert all(f"| `{key}` |" in table for key in KEYS)


@pytest.mark.parametrize(
    ("file", "symbol", "line"),
    [
        ("model/leg.hpp", "LegAxes", "struct LegAxes {"),
        ("model/leg.hpp", "leg_inertia", "Sym3<T> leg_inertia("),
        ("model/leg.hpp", "LegAxes::W", "W(const Vec3<V>& v) const {"),
        ("model/equations.hpp", "base_coupling", "Mat6<T> base_coupling("),
        ("model/joint.hpp", "Joint", "enum class Joint"),
    ],
)
def test_a_symbol_of_the_core_is_found_where_it_is_defined(file, symbol, line):
    text = (CORE / file).read_text(encoding="utf-8")
    assert line in text.splitlines()[core_sources.definition(text, symbol) - 1]


def test_every_struct_of_the_core_is_found():
    for path in CORE.rglob("*.hpp"):
        text = path.read_text(encoding="utf-8")
        for name in re.findall(r"^(?:template <[^>]*> )?struct (\w+) \{", text, re.MULTILINE):
            assert f"struct {name} " in text.splitlines()[core_sources.definition(text, name) - 1]


def test_what_is_only_named_or_called_is_not_defined():
    text = "struct A;\n// struct B {\nint f(int);\nvoid g() {\n  h(1);\n  return k(2);\n}\n"
    assert [core_sources.definition(text, name) for name in ("A", "B", "h", "k", "g")] == [None, None, None, None, 4]


def test_links_that_leave_docs_lead_to_pages_of_the_site():
    assert outside.leaving("[a](../CHANGELOG.md#x) [b](web.md)", "") == "[a](changelog.md#x) [b](web.md)"
    assert outside.leaving("[a](../../CHANGELOG.md) [b](../web.md)", "theory") == "[a](../changelog.md) [b](../web.md)"
    assert outside.mended("[a](../docs/notation.md)", "benchmarks") == "[a](notation.md)"
    assert (
        outside.mended("![a](all.png) [b](https://x.org/y)", "benchmarks")
        == "![a](benchmarks/all.png) [b](https://x.org/y)"
    )
    assert outside.mended("[a](weakest_pose.py)", "examples") == "[a](examples.md#weakest_pose)"


PAGE = '<h1 id="top">A</h1><a href="{link}">b</a><link rel="stylesheet" href="a.css">{more}'


@pytest.mark.parametrize(
    ("link", "more", "css", "problem"),
    [
        ("index.html#top", "", "", None),
        ("https://example.org/", "", "a{b:url(data:image/png;base64,AA)}", None),
        ("gone.html", "", "", "leads to no file"),
        ("#gone", "", "", "no such place"),
        ("#top", '<script src="https://cdn.example.org/a.js"></script>', "", "elsewhere"),
        ("#top", '<img src="gone.png">', "", "leads to no file"),
        ("#top", "", "@font-face{src:url(//fonts.example.org/a.woff2)}", "elsewhere"),
        ("#top", "", "a{b:url(gone.png)}", "missing"),
    ],
)
def test_the_check_finds_what_is_wrong_in_a_site(tmp_path, link, more, css, problem):
    (tmp_path / "index.html").write_text(PAGE.format(link=link, more=more))
    (tmp_path / "a.css").write_text(css)
    found = check_site.problems(tmp_path)
    assert found == [] if problem is None else len(found) == 1 and problem in found[0]


def test_every_picture_is_shown_and_has_the_script_that_draws_it():
    folder = DOCS / "images"
    assert sorted(pictures) == sorted(path.name for path in folder.iterdir() if path.suffix in {".png", ".svg"})
    assert set(pictures.values()) == {path.name for path in folder.glob("draw_*.py")}
    pages = "\n".join(path.read_text(encoding="utf-8") for path in DOCS.rglob("*.md"))
    assert [name for name in pictures if f"(images/{name}" not in pages] == []


@pytest.mark.parametrize("page", tables.TABLES)
def test_tables_in_pages_are_those_of_the_sources(page):
    """Whoever reads a page where it is not built sees them too; python docs/tables/write.py writes them."""
    assert (DOCS / page).read_text(encoding="utf-8") == tables.filled(page)
