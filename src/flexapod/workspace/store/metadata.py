"""What a stored sweep says of itself, and its empty arrays: made as a whole, replaced as a whole, and compared."""

from __future__ import annotations

import json
import os
import shutil
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from flexapod.checks import whole
from flexapod.conventions import AXES
from flexapod.errors import ArgumentError, OutputError
from flexapod.output_files import passing
from flexapod.workspace.pose_sets import GridPoses
from flexapod.workspace.quantities import PENDING, QUANTITIES, attributes, provenance
from flexapod.workspace.store.block_job import Job, sync, zarr_package
from flexapod.workspace.store.blocks import Blocks
from flexapod.workspace.store.integrity import (
    ROOT,
    Layout,
    array_names,
    damaged_description,
    description_files,
    dtype_of,
    sealed,
)

FORMAT = "flexapod sweep 2"


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
        "shape": " ".join(map(str, job.blocks.shape)),
        "chunk": " ".join(map(str, job.blocks.chunk)),
        "keeps_poses": int(job.keep_poses),
        "coordinates": " ".join(AXES),
    }


def make_store(job: Job) -> None:
    """The whole tree of metadata under another name, then moved into place: there is a store or there is none."""
    path = Path(job.path)
    try:
        if path.exists():
            raise OutputError(f"{path} exists already. Go on with it (--resume), choose another name, or remove it.")
        if not path.parent.is_dir():
            raise OutputError(f"{path.parent} is no directory, so {path.name} cannot be written in it. Make it first.")
        with passing(path.with_name(f".{path.name}.{job.token}")) as making:
            _write_metadata(making, job)
            os.replace(making, path)
    except OutputError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a name with a null character
        words = getattr(error, "strerror", None) or error
        raise OutputError(f"{path} cannot be written: {words}. Choose another place.") from error


def _write_metadata(path: Path, job: Job) -> None:
    assert job.points is not None
    points, cut = job.points, job.blocks
    path.mkdir()
    zarr = zarr_package()
    group = zarr.create_group(path, zarr_format=3)
    for name in job.layout.arrays:
        trailing = QUANTITIES[name].trailing if name in QUANTITIES else ""
        dtype = dtype_of(name)
        group.create_array(
            name,
            shape=cut.shape + ((6,) if trailing else ()),
            chunks=cut.chunk + ((6,) if trailing else ()),
            dtype=dtype,
            fill_value={"f": np.nan, "u": PENDING, "b": False}[dtype.kind],
            compressors=zarr.codecs.Crc32cCodec(),  # a sum of each file; numbers of this kind hardly shrink
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
    replace_attributes(path, {**attributes_of(job), "files": description_files(path), "done": ""})


def mend_description(job: Job, files: dict[str, str]) -> list[str]:
    """Put back what describes a store where it is damaged; the names of what was."""
    path = Path(job.path)
    damaged = damaged_description(path, files)
    if damaged:
        try:
            with passing(path.with_name(f".{path.name}.{job.token}")) as making:
                _write_metadata(making, job)
                for name in damaged:
                    remove(path / name)
                    (path / name).parent.mkdir(parents=True, exist_ok=True)
                    os.replace(making / name, path / name)
        except OSError as error:
            raise OutputError(f"{path} cannot be mended: {error.strerror or error}. Choose another store.") from error
    return damaged


def remove(path: Path) -> None:
    """Take away a file, or a directory that stands in its place."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _plain(attrs: dict[str, Any]) -> dict[str, Any]:
    return {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in attrs.items()}


def replace_attributes(path: Path, attrs: dict[str, Any]) -> None:
    """Put other attributes in the place of those of a store: the old ones are there until the new ones are whole."""
    file, new = path / ROOT, path / f"{ROOT}.partial"
    document = {"attributes": sealed(attrs), "zarr_format": 3, "node_type": "group"}
    try:
        with new.open("w", encoding="utf-8") as stream:
            json.dump(document, stream, indent=2)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(new, file)
    finally:
        new.unlink(missing_ok=True)  # where the disk was full
    sync(path)


class Description(NamedTuple):
    """What a store says of itself: its attributes, where its numbers lie, and the blocks that are done."""

    attrs: dict[str, Any]
    layout: Layout
    done: frozenset[int]


def read_description(path: str | Path) -> Description:
    """What a store says of itself. Raises OutputError where there is none, or where it is damaged."""
    path = Path(path)
    attrs = _attributes(path)
    try:
        shape, chunk = (tuple(map(int, attrs[key].split())) for key in ("shape", "chunk"))
        cut = Blocks(shape, chunk)
        if not 0 < len(shape) == len(chunk) or min(*shape, *chunk) < 1:
            raise ValueError(f"blocks of {chunk} of {shape} poses")
        layout = Layout(path, array_names(_names_in(attrs["quantities"]), bool(attrs["keeps_poses"])), cut)
        done = frozenset(numbers_in(attrs["done"], cut.count) if "done" in attrs else range(cut.count))
    except (KeyError, ValueError, TypeError, AttributeError, ArgumentError) as error:
        raise _broken(path, error) from error
    return Description(attrs, layout, done)


def _names_in(text: Any) -> tuple[str, ...]:
    """Names of quantities in an attribute."""
    names = tuple(text.split())
    if not names or any(name not in QUANTITIES for name in names):
        raise ValueError(f"quantities {text!r}")
    return names


def _attributes(path: Path) -> dict[str, Any]:
    try:
        document = json.loads((path / ROOT).read_bytes())
        attrs = document["attributes"]
        found = attrs["format"]
    except (FileNotFoundError, NotADirectoryError):
        raise OutputError(f"there is no sweep at {path} to read or to resume (no {ROOT} in it).") from None
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise OutputError(
            f"{path} is no sweep of Flexapod, or damaged: its {ROOT} does not say what the store holds. Give a store "
            f"that `flexapod sweep --out` made; of a damaged one put back a copy of {ROOT}, or sweep anew."
        ) from error
    if found != FORMAT:
        raise OutputError(f"{path} has format {found!r}; this version reads {FORMAT!r}.")
    kind = (document.get("zarr_format"), document.get("node_type"), sorted(document))
    if kind != (3, "group", ["attributes", "node_type", "zarr_format"]) or sealed(attrs) != attrs:
        raise _broken(path, "its sum does not agree")
    return dict(attrs)


def _broken(path: Path, reason: object) -> OutputError:
    return OutputError(
        f"{path} is damaged: {ROOT}, which says what the store holds, is not what was written ({reason}). Put back a "
        "copy of that file, or remove the store and sweep anew."
    )


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
    if chunk is not None and whole(chunk, "chunk") != stored:
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


def numbers_in(text: str, count: int) -> set[int]:
    """The numbers of which `ranges` gives the text. Raises ValueError for another text, or one not below `count`."""
    found: set[int] = set()
    for part in filter(None, text.split(",")):
        first, _, last = part.partition("-")
        low, high = int(first), int(last or first)
        if not 0 <= low <= high < count:
            raise ValueError(f"blocks {part} of {count}")
        found.update(range(low, high + 1))
    return found
