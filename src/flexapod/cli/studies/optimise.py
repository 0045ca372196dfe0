"""The study of `flexapod optimise`."""

from __future__ import annotations

import click

from flexapod.cli.options import common, problem
from flexapod.cli.options.optimise import Options
from flexapod.cli.output.interrupt import Stopping
from flexapod.cli.output.progress import TrialProgress
from flexapod.optimisation.design_results import OptimalDesign
from flexapod.optimisation.design_search import optimise
from flexapod.optimisation.pareto import ParetoFront, pareto_front
from flexapod.report.studies import optimisation as studies
from flexapod.report.study import Study


def compute(options: Options) -> Study:
    """The design, or the front of designs, that the options ask for. The first interrupt ends the search early."""
    hexapod = common.load_design(options.design, options.changes)
    aim = problem.objective(hexapod, options.pose, options.box, options.around, options.mean)
    varied, kept = problem.variables(options.vary), problem.constraints(options.keep)
    found: OptimalDesign | ParetoFront
    with Stopping() as stop, TrialProgress() as bar:
        settings = {**options.settings(), "on_trial": bar, "stop": stop}
        if options.against is None:
            found = optimise(hexapod, varied, aim, kept, sampler=options.sampler, verify=options.verify, **settings)
        else:
            other = problem.keep(options.against)
            found = pareto_front(hexapod, varied, other, aim, kept, refine=options.refine, **settings)
    if stop.signal is not None:
        where = f"Go on with the same command: {options.study}" if options.study else "Nothing is kept without --study."
        click.echo(f"stopped after {found.history.sizes['trial']} trials. {where}", err=True)
    if isinstance(found, ParetoFront):
        return studies.front(found, repr(aim))
    return studies.optimal(found, repr(aim))
