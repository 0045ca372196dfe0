"""Stored sweeps: the numbers of a sweep in memory; the same bytes however often a run is ended and taken up again."""

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.helpers.stores import BOX, POSES, I, content, stored

import flexapod as fx
from flexapod.workspace.store import store as store_module
from flexapod.workspace.store import threads as threads_module
from flexapod.workspace.store.blocks import Blocks, blocks


@settings(max_examples=100, deadline=None)
@given(shape=st.lists(st.integers(1, 7), min_size=1, max_size=5), most=st.integers(1, 60))
def test_blocks_are_runs_that_cover_the_array_once(shape, most):
    cut = blocks(tuple(shape), most)
    numbers = np.arange(np.prod(shape)).reshape(shape)
    end = 0
    for block in cut:
        assert block.start == end
        assert block.stop - block.start <= most
        assert np.array_equal(numbers[block.region].ravel(), np.arange(block.start, block.stop))
        assert cut[block.number] == block
        end = block.stop
    assert end == numbers.size


def test_blocks_of_a_huge_array_are_found_at_once():
    cut = Blocks((10**12,), (2**19,))
    assert cut[cut.count - 1].stop == 10**12


@pytest.mark.parametrize(
    "poses",
    [
        fx.random_poses(BOX, 2000),
        fx.workspace.low_discrepancy(BOX, 2000),
        fx.pose_grid(x=np.linspace(0, 0.2, 9), z=np.linspace(0.7, 0.9, 8), yaw=np.linspace(-0.2, 0.2, 7)),
        fx.Pose.from_rpy(*fx.random_poses(BOX, 500).rows(0, 500).T),
        fx.random_poses(BOX, 600).rows(0, 600).reshape(20, 30, 6),
    ],
    ids=["random", "sobol", "grid", "pose", "array"],
)
def test_a_store_holds_what_a_sweep_gives(tmp_path, poses):
    names = ("omega_1", "omega", "cond_H", "within_limits")
    stored(tmp_path / "map.zarr", poses, names, chunk=270)
    found, expected = fx.open_sweep(tmp_path / "map.zarr"), fx.sweep(I, poses, quantities=names)
    assert found.omega_1.dims == expected.omega_1.dims
    for name in (*names, "status", "x", "z", "pitch", "yaw"):
        if isinstance(poses, fx.Pose) and name in {"pitch", "yaw"}:  # of matrices; the sweep's lanes round otherwise
            assert np.allclose(found[name].values, expected[name].values, rtol=0, atol=1e-14), name
        else:
            assert np.array_equal(found[name].values, expected[name].values), name
        assert found[name].attrs["long_name"] == expected[name].attrs["long_name"]
    assert found.attrs["design_digest"] == I.digest
    assert fx.Hexapod.from_toml(found.attrs["design_toml"]) == I


def test_other_tools_can_read_it(tmp_path):
    import zarr

    stored(tmp_path / "map.zarr", chunk=3000)
    group = zarr.open_group(tmp_path / "map.zarr", mode="r")
    assert group.metadata.zarr_format == 3
    assert group["omega_1"].chunks == (3000,)
    assert group["omega_1"].metadata.dimension_names == ("pose",)
    assert group["omega_1"].attrs["units"] == "rad/s"


def test_poses_can_be_left_out_and_made_again(tmp_path):
    stored(tmp_path / "map.zarr", keep_poses=False)
    found = fx.open_sweep(tmp_path / "map.zarr")
    assert "x" not in found
    worst = fx.summarise(found).worst
    assert np.array_equal(worst.pose, POSES.rows(worst.number, worst.number + 1)[0])


class StopAfter:
    """A `stop` that says so when it was asked often enough, as a Ctrl-C would."""

    def __init__(self, count):
        self.left = count

    def __call__(self):
        self.left -= 1
        return self.left < 0


def test_stopped_and_resumed_is_the_same_to_the_byte(tmp_path):
    stored(tmp_path / "whole.zarr", chunk=700)
    path = tmp_path / "pieces.zarr"
    store = fx.workspace.SweepStore.create(path, I, POSES, chunk=700)
    store.run(workers=1, stop=StopAfter(4))
    assert 0 < len(store.done) < store.job.blocks.count
    partial = fx.open_sweep(path)
    pending = partial.status.values == 255
    assert 0 < pending.sum() < POSES.count
    assert np.isnan(partial.omega_1.values[pending]).all()
    assert np.isfinite(partial.omega_1.values[~pending]).all()
    before = partial.attrs["done"]
    runs = 0
    while not store.complete:
        store = fx.workspace.SweepStore.resume(path, I, POSES)
        store.run(workers=2, stop=StopAfter(6))
        runs += 1
    assert runs > 1
    assert before
    assert "done" not in fx.open_sweep(path).attrs
    assert content(path) == content(tmp_path / "whole.zarr")


