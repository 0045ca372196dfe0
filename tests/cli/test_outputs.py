"""What commands write: tried before the work, whole or not at all, whatever the disk, the target or the user does."""

import os
import re
import shutil
import signal
import threading
import time
import weakref
from importlib import import_module

import pytest
from tests.helpers.waiting import until
from tests.helpers.writers import WRITERS, needs, small_files

import flexapod as fx
from flexapod import output_files
from flexapod.cli import COMMANDS

WRITE_NOTHING = {"check", "cite", "designs", "modes", "serve"}


def test_every_command_that_writes_is_tried_here():
    assert {name.split()[0].rstrip(",") for name in WRITERS} | WRITE_NOTHING == set(COMMANDS)


@pytest.mark.parametrize("name", [name for name in WRITERS if name != "new"])
def test_a_target_that_cannot_be_is_told_before_the_work(name, run, tmp_path, monkeypatch):
    """The work would raise here; what is below a file can be neither a file nor a directory."""
    needs(name)
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
    needs(name)
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    shutil.rmtree(gone)
    code, _, err = run(*WRITERS[name][:-2])
    assert code == 2
    assert "cannot be made a directory" in err or "No such file" in err


def test_a_design_is_saved_as_a_whole(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text("from before")
    with small_files(), pytest.raises(fx.errors.OutputError, match="File too large"):
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
    reader.join(60)
    assert found == ["through"]
    assert pipe.is_fifo()
    real.chmod(0o440)
    with pytest.raises(fx.errors.OutputError, match="may not be written to"):
        output_files.write_file(real, "never")
    with pytest.raises(fx.errors.OutputError, match="is a directory"):
        output_files.check_file(tmp_path)
    with pytest.raises(fx.errors.OutputError, match="too long"):
        output_files.check_file(tmp_path / ("a" * 400))


@pytest.fixture
def interruptible():
    """Ctrl-C raises KeyboardInterrupt, as it does but in a shell's background jobs."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
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


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_is_not_lost_in_a_callback(number, code, run, monkeypatch):
    import flexapod.cli.studies.simulate as study

    class Thing:
        pass

    def simulate(*args, **kwargs):
        thing = Thing()
        kept = weakref.ref(thing, lambda _: signal.raise_signal(number))  # Python lets no exception out of here
        del thing
        time.sleep(10)
        return kept

    monkeypatch.setattr(study, "simulate", simulate)
    found, _, err = run("simulate", "cubic-isolator", "--duration", "1")
    assert found == code
    assert "ignored" not in err


def test_what_another_thread_puts_back_after_an_interrupt_is_removed(tmp_path):
    making = tmp_path / ".making"
    with pytest.raises(KeyboardInterrupt), output_files.passing(making):
        raise KeyboardInterrupt

    def write_late():
        for _ in range(5):  # each later than the one before has been removed
            until(lambda: not making.exists())
            making.mkdir()

    late = threading.Thread(target=write_late)
    late.start()
    output_files.remove_passing()
    late.join()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("interruptible")
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
