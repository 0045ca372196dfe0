"""A study that declares what it has is shown in the terminal, as a page, in a notebook and as JSON, with no more code."""

import dataclasses
import io
import json
import re

import matplotlib
import numpy as np
import pytest
import xarray as xr
from rich.console import Console

import flexapod as fx
from flexapod.cli.output.results import emit
from flexapod.mechanics.cautions import Caution
from flexapod.plots.style import new_figure
from flexapod.report import gather, page
from flexapod.report.study import Bars, Column, Drawing, Row, Section, Study, Table
from flexapod.report.terminal import show

matplotlib.use("Agg")


def figure():
    made = new_figure(3, 2)
    made.add_subplot().plot([0, 1], [0, 1])
    return made


@pytest.fixture
def study():
    table = Table(
        [Column("leg", ["1", "2"]), Column("force", np.array([1.23456, np.nan]), "N", 3, [True, False])], "A note."
    )
    bars = Bars(["mass + 1 %", "stiffness + 1 %"], [-0.004, 0.005], ["", "along x"], brief=[1])
    drawing = Drawing("line", "A line", figure, "Drawn.")
    return Study(
        hexapod=fx.load("motion-base"),
        subject="example",
        about="An <example>.",
        data={"index_rad_s": 12.5, "force_n": np.array([1.0, np.inf])},
        rows=[Row("Index", 12.5, "rad/s"), Row("only here", 3.0, on="terminal"), Row("Card", None, on="page")],
        sections=[Section("Forces", [drawing, table]), Section("Effects", [bars], ["Words."])],
        cautions=[Caution("example", "Beware of the dog.")],
        files={"line.png": drawing.draw, "forces.csv": lambda: "leg,force\n", "forces.nc": lambda: xr.Dataset({"a": 1.0}), "example.html": None},
        dataset=xr.Dataset({"a": 1.0}),
    )  # fmt: skip


def test_the_page_has_all_that_is_declared(study):
    text = page(study)
    for words in (
        "<h1>motion-base</h1>",
        "An &lt;example&gt;.",
        "12.50 <span>rad/s</span>",
        "Beware of the dog.",
        "A note.",
    ):
        assert words in text
    assert '<td class="over">1.23</td>' in text
    assert text.count("<svg") == 1
    assert "only here" not in text
    assert "+0.500 %" in text


def test_a_page_without_main_numbers_has_no_room_for_them(study):
    assert '<dl class="key">' in page(study)
    assert '<dl class="key">' not in page(dataclasses.replace(study, rows=[]))


def test_the_terminal_has_its_part(study):
    out = io.StringIO()
    show(study, Console(file=out, width=100))
    text = out.getvalue()
    for words in (
        "motion-base: An <example>.",
        "  Index 12.50 rad/s",
        "only here 3.000",
        "1.23",
        "0.500 %",
        "Warning: Beware",
    ):
        assert words in text
    assert "Card" not in text
    assert "mass + 1 %" not in text


def without_figures(text):
    """A page without its figures: one that a file shows as well is laid out for that file."""
    return re.sub(r"<svg.*?</svg>", "", text, flags=re.DOTALL)


def test_a_command_writes_its_files_and_prints_json(study, tmp_path, capsys):
    emit(study, tmp_path, as_json=True)
    found = json.loads(capsys.readouterr().out)
    assert found["index_rad_s"] == 12.5
    assert found["force_n"] == [1.0, None]
    assert found["files"] == [str(tmp_path / name) for name in study.files]
    written = (tmp_path / "example.html").read_text(encoding="utf-8")
    assert written.count("<svg") == page(study).count("<svg") > 0
    assert "<svg" in written
    assert without_figures(written) == without_figures(page(study))
    assert xr.open_dataset(tmp_path / "forces.nc").a == 1.0
    emit(study, None, as_json=False)
    assert "12.50" in capsys.readouterr().out
    assert study.to_dataset() is study.dataset


def test_a_notebook_shows_the_machine():
    found = gather(fx.load("motion-base"))
    frame = found._repr_html_()
    assert frame.startswith("<iframe srcdoc=")
    assert "The machine in 3-D" in frame
    assert found.to_dict()["design"] == "motion-base"
