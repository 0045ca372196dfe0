"""A certificate that lies where another is to be written: it stays, unless the new one proves all that it does."""

from __future__ import annotations

from pathlib import Path

from flexapod.certificates.certificate import Certificate
from flexapod.certificates.file import data_of, read_certificate
from flexapod.errors import OutputError
from flexapod.mechanics.cautions import Caution

#: What makes two certificates answers to one question.
_QUESTION = ("claim", "joint", "within_limits", "nominal", "assumed", "strays", "strayed", "payload", "region")


class Earlier:
    """The proof in a file that is about to be written anew: put aside for the run, and put back if that fails."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._aside: Path | None = None
        self._found: Certificate | None = None

    def __enter__(self) -> Earlier:
        if self._path is None or not self._path.exists():
            return self
        try:
            found = read_certificate(self._path)
        except OutputError:  # no certificate: nothing is lost
            return self
        if found.status == "proved":
            self._found, self._aside = found, _free(self._path)
            self._path.rename(self._aside)
        return self

    def beside(self, new: Certificate) -> list[Caution]:
        """What to say of the earlier proof beside a new certificate; one that the new one covers is dropped."""
        if self._found is None or self._aside is None:
            return []
        if _covers(new, self._found):
            self._aside.unlink()
            return []
        text = f"The earlier proof is kept as {self._aside}, for this certificate does not prove all that it does."
        return [Caution("earlier", text)]

    def __exit__(self, *_: object) -> None:
        if self._path is not None and self._aside is not None and not self._path.exists() and self._aside.exists():
            self._aside.rename(self._path)


def _free(path: Path) -> Path:
    """A name for the earlier file that no file has."""
    names = (path.with_name(f"{path.stem}-earlier{number}{path.suffix}") for number in ("", *range(2, 1000)))
    return next(name for name in names if not name.exists())


def _covers(new: Certificate, earlier: Certificate) -> bool:
    """Whether one certificate proves what the earlier one does, of the same region."""
    ours, theirs = data_of(new), data_of(earlier)
    if new.status != "proved" or any(ours.get(name) != theirs.get(name) for name in _QUESTION):
        return False
    if new.claim == "condition":
        return new.upper <= earlier.upper
    return new.claim != "index" or new.lower >= earlier.lower
