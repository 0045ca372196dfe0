"""Feeds mutated design files to the reader. What comes back is a design or a DesignError; anything else is a crash.

    python tests/fuzz/designs.py CORPUS [libFuzzer's options]

CORPUS is a directory; the packaged designs are put into it, and what the search finds is kept there for the next run.
The search learns from the code's own branches, so `flexapod` must be found in the sources (see `make fuzz`): what an
editable install's finder loads it cannot follow.
"""

import random
import re
import sys
import warnings
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["flexapod"]):
    from flexapod.design import design_file, hexapod, schema, shorthands, units  # noqa: F401

NUMBER = re.compile(rb"[-+]?\d[\d_.eE+-]*")
VALUES = [b"0", b"-1", b"1", b"-0.0", b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e101", b"1e99", b"1e-320"]
VALUES += [b"9" * 400, b"0x" + b"f" * 40, b"true", b'"text"', b'""', b"[]", b"[[]]", b"[1, [2]]", b"{}", b"{a = 1}"]
VALUES += [b"1979-05-27", b"07:32:00", b"[0, 0, 0]", b"[1, 2, 3, 4, 5, 6]", b'"\\u0000\\U0001F916"', b"'''a\nb'''"]
SPRINGS = (
    "stiffness = 2e7\nseries_stiffness = [94e6, 94e6]\nloss_factor = 0.02\n"
    "joint_stiffness = {universal = [15.0, 20.0], spherical = 15.0, torsion = 10.0}\n"
    "joint_rest = {position = [0.0, 0.0, 0.5]}",
    'stiffness_law = {kind = "table", lengths = [0.4, 0.6, 0.8], stiffnesses = [3e7, 2e7, 1e7]}',
    'stiffness_law = {kind = "screw", fixed = 8e7, axial_rigidity = 4e7, zero_length = 0.4}',
)
SCRATCH = Path("scratch.toml")


def check(data: bytes) -> None:
    """One file: read, and if it is a design, written and read again."""
    SCRATCH.write_bytes(data)
    try:
        design = hexapod.load(SCRATCH)
    except hexapod.DesignError as error:
        if not str(error).rstrip().endswith((".", "?")):
            raise AssertionError(f"a message that stops half way: {error}") from error
        return
    if hexapod.Hexapod.from_toml(design.to_toml()) != design:
        raise AssertionError("a design that is written is not the one that is read back")
    repr(design)


def mutate(data: bytes, max_size: int, seed: int) -> bytes:
    """Now and then bytes change as the search likes; else lines and numbers, so that most files stay TOML."""
    rng = random.Random(seed)
    if rng.random() < 0.25:
        return atheris.Mutate(data, max_size)
    lines = data.split(b"\n")
    for _ in range(rng.randint(1, 3)):
        place = rng.randrange(len(lines))
        change = rng.randrange(5)
        if change == 0:
            del lines[place : place + rng.randint(1, 3)]
            lines = lines or [b""]
        elif change == 1:
            lines.insert(rng.randrange(len(lines) + 1), lines[place])
        elif change == 2:
            lines[place] = NUMBER.sub(lambda _: rng.choice(VALUES), lines[place], count=rng.randint(1, 3))
        elif change == 3:
            lines[place] = lines[place].split(b"=")[0] + b"= " + rng.choice(VALUES)
        else:
            lines.insert(place, key_for(lines[:place], rng) + b" = " + rng.choice(VALUES))
    return b"\n".join(lines)[:max_size]


def key_for(above: list[bytes], rng: random.Random) -> bytes:
    """A key of the table that these lines end in, with a unit or without; now and then one of another table."""
    headers = [line.strip()[1:-1].decode(errors="replace") for line in above if line.startswith(b"[")]
    here = schema.children(headers[-1] if headers else "")
    if not here or rng.random() < 0.1:
        return rng.choice(KEYS)
    unit = rng.choice(["", "", *sorted(units.ALL_UNITS)])
    return (rng.choice(here) + (f"_{unit}" if unit else "")).encode()


def keys() -> list[bytes]:
    """Keys as they may stand in a file, with and without units, and headers of tables."""
    names = [key.rsplit(".", 1)[-1] for key in (*schema.KEYS, *schema.TEXT_KEYS)]
    with_units = [f"{name}_{unit}" for name in set(names) for unit in units.ALL_UNITS]
    return [key.encode() for key in sorted({*names, *with_units, *schema.KEYS})]


KEYS = keys()


def main() -> None:
    corpus, *options = sys.argv[1:]
    Path(corpus).mkdir(parents=True, exist_ok=True)
    for name in hexapod.packaged_designs():
        (Path(corpus) / name).write_bytes(design_file.find(name).read_bytes())
    template = hexapod.template("fuzz")
    (Path(corpus) / "template").write_text(template, encoding="utf-8")
    for number, springs in enumerate(SPRINGS):
        (Path(corpus) / f"springs{number}").write_text(template.replace("stiffness_N_per_um = 20.0", springs, 1))
    words = [*KEYS, *(f"[{table}]".encode() for table in sorted(schema.TABLES)), *VALUES[:12]]
    dictionary = Path("keys.dict")
    dictionary.write_text("".join(f'"{word.decode()}"\n' for word in words))
    warnings.simplefilter("error")  # a warning of NumPy's is no answer to a user either
    arguments = [sys.argv[0], corpus, f"-dict={dictionary}", "-max_len=8192", "-timeout=10", *options]
    atheris.Setup(arguments, check, custom_mutator=mutate)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