def test_resuming_a_complete_store_changes_nothing(tmp_path):
    path = tmp_path / "map.zarr"
    stored(path)
    before = content(path)
    store = fx.workspace.SweepStore.resume(path, I, POSES)
    assert store.complete
    assert store.run().done == POSES.count
    assert content(path) == before


KILLED = """
import sys, flexapod as fx
from flexapod.workspace.store import store
store.MARK_EVERY = 0.0
design = fx.load("mukherjee-i")
poses = fx.random_poses(fx.Box.about(fx.home_pose(design), 0.08, 0.15), 600_000, seed=5)
fx.workspace.SweepStore.create(sys.argv[1], design, poses, chunk=30_000).run()
"""


def test_killed_and_resumed_is_the_same_to_the_byte(tmp_path):
    path = tmp_path / "map.zarr"
    with subprocess.Popen([sys.executable, "-c", KILLED, path]) as process:
        while not path.exists() or not store_module.read_description(path).done:
            assert process.poll() is None, "the run ended before it could be killed"
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
    poses = fx.random_poses(BOX, 600_000, seed=5)
    (path / "omega_1" / "c" / "7.0123.partial").write_bytes(b"half a chunk")
    store = fx.workspace.SweepStore.resume(path, I, poses)
    assert 0 < len(store.done) < store.job.blocks.count
    state = store.run()
    assert 0 < state.before < state.done == 600_000
    stored(tmp_path / "whole.zarr", poses, chunk=30_000)
    assert content(path) == content(tmp_path / "whole.zarr")


def test_what_a_killed_worker_left_is_taken_away(tmp_path):
    path = tmp_path / "map.zarr"
    store = fx.workspace.SweepStore.create(path, I, POSES, chunk=4000)
    left = path / "cond_H" / "c" / "1.0123.partial"
    store.run(progress=lambda share: left.write_bytes(b"half a chunk"))
    stored(tmp_path / "whole.zarr", chunk=4000)
    assert content(path) == content(tmp_path / "whole.zarr")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"hexapod": I.replace({"platform.mass": 41.0})}, ("another design", I.digest)),
        (
            {"region": fx.random_poses(fx.Box.about(fx.home_pose(I), 0.09, 0.15), 10_000, seed=5)},
            ("another poses", '"box"'),
        ),
        ({"region": fx.random_poses(BOX, 10_000, seed=6)}, ('"seed": 5', '"seed": 6')),
        ({"region": fx.random_poses(BOX, 10_001, seed=5)}, ('"count": 10000', '"count": 10001')),
        ({"quantities": ("omega_1",)}, ("omega_1 cond_H", "now it is omega_1")),
        ({"joint": "spin_free"}, ("another joint model", "universal", "spin_free")),
        ({"chunk": 123}, ("blocks of 4000 poses, not 123",)),
    ],
)
def test_a_changed_sweep_is_not_resumed(tmp_path, change, words):
    path = tmp_path / "map.zarr"
    fx.workspace.SweepStore.create(path, I, POSES, chunk=4000)
    given = {"hexapod": I, "region": POSES, "quantities": ("omega_1", "cond_H"), **change}
    with pytest.raises(fx.errors.OutputError) as caught:
        fx.workspace.SweepStore.resume(path, **given)
    for word in words:
        assert word in str(caught.value)


def test_given_poses_are_told_apart_by_their_numbers(tmp_path):
    rows = POSES.rows(0, 50)
    fx.workspace.SweepStore.create(tmp_path / "map.zarr", I, rows)
    fx.workspace.SweepStore.resume(tmp_path / "map.zarr", I, rows.copy())
    other = rows.copy()
    other[17, 3] += 1e-12
    with pytest.raises(fx.errors.OutputError, match="another poses"):
        fx.workspace.SweepStore.resume(tmp_path / "map.zarr", I, other)


def test_a_bad_pose_is_data_in_a_store_too(tmp_path):
    rows = POSES.rows(0, 50).copy()
    rows[17, 3] = np.nan
    store = fx.workspace.SweepStore.create(tmp_path / "map.zarr", I, rows)
    assert store.run().statuses == {0: 49, 3: 1}


def test_what_is_there_is_not_overwritten(tmp_path):
    path = tmp_path / "map.zarr"
    path.mkdir()
    with pytest.raises(fx.errors.OutputError, match="exists already"):
        fx.workspace.SweepStore.create(path, I, POSES)


@pytest.mark.parametrize(
    "make", [lambda p: None, lambda p: p.mkdir(), lambda p: (p.mkdir(), (p / "zarr.json").write_text("{}"))]
)
def test_what_is_no_store_is_not_resumed(tmp_path, make):
    make(tmp_path / "map.zarr")
    with pytest.raises(fx.errors.OutputError, match=r"no sweep"):
        fx.workspace.SweepStore.resume(tmp_path / "map.zarr", I, POSES)


