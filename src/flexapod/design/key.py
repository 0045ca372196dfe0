"""The rule of a key of a design file: what its value means, its unit, its shapes and its range."""

from dataclasses import dataclass

ANY = -1  #: a length that is not fixed
SHAPES = {
    (): "one number",
    (2,): "two numbers [min, max]",
    (ANY,): "some numbers",
    (3,): "three numbers [x, y, z]",
    (6,): "six numbers, one for each leg",
    (3, 3): "three rows of three numbers",
    (6, 2): "six pairs [min, max]",
    (6, ANY): "six rows of as many numbers each",
    (6, 3): "six rows [x, y, z]",
    (6, 6): "six rows of six numbers",
    (6, 3, 3): "six matrices of three rows of three numbers",
}


@dataclass(frozen=True)
class Key:
    """What a value must be. `least` and `most` are in SI units; `open_` leaves `least` itself out.

    `default` (SI) is what a design has that leaves the key out, where that is said here and not in tables.py. A new
    number of each leg needs its line in the core (`model/design.hpp`) and one here with a default.

    A value that must be `symmetric` may also be given as the numbers on its diagonal. `pair` is what two numbers are.
    """

    meaning: str
    dimension: str | None
    shapes: tuple[tuple[int, ...], ...]
    remedy: str = "Write the number in SI units or put another unit in the key's name."
    too_large: str = ""  # the remedy for infinity and numbers near it, where it is another
    least: float | None = None
    most: float | None = None
    open_: bool = False
    symmetric: bool = False
    default: float | None = None
    pair: str = "[min, max]"

    @property
    def shape_text(self) -> str:
        moments = ", or the three principal moments" if self.dimension == "inertia" else ", or those on the diagonal"
        words = " or ".join(SHAPES[shape].replace("[min, max]", self.pair) for shape in self.shapes)
        return words + (moments if self.symmetric else "")

    def takes(self, shape: tuple[int, ...]) -> bool:
        """Whether a value may have this shape."""
        return shape in self.shapes or any(
            len(known) == len(shape) and all(n in (ANY, m) and m for n, m in zip(known, shape, strict=True))
            for known in self.shapes
        )
