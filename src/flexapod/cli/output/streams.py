"""Standard output and error: encodings that lack some signs, as pipes of Windows have, and streams that are full."""

from __future__ import annotations

import codecs
import os
import sys
from typing import Any
from unicodedata import normalize

_PLAIN = {
    "ω": "w",
    "≥": ">=",
    "≤": "<=",
    "°": " deg",
    "±": "+-",
    "²": "2",
    "³": "3",
    "µ": "u",
    "μ": "u",
    "·": "*",
    "×": "x",
    "…": "...",
    "–": "-",
    "−": "-",
    "π": "pi",
    "≠": "!=",
    "∞": "inf",
    "✓": "ok",
    "“": '"',
    "”": '"',
    "’": "'",
    **{chr(0x2080 + digit): str(digit) for digit in range(10)},  # as subscripts
}


def _plainly(error: UnicodeError) -> tuple[str, int]:
    """Signs that an encoding lacks in those that every encoding has."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(_PLAIN.get(sign) or _bare(sign) for sign in error.object[error.start : error.end]), error.end


def _bare(sign: str) -> str:
    """A letter without its accents, "?" for what is none."""
    return normalize("NFKD", sign).encode("ascii", "ignore").decode() or "?"


codecs.register_error("flexapod.plainly", _plainly)


def speak_plainly() -> None:
    """Have standard output and error write what their encoding lacks in plain signs, rather than fail."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="flexapod.plainly")


def give_up(stream: Any) -> None:
    """Point a stream that cannot be written to nowhere, so that the interpreter does not fail on it at its end."""
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
    except (OSError, ValueError, AttributeError):  # a stream that is no file
        pass
