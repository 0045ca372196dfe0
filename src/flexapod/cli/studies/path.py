"""The study of `flexapod path`."""

from __future__ import annotations

import math
from dataclasses import replace

import click
import numpy as np

from flexapod.certificates.index import certify
from flexapod.cli.options import common, payloads, waypoints
from flexapod.cli.options.given import needed
from flexapod.cli.options.path import Options
from flexapod.cli.output.stages import Report
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError, SingularPoseError
from flexapod.mechanics.inputs import as_point
from flexapod.paths.analysis import path_index
from flexapod.paths.leg_speed import LegSpeed
from flexapod.paths.loads import path_loads
from flexapod.paths.motor_loads import motor_loads
from flexapod.paths.payloads import payload_loads
from flexapod.paths.plan import Plan, plan_slice
from flexapod.paths.planning import LONGEST, plan_path
from flexapod.paths.requirements import PathRequirements
from flexapod.paths.trajectory import Trajectory
from flexapod.pose import Pose
from flexapod.report.studies.path import PathFindings, study
from flexapod.report.study import Study

_PLANNED = "a path that is planned, with --from and --to; that of FILE is as it stands there"
_OF_PLANS = ("duration", "leg_rate", "leg_acceleration", "condition", "clearance", "objective", "limits", "seed")


def compute(options: Options, report: Report) -> Study:
    """The index along the path of the options, given or planned."""
    hexapod = common.load_design(options.design, options.changes)
    if options.hold is not None and hexapod.drive is None:
        raise click.UsageError(f"--hold is for motors, and {hexapod.name!r} has none. Add [drive] to the design.")
    as_point(hexapod, options.point)
    cases = payloads.read(options.payload, options.payloads)
    found = _given(hexapod, options) if _is_file(options) else _planned(hexapod, options, report)
    if cases:
        side = payload_loads(hexapod, found.path, cases, joint=options.joint, point=options.point)
        found = replace(found, cases=side)
    if hexapod.drive is not None:
        found = _with_motors(hexapod, found, options.hold or 0.0)
    return study(hexapod, found, None if found.plan is None else waypoints.written(found.path))


def _with_motors(hexapod: Hexapod, found: PathFindings, hold: float) -> PathFindings:
    """What the motors do besides, as the design is and with each payload."""
    motors = motor_loads(hexapod, found.loads, hold=hold)
    cases = None if found.cases is None else motor_loads(hexapod, found.cases, hold=hold)
    return replace(found, motors=motors, case_motors=cases)


def _is_file(options: Options) -> bool:
    ends = (options.start is not None) + (options.goal is not None)
    if options.file is not None and ends == 0:
        needed(False, _PLANNED, *_OF_PLANS)
        return True
    if options.file is None and ends == 2:
        needed(False, "the motion of a FILE; a planned path has --from and --to", "home_time", "ends")
        if options.bound is None:
            raise click.UsageError("a path is planned to keep the index above a bound. Give --bound RAD_S.")
        return False
    raise click.UsageError("give a FILE of waypoints, or --from and --to to plan a path between two poses.")


def _given(hexapod: Hexapod, options: Options) -> PathFindings:
    assert options.file is not None
    path = given = waypoints.read(options.file, options.ends, _origin(hexapod, options))  # type: ignore[arg-type]
    if options.home_time is not None:
        path = given.between(common.home_for(hexapod, "--home-time"), options.home_time)
    try:
        index = path_index(hexapod, path, bound=options.bound, joint=options.joint)
    except (SingularPoseError, PoseError) as error:
        raise type(error)(f"{error}{_hint(hexapod, given, options)}") from error
    loads = path_loads(hexapod, path, joint=options.joint, point=options.point)
    proof = None
    if options.certify:
        proof = certify(hexapod, path, at_least=options.bound, joint=options.joint, time_limit=LONGEST)
    return PathFindings(path, index, loads, _size(hexapod), certificate=proof)


def _planned(hexapod: Hexapod, options: Options, report: Report) -> PathFindings:
    assert options.start is not None
    assert options.goal is not None
    assert options.bound is not None
    needed = PathRequirements(
        options.bound,
        condition_number=options.condition,
        clearance=options.clearance,
        limits=options.limits,
        joint=options.joint,
    )
    origin = _origin(hexapod, options)
    plan: Plan = plan_path(
        hexapod,
        _pose(options.start, origin),
        _pose(options.goal, origin),
        needed,
        objective=options.objective,  # type: ignore[arg-type]
        timing=_timing(options),
        certify=options.certify,
        seed=options.seed,
        progress=lambda share: report("planning", share),
    )
    index = path_index(hexapod, plan.path, bound=options.bound, joint=options.joint)
    loads = path_loads(hexapod, plan.path, joint=options.joint, point=options.point)
    if plan.rough is None:
        return PathFindings(plan.path, index, loads, plan.size, plan=plan, certificate=plan.certificate)
    beside = path_index(hexapod, plan.straight, bound=options.bound, joint=options.joint, singular="keep")
    plane = plan_slice(hexapod, plan)
    return PathFindings(plan.path, index, loads, plan.size, beside, plan, plane, plan.certificate)


def _pose(six: tuple[float, ...], origin: Pose | None) -> Pose:
    pose = common.pose_of(six)
    return pose if origin is None else origin.displaced(pose)


def _origin(hexapod: Hexapod, options: Options) -> Pose | None:
    """What poses are measured from: the home pose with --from-home, or else the base."""
    return common.home_for(hexapod, "--from-home") if options.from_home else None


def _hint(hexapod: Hexapod, path: Trajectory, options: Options) -> str:
    """What may be wrong with a path that lies about the base's origin instead of the home pose."""
    home, places = hexapod.home, path.waypoints.position
    if options.from_home or home is None or np.linalg.norm(home.position) == 0:
        return ""
    from_base, from_home = (np.linalg.norm(places - place, axis=1).max() for place in (0.0, home.position))
    if from_base >= 0.5 * from_home:
        return ""
    return (
        f" The waypoints lie about the base's origin, {np.linalg.norm(home.position):.4g} m from the home pose; if "
        "they are measured from home, give --from-home."
    )


def _timing(options: Options) -> LegSpeed | float:
    speeds = [options.leg_rate, options.leg_acceleration]
    if speeds == [None, None]:
        return options.duration or 1.0
    if options.duration is not None:
        raise click.UsageError("--duration and --leg-rate or --leg-acceleration both time the path. Give one of them.")
    return LegSpeed(*(math.inf if speed is None else speed for speed in speeds))


def _size(hexapod: Hexapod) -> float:
    return math.sqrt(float((hexapod.platform_joints**2).sum(axis=1).mean()))
