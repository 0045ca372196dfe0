"""Command lines in processes of their own, ended by a signal at a drawn moment or at a drawn touch of a file."""

import json
import multiprocessing
import os
import signal
import sys
import time
from multiprocessing import forkserver
from pathlib import Path
from random import Random
from typing import NamedTuple
from unittest.mock import patch

LIMIT = 150  # s: far more than any of these commands needs
_PROCESSES = multiprocessing.get_context("forkserver")
_FORKED = forkserver.ForkServer()  # has imported everything already, so that an attack is not spent on imports
_IMPORTED = ["flexapod.cli", "scipy.optimize", "scipy.signal", "scipy.stats", "xarray", "matplotlib.pyplot", "PIL.Image",
             "rich.progress", "rich.table", "control", "zarr", "optuna", "dask.array", "pint"]  # fmt: skip
_FORKED.set_forkserver_preload(_IMPORTED)


class Kill(NamedTuple):
    """What ends a process: a signal, seconds after its start, or just before it opens, renames or removes a file."""

    signal: signal.Signals
    after: float | None
    touch: int | None


class Ended(NamedTuple):
    """How a command ended: exit code, negative for a signal that was not caught, and what it said."""

    code: int
    out: str
    err: str
    seconds: float

    @property
    def touches(self) -> int:
        """How often it touched a file, where that was counted."""
        return int(self.out.rpartition("\0")[2] or 0)


def drawn_kill(draw: Random, whole: Ended) -> Kill:
    """A kill while a command that takes as long as `whole` is at work: half of them where it touches its files."""
    number = draw.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
    if draw.random() < 0.5 and whole.touches:
        return Kill(number, None, draw.randrange(whole.touches))
    return Kill(number, 0.01 + draw.random() * whole.seconds, None)


def killed(line: list[str], folder: Path, kill: Kill | None = None) -> Ended:
    """Run a command in a folder, to its end or until it is killed. The number of its touches follows its output."""
    return Running(line, folder, kill).end()


class Running:
    """A command at work."""

    def __init__(self, line: list[str], folder: Path, kill: Kill | None = None) -> None:
        self.kill, self.said = kill, folder.parent / f"{folder.name}.{time.monotonic_ns()}"
        begun, begins = multiprocessing.Pipe(duplex=False)
        given = (line, str(folder), str(self.said), kill, begins)
        self.process = _PROCESSES.Process(target=_command, args=given, daemon=True)
        with patch.object(forkserver, "connect_to_new_process", _FORKED.connect_to_new_process):  # not that of the page
            self.process.start()
        begins.close()
        begun.poll(LIMIT)
        begun.close()
        self.start = time.monotonic()

    def end(self) -> Ended:
        """Wait for the moment of the kill, and for the end."""
        try:
            if self.kill is not None and self.kill.after is not None:
                self.process.join(self.kill.after)
                if self.process.is_alive():
                    os.kill(self.process.pid, self.kill.signal)
            self.process.join(LIMIT)
            assert self.process.exitcode is not None, f"no end {LIMIT} s after its start and {self.kill}"
        finally:
            self.process.kill()
        seconds = time.monotonic() - self.start
        streams = [self.said.with_name(self.said.name + ending) for ending in (".out", ".err")]
        out, err = (stream.read_text(encoding="utf-8", errors="replace") for stream in streams)
        for stream in streams:
            stream.unlink()
        return Ended(self.process.exitcode, out, err, seconds)


def cut_short(ended: Ended, kill: Kill, as_json: bool) -> str:
    """What became of a command: "done", or "cut short" as it should be; raises AssertionError for anything else."""
    assert "Traceback" not in ended.err, ended
    assert "Exception ignored" not in ended.err, ended
    if ended.code == 0:
        assert kill.touch is None or kill.touch >= ended.touches, f"{kill} was not heard: {ended}"
        return "done"
    caught = kill.signal != signal.SIGKILL
    # a signal in the last instants, when all is said and done, ends the interpreter itself: the shell sees the same
    assert ended.code in {128 + kill.signal if caught else -kill.signal, -kill.signal}, ended
    if caught and as_json and ended.code > 0:
        told = ended.out.partition("\0")[0].strip(), (ended.err.strip().splitlines() or [""])[-1]
        found = [json.loads(text) for text in told if text.startswith("{")]
        assert any(one.get("cut_short") is True for one in found), ended
    return "cut short"


def _command(line, folder, said, kill, begins):
    """The process: its streams to files, and the kill at a touch."""
    os.chdir(folder)
    for handle, ending in ((1, ".out"), (2, ".err")):
        os.dup2(os.open(said + ending, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), handle)
    sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", closefd=False)  # noqa: SIM115
    signal.signal(signal.SIGINT, signal.default_int_handler)
    from flexapod.cli import main

    touches = 0

    def count(event, args):
        nonlocal touches
        if event in ("open", "os.rename", "os.remove", "os.mkdir", "os.link", "sqlite3.connect") and _within(
            args, folder
        ):
            touches += 1
            if kill is not None and kill.touch == touches - 1:
                os.kill(os.getpid(), kill.signal)

    sys.addaudithook(count)
    begins.close()
    code = main(line)
    sys.stdout.write(f"\0{touches}")
    sys.stdout.flush()
    sys.exit(code)


def _within(args, folder):
    """Whether a file in the folder is touched to change it, as far as an audit event tells."""
    name = args[0] if args and isinstance(args[0], str | bytes | os.PathLike) else ""
    path = os.path.abspath(os.fsdecode(name))
    return path.startswith(folder) and not (len(args) == 3 and args[1] in ("r", "rb"))
