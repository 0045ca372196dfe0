"""What commands write: tried before the work, whole or not at all, whatever the disk, the target or the user does."""

import os
import re
import resource
import shutil
import signal
import threading
from importlib import import_module

import pytest

import flexapod as fx
from flexapod import output_files
from flexapod.cli import COMMANDS

HOME = ["--pose", "0", "0", "0.89", "0", "0", "0"]
PLANNED = ["--from", "0", "0", "0.89", "0", "0", "0", "--to", "0", "0", "0.9", "0", "0", "0", "--bound", "50"]

#: Command lines whose last argument is what they write, by a name.
WRITERS = {
    "animate": ["animate", "cubic-isolator", "--out", "mode.gif"],
    "control": ["control", "cubic-isolator", "velocity", "--gain", "10", "--out", "here"],
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
    "sweep csv": ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "400", "--out", "a.csv"],
    "sweep nc": ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "400", "--out", "a.nc"],
    "sweep parquet": ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "400", "--out", "a.parquet"],
    "sweep, drawn": ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "400", "--figure", "a.png"],
}  # fmt: skip
WRITE_NOTHING = {"check", "designs", "modes", "serve"}


@pytest.fixture
def small_files():
    """No file may grow beyond 2 kB, as on a disk that is full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2048, before[1]))
    resource.setrlimit(resource.RLIMIT_FSIZE, before)


def _lacks_an_extra(name):
    needs = {"path": "ompl", "optimise": "optuna"}
    pytest.importorskip(needs.get(name.split()[0], "numpy"))


def test_every_command_that_writes_is_tried_here():
    assert {name.split()[0].rstrip(",") for name in WRITERS} | WRITE_NOTHING == set(COMMANDS)


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_is_a_sentence_and_leaves_nothing_cut(name, run, small_files, tmp_path, monkeypatch):
    _lacks_an_extra(name)
    monkeypatch.chdir(tmp_path)
    line = WRITERS[name]
    target = tmp_path / line[-1]
    if target.suffix and name != "new":
        target.write_text("from before")
    if name == "kinematics":
        rows = "".join(f"{0.12 + 1e-4 * k:.4f},.12,.12,.12,.12,.12\n" for k in range(30))
        (tmp_path / "lengths.csv").write_text("leg1,leg2,leg3,leg4,leg5,leg6\n" + rows)
    small_files()
    code, _, err = run(*line)
    assert code == 2, err
    assert "File too large" in err
    assert "Usage:" not in err
    assert "Traceback" not in err
    kept = sorted(path for path in tmp_path.rglob("*") if path.is_file())
    assert all(path.stat().st_size < 2048 for path in kept), kept  # small ones were complete before the large one
    assert not [path for path in kept if path.name.startswith(".")]
    if target.suffix and name != "new":
        assert target.read_text() == "from before"


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only an administrator may mount")
@pytest.mark.parametrize("name", ["sweep nc", "animate", "export mjcf"])
def test_on_a_disk_that_is_full_indeed(name, tmp_path):
    """In a process of its own: with HDF5 on the disk itself it ended in a segmentation fault."""
    import subprocess
    import sys

    small = tmp_path / "small"
    small.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", small], capture_output=True).returncode:
        pytest.skip("mounting is not allowed here")
    try:
        done = subprocess.run(
            [sys.executable, "-m", "flexapod", *WRITERS[name]], cwd=small, capture_output=True, text=True
        )
        assert (done.returncode, list(small.iterdir())) == (2, [])
        assert "No space left on device" in done.stderr
        assert "Traceback" not in done.stderr
    finally:
        subprocess.run(["umount", small], check=True)


@pytest.mark.parametrize("name", [name for name in WRITERS if name != "new"])
def test_a_target_that_cannot_be_is_told_before_the_work(name, run, tmp_path, monkeypatch):
    """The work would raise here; what is below a file can be neither a file nor a directory."""
    _lacks_an_extra(name)
    (tmp_path / "file").write_text("")
    *line, last = WRITERS[name]
    command = line[0]

    def work(*args, **kwargs):
        raise AssertionError("began to work")

    works = {
        "animate": ("flexapod.plots.animation", "natural_modes"),
        "export": ("flexapod.interchange.multibody", "at_rest"),
        "paper": ("flexapod.paper", "draw"),
        "report": ("flexapod.report.findings", "gather"),
    }
    module, function = works.get(command, (f"flexapod.cli.studies.{command}", "compute"))
    monkeypatch.setattr(import_module(module), function, work)
    code, _, err = run(*line, tmp_path / "file" / last)
    assert code == 2
    assert re.search("cannot be (written|made a directory)|is no directory", err)
    assert "Usage:" not in err


@pytest.mark.parametrize("name", ["optimise", "report", "robust"])
def test_the_current_directory_is_tried_too(name, run, tmp_path, monkeypatch):
    _lacks_an_extra(name)
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    shutil.rmtree(gone)
    code, _, err = run(*WRITERS[name][:-2])
    assert code == 2
    assert "cannot be made a directory" in err or "No such file" in err


def test_a_design_is_saved_as_a_whole(small_files, tmp_path):
    file = tmp_path / "own.toml"
    file.write_text("from before")
    small_files()
    with pytest.raises(fx.errors.OutputError, match="File too large"):
        fx.load("mukherjee-ii").save(file)
    assert [path.read_text() for path in tmp_path.iterdir()] == ["from before"]


def test_an_interrupt_leaves_the_file_from_before(tmp_path):
    file = tmp_path / "a.txt"
    file.write_text("from before")

    def interrupted():
        with output_files.completed(file) as making:
            making.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [path.read_text() for path in tmp_path.iterdir()] == ["from before"]


def test_links_modes_and_pipes_are_respected(tmp_path):
    real, link, pipe = tmp_path / "real.txt", tmp_path / "link.txt", tmp_path / "pipe"
    real.write_text("before")
    real.chmod(0o640)
    link.symlink_to(real)
    output_files.write_file(link, "after")
    assert link.is_symlink()
    assert real.read_text() == "after"
    assert real.stat().st_mode & 0o777 == 0o640
    os.mkfifo(pipe)
    found = []
    reader = threading.Thread(target=lambda: found.append(pipe.read_text()))
    reader.start()
    output_files.write_file(pipe, "through")
    reader.join(10)
    assert found == ["through"]
    assert pipe.is_fifo()
    real.chmod(0o440)
    with pytest.raises(fx.errors.OutputError, match="may not be written to"):
        output_files.write_file(real, "never")
    with pytest.raises(fx.errors.OutputError, match="is a directory"):
        output_files.check_file(tmp_path)
    with pytest.raises(fx.errors.OutputError, match="too long"):
        output_files.check_file(tmp_path / ("a" * 400))


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_signals_end_a_command_with_their_code(number, code, run, monkeypatch, tmp_path):
    import flexapod.cli.studies.simulate as study

    monkeypatch.setattr(study, "simulate", lambda *args, **kwargs: signal.raise_signal(number))
    before = signal.getsignal(signal.SIGTERM)
    line = ["simulate", "cubic-isolator", "--duration", "1", "--out", tmp_path / "here"]
    assert run(*line)[0] == code
    found, out, err = run(*line, "--json")
    assert (found, out) == (code, "")
    assert '"kind": "Interrupted"' in err or '"kind": "Terminated"' in err
    assert signal.getsignal(signal.SIGTERM) is before
    assert not (tmp_path / "here").exists()


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_search_that_is_cut_short_says_so(number, code, run, monkeypatch):
    pytest.importorskip("optuna")
    import json

    from flexapod.cli.output.progress import TrialProgress

    monkeypatch.setattr(TrialProgress, "__call__", lambda self, done, *rest: done == 3 and signal.raise_signal(number))
    line = WRITERS["optimise"][:-2]
    found, out, _ = run(*line, "--trials", 50, "--json")
    assert found == code
    assert json.loads(out)["cut_short"] is True
