"""The study of `flexapod sweep`."""

from __future__ import annotations

import logging
import math
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.given import needed
from flexapod.cli.options.poses import box_of, grid_of, read_poses
from flexapod.cli.options.sweep import DEFAULT_POINTS, Options
from flexapod.cli.output.interrupt import CutShort, OutOfTime, Stopping
from flexapod.cli.output.progress import PoseProgress
from flexapod.cli.output.stages import Report
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError
from flexapod.plots import sweep as plots
from flexapod.plots import sweep_axes
from flexapod.report.studies.sweep import study
from flexapod.report.study import Study
from flexapod.workspace.box import BITS, Box
from flexapod.workspace.pose_sets import PoseSet, given_poses
from flexapod.workspace.quantities import QUANTITIES, chosen
from flexapod.workspace.sampling import low_discrepancy, random_poses
from flexapod.workspace.store.dask_cluster import cluster
from flexapod.workspace.store.file_formats import check_size, save
from flexapod.workspace.store.reading import open_sweep
from flexapod.workspace.store.store import SweepStore
from flexapod.workspace.summary import summarise
from flexapod.workspace.sweeping import sweep
from flexapod.workspace.worst import WorstPose, worst_pose

if TYPE_CHECKING:
    import xarray as xr

T = TypeVar("T")


def compute(options: Options, report: Report) -> Study:
    """The sweep that the options ask for, its summary, its worst pose and its figure."""
    hexapod = common.load_design(options.design, options.changes)
    points, box = _points(hexapod, options)
    quantities = _quantities(hexapod, options.quantities)
    if options.worst and box is None:
        raise click.UsageError("--worst looks for the worst pose of a box. Give --box or --around.")
    if not options.streamed and (options.resume or options.scheduler or options.part or options.time_limit):
        raise click.UsageError(
            "--resume, --scheduler, --part and --time-limit need a store to write to. Give --out NAME.zarr."
        )
    needed(options.streamed, "a store, which --out NAME.zarr is", "chunk", "keep_poses")
    needed(options.scheduler, "the cluster of --scheduler", "timeout")
    needed(options.figure, "the picture, which --figure asks for", "level")
    needed(box is not None, "the points of --box or --around; a grid or file has its own poses", "seed")
    if options.figure is not None:
        figures.check(options.figure)
        sweep_axes.check_swept(points.dims, quantities)
    found, complete = (_streamed if options.streamed else _in_memory)(hexapod, points, quantities, options)
    if not complete:  # there are other parts
        return study(hexapod, found, options.out, None, None)
    everywhere, notes = options.all_poses, list[str]()

    def judged(make: Callable[[], T]) -> T | None:
        """What is made of the poses that count. Where none does, the numbers that were written are not lost with it."""
        try:
            return make()
        except PoseError as error:
            if options.out is None:
                raise
            notes.append(f"{options.out} was written, but {error}")
            return None

    if options.figure is not None:
        judged(lambda: _draw(found, options))
    summary = worst = None
    if options.summary and "omega_1" in found:
        summary = judged(lambda: summarise(found, options.at_least, all_poses=everywhere))
    if options.worst and box is not None:
        worst = judged(lambda: _worst(hexapod, box, options, report))
    notes = list(dict.fromkeys(notes))
    return study(hexapod, found, options.out, summary, worst, all_poses=everywhere, notes=notes)


def _worst(hexapod: Hexapod, box: Box, options: Options, report: Report) -> WorstPose:
    return worst_pose(
        hexapod,
        box,
        joint=options.joint,
        seed=options.seed,
        threads=options.threads,
        all_poses=options.all_poses,
        progress=lambda share: report("worst pose", share),
    )


def _draw(found: xr.Dataset, options: Options) -> None:
    assert options.figure is not None
    draw = partial(plots.auto, found, options.level, all_poses=options.all_poses)
    figures.write(draw, options.figure, str(found.attrs["design"]))
    click.echo(f"wrote {options.figure}", err=True)


