"""Figures that a file and a page both show."""

import matplotlib
import numpy as np
import pytest

import flexapod as fx
from flexapod.cli.output.results import write
from flexapod.plots.shared import drawn_for_all, shared
from flexapod.plots.style import new_figure
from flexapod.report.study import Drawing, Section, Study


@pytest.fixture
def drawn():
    return []


@pytest.fixture
def study(drawn):
    def draw():
        ax = new_figure(9.0, 3.0).add_subplot(ylabel="height")
        ax.plot([1.0, 2.0])
        drawn.append(ax.figure)
        return ax

    sections = [Section("Section", [Drawing("one", "One figure", draw)])]
    return Study(
        fx.load("motion-base"), "study", "about it", {}, sections=sections, files={"one.png": draw, "one.html": None}
    )


def test_a_file_and_a_page_show_one_figure(study, drawn, tmp_path):
    files = write(study, tmp_path)
    assert [path.name for path in files] == ["one.png", "one.html"]
    assert len(drawn) == 1
    assert ">height</text>" in (tmp_path / "one.html").read_text(encoding="utf-8")
    write(study, tmp_path)
    assert len(drawn) == 2, "nothing is kept beyond the files of a study"


def test_a_page_keeps_its_own_style(study, drawn, tmp_path):
    with matplotlib.rc_context({"lines.linewidth": 5.0}):
        write(study, tmp_path)
    assert [figure.axes[0].lines[0].get_linewidth() for figure in drawn] == [5.0, 1.5]


def test_the_layout_of_the_first_file_stays(study):
    draw = study.files["one.png"]
    with drawn_for_all():
        figure = shared(draw)
        figure.draw_without_rendering()
        places = [ax.get_position().bounds for ax in figure.axes]
        assert shared(draw) is figure
        figure.set_figwidth(3.0)
        figure.draw_without_rendering()
        np.testing.assert_array_equal([ax.get_position().bounds for ax in figure.axes], places)
    assert shared(draw) is not figure
