"""At which frequency a leg bends: what the model of axial springs leaves out, beside the frequencies that it gives."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import single_pose
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.mechanics.plausibility import Caution
from flexapod.mechanics.symmetric_pencil import pencil_squares
from flexapod.pose import PoseLike
from flexapod.showing import in_notebooks

ELEMENTS = 24  # along a leg, which gives its first frequency to 1e-5
NEAR = 2.0  # times the highest frequency: a leg that bends below this moves with the modes that the model gives


@in_notebooks
class LegBending(NamedTuple):
    """The first bending frequencies of the legs, as `leg_bending` gives them.

    Attributes
    ----------
    omega : ndarray
        Natural frequency, rad/s, (6,); NaN where it is not known.
    unknown : str
        Why a frequency is not known, in words; empty where all are known.
    """

    omega: Array
    unknown: str

    @property
    def lowest(self) -> float:
        """The lowest of the frequencies that are known, rad/s; NaN where none is."""
        return float(np.fmin.reduce(self.omega))


class _Rod(NamedTuple):
    """The numbers of a rod of each leg, (6,): length m, mass kg, bending stiffness N m2."""

    length: Array
    mass: Array
    bending: Array


def leg_bending(hexapod: Hexapod, pose: PoseLike | None = None) -> LegBending:
    """Compute the first bending frequency of each leg by itself: a beam of its two rods, pinned at its joints.

    Parameters
    ----------
    hexapod : Hexapod
        The machine. Both parts of its legs must be given as rods (`legs.lower.rod`, `legs.upper.rod`) with a
        `bending_stiffness`, which is Young's modulus times the second moment of area.
    pose : Pose or array_like, optional
        Pose of the platform, one: a Pose, or x, y, z in m and roll, pitch, yaw in rad. Left out, the home pose.

    Returns
    -------
    LegBending
        `omega`, rad/s, and why some of it is not known.

    Raises
    ------
    PoseError
        For a batch of poses, or at a pose that no leg can take.

    See Also
    --------
    flexapod.natural_modes : The frequencies of the platform on legs that do not bend.

    Notes
    -----
    Beams after Euler and Bernoulli, without axial load, by finite elements with cubic deflections (O. C. Zienkiewicz
    and R. L. Taylor, The Finite Element Method). Where the rods overlap, as a piston rod and its cylinder do, their
    masses and bending stiffnesses add up. The platform and the bending stiffness of the joints play no part.

    Examples
    --------
    >>> bends = fx.mechanics.leg_bending(fx.load("motion-base"))
    >>> round(bends.lowest)
    223
    """
    lengths = inverse_kinematics(hexapod, single_pose(hexapod, pose))
    lower, upper = _rod(hexapod, "lower"), _rod(hexapod, "upper")
    omega, unknown = np.full(6, np.nan), ""
    if isinstance(lower, str):
        return LegBending(omega, lower)
    if isinstance(upper, str):
        return LegBending(omega, upper)
    for leg, length in enumerate(lengths):
        misfit = _misfit(leg, length, lower.length[leg], upper.length[leg])
        unknown = unknown or misfit
        if not misfit:
            omega[leg] = _first_frequency(length, *(_Rod(*(x[leg] for x in rod)) for rod in (lower, upper)))
    return LegBending(omega, unknown)


def bending_caution(bends: LegBending, highest: float) -> list[Caution]:
    """Whether legs bend within the frequencies that the model gives, or soon above; highest: of these, rad/s."""
    if not bends.lowest < NEAR * highest:
        return []
    leg = int(np.nanargmin(bends.omega)) + 1
    text = (
        f"Leg {leg} bends at {bends.lowest:.4g} rad/s by itself, and mode 6 is at {highest:.4g} rad/s: near and above "
        "the bending of the legs the platform moves otherwise than computed, for legs are taken not to bend. Make the "
        "legs stiffer against bending, or rely on the modes well below."
    )
    return [Caution("leg_bends", text, {"leg": leg, "omega": bends.lowest, "highest": highest})]


def _rod(hexapod: Hexapod, part: str) -> _Rod | str:
    """The rod of a part of the legs, or why it is not known as a beam."""
    table = f"legs.{part}.rod"
    form = next((form for form in hexapod.short_forms if form.table == table), None)
    if form is None:
        return f"the design gives no [{table}]"
    if "bending_stiffness" not in form.given:
        return f"the design gives no {table}.bending_stiffness"
    return _Rod(*(np.broadcast_to(form.given[key], 6) for key in ("length", "mass", "bending_stiffness")))


def _misfit(leg: int, length: float, lower: float, upper: float) -> str:
    """Why a leg of this length is no beam of its rods; "" where it is one."""
    if max(lower, upper) > length * (1 + 1e-12):
        return f"a rod of leg {leg + 1} is {max(lower, upper):.6g} m long, and the leg {length:.6g} m"
    if lower + upper < length * (1 - 1e-12):
        return f"the rods of leg {leg + 1} are {lower + upper:.6g} m long together, and the leg {length:.6g} m"
    return ""


def _first_frequency(length: float, lower: _Rod, upper: _Rod) -> float:
    """First frequency of a pinned beam, rad/s; the lower rod begins at 0, the upper one at the other end."""
    steps = np.unique(np.clip([0.0, length - float(upper.length), float(lower.length), length], 0.0, length))
    steps = steps[np.append(True, np.diff(steps) > 1e-9 * length)]
    steps[-1] = length
    parts = [np.linspace(a, b, int(np.ceil(ELEMENTS * (b - a) / length)), endpoint=False) for a, b in pairwise(steps)]
    nodes = np.append(np.concatenate(parts), length)
    M, K = np.zeros((2, 2 * nodes.size, 2 * nodes.size))
    for i, (a, b) in enumerate(pairwise(nodes)):
        middle, place = (a + b) / 2, np.s_[2 * i : 2 * i + 4, 2 * i : 2 * i + 4]
        here = [
            rod for rod, inside in ((lower, middle < lower.length), (upper, middle > length - upper.length)) if inside
        ]
        M[place] += sum(float(rod.mass / rod.length) for rod in here) * _mass(b - a)
        K[place] += sum(float(rod.bending) for rod in here) * _stiffness(b - a)
    free = np.delete(np.arange(2 * nodes.size), [0, 2 * nodes.size - 2])  # the ends do not move, but turn
    inverse = pencil_squares(M[np.ix_(free, free)], K[np.ix_(free, free)])
    return float(1 / np.sqrt(inverse[-1]))  # the greatest 1 / omega^2 keeps digits that the least omega^2 would not


def _mass(h: float) -> Array:
    """Of an element with unit mass for each length, in deflection and slope at both ends."""
    rows = [
        [156, 22 * h, 54, -13 * h],
        [22 * h, 4 * h**2, 13 * h, -3 * h**2],
        [54, 13 * h, 156, -22 * h],
        [-13 * h, -3 * h**2, -22 * h, 4 * h**2],
    ]
    return np.array(rows) * h / 420


def _stiffness(h: float) -> Array:
    """Of an element with unit bending stiffness."""
    rows = [
        [12, 6 * h, -12, 6 * h],
        [6 * h, 4 * h**2, -6 * h, 2 * h**2],
        [-12, -6 * h, 12, -6 * h],
        [6 * h, 2 * h**2, -6 * h, 4 * h**2],
    ]
    return np.array(rows) / h**3
