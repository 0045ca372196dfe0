"""Numbers that a packaged design assumes are told wherever a result of it is, and nowhere else."""

import html
import json

import pytest

import flexapod as fx
from flexapod.design.catalogue import assumed_of, catalogue

ASSUMING = [name for name, one in catalogue().items() if one.assumed]
WORDS = "dehaeze-cubic, for want of data: a payload of 1 kg, a ball of 50 mm radius"
LINES = {
    "report": ["report", "dehaeze-cubic", "--out", "."],
    "statics": ["statics", "dehaeze-cubic"],
    "check": ["check", "dehaeze-cubic"],
    "modes": ["modes", "dehaeze-cubic"],
}


def test_the_catalogue_and_the_designs_agree():
    assert len(ASSUMING) >= 5
    for name in fx.packaged_designs():
        assert bool(assumed_of(fx.load(name))) is (name in ASSUMING)


@pytest.mark.parametrize("name", LINES)
def test_results_say_what_they_rest_on(run, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    code, out, _ = run(*LINES[name])
    assert (code, WORDS in " ".join(out.split())) == (0, True)
    code, out, _ = run(*LINES[name], "--json")
    assert WORDS in json.loads(out)["assumed"]
    if name == "report":
        assert WORDS in html.unescape((tmp_path / "dehaeze-cubic.html").read_text())
    code, out, _ = run(*[word.replace("dehaeze-cubic", "motion-base") for word in LINES[name]])
    assert (code, "for want of data" in out) == (0, False)


def test_a_changed_design_is_told_as_such():
    machine = fx.load("dehaeze-cubic")
    assert "from which this design differs" not in assumed_of(machine)
    assert "from which this design differs, for want of data" in assumed_of(machine.replace({"platform.mass": 2.0}))
    assert assumed_of(machine.replace({"name": "mine"})) == ""
    assert WORDS in html.unescape(machine._repr_html_())
