"""What a sweep can find at a pose: names, units and meanings, and the call of the compiled kernel that finds them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache, reduce
from operator import or_
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.checks import one_of
from flexapod.conventions import AXES, Array, JointModel, Unit, in_unit, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.design.parts import Limits
from flexapod.errors import ArgumentError, shown
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.inputs import as_joint
from flexapod.mechanics.joint_limits import neutral_directions
from flexapod.mechanics.load_limits import force_bounds
from flexapod.pose import Pose
from flexapod.rotations import matrices_of_quaternions, rpy_matrix
from flexapod.tables import normal_unit


class Quantity(NamedTuple):
    """`trailing`: name of a last axis of six, or ""."""

    unit: Unit
    meaning: str
    trailing: str = ""
    dtype: str = "float64"


QUANTITIES: dict[str, Quantity] = {
    "omega_1": Quantity("rad/s", "lowest natural frequency (dynamic stability index)"),
    "omega": Quantity("rad/s", "natural frequencies", "mode"),
    "cond_H": Quantity("1", "condition number of the force transformation H"),
    "leg_length": Quantity("m", "leg length", "leg"),
    "universal_angle": Quantity("rad", "universal joint angle from neutral", "leg"),
    "spherical_angle": Quantity("rad", "spherical joint angle from neutral", "leg"),
    "universal_moment": Quantity("N m", "bending moment of the universal joint's springs", "leg"),
    "spherical_moment": Quantity("N m", "bending moment of the spherical joint's springs", "leg"),
    "leg_distance": Quantity("m", "least distance between two leg axes"),
    "leg_force": Quantity("N", "largest static leg force under gravity"),
    "leg_compression": Quantity("N", "largest static compression of a leg under gravity"),
    "leg_tension": Quantity("N", "largest static tension of a leg under gravity"),
    "lowest_stiffness": Quantity("N/m", "lowest stiffness against displacement of the reference point"),
    "within_limits": Quantity("1", "whether legs and joints at rest are within the design's limits", dtype="bool"),
}
#: Poses as the kernel takes them: rows (n, 6) or (n, 12), or positions (n, 3) and rotations (n, 4) or (n, 9).
PoseNumbers: TypeAlias = "Array | tuple[Array, Array]"
_DEFAULT = ("omega_1", "cond_H")
SIGNED_FORCES = ("leg_compression", "leg_tension")  #: found one pose after the other, where the rest is by lanes
#: What else a quantity is called -> its name here.
COMMON_NAMES = {
    "frequency": "omega_1",
    "index": "omega_1",
    "stability_index": "omega_1",
    "lowest_frequency": "omega_1",
    "frequencies": "omega",
    "natural_frequencies": "omega",
    "condition_number": "cond_H",
    "condition": "cond_H",
    "leg_lengths": "leg_length",
    "lengths": "leg_length",
    "joint_angles": "universal_angle",
    "stiffness": "lowest_stiffness",
    "limits": "within_limits",
}
#: Code of a pose that has not been computed yet, in a store that is being written.
PENDING = 255
_MEANINGS = {
    "ok": "every value is right",
    "singular": "the legs cannot hold the platform: the lowest frequency is zero to rounding, forces are NaN",
    "no_leg": "a leg has no length or lies along its universal joint's axis: values are NaN",
    "not_finite": "the pose holds NaN or infinity: values are NaN",
    "no_inertia": "the inertia matrix is not positive definite: frequencies are NaN",
    "outside_stiffness_law": "a leg's length is outside its stiffness law: frequencies and stiffnesses are NaN",
    "pending": "not computed yet",
}


def statuses() -> dict[int, str]:
    """Names of the status codes."""
    return {**{status.value: status.name for status in _core.SweepStatus}, PENDING: "pending"}


def chosen(quantities: str | Iterable[str] | None, hexapod: Hexapod) -> tuple[str, ...]:
    """Quantities by name, in the order of the table, each once. Raises ArgumentError for an unknown name or none.

    None: the usual ones; of a design with limits, whether they are kept as well.
    """
    if quantities is None:
        return (*_DEFAULT, *(("within_limits",) if hexapod.limits.given else ()))
    if not isinstance(quantities, Iterable):
        raise ArgumentError(f"quantities is {shown(quantities)}; it must be the name of a quantity, or several.")
    names = (quantities,) if isinstance(quantities, str) else tuple(quantities)
    for name in names:
        if isinstance(name, str) and name in COMMON_NAMES:
            raise ArgumentError(f"there is no quantity {name!r}. Did you mean {COMMON_NAMES[name]!r}?")
        one_of(name, "quantity", QUANTITIES)
    if not names:
        raise ArgumentError(f"no quantity was asked for; choose from {', '.join(QUANTITIES)}.")
    return tuple(name for name in QUANTITIES if name in names)


def evaluate(
    hexapod: Hexapod,
    poses: PoseNumbers,
    quantities: tuple[str, ...],
    joint: JointModel,
    threads: int,
    limits: _core.SweepLimits | None = None,
    *,
    forces: bool = True,
) -> dict[str, Any]:
    """The quantities and `status` at poses from the compiled kernel.

    poses: rows (n, 6) or (n, 12), or positions (n, 3) and rotations, quaternions (n, 4) or matrices (n, 9).

    limits: `kernel_limits(hexapod)`, for those who call often. forces: whether `within_limits` is of leg forces too.
    """
    limits = kernel_limits(hexapod) if limits is None else limits
    bounds = force_bounds(hexapod.limits) if forces and "within_limits" in quantities else None
    asked = tuple(name for name in quantities if name not in SIGNED_FORCES)
    if bounds is not None or not asked:
        asked = (*asked, "leg_force")
    found = _core.sweep(hexapod.packed, as_joint(joint), poses, _asked(asked), limits, threads)
    if not {*SIGNED_FORCES}.isdisjoint(quantities):
        force = inverse_dynamics(hexapod, _as_pose(poses), joint=joint)
        found |= {"leg_compression": force.max(axis=1), "leg_tension": -force.min(axis=1)}
    if bounds is not None:
        found["within_limits"] = found["within_limits"] & _forces_kept(hexapod, poses, joint, found, bounds)
    return {name: found[name] for name in (*quantities, "status")}


def _forces_kept(
    hexapod: Hexapod, poses: PoseNumbers, joint: JointModel, found: dict[str, Any], bounds: tuple[float, float]
) -> NDArray[np.bool_]:
    """Whether the forces of rest are within their bounds, (n,); false where no forces hold the pose.

    The kernel tells the largest force without its sign: only where one bound alone allows it are the forces looked at.
    """
    least, most = bounds
    kept: NDArray[np.bool_] = found["leg_force"] <= min(-least, most)
    left = found["within_limits"] & ~kept & (found["leg_force"] <= max(-least, most))
    if left.any():
        force = inverse_dynamics(hexapod, _as_pose(poses)[left], joint=joint)
        kept[left] = ((force >= least) & (force <= most)).all(axis=1)
    return kept


def _as_pose(poses: PoseNumbers) -> Pose:
    """The poses that the kernel takes as rows."""
    if not isinstance(poses, tuple):
        matrix = rpy_matrix(poses[:, 3:]) if poses.shape[1] == 6 else poses[:, 3:].reshape(-1, 3, 3)
        return Pose.trusted(poses[:, :3], matrix)  # of a pose that is none the forces are NaN
    position, turned = poses
    if turned.shape[1] == 4:
        return Pose.trusted(position, matrices_of_quaternions(turned))
    return Pose.trusted(position, turned.reshape(-1, 3, 3))


@cache
def _asked(arrays: tuple[str, ...]) -> _core.SweepQuantity:
    """What the kernel is asked for, so that it gives the arrays of these names."""
    return reduce(or_, (_core.SWEEP_ARRAYS[name] for name in arrays))


def index_and_gradient(hexapod: Hexapod, joint: JointModel) -> Callable[[Array], tuple[Array, Array]]:
    """A function from poses, rows (n, 6), to omega_1 (n,) and its derivatives by the coordinates (n, 6).

    Both are zero where omega_1 cannot be computed.
    """
    wanted = _asked(("omega_1", "omega_1_gradient"))
    model, packed, limits = as_joint(joint), hexapod.packed, kernel_limits(hexapod)

    def found(rows: Array) -> tuple[Array, Array]:
        at = _core.sweep(packed, model, rows, wanted, limits, 1)
        return np.nan_to_num(at["omega_1"]), np.nan_to_num(at["omega_1_gradient"])

    return found


def kernel_limits(hexapod: Hexapod, only_law: bool = False) -> _core.SweepLimits:
    """The design's limits as the kernel takes them, within the range of a stiffness law; or that range alone."""
    limits = Limits() if only_law else hexapod.limits
    lengths = np.array(np.broadcast_to((-np.inf, np.inf) if limits.leg_length is None else limits.leg_length, (6, 2)))
    law = hexapod.legs.stiffness_law
    if law is not None:
        lengths = np.stack([np.maximum(lengths[:, 0], law.range[:, 0]), np.minimum(lengths[:, 1], law.range[:, 1])], 1)
    return _core.SweepLimits(
        neutral=neutral_directions(hexapod),
        leg_length=np.ascontiguousarray(lengths),
        universal_angle=np.inf if limits.universal_angle is None else limits.universal_angle,
        spherical_angle=np.inf if limits.spherical_angle is None else limits.spherical_angle,
        universal_moment=np.inf if limits.universal_moment is None else limits.universal_moment,
        spherical_moment=np.inf if limits.spherical_moment is None else limits.spherical_moment,
        leg_distance=-np.inf if limits.leg_distance is None else limits.leg_distance,
    )


