"""`flexapod cite`: BibTeX that a parser written apart reads, of this version and of the paper."""

import re

import flexapod as fx


def parsed(text):
    """Entries of a BibTeX text: kind and fields by key; values in balanced braces."""
    found = {}
    for kind, key, body in re.findall(r"^@(\w+)\{(\w+),\n(.*?)^\}$", text, re.MULTILINE | re.DOTALL):
        fields = dict(re.findall(r"^  (\w+) += \{(.*)\},$", body, re.MULTILINE))
        assert len(fields) == len(body.splitlines())
        assert all(value.count("{") == value.count("}") for value in fields.values())
        found[key] = (kind, fields)
    return found


def test_bibtex(run, result):
    code, out, err = run("cite")
    assert (code, err) == (0, "")
    found = parsed(out)
    kind, paper = found["mukherjee2007"]
    assert kind == "article"
    assert paper["author"] == "Mukherjee, P. and Dasgupta, B. and Mallik, A. K."
    assert paper["title"].replace("{", "").replace("}", "") == (
        "Dynamic stability index and vibration analysis of a flexible Stewart platform"
    )
    assert (paper["journal"], paper["year"]) == ("Journal of Sound and Vibration", "2007")
    kind, software = found["flexapod"]
    assert (kind, software["version"]) == ("software", fx.__version__)
    told = result("cite")
    assert told["bibtex"] == out.rstrip("\n")
    assert told["software"]["version"] == fx.__version__
    assert told["paper"]["authors"] == ["P. Mukherjee", "B. Dasgupta", "A. K. Mallik"]


def test_the_other_form(run):
    code, out, _ = run("cite", "--cff")
    assert code == 0
    assert out.startswith("cff-version: 1.2.0\n")
    assert run("cite", "--cff", "--json")[0] == 2
