"""The packaged machines without what makes them machines as built: joints turn freely, each leg is one constant spring.

For tests of mechanics whose numbers come from such machines. They have the packaged names, geometry and masses.
"""

from pathlib import Path

import flexapod as fx

FOLDER = Path(__file__).parents[1] / "data" / "machines"


def file(name: str) -> str:
    """The path of a machine's design file."""
    return str(FOLDER / f"{name}.toml")


def plain_machine(name: str) -> fx.Hexapod:
    """The machine; those that the package has without such springs are the packaged ones."""
    return fx.load(file(name) if Path(file(name)).exists() else name)
