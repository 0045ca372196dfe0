"""Encoding of answers: JSON in which NaN and infinity become null, and frames of JSON followed by binary numbers."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from starlette.responses import Response

from flexapod.web.answers import JobMessage
from flexapod.web.plain import plain


class JSONAnswer(Response):
    """JSON of nested dicts, lists and NumPy arrays."""

    media_type = "application/json"

    def render(self, content: Any) -> bytes:
        return as_json(content)


def as_json(content: Any) -> bytes:
    """JSON text with null for NaN and infinity."""
    return json.dumps(plain(content), allow_nan=False, separators=(",", ":")).encode()


def frame(message: JobMessage, data: bytes = b"") -> bytes:
    """One message of a stream: two little-endian 32-bit lengths, JSON, bytes."""
    head = as_json(message)
    return struct.pack("<II", len(head), len(data)) + head + data


def float32(array: np.ndarray) -> bytes:
    """The numbers of an array in the order of its memory (last axis fastest), as little-endian float32.

    Those that it has no number for, beyond 3.4e38, are infinite.
    """
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, dtype="<f4").tobytes()
