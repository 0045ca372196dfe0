"""What every pose of a planned path must satisfy, as numbers that are >= 0 where it does."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np

from flexapod.checks import number, one_of, positive
from flexapod.conventions import JOINT_MODELS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PathError, told_apart
from flexapod.mechanics.joint_limits import check_limits, limit_excess
from flexapod.mechanics.kinematics import condition_number, inverse_kinematics
from flexapod.mechanics.limited import together
from flexapod.pose import Pose
from flexapod.showing import in_notebooks
from flexapod.workspace.quantities import evaluate, kernel_limits

_MOST = 1e9  # of a relative margin
_SHARPNESS = 80.0  # of smooth minima: they lie below the true one by at most log(12)/80, 3 %


@in_notebooks
@dataclass(frozen=True)
class PathRequirements:
    """What a planned path keeps to, all along.

    Parameters
    ----------
    index : float
        Least natural frequency, rad/s.
    condition_number : float, optional
        Largest condition number of the force transformation H (in metres). By default only the index keeps away from
        singular poses, at which it is zero.
    clearance : float, optional
        Least distance between leg axes, m, in place of that in the design's limits.
    limits : bool, optional
        Whether the design's limits are kept: those of poses at rest, leg forces under the weight among them, and those
        of force, speed, acceleration and power of the legs on the path as it is timed.
    reach : float, optional
        How far the search may leave the box around start and goal, m; half the mean leg length by default.
    turn : float, optional
        The same for rotations, rad.
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.

    Raises
    ------
    ArgumentError
        If no path could keep a bound, such as one that is not > 0.

    See Also
    --------
    plan_path : a path that keeps requirements.

    Examples
    --------
    >>> needs = fx.PathRequirements(100.0, condition_number=20.0)
    >>> needs.turn
    0.5
    """

    index: float
    _: KW_ONLY
    condition_number: float | None = None
    clearance: float | None = None
    limits: bool = True
    reach: float | None = None
    turn: float = 0.5
    joint: JointModel = "universal"

    def __post_init__(self) -> None:
        for name, unit in (("index", "rad/s"), ("reach", "m"), ("turn", "rad"), ("clearance", "m")):
            if getattr(self, name) is not None or name in {"index", "turn"}:
                positive(getattr(self, name), name, unit)
        one_of(self.joint, "joint", JOINT_MODELS)
        if self.condition_number is not None and not number(self.condition_number, "condition_number") > 1:
            raise ArgumentError(
                f"condition_number is {self.condition_number}; it must be > 1, as no H has a smaller one."
            )


class Margins:
    """Requirements on a machine's poses. Each margin is relative: 0.1 is 10 % of the bound, or of the leg's stroke."""

    def __init__(self, hexapod: Hexapod, requirements: PathRequirements) -> None:
        self.required = requirements
        self.hexapod = hexapod
        self.limited = hexapod.replace({"limits": None}) if not requirements.limits else hexapod
        if requirements.clearance is not None:
            self.limited = self.limited.replace({"limits.leg_distance": requirements.clearance})
        self._packed = kernel_limits(self.limited)

    def frequencies(self, poses: Pose) -> Array:
        """(n, 6) rad/s; zero where no leg can take the pose."""
        return np.nan_to_num(
            evaluate(self.hexapod, _rows(poses), ("omega",), self.required.joint, 1, self._packed)["omega"]
        )

    def met(self, poses: Pose) -> np.ndarray:
        """(n,) whether each pose meets every requirement."""
        wanted = ("omega_1", "within_limits", "cond_H")[: 3 if self.required.condition_number else 2]
        found = evaluate(self.limited, _rows(poses), wanted, self.required.joint, 1, self._packed)
        ok = (found["omega_1"] >= self.required.index) & found["within_limits"].astype(bool)
        if self.required.condition_number is not None:
            ok &= found["cond_H"] <= self.required.condition_number
        return ok

    def worst(self, poses: Pose) -> Array:
        """(n,) the least margin of each pose."""
        parts = [self.frequencies(poses)[:, :1] / self.required.index - 1, *self._others(poses)]
        least = np.min([part.min(axis=1) for part in parts], axis=0)
        return np.where(np.isfinite(least), least, -np.inf)

    def smooth(self, poses: Pose) -> Array:
        """(n, k) margins by kind, each a smooth minimum over the modes or the legs, never above the true one.

        A smooth minimum of all six frequencies is differentiable also where the lowest are equal.
        """
        ratio = self.frequencies(poses) / self.required.index - 1
        return np.stack([smooth_minimum(part) for part in (ratio, *self._others(poses))], axis=1)

    def _others(self, poses: Pose) -> list[Array]:
        found = []
        if self.required.condition_number is not None:
            found.append(
                1 - np.asarray(condition_number(self.hexapod, poses))[:, None] / self.required.condition_number
            )
        for quantity in limit_excess(self.limited, poses, joint=self.required.joint):
            value = quantity.value.reshape(poses.shape[0], -1)
            least, most = np.broadcast_to(quantity.least, value.shape), np.broadcast_to(quantity.most, value.shape)
            both = np.isfinite(least) & np.isfinite(most)
            scale = np.where(both, most - least, np.where(np.isfinite(most), most, least))
            with np.errstate(invalid="ignore", over="ignore"):
                sides = np.concatenate([(value - least) / scale, (most - value) / scale], axis=1)
            bounded = np.isfinite(np.concatenate([least, most], axis=1)).any(axis=0)
            found.append(np.clip(sides[:, bounded], -_MOST, _MOST))  # beside a bound near zero all is infinitely far
        return found

    def check(self, pose: Pose, name: str) -> None:
        """Raises PathError for an end of a path that breaks a requirement, and says which."""
        index = float(self.frequencies(Pose(pose.position[None], pose.matrix[None]))[0, 0])
        required = self.required
        if not index >= required.index:
            told, bound = told_apart(index, required.index, (5, 5))
            raise PathError(
                f"the {name} pose has a lowest natural frequency of {told} rad/s, below the bound of "
                f"{bound} rad/s; no path from it can keep the bound. Lower the bound, or move the pose."
            )
        cond = float(condition_number(self.hexapod, pose))
        if required.condition_number is not None and not cond <= required.condition_number:
            told, bound = told_apart(cond, required.condition_number, (5, 5))
            raise PathError(
                f"the {name} pose has cond(H) = {told}, above the bound of {bound}. Raise the bound, or move the pose."
            )
        exceeded = check_limits(self.limited, pose, joint=required.joint).exceeded
        if exceeded:
            raise PathError(
                f"the {name} pose is outside the limits: {'; '.join(together(exceeded))}. Move it, or widen the limits."
            )

    def reach_from(self, ends: Pose) -> float:
        """How far the search may go beyond the ends, m."""
        return self.required.reach or 0.5 * float(inverse_kinematics(self.hexapod, ends).mean())


def smooth_minimum(values: Array) -> Array:
    """-log(sum exp(-a x))/a over the last axis: smooth, and below the least value by at most log(n)/a.

    Margins may be negative, where `optimisation.derivatives.soft_least` takes positive frequencies and their slopes.
    """
    least = values.min(axis=-1, keepdims=True)
    least = np.where(np.isfinite(least), least, -1e3)
    return least[..., 0] - np.log(np.exp(-_SHARPNESS * (values - least)).sum(axis=-1)) / _SHARPNESS


def _rows(poses: Pose) -> Array:
    return poses.packed
