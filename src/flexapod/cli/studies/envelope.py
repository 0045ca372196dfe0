"""The study of `flexapod envelope`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from flexapod.cli.options import common
from flexapod.report.studies.envelope import study
from flexapod.report.study import Study
from flexapod.workspace.envelope import envelope

if TYPE_CHECKING:
    from flexapod.cli.options.points import PointGiven
    from flexapod.conventions import JointModel


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str
    changes: tuple[str, ...]
    joint: JointModel
    pose: tuple[float, ...] | None
    point: PointGiven
    proportions: tuple[float, ...] | None
    index: float | None
    condition: float | None
    characteristic_length: float | None
    as_csv: bool
    as_json: bool
    out: Path | None


def compute(options: Options) -> Study:
    """The envelope of the options."""
    hexapod, where = common.machine(options.design, options.changes, options.pose)
    half = options.proportions
    found = envelope(
        hexapod,
        where,
        point=options.point,
        proportions=None if half is None else [*half[:3], *map(math.radians, half[3:])],
        index=options.index,
        condition_number=options.condition,
        characteristic_length=options.characteristic_length,
        joint=options.joint,
    )
    return study(hexapod, found, bounded=options.index is not None or options.condition is not None)
