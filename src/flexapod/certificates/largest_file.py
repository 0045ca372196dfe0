"""How far the search for the largest box is, in a file, so that it can be gone on with."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flexapod.certificates import file
from flexapod.certificates.certificate import Certificate
from flexapod.conventions import Array
from flexapod.errors import DesignError, OutputError
from flexapod.output_files import write_file
from flexapod.workspace.store.integrity import sealed

FORMAT = "flexapod largest box"


@dataclass
class Progress:
    """The largest scale that is proved, with its certificate; the least that is refuted, with a pose; that in hand."""

    low: float
    found: Certificate | None
    refuted: float
    pose: Array | None
    scale: float


def in_hand(path: Path) -> Path:
    """The file of the certificate that is being made, beside that of the search."""
    return path.with_name(f"{path.stem}-in-hand.json")


def write(path: Path, question: dict[str, Any], progress: Progress) -> None:
    """Write how far a search is, as a whole or not at all. Raises OutputError."""
    data = {
        "format": FORMAT,
        "version": file.VERSION,
        "question": question,
        "low": progress.low,
        "found": None if progress.found is None else file.data_of(progress.found),
        "refuted": str(progress.refuted),
        "pose": None if progress.pose is None else progress.pose.tolist(),
        "scale": progress.scale,
    }
    write_file(path, json.dumps(sealed(data), indent=1) + "\n")


def read(path: Path, question: dict[str, Any]) -> Progress:
    """Read how far a search is. Raises OutputError where the file is of another question, or cannot be read."""
    data = file.read_data(path, FORMAT)
    if other := [name for name, value in question.items() if data.get("question", {}).get(name) != value]:
        raise OutputError(
            f"{path} is the search for another box: its {' and '.join(other)} differ. Give the same arguments, or "
            "another file."
        )
    try:
        return Progress(
            low=float(data["low"]),
            found=None if data["found"] is None else file.certificate_of(data["found"]),
            refuted=float(data["refuted"]),
            pose=None if data["pose"] is None else np.array(data["pose"], dtype=np.float64).reshape(6),
            scale=float(data["scale"]),
        )
    except (KeyError, TypeError, ValueError, DesignError) as error:
        raise OutputError(f"{path} cannot be understood ({error}). Begin the search anew, without resume.") from error
