"""Options of the commands that several computers can share."""

from __future__ import annotations

import re
from typing import Any

import click

from flexapod.cli.options.quantities import TIME


class PartOf(click.ParamType):
    """K/N: which part, from 1, of how many."""

    name = "part"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, int]:
        if isinstance(value, tuple):
            return value
        match = re.fullmatch(r"([1-9]\d{0,8})/([1-9]\d{0,8})", value.strip(), re.ASCII)
        if match is None or int(match[1]) > int(match[2]):
            self.fail(f"{value!r} is no part. Give K/N with K from 1 to N, as 2/8.", param, ctx)
        return int(match[1]), int(match[2])


cluster_options = (
    click.option(
        "--scheduler",
        default=None,
        metavar="ADDRESS",
        help="Compute on the Dask cluster of this scheduler: tcp://host:8786, or the file.json that it writes its "
        "address to; `local` starts one here.",
    ),
    click.option(
        "--timeout",
        type=TIME,
        default="10s",
        show_default=True,
        metavar="S",
        help="How long to wait for the scheduler of --scheduler, and then for its first worker.",
    ),
)
