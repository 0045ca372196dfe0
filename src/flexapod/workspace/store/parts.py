"""Parts of a store, each computed by a run of its own: which blocks are whose, and how the runs keep apart."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

from flexapod.checks import whole
from flexapod.errors import ArgumentError, OutputError
from flexapod.workspace.store.one_writer import locked

_MARKS = "status"  # what is locked while a run says which blocks are done: an array that every store has
_FOLDER = f"{_MARKS}/.parts"  # of a store that is not complete: a file to lock for each part that was begun

PATIENCE = 120.0  # s that a run waits for others to say what they have done


class Part(NamedTuple):
    """Part `number` (from 1) of the `of` parts of a store: a run of its blocks, as long as those of the others."""

    number: int
    of: int

    @classmethod
    def checked(cls, number: object, of: object) -> Part:
        """Raises ArgumentError for numbers of no part."""
        part = cls(whole(number, "part"), whole(of, "of"))
        if part.number > part.of:
            raise ArgumentError(f"part is {part.number} of {part.of}; parts are counted from 1 to their number.")
        return part

    def blocks(self, count: int) -> range:
        """Its blocks, of so many. Raises ArgumentError where there are fewer blocks than parts."""
        if count < self.of:
            raise ArgumentError(
                f"the store has {count} block{'s' * (count > 1)}, fewer than its {self.of} parts. Give a smaller chunk "
                "(--chunk), or fewer parts."
            )
        return range(count * (self.number - 1) // self.of, count * self.number // self.of)

    @contextmanager
    def writing(self, path: str) -> Iterator[None]:
        """This part is written by one run at a time, beside other parts of as many; none beside a run of the whole."""
        file = Path(path, _FOLDER, f"{self.number}-of-{self.of}")
        with ExitStack() as held:
            held.enter_context(locked(path, shared=True))
            with marking(path):
                file.parent.mkdir(exist_ok=True)
                self._refuse_others(file.parent)
                file.touch()
                held.enter_context(locked(str(file)))
            yield

    def _refuse_others(self, folder: Path) -> None:
        """Raises OutputError where a part of another number of parts is being written: their blocks are not apart."""
        for file in folder.iterdir():
            if not file.name.endswith(f"-of-{self.of}"):
                try:
                    with locked(str(file)):
                        file.unlink(missing_ok=True)
                except OutputError:
                    number, _, of = file.name.partition("-of-")
                    raise OutputError(
                        f"part {number} of {of} of {folder.parents[1]} is being written, and this is one of {self.of} "
                        "parts. Wait for it, or give as many parts."
                    ) from None


@contextmanager
def marking(path: str) -> Iterator[None]:
    """One run at a time says which blocks are done; others wait for it."""
    with locked(os.path.join(path, _MARKS), patience=PATIENCE):
        yield


def forget_parts(path: str) -> None:
    """Take away what parts of a store were told apart by."""
    shutil.rmtree(Path(path, _FOLDER), ignore_errors=True)
