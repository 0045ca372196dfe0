"""Robustness of the index to uncertain parameters, as a study."""

from __future__ import annotations

from functools import partial
from typing import Any

from flexapod import plots
from flexapod.design.hexapod import Hexapod
from flexapod.optimisation.uncertainty import Robustness
from flexapod.report.numbers import file_name, percent, shown
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table

MOST = 8  # parameters that the terminal shows


def study(hexapod: Hexapod, found: Robustness, over: str) -> Study:
    """Distribution, worst case, and what matters most. over: the poses, in words."""
    spread = Drawing("spread", "How the index strays", partial(plots.optimisation.spread, found),
                     f"{found.samples.sizes['sample']} designs; at {over}.")  # fmt: skip
    sections = [Section(spread.title, [spread])]
    if found.sensitivity is not None:
        words = "Sobol indices: shares of the variance of the index, with 95 % confidence."
        importance = Drawing("importance", "What matters most", partial(plots.optimisation.importance, found), words)
        sections.append(Section(importance.title, [importance, _shares(found)]))
    worst = [Column("parameter", list(found.worst_at)), Column("value", list(found.worst_at.values()), digits=5)]
    name = f"{file_name(hexapod.name)}-robust"
    return Study(
        hexapod=hexapod,
        subject="robustness",
        about=f"The index where parameters are uncertain: at {over}.",
        data=_data(hexapod, found, over),
        rows=_rows(found),
        sections=[*sections, Section("The worst case", [Table(worst, "In SI units.")])],
        files={f"{name}.html": None, f"{name}.png": spread.draw},
    )


def _rows(found: Robustness) -> list[Row]:
    quantiles = ", ".join(f"{100 * q:g} %: {value:.6g}" for q, value in found.quantiles.items())
    below = f"rad/s, {percent(found.worst / found.nominal - 1)}"
    return [
        Row("Index as designed", found.nominal, "rad/s", 5),
        Row("99 % of designs are above", found.quantiles[0.01], "rad/s", 5, on="page"),
        Row("Worst case", found.worst, below, 5),
        Row("Mean and deviation", found.mean, f"\u00b1 {shown(found.deviation, 3)} rad/s", 5),
        Row("quantiles", quantiles, "rad/s", on="terminal"),
    ]


def _shares(found: Robustness) -> Table:
    assert found.sensitivity is not None
    told = found.sensitivity.sortby("total", ascending=False).isel(parameter=slice(0, MOST))
    shares = [
        f"{total:.3f} ± {confidence:.3f}"
        for total, confidence in zip(told.total.values, told.total_confidence.values, strict=True)
    ]
    columns = [Column("parameter", [str(name) for name in told.parameter.values]), Column("share", shares)]
    return Table(columns, title="Shares of the variance, with interactions (95 % confidence)", on="terminal")


def _data(hexapod: Hexapod, found: Robustness, over: str) -> dict[str, Any]:
    data: dict[str, Any] = {
        "design": hexapod.name,
        "digest": hexapod.digest,
        "over": over,
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
            data[f"sobol_{kind}"] = dict(zip(names, found.sensitivity[kind].values.tolist(), strict=True))
    return data
