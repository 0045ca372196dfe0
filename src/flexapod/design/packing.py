"""Where the core keeps each number of a design, and a design's values in that order."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.conventions import Array

#: Key of the design file -> numbers of its entries, in the key's shape; symmetric matrices name six of them twice.
PLACES: dict[str, NDArray[np.int64]] = {field.name: field.index for field in _core.DESIGN_LAYOUT}


def packed(values: Mapping[str, Any]) -> Array:
    """The design as the core takes it, read-only, from its values by file key."""
    numbers = np.empty(_core.design_size)
    for key, place in PLACES.items():
        numbers[place] = values[key]
    numbers.flags.writeable = False
    return numbers
