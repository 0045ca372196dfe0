"""`flexapod optimise`: a better design, or the front of the best ones."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common, problem

if TYPE_CHECKING:
    from flexapod.conventions import JointModel
    from flexapod.optimisation.design_search import OptimalDesign
    from flexapod.optimisation.objectives import Objective
    from flexapod.optimisation.pareto import ParetoFront

where_options = common.stack(
    common.pose_option,
    click.option(
        "--around",
        type=float,
        nargs=2,
        default=None,
        metavar="M DEG",
        help="The workspace of every coordinate of the home pose plus and minus these; it moves with home.",
    ),
    click.option(
        "--box", multiple=True, metavar="NAME=LEAST:LARGEST,...", help="A workspace in the base frame (m, degrees)."
    ),
)
out_option = common.out_option(
    "Where to write the report (HTML), figures (PNG) and designs (TOML). Default: here; with --json: no files."
)
threads_option = click.option("--threads", type=click.IntRange(1), default=None, help="Default: all cores.")


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str
    vary: tuple[str, ...]
    keep: tuple[str, ...]
    against: str | None
    pose: tuple[float, ...] | None
    around: tuple[float, float] | None
    box: tuple[str, ...]
    mean: Path | None
    trials: int
    study: Path | None
    sampler: str
    seed: int
    points: int
    verify: int
    refine: int
    threads: int | None
    out: Path | None
    changes: tuple[str, ...]
    joint: JointModel
    as_json: bool

    def settings(self) -> dict[str, Any]:
        names = ("trials", "study", "seed", "points", "verify", "threads", "joint")
        return {name: getattr(self, name) for name in names}


@click.command()
@common.design_argument
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="KEY=LEAST:LARGEST",
    help="A variable: a key of the design file, as platform.mass=20:40 or platform.joints_mm[:][2]=-5:5. +KEY adds to "
    "what is there, *KEY scales it, A,-B ties B to minus A. base.circle.radius, .half_angle, .turn, .height and the "
    "same of the platform keep three symmetric pairs of joints. Repeatable.",
)
@click.option(
    "--keep",
    multiple=True,
    metavar="NAME[_UNIT][=BOUND]",
    help=f"A constraint: {', '.join(problem.KEEPS)}. Without a bound: no worse than the design is now. Repeatable.",
)
@click.option(
    "--against", metavar="NAME", help="The Pareto front of the index against this (mass, footprint, cond, ...)."
)
@where_options
@click.option(
    "--mean",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    default=None,
    metavar="FILE",
    help="Raise the mean index over the poses of a file (x,y,z,roll,pitch,yaw in m, degrees).",
)
@click.option("--trials", type=click.IntRange(0), default=200, show_default=True, help="Of the global search.")
@click.option(
    "--study",
    type=click.Path(path_type=Path, dir_okay=False),
    default=None,
    metavar="FILE",
    help="Keep the trials in this SQLite file: to stop, to go on, to share the search between processes.",
)
@click.option("--sampler", type=click.Choice(["tpe", "sobol"]), default="tpe", show_default=True)
@click.option("--seed", type=int, default=0, show_default=True)
@click.option("--points", type=click.IntRange(1), default=2**12, show_default=True, help="Poses of a trial.")
@click.option("--verify", type=click.IntRange(2), default=2**17, show_default=True, help="Poses of the last sweep.")
@click.option("--refine", type=click.IntRange(0), default=12, show_default=True, help="Points of a front made exact.")
@threads_option
@out_option
@common.set_option
@common.joint_option
@common.json_option
def command(**given: Any) -> None:
    """Raise the stability index of DESIGN within constraints, and verify the result on a denser sweep.

    \b
    flexapod optimise mukherjee-ii --around 0.005 5 --keep footprint --keep stroke \\
        --vary base.circle.radius_mm=20:30 --vary platform.circle.radius_mm=30:60 \\
        --vary base.circle.half_angle_deg=5:55 --vary home.position_mm[2]=70:100
    """
    options = Options(**{field.name: given[field.name] for field in fields(Options)})
    hexapod = common.load_design(options.design, options.changes)
    aim = problem.objective(hexapod, options.pose, options.box, options.around, options.mean)
    varied, kept = problem.variables(options.vary), problem.constraints(options.keep)
    from flexapod.cli.output.interrupt import Stopping

    with Stopping() as stop, TrialProgress() as bar:
        settings = {**options.settings(), "progress": bar, "stop": stop}
        if options.against is None:
            from flexapod.optimisation.design_search import optimise

            found: Any = optimise(hexapod, varied, aim, kept, sampler=options.sampler, **settings)
        else:
            from flexapod.optimisation.pareto import pareto_front

            other = problem.keep(options.against)
            found = pareto_front(hexapod, varied, other, aim, kept, refine=options.refine, **settings)
    if stop.signal is not None:
        where = f"Go on with the same command: {options.study}" if options.study else "Nothing is kept without --study."
        click.echo(f"stopped after {found.history.sizes['trial']} trials. {where}", err=True)
    (_show_front if options.against else _show_design)(found, aim, options)


class TrialProgress:
    """Called with trials finished, trials wanted, and the best index so far."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )

        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[best]}"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
        )
        self._progress = Progress(*columns, console=Console(stderr=True))
        self._task: Any = None

    def __enter__(self) -> TrialProgress:
        self._progress.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._progress.stop()

    def __call__(self, done: int, wanted: int, best: float) -> None:
        if self._task is None:
            self._task = self._progress.add_task("trials", total=wanted, best="")
        words = f"best {best:.5g} rad/s" if best == best else "none feasible yet"
        finishing = done >= wanted
        self._progress.update(
            self._task,
            completed=done,
            best=words,
            description="finishing by gradients, verifying" if finishing else "trials",
        )


