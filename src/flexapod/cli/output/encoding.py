"""Words on streams whose encoding lacks some of their signs, such as pipes of Windows."""

from __future__ import annotations

import codecs
import sys

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
}


def _plainly(error: UnicodeError) -> tuple[str, int]:
    """Signs that an encoding lacks in those that every encoding has."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(_PLAIN.get(sign, "?") for sign in error.object[error.start : error.end]), error.end


codecs.register_error("flexapod.plainly", _plainly)


def speak_plainly() -> None:
    """Have standard output and error write what their encoding lacks in plain signs, rather than fail."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="flexapod.plainly")