def memory(poses: int, quantities: tuple[str, ...]) -> int:
    """Bytes that a sweep takes: coordinates, status, and quantities."""
    columns = (np.dtype(QUANTITIES[name].dtype).itemsize * len(table_titles(name)) for name in quantities)
    return poses * (49 + sum(columns))


def table_titles(name: str) -> tuple[str, ...]:
    """Titles of the columns of a quantity in a table, without their unit: `omega_mode_1` to `omega_mode_6`."""
    trailing = QUANTITIES[name].trailing
    return tuple(f"{name}_{trailing}_{k}" for k in range(1, 7)) if trailing else (name,)


def titled(title: str, unit: str) -> str:
    """A title with its unit as files name it: `x_m`, `omega_1_rad_per_s`."""
    return title if unit in ("", "1") else f"{title}_{normal_unit(unit)}"


def attributes(name: str) -> dict[str, Any]:
    """Attributes of a variable of a result, as the CF conventions name them."""
    if name == "status":
        codes = statuses()
        return {
            "long_name": "status of the pose",
            "flag_values": np.array(list(codes), dtype=np.uint8),
            "flag_meanings": " ".join(codes.values()),
            "comment": "; ".join(f"{word}: {_MEANINGS[word]}" for word in codes.values()),
        }
    if name in AXES:
        k = AXES.index(name)
        turn = f"about the fixed axis {AXES[k - 3]}" if k > 2 else "of the reference point, base frame"
        return in_unit(unit_of(name), f"{name} {turn}")
    quantity = QUANTITIES[name]
    return in_unit(quantity.unit, quantity.meaning)


def provenance(hexapod: Hexapod, joint: JointModel) -> dict[str, Any]:
    """What a result was made from and with."""
    from flexapod import __version__

    return {
        "title": f"Pose sweep of {hexapod.name}",
        "design": hexapod.name,
        "design_digest": hexapod.digest,
        "joint": joint,
        "source": f"flexapod {__version__}",
        "instruction_set": _core.simd(),
    }
