"""`flexapod path`: the stability index along a path, or a path that keeps it above a bound."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path as File
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common
from flexapod.cli.output.stages import Report, stages

if TYPE_CHECKING:
    from flexapod.conventions import JointModel
    from flexapod.design.hexapod import Hexapod
    from flexapod.paths.planning import LegSpeed, Plan
    from flexapod.report.studies.path import PathFindings

_POSE: dict[str, Any] = {"type": float, "nargs": 6, "default": None, "metavar": "X Y Z ROLL PITCH YAW"}


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str
    changes: tuple[str, ...]
    joint: JointModel
    as_json: bool
    file: File | None
    start: tuple[float, ...] | None
    goal: tuple[float, ...] | None
    bound: float | None
    ends: str
    objective: str
    duration: float | None
    leg_rate: float | None
    leg_acceleration: float | None
    condition: float | None
    clearance: float | None
    limits: bool
    seed: int
    out: File | None


_positive = click.FloatRange(min=0, min_open=True)
_options = common.stack(
    click.argument("file", type=click.Path(path_type=File, dir_okay=False), required=False),
    click.option("--from", "start", **_POSE, help="Plan from this pose (m, degrees)."),
    click.option("--to", "goal", **_POSE, help="Plan to this pose (m, degrees)."),
    click.option("--bound", type=_positive, metavar="RAD_S", help="Least natural frequency that the path should keep."),
    click.option(
        "--ends",
        type=click.Choice(["rest", "free", "periodic"]),
        default="rest",
        show_default=True,
        help="How the path of FILE begins and ends.",
    ),
    click.option(
        "--least",
        "objective",
        type=click.Choice(["length", "time"]),
        default="length",
        show_default=True,
        help="What a planned path has least of; time needs --leg-rate or --leg-acceleration.",
    ),
    click.option("--duration", type=_positive, metavar="S", help="Duration of a planned path. Default: 1 s."),
    click.option("--leg-rate", type=_positive, metavar="M_S", help="Fastest rate of a leg; times a planned path."),
    click.option("--leg-acceleration", type=_positive, metavar="M_S2", help="Largest acceleration of a leg."),
    click.option("--condition", type=_positive, metavar="C", help="Most that cond(H) may be on a planned path."),
    click.option("--clearance", type=_positive, metavar="M", help="Least distance of leg axes on a planned path."),
    click.option("--limits/--no-limits", default=True, help="Whether a planned path keeps the design's limits."),
    click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of the planner's samples."),
    common.out_option("Where to write the report, figures and planned waypoints. Default: nothing is written."),
)


@click.command()
@common.design_argument
@_options
@common.set_option
@common.joint_option
@common.json_option
def command(**given: Any) -> None:
    """The stability index, leg forces and travel along a path of DESIGN, from FILE or planned.

    FILE is CSV with the columns t, x, y, z, roll, pitch, yaw (s, m, degrees) and, if wanted, weight.

    \b
    flexapod path mukherjee-i waypoints.csv --bound 150
    flexapod path mukherjee-i --from 0 0 0.89 0 -33 -10 --to 0 0 0.89 0 45 53 --bound 110 --out path
    """
    options = Options(**given)
    hexapod = common.load_design(options.design, options.changes)
    with stages(options.as_json) as report:
        found = _given(hexapod, options) if _is_file(options) else _planned(hexapod, options, report)
    written = [] if options.out is None else _write(hexapod, found, common.output_directory(options.out))
    result = _result(hexapod, found, written)
    if options.as_json:
        common.print_json(result)
    else:
        _show(hexapod, found, written)


def _is_file(options: Options) -> bool:
    ends = (options.start is not None) + (options.goal is not None)
    if options.file is not None and ends == 0:
        return True
    if options.file is None and ends == 2:
        if options.bound is None:
            raise click.UsageError("a path is planned to keep the index above a bound. Give --bound RAD_S.")
        return False
    raise click.UsageError("give a FILE of waypoints, or --from and --to to plan a path between two poses.")


def _given(hexapod: Hexapod, options: Options) -> PathFindings:
    from flexapod.cli.options.waypoints import read
    from flexapod.paths.analysis import path_index, path_loads
    from flexapod.report.studies.path import PathFindings

    assert options.file is not None
    path = read(options.file, options.ends)  # type: ignore[arg-type]
    index = path_index(hexapod, path, bound=options.bound, joint=options.joint)
    return PathFindings(path, index, path_loads(hexapod, path, joint=options.joint), _size(hexapod))


def _planned(hexapod: Hexapod, options: Options, report: Report) -> PathFindings:
    from flexapod.paths.analysis import path_index, path_loads
    from flexapod.paths.planning import plan_path, plan_slice
    from flexapod.paths.requirements import PathRequirements
    from flexapod.report.studies.path import PathFindings

    assert options.start is not None
    assert options.goal is not None
    assert options.bound is not None
    needed = PathRequirements(options.bound, options.condition, options.clearance, options.limits, joint=options.joint)
    plan: Plan = plan_path(
        hexapod,
        _pose(options.start),
        _pose(options.goal),
        needed,
        objective=options.objective,  # type: ignore[arg-type]
        timing=_timing(options),
        seed=options.seed,
        progress=report,
    )
    index = path_index(hexapod, plan.path, bound=options.bound, joint=options.joint)
    loads = path_loads(hexapod, plan.path, joint=options.joint)
    if plan.rough is None:
        return PathFindings(plan.path, index, loads, plan.size, plan=plan)
    beside = path_index(hexapod, plan.straight, bound=options.bound, joint=options.joint, singular="keep")
    return PathFindings(plan.path, index, loads, plan.size, beside, plan, plan_slice(hexapod, plan))


def _pose(six: tuple[float, ...]) -> Any:
    from flexapod.pose import Pose

    return Pose.from_rpy(*six[:3], *(math.radians(angle) for angle in six[3:]))


def _timing(options: Options) -> LegSpeed | float:
    from flexapod.paths.planning import LegSpeed

    speeds = [options.leg_rate, options.leg_acceleration]
    if speeds == [None, None]:
        return options.duration or 1.0
    if options.duration is not None:
        raise click.UsageError("--duration and --leg-rate or --leg-acceleration both time the path. Give one of them.")
    return LegSpeed(*(math.inf if speed is None else speed for speed in speeds))


def _size(hexapod: Hexapod) -> float:
    return math.sqrt(float((hexapod.platform_joints**2).sum(axis=1).mean()))


def _write(hexapod: Hexapod, found: PathFindings, directory: File) -> list[str]:
    from flexapod.cli.options.waypoints import written
    from flexapod.plots import path as plots_path
    from flexapod.report.studies.path import page

    figures = {"index": plots_path.index_along(found.along, found.beside), "loads": plots_path.loads(found.loads)}
    if found.plane is not None:
        figures["plane"] = plots_path.plan_map(found.plane)
    files = []
    for name, figure in figures.items():
        files.append(directory / f"path-{name}.png")
        common.save_figure(figure, files[-1])
    if found.plan is not None:
        files.append(directory / "waypoints.csv")
        common.write_file(files[-1], written(found.path))
    files.append(directory / "path.html")
    common.write_file(files[-1], page(hexapod, found))
    return [str(file) for file in files]


def _result(hexapod: Hexapod, found: PathFindings, written: list[str]) -> dict[str, Any]:
    index, loads, plan = found.along, found.loads, found.plan
    result = {
        "design": hexapod.name,
        "digest": hexapod.digest,
        "duration_s": found.path.duration,
        "length_m": found.path.length(found.size),
        "radian_as_m": found.size,
        "least_index_rad_s": index.minimum,
        "least_index_at_s": index.minimum_time,
        "least_index_pose_m_deg": common.pose_numbers(index.minimum_pose),
        "bound_rad_s": index.bound,
        "above_bound": None if index.bound is None else index.above,
        "below_bound_s": index.below,
        "weighted_mean_index_rad_s": index.weighted_mean,
        "within_limits": bool(loads.within_limits.all()),
        "leg_stroke_m": loads.stroke.values,
        "leg_peak_force_N": loads.peak_force.values,
        "leg_peak_rate_m_s": abs(loads.leg_rate).max("time").values,
        "waypoints_s": found.path.times,
        "waypoints_m_deg": [common.pose_numbers(found.path.waypoints[i]) for i in range(len(found.path.times))],
        "files": written,
    }
    if plan is not None:
        result["plan"] = {
            "straight_length_m": plan.straight_length,
            "straight_least_index_rad_s": plan.straight_least_index,
            "least_margin": plan.margin,
            "batches": plan.batches,
        }
    return result


def _show(hexapod: Hexapod, found: PathFindings, written: list[str]) -> None:
    from flexapod.report.studies.path import cautions

    out, index = common.console(), found.along
    out.print(f"{hexapod.name}: {found.path!r}", markup=False)
    out.print(
        f"  least index {index.minimum:.5g} rad/s at {index.minimum_time:.4g} s, {index.minimum_pose!r}",
        markup=False,
        soft_wrap=True,
    )
    if index.bound is not None:
        words = "above it all along" if index.above else "BELOW it in places"
        out.print(f"  bound {index.bound:.5g} rad/s: {words}")
    out.print(f"  weighted mean index {index.weighted_mean:.5g} rad/s")
    if found.plan is not None:
        p = found.plan
        out.print(
            f"  length {p.length:.4g} m; the straight line has {p.straight_length:.4g} m and an index down to "
            f"{p.straight_least_index:.4g} rad/s",
            soft_wrap=True,
        )
    loads = found.loads
    travel, force = 1e3 * float(loads.stroke.max()), float(loads.peak_force.max())
    out.print(f"  legs: travel up to {travel:.4g} mm, force up to {force:.5g} N")
    common.print_warnings(cautions(found))
    for file in written:
        click.echo(f"Wrote {file}")
