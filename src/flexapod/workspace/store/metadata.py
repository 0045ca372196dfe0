"""What a stored sweep says of itself, and its empty arrays: made as a whole, replaced as a whole, and compared."""

from __future__ import annotations

import json
import os
import shutil
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from flexapod.conventions import AXES
from flexapod.errors import OutputError
from flexapod.workspace.pose_sets import GridPoses
from flexapod.workspace.quantities import PENDING, QUANTITIES, attributes, provenance
from flexapod.workspace.store.block_job import Job, sync, zarr_package

FORMAT = "flexapod sweep 1"


def attributes_of(job: Job) -> dict[str, Any]:
    """The attributes of a store, without the blocks that are done."""
    assert job.points is not None
    box = job.points.box
    volume = {} if box is None else {"box_volume": box.volume, "box_volume_unit": box.volume_unit}
    return {
        **provenance(job.hexapod, job.joint),
        "format": FORMAT,
        "design_toml": job.hexapod.to_toml(),
        "poses": json.dumps(job.points.identity()),
        **volume,
        "quantities": " ".join(job.quantities),
        "chunk": " ".join(map(str, job.blocks.chunk)),
        "keeps_poses": int(job.keep_poses),
        "coordinates": " ".join(AXES),
    }


def make_store(job: Job) -> None:
    """The whole tree of metadata under another name, then moved into place: there is a store or there is none."""
    path = Path(job.path)
    if path.exists():
        raise OutputError(f"{path} exists already. Go on with it (--resume), choose another name, or remove it.")
    if not path.parent.is_dir():
        raise OutputError(f"{path.parent} is no directory, so {path.name} cannot be written in it. Make it first.")
    making = path.with_name(f".{path.name}.{job.token}")
    try:
        _write_metadata(making, job)
        os.replace(making, path)
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror or error}. Choose another place.") from error
    finally:
        shutil.rmtree(making, ignore_errors=True)


def _write_metadata(path: Path, job: Job) -> None:
    assert job.points is not None
    points, cut = job.points, job.blocks
    path.mkdir()
    group = zarr_package().create_group(path, zarr_format=3, attributes={**attributes_of(job), "done": ""})
    coordinate = {name: "float64" for name in AXES if job.keep_poses}
    columns = {name: QUANTITIES[name].dtype for name in job.quantities} | {"status": "uint8"} | coordinate
    for name, dtype in columns.items():
        trailing = QUANTITIES[name].trailing if name in QUANTITIES else ""
        group.create_array(
            name,
            shape=cut.shape + ((6,) if trailing else ()),
            chunks=cut.chunk + ((6,) if trailing else ()),
            dtype=dtype,
            fill_value={"float64": np.nan, "uint8": PENDING, "bool": False}[dtype],
            compressors="auto" if name == "status" else None,  # numbers of this kind hardly shrink
            dimension_names=points.dims + ((trailing,) if trailing else ()),
            attributes=_plain(attributes(name)),
        )
        if trailing and trailing not in group:
            group.create_array(trailing, data=np.arange(1, 7), dimension_names=(trailing,))
    if isinstance(points, GridPoses):
        for name in AXES:
            axis = points.axes[name]
            along = name in points.dims
            group.create_array(
                name,
                data=axis if along else axis[0].reshape(()),
                dimension_names=(name,) if along else (),
                attributes=_plain(attributes(name)),
            )


def _plain(attrs: dict[str, Any]) -> dict[str, Any]:
    return {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in attrs.items()}


def replace_attributes(path: Path, attrs: dict[str, Any]) -> None:
    """Put other attributes in the place of those of a store: the old ones are there until the new ones are whole."""
    file, new = path / "zarr.json", path / "zarr.json.partial"
    document = json.loads(file.read_bytes())
    document["attributes"] = attrs
    with new.open("w", encoding="utf-8") as stream:
        json.dump(document, stream, indent=2)
        stream.flush()
        os.fsync(stream.fileno())
    os.replace(new, file)
    sync(path)


def read_attributes(path: str | Path) -> dict[str, Any]:
    """Attributes of a sweep store. Raises OutputError where there is none."""
    file = Path(path, "zarr.json")
    try:
        attrs = json.loads(file.read_bytes())["attributes"]
        found = attrs["format"]
    except FileNotFoundError:
        raise OutputError(f"there is no sweep at {path} to read or to resume (no {file.name} in it).") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise OutputError(f"{path} is no sweep of Flexapod ({type(error).__name__}: {error}).") from error
    if found != FORMAT:
        raise OutputError(f"{path} has format {found!r}; this version reads {FORMAT!r}.")
    return dict(attrs)


_COMPARED = {
    "design_digest": "design",
    "poses": "poses",
    "joint": "joint model",
    "quantities": "choice of quantities",
    "source": "version",
    "instruction_set": "instruction set (FLEXAPOD_SIMD)",
}


def refuse_other(path: str | Path, old: dict[str, Any], new: dict[str, Any], chunk: int | None) -> None:
    """Raises OutputError if a store was begun with something else than it is to be resumed with."""
    for key, word in _COMPARED.items():
        if old[key] != new[key]:
            was, now = (
                f"{attrs['design']!r} ({attrs[key]})" if key == "design_digest" else str(attrs[key])
                for attrs in (old, new)
            )
            raise OutputError(
                f"{path} was begun with another {word}: it has {was}, and now it is {now}. "
                "Resume with what it was begun with, or write to another store."
            )
    stored = prod(map(int, old["chunk"].split()))
    if chunk is not None and chunk != stored:
        raise OutputError(f"{path} was begun with blocks of {stored} poses, not {chunk}. Leave --chunk out to resume.")


def ranges(numbers: set[int]) -> str:
    """Numbers as text, such as "0-4,6"."""
    text: list[str] = []
    ordered = sorted(numbers)
    first = 0
    for k, number in enumerate(ordered):
        if k + 1 == len(ordered) or ordered[k + 1] != number + 1:
            text.append(f"{ordered[first]}-{number}" if k > first else str(number))
            first = k + 1
    return ",".join(text)


def numbers_in(text: str) -> set[int]:
    """The numbers of which `ranges` gives the text."""
    found: set[int] = set()
    for part in filter(None, text.split(",")):
        first, _, last = part.partition("-")
        found.update(range(int(first), int(last or first) + 1))
    return found
