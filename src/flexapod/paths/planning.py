"""Paths that stay stiff: between two poses, with the stability index above a bound and all limits kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
import xarray as xr

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PathError, SingularPoseError
from flexapod.mechanics.inputs import single_pose
from flexapod.mechanics.kinematics import force_transformation
from flexapod.mechanics.modes import natural_modes
from flexapod.paths.ompl_planner import search
from flexapod.paths.requirements import Margins, PathRequirements
from flexapod.paths.smoothing import Smoother, Speeds, duration, resampled
from flexapod.paths.trajectory import Chart, Trajectory
from flexapod.pose import Pose

Objective = Literal["length", "time"]
Progress = Callable[[str, float], None]
_WAYPOINTS = (8, 12, 18, 26)  # tried in turn: more of them follow a narrow way more closely
_STEP = 0.02  # between checked points of a line, in platform sizes and rad
_MARGINS = (0.005, 0.02, 0.04)  # kept at the samples of the smoothing, so that the bounds hold between them


@dataclass(frozen=True)
class LegSpeed:
    """What the actuators can do: rate m/s, acceleration m/s2. A path timed with it takes the least time they allow.

    Raises: PathError for numbers that are not > 0, or no bound at all.
    Source: own.
    """

    rate: float = np.inf
    acceleration: float = np.inf

    def __post_init__(self) -> None:
        if not (self.rate > 0 and self.acceleration > 0):
            raise PathError(f"leg speed is {self.rate} m/s and {self.acceleration} m/s2; both must be > 0")
        if not (np.isfinite(self.rate) or np.isfinite(self.acceleration)):
            raise PathError("leg speed has no bound; give a rate (m/s), an acceleration (m/s2), or both")


@dataclass(frozen=True, eq=False)
class Plan:
    """A planned path; see `plan_path`.

    path: smooth, at rest at both ends. straight: the straight line between the same poses in the same manner. rough:
    corners of the sampling planner's line (None where the straight line was good enough). requirements: as kept.
    length, straight_length: m, one radian counted as `size`, the radius of the platform's joints, m. least_index,
    straight_least_index: rad/s. margin: the least relative margin to any requirement on the path. batches: of samples
    that the search drew.

    Source: conclusion 1.
    """

    path: Trajectory
    straight: Trajectory
    rough: Pose | None
    requirements: PathRequirements
    size: float
    length: float
    straight_length: float
    least_index: float
    straight_least_index: float
    margin: float
    batches: int


def plan_path(
    hexapod: Hexapod,
    start: Pose,
    goal: Pose,
    requirements: PathRequirements | float,
    *,
    objective: Objective = "length",
    timing: LegSpeed | float = 1.0,
    seed: int = 0,
    progress: Progress | None = None,
) -> Plan:
    """A path from `start` to `goal` that keeps the requirements (or just a bound on the index, rad/s) all along.

    objective: least "length", or least "time" for actuators as `timing` says. timing: LegSpeed, or the duration in s.
    A sampling planner (`BIT*`, by OMPL) finds a way; a gradient method then makes it short or quick and smooth, and the
    result is checked on points four times as dense. The same seed gives the same path. progress: called with a stage
    and its share done.

    Raises: PathError where an end breaks a requirement or no path is found, and says which requirement;
    SingularPoseError where singular poses lie between start and goal on any path; PoseError for ends that are not one
    Pose.
    Source: conclusion 1; `BIT*` after J. D. Gammell, S. S. Srinivasa and T. D. Barfoot (2015), SLSQP after D. Kraft
    (1988).
    """
    task = _Task(hexapod, start, goal, requirements, objective, timing)
    report = progress or (lambda stage, share: None)
    line = np.stack([task.ends[0], task.ends[1]])
    straight = task.path(resampled(line, _WAYPOINTS[0]))
    straight_margin = float(task.worst(straight).min())
    if straight_margin >= 0 and objective == "length":
        return task.plan(straight, straight, None, 0)
    rough, batches = (line, 0) if straight_margin >= 0 else task.explore(seed, lambda share: report("search", share))
    path = task.smoothed(rough, lambda share: report("smoothing", share))
    corners = None if batches == 0 else task.chart.poses(rough * task.scale)
    return task.plan(path, straight, corners, batches)


def plan_slice(hexapod: Hexapod, plan: Plan, points: int = 81) -> xr.Dataset:
    """The index on the plane through a plan's start, goal and the point of its path farthest from the straight line.

    Dataset over (aside, along), `points` each, m, one radian counted as the plan's `size`: `index`, rad/s; `met`,
    whether all requirements are. `path_along`, `path_aside` over `step`: the path projected on the plane. Attribute
    straight: where the goal lies on `along`.

    Raises: PathError for a plan that is straight.
    Source: own.
    """
    scale = np.repeat([1.0, plan.size], 3)
    chart = plan.path.chart
    z = chart.coordinates(plan.path(plan.path.grid(400)).pose) * scale
    line = z[-1] - z[0]
    length = float(np.linalg.norm(line))
    along = (z - z[0]) @ (line / length)
    off = z - z[0] - along[:, None] * (line / length)
    far = int(np.linalg.norm(off, axis=1).argmax())
    reach = float(np.linalg.norm(off[far]))
    if reach < 1e-6 * length:
        raise PathError("the planned path is straight; it spans no plane to show")
    basis = np.stack([line / length, off[far] / reach])
    place = (z - z[0]) @ basis.T
    room = 0.15 * max(length, reach)
    axes = [np.linspace(place[:, k].min() - room, place[:, k].max() + room, points) for k in range(2)]
    axes[1] = np.linspace(min(axes[1][0], -0.6 * reach - room), axes[1][-1], points)
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    poses = chart.poses((z[0] + grid @ basis) / scale)
    margins = Margins(hexapod, plan.requirements)
    return xr.Dataset(
        {
            "index": (("aside", "along"), margins.frequencies(poses)[:, 0].reshape(points, points), {"units": "rad/s"}),
            "met": (("aside", "along"), margins.met(poses).reshape(points, points)),
            "path_along": ("step", place[:, 0], {"units": "m"}),
            "path_aside": ("step", place[:, 1], {"units": "m"}),
        },
        {"along": ("along", axes[0], {"units": "m"}), "aside": ("aside", axes[1], {"units": "m"})},
        {"design": hexapod.name, "digest": hexapod.digest, "bound": plan.requirements.index, "straight": length},
    )


class _Task:
    """One planning problem in scaled coordinates z: position / size, rotation vector about the middle of the ends."""

    def __init__(
        self,
        hexapod: Hexapod,
        start: Pose,
        goal: Pose,
        requirements: PathRequirements | float,
        objective: str,
        timing: LegSpeed | float,
    ) -> None:
        if objective not in get_args(Objective):
            raise PathError(f"objective is {objective!r}; it must be 'length' or 'time'")
        if objective == "time" and not isinstance(timing, LegSpeed):
            raise PathError(f"timing is {timing!r}; least time needs a LegSpeed, which says what the actuators can do")
        if not isinstance(timing, LegSpeed) and not (np.isfinite(timing) and timing > 0):
            raise PathError(f"timing is {timing!r}; it must be a duration > 0 s, or a LegSpeed")
        for pose, name in ((start, "start"), (goal, "goal")):
            single_pose(hexapod, pose, name)
        needed = requirements if isinstance(requirements, PathRequirements) else PathRequirements(float(requirements))
        self.hexapod, self.required, self.objective, self.timing = hexapod, needed, objective, timing
        self.margins = Margins(hexapod, needed)
        both = Pose(np.stack([start.position, goal.position]), np.stack([start.matrix, goal.matrix]))
        for pose, name in ((start, "start"), (goal, "goal")):
            self.margins.check(pose, name)
        sides = np.linalg.slogdet(force_transformation(hexapod, both))[0]
        if sides[0] != sides[1]:
            raise SingularPoseError(
                "start and goal lie on different sides of the singular poses (det H changes its sign), so every path "
                "between them passes through one. Choose both on the same side."
            )
        self.chart = Chart.about(both)
        self.size = float(np.sqrt((hexapod.platform_joints**2).sum(axis=1).mean()))
        self.scale = np.repeat([self.size, 1.0], 3)
        self.ends = self.chart.coordinates(both) / self.scale
        if not np.abs(self.ends[1] - self.ends[0]).max() > 1e-9:
            raise PathError("start and goal are the same pose; there is nothing to plan")
        room = np.repeat([self.margins.reach_from(both) / self.size, needed.turn], 3)
        self.low, self.high = self.ends.min(axis=0) - room, self.ends.max(axis=0) + room

    def met(self, z: Array) -> np.ndarray:
        """(n,) whether points (n, 6) meet every requirement."""
        return self.margins.met(self.chart.poses(z * self.scale))

    def worst(self, path: Trajectory, samples: int = 400) -> Array:
        return self.margins.worst(path(path.grid(samples)).pose)

    def explore(self, seed: int, progress: Callable[[float], None]) -> tuple[Array, int]:
        found = search(self.met, self.ends, self.low, self.high, step=_STEP, seed=seed, progress=progress)
        if found.points is None:
            raise PathError(self._why_not(seed))
        return found.points, found.batches

    def _why_not(self, seed: int) -> str:
        """What stands in the way, from samples of the search box."""
        points = self.low + (self.high - self.low) * np.random.default_rng(seed).random((2000, 6))
        poses = self.chart.poses(points * self.scale)
        index = self.margins.frequencies(poses)[:, 0]
        share = float(self.margins.met(poses).mean())
        stiff = float((index >= self.required.index).mean())
        return (
            f"no path was found that keeps the index above {self.required.index:.5g} rad/s and all limits: of poses "
            f"sampled around start and goal {stiff:.2%} have that index and {share:.2%} also keep the limits "
            f"(the highest index seen is {index.max():.5g} rad/s). Lower the bound, widen the limits, or raise "
            "reach and turn so that the search may go farther."
        )

    def smoothed(self, rough: Array, progress: Callable[[float], None]) -> Trajectory:
        """The best spline that keeps every requirement on a dense check. Raises PathError where none does."""
        speeds = Speeds(self.timing.rate, self.timing.acceleration) if isinstance(self.timing, LegSpeed) else None
        smoother = Smoother(self.margins, self.chart, self.size, speeds if self.objective == "time" else None)
        tries = [(count, margin) for count in _WAYPOINTS for margin in _MARGINS]
        nearest = -np.inf
        for number, (count, margin) in enumerate(tries):
            done = [0]

            def report(number: int = number, done: list[int] = done) -> None:
                done[0] += 1
                progress((number + min(done[0], 60) / 60) / len(tries))

            first = resampled(rough, count)
            points = smoother.run(first, 4 * count + 1, margin, self.low, self.high, report)
            path = self.path(points)
            worst = float(self.worst(path, 16 * count).min())
            if worst >= 0:
                progress(1.0)
                return path
            nearest = max(nearest, worst)
        raise PathError(
            f"a way was found, but no smooth path along it keeps every requirement: the best one misses by "
            f"{-nearest:.2%}. Lower the bound on the index by as much, or try another seed."
        )

    def path(self, z: Array) -> Trajectory:
        """The path through scaled waypoints, in the time that `timing` allows."""
        poses = self.chart.poses(z * self.scale)
        unit = Trajectory(poses, np.linspace(0.0, 1.0, len(z)))
        if not isinstance(self.timing, LegSpeed):
            return unit.retimed(float(self.timing))
        motions = unit(np.linspace(0.0, 1.0, 801))
        return unit.retimed(duration(self.hexapod, motions, Speeds(self.timing.rate, self.timing.acceleration)))

    def plan(self, path: Trajectory, straight: Trajectory, rough: Pose | None, batches: int) -> Plan:
        def least(path: Trajectory) -> float:
            return float(
                natural_modes(self.hexapod, path(path.grid(800)).pose, joint=self.required.joint).omega[:, 0].min()
            )

        values: dict[str, Any] = {
            "requirements": self.required,
            "size": self.size,
            "length": path.length(self.size),
            "straight_length": straight.length(self.size),
            "least_index": least(path),
            "straight_least_index": least(straight),
            "margin": float(self.worst(path, 1600).min()),
            "batches": batches,
        }
        return Plan(path, straight, rough, **values)
