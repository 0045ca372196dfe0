"""The study of `flexapod robust`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click

from flexapod.cli.options import common, problem
from flexapod.cli.output.stages import Report
from flexapod.design.hexapod import Hexapod
from flexapod.optimisation.uncertainty import robustness
from flexapod.report.studies.robustness import study
from flexapod.report.study import Study


def compute(hexapod: Hexapod, given: Mapping[str, Any], report: Report) -> Study:
    """The distribution of the index that the options ask for."""
    over = problem.where(hexapod, given["pose"], given["box"], given["around"])
    straying = problem.uncertain(given["uncertain"]) + problem.payloads(given["payload"], given["payload_at"])
    if not straying:
        raise click.UsageError("nothing strays. Give --uncertain KEY=SPREAD or --payload LEAST:LARGEST.")
    options = {name: given[name] for name in ("samples", "sensitivity", "all_poses", "joint", "seed", "threads")}
    found = robustness(
        hexapod,
        straying,
        over,
        pose_samples=given["poses"],
        progress=lambda share: report("designs", share),
        **options,
    )
    pose = None if given["pose"] is None else common.pose_of(given["pose"])
    return study(hexapod, found, "home" if over is None else repr(over), pose)
