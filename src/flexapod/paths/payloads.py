"""The loads of a path with each of several payloads on the platform."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.checks import instance, not_negative, numbers
from flexapod.conventions import Array, JointModel, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.inertia import ROUNDING, inertia_flaw
from flexapod.design.origin import origin
from flexapod.design.payload import with_payload
from flexapod.errors import ArgumentError, shown
from flexapod.mechanics.inputs import ZERO, PointLike, point_attributes
from flexapod.paths.analysis import check_arguments, path_index
from flexapod.paths.loads import path_loads
from flexapod.paths.trajectory import Trajectory
from flexapod.showing import in_notebooks

_MOST_CASES = 1000
_NO_INERTIA = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@in_notebooks
@dataclass(frozen=True, eq=False)
class PayloadCase:
    """A load that the platform carries along a path, beside what the design's platform weighs.

    Parameters
    ----------
    name : str
        What the case is called.
    mass : float, optional
        Mass, kg, not negative.
    position : array_like, optional
        Its centre in the platform's frame, m, (3,).
    inertia : array_like, optional
        Inertia about its own centre, platform axes, kg m2, (3, 3), or three principal moments; a point mass by default.
    force, moment : array_like, optional
        Constant force (N) and moment (N m) on the platform at its reference point, in the platform's axes, (3,).

    Raises
    ------
    ArgumentError
        If the name is empty, or the mass or a principal moment of the inertia negative.

    See Also
    --------
    payload_loads : the loads of a path in several such cases.

    Notes
    -----
    Flat bodies and rods are bodies too. An inertia whose largest principal moment exceeds the sum of the other two, as
    rounding to a few digits makes it of a plate, is of none; it is taken as given and told in `warnings`, as that of a
    design's platform is.

    Examples
    --------
    >>> fx.paths.PayloadCase("camera", 12.0, (0, 0, 0.1)).position.tolist()
    [0.0, 0.0, 0.1]
    """

    name: str
    mass: float = 0.0
    position: Array = ZERO  # type: ignore[assignment]
    inertia: Array = _NO_INERTIA  # type: ignore[assignment]
    force: Array = ZERO  # type: ignore[assignment]
    moment: Array = ZERO  # type: ignore[assignment]

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip():
            raise ArgumentError(f'name of a payload is {shown(self.name)}; it must be text, such as "camera".')
        what = f"of the payload {self.name!r}"
        found: dict[str, object] = {"mass": not_negative(self.mass, f"mass {what}", "kg")}
        for name in ("position", "force", "moment"):
            found[name] = numbers(getattr(self, name), f"{name} {what}", (3,))
        inertia = _matrix(self.inertia, f"inertia {what}")
        principal = np.linalg.eigvalsh(inertia)
        if principal[0] < -ROUNDING * principal[2]:
            raise ArgumentError(
                f"inertia {what} is of no body: its smallest principal moment is {principal[0]:.3g} kg m2, below zero. "
                "Check the signs and sizes of its entries; it is taken about the payload's own centre."
            )
        if inertia.any() and not found["mass"]:
            raise ArgumentError(f"mass {what} is 0 although it has an inertia; it must be > 0.")
        for name, value in {**found, "inertia": inertia}.items():
            object.__setattr__(self, name, value)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is odd about the payload, as `Hexapod.warnings` of a design."""
        flaw = inertia_flaw(self.inertia)
        return (f"inertia: no rigid body has it; {flaw}. Results are computed with it as given.",) if flaw else ()


def payload_loads(
    hexapod: Hexapod,
    path: Trajectory,
    payloads: Sequence[PayloadCase],
    *,
    samples: int = 400,
    joint: JointModel = "universal",
    point: PointLike = ZERO,
) -> xr.Dataset:
    """Compute the loads of a trajectory with each of several payloads on the platform.

    Parameters
    ----------
    hexapod : Hexapod
        The design. Its `platform.mass` is carried in every case, and the payload besides.
    path : Trajectory
        The motion of the platform.
    payloads : sequence of PayloadCase
        The cases, each with a name of its own.
    samples : int, optional
        Number of instants, at least 8.
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.
    point : array_like or str, optional
        Point of the platform whose motion is told, in its frame, m, (3,), or the name of a point of the design.

    Returns
    -------
    xarray.Dataset
        What `path_loads` gives over `time` (s) and `leg`, with `case` (names) before them, and over `case`: mass (kg)
        of the payload, least_index (rad/s), the lowest natural frequency on the path, and warning, what is odd about
        the payload.

    Raises
    ------
    SingularPoseError
        If no leg forces can drive the trajectory somewhere.
    ArgumentError
        If there are no payloads, two have one name, or an argument has a wrong type.

    See Also
    --------
    path_loads : the loads of the design as it is.

    Notes
    -----
    A payload is rigidly part of the platform: its mass, mass centre and inertia are those of both bodies together.

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i")
    >>> path = fx.Trajectory([[0, 0, 0.89, 0, 0, 0], [0.1, 0, 0.89, 0, 0, 0]], times=[0.0, 1.0])
    >>> cases = [fx.paths.PayloadCase("empty"), fx.paths.PayloadCase("full", 50.0, (0, 0, 0.1))]
    >>> found = fx.paths.payload_loads(hexapod, path, cases)
    >>> str(found.peak_force.max("leg").idxmax().values)
    'full'
    """
    check_arguments(hexapod, path, samples)
    cases = _checked(payloads)
    told = point_attributes(hexapod, point)
    found, least = [], []
    for case in cases:
        loaded = with_payload(hexapod, case.mass, case.position, case.inertia)
        acting = {"force": case.force, "moment": case.moment}
        loads = path_loads(loaded, path, samples=samples, joint=joint, point=point, **acting)
        found.append(loads)
        least.append(path_index(loaded, path, samples=samples, joint=joint).minimum)
    names = xr.DataArray([case.name for case in cases], dims="case", name="case")
    together = xr.concat(found, dim=names, combine_attrs="override")
    together["mass"] = ("case", [case.mass for case in cases], in_unit("kg", "mass of the payload"))
    together["warning"] = ("case", [" ".join(case.warnings) for case in cases])
    together["least_index"] = ("case", least, in_unit("rad/s", "lowest natural frequency on the path"))
    return together.assign_attrs({**origin(hexapod), **told})


def _checked(payloads: Sequence[PayloadCase]) -> list[PayloadCase]:
    if isinstance(payloads, str | PayloadCase) or not isinstance(payloads, Sequence):
        raise ArgumentError(f"payloads is {shown(payloads)}; it must be a list of flexapod.paths.PayloadCase.")
    for case in payloads:
        instance(case, PayloadCase, "a payload", 'such as flexapod.paths.PayloadCase("camera", 12.0) makes one')
    names = [case.name for case in payloads]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ArgumentError(f"two payloads are called {twice!r}; each must have a name of its own.")
    if not 1 <= len(names) <= _MOST_CASES:
        raise ArgumentError(f"payloads has {len(names)} cases; there must be 1 to {_MOST_CASES}.")
    return list(payloads)


def _matrix(value: ArrayLike, name: str) -> Array:
    """An inertia, (3, 3), from itself or three moments."""
    try:
        shape = np.shape(value)
    except (TypeError, ValueError):  # rows of different lengths
        shape = ()
    if shape == (3,):
        return np.diag(numbers(value, name, (3,)))
    matrix = numbers(value, name, (3, 3))
    if np.abs(matrix - matrix.T).max() > 1e-9 * np.abs(matrix).max():
        raise ArgumentError(f"{name} is not symmetric; it must be. Principal moments alone may be given as three.")
    return 0.5 * (matrix + matrix.T)
