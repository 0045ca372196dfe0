"""Texts that would take minutes or gigabytes to read are refused at once, and lists of errors end."""

import os
import socket
import threading
import tomllib

import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.design import design_file, text_limits
from flexapod.design.design_file import tables_of, template
from flexapod.errors import DesignError

OWN = template("own")
DEEP = {
    "bare": ".".join(["a"] * 40_000) + "=1",
    "digits": ".".join(["1"] * 40_000) + "=1",
    "decimals": " . ".join(["1.1"] * 20_000) + "=1",
    "spaced": " . ".join(["a"] * 20_000) + "=1",
    "quoted": ".".join(['"a b"'] * 20_000) + "=1",
    "separators": ".".join(['"=,[]{}#"'] * 20_000) + "=1",
    "header": f"[{'.'.join(['a'] * 40_000)}]",
    "array of tables": f"[[{'.'.join(['a'] * 40_000)}]]",
    "inline": f"x = {{{'.'.join(['a'] * 40_000)} = 1}}",
    "behind a string": 'x = "#" \n' + ".".join(["a"] * 40_000) + "=1",
    "behind a strange line end": '"a\u2028b".' + ".".join(["a"] * 40_000) + "=1",
}


@pytest.fixture
def reader_untouched(monkeypatch):
    """Fails where the TOML reader is asked, which takes time with the square of the depth."""

    def loads(text):
        raise AssertionError("the text was read")

    monkeypatch.setattr(design_file.tomllib, "loads", loads)


@pytest.mark.parametrize("text", DEEP.values(), ids=DEEP)
def test_deep_keys_are_refused_before_they_are_read(text, reader_untouched):
    with pytest.raises(DesignError, match=r"line [12] has more than 48 dots") as caught:
        fx.Hexapod.from_toml(text)
    assert len(str(caught.value)) < 400


def test_long_texts_are_refused_before_they_are_read(reader_untouched):
    with pytest.raises(DesignError, match="longer than 256 kB"):
        fx.Hexapod.from_toml("#" * (text_limits.MOST_BYTES + 1))


def test_what_people_write_is_read():
    numbers = ", ".join(f"[{i}.5, -{i}.25e-3, +{i}.125]" for i in range(300))
    comment = "# " + "." * 500 + " e.g. i.e. " + "Words. " * 20
    text = f"{comment}\nx = [{numbers}]\n{comment}\ndate = 2026-11-30T07:32:00.999\n"
    assert tables_of(text) == tomllib.loads(text)
    assert fx.Hexapod.from_toml(f"{comment}\n" * 200 + OWN) == fx.Hexapod.from_toml(OWN)


def test_a_file_of_another_kind_is_told_by_its_size(tmp_path):
    file = tmp_path / "large.toml"
    with file.open("wb") as large:
        large.truncate(10**12)  # nothing of it is on the disk, and it would not go into memory
    with pytest.raises(DesignError, match=r"large.toml: the text is longer than 256 kB"):
        fx.load(file)


@pytest.mark.parametrize("kind", ["zero", "fifo", "socket"])
def test_files_without_an_end_are_not_read(kind, tmp_path, run, monkeypatch):
    if not hasattr(os, "mkfifo"):
        pytest.skip("devices, pipes and sockets with names are those of Unix")
    path = tmp_path / "design.toml"
    if kind == "zero":
        path = "/dev/zero"
    elif kind == "fifo":
        os.mkfifo(path)
    else:
        monkeypatch.chdir(tmp_path)  # the path of a socket is short
        with socket.socket(socket.AF_UNIX) as bound:
            bound.bind("design.toml")
    ended = []
    asked = threading.Thread(target=lambda: ended.append(run("check", str(path))), daemon=True)
    asked.start()
    asked.join(60)
    ((code, _, err),) = ended
    assert code == 2
    assert "no regular file" in err


def test_many_keys_are_refused_without_comparing_each(monkeypatch):
    def compared(*words, **options):
        raise AssertionError("names were compared")

    monkeypatch.setattr("difflib.get_close_matches", compared)
    for text in ("\n".join(f"k{i} = 1" for i in range(6000)), "\n".join(f"[t{i}]" for i in range(20_000))):
        with pytest.raises(DesignError, match="more than 250 keys"):
            fx.Hexapod.from_toml(text)
    with pytest.raises(DesignError, match="there are 5000 changes"):
        plain_machine("motion-base").replace({f"legs.stiffness[{i}]": 1 for i in range(5000)})


def test_a_long_key_is_cut_where_it_is_told():
    for call in (
        lambda: fx.Hexapod.from_toml(f"{'k' * 100_000} = 1"),
        lambda: plain_machine("motion-base").replace({"platform." + "k" * 100_000: 1}),
        lambda: plain_machine("motion-base").replace({"k" * 100_000: None}),
        lambda: plain_machine("motion-base").replace({"k" * 100_000 + "[0]": 1}),
    ):
        with pytest.raises(DesignError) as caught:
            call()
        assert len(str(caught.value)) < 1000


@pytest.mark.parametrize("name", ["", "  ", "x" * 256, "\udcff"])
def test_names_that_are_none(name):
    with pytest.raises(DesignError, match="name"):
        plain_machine("motion-base").replace({"name": name})


@pytest.mark.parametrize("name", ["", ".", "..", "/", "x" * 300, "\udcff", "\u00e9" * 150])
def test_new_wants_the_name_of_a_file(name, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run("new", name)
    assert (code, out) == (2, "")
    assert "Choose a shorter one" in err or "is no name of a file" in err
    assert list(tmp_path.iterdir()) == []


def test_a_design_in_a_file_whose_name_is_no_text(tmp_path, result):
    file = os.fsencode(tmp_path) + b"/\xff.toml"
    with open(file, "w") as out:
        out.write(OWN.replace('name = "own"', ""))
    assert result("check", os.fsdecode(file))["design"] == "?"


def test_lists_of_errors_are_cut_at_twenty():
    pytest.importorskip("starlette")
    from flexapod.web.design_errors import InvalidDesign
    from flexapod.web.designs import Source, built

    with pytest.raises(InvalidDesign) as caught:
        built(Source("\n".join(f"[platform.k{i}]\nmass = {i}" for i in range(60))))
    assert len(caught.value.errors) == 21
    assert caught.value.errors[-1]["message"] == "There are 40 errors more."
    text = OWN.replace("mass = 60.0 ", "mass_kgs = 60.0 ").replace("leg_distance = ", "leg_distanc = ")
    with pytest.raises(InvalidDesign) as caught:
        built(Source(text))
    lines = text.splitlines()
    told = [lines[error["line"] - 1].split("=")[0].strip() for error in caught.value.errors]
    assert told == ["mass_kgs", "leg_distanc"]
    with pytest.raises(InvalidDesign) as caught:
        built(Source(OWN, "{" + ", ".join(f'"k{i}": 1' for i in range(3000)) + "}"))
    assert len(caught.value.errors) == 1
