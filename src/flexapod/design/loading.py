"""Designs from the library and from files."""

from __future__ import annotations

from pathlib import Path

from flexapod.design import design_file
from flexapod.design.hexapod import Hexapod
from flexapod.errors import DesignError


def load(name_or_path: str | Path) -> Hexapod:
    """Read a packaged design by its name, or a design file (.toml) by its path.

    Parameters
    ----------
    name_or_path : str or Path
        A name that `flexapod.packaged_designs` lists, or the path of a file.

    Returns
    -------
    Hexapod
        The design, in SI units.

    Raises
    ------
    DesignError
        For a name or file that is no design, with the reason and the remedy.

    See Also
    --------
    flexapod.Hexapod.from_toml : Read the text of a design file.

    Notes
    -----
    What a packaged design is taken from stands in its file. The format is described in docs/design-file.md.

    Examples
    --------
    >>> fx.load("mukherjee-ii").platform_mass
    4.0
    """
    path = design_file.find(name_or_path)
    read = design_file.read_file(path)
    try:
        return Hexapod.from_values(*read)
    except DesignError as error:
        raise DesignError(f"{path}: {error}") from error