def _points(hexapod: Hexapod, options: Options) -> tuple[PoseSet, Box | None]:
    ways = [bool(options.box or options.around), bool(options.grid), options.poses is not None]
    if sum(ways) != 1:
        raise click.UsageError(
            "give one set of poses: --around M DEG, --box NAME=LEAST:LARGEST,..., --grid NAME=FIRST:LAST:COUNT,... "
            "or --poses FILE."
        )
    if not ways[0]:
        if options.points is not None or options.even:
            raise click.UsageError(
                "--points and --low-discrepancy go with --box or --around; a grid or file has its own poses."
            )
        found = grid_of(hexapod, options.grid) if ways[1] else given_poses(read_poses(options.poses))  # type: ignore[arg-type]
        return found, None
    box = box_of(hexapod, options.box, options.around)
    make, count = low_discrepancy if options.even else random_poses, options.points or DEFAULT_POINTS
    if options.even and count > 2**BITS:
        raise click.UsageError(f"--points is {count}; --low-discrepancy has {2**BITS} points. Leave it out for more.")
    return make(box, count, seed=options.seed), box


def _quantities(hexapod: Hexapod, text: str) -> tuple[str, ...]:
    """What is asked for, and of a design with limits whether they are kept."""
    names = [name.strip() for name in text.split(",") if name.strip()]
    limits = ("within_limits",) if names and hexapod.limits.given else ()
    return tuple(QUANTITIES) if names == ["all"] else chosen((*names, *limits), hexapod)


def _in_memory(
    hexapod: Hexapod, points: PoseSet, quantities: tuple[str, ...], options: Options
) -> tuple[xr.Dataset, bool]:
    check_size(options.out or Path("sweep.nc"), points.count, quantities)
    found = sweep(hexapod, points, quantities=quantities, joint=options.joint, threads=options.threads)
    if options.out is not None:
        save(found, options.out)
        click.echo(f"wrote {options.out}", err=True)
    return found, True


def _streamed(
    hexapod: Hexapod, points: PoseSet, quantities: tuple[str, ...], options: Options
) -> tuple[xr.Dataset, bool]:
    """The store that is written, and whether it is complete, as the last of its parts leaves it."""
    assert options.out is not None
    if options.scheduler is None:
        store = _store(hexapod, points, quantities, options)
        _run(store, options.threads, options)
    else:
        with cluster(options.scheduler, options.timeout) as workers:
            logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # what matters is raised, and told by us
            store = _store(hexapod, points, quantities, options)
            _run(store, workers, options)
    return open_sweep(options.out), store.complete


def _store(hexapod: Hexapod, points: PoseSet, quantities: tuple[str, ...], options: Options) -> SweepStore:
    assert options.out is not None
    given: dict[str, Any] = {"quantities": quantities, "joint": options.joint, "chunk": options.chunk}
    poses: dict[str, Any] = {"keep_poses": options.keep_poses}
    if options.part is not None:
        number, of = options.part
        store = SweepStore.join(options.out, hexapod, points, part=number, of=of, **given, **poses)
    elif options.resume:
        store = SweepStore.resume(options.out, hexapod, points, **given)
    else:
        store = SweepStore.create(options.out, hexapod, points, **given, **poses)
    if store.damaged:
        more = f" and {len(store.damaged) - 1} more" if len(store.damaged) > 1 else ""
        click.echo(f"damaged or missing in {options.out}, so computed anew: {store.damaged[0]}{more}", err=True)
    return store


def _run(store: SweepStore, workers: Any, options: Options) -> None:
    """Compute what is missing, with progress on standard error; exits when a signal or the time limit stopped it."""
    end = math.inf if options.time_limit is None else time.monotonic() + options.time_limit
    with Stopping() as stop, PoseProgress() as bar:
        state = store.run(
            workers, progress=lambda share: bar(store.state), stop=lambda: stop() or time.monotonic() > end
        )
    part = "" if options.part is None else "part {}/{}: ".format(*options.part)
    if state.done < state.total:
        told = f"{part}{state.done} of {state.total} poses in {store.job.path}. Go on with the same command"
        more = " and --resume" if options.part is None else ""
        if stop():
            raise CutShort(f"stopped with {told}{more}.", stop.signal)
        raise OutOfTime(f"the time is up, with {told}{more}.")
    click.echo(f"{part}{state.total} poses in {store.job.path}", err=True)
