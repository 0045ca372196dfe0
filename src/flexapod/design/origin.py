"""What every result says of where it comes from."""

from __future__ import annotations

from flexapod.design.hexapod import Hexapod


def origin(*hexapods: Hexapod) -> dict[str, str]:
    """Attributes of a result: designs, the digests of all their numbers, and the version that computed it."""
    from flexapod import __version__

    machines = {hexapod.digest: hexapod.name for hexapod in hexapods}
    return {
        "design": ", ".join(sorted(set(machines.values()))),
        "digest": ", ".join(machines),
        "source": f"flexapod {__version__}",
    }
