"""How a command ends: with a sentence and exit code 2 for whatever the input, the machine or its streams can do."""

import csv
import io
import os
import subprocess
import sys
import warnings

import numpy as np
import pytest

from flexapod.cli import main

MODES = ["modes", "motion-base"]


class SlycotResultWarning(UserWarning):
    pass


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (MemoryError(), "not enough memory"),
        (OverflowError("too large"), "too large to compute with"),
        (ZeroDivisionError("division by zero"), "too small to compute with"),
        (FloatingPointError("underflow"), "FloatingPointError: underflow"),
        (np.linalg.LinAlgError("Singular matrix"), "singular to rounding"),
        (csv.Error("field larger than field limit"), "no CSV file"),
        (EOFError("No data left in file"), "ends before it is complete"),
        (RecursionError("maximum recursion depth"), "nested too deeply"),
        (SlycotResultWarning("ill-conditioned"), "cannot be relied on"),
        (UnicodeEncodeError("idna", "\u00ed", 0, 1, "no"), "encoding"),
        (OSError(28, "No space left on device", "a.txt"), "a.txt: No space left on device"),
        (OSError(5, "Input/output error"), "Input/output error"),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, BaseException) else "",
)
def test_an_error_of_the_machine_is_a_sentence(error, words, run, monkeypatch):
    from flexapod.cli.options import common

    def fail(*args, **kwargs):
        raise error

    monkeypatch.setattr(common, "machine", fail)
    code, out, err = run(*MODES)
    assert (code, out) == (2, "")
    assert words in err
    assert "Usage:" not in err
    assert len(err.strip().splitlines()) == 1
    code, _, err = run(*MODES, "--json")
    assert code == 2
    assert f'"kind": "{"ClickException" if isinstance(error, EOFError) else type(error).__name__}"' in err


def test_a_fault_of_flexapod_is_not_hidden(run, monkeypatch):
    from flexapod.cli.options import common

    def fail(*args, **kwargs):
        raise KeyError("own")

    monkeypatch.setattr(common, "machine", fail)
    with pytest.raises(KeyError):
        run(*MODES)


ABSURD = [
    ["simulate", "motion-base", "--duration", "1", "--samples", "999999999999"],
    ["robust", "motion-base", "--uncertain", "legs.stiffness_law.bulk_modulus=10%", "--samples", "99999999999"],
    ["robust", "motion-base", "--uncertain", "legs.stiffness_law.bulk_modulus=10%", "--poses", "99999999"],
    ["robust", "motion-base", "--uncertain", "legs.stiffness_law.bulk_modulus=10%", "--seed", "-1"],
    ["optimise", "motion-base", "--vary", "platform.mass=1:2", "--seed", "-1"],
    ["optimise", "motion-base", "--vary", "platform.mass=1:2", "--trials", "1" * 400],
    ["control", "motion-base", "velocity", "--shake", "0.01", "--duration", "1e12"],
    ["control", "motion-base", "velocity", "--delay", "1000"],
    ["control", "motion-base", "velocity", "--gain", "nan"],
    ["control", "motion-base", "force", "--gain", "1e308"],
    ["paper", "--points", "99999999999", "--figure", "4"],
    ["paper", "--figure", "\u00b2"],
    ["sweep", "motion-base", "--around", "1", "1", "--points", "9" * 400],
    ["sweep", "motion-base", "--around", "nan", "1"],
    ["modes", "motion-base", "--pose", "0", "0", "inf", "0", "0", "0"],
    ["response", "motion-base", "--loss-factor", "1e308"],
    ["animate", "cubic-isolator", "--exaggeration", "1e308"],
    ["animate", "cubic-isolator", "--exaggeration", "1e20"],
    ["simulate", "motion-base", "--harmonic", "z", "1mm", "5Hz", "--duration", "1e308"],
    ["simulate", "motion-base", "--random", "z", "VC-A", "--seed", "-1", "--duration", "1"],
    ["serve", "--host", "\u00ed", "--port", "0"],
    ["new", ""],
    ["new", "."],
    ["new", "/"],
    ["new", "a" * 300],
]


@pytest.mark.parametrize("line", ABSURD, ids=[" ".join(line)[:60] for line in ABSURD])
def test_absurd_numbers_and_names_are_refused_at_once(line, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*line)
    assert (code, out) == (2, "")
    assert err.startswith(("Usage:", "Error:"))
    assert list(tmp_path.iterdir()) == []


def test_a_controller_that_cannot_be_computed_is_a_sentence(run):
    pytest.importorskip("slycot")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        code, _, err = run("control", "precision-positioner", "lqg", "--measure", "leg_length", "--noise", "1e-6")
    assert code in (0, 2)
    assert "Traceback" not in err


def _piped(*line, **environment):
    environment = {**os.environ, **environment}
    return subprocess.run([sys.executable, "-m", "flexapod", *line], capture_output=True, env=environment)


def test_an_instruction_set_that_is_not_there_is_a_sentence():
    done = _piped(*MODES, FLEXAPOD_SIMD="nonsense")
    assert done.returncode == 2
    assert done.stderr.decode().startswith("Error: FLEXAPOD_SIMD is 'nonsense'")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="this system has no /dev/full")
@pytest.mark.parametrize("also", [[], ["--json"]])
def test_a_full_standard_output_ends_cleanly(also):
    with open("/dev/full", "wb") as full:
        done = subprocess.run([sys.executable, "-m", "flexapod", *MODES, *also], stdout=full, stderr=subprocess.PIPE)
        assert done.returncode == 2
        assert done.stderr.count(b"\n") == 1
        assert b"No space left on device" in done.stderr
        done = subprocess.run([sys.executable, "-m", "flexapod", *MODES, *also], stdout=full, stderr=full)
        assert done.returncode == 2


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "latin-1"])
@pytest.mark.parametrize(
    "line",
    [
        ["sweep", "motion-base", "--around", "0.1", "5", "--points", "50", "--at-least", "20"],
        ["report", "cubic-isolator", "--out"],
        ["path", "mukherjee-i", "--out"],
        ["check", "motion-base"],
        ["designs"],
    ],
    ids=lambda line: line[0],
)
def test_any_encoding_of_standard_output_will_do(line, encoding, tmp_path, monkeypatch):
    if line[0] == "path":
        rows = "t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0,0,0.9,0,0,0\n"
        (tmp_path / "way.csv").write_text(rows)
        line = [line[0], line[1], str(tmp_path / "way.csv"), line[2]]
    line = [*line, *([str(tmp_path)] if line[-1] == "--out" else [])]
    if line[0] in ("check", "designs"):  # as the shell starts it; the others take long to start
        done = _piped(*line, PYTHONIOENCODING=encoding, PYTHONUTF8="0")
        assert (done.returncode, done.stderr.count(b"Traceback")) == (0, 0), done.stderr
        written = done.stdout
    else:
        there = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
        monkeypatch.setattr(sys, "stdout", there)
        assert main(line) == 0
        there.flush()
        written = there.buffer.getvalue()
    assert written
    assert b"?" not in written


def test_tables_in_pipes_are_not_cut(run):
    code, out, _ = run("sweep", "motion-base", "--around", "0.1", "5", "--points", "500", "--quantities", "all")
    assert code == 0
    assert "\u2026" not in out
    assert "..." not in out
