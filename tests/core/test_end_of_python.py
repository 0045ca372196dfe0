"""Daemon threads that are within the core when Python ends: the process ends as if they were not there."""

import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]

LEFT_HALF_WAY = """
from flexapod.web.simulation import simulation
run = simulation(LONG)
next(run)
"""
WHILE_THE_CORE_WORKS = """
news = threading.Event()
start(lambda done: news.set())
news.wait()
"""
WHILE_PYTHON_HEARS_OF_PROGRESS = """
news = threading.Event()
start(lambda done: (news.set(), time.sleep(0.5)))
news.wait()
"""
BEFORE = """
import threading, time
import flexapod as fx
from web.asked import LONG

def start(progress):
    machine, shaken = fx.Hexapod.from_toml(LONG["design"]), fx.excitation.harmonic("z", 1e-9, 6e5)
    pose = fx.Pose(LONG["pose"][:3])
    work = lambda: fx.simulate(machine, pose, base_motion=shaken, duration=60.0, progress=progress)
    threading.Thread(target=work, daemon=True).start()
"""


@pytest.mark.parametrize(
    "work",
    [LEFT_HALF_WAY, WHILE_THE_CORE_WORKS, WHILE_PYTHON_HEARS_OF_PROGRESS],
    ids=["half-way", "at work", "heard"],
)
def test_a_process_ends_though_a_daemon_thread_is_within_the_core(work: str) -> None:
    program = f"import sys; sys.path.insert(0, {str(TESTS)!r})\n{BEFORE}{work}"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
