"""Stores that lost something or were changed: what is told where they are opened, read and taken up again."""

import json
import os

import numpy as np
import pytest
from tests.helpers.stores import BOX, I, content, stored

import flexapod as fx
from flexapod.cli import main
from flexapod.workspace.store import metadata

pytest.importorskip("zarr")

POSES = fx.random_poses(BOX, 6000, seed=5)


@pytest.fixture
def store(tmp_path):
    path = tmp_path / "map.zarr"
    stored(path, POSES, chunk=2000)
    return path


def resumed(path):
    found = fx.workspace.SweepStore.resume(path, I, POSES)
    found.run()
    return found


def test_files_of_blocks_end_in_a_sum_that_other_tools_check(store):
    import zarr

    group = zarr.open_group(store, mode="r")
    assert [codec.to_dict()["name"] for codec in group["omega_1"].compressors] == ["crc32c"]
    (store / "omega_1" / "c" / "1").write_bytes(b"x" * (store / "omega_1" / "c" / "1").stat().st_size)
    with pytest.raises(ValueError, match="checksum"):
        _ = group["omega_1"][:]


def remove(file):
    file.unlink()


def cut(file):
    file.write_bytes(file.read_bytes()[:-100])


def empty(file):
    file.write_bytes(b"")


@pytest.mark.parametrize("damage", [remove, cut, empty])
@pytest.mark.parametrize("name", ["omega_1/c/1", "status/c/2", "yaw/c/0", "cond_H/zarr.json", "x/zarr.json"])
def test_what_is_missing_is_told_where_a_store_is_opened(store, damage, name):
    before = content(store)
    damage(store / name)
    with pytest.raises(fx.errors.OutputError, match=rf"map\.zarr is damaged: {name} is missing or not.*--resume"):
        fx.open_sweep(store)
    found = resumed(store)
    assert found.damaged == (name,)
    assert content(store) == before


def test_a_bit_that_turned_is_told_where_it_is_read(store):
    before = content(store)
    file = store / "omega_1" / "c" / "1"
    data = bytearray(file.read_bytes())
    data[123] ^= 4
    file.write_bytes(data)
    found = fx.open_sweep(store)
    assert np.isfinite(found.omega_1[:2000]).all()
    for read in (
        lambda: found.omega_1.values,
        lambda: fx.summarise(found),
        lambda: fx.plots.sweep.index_scatter(found),
    ):
        with pytest.raises(fx.errors.OutputError, match=r"map\.zarr is damaged: omega_1/c/1"):
            read()
    assert resumed(store).damaged == ("omega_1/c/1",)
    assert content(store) == before


def test_many_damaged_files_are_told_briefly(store):
    for file in store.rglob("c/*"):
        file.unlink()
    with pytest.raises(fx.errors.OutputError, match=r"and \d+ more are missing") as caught:
        fx.open_sweep(store)
    assert len(str(caught.value)) < 600


@pytest.mark.parametrize(
    "change",
    [
        *(lambda d, key=key: d["attributes"].pop(key) for key in (
            "chunk", "shape", "keeps_poses", "poses", "design_digest", "quantities", "files", "sum", "joint",
        )),
        *(lambda d, key=key, value=value: d["attributes"].update({key: value}) for key, value in (
            ("chunk", "a b"), ("chunk", "0"), ("done", "a-b"), ("done", "0-99999999999"), ("done", "0-7"),
            ("quantities", "omega_1"), ("keeps_poses", 0), ("poses", "{}"), ("box_volume", 1.0),
        )),
        lambda d: d.update(node_type="array"),
        lambda d: d.update(zarr_format=2),
        lambda d: d.update(consolidated_metadata={}),
    ],
)  # fmt: skip
def test_what_a_store_says_of_itself_is_not_believed_unseen(store, change):
    file = store / "zarr.json"
    document = json.loads(file.read_bytes())
    change(document)
    file.write_text(json.dumps(document))
    for use in (lambda: fx.open_sweep(store), lambda: fx.workspace.SweepStore.resume(store, I, POSES)):
        with pytest.raises(fx.errors.OutputError, match=r"map\.zarr is damaged: zarr\.json"):
            use()


@pytest.mark.parametrize("attrs", [{"chunk": "a b"}, {"done": "0-99999999999"}, {"quantities": ""}, {"shape": "0"}])
def test_nor_where_its_sum_agrees(store, attrs):
    file = store / "zarr.json"
    document = json.loads(file.read_bytes())
    document["attributes"] = metadata.sealed(document["attributes"] | attrs)
    file.write_text(json.dumps(document))
    with pytest.raises(fx.errors.OutputError, match=r"map\.zarr is damaged: zarr\.json"):
        fx.open_sweep(store)


def test_blocks_that_are_not_marked_are_not_read(tmp_path):
    """A run that was killed may have written some of the files of a block."""
    path = tmp_path / "map.zarr"
    asked = iter(range(100))
    run = fx.workspace.SweepStore.create(path, I, POSES, chunk=1000)
    run.run(workers=1, stop=lambda: next(asked) > 2)
    stored(tmp_path / "whole.zarr", POSES, chunk=1000)
    last = run.job.blocks.count - 1
    assert last not in run.done
    for name in ("omega_1", "status"):
        os.link(tmp_path / "whole.zarr" / name / "c" / str(last), path / name / "c" / str(last))
    found = fx.open_sweep(path)
    assert (found.status.values[5000:] == 255).all()
    assert np.isnan(found.omega_1.values[5000:]).all()
    assert resumed(path).damaged == ()
    assert content(path) == content(tmp_path / "whole.zarr")


def test_a_store_of_another_version_is_told(store):
    file = store / "zarr.json"
    file.write_text(file.read_text().replace("flexapod sweep 2", "flexapod sweep 1"))
    with pytest.raises(fx.errors.OutputError, match="has format 'flexapod sweep 1'; this version reads"):
        fx.open_sweep(store)


def test_the_command_says_what_it_computes_anew(tmp_path, capsys):
    path = tmp_path / "map.zarr"
    given = ["sweep", "motion-base", "--around", ".1", "5", "--points", "6000", "--chunk", "2000", "--out", str(path)]
    assert main(given) == 0
    first = capsys.readouterr().out
    (path / "omega_1" / "c" / "1").unlink()
    assert main([*given, "--resume", "--at-least", "20"]) == 0
    said = capsys.readouterr()
    assert f"damaged or missing in {path}, so computed anew: omega_1/c/1\n" in said.err
    assert "ω1 ≥ 20 rad/s: 100.000% of the poses" in said.out
    assert first.splitlines()[-1] in said.out
