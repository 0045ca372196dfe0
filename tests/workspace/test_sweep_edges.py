"""Corners of sweeps: nothing that has an index, few poses, clusters that fail, systems that lack something."""

import json
import os
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.helpers.stores import BOX, I

import flexapod as fx
from flexapod.plots import sweep, sweep_scatter
from flexapod.workspace import summary
from flexapod.workspace.pose_sets import described
from flexapod.workspace.store import block_job, dask_cluster, file_formats

pytest.importorskip("zarr")
pytest.importorskip("distributed")


def nowhere():
    """A machine and poses at which no leg can be: all have no length."""
    h = fx.load("mukherjee-i")
    return h.replace({"platform.joints": h.base_joints.tolist()}), np.zeros((5, 6))


def test_a_sweep_without_an_index_is_not_summed_up():
    found = fx.sweep(*nowhere())
    assert not np.isfinite(found.omega_1).any()
    with pytest.raises(fx.PoseError, match=r"none of the 5 poses has an index\. See the variable `status`"):
        fx.summarise(found)
    with pytest.raises(fx.PoseError, match="no pose of this sweep has an index"):
        sweep.index_scatter(found)
    with pytest.raises(fx.PoseError, match=r"no pose of Box.* could be computed\. Look at the status"):
        fx.worst_pose(nowhere()[0], fx.Box(yaw=(-1e-12, 1e-12)), samples=4)


def test_bins_of_the_index_alone_and_over_decades(monkeypatch):
    """Where the index spans decades, the bins are even in its logarithm."""
    box = fx.Box(x=0, y=0, z=0.89, roll=0, pitch=(-0.57, 0.78), yaw=(-0.18, 0.92))
    found = fx.sweep(I, fx.random_poses(box, 3000, seed=2), quantities=["omega_1"])
    values = found.omega_1.values
    assert values.max() > 4 * values.min() > 0
    exact = fx.summarise(found)
    monkeypatch.setattr(summary, "EXACT", 100)
    binned = fx.summarise(found)
    assert np.isnan(binned.correlation)
    width = np.log(values.max() / values.min()) / 65536
    for at, value in exact.quantiles.items():
        nearest = np.sort(values)[[int(at * 2999), min(2999, int(at * 2999) + 1)]]
        assert nearest[0] * (1 - 2 * width) <= binned.quantiles[at] <= nearest[1] * (1 + 2 * width)
        assert binned.quantiles[at] == pytest.approx(value, rel=0.05)  # exact ones lie between neighbours too


def test_more_descents_than_poses_that_are_apart():
    """Few poses near one another: the distance asked for is halved until there are enough."""
    box = fx.Box(x=(0, 0.01), y=0, z=0.89, roll=0, pitch=0, yaw=0)
    found = fx.worst_pose(I, box, samples=40, starts=30)
    assert found.starts == 30
    assert found.omega_1 <= fx.stability_index(I, fx.Pose.from_rpy(np.linspace(0, 0.01, 50), 0, 0.89)).min()


def test_poses_that_were_given_cannot_be_made_again():
    assert (
        described(fx.workspace.pose_path(np.array([[0, 0, 0.9, 0, 0, 0], [0, 0, 1.0, 0, 0, 0]]), 3).describe()) is None
    )


class Future:
    def __init__(self, end):
        self.result = end

    def done(self):
        return True


class Client:
    """A Dask client whose futures end as told."""

    status = "running"

    def __init__(self, *ends):
        self.ends, self.cancelled = list(ends), []

    def submit(self, *given, **options):
        return Future(self.ends.pop(0))

    def cancel(self, futures):
        self.cancelled += futures


def submitted(monkeypatch, client):
    workers = dask_cluster.Cluster(client)
    monkeypatch.setattr(workers, "_most", lambda: 1)
    monkeypatch.setattr(workers, "_submit", lambda job, number: client.submit())
    return list(workers.compute(None, [0, 1], lambda: False))


def test_a_slow_block_is_waited_for(monkeypatch):
    import distributed

    waits = []

    def wait(futures, timeout, return_when):
        waits.append(timeout)
        if len(waits) == 1:
            raise TimeoutError

    monkeypatch.setattr(distributed, "wait", wait)
    assert submitted(monkeypatch, Client(lambda: "first", lambda: "second")) == ["first", "second"]
    assert len(waits) == 3


def test_a_block_that_kills_its_workers_is_told(monkeypatch):
    import distributed

    def killed():
        raise distributed.KilledWorker("block 0", SimpleNamespace(address="tcp://one"), 3)

    monkeypatch.setattr(distributed, "wait", lambda *given, **options: None)
    with pytest.raises(
        fx.errors.ClusterError, match=r"the cluster lost several workers over one block .* go on with --resume"
    ):
        submitted(monkeypatch, Client(killed))


