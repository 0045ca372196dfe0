"""Stores damaged at random: what is read is right or refused, and what is taken up again is the whole store.

FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import json
import os
import random
import shutil
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from tests.attack.bounded import AMONG_TESTS, SECONDS, SEED, tried
from tests.helpers.stores import BOX, I, content

import flexapod as fx

pytest.importorskip("zarr")

GRID = fx.pose_grid(x=[-0.05, 0.0, 0.05], z=np.linspace(0.8, 0.9, 7), yaw=[0.0, 0.1])
KINDS = {
    "random": (fx.random_poses(BOX, 60, seed=5), ("omega_1", "cond_H"), 13),
    "grid": (GRID, ("omega_1", "omega", "within_limits"), 10),
    "given": (fx.random_poses(BOX, 40, seed=6).rows(0, 40).reshape(5, 8, 6), ("omega_1", "leg_length"), 8),
}


class Attacked:
    """A store of one kind, whole and in part, and the truth about it."""

    def __init__(self, kind, directory):
        self.poses, self.quantities, self.chunk = KINDS[kind]
        self.given = {"quantities": self.quantities, "chunk": self.chunk}
        self.whole, self.part = directory / f"{kind}.zarr", directory / f"{kind}-part.zarr"
        fx.workspace.SweepStore.create(self.whole, I, self.poses, **self.given).run(workers=1)
        asked = iter(range(100))
        store = fx.workspace.SweepStore.create(self.part, I, self.poses, **self.given)
        store.run(workers=1, stop=lambda: next(asked) > 2)
        assert 0 < len(store.done) < store.job.blocks.count
        self.content, self.truth = content(self.whole), fx.sweep(I, self.poses, quantities=self.quantities)
        self.pending = {self.whole: 0, self.part: int((fx.open_sweep(self.part).status == 255).sum())}

    def check_reading(self, path, source):
        """What is read is right, or a Flexapod error says that it is damaged."""
        try:
            found = fx.open_sweep(path)
            found.load()
            fx.summarise(found)
        except fx.FlexapodError as error:
            assert str(path) in str(error)  # noqa: PT017
            return "refused when read"
        there = found.status.values != 255
        assert (~there).sum() == self.pending[source]
        for name in (*self.quantities, "status"):
            assert np.array_equal(found[name].values[there], self.truth[name].values[there], equal_nan=True), name
            assert found[name].attrs.get("units") == self.truth[name].attrs.get("units")
        for name in fx.conventions.AXES:
            places = there if found[name].dims == found.status.dims else ...
            assert np.array_equal(found[name].values[places], self.truth[name].values[places]), name
        return "right"

    def check_resuming(self, path):
        """The store is whole again, to the byte, or a Flexapod error says why it cannot be."""
        try:
            fx.workspace.SweepStore.resume(path, I, self.poses, quantities=self.quantities).run(workers=1)
        except fx.FlexapodError as error:
            assert str(path) in str(error)  # noqa: PT017
            return "not taken up"
        assert content(path) == self.content
        return "mended"


def flip(file, chance):
    data = bytearray(file.read_bytes())
    for _ in range(chance.choice([1, 1, 3])):
        if data:
            data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    file.write_bytes(data)


def truncate(file, chance):
    file.write_bytes(file.read_bytes()[: chance.randrange(max(1, file.stat().st_size))])


def lengthen(file, chance):
    file.write_bytes(file.read_bytes() + chance.randbytes(chance.randrange(1, 9)))


def scribble(file, chance):
    file.write_bytes(chance.randbytes(file.stat().st_size))


def zeros(file, chance):
    file.write_bytes(bytes(file.stat().st_size))


def make_directory(file, chance):
    file.unlink()
    file.mkdir()


def remove_parent(file, chance):
    shutil.rmtree(file.parent)


def edit(file, chance):
    """A key of a JSON file dropped, or with another value."""
    if file.name != "zarr.json":
        return
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
        place = document if chance.random() < 0.4 else document["attributes"]
        key = chance.choice(sorted(place))
    except (ValueError, KeyError, TypeError, IndexError):
        return
    if chance.random() < 0.4:
        del place[key]
    else:
        place[key] = chance.choice(["", "a b", "a-b", "0-99999999999", "-1", 0, -1, 10**30, None, [], {}, True, "0-7"])
    file.write_text(json.dumps(document), encoding="utf-8")


DAMAGES = [
    flip, flip, flip, truncate, lengthen, scribble, zeros, make_directory, remove_parent, edit, edit, edit,
    lambda file, chance: file.unlink(), lambda file, chance: file.unlink(),
]  # fmt: skip


@pytest.fixture(scope="module")
def folder():
    """In memory where that can be: many small files are written."""
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None) as name:
        yield Path(name)


@pytest.fixture(scope="module", params=sorted(KINDS))
def attacked(request, folder):
    return Attacked(request.param, folder)


def test_damage_is_never_taken_for_numbers(attacked, folder, monkeypatch):
    monkeypatch.setattr(os, "fsync", lambda handle: None)  # no power cut is tried here, and more stores are
    end = time.monotonic() + 0.6 * SECONDS / len(KINDS)
    seed, seen = 0, Counter()
    most = 30 if AMONG_TESTS else np.inf
    while (time.monotonic() < end or seed < 10) and seed < most:
        chance = random.Random(f"{SEED} {sorted(attacked.quantities)} {seed}")
        source = chance.choice([attacked.whole, attacked.whole, attacked.part])
        path = folder / f"{seed}.zarr"
        shutil.copytree(source, path)
        for _ in range(chance.choice([1, 1, 2, 4])):
            files = sorted(file for file in path.rglob("*") if file.is_file()) if path.exists() else []
            if files:
                chance.choice(DAMAGES)(chance.choice(files), chance)
        try:
            seen[attacked.check_reading(path, source)] += 1
            seen[attacked.check_resuming(path)] += 1
        except Exception as error:
            raise AssertionError(f"{SEED}, {seed} of {sorted(attacked.quantities)}: {error!r}") from error
        shutil.rmtree(path, ignore_errors=True)
        Path(path).unlink(missing_ok=True)
        seed += 1
    for outcome, count in seen.items():
        resumed = outcome in ("mended", "not taken up")
        tried("damaged stores taken up again" if resumed else "damaged stores read", outcome, count)
    assert seen["mended"]
    assert seen["refused when read"]
