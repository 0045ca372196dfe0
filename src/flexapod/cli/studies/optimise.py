"""The study of `flexapod optimise`."""

from __future__ import annotations

import json
import math
import sys

import click

from flexapod.cli.options import common, problem
from flexapod.cli.options.optimise import Options
from flexapod.cli.output.interrupt import Stopping
from flexapod.cli.output.progress import TrialProgress
from flexapod.errors import InfeasibleError
from flexapod.optimisation.design_results import OptimalDesign
from flexapod.optimisation.design_search import optimise
from flexapod.optimisation.pareto import ParetoFront, pareto_front
from flexapod.progress import in_terminal
from flexapod.report.studies import optimisation as studies
from flexapod.report.study import Study


def compute(options: Options) -> Study:
    """The design, or the front of designs, that the options ask for. The first interrupt ends the search early."""
    hexapod = common.load_design(options.design, options.changes)
    aim = problem.objective(hexapod, options.pose, options.box, options.around, options.mean)
    if options.certify and options.against is not None:
        raise click.UsageError("--certify proves the index of one design, --against gives many. Leave one of them out.")
    varied, kept = problem.variables(options.vary), problem.constraints(options.keep)
    found: OptimalDesign | ParetoFront
    with Stopping() as stop, TrialProgress() as bar:
        if in_terminal() and not options.as_json:
            bar(0, options.trials, math.nan)  # at once: to judge the design as it is takes a while
        settings = {**options.settings(), "on_trial": bar, "stop": stop}
        try:
            if options.against is None:
                own = {"sampler": options.sampler, "verify": options.verify, "certify": options.certify}
                found = optimise(hexapod, varied, aim, kept, **own, **settings)  # type: ignore[arg-type]
            else:
                other = problem.keep(options.against)
                found = pareto_front(hexapod, varied, other, aim, kept, refine=options.refine, **settings)
        except InfeasibleError as error:
            if stop.signal is None:
                raise
            _nothing_yet(error, options)
            sys.exit(128 + stop.signal)
    if stop.signal is not None:
        after = f"stopped after {found.history.sizes['trial']} trials; the best so far follows. {_kept(options)}"
        click.echo(after, err=True)
    if isinstance(found, ParetoFront):
        return studies.front(found, repr(aim))
    return studies.optimal(found, repr(aim), options.joint)


def _kept(options: Options) -> str:
    if options.study:
        return f"Go on with the same command: {options.study}"
    return "The trials themselves are not kept without --study."


def _nothing_yet(error: InfeasibleError, options: Options) -> None:
    """Say that a search was cut short before it had a result."""
    words = f"stopped: {error} {_kept(options)}"
    told = json.dumps({"error": words, "kind": type(error).__name__, "cut_short": True})
    click.echo(told if options.as_json else words, err=True)
