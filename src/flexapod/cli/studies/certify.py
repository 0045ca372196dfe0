"""The study of `flexapod certify`."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from flexapod.certificates.certificate import Certificate
from flexapod.certificates.checking import check_certificate
from flexapod.certificates.claims import certify_condition_number, certify_limits, certify_regular
from flexapod.certificates.file import read_certificate, write_certificate
from flexapod.certificates.index import certify
from flexapod.certificates.largest import certified_box
from flexapod.cli.options import common, problem, waypoints
from flexapod.cli.options.certify import Options
from flexapod.cli.options.given import needed, others
from flexapod.cli.output.interrupt import Stopping
from flexapod.cli.output.stages import Report
from flexapod.cli.studies.earlier_proof import Earlier
from flexapod.design.hexapod import Hexapod
from flexapod.output_files import make_directory
from flexapod.report.numbers import file_name
from flexapod.report.studies.certificate import study
from flexapod.report.study import Study
from flexapod.workspace.store.dask_cluster import cluster

_OF_CHECKS = ("time_limit", "threads", "out", "as_json")  # options that a check has as well


def compute(options: Options, place: Path | None, report: Report) -> tuple[Study, list[Path]]:
    """The study of what the options ask for, and the files that are written. place: where to keep a certificate."""
    with Stopping() as stop:
        watch = {
            "time_limit": options.time_limit,
            "threads": options.threads,
            "progress": lambda share: report("decided, by volume", share),
            "stop": stop,
        }
        _check_needs(options)
        if options.check is not None:
            return study(_checked(options, watch), checked=True), []
        if options.design is None:
            raise click.UsageError("give a DESIGN to certify, or --check FILE.")
        hexapod = common.load_design(options.design, options.changes)
        _check_claim(options)
        path = None if place is None else make_directory(place) / f"{file_name(hexapod.name)}-certificate.json"
        if options.largest:
            return _largest(hexapod, options, path, watch)
        with Earlier(None if options.resume else path) as earlier:
            found = _certified(hexapod, options, path, watch)
            note = earlier.beside(found)
    told = study(found)
    return replace(told, cautions=[*told.cautions, *note]), [] if path is None else [path]


def _checked(options: Options, watch: dict[str, Any]) -> Certificate:
    assert options.check is not None
    given = read_certificate(options.check)
    if options.design is not None:
        digest = common.load_design(options.design, options.changes).digest
        if digest != given.nominal:
            raise click.UsageError(
                f"{options.check} is a certificate of {given.hexapod.name!r}, digest {given.nominal}; the digest of "
                f"{options.design} is {digest}. It proves nothing of that one."
            )
    return check_certificate(given, **watch)


def _check_needs(options: Options) -> None:
    """Raises UsageError where an option counts for nothing."""
    checked = "a proof; that in FILE of --check has its own claim, region and model"
    needed(options.check is None, checked, *others("design", "changes", "check", *_OF_CHECKS))
    needed(options.design or options.check is None, "DESIGN, which is not given", "changes")
    needed(options.path_file, "the path of --path", "ends", "from_home")
    needed(options.scheduler, "the cluster of --scheduler", "timeout")


def _check_claim(options: Options) -> None:
    """Raises UsageError where the options make no one claim."""
    index = options.at_least is not None or options.gap is not None
    claims = [index or options.largest, options.regular, options.limits, options.condition is not None]
    if sum(claims) > 1:
        raise click.UsageError("--at-least or --gap, --regular, --limits and --condition each make a claim. Give one.")
    if options.at_least is not None and options.gap is not None:
        raise click.UsageError("--at-least is what to prove, --gap how close the closest bound. Give one of them.")
    if options.largest and options.at_least is None:
        raise click.UsageError("--largest needs the bound that the box is to keep. Give --at-least.")
    if any(claims[1:]) and options.payload:
        raise click.UsageError("--payload is for the index: other claims depend on geometry alone.")
    if options.limits and options.within_limits:
        raise click.UsageError("--limits with --within-limits is true of every machine. Leave one of them out.")
    if options.largest and (options.scheduler or options.path_file or options.pose):
        raise click.UsageError("--largest is for --around or --box, without --scheduler, --path and --pose.")
    if options.resume and options.as_json and options.out is None:
        raise click.UsageError("--resume goes on with a file, and --json writes none. Give --out DIR.")


def _region(hexapod: Hexapod, options: Options) -> Any:
    where = problem.where(hexapod, options.pose, options.box, options.around)
    if options.path_file is None:
        return where
    if where is not None:
        raise click.UsageError("--path and --pose, --box or --around each say where. Give one of them.")
    origin = common.home_for(hexapod, "--from-home") if options.from_home else None
    return waypoints.read(options.path_file, options.ends, origin)  # type: ignore[arg-type]


def _uncertain(options: Options) -> list[Any]:
    return problem.uncertain(options.uncertain) + problem.payloads(options.payload, options.payload_at)


def _certified(hexapod: Hexapod, options: Options, path: Path | None, watch: dict[str, Any]) -> Certificate:
    region = _region(hexapod, options)
    with cluster(options.scheduler, options.timeout) if options.scheduler else nullcontext() as workers:
        given = {**watch, "path": path, "resume": options.resume, "cluster": workers}
        if options.limits:
            return certify_limits(hexapod, region, joint=options.joint, uncertain=_uncertain(options), **given)
        given |= {"within_limits": options.within_limits, "uncertain": _uncertain(options)}
        if options.regular:
            return certify_regular(hexapod, region, **given)
        if options.condition is not None:
            return certify_condition_number(hexapod, region, at_most=options.condition, **given)
        given |= {"joint": options.joint, "gap": options.gap or 0.01}
        return certify(hexapod, region, at_least=options.at_least, **given)


def _largest(hexapod: Hexapod, options: Options, path: Path | None, watch: dict[str, Any]) -> tuple[Study, list[Path]]:
    assert options.at_least is not None
    shape: Any = problem.where(hexapod, None, options.box, options.around)
    if shape is None:
        raise click.UsageError("--largest needs a shape. Give --around M DEG or --box NAME=LEAST:LARGEST,....")
    found = certified_box(
        hexapod,
        shape,
        options.at_least,
        joint=options.joint,
        within_limits=options.within_limits,
        uncertain=_uncertain(options),
        path=None if path is None else path.with_name(f"{file_name(hexapod.name)}-largest.json"),
        resume=options.resume,
        **watch,
    )
    if path is not None:
        write_certificate(found.certificate, path)
    return study(found.certificate, largest=found), [] if path is None else [path]
