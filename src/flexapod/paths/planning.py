"""Paths that stay stiff: between two poses, with the stability index above a bound and all limits kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexapod.certificates.index import certify as certify_index
from flexapod.design.hexapod import Hexapod
from flexapod.paths.leg_speed import LegSpeed
from flexapod.paths.plan import Plan
from flexapod.paths.planning_task import WAYPOINTS, Objective, PlanningTask
from flexapod.paths.requirements import PathRequirements
from flexapod.paths.smoothing import resampled
from flexapod.pose import PoseLike
from flexapod.progress import ProgressLike, with_progress

LONGEST = 60.0  # s that a proof may take: mostly it takes milliseconds


@with_progress("plan")
def plan_path(
    hexapod: Hexapod,
    start: PoseLike,
    goal: PoseLike,
    requirements: PathRequirements | float,
    *,
    objective: Objective = "length",
    timing: LegSpeed | float = 1.0,
    certify: bool = False,
    seed: int = 0,
    progress: ProgressLike = None,
) -> Plan:
    """Plan a path between two poses on which the stability index and other requirements are kept.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    start, goal : Pose or array_like
        Ends of the path, each a Pose or x, y, z (m), roll, pitch, yaw (rad).
    requirements : PathRequirements or float
        What is kept all along, or just the least index, rad/s.
    objective : {"length", "time"}, optional
        What is made least. "time" needs a LegSpeed as `timing`.
    timing : LegSpeed or float, optional
        What the actuators can do, or the duration, s.
    certify : bool, optional
        Whether the bound on the index is also proved at every pose of the path: `certificate` of the plan. One that
        keeps it by less than 1e-6 of it may stay undecided.
    seed : int, optional
        Seed of the search. The same seed gives the same path.
    progress : callable or False, optional
        Called with the share done, 0 to 1: the search is the first half of it, smoothing the second.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

    Returns
    -------
    Plan
        The path, the straight line for comparison, and how well both keep the requirements.

    Raises
    ------
    PathError
        If an end breaks a requirement, or no path is found; the message says which requirement stands in the way.
    SingularPoseError
        If singular poses lie between start and goal on any path.
    PoseError
        If an end is not one pose that the legs can take.
    ArgumentError
        If another argument has a wrong value.
    MissingExtraError
        If OMPL is needed and not installed.

    See Also
    --------
    path_index : the index along a trajectory.
    plan_slice : a map of the index around a planned path.

    Notes
    -----
    The bound on the index is that of [1]_, conclusion 1. Where the straight line does not keep the requirements, BIT*
    [2]_ (from OMPL) finds a way round, on the side of the singular poses where the ends are. SLSQP [3]_ then makes it
    short or quick and smooth. A path is taken only where it passes no singular pose and the minima of all its margins,
    refined between 800 instants, are >= 0. Where the design limits forces, speeds, accelerations or power of the legs,
    a path timed by a LegSpeed takes as long as it needs to keep them; one of a given duration that exceeds them is
    refused, with the duration in which it would keep them.

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration (2007).
    .. [2] J. D. Gammell, S. S. Srinivasa and T. D. Barfoot, "Batch Informed Trees (BIT*)", IEEE International
       Conference on Robotics and Automation (2015).
    .. [3] D. Kraft, "A software package for sequential quadratic programming", DFVLR-FB 88-28 (1988).

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i")
    >>> plan = fx.plan_path(hexapod, [0, 0, 0.89, 0, 0, 0], [0.1, 0, 0.89, 0, 0, 0], 90.0, timing=2.0)
    >>> plan.path.duration, round(plan.least_index, 1)
    (2.0, 173.1)
    """
    task = PlanningTask(hexapod, start, goal, requirements, objective=objective, timing=timing)
    report = progress or (lambda share: None)
    line = np.stack([task.ends[0], task.ends[1]])
    straight = task.path(resampled(line, WAYPOINTS[0]))
    straight_margin = task.margin(straight)
    if straight_margin >= 0 and objective == "length":
        return _certified(task.plan(straight, straight, None, 0), hexapod, certify)
    if straight_margin >= 0:
        rough, batches = line, 0
    else:
        rough, batches = task.explore(seed, lambda share: report(0.5 * min(share, 1.0)))
    path = task.smoothed(rough, lambda share: report(0.5 + 0.5 * share))
    corners = None if batches == 0 else task.chart.poses(rough * task.scale)
    return _certified(task.plan(path, straight, corners, batches), hexapod, certify)


def _certified(plan: Plan, hexapod: Hexapod, certify: bool) -> Plan:
    """The plan with a certificate, where one is asked for."""
    if not certify:
        return plan
    needed = plan.requirements
    proof = certify_index(hexapod, plan.path, at_least=needed.index, joint=needed.joint, time_limit=LONGEST)
    return replace(plan, certificate=proof)
