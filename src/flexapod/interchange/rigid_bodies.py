"""Rigid bodies as other tools demand them: with mass, and with an inertia that some body of that mass has."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.inertia import inertia_flaw, second_moments
from flexapod.errors import DesignError
from flexapod.mechanics.inputs import as_hexapod

LEAST_MASS = 1e-4  # of the platform's mass, in place of none
LEAST_SPREAD = 1e-6  # of the largest second moment; of mass times the machine's width squared for a mass at a point


def nearest_physical(hexapod: Hexapod) -> Hexapod:
    """Replace bodies that cannot exist by the nearest solid ones.

    Rigid-body programs refuse bodies without mass and inertias that no solid body has. The natural frequencies of the
    changed design differ somewhat: compare them.

    Parameters
    ----------
    hexapod : Hexapod
        The design.

    Returns
    -------
    Hexapod
        The changed design, or `hexapod` itself if all its bodies can exist.

    Raises
    ------
    DesignError
        If `hexapod` is not a Hexapod.

    Notes
    -----
    The second moments of mass of a body are the matrix trace(I)/2 E - I, in kg m2, which is positive definite for solid
    bodies. Where it is not, its eigenvalues are raised to a millionth of the largest (a sheet gets a thickness of a
    thousandth of its width, a thin rod a radius): the smallest change, in the sum of squares, that gives such moments.
    Parts of legs without mass get a ten-thousandth of the platform's mass, and a mass at a point the moments of a ball
    with a radius of gyration of a thousandth of the machine's width. So machines of all sizes change alike.

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-ii")
    >>> solid = fx.interchange.nearest_physical(hexapod)
    >>> round(float(fx.natural_modes(solid, fx.home_pose(solid)).omega[0] / fx.natural_modes(
    ...     hexapod, fx.home_pose(hexapod)).omega[0]), 3)
    1.0
    """
    as_hexapod(hexapod)
    changes: dict[str, Any] = {}
    reach = float(np.ptp(np.concatenate([hexapod.base_joints, hexapod.platform_joints]), axis=0).max())
    if inertia_flaw(hexapod.platform_inertia, solid=True):
        changes["platform.inertia"] = _mended(hexapod.platform_mass, hexapod.platform_inertia, reach)
    for name in ("lower", "upper"):
        part = getattr(hexapod.legs, name)
        mass = np.where(part.mass > 0, part.mass, LEAST_MASS * hexapod.platform_mass)
        inertia = np.array(
            [
                _mended(m, given, reach) if inertia_flaw(given, solid=True) else given
                for m, given in zip(mass, part.inertia, strict=True)
            ]
        )
        if (mass != part.mass).any():
            changes[f"legs.{name}.mass"] = mass
        if (inertia != part.inertia).any():
            changes[f"legs.{name}.inertia"] = inertia
    return hexapod.replace(changes) if changes else hexapod


def check_physical(hexapod: Hexapod) -> None:
    """Raises DesignError, with the remedies, for the first body that a rigid-body program refuses."""
    bodies = [("platform", "", hexapod.platform_mass, hexapod.platform_inertia)]
    for name in ("lower", "upper"):
        part = getattr(hexapod.legs, name)
        bodies += [(f"legs.{name}", f" of leg {i + 1}", part.mass[i], part.inertia[i]) for i in range(6)]
    for key, leg, mass, inertia in bodies:
        flaw = "its mass is 0" if mass == 0 else inertia_flaw(inertia, solid=True)
        if flaw:
            raise DesignError(
                f"{key}{leg} is a body that rigid-body programs refuse: {flaw}. Give {key} a mass and an inertia that "
                "a solid body has, or take the nearest such body: flexapod.interchange.nearest_physical(hexapod), "
                "on the command line --nearest-physical. It changes the natural frequencies somewhat."
            )


def _mended(mass: float, inertia: Array, reach: float) -> Array:
    moments, axes = np.linalg.eigh(second_moments(inertia))
    ball = LEAST_SPREAD * mass * reach**2
    least = LEAST_SPREAD * moments[2] if moments[2] > ball else ball
    spread = (axes * np.maximum(moments, least)) @ axes.T
    spread = (spread + spread.T) / 2
    return np.asarray(np.trace(spread) * np.eye(3) - spread)
