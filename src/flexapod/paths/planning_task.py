"""One planning problem: its requirements, its coordinates, and the steps from a straight line to a smooth path."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import one_of, positive
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PathError, SingularPoseError
from flexapod.mechanics.inputs import single_pose
from flexapod.mechanics.kinematics import det_sign
from flexapod.paths.analysis import dips, path_index
from flexapod.paths.chart import Chart
from flexapod.paths.leg_speed import LegSpeed, duration
from flexapod.paths.load_timing import exceeded, least_duration
from flexapod.paths.ompl_planner import search
from flexapod.paths.plan import Plan
from flexapod.paths.requirements import Margins, PathRequirements
from flexapod.paths.smoothing import Smoother, resampled
from flexapod.paths.trajectory import Trajectory
from flexapod.pose import Pose, PoseLike

Objective = Literal["length", "time"]
WAYPOINTS = (8, 12, 18, 26)  # tried in turn: more of them follow a narrow way more closely
_STEP = 0.02  # between checked points of a line, in platform sizes and rad
_CHECKED = 800  # instants of a path at which its margins are computed, before their minima are refined
_MARGINS = (0.005, 0.02, 0.04)  # kept at the samples of the smoothing, so that the bounds hold between them


class PlanningTask:
    """One planning problem in scaled coordinates z: position / size, rotation vector about the middle of the ends."""

    def __init__(
        self,
        hexapod: Hexapod,
        start: PoseLike,
        goal: PoseLike,
        requirements: PathRequirements | float,
        *,
        objective: Objective = "length",
        timing: LegSpeed | float = 1.0,
    ) -> None:
        one_of(objective, "objective", get_args(Objective))
        if not isinstance(timing, LegSpeed):
            if objective == "time":
                raise ArgumentError(
                    f"timing is {timing!r}; least time needs a LegSpeed, which says what the actuators can do."
                )
            positive(timing, "timing", "s")
        start, goal = single_pose(hexapod, start, "start"), single_pose(hexapod, goal, "goal")
        needed = requirements if isinstance(requirements, PathRequirements) else PathRequirements(requirements)
        self.hexapod, self.required, self.objective, self.timing = hexapod, needed, objective, timing
        self.margins = Margins(hexapod, needed)
        self.limited = self.margins.limited
        if isinstance(timing, LegSpeed):
            self.timing = timing.within(self.limited.limits)
        both = Pose(np.stack([start.position, goal.position]), np.stack([start.matrix, goal.matrix]))
        for pose, name in ((start, "start"), (goal, "goal")):
            self.margins.check(pose, name)
        self.side, other = det_sign(hexapod, both)
        if self.side != other:
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
        """(n,) whether points (n, 6) meet every requirement, on the side of the singular poses where the ends are."""
        poses = self.chart.poses(z * self.scale)
        met = self.margins.met(poses)
        met[met] = det_sign(self.hexapod, poses[met]) == self.side
        return met

    def margin(self, path: Trajectory) -> float:
        """The least margin along a path: its minima are refined, and beyond a singular pose it is -1."""

        def worst(t: ArrayLike) -> Array:
            poses = path(t).pose
            return np.where(det_sign(self.hexapod, poses) == self.side, self.margins.worst(poses), -1.0)

        times = path.grid(_CHECKED)
        values = worst(times)
        return min([float(values.min()), *(value for _, value in dips(worst, times, values))])

    def explore(self, seed: int, progress: Callable[[float], object]) -> tuple[Array, int]:
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

    def smoothed(self, rough: Array, progress: Callable[[float], object]) -> Trajectory:
        """The best spline that keeps every requirement on a dense check. Raises PathError where none does."""
        speed = self.timing if isinstance(self.timing, LegSpeed) and self.objective == "time" else None
        smoother = Smoother(self.margins, self.chart, self.size, speed)
        tries = [(count, margin) for count in WAYPOINTS for margin in _MARGINS]
        nearest = -np.inf
        for number, (count, margin) in enumerate(tries):
            done = [0]

            def report(number: int = number, done: list[int] = done) -> None:
                done[0] += 1
                progress((number + min(done[0], 60) / 60) / len(tries))

            first = resampled(rough, count)
            points = smoother.run(first, 4 * count + 1, margin, self.low, self.high, report)
            path = self.path(points)
            worst = self.margin(path)
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
        quick = unit.retimed(duration(self.hexapod, motions, self.timing))
        needed = least_duration(self.limited, quick, self.required.joint)
        return quick if needed is None else quick.retimed(needed)

    def check_loads(self, path: Trajectory) -> None:
        """Raises PathError where the legs exceed limits of force, speed, acceleration or power on the way."""
        beyond = exceeded(self.limited, path, self.required.joint)
        if not beyond:
            return
        needed = least_duration(self.limited, path, self.required.joint)
        what = f"in {path.duration:.5g} s the path exceeds the design's limits of leg {' and '.join(beyond)}"
        if needed is None:
            raise PathError(f"{what}, and slower as well. Widen the limits, or choose other poses.")
        raise PathError(
            f"{what}; it keeps them in {needed:.6g} s. Give it that much time (timing, on the command line "
            "--duration), or widen the limits."
        )

    def plan(self, path: Trajectory, straight: Trajectory, rough: Pose | None, batches: int) -> Plan:
        self.check_loads(path)

        def least(path: Trajectory) -> float:
            return path_index(self.hexapod, path, joint=self.required.joint, singular="keep").minimum

        values: dict[str, Any] = {
            "requirements": self.required,
            "size": self.size,
            "length": path.length(self.size),
            "straight_length": straight.length(self.size),
            "least_index": least(path),
            "straight_least_index": least(straight),
            "margin": self.margin(path),
            "batches": batches,
        }
        return Plan(path, straight, rough, **values)
