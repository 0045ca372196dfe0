"""Certificates in files: JSON with everything that a check needs, and a sum that tells what was changed."""

from __future__ import annotations

import json
import math
from base64 import b64decode, b64encode
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from flexapod.certificates.certificate import CLAIMS, STATUSES, Certificate
from flexapod.certificates.question import MOST_BOXES
from flexapod.conventions import JOINT_MODELS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.strays import data_of as strays_data
from flexapod.design.strays import strays_of
from flexapod.errors import ArgumentError, DesignError, OutputError
from flexapod.output_files import output_path, write_file
from flexapod.workspace.proof import Boxes, PathPieces, Place
from flexapod.workspace.store.integrity import sealed

FORMAT = "flexapod certificate"
VERSION = 1
_WITH_STRAYS = 2  # what reads version 1 only would check the design in the middle of the ranges
_WITH_PAYLOAD = 3  # and what reads version 2 only would leave out the payload
_NUMBERS = ("wanted", "gap", "lower", "upper", "level", "share_left", "share_outside", "seconds")
_PLAIN = ("claim", "status", "joint", "within_limits", "nominal", "broken", "boxes")


def write_certificate(certificate: Certificate, path: str | PathLike[str]) -> Path:
    """Write a certificate, as a whole or not at all. Raises OutputError."""
    return write_file(output_path(path), text_of(certificate))


def text_of(certificate: Certificate) -> str:
    """A certificate as the text of a file."""
    return json.dumps(sealed(data_of(certificate)), indent=1) + "\n"


def data_of(certificate: Certificate) -> dict[str, Any]:
    """A certificate as plain data."""
    from flexapod import __version__

    design = certificate.hexapod
    return {
        "format": FORMAT,
        "version": _WITH_PAYLOAD if certificate.payload else _WITH_STRAYS if certificate.strays else VERSION,
        "source": f"flexapod {__version__}",
        **{name: getattr(certificate, name) for name in _PLAIN},
        **{name: _plain(getattr(certificate, name)) for name in _NUMBERS},
        "assumed": list(certificate.assumed),
        **(
            {"strays": strays_data(certificate.strays), "strayed": list(certificate.strayed)}
            if certificate.strays
            else {}
        ),
        **({"payload": list(certificate.payload)} if certificate.payload else {}),
        "pose": None if certificate.pose is None else certificate.pose.tolist(),
        "region": region_data(certificate.place),
        "left": _packed(certificate.left),
        "design": {"name": design.name, "digest": design.digest, "toml": design.to_toml()},
    }


def region_data(place: Place) -> dict[str, Any]:
    """A region as plain data."""
    if isinstance(place, Boxes):
        return {"boxes": place.parts.tolist()}
    return {"pieces": place.pieces.tolist(), "middle": place.middle.tolist(), "spans": place.parts.tolist()}


def read_certificate(path: str | PathLike[str]) -> Certificate:
    """Read the file of a certificate.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    Certificate
        What is in it, as it was written.

    Raises
    ------
    OutputError
        If it cannot be read, is no certificate, or was changed since it was written.

    See Also
    --------
    check_certificate : Prove it anew.

    Notes
    -----
    The file ends in a sum over all that is in it, so that what a copy lost or a hand changed is told. A change of both
    it and its sum is told by `check_certificate`.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> box = fx.Box.about(fx.home_pose(machine), 0.02, 0.02)
    >>> found = fx.certify(machine, box, at_least=25.0, path="proof.json")
    >>> fx.certificates.read_certificate("proof.json").lower
    25.0
    """
    place = output_path(path)
    data = read_data(place, FORMAT)
    try:
        return certificate_of(data)
    except (KeyError, TypeError, ValueError, ArgumentError, DesignError) as error:
        raise _none(place, f"it cannot be understood ({error})") from error


