"""Inputs that people have, in tests/data/cases."""

from pathlib import Path

CASES = Path(__file__).parents[1] / "data" / "cases"


def case(folder: str, name: str) -> Path:
    """A file of the cases."""
    return CASES / folder / name
