"""Command lines drawn at random: every command with bad values for its options, by the types that they declare.

Each ends with exit code 0 or 2, says in a sentence why, and never hangs. FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import contextlib
import io
import re
import warnings

import click
import pytest
from tests.attack import files as attacked_files
from tests.attack.bounded import limited, rounds, tried

from flexapod.cli import COMMANDS, group, main
from flexapod.cli.options import common

pytest.importorskip("optuna")
pytest.importorskip("ompl")

AT = ["--pose", "0", "0", "0.035", "0", "0", "0"]
#: A small command line of each command that is right, in a folder of the files below.
RIGHT = {
    "animate": ["cubic-isolator", "--out", "a.gif"],
    "certify": ["mukherjee-ii", "--around", "0.0005", "0.5", "--at-least", "1Hz"],
    "check": ["cubic-isolator"],
    "cite": [],
    "control": ["cubic-isolator", "velocity", "--gain", "10"],
    "designs": [],
    "envelope": ["cubic-isolator"],
    "export": ["cubic-isolator", "--to", "mjcf", "--out", "m.xml"],
    "kinematics": ["cubic-isolator", "lengths.csv"],
    "modes": ["cubic-isolator"],
    "new": ["own.toml"],
    "optimise": ["precision-positioner", "--vary", "platform.mass=20:30", "--trials", "2", "--points", "8", "--verify", "16", "--out", "here"],
    "paper": ["--figure", "2", "--points", "100", "--out", "here"],
    "path": ["mukherjee-i", "way.csv"],
    "report": ["cubic-isolator", "--out", "here"],
    "response": ["cubic-isolator", "--points", "10"],
    "robust": ["cubic-isolator", "--uncertain", "legs.stiffness=10%", "--samples", "8", "--sensitivity", "0", "--poses", "4", "--out", "here"],
    "serve": ["cubic-isolator", "--port", "0"],
    "simulate": ["cubic-isolator", "--harmonic", "z", "1um", "5Hz", "--duration", "0.05", "--samples", "5"],
    "statics": ["cubic-isolator", "--elevation", "90:80:2"],
    "sweep": ["cubic-isolator", "--around", "0.001", "1", "--points", "20"],
}  # fmt: skip

TEXTS = (
    "", " ", "x", "=", ":", "=1", "a=b", "-", "1", "nan", "\u03c9", "\u00b2", "\0", "x" * 3000, "'\"", "../x", "%s", "{}",
    "platform.mass", "platform.mass=", "platform.mass=nan", "platform.mass=1e999", "platform.mass=-1", "platform.mass=1:2",
    "platform.mass=2:1", "platform.mass=0:0", "platform.mass_lb=1:2", "platform.joints[9]=1", "platform.joints=[[1]]",
    "legs.stiffness=10%", "legs.stiffness=1e9%", "legs.stiffness=-1%,normal", "legs.stiffness=5%,normal,uniform",
    "legs.stiffness[:]=1:2", "home.position[2]=0.2:0.3", "base.circle.radius=0:1", "base.circle.nothing=0:1", "name=x",
    "a.b.c.d.e=1", "x=0:1", "x=0:1:3", "x=0:1:\u00b2", "x=0:1:0", "x=0:1:99999999999", "x=1:0", "x=nan:1", "x=0:inf", "q=0:1",
    "x=0:1,x=0:1", "x=1e300:2e300", "mass", "footprint_mm=1", "footprint=nan", "stroke=-1", "limits=3", "cond=1e400",
    "omega_1,omega_1", "all", "acceleration,acceleration", "leg_force,nothing", "z", "roll", "force:z", "leg:7", "base:q",
    "VC-A", "VC-Z", "ground:none", "sea:1:8", "sea:-1:8", "sea:1m:8s:99", "flat:1:2:1", "flat:nan:1:2", "tcp://nowhere:1", "tls://x",
)  # fmt: skip
WHOLE = (
    "-1",
    "0",
    "1",
    "2",
    "3",
    "1.5",
    "1e3",
    "0x10",
    "\u00b2",
    "\u0663",
    "1_0",
    "",
    " 5 ",
    "nan",
    "9" * 30,
    "9" * 5000,
    "two",
)
REAL = ("-1", "0", "-0.0", "1", "1e-320", "1e-30", "1e30", "1e31", "1e308", "1e309", "nan", "inf", "-inf", "1_0", "", "one",
        "1e", "0,5", "\u0663", "9" * 500)  # fmt: skip
AMOUNTS = (*REAL, "1um", "1kg", "5Hz", "10ms", "1e300s", "-1deg", "3g", "1 m", "1m/s2", "0s", "1nN")
OUTPUTS = ("", ".", "..", "/", "file", "file/x", "nowhere/x.png", "x" * 400, "a.foo", "a.zarr", "a.csv", "a.nc", "a.svg",
           "a.mp4", "a.gif", "a\0b", "/proc/x", "-", "\u03c9.png", "%41.png", "folder")  # fmt: skip
INPUTS = (*attacked_files.NAMES, *[attacked_files.DAMAGED] * len(attacked_files.NAMES))
DESIGNS = (
    "",
    "nothing",
    "cubic-isolator",
    "full.toml",
    "bad.toml",
    "deep.toml",
    "bytes.csv",
    "folder",
    "empty.csv",
    "x" * 400,
    "a\0b",
    ".",
)


#: A call, a module or a flag of Python, and an argument by its name alone, that a user of commands does not know.
PYTHON = re.compile(
    r"\b(?:fx|np|hexapod|flexapod)\.[a-z_]+\w*\b(?!\.(?:toml|csv))|\b[a-z]+_[a-z_]+\(|\b\w+=(?:True|False|None)\b|\((?:see )?[a-z]+_[a-z_]+\)"
)


@pytest.fixture
def files(tmp_path, monkeypatch):
    """A folder with files to be read, right and wrong."""
    monkeypatch.chdir(tmp_path)
    attacked_files.write(tmp_path)
    return tmp_path


@pytest.fixture
def unserved(monkeypatch):
    """`serve` without serving."""
    uvicorn = pytest.importorskip("uvicorn")
    monkeypatch.setattr(uvicorn.Server, "run", lambda self, sockets=(): [socket.close() for socket in sockets])
    monkeypatch.setattr("webbrowser.open", lambda address: True)


def _values(kind, draw):
    """A bad, odd or right value for an option, by its type."""
    if isinstance(kind, click.Tuple):
        return [_values(one, draw)[0] for one in kind.types]
    if isinstance(kind, click.Choice):
        return [draw.choice([*map(str, kind.choices), "", "x", "UNIVERSAL"])]
    if isinstance(kind, click.IntRange) or kind is click.INT:
        return [draw.choice(WHOLE)]
    if isinstance(kind, click.FloatRange) or kind is click.FLOAT:
        return [draw.choice(REAL)]
    if isinstance(kind, common.Output):
        return [draw.choice(OUTPUTS)]
    if isinstance(kind, click.Path):
        return [draw.choice(INPUTS)]
    if isinstance(kind, common.DesignName):
        return [draw.choice(DESIGNS)]
    if hasattr(kind, "dimension"):
        return [draw.choice(AMOUNTS)]
    return [draw.choice(TEXTS)]


#: What the machine with everything takes in place of what others do.
_FULL = dict.fromkeys(["cubic-isolator", "precision-positioner", "mukherjee-ii", "mukherjee-i"], "full.toml") | {
    "way.csv": "from_home.csv", "lengths.csv": "full_lengths.csv", "1Hz": "80Hz", "0.5": "0.1", "legs.stiffness=10%": "platform.mass=10%",
}  # fmt: skip


def _of_full(line):
    """The same command line for the machine with everything."""
    line = [_FULL.get(word, word) for word in line]
    return [*line, "--from-home"] if "from_home.csv" in line else line


def _line(name, draw):
    """The right command line of a command with some options replaced or added."""
    context = click.Context(group)
    command = group.get_command(context, name)
    line = _of_full(list(RIGHT[name])) if draw.random() < 0.5 else list(RIGHT[name])
    places = [k for k, param in enumerate(p for p in command.params if isinstance(p, click.Argument))]
    for param in draw.sample(command.params, k=min(draw.choice((1, 1, 1, 2, 3)), len(command.params))):
        if isinstance(param, click.Argument):
            k = [p for p in command.params if isinstance(p, click.Argument)].index(param)
            if k < len(line) and k in places and not line[k].startswith("-"):
                line[k] = _values(param.type, draw)[0]
            continue
        option = draw.choice([*param.opts, *param.secondary_opts])
        if getattr(param, "is_flag", False):
            line.append(option)
            continue
        composite = isinstance(param.type, click.Tuple)
        line += [option, *(v for _ in range(1 if composite else param.nargs) for v in _values(param.type, draw))]
    if name == "certify" and "--time-limit" not in line:  # a proof has no end of its own: it goes on until it is one
        line += ["--time-limit", "5"]
    return [name, *line, *(["--json"] if draw.random() < 0.3 else [])]


#: Exit codes that are answers too: what was asked does not hold, or was not decided or not completed in its time.
ANSWERS = {"certify": (1, 3), "sweep": (3,)}


def _run(line):
    """Exit code and what was said."""
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2)]
    with contextlib.redirect_stdout(streams[0]), contextlib.redirect_stderr(streams[1]), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            with limited():
                code = main(line)
        except SystemExit as end:  # a sweep to a store
            code = end.code
    for stream in streams:
        stream.flush()
    return code, *(stream.buffer.getvalue().decode(errors="replace") for stream in streams)


def test_every_command_is_attacked():
    assert set(RIGHT) == set(COMMANDS)


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_bad_command_lines_end_in_a_sentence(name, files, unserved):
    right, full = RIGHT[name], _of_full(RIGHT[name])
    for line in (right, full) if full != right else (right,):
        assert _run([name, *line])[0] == 0, f"{name} {line} is right"
    for draw in rounds(0.9 / len(COMMANDS), name):
        attacked_files.damage(files, draw)
        line = _line(name, draw)
        try:
            code, out, err = _run(line)
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            pytest.fail(f"{line}: {type(error).__name__}: {str(error)[:300]}")
        told = f"{[text[:80] for text in line]}\n{err[-500:]}"
        assert code in (0, 2, *ANSWERS.get(name, ())), told
        assert "Traceback" not in err + out, told
        if code == 2:
            assert err.strip(), told
            assert len(err) < 8000, told
            assert not PYTHON.search(err), told
        for hidden in files.rglob(".[0-9]*"):
            pytest.fail(f"{told}: {hidden} was left")
        if (files / "own.toml").exists():
            (files / "own.toml").unlink()
        tried("command lines with bad values", "refused in a sentence" if code == 2 else "answered")
