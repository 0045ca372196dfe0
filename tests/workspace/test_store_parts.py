"""Parts of one store: runs beside each other, killed and taken up, leave the bytes of one run."""

import os
import subprocess
import sys
import threading
import time
from contextlib import ExitStack

import pytest
from tests.helpers.stores import POSES, I, content, stored

import flexapod as fx
from flexapod.workspace.store import parts
from flexapod.workspace.store.parts import Part

CHUNK = 500  # of 10 000 poses: 20 blocks
Store = fx.workspace.SweepStore


def joined(path, part, of, **options):
    return Store.join(path, I, POSES, part=part, of=of, chunk=CHUNK, quantities=("omega_1", "cond_H"), **options)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    place = tmp_path_factory.mktemp("whole") / "map.zarr"
    stored(place, chunk=CHUNK)
    return content(place)


@pytest.mark.parametrize("count", [1, 7, 20, 4_000_000])
def test_parts_are_all_blocks_once(count):
    for of in (1, 2, 3, min(count, 64)):
        if of <= count:
            found = [Part(k, of).blocks(count) for k in range(1, of + 1)]
            assert [part.start for part in found[1:]] == [part.stop for part in found[:-1]]
            assert (found[0].start, found[-1].stop) == (0, count)
            assert max(map(len, found)) - min(map(len, found)) <= 1


def test_one_after_the_other(tmp_path, whole):
    place = tmp_path / "map.zarr"
    for number in (2, 3, 1):
        store = joined(place, number, 3)
        state = store.run()
        assert state.done == state.total == 500 * len(Part(number, 3).blocks(20))
        assert store.complete == (number == 1)
        found = fx.open_sweep(place)
        assert int((found.status == 255).sum()) == 10_000 - {2: 3500, 3: 7000, 1: 10_000}[number]
    assert content(place) == whole


def test_at_once(tmp_path, whole):
    """Each process makes the store if it is the first."""
    place = tmp_path / "map.zarr"
    errors = []

    def one(number):
        try:
            joined(place, number, 5).run(1)
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=one, args=(number,)) for number in range(1, 6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
    assert content(place) == whole


PROGRAM = """
import sys, time
from tests.workspace.test_store_parts import joined
joined(sys.argv[1], 1, 2).run(1, progress=lambda share: (print(share, flush=True), time.sleep(600)))
"""


def test_a_killed_part_is_taken_up(tmp_path, whole):
    place = tmp_path / "map.zarr"
    path = os.pathsep.join([os.getcwd(), *sys.path])
    command = [sys.executable, "-c", PROGRAM, str(place)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": path}) as process:
        assert process.stdout.readline()  # a block is on the disk
        with pytest.raises(fx.errors.OutputError, match="another run is writing"):
            joined(place, 1, 2)
        with pytest.raises(fx.errors.OutputError, match=r"part 1 of 2 .* is being written, and this is one of 3 parts"):
            joined(place, 1, 3)
        with pytest.raises(fx.errors.OutputError, match="another run is writing"):
            Store.resume(place, I, POSES, quantities=("omega_1", "cond_H"))
        joined(place, 2, 2).run()
        process.kill()
    cut = min((place / "omega_1" / "c").iterdir(), key=lambda file: int(file.name))  # of part 1
    cut.write_bytes(cut.read_bytes()[:-1])  # and the disk lost a byte
    assert not joined(place, 2, 2).complete
    assert joined(place, 1, 2).run().done == 5000
    assert content(place) == whole


def test_a_part_stopped_in_time_goes_on(tmp_path, whole):
    place = tmp_path / "map.zarr"
    end = time.monotonic()
    store = joined(place, 1, 2)
    state = store.run(1, stop=lambda: time.monotonic() > end)
    assert state.done < state.total == 5000
    assert not store.complete
    for number in (1, 2):
        joined(place, number, 2).run()
    assert content(place) == whole
    again = joined(place, 1, 2)
    assert again.complete
    assert again.run().done == 5000
    assert content(place) == whole


def test_marks_that_another_run_never_gives_back(tmp_path, monkeypatch):
    """As of a job that the batch system suspended in the wrong moment: told, and all that was computed is there."""
    place = tmp_path / "map.zarr"
    store = joined(place, 1, 2)
    monkeypatch.setattr(parts, "PATIENCE", 0.05)
    with ExitStack() as other, pytest.raises(fx.errors.OutputError, match=r"another run is writing .*status just now"):
        store.run(progress=lambda share: other.enter_context(parts.marking(str(place))) if share == 1 else None)
    assert joined(place, 1, 2).run().before == 5000


@pytest.mark.parametrize(
    ("part", "of", "words"),
    [
        (0, 2, "part is 0; it must be a whole number, at least 1"),
        (3, 2, "part is 3 of 2"),
        (1, 21, "the store has 20 blocks, fewer than its 21 parts"),
    ],
)
def test_what_is_no_part(tmp_path, part, of, words):
    with pytest.raises(fx.ArgumentError, match=words):
        joined(tmp_path / "map.zarr", part, of)
    assert not (tmp_path / "map.zarr").exists()


def test_the_command(run, tmp_path, whole):
    line = ["sweep", "mukherjee-i", "--around", "0.08", "0.15rad", "--points", 10_000, "--seed", 5, "--chunk", CHUNK]
    place = tmp_path / "map.zarr"
    code, out, err = run(*line, "--out", place, "--part", "2/2", "--threads", 1)
    assert code == 0
    assert "part 2/2: 5000 poses" in err
    assert "worst" not in out  # no summary of a part
    code, out, err = run(*line, "--out", place, "--part", "1/2", "--time-limit", "1us", "--json")
    assert code == 3
    assert '"kind": "OutOfTime"' in err
    code, out, err = run(*line, "--out", place, "--part", "1/2")
    assert code == 0
    assert "10000 poses: 10000 ok" in out
    assert content(place) == whole
    for wrong in ("3/2", "0/2", "1", "1/x", "-1/2"):
        assert run(*line, "--out", place, "--part", wrong)[0] == 2
    assert run(*line, "--part", "1/2")[0] == 2
