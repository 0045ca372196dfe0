"""A stored sweep, whole or in part, as a dataset whose numbers are read when they are used."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from flexapod.workspace.quantities import QUANTITIES
from flexapod.workspace.store.block_job import zarr_package
from flexapod.workspace.store.integrity import damage, damaged_description
from flexapod.workspace.store.metadata import read_description

if TYPE_CHECKING:
    import xarray as xr


def open_sweep(path: str | Path) -> xr.Dataset:
    """Open a stored sweep, whole or in part.

    Parameters
    ----------
    path : str or Path
        The store.

    Returns
    -------
    xarray.Dataset
        As `fx.sweep` gives, in SI units; numbers are read when they are used. Poses that are not computed yet are NaN
        and have the status ``pending``.

    Raises
    ------
    OutputError
        If there is no such store, or it is damaged. Sizes of files are looked at when it is opened, and every file is
        compared with its sum when it is read.

    See Also
    --------
    SweepStore : Makes a store.

    Notes
    -----
    The store is a Zarr group (version 3), which other programs can read.

    Examples
    --------
    >>> store = fx.workspace.SweepStore.create("map.zarr", fx.load("motion-base"), fx.pose_grid(z=[2.3, 2.4]))
    >>> _ = store.run()
    >>> fx.open_sweep("map.zarr").omega_1.round(2).values
    array([28.88, 27.99])
    """
    import xarray as xr

    zarr = zarr_package()
    from flexapod.workspace.store.guarded import Guarded

    attrs, layout, done = read_description(path)
    files = damaged_description(layout.path, attrs["files"])
    files += [file for names in layout.damaged(sorted(done), thorough=False).values() for file in names]
    if files:
        raise damage(layout.path, files)
    guarded = Guarded(zarr.storage.LocalStore(layout.path, read_only=True), layout, done)
    found = xr.open_zarr(guarded, consolidated=False, chunks=None)
    return found[[*(name for name in QUANTITIES if name in layout.arrays), "status"]]