def test_places_that_cannot_be_written_are_told(tmp_path):
    with pytest.raises(fx.errors.OutputError, match="is no directory"):
        fx.workspace.SweepStore.create(tmp_path / "none" / "map.zarr", I, POSES)
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(fx.errors.OutputError, match="is no directory"):
        fx.workspace.SweepStore.create(file / "map.zarr", I, POSES)
    with pytest.raises(fx.errors.OutputError, match="cannot be written"):
        fx.workspace.SweepStore.create(Path("/proc/map.zarr"), I, POSES)


def test_two_runs_do_not_write_one_store(tmp_path):
    store = fx.workspace.SweepStore.create(tmp_path / "map.zarr", I, POSES, chunk=1000)
    other = fx.workspace.SweepStore.resume(tmp_path / "map.zarr", I, POSES)
    refused = []

    def meanwhile(state):
        if not refused:
            with pytest.raises(fx.errors.OutputError, match="another run"):
                other.run()
            refused.append(state)

    store.run(progress=meanwhile)
    assert refused


def test_another_instruction_set_is_refused(tmp_path):
    """Its last digits may differ, and the bytes would then depend on where a run was taken up."""
    path = tmp_path / "map.zarr"
    code = f"""
import flexapod as fx
design = fx.load("mukherjee-i")
poses = fx.random_poses(fx.Box.about(fx.home_pose(design), 0.08, 0.15), 10_000, seed=5)
fx.workspace.SweepStore.create({str(path)!r}, design, poses)
"""
    from flexapod import _core

    if len(_core.simd_available()) < 2:
        pytest.skip("this processor has one instruction set only")
    other = next(name for name in _core.simd_available() if name != _core.simd())
    subprocess.run([sys.executable, "-c", code], env={**os.environ, "FLEXAPOD_SIMD": other}, check=True)
    with pytest.raises(fx.errors.OutputError, match=f"instruction set.*{other}.*{_core.simd()}"):
        fx.workspace.SweepStore.resume(path, I, POSES)


def test_a_full_disk_leaves_a_readable_store_that_can_be_gone_on_with(tmp_path, monkeypatch):
    """The disk is full after five blocks, for this process; see below for a disk that truly is."""
    count = iter(range(100))

    def write(job, number, rows=None):
        if next(count) >= 5:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return real(job, number, rows)

    real = threads_module.write_block
    path = tmp_path / "map.zarr"
    store = fx.workspace.SweepStore.create(path, I, POSES, chunk=500)
    with monkeypatch.context() as patch:
        patch.setattr(threads_module, "write_block", write)
        with pytest.raises(fx.errors.OutputError, match=r"No space left on device.*poses are in it") as caught:
            store.run()
    partial = fx.open_sweep(path)
    there = partial.status.values == 0
    assert f"{there.sum()} of 10000 poses" in str(caught.value) or there.sum() <= 5 * 500
    assert np.isfinite(partial.omega_1.values[there]).all()
    fx.workspace.SweepStore.resume(path, I, POSES).run()
    stored(tmp_path / "whole.zarr", chunk=500)
    assert content(path) == content(tmp_path / "whole.zarr")


def test_a_disk_that_is_full(small_disk):
    path = small_disk / "map.zarr"
    poses = fx.random_poses(BOX, 100_000, seed=5)  # 6.5 MB
    store = fx.workspace.SweepStore.create(path, I, poses, chunk=5000)
    with pytest.raises(fx.errors.OutputError, match="No space left on device"):
        store.run(workers=1)
    partial = fx.open_sweep(path)
    marked = sum(store.job.blocks[n].stop - store.job.blocks[n].start for n in store.done)
    assert marked > 0
    assert (partial.status.values == 0).sum() >= marked
    assert np.isfinite(partial.omega_1.values[partial.status.values == 0]).sum() >= marked


def test_memory_does_not_grow_with_the_number_of_poses(tmp_path):
    """Four times as many poses, 65 MB more of numbers: less than 20 MB more of memory."""
    code = """
import resource, sys, flexapod as fx
design = fx.load("mukherjee-i")
poses = fx.random_poses(fx.Box.about(fx.home_pose(design), 0.08, 0.15), int(sys.argv[2]))
fx.workspace.SweepStore.create(sys.argv[1], design, poses, chunk=50_000).run(workers=1)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""
    peaks = []
    for count in (350_000, 1_400_000):
        command = [sys.executable, "-c", code, tmp_path / f"{count}.zarr", str(count)]
        peaks.append(int(subprocess.run(command, capture_output=True, text=True, check=True).stdout) / 1024)
    assert peaks[1] - peaks[0] < 20
