"""Runs the code blocks of a Markdown document, in order, in one folder, as a reader would.

What a block is, its language says:

- `python` is run, all in one namespace; a block `text` with the title "output" after it is what it must print.
- `sh`, and a block without a language: the lines that begin with `flexapod` are run and must succeed.
- `console`: a line `$ flexapod ...` is run, and the lines after it are what it must print. Lines may be broken
  elsewhere, and `...` stands for anything.
- `toml` and `csv` with a title are files of that name.

A comment before a block changes that:

- `<!-- test: append to FILE -->` adds the block to a file, `<!-- test: instead of TEXT in FILE -->` puts it in the
  place of that text there.
- `<!-- test: 1000000 as 1000, 20 as 5 -->` runs the block with other numbers than it shows.
- `<!-- test: skip, REASON -->` leaves it out.
"""

import contextlib
import io
import re
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

FENCE = re.compile(
    r"(?:^<!-- test: (?P<how>.*?) -->\n+)?"
    r"^(?P<indent> *)```(?P<language>\w*)(?: +title=\"(?P<title>[^\"]*)\")?.*\n(?P<text>(?:.*\n)*?)(?P=indent)```$",
    re.MULTILINE,
)

#: Commands that take too long here, and where they are tested.
ELSEWHERE = {"serve": "tests/web", "paper": "tests of `flexapod paper`"}

#: Runs a command line: exit code, standard output, standard error.
Run = Callable[..., tuple[int, str, str]]


class Block(NamedTuple):
    language: str
    title: str
    text: str
    how: str
    line: int  # where the block's first line is in the document, from 1


def blocks(document: str) -> list[Block]:
    """The fenced code blocks of a Markdown text, in order."""
    found = []
    for match in FENCE.finditer(document):
        indent = match["indent"]
        text = "".join(line.removeprefix(indent) for line in match["text"].splitlines(keepends=True))
        line = document.count("\n", 0, match.start("text")) + 1
        found.append(Block(match["language"], match["title"] or "", text, match["how"] or "", line))
    return found


def run_document(path: Path, folder: Path, run: Run) -> int:
    """Run a document's blocks in a folder, which must be the current one; how many were run."""
    namespace: dict[str, object] = {"__name__": "__main__"}
    printed, count = "", 0
    for block in blocks(path.read_text(encoding="utf-8")):
        if block.how.startswith("skip"):
            continue
        where = f"{path.name}, line {block.line}"
        text = _smaller(block)
        match block.language:
            case "python":
                printed = _python(text, namespace, where)
            case "text" if block.title == "output":
                assert matches(block.text, printed), f"{where}: printed\n{printed}"
            case "toml" | "csv" if block.title:
                _write(block, folder)
            case "console":
                _console(text, run, where)
            case "sh" | "":
                _commands(text, run, where)
            case _:
                continue
        count += 1
    return count


def _write(block: Block, folder: Path) -> None:
    if block.how.startswith("append to "):
        file = folder / block.how.removeprefix("append to ")
        file.write_text(file.read_text() + block.text)
    elif block.how.startswith("instead of "):
        old, name = block.how.removeprefix("instead of ").rsplit(" in ", 1)
        before = (folder / name).read_text()
        assert before.count(old) == 1, f"line {block.line}: {name} does not have {old!r} once"
        (folder / name).write_text(before.replace(old, block.text.rstrip("\n")))
    else:
        (folder / block.title).write_text(block.text)


def _smaller(block: Block) -> str:
    text = block.text
    for change in block.how.split(", ") if " as " in block.how else ():
        shown, used = change.split(" as ")
        assert shown in text, f"line {block.line}: the block does not have {shown!r}"
        text = text.replace(shown, used)
    return text


def _python(text: str, namespace: dict[str, object], where: str) -> str:
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(compile(text, where, "exec"), namespace)
    return printed.getvalue()


def _commands(text: str, run: Run, where: str) -> None:
    """Lines that begin with `flexapod`."""
    for line in text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words[:1] == ["flexapod"] and words[1] not in ELSEWHERE:
            code, _, err = run(*words[1:])
            assert code == 0, f"{where}: {line}\n{err}"


def _console(text: str, run: Run, where: str) -> None:
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        line, _, expected = part.replace("\\\n", " ").partition("\n")
        words = shlex.split(line, comments=True)
        assert words[0] == "flexapod", f"{where}: {line}"
        code, out, err = run(*words[1:])
        wrong = any(each.startswith("Error: ") for each in expected.splitlines())
        assert code == (2 if wrong else 0), f"{where}: {line}\n{err}"
        assert matches(expected, err if wrong else out), f"{where}: {line}\n{out}{err}"


def matches(expected: str, printed: str) -> bool:
    """Whether a text is what was expected, however its lines are broken; `...` stands for anything."""
    words = [".*" if word == "..." else re.escape(word) for word in expected.split()]
    return re.fullmatch(" ".join(words).replace(" .* ", " (?:.* )?"), " ".join(printed.split())) is not None
