"""Long calls show their progress by themselves: where somebody looks on, once, after a while, and else never."""

import contextlib
import inspect
import os
import subprocess
import sys
import threading
import warnings

import numpy as np
import pytest
from tests.attack.test_api import BOX, HOME, H, _arguments, files  # noqa: F401  # files is a fixture
from tests.helpers.public import FUNCTIONS, PUBLIC

import flexapod as fx
from flexapod import progress

LONG = sorted(
    name for name in {*FUNCTIONS, "animate_simulation"} if "progress" in inspect.signature(PUBLIC[name]).parameters
)


#: What makes a call go where progress is told, and end soon: a plan that must search, a proof in little time.
MORE = {
    "certified_box": {"box": fx.Box.about(HOME, 1e-4, 1e-3), "tolerance": 0.5},
    "plan_path": {
        "hexapod": fx.load("mukherjee-i"),
        "start": fx.Pose.from_rpy(0, 0, 0.89, 0, -33, -10, degrees=True),
        "goal": fx.Pose.from_rpy(0, 0, 0.89, 0, 45, 53, degrees=True),
        "requirements": fx.PathRequirements(110.0),
    },
}


class Screen:
    """Stands in for a terminal: the bars that were begun, what they showed, and how many are left."""

    def __init__(self):
        self.bars, self.shares, self.closed = [], [], 0

    def __call__(self, what, began):
        self.bars.append(what)
        return self

    def show(self, share):
        self.shares.append(share)

    def close(self):
        self.closed += 1


@pytest.fixture
def screen(monkeypatch):
    screen = Screen()
    monkeypatch.setattr(progress, "_kind", lambda: screen)
    monkeypatch.setattr(progress, "AFTER", 0.0)
    monkeypatch.setattr(progress, "_EVERY", 0.0)
    return screen


def call(name, **more):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return PUBLIC[name](**{**_arguments(name), **MORE.get(name, {}), **more})


def test_all_long_calls_are_known():
    assert len(LONG) >= 15
    assert {"optimise", "pareto_front", "robustness", "certify", "simulate", "plan_path", "worst_pose"} <= set(LONG)


@pytest.mark.parametrize("name", LONG)
def test_a_long_call_shows_one_bar_or_none(name, files, screen):  # noqa: F811
    """Of the calls that it makes itself, which would show one too, nothing is seen."""
    call(name)
    assert len(screen.bars) == screen.closed == 1
    assert all(0 <= share <= 1 for share in screen.shares)
    assert screen.shares == sorted(screen.shares) or name == "certified_box"  # which begins anew with each box
    call(name, progress=False)
    told = []
    call(name, progress=told.append)
    assert told
    assert len(screen.bars) == 1


def test_a_sweep_to_a_store_shows_its_bar(screen, tmp_path):
    store = fx.workspace.SweepStore.create(tmp_path / "swept.zarr", H, fx.random_poses(BOX, 64), chunk=8)
    store.run(1)
    assert screen.bars == ["sweep"]
    assert screen.shares[-1] == 1.0


def test_the_bar_of_a_call_that_fails_is_closed(screen):
    def stop(*given):
        raise ZeroDivisionError

    def trial(done, wanted, best):
        stop()

    with pytest.raises(ZeroDivisionError):
        call("optimise", on_trial=trial)
    assert screen.closed == len(screen.bars)
    assert not progress._inside.get()


def test_no_bar_before_its_time(screen, monkeypatch):
    monkeypatch.setattr(progress, "AFTER", 1000.0)
    fx.simulate(H, HOME, duration=0.01)
    assert screen.bars == []


def test_what_is_no_progress_is_refused():
    for bad in (True, 1, "yes", np.False_):
        with pytest.raises(fx.ArgumentError, match=r"progress is .*; it must be a function"):
            fx.simulate(H, HOME, duration=0.01, progress=bad)


RUN = """
import flexapod as fx
from flexapod import progress
progress.AFTER = 0.0
fx.simulate(fx.load("precision-positioner"), duration=0.05)
"""
THREAD = f"""
import threading
thread = threading.Thread(target=lambda: exec({RUN!r}))
thread.start()
thread.join()
"""
POOL = f"""
import multiprocessing
with multiprocessing.get_context("fork").Pool(1) as pool:
    pool.apply(exec, [{RUN!r}])
"""


def shown_by(code, terminal=True):
    """What a process writes to its standard error, which is a terminal or a pipe."""
    read, write = os.openpty() if terminal else os.pipe()
    found = []

    def collect():
        with contextlib.suppress(OSError):  # of a terminal that nobody writes to any more
            while part := os.read(read, 4096):
                found.append(part)

    reader = threading.Thread(target=collect, daemon=True)
    reader.start()
    try:
        environment = os.environ | {"TERM": "xterm", "COLUMNS": "100"}
        given = [sys.executable, "-c", code]
        subprocess.run(given, stderr=write, stdout=subprocess.DEVNULL, check=True, env=environment, timeout=300)
    finally:
        os.close(write)
    reader.join(60)
    os.close(read)
    return b"".join(found).decode()


needs_terminals = pytest.mark.skipif(not hasattr(os, "openpty"), reason="there are no terminals to be made here")


@needs_terminals
def test_a_terminal_shows_a_line_that_goes_again():
    text = shown_by(RUN)
    assert "simulation" in text
    assert "%" in text
    assert "\x1b[2K" in text.rpartition("simulation")[2]  # the line is erased


@needs_terminals
def test_nothing_is_shown_where_nobody_looks_on():
    assert shown_by(RUN, terminal=False) == ""
    assert shown_by(THREAD) == ""
    assert shown_by(POOL) == ""


@needs_terminals
def test_commands_show_their_own(tmp_path):
    """Stages, at once, and not the bars of the library's calls, which tell per cent."""
    code = "from flexapod import progress, cli; progress.AFTER = 0.0; cli.main('sweep precision-positioner --around 0.001 0.5 --points 64 --worst'.split())"
    shown = shown_by(code)
    assert 0 <= shown.find("sweep") < shown.find("worst pose")
    assert "%" not in shown
