"""`flexapod robust`: how far the stability index strays when parts of the design are uncertain."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.commands.optimise import out_option, threads_option, where_options
from flexapod.cli.options import common, problem
from flexapod.cli.output.stages import stages

if TYPE_CHECKING:
    from flexapod.optimisation.uncertainty import Robustness


@click.command()
@common.design_argument
@click.option(
    "--uncertain",
    multiple=True,
    metavar="KEY=SPREAD[%][,DISTRIBUTION][,together]",
    help="A number of the design that strays: legs.stiffness=10% or platform.mass=50,normal. Uniform by default: plus "
    "and minus the spread; also normal, lognormal, triangular. Legs stray one by one, unless `together`. Repeatable.",
)
@click.option("--payload", metavar="LEAST:LARGEST", help="Mass (kg) of a load on the platform beyond the design's.")
@click.option(
    "--payload-at",
    nargs=3,
    default=("0", "0", "0"),
    metavar="X Y Z",
    help="Where it is in the platform frame (m): each a number or LEAST:LARGEST.",
)
@where_options
@click.option("--samples", type=click.IntRange(2), default=2**14, show_default=True, help="Designs to draw.")
@click.option("--poses", type=click.IntRange(1), default=256, show_default=True, help="Poses of a workspace.")
@click.option(
    "--sensitivity",
    type=click.IntRange(0),
    default=1024,
    show_default=True,
    help="Base samples of the Sobol analysis, a power of two; 0 leaves it out.",
)
@click.option("--seed", type=int, default=0, show_default=True)
@threads_option
@out_option
@common.set_option
@common.joint_option
@common.json_option
def command(design: str, changes: tuple[str, ...], out: Path | None, as_json: bool, **given: Any) -> None:
    """Distribution and worst case of the stability index of DESIGN, and which uncertain parameter matters most.

    \b
    flexapod robust motion-base --uncertain legs.stiffness=15% --payload 0:500 --payload-at -0.5:0.5 -0.5:0.5 0.5:1.5
    """
    from flexapod.optimisation.uncertainty import Payload, robustness

    hexapod = common.load_design(design, changes)
    over = problem.where(hexapod, given["pose"], given["box"], given["around"])
    straying = problem.uncertain(given["uncertain"])
    if given["payload"] is not None:
        at = tuple(problem.span("--payload-at", text) for text in given["payload_at"])
        straying.append(Payload(problem.span("--payload", given["payload"]), at))  # type: ignore[arg-type]
    if not straying:
        raise click.UsageError("nothing strays. Give --uncertain KEY=SPREAD or --payload LEAST:LARGEST.")
    options = {name: given[name] for name in ("samples", "poses", "sensitivity", "joint", "seed", "threads")}
    with stages(as_json) as report:
        found = robustness(hexapod, straying, over, progress=report, **options)
    files = []
    words = "home" if over is None else repr(over)
    if out is not None or not as_json:
        files = _write(found, hexapod, words, common.output_directory(Path() if out is None else out))
    if as_json:
        common.print_json(
            {"design": hexapod.name, "digest": hexapod.digest, "over": words, **_plain(found), "files": files}
        )
        return
    _show(found, words)
    for file in files:
        click.echo(f"wrote {file}")


def _write(found: Robustness, hexapod: Any, over: str, directory: Path) -> list[str]:
    from flexapod.plots import optimisation
    from flexapod.report.studies.optimisation import robust_page

    page, figure = (directory / f"{common.file_name(hexapod.name)}-robust.{kind}" for kind in ("html", "png"))
    common.write_file(page, robust_page(found, hexapod, f"at {over}"))
    common.save_figure(optimisation.spread(found), figure)
    return [str(page), str(figure)]


def _plain(found: Robustness) -> dict[str, Any]:
    told: dict[str, Any] = {
        "nominal_rad_s": found.nominal,
        "mean_rad_s": found.mean,
        "deviation_rad_s": found.deviation,
        "quantiles_rad_s": found.quantiles,
        "worst_rad_s": found.worst,
        "worst_at": found.worst_at,
        "samples": found.samples.sizes["sample"],
    }
    if found.sensitivity is not None:
        names = found.sensitivity.parameter.values.tolist()
        for kind in ("first", "total", "first_confidence", "total_confidence"):
            told[f"sobol_{kind}"] = dict(zip(names, found.sensitivity[kind].values.tolist(), strict=True))
    return told


def _show(found: Robustness, over: str) -> None:
    click.echo(f"index at {over}: {found.nominal:.6g} rad/s as designed")
    click.echo(f"  mean {found.mean:.6g}, deviation {found.deviation:.4g} rad/s")
    click.echo("  " + ", ".join(f"{100 * q:g} %: {value:.6g}" for q, value in found.quantiles.items()))
    click.echo(f"  worst case {found.worst:.6g} rad/s, where")
    for name, value in found.worst_at.items():
        click.echo(f"    {name} = {value:.6g}")
    if found.sensitivity is not None:
        click.echo("  shares of the variance, with interactions (95 % confidence):")
        told = found.sensitivity.sortby("total", ascending=False)
        for name in told.parameter.values[:8].tolist():
            one = told.sel(parameter=name)
            click.echo(f"    {name}: {float(one.total):.3f} ± {float(one.total_confidence):.3f}")
