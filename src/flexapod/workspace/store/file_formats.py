"""A sweep in memory to one file: NetCDF, Parquet or CSV, by the ending of its name."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod.conventions import AXES, unit_of
from flexapod.errors import OutputError
from flexapod.optional import needed
from flexapod.output_files import check_file, completed, netcdf
from flexapod.workspace.pose_sets import in_words
from flexapod.workspace.quantities import QUANTITIES, memory, table_titles, titled

if TYPE_CHECKING:
    import pandas
    import xarray as xr

ZARR = ".zarr"
MOST_BYTES = 4 * 2**30


def save(sweep: xr.Dataset, path: str | Path) -> None:
    """Write a sweep. The file is there when it is whole: until then it has another name.

    Parquet and CSV have a row for each pose; CSV begins with lines `# name: value` that tell units and provenance.
    Raises OutputError for another ending or where nothing can be written, MissingExtraError for a missing package.
    """
    path = Path(path)
    write = _writer(path)
    with completed(path) as making:
        write(sweep, making)


def check_size(path: Path, poses: int, quantities: tuple[str, ...]) -> None:
    """Raises OutputError, before anything is computed, for a file that would be too large or cannot be."""
    _writer(path)
    check_file(path)
    size = memory(poses, quantities)
    if size > MOST_BYTES:
        raise OutputError(
            f"{in_words(poses)} poses take {size // 2**30} GiB in memory; a {path.suffix} file is written whole, up to "
            f"{MOST_BYTES // 2**30} GiB. Stream to a store instead: {path.with_suffix(ZARR).name}"
        )


def _writer(path: Path) -> Callable[[xr.Dataset, Path], None]:
    if path.suffix.lower() not in _WRITERS:
        raise OutputError(f"{path.name} ends in {path.suffix!r}; it must end in .zarr, {', '.join(_WRITERS)}.")
    return _WRITERS[path.suffix.lower()]


def _netcdf(sweep: xr.Dataset, path: Path) -> None:
    needed("h5netcdf", "sweep", "a .nc file needs h5netcdf")
    path.write_bytes(netcdf(sweep, engine="h5netcdf"))


def _parquet(sweep: xr.Dataset, path: Path) -> None:
    why = "a .parquet file needs PyArrow"
    pyarrow, parquet = needed("pyarrow", "sweep", why), needed("pyarrow.parquet", "sweep", why)
    table = pyarrow.Table.from_pandas(rows(sweep), preserve_index=False)
    told = {"flexapod": json.dumps(_about(sweep))}
    parquet.write_table(table.replace_schema_metadata({**(table.schema.metadata or {}), **told}), path)


def _csv(sweep: xr.Dataset, path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        for key, value in _about(sweep).items():
            stream.write(f"# {key}: {value}\n")
        rows(sweep).to_csv(stream, index=False, lineterminator="\n")


def _about(sweep: xr.Dataset) -> dict[str, str]:
    units = ", ".join(
        f"{name} {variable.attrs['units']}" for name, variable in sweep.variables.items() if "units" in variable.attrs
    )
    codes = sweep["status"].attrs
    words = [f"{k} {word}" for k, word in zip(codes["flag_values"], codes["flag_meanings"].split(), strict=True)]
    attrs = {str(key): str(value) for key, value in sweep.attrs.items()}
    if "poses" in attrs:
        attrs["poses"] = _brief(json.loads(attrs["poses"]))
    return {**attrs, "units": units, "status": ", ".join(words)}


def _brief(poses: dict[str, Any]) -> str:
    """What the poses are, in a line: the values of an axis of a grid are those of its column."""
    axes = {
        name: axis if isinstance(axis, dict) or len(axis) < 2 else {"values": len(axis)}
        for name, axis in poses.get("axes", {}).items()
    }
    return json.dumps({**poses, **({"axes": axes} if axes else {})})


def rows(sweep: xr.Dataset) -> pandas.DataFrame:
    """A row for each pose: coordinates, every quantity, those of six in six columns, status.

    Titles end in the unit: x_m, roll_rad, omega_1_rad_per_s, omega_mode_1_rad_per_s.
    """
    import pandas

    status = sweep["status"]
    found: dict[str, Any] = {}
    for name in AXES:
        column = sweep[name].broadcast_like(status).transpose(*status.dims)
        found[titled(name, unit_of(name))] = column.values.ravel()
    for key, variable in sweep.data_vars.items():
        name = str(key)
        if name == "status":
            continue
        titles, unit = table_titles(name), QUANTITIES[name].unit
        for title, values in zip(titles, np.asarray(variable.values).reshape(-1, len(titles)).T, strict=True):
            found[titled(title, unit)] = values
    return pandas.DataFrame({**found, "status": status.values.ravel()})


_WRITERS = {".nc": _netcdf, ".parquet": _parquet, ".csv": _csv}
