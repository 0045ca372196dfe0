"""What --psd, --load and --at give, as arguments of the library's random responses."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import click

from flexapod.cli.options.points import PointGiven
from flexapod.cli.options.spectra import read_load, read_spectra
from flexapod.vibration.random_sources import RandomLoad


class ShakingGiven(NamedTuple):
    """Arguments of `random_response` and `controlled_random_response`, and what there is to say of the files."""

    given: dict[str, Any]
    notes: list[str]


def read_shaking(psd: Path | None, files: Sequence[Path], at: Sequence[PointGiven]) -> ShakingGiven | None:
    """Spectra of the base and of loads in files; None where there are none."""
    given: dict[str, Any] = {}
    notes, loads = [], []
    if psd is not None:
        spectra = read_spectra(psd)
        notes += spectra.notes
        given = {"psd": spectra.density, "frequency": spectra.frequency, "of": spectra.of}
    if at and not files:
        raise click.UsageError("--at is where a load acts, and there is none. Give its spectra with --load.")
    places = tuple(at) or ((0.0, 0.0, 0.0),)
    if len(places) not in (1, len(files)):
        raise click.UsageError(
            f"--at gives {len(places)} places for {len(files)} load{'s' * (len(files) > 1)}. Give one for all, or one "
            "for each --load in turn."
        )
    stems = [file.stem for file in files]
    for file, place in zip(files, places * len(files) if len(places) == 1 else places, strict=False):
        spectra = read_load(file)
        notes += spectra.notes
        alone = stems.count(file.stem) == 1 and file.stem != "base"  # which is the moving base in the results
        name = file.stem if alone else str(file)
        loads.append(RandomLoad(spectra.density, frequency=spectra.frequency, point=place, name=name))
    return ShakingGiven({**given, "loads": loads}, notes) if given or loads else None
