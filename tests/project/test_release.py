"""What a release says of itself in several places is the same."""

import re
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
import yaml

import flexapod as fx
from flexapod import citation

ROOT = Path(__file__).resolve().parents[2]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


def test_the_version_is_one():
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert CITATION["version"] == fx.__version__
    assert metadata.version("flexapod") == fx.__version__
    assert re.search(r"^## (\S+)", changelog, re.MULTILINE)[1] == fx.__version__


def test_a_dated_changelog_has_a_dated_citation():
    heading = re.search(r"^## .*", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)[0]
    assert ("unreleased" in heading) == ("date-released" not in CITATION)


def test_the_citation_file_is_made_from_the_package(monkeypatch):
    """By `flexapod cite --cff`; with a date of release as well, it is what YAML reads again."""
    assert (ROOT / "CITATION.cff").read_text(encoding="utf-8") == citation.cff()
    monkeypatch.setattr(citation, "RELEASED", "2026-12-01")
    read = yaml.safe_load(citation.cff())
    assert str(read["date-released"]) == "2026-12-01"
    assert {key: read[key] for key in citation.SOFTWARE if key != "authors"} == {
        key: value for key, value in citation.SOFTWARE.items() if key != "authors"
    }
    assert "year    = {2026}" in citation.bibtex()


def test_the_paper_is_cited():
    (paper,) = CITATION["references"]
    assert paper["title"] in (ROOT / "README.md").read_text(encoding="utf-8").replace("\n", " ")
    assert CITATION["license"] == metadata.metadata("flexapod")["License-Expression"]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_workflows_ask_for_what_the_makefile_has(path):
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    jobs = yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"]
    steps = [step for job in jobs.values() for step in job["steps"]]
    asked = {match for step in steps for match in re.findall(r"make ([a-z-]+)", step.get("run", ""))}
    assert asked <= targets
    assert all(re.search(r"@(v\d+|release/v\d+)$", step["uses"]) for step in steps if "uses" in step)


def test_releases_ask_for_the_packages_that_compile_here():
    """`.ci/run` makes the wheel in this environment, which would not miss what pyproject.toml forgets to ask for."""
    asked = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["build-system"]["requires"]
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    installed = re.search(r"pip install -q -c constraints\.txt pip (.*)", makefile)[1].split()
    of_themselves = {"cmake", "ninja"}  # the backend asks for them where they are missing
    assert {re.split(r"[<>=~]", name)[0] for name in asked} == set(installed) - of_themselves