def test_a_place_that_cannot_be_written_is_told(tmp_path):
    small = fx.sweep(I, fx.pose_grid(z=[0.9, 0.95]), quantities=["omega_1"])
    with pytest.raises(fx.errors.OutputError, match=r"sweep\.csv cannot be written: No such file or directory"):
        file_formats.save(small, tmp_path / "none" / "sweep.csv")


def test_systems_without_locks_and_directory_handles_still_write(tmp_path, monkeypatch):
    """As Windows."""
    store = fx.workspace.SweepStore.create(tmp_path / "s.zarr", I, fx.pose_grid(z=[0.9, 0.95]), quantities=["omega_1"])
    monkeypatch.setitem(sys.modules, "fcntl", None)
    real = os.open

    def files_only(path, *given, **options):
        if os.path.isdir(path):
            raise PermissionError(13, "Permission denied", str(path))
        return real(path, *given, **options)

    monkeypatch.setattr(block_job.os, "open", files_only)
    store.run(1)
    assert store.complete
    assert fx.open_sweep(tmp_path / "s.zarr").omega_1.size == 2


def test_a_store_of_another_format_is_told(tmp_path):
    fx.workspace.SweepStore.create(tmp_path / "s.zarr", I, fx.pose_grid(z=[0.9, 0.95]), quantities=["omega_1"])
    file = tmp_path / "s.zarr" / "zarr.json"
    document = json.loads(file.read_text())
    document["attributes"]["format"] = "flexapod-sweep-99"
    file.write_text(json.dumps(document))
    with pytest.raises(fx.errors.OutputError, match="has format 'flexapod-sweep-99'; this version reads"):
        fx.open_sweep(tmp_path / "s.zarr")


def test_scatter_reads_block_by_block_and_skips_those_without_an_index():
    found = fx.sweep(I, fx.random_poses(BOX, 400, seed=1))
    found["omega_1"][:200] = np.nan
    found["omega_1"].encoding["chunks"] = (100,)
    cloud = sweep_scatter._Cloud(summary.Counted(found, False))
    low, high, count = cloud.low, cloud.high, cloud.count
    assert count == 200
    assert low[0] == found.omega_1.values[200:].min()
    assert high[1] == found.cond_H.values[200:].max()


def test_a_map_of_angles_and_of_wide_lengths_is_in_degrees_and_metres():
    base = plain_machine("motion-base")
    found = fx.sweep(base, fx.pose_grid(z=np.linspace(2.2, 2.8, 3), roll=[-0.1, 0.0, 0.1]), quantities=["omega_1"])
    ax = sweep.index_map(found)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("z (m)", "roll (°)")
    assert ax.get_ylim() == pytest.approx(np.degrees([-0.15, 0.15]))  # half a cell around the outer poses
    line = sweep.auto(found.isel(roll=1))
    assert line.get_xlabel() == "z (m)"


def test_grids_that_no_map_can_show_are_scattered(monkeypatch):
    """Four coordinates: the index against cond(H), counted in cells where the poses are many."""
    axes = {"x": [0.0, 0.05], "y": [0.0, 0.05], "z": [0.9, 1.0], "yaw": [0.0, 0.1]}
    found = fx.sweep(I, fx.pose_grid(**axes))
    assert sweep.auto(found).get_xlabel() == "cond(H)"
    monkeypatch.setattr(sweep_scatter, "_DOTS", 10)
    bare = sweep.index_scatter(found, colorbar=False)
    assert len(bare.figure.axes) == 1
    assert len(sweep.index_scatter(found).figure.axes) == 2


def test_a_map_of_one_value_has_no_contours_and_no_worst_pose():
    found = fx.sweep(I, fx.pose_grid(x=[0.0, 0.1], z=[0.9, 1.0]), quantities=["omega_1"])
    found["omega_1"][:] = 100.0
    ax = sweep.index_map(found)
    assert len(ax.lines) == 0
    assert len(ax.collections) == 1  # the map itself


def test_a_figure_of_an_unknown_kind_and_a_fault_of_matplotlib(tmp_path, monkeypatch):
    ax = sweep.index_line(fx.sweep(I, fx.pose_grid(z=[0.9, 1.0]), quantities=["omega_1"]))
    with pytest.raises(fx.errors.OutputError, match=r"Choose \.png, \.pdf or \.svg"):
        sweep.save(ax, tmp_path / "map.docx")

    def broken(*given, **options):
        raise ValueError("of ours")

    monkeypatch.setattr(ax.figure, "savefig", broken)
    with pytest.raises(ValueError, match="of ours"):
        sweep.save(ax, tmp_path / "map.png")