def _files(options: Options) -> Path | None:
    if options.out is None and options.as_json:
        return None
    return common.output_directory(Path() if options.out is None else options.out)


def _show_design(found: OptimalDesign, aim: Objective, options: Options) -> None:
    from flexapod.plots import optimisation
    from flexapod.report.studies.optimisation import optimal_page

    directory = _files(options)
    files = []
    if directory is not None:
        name = common.file_name(found.hexapod.name)
        files = [directory / f"{name}.toml", directory / f"{name}.html", directory / f"{name}.png"]
        common.write_file(files[0], found.hexapod.to_toml())
        common.write_file(files[1], optimal_page(found, repr(aim)))
        common.save_figure(optimisation.plan(found), files[2])
    if options.as_json:
        common.print_json(
            {
                "design": found.hexapod.name,
                "digest": found.hexapod.digest,
                "objective": repr(aim),
                "index_rad_s": found.index,
                "start_index_rad_s": found.start_index,
                "searched_index_rad_s": found.searched_index,
                "gain": found.gain,
                "variables": found.variables,
                "at_bounds": found.at_bounds,
                "coincident_frequencies": found.coincident,
                "verified_poses": found.verification.points,
                "worst_pose_m_rad": found.verification.pose,
                "constraints": [vars(check) for check in found.verification.checks],
                "trials": found.history.sizes["trial"],
                "gradient_evaluations": found.evaluations,
                "seconds": found.seconds,
                "files": [str(file) for file in files],
            }
        )
        return
    click.echo(f"{aim!r}: {found.start_index:.6g} -> {found.index:.6g} rad/s ({100 * found.gain:+.3g} %), verified at "
               f"{found.verification.points} poses")  # fmt: skip
    for name, value in found.variables.items():
        click.echo(f"  {name} = {value:.6g}" + ("  (on its bound)" if name in found.at_bounds else ""))
    for check in found.verification.checks:
        state = "kept" if check.kept else "BROKEN"
        click.echo(f"  {check.name}: {check.value:.6g} {check.unit}, at {check.side} {check.bound:.6g}: {state}")
    _wrote(files)


def _show_front(found: ParetoFront, aim: Objective, options: Options) -> None:
    from flexapod.plots import optimisation
    from flexapod.report.studies.optimisation import front_page

    directory = _files(options)
    files: list[Path] = []
    if directory is not None:
        name = common.file_name(found.hexapod.name)
        files = [directory / f"{name}-front.html", directory / f"{name}-front.png"]
        common.write_file(files[0], front_page(found, repr(aim)))
        common.save_figure(optimisation.front(found), files[1])
        for hexapod in found.designs:
            files.append(directory / f"{common.file_name(hexapod.name)}.toml")
            common.write_file(files[-1], hexapod.to_toml())
    if options.as_json:
        common.print_json(
            {
                "objective": repr(aim),
                "against": found.name,
                "unit": found.unit,
                "start": {"index_rad_s": found.start[0], "against": found.start[1]},
                "index_rad_s": found.index,
                "against_values": found.against,
                "variables": dict(zip(found.names, found.variables.T, strict=True)),
                "trials": found.history.sizes["trial"],
                "files": [str(file) for file in files],
            }
        )
        return
    click.echo(f"{aim!r} against {found.name}; the design begun with has {found.start[0]:.6g} rad/s at "
               f"{found.start[1]:.6g} {found.unit}".rstrip())  # fmt: skip
    for index, value in zip(found.index, found.against, strict=True):
        click.echo(f"  {index:.6g} rad/s at {value:.6g} {found.unit}".rstrip())
    _wrote(files)


def _wrote(files: list[Path]) -> None:
    for file in files:
        click.echo(f"wrote {file}")
