"""The validation page is whole and not old: its claims are measured, its file is current, its table shows all of it."""

import ast
import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest
from tests.helpers.claims import CLAIMS, FILE, Ledger, committed

TESTS = Path(__file__).parents[1]
ROWS = committed()


def hook():
    spec = importlib.util.spec_from_file_location("validation_hook", FILE.parent / "_hooks" / "validation.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def functions(file: str) -> dict[str, str]:
    text = (TESTS.parent / file).read_text(encoding="utf-8")
    found = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
    return {node.name: ast.get_source_segment(text, node) for node in found}


def test_the_file_has_every_claim_in_its_present_words():
    assert list(ROWS) == list(CLAIMS)
    for key, claim in CLAIMS.items():
        assert {name: ROWS[key][name] for name in claim._fields} == claim._asdict(), "run `make validation`"


@pytest.mark.parametrize("key", CLAIMS)
def test_every_claim_is_measured_where_the_file_says(key):
    row = ROWS[key]
    assert 0 <= row["found"] < row["bound"]
    assert row["tests"]
    for test in row["tests"]:
        file, name = test.split("::")
        assert f'"{key}"' in functions(file)[name]


def test_no_test_measures_a_claim_that_is_not_one():
    named = set()
    for path in TESTS.rglob("test_*.py"):
        if path != Path(__file__):
            named |= set(re.findall(r'measured\(\s*"([^"]+)"', path.read_text(encoding="utf-8")))
    assert named == set(CLAIMS)


@pytest.mark.parametrize("found", [1e-10, 2.0, np.nan, [0.0, np.nan], [-1.0, 0.0]])
def test_what_is_not_below_the_bound_fails(found):
    with pytest.raises(AssertionError, match="not below"):
        Ledger(None)("motion/engine", found, 1e-10)


def test_a_file_that_is_old_fails():
    test = "tests/docs/test_validation.py::test_a_file_that_is_old_fails"
    ledger = Ledger({"motion/engine": {"bound": 1e-10, "tests": [test]}})
    ledger("motion/engine", 1e-12, 1e-10)
    with pytest.raises(AssertionError, match="a claim has one"):
        ledger("motion/engine", 1e-12, 1e-9)
    for old in (
        {},
        {"motion/engine": {"bound": 1e-9, "tests": [test]}},
        {"motion/engine": {"bound": 1e-10, "tests": []}},
    ):
        with pytest.raises(AssertionError, match="make validation"):
            Ledger(old)("motion/engine", 1e-12, 1e-10)


def test_a_table_needs_every_claim(tmp_path):
    with pytest.raises(ValueError, match="no test measured motion/matrices"):
        Ledger(None).write(tmp_path / "validation.json")


def test_the_readme_says_what_was_measured():
    text = " ".join((FILE.parents[1] / "README.md").read_text(encoding="utf-8").split())
    assert f"measures {len(CLAIMS)} claims" in text
    shown = {
        "motion/engine": "{:.1e}",
        "motion/reactions": "{:.1e}",
        "motion/accelerations": "{:.1e}",
        "modes/ordinary": "{:.1f} roundings",
    }
    for key, form in shown.items():
        assert form.format(ROWS[key]["found"]) in text, f"the README's number of {key}"


def test_the_page_shows_every_claim():
    module = hook()
    page = (FILE.parent / "validation.md").read_text(encoding="utf-8")
    assert page.count(module.MARKER) == 1
    shown = module.on_page_markdown(page, None, None, None)
    assert module.MARKER not in shown
    lines = [line for line in shown.splitlines() if line.startswith("| ") and not line.startswith("| claim |")]
    assert len(lines) == len(CLAIMS)
    for line, row in zip(lines, ROWS.values(), strict=True):
        cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        assert cells[:3] == [row["claim"], row["against"], module.number(row["found"])]
        assert cells[3].startswith(module.number(row["bound"]))
        assert row["tests"][0].split("::")[0].split("/")[-1].removesuffix(".py") in cells[4]