def read_data(place: Path, kind: str) -> dict[str, Any]:
    """What is in a sealed file of a format. Raises OutputError where it cannot be read, or was changed."""
    try:
        data = json.loads(place.read_text(encoding="utf-8"))
    except OSError as error:
        raise OutputError(
            f"{place} cannot be read: {error.strerror or error}. Give the file of a certificate."
        ) from error
    except ValueError as error:
        raise _none(place, "it is no JSON") from error
    if not isinstance(data, dict) or data.get("format") != kind:
        raise _none(place, f"its format is not {kind!r}")
    if data.get("version") not in (VERSION, _WITH_STRAYS, _WITH_PAYLOAD):
        raise OutputError(
            f"{place} is of version {data.get('version')!r}; this Flexapod reads versions up to {_WITH_PAYLOAD}."
        )
    if sealed(data)["sum"] != data.get("sum"):
        raise OutputError(
            f"{place} was changed since it was written: its sum is not that of what is in it. Take another copy, or "
            "make the certificate anew."
        )
    return data


def certificate_of(data: Mapping[str, Any]) -> Certificate:
    """A certificate of plain data. Raises KeyError, TypeError, ValueError or DesignError where it is none."""
    hexapod = Hexapod.from_toml(data["design"]["toml"])
    if hexapod.digest != data["design"]["digest"]:
        raise ValueError("its design has another digest than it says")
    place, strays = _place(data["region"]), strays_of(data.get("strays", []))
    for name, known in (("claim", CLAIMS), ("status", STATUSES), ("joint", JOINT_MODELS)):
        if data[name] not in known:
            raise ValueError(f"{name} is {data[name]!r}")
    numbers: dict[str, Any] = {name: _number(data[name]) for name in _NUMBERS}
    if data["wanted"] is None:
        numbers["wanted"] = None
    return Certificate(
        hexapod=hexapod,
        place=place,
        assumed=tuple(map(str, data["assumed"])),
        strays=strays,
        payload=_payload(data.get("payload", [])),
        strayed=_strayed(data.get("strayed", []), len(strays)),
        pose=None if data["pose"] is None else np.array(data["pose"], dtype=np.float64).reshape(6),
        left=_unpacked(data["left"], place.parts.shape[1:]),
        **numbers,
        **{name: data[name] for name in _PLAIN},
    )


def _strayed(values: list[float], count: int) -> tuple[float, ...]:
    found = tuple(map(float, values))
    if len(found) not in (0, count) or not all(-1 <= value <= 1 for value in found):
        raise ValueError("the values of its strays are not from -1 to 1 each")
    return found


def _payload(values: list[float]) -> tuple[float, ...]:
    found = tuple(map(float, values))
    if len(found) not in (0, 4) or not np.isfinite(found).all() or (found and found[0] < 0):
        raise ValueError("its payload is no mass and place")
    return found


def _place(data: Mapping[str, Any]) -> Place:
    if "boxes" in data:
        boxes = np.array(data["boxes"], dtype=np.float64)
        if boxes.ndim != 3 or boxes.shape[1:] != (6, 2) or not 0 < len(boxes) <= MOST_BOXES:
            raise ValueError(f"its boxes have shape {boxes.shape}")
        if not (np.isfinite(boxes).all() and (boxes[:, :, 0] <= boxes[:, :, 1]).all()):
            raise ValueError("its boxes are reversed or not finite")
        return Boxes(boxes)
    found = (np.array(data[name], dtype=np.float64) for name in ("pieces", "middle", "spans"))
    return PathPieces(*found)


def _plain(value: float | None) -> float | str | None:
    """A number as JSON has it; those that are not finite as words."""
    return value if value is None or math.isfinite(value) else str(float(value))


def _number(value: float | str | None) -> float:
    return float("nan") if value is None else float(value)


def _packed(parts: Array) -> dict[str, Any]:
    """Many numbers, without loss and short."""
    content = np.ascontiguousarray(parts, dtype="<f8")
    return {"count": len(content), "float64": b64encode(content.tobytes()).decode()}


def _unpacked(data: Mapping[str, Any], shape: tuple[int, ...]) -> Array:
    found = np.frombuffer(b64decode(data["float64"], validate=True), dtype="<f8").astype(np.float64)
    return found.reshape(int(data["count"]), *shape)


def _none(path: Path, why: str) -> OutputError:
    return OutputError(f"{path} is no certificate of Flexapod: {why}. Give a file that `flexapod certify` wrote.")
