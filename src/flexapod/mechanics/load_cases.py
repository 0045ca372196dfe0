"""Load cases at rest: gravity from any direction and loads at any point; leg forces, deflections and stiffness."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import number, numbers, one_of
from flexapod.conventions import AXES, LEGS, Array, JointModel, Unit, in_mixed_units, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError, KinematicsError, PoseError, SingularPoseError, shown
from flexapod.mechanics.inputs import ZERO, PointLike, as_hexapod, as_joint, as_point, point_attributes, pose_or_home
from flexapod.mechanics.load_case import Answer, Case, answer, unanswered
from flexapod.mechanics.load_limits import load_excess
from flexapod.mechanics.springs import axial_stiffness
from flexapod.pose import Pose, PoseLike, vectors

if TYPE_CHECKING:
    import xarray as xr

Axes = Literal["platform", "base"]
AXES_OF_LOADS: tuple[Axes, ...] = ("platform", "base")
#: What deflections are derived by, with its dimension, and its unit below theirs.
_DERIVATIVES = (
    ("leg_length", ("leg",), "/m"),
    ("stiffness", ("leg",), "*m/N"),
    ("mass", (), "/kg"),
    ("mass_center", ("axis",), "/m"),
)
_CARRIED: tuple[tuple[str, Unit], ...] = (
    ("spherical_force", "N"),
    ("universal_force", "N"),
    ("leg_moment", "N m"),
    ("universal_moment", "N m"),
)
_PLACE = ("x", "y", "z")


class _Given(NamedTuple):
    """Load cases, each array with one row for each."""

    pose: Pose
    gravity: Array
    force: Array
    moment: Array
    at: Array


def gravity_at(elevation: ArrayLike, base_roll: ArrayLike = 0.0, *, magnitude: float = 9.81) -> Array:
    """Give gravity in the base frame of a machine whose base is tilted, as that of a telescope.

    Parameters
    ----------
    elevation : array_like
        Angle of the base's z axis above the horizon, rad, (...): pi/2 where it points at the zenith.
    base_roll : array_like
        Turn of the base about its z axis, rad, (...). At zero its y axis points down the slope, and x is level.
    magnitude : float
        Gravity, m/s2.

    Returns
    -------
    ndarray
        Gravity in the base frame, m/s2, (..., 3).

    Raises
    ------
    ArgumentError
        For what is not a finite number, and a magnitude below zero.

    Notes
    -----
    (cos e sin r, cos e cos r, -sin e) times the magnitude, with the elevation e and the roll r.

    Examples
    --------
    >>> fx.mechanics.gravity_at(np.radians([90, 15])).round(3).tolist()
    [[0.0, 0.0, -9.81], [0.0, 9.476, -2.539]]
    """
    e, r = numbers(elevation, "elevation", None), numbers(base_roll, "base_roll", None)
    g = number(magnitude, "magnitude", "m/s2", need=">= 0")
    try:
        e, r = np.broadcast_arrays(e, r)
    except ValueError:
        raise ArgumentError(
            f"elevation has shape {e.shape}, base_roll {r.shape}; their axes must be equal or 1."
        ) from None
    down = np.stack([np.cos(e) * np.sin(r), np.cos(e) * np.cos(r), -np.sin(e)], axis=-1)
    return np.where(np.abs(down) < 1e-15, 0.0, g * down)


def load_cases(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    gravity: ArrayLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    at: PointLike = ZERO,
    axes: Axes = "platform",
    point: PointLike = ZERO,
    reference: int | None = None,
    section: float = 0.5,
    joint: JointModel = "universal",
) -> xr.Dataset:
    """Find leg forces, joint reactions, deflections and stiffness at rest for many load cases.

    Every argument but `point` may have one row for all cases, or one for each.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform without deflection, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad,
        (..., 6). Left out, the home pose.
    gravity : array_like, optional
        Gravity in the base frame, m/s2, (3,) or (n, 3), as `gravity_at` gives it. Left out, the design's.
    force, moment : array_like
        Force (N) and moment (N m) on the platform, (3,) or (n, 3).
    at : array_like or str
        Point of the platform, in its frame, m, (3,) or (n, 3), at which the force acts, or the name of a point of the
        design.
    axes : {"platform", "base"}
        Axes of force and moment: the platform's, with which they turn, or the base's, in which they stay.
    point : array_like or str
        Point of the platform, in its frame, m, (3,), whose deflection and stiffness are wanted, or the name of a point
        of the design.
    reference : int, optional
        Number of the case, from 0, for whose gravity and load the leg lengths are set: with them each pose is held
        exactly in that case. Left out, lengths are those of the pose without weight and load.
    section : float
        Where along a leg the moment in it is taken, as a fraction of its length from the base joint.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    xarray.Dataset
        Over `case`, and `leg`, `axis` (x, y, z) or `displacement` (x to yaw) and `by` (the same): gravity, leg_force
        (N, positive: compression), leg_length, unstretched_length (m), deflection of the point (m) and rotation
        (rotation vector, rad) in base axes, spherical_force, universal_force (N), leg_moment, universal_moment (N m),
        stiffness and compliance at the point (base axes; N, m, rad), deflection_by_leg_length,
        deflection_by_stiffness (of a leg, with all that is in series), deflection_by_mass and deflection_by_mass_center
        (derivatives of deflection and rotation), force_within_limits, and status: "ok", or why there
        is no equilibrium, with NaN elsewhere.

    Raises
    ------
    PoseError
        Where no pose is given and no home pose is known.
    ArgumentError
        For numbers of a wrong shape or for different numbers of cases, a reference that is no case, and unknown axes or
        joint models.
    DesignError
        If `hexapod` is not a Hexapod.

    See Also
    --------
    flexapod.hold : The leg forces that hold a pose.
    flexapod.static_equilibrium : Where the platform settles for given lengths.

    Notes
    -----
    Each equilibrium is exact for large deflections (Newton's method with the exact tangent). Stiffness is the tangent
    there, with the geometric stiffness of loads; its inverse times small changes of leg length, of a leg's stiffness,
    and of the platform's mass or mass centre (whose weight also is in the reference) gives the derivatives.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> elevation = np.radians([90, 60, 30])
    >>> cases = fx.load_cases(machine, gravity=fx.mechanics.gravity_at(elevation), reference=0)
    >>> (1e3 * cases.deflection.sel(axis="y")).round(2).values[1:].tolist()  # mm
    [5.18, 8.96]
    """
    as_hexapod(hexapod), as_joint(joint)
    acted = as_point(hexapod, at, "at") if isinstance(at, str) else at
    given = _spread(hexapod, pose, gravity, force, moment, acted)
    one_of(axes, "axes", AXES_OF_LOADS)
    centre, cut = as_point(hexapod, point), number(section, "section")
    count = len(given.gravity)
    if reference is not None and not (_is_whole(reference) and 0 <= reference < count):
        raise ArgumentError(f"reference is {shown(reference)}; it must be the number of one of {count} cases, from 0.")
    machines: dict[bytes, Hexapod] = {}
    answers = []
    for k in range(count):
        own = _case(hexapod, given, k, k, machines, axes)
        zero = None if reference is None else _case(hexapod, given, reference, k, machines, axes)
        try:
            answers.append(answer(own, zero, centre, cut, joint))
        except (SingularPoseError, KinematicsError, PoseError) as error:
            answers.append(unanswered(str(error)))
    return _dataset(hexapod, given, answers).assign_attrs(point_attributes(hexapod, point))


def _is_whole(value: object) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def _spread(hexapod: Hexapod, pose: PoseLike | None, gravity: ArrayLike | None, *loads: ArrayLike) -> _Given:
    """All arguments with a row for each case."""
    where = pose_or_home(hexapod, pose)
    given = [hexapod.gravity if gravity is None else gravity, *loads]
    rows = [
        vectors(value, name, 3, ArgumentError)
        for value, name in zip(given, ("gravity", "force", "moment", "at"), strict=True)
    ]
    shapes = [where.shape, *(row.shape[:-1] for row in rows)]
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        shape = (0, 0)
    if len(shape) > 1 or 0 in shape:
        raise ArgumentError(
            f"pose, gravity, force, moment and at have {', '.join(map(str, shapes))} cases; each must have one row, or "
            "one for each case, the same number for all, at least one."
        )
    count = shape[0] if shape else 1
    poses = Pose(np.broadcast_to(where.position, (count, 3)), np.broadcast_to(where.matrix, (count, 3, 3)))
    return _Given(poses, *(np.broadcast_to(row, (count, 3)) for row in rows))


def _case(hexapod: Hexapod, given: _Given, load: int, pose: int, machines: dict[bytes, Hexapod], axes: Axes) -> Case:
    """The gravity and load of one case at the pose of another."""
    gravity = given.gravity[load]
    machine = machines.setdefault(gravity.tobytes(), hexapod if np.array_equal(gravity, hexapod.gravity) else None)  # type: ignore[arg-type]
    if machine is None:
        machine = machines[gravity.tobytes()] = dataclasses.replace(hexapod, gravity=gravity)
    loads = given.force[load], given.moment[load], given.at[load]
    return Case(machine, given.pose[pose], *loads, axes == "base")


def _dataset(hexapod: Hexapod, given: _Given, answers: list[Answer]) -> xr.Dataset:
    import xarray as xr

    def stacked(name: str) -> Array:
        return np.stack([getattr(one, name) for one in answers])

    legs, place, six = ("case", "leg"), ("case", "axis"), ("case", "displacement")
    found: dict[str, tuple[Any, ...]] = {
        "gravity": (place, given.gravity, in_unit("m/s^2", "gravity, base frame")),
        "leg_force": (legs, stacked("leg_force"), in_unit("N", "leg force, positive in compression")),
        "leg_length": (legs, stacked("leg_length"), in_unit("m", "leg length")),
        "unstretched_length": (legs, stacked("unstretched_length"), in_unit("m", "leg length without load")),
        "deflection": (place, stacked("deflection"), in_unit("m", "deflection of the point, base axes")),
        "rotation": (place, stacked("rotation"), in_unit("rad", "rotation vector of the platform, base axes")),
    }
    for name, unit in _CARRIED:
        found[name] = (("case", "leg", "axis"), stacked(name), in_unit(unit, name.replace("_", " ")))
    for name, mixed in (("stiffness", "load_unit/by_unit"), ("compliance", "displacement_unit/wrench_unit")):
        found[name] = ((*six, "by"), stacked(name), in_mixed_units(mixed, f"{name} at the point"))
    for name, by, per in _DERIVATIVES:
        dims, told = (*six, *by), in_mixed_units(f"displacement_unit{per}", f"deflection of the point by {name}")
        found[f"deflection_by_{name}"] = (dims, stacked(f"by_{name}"), told)
    force = stacked("leg_force")
    within = np.isfinite(force).all(axis=1)
    for limited in load_excess(hexapod, force):
        within &= limited.kept.all(axis=1)
    found["force_within_limits"] = ("case", within, in_unit("1", "whether leg forces keep the design's limits"))
    found["status"] = ("case", np.array([one.status for one in answers]), {})
    moves, loads = np.array(["m"] * 3 + ["rad"] * 3), np.array(["N"] * 3 + ["N m"] * 3)
    coords = {
        "case": np.arange(len(answers)),
        "leg": list(LEGS),
        "axis": list(_PLACE),
        "displacement": list(AXES),
        "by": list(AXES),
        "displacement_unit": ("displacement", moves),
        "load_unit": ("displacement", loads),
        "by_unit": ("by", moves),
        "wrench_unit": ("by", loads),
    }
    return xr.Dataset(found, coords).assign_attrs(
        **origin(hexapod),
        leg_stiffness=[float(k) for k in axial_stiffness(hexapod, answers[0].unstretched_length)[0]],
    )
