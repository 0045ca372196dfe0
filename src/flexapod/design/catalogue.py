"""What the packaged designs are, from the comment at the head of each file: a paragraph, then lines `# Key: text`."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from itertools import takewhile
from typing import NamedTuple

from flexapod.design.design_file import find, packaged_designs
from flexapod.design.hexapod import Hexapod
from flexapod.design.loading import load


class Description(NamedTuple):
    """What a file says of its machine; empty where it says nothing of the kind.

    about: what it is. kind: of machine. by: its maker or author. year: of the source. source: where its numbers are
    from. published: a number of the source that tests find again. assumed: what the source does not give, and on what
    ground.
    """

    about: str
    kind: str = ""
    by: str = ""
    year: str = ""
    source: str = ""
    published: str = ""
    assumed: str = ""


_MORE = "  "  # before the further lines of a text


def description(text: str) -> Description:
    """What the text of a design file says of its machine."""
    comment = [line.removeprefix("#").removeprefix(" ") for line in takewhile(_is_comment, text.splitlines())]
    about = list(takewhile(bool, comment))
    found: dict[str, str] = {}
    key = ""
    for line in comment[len(about) :]:
        name, colon, words = line.partition(": ")
        if key and line.startswith(_MORE):
            found[key] += f" {line.strip()}"
        elif colon and name.lower() in Description._fields[1:]:
            key = name.lower()
            found[key] = words
        else:
            key = ""
    return Description(" ".join(about), **found)


def catalogue(words: Iterable[str] = ()) -> dict[str, Description]:
    """The packaged designs whose names or descriptions have all of some words, in any case."""
    found = {}
    for name in packaged_designs():
        one = description(find(name).read_text(encoding="utf-8"))
        text = " ".join((name, *one)).lower()
        if all(word.lower() in text for word in words):
            found[name] = one
    return found


def assumed_of(hexapod: Hexapod) -> str:
    """What a packaged design, or one that was made of it and has its name, assumes, as a sentence; "" for others."""
    return _assumed(hexapod.name, hexapod.digest)


@lru_cache(maxsize=64)
def _assumed(name: str, digest: str) -> str:
    if name not in packaged_designs():
        return ""
    assumed = description(find(name).read_text(encoding="utf-8")).assumed
    if not assumed:
        return ""
    which = "" if load(name).digest == digest else ", from which this design differs"
    return f"Assumed in the packaged design {name}{which}, for want of data: {assumed}"


def _is_comment(line: str) -> bool:
    return line.startswith("#")
