"""A disk that is full at any byte, for every command that writes: a sentence, exit code 2, and no file that is cut.

On a file system of its own, in memory, where one can be mounted; and with a limit of the size of files everywhere.
FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import json
import os
import shutil
import subprocess
import sys
from itertools import cycle

import pytest
from tests.attack.bounded import rounds, tried
from tests.attack.killing import killed
from tests.helpers.stores import content
from tests.helpers.writers import WRITERS, files_of, given_files, needs, same, small_files

if os.name != "posix":
    pytest.skip("disks and limits of POSIX", allow_module_level=True)

BEFORE = b"from before"
#: Commands that keep their work in a file of many pieces, which can be gone on with when there is room again.
KEPT = {
    "sweep zarr": ["sweep", "mukherjee-i", "--around", "0.05", "10", "--points", "20000", "--chunk", "2000", "--out", "a.zarr"],
    "optimise, kept": [*WRITERS["optimise"][:-2], "--study", "s.db"],
}  # fmt: skip
PAGE = 4096


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_is_a_sentence_and_leaves_nothing_cut(name, run, tmp_path, monkeypatch):
    needs(name)
    monkeypatch.chdir(tmp_path)
    line = WRITERS[name]
    target = tmp_path / line[-1]
    if target.suffix and name != "new":
        target.write_text("from before")
    given_files(tmp_path)
    with small_files():
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
@pytest.mark.parametrize("name", ["sweep nc", "export mjcf"])
def test_on_a_disk_that_is_full_indeed(name, tmp_path):
    """In a process of its own: with HDF5 on the disk itself it ended in a segmentation fault."""
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


class Disk:
    """A file system of 16 MiB in memory, of which as much is free as is asked for."""

    def __init__(self, folder):
        self.folder, self._filler = folder, folder / "filler"

    def empty(self):
        for path in self.folder.iterdir():
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def leave(self, pages):
        there = os.statvfs(self.folder)
        size = (there.f_bavail - pages) * there.f_frsize
        with self._filler.open("wb") as filler:
            os.posix_fallocate(filler.fileno(), 0, size)

    def make_room(self):
        self._filler.unlink(missing_ok=True)


@pytest.fixture(scope="module")
def disk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("disk") / "work"
    folder.mkdir()
    made = shutil.which("mount") and subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=16m", "tmpfs", folder], capture_output=True, check=False
    )
    if not made or made.returncode:
        pytest.skip("a small file system cannot be mounted here")
    yield Disk(folder)
    subprocess.run(["umount", folder], check=True)


def _told_in_a_sentence(ended, as_json, told):
    assert ended.code == 2, told
    assert "No space left on device" in ended.err or "full" in ended.err, told
    assert "Traceback" not in ended.err, told
    assert "Usage:" not in ended.err, told
    if as_json:
        assert json.loads(ended.err.strip().splitlines()[-1])["error"], told


def test_every_command_on_a_disk_that_is_full_at_any_byte(disk):
    for name in WRITERS:
        needs(name)
    wholes, names = {}, None
    for draw in rounds(0.6, "full disks"):
        names = names or cycle(draw.sample(sorted(WRITERS), len(WRITERS)))
        name = next(names)
        disk.empty()
        if name not in wholes:
            given_files(disk.folder)
            assert killed(WRITERS[name], disk.folder).code == 0, name
            wholes[name] = {k: v for k, v in files_of(disk.folder).items() if k != "lengths.csv"}
            disk.empty()
        written = wholes[name]
        given_files(disk.folder)
        replaced = draw.random() < 0.5 and name != "new"
        for file in written if replaced else ():
            (disk.folder / file).parent.mkdir(exist_ok=True)
            (disk.folder / file).write_bytes(BEFORE)
        free = draw.randrange(sum(-(-len(content) // PAGE) for content in written.values()))
        disk.leave(free)
        as_json = draw.random() < 0.5
        ended = killed([*WRITERS[name], *(["--json"] if as_json else [])], disk.folder)
        told = f"{name} with {free} pages free: {ended}"
        found = {k: v for k, v in files_of(disk.folder).items() if k not in ("filler", "lengths.csv")}
        if ended.code:
            _told_in_a_sentence(ended, as_json, told)
        assert not [file for file in found if file.rpartition("/")[2].startswith(".")], told
        for file, now in found.items():
            assert (replaced and ended.code and now == BEFORE) or same(now, written[file]), f"{told} cut {file}"
        assert ended.code or set(found) == set(written), told
        tried("commands on a full disk", "told, nothing cut" if ended.code else "enough room after all")


def _of_study(file):
    """What SQLite leaves beside a file when it has no room to put the last changes into it; it does so the next time."""
    return {f"{file.name}-wal", f"{file.name}-shm"} if file.suffix == ".db" else set()


def test_what_is_kept_on_a_full_disk_is_gone_on_with(disk, tmp_path):
    for name in WRITERS:
        needs(name)
    pytest.importorskip("zarr")
    whole = tmp_path / "whole"
    whole.mkdir()
    assert killed(KEPT["sweep zarr"], whole).code == 0
    truth = content(whole / "a.zarr")
    for draw in rounds(0.4, "full disks of stores"):
        name = draw.choice(sorted(KEPT))
        line, there = KEPT[name], disk.folder / KEPT[name][-1]
        disk.empty()
        free = draw.randrange(300 if there.suffix == ".zarr" else 60)
        disk.leave(free)
        as_json = draw.random() < 0.5
        ended = killed([*line, *(["--json"] if as_json else [])], disk.folder)
        told = f"{name} with {free} pages free: {ended}"
        if ended.code:
            _told_in_a_sentence(ended, as_json, told)
        disk.make_room()
        assert {path.name for path in disk.folder.iterdir()} <= {there.name, *_of_study(there)}, told
        again = [*line, *(["--resume"] if there.suffix == ".zarr" and there.exists() else [])]
        ended = killed(again, disk.folder)
        assert ended.code == 0, f"{told}, then {ended}"
        assert not _of_study(there) & {path.name for path in disk.folder.iterdir()}, told
        if there.suffix == ".zarr":
            assert content(there) == truth, told
        tried("work kept on a full disk and gone on with", f"{name}: nothing lost")
