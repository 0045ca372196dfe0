"""Errors that are not Flexapod's own but that bad input, a small machine or a full disk bring about, in sentences."""

from __future__ import annotations

#: Name of an error's class, or of one that it is derived from -> what it means. By name, so that nothing is imported.
_MEANINGS = {
    "MemoryError": "there is not enough memory for this. Ask for fewer points, samples or poses, or a shorter duration",
    "RecursionError": "the input is nested too deeply. Write it flatter",
    "OverflowError": "a number is too large to compute with. Give a smaller one",
    "FloatingPointError": "a number is too large or too small to compute with. Give another one",
    "ZeroDivisionError": "a number is too small to compute with. Give a larger one",
    "LinAlgError": "the equations are singular to rounding here. Choose another pose, other gains or other weights",
    "SlycotError": "the equations of the controller cannot be solved. Change its measurements, effort or noise",
    "SlycotWarning": "the equations of the controller are badly conditioned. Change its measurements, effort or noise",
    "EOFError": "a file ends before it is complete. Write it again",
    "Error": "a file is no CSV file. Export the table as CSV",
    "UnicodeError": "a text is not in the encoding that it should be in. Write it in UTF-8",
    "Warning": "what was computed cannot be relied on. Change the input",
}


def sentence(error: Exception) -> str | None:
    """What an error means and what to do; None for one that nothing but a fault of Flexapod explains."""
    if isinstance(error, OSError):
        return _of_the_system(error)
    detail = " ".join(str(error).split())[:200]
    if isinstance(error, ImportError) and "FLEXAPOD_SIMD" in detail:
        return detail
    for kind in type(error).__mro__:
        if kind.__name__ in _MEANINGS and (kind.__name__ != "Error" or kind.__module__ == "_csv"):
            return f"{_MEANINGS[kind.__name__]} ({type(error).__name__}{f': {detail}' if detail else ''})."
    return None


def _of_the_system(error: OSError) -> str:
    words = error.strerror or str(error) or type(error).__name__
    if error.filename is None:
        return f"a file or stream cannot be read or written: {words}."
    return f"{error.filename}: {words}. Check the name, its permissions and the space on its disk."
