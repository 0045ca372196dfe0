"""Sweeps too large for memory: Zarr stores that can be resumed, computed by threads or on a Dask cluster."""
