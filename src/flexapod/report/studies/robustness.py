"""Robustness of the index to uncertain parameters, as a study."""

from __future__ import annotations

from typing import Any

from flexapod import plots
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import Caution
from flexapod.optimisation.uncertainty import Robustness, moves
from flexapod.pose import PoseLike
from flexapod.report.numbers import brief, file_name, percent, shown
from flexapod.report.studies import least_index
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table

MOST = 8  # parameters that the terminal shows
CUT = "Normal and lognormal distributions are cut off at four standard deviations; least and largest are their ends."


def study(hexapod: Hexapod, found: Robustness, over: str, pose: PoseLike | None = None) -> Study:
    """Distribution, worst case, and what matters most. over: the poses, in words. pose: where it is one, not home."""
    count, told = found.samples.sizes["sample"], found.samples.attrs
    beyond = told["poses_beyond_limits"]
    left = f" ({told['poses']} poses within the design's limits, {beyond} beyond them left out)" if beyond else ""
    poses = left or (f" ({told['poses']} poses)" if told["poses"] > 1 else "")
    spread = Drawing("spread", "How the index strays", lambda: plots.optimisation.spread(found),
                     f"{count} designs; at {over}{poses}.")  # fmt: skip
    drawn = f"{count} designs of a scrambled Sobol sequence, seed {told['seed']}; all parameters independent."
    sections = [Section("What is assumed", [_assumed(found)], [drawn]), Section(spread.title, [spread])]
    if found.sensitivity is not None:
        words = "Sobol indices: shares of the variance of the index, with 95 % confidence."
        importance = Drawing("importance", "What matters most", lambda: plots.optimisation.importance(found), words)
        sections.append(Section(importance.title, [importance, _shares(found)]))
    name, where = f"{file_name(hexapod.name)}-robust", "at home" if pose is None else "at the pose given"
    return Study(
        hexapod=hexapod,
        subject="robustness",
        about=f"The index where parameters are uncertain: at {over}{left}.",
        data=_data(hexapod, found, over),
        rows=_rows(found),
        sections=[*sections, Section("The worst case", [_worst(found)])],
        cautions=[
            *_cautions(found),
            *least_index.cautions(hexapod, pose, found.samples.attrs["joint"], f"The design as it is, {where}"),
        ],
        files={f"{name}.html": None, f"{name}.png": spread.draw},
    )


def _cautions(found: Robustness) -> list[Caution]:
    if moves(found.samples["index"].values):
        return []
    words = ", ".join(dict.fromkeys(one.words.partition(",")[0] for one in found.ranges.values()))
    return [Caution("unmoved", f"The index does not depend on what is uncertain here: {words}.")]


def _assumed(found: Robustness) -> Table:
    ranges = list(found.ranges.values())
    return Table(
        [
            Column("parameter", [one.words for one in ranges]),
            Column("unit", [one.unit for one in ranges]),
            Column("nominal", [one.nominal for one in ranges], digits=5),
            Column("least", [brief(one.low, 5) for one in ranges]),
            Column("largest", [brief(one.high, 5) for one in ranges]),
            Column("distribution", [one.distribution for one in ranges]),
        ],
        CUT if any("normal" in one.distribution for one in ranges) else "",
    )


def _worst(found: Robustness) -> Table:
    words = [found.ranges[name].words for name in found.worst_at]
    units = [found.ranges[name].unit for name in found.worst_at]
    values = list(found.worst_at.values())
    note = f"{found.agreed} of {found.searches} searches ended at this index: the fewer, the less sure it is."
    return Table([Column("parameter", words), Column("unit", units), Column("value", values, digits=5)], note)


def _rows(found: Robustness) -> list[Row]:
    quantiles = ", ".join(f"{100 * q:g} %: {value:.6g}" for q, value in found.quantiles.items())
    below, seed = f"rad/s, {percent(found.worst / found.nominal - 1, 1)}", found.samples.attrs["seed"]
    return [
        Row("Index as designed", found.nominal, "rad/s", 5),
        Row("99 % of designs are above", found.quantiles[0.01], "rad/s", 5, on="page"),
        Row("Worst case", found.worst, below, 5, f"({found.agreed} of {found.searches} searches)"),
        Row("Mean and deviation", found.mean, f"\u00b1 {shown(found.deviation, 3)} rad/s", 5),
        Row("quantiles", quantiles, "rad/s", on="terminal"),
        Row("drawn", str(found.samples.sizes["sample"]), "designs", note=f"seed {seed}", on="terminal"),
    ]


def _shares(found: Robustness) -> Table:
    assert found.sensitivity is not None
    told = found.sensitivity.sortby("total", ascending=False).isel(parameter=slice(0, MOST))
    shares = [
        f"{total:.3f} ± {confidence:.3f}"
        for total, confidence in zip(told.total.values, told.total_confidence.values, strict=True)
    ]
    words = [found.ranges[str(name)].words for name in told.parameter.values]
    columns = [Column("parameter", words), Column("share", shares)]
    return Table(columns, title="Shares of the variance, with interactions (95 % confidence)", on="terminal")


def _data(hexapod: Hexapod, found: Robustness, over: str) -> dict[str, Any]:
    data: dict[str, Any] = {
        **origin(hexapod),
        "over": over,
        "nominal_rad_s": found.nominal,
        "mean_rad_s": found.mean,
        "deviation_rad_s": found.deviation,
        "quantiles_rad_s": found.quantiles,
        "worst_rad_s": found.worst,
        "worst_at": found.worst_at,
        "worst_searches": found.searches,
        "worst_agreed": found.agreed,
        "parameters": {name: one._asdict() for name, one in found.ranges.items()},
        "samples": found.samples.sizes["sample"],
        "poses": found.samples.attrs["poses"],
        "poses_beyond_limits": found.samples.attrs["poses_beyond_limits"],
        "seed": found.samples.attrs["seed"],
        "joint": found.samples.attrs["joint"],
    }
    if found.sensitivity is not None:
        names = found.sensitivity.parameter.values.tolist()
        for kind in ("first", "total", "first_confidence", "total_confidence"):
            data[f"sobol_{kind}"] = dict(zip(names, found.sensitivity[kind].values.tolist(), strict=True))
    return data
