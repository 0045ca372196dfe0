"""A small command line of every command that writes, and what it finds and leaves in its folder."""

import re
import sys
from contextlib import contextmanager

import pytest

PLANNED = ["--from", "0", "0", "0.89", "0", "0", "0", "--to", "0", "0", "0.9", "0", "0", "0", "--bound", "50"]

#: Command lines whose last argument is what they write, by a name.
WRITERS = {
    "animate": ["animate", "cubic-isolator", "--out", "mode.gif"],
    "certify": ["certify", "mukherjee-ii", "--around", "0.0005", "0.5", "--at-least", "1Hz", "--out", "here"],
    "control": ["control", "cubic-isolator", "velocity", "--gain", "10", "--out", "here"],
    "envelope": ["envelope", "cubic-isolator", "--out", "here"],
    "export mjcf": ["export", "cubic-isolator", "--to", "mjcf", "--out", "m.xml"],
    "export urdf": ["export", "cubic-isolator", "--to", "urdf", "--nearest-physical", "--out", "m.urdf"],
    "export sdf": ["export", "cubic-isolator", "--to", "sdf", "--nearest-physical", "--out", "m.sdf"],
    "export mat": ["export", "cubic-isolator", "--to", "mat", "--out", "m.mat"],
    "kinematics": ["kinematics", "cubic-isolator", "lengths.csv", "--out", "poses.csv"],
    "new": ["new", "own.toml"],
    "optimise": ["optimise", "precision-positioner", "--vary", "platform.mass=20:30", "--trials", "3", "--points", "16", "--verify", "32", "--out", "here"],
    "paper": ["paper", "--figure", "2", "--points", "200", "--out", "here"],
    "path": ["path", "mukherjee-i", *PLANNED, "--out", "here"],
    "report": ["report", "cubic-isolator", "--out", "here"],
    "response": ["response", "cubic-isolator", "--points", "20", "--out", "here"],
    "robust": ["robust", "cubic-isolator", "--uncertain", "legs.stiffness=10%", "--samples", "16", "--sensitivity", "0", "--out", "here"],
    "simulate": ["simulate", "cubic-isolator", "--harmonic", "z", "1um", "5Hz", "--duration", "0.2", "--out", "here"],
    "simulate, animated": ["simulate", "cubic-isolator", "--harmonic", "z", "1um", "5Hz", "--duration", "0.2", "--animate", "run.gif"],
    "statics": ["statics", "cubic-isolator", "--elevation", "90:80:2", "--out", "here"],
    "sweep csv": ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "400", "--out", "a.csv"],
    "sweep nc": ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "400", "--out", "a.nc"],
    "sweep parquet": ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "400", "--out", "a.parquet"],
    "sweep, drawn": ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "400", "--figure", "a.png"],
}  # fmt: skip


def given_files(folder):
    """Make what the command lines read; the names."""
    rows = "".join(f"{0.12 + 1e-4 * k:.4f},.12,.12,.12,.12,.12\n" for k in range(30))
    (folder / "lengths.csv").write_text("leg1,leg2,leg3,leg4,leg5,leg6\n" + rows)
    return {"lengths.csv"}


def needs(name):
    """Skip where the extra that a command line needs is not installed."""
    pytest.importorskip({"path": "ompl", "optimise": "optuna"}.get(name.split()[0], "numpy"))


def files_of(folder):
    """Every file of a folder with its bytes."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


#: What differs between two runs of a command: dates, times, and names that stand for nothing.
_OF_THE_RUN = re.compile(
    rb"<dc:date>[^<]*|Created on: [^\0]*|\b[mp][0-9a-f]{10}\b|\d+(\.\d+)? s\b|\"(seconds|sum)\": [^,\n]*"
)


def same(found, whole):
    """Whether two runs wrote the same file."""
    return _OF_THE_RUN.sub(b"", found) == _OF_THE_RUN.sub(b"", whole)


@contextmanager
def small_files():
    """No file may grow beyond 2 kB, as on a disk that is full; nor may the test runner's own log meanwhile.

    Python would cut off what it compiles of a module that is first loaded in here, and other tests would read that.
    """
    import resource  # POSIX only

    before, compiled = resource.getrlimit(resource.RLIMIT_FSIZE), sys.dont_write_bytecode
    resource.setrlimit(resource.RLIMIT_FSIZE, (2048, before[1]))
    sys.dont_write_bytecode = True
    try:
        yield
    finally:
        sys.dont_write_bytecode = compiled
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
