"""Figures for print: drawn where the user says, in the user's style, as wide as a column, with words that are text."""

import inspect
import itertools
import re

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image
from tests.helpers import figures

import flexapod as fx
from flexapod import __version__, plots
from flexapod.plots import style
from flexapod.report import page
from flexapod.report.findings import gather
from flexapod.report.studies.machine import study

pypdf = pytest.importorskip("pypdf")

MM = 25.4
pytestmark = pytest.mark.filterwarnings("ignore::flexapod.control.GainWarning")


def test_every_plot_is_tried_here():
    assert set(figures.functions()) == set(figures.DRAW)


@pytest.mark.parametrize("name", figures.DRAW)
def test_a_plot_draws_where_it_is_told(name):
    """What draws on one pair of axes takes `ax` and gives it back; what draws on several, a figure or a part of one."""
    places = {"ax", "figure"} & set(inspect.signature(figures.functions()[name]).parameters)
    draw = figures.prepared(name)
    page = Figure(figsize=(12, 6), layout="constrained")
    if places == {"ax"}:
        space = {"projection": "3d"} if name.split(".")[0] in ("machine_3d", "sweep_surface") else {}
        ax, other = page.add_subplot(1, 2, 1, **space), page.add_subplot(1, 2, 2)
        assert draw(ax=ax) is ax
        assert [one for one in page.axes if one not in (ax, other)] == [
            one for one in page.axes if one.get_label() == "<colorbar>"
        ]
        assert page.get_suptitle() == ""
        assert not page.legends
    else:
        assert places == {"figure"}
        part, rest = page.subfigures(1, 2)
        assert draw(figure=part) is part
        assert part.axes
        assert not rest.axes
        other = None
    assert other is None or not other.has_data()


@pytest.mark.parametrize("name", figures.DRAW)
def test_a_plot_takes_the_users_style_and_width(name):
    """Sizes of words and lines, the colour of words and the width; panels of a narrow figure do not overlap."""
    with matplotlib.rc_context({"font.size": 5.0, "lines.linewidth": 0.75, "text.color": "#123456"}):
        with plots.for_print(width=0.088, title=False):
            drawn = figures.prepared(name)()
        figure = style.figure_of(drawn)
        assert figure.get_figwidth() * MM == pytest.approx(88.0, rel=1e-12)
        figure.draw_without_rendering()
    assert figure.get_suptitle() == ""
    flat = [ax for ax in figure.axes if not hasattr(ax, "get_zlabel")]
    labels = [text for ax in flat for text in (ax.xaxis.label, ax.yaxis.label) if text.get_text()]
    assert {text.get_size() for text in labels} <= {5.0}
    assert not labels or "#123456" in {matplotlib.colors.to_hex(text.get_color()) for text in labels}
    words = [text for ax in figure.axes for text in ax.texts]
    assert max((text.get_size() for text in words), default=5.0) <= 5.5
    widths = [line.get_linewidth() for ax in figure.axes for line in ax.lines]
    assert max(widths, default=0.0) <= 2.5  # of 5, the thickest line that is drawn otherwise
    marked = [line for ax in figure.axes for line in ax.lines if line.get_marker() not in ("None", "", None)]
    for line in marked:  # half of 10, of strokes half of 17
        assert line.get_markersize() <= (8.5 if line.get_marker() in ("|", "_") else 5.0)
        assert line.get_markeredgewidth() <= 1.1
    boxes = [ax.get_position() for ax in flat if ax.get_label() != "<colorbar>"]
    for i, one in enumerate(boxes):
        assert one.width > 0.1
        for other in boxes[i + 1 :]:
            assert min(one.x1, other.x1) <= max(one.x0, other.x0) or min(one.y1, other.y1) <= max(one.y0, other.y0)


def test_without_a_change_sizes_are_those_of_the_house():
    figure = figures.prepared("response.frequency_response")()
    assert figure.get_size_inches().tolist() == [10.0, 6.2]
    assert {ax.yaxis.label.get_size() for ax in figure.axes} == {10.0}
    assert {text.get_size() for ax in figure.axes for text in ax.get_xticklabels()} == {9.0}
    with matplotlib.rc_context({"figure.figsize": (5.0, 4.0), "xtick.labelsize": 6.0}):
        other = figures.prepared("response.frequency_response")()
    assert other.get_size_inches().tolist() == [5.0, 4.0]
    assert {text.get_size() for ax in other.axes for text in ax.get_xticklabels()} == {6.0}


def test_a_page_keeps_its_own_style():
    """Reports follow the colours of their page, whatever the user's style."""
    found = study(gather(figures.base(), fx.home_pose(figures.base())))
    plain = page(found)
    with matplotlib.rc_context({"font.size": 20.0, "text.color": "red", "axes.facecolor": "black"}):
        assert page(found) == plain


def fonts_of(page):
    return [font.get_object() for font in page["/Resources"]["/Font"].values()]


def write(run, tmp_path, *options):
    code, _, err = run("response", "cubic-isolator", "--points", 60, "--out", tmp_path, *options)
    assert (code, err) == (0, "")


def test_a_pdf_is_as_wide_as_a_column_and_holds_its_fonts(run, tmp_path):
    write(run, tmp_path, "--format", "pdf", "--width", "88mm", "--font-size", 7)
    reader = pypdf.PdfReader(tmp_path / "response.pdf")
    (page,) = reader.pages
    assert float(page.mediabox.width) / 72 * MM == pytest.approx(88.0, abs=0.01)
    descendants = [
        font["/DescendantFonts"][0].get_object() if "/DescendantFonts" in font else font for font in fonts_of(page)
    ]
    assert descendants
    assert all("/FontFile2" in font["/FontDescriptor"].get_object() for font in descendants)  # TrueType, as a whole
    text = page.extract_text()
    assert "frequency, Hz" in text
    assert "cubic-isolator: motion per base motion" in " ".join(text.split())
    told = reader.metadata
    assert told["/Title"] == "cubic-isolator: motion per base motion, base z"
    assert told["/Creator"] == f"Flexapod {__version__}"
    assert "design: cubic-isolator" in told["/Subject"]
    assert "axes and units: amplitude, m/m; frequency, Hz; phase, deg" in told["/Subject"]
    assert "/CreationDate" not in told
    assert not (tmp_path / "response.png").exists()


def test_an_svg_holds_words_and_the_same_figure_is_the_same_file(run, tmp_path):
    write(run, tmp_path, "--format", "svg", "--width", "180mm", "--no-title")
    first = (tmp_path / "response.svg").read_text()
    write(run, tmp_path, "--format", "svg", "--width", "180mm", "--no-title")
    assert (tmp_path / "response.svg").read_text() == first
    words = re.findall(r"<text[^>]*>([^<]+)</text>", first)
    assert "frequency, Hz" in words
    assert not [word for word in words if "motion per base motion" in word]
    width = re.search(r'width="([0-9.]+)pt"', first)
    assert float(width[1]) / 72 * MM == pytest.approx(180.0, abs=0.01)
    assert "<dc:title>cubic-isolator: motion per base motion, base z</dc:title>" in first  # though it is not drawn
    assert f"Flexapod {__version__}" in first
    assert "<dc:date>" not in first


def test_a_png_for_print_has_600_dots_an_inch(run, tmp_path):
    write(run, tmp_path, "--width", "88mm")
    with Image.open(tmp_path / "response.png") as picture:
        assert picture.width == pytest.approx(88.0 / MM * 600, abs=1)
        assert picture.text["Software"] == f"Flexapod {__version__}"
        assert "frequency, Hz" in picture.text["Description"]


def test_figures_of_other_commands(run, tmp_path):
    sweep = ["sweep", "cubic-isolator", "--around", 0.001, 1, "--points", 50, "--figure", tmp_path / "a.svg"]
    assert run(*sweep, "--width", "120mm", "--format", "svg")[0] == 0
    assert 'width="340.157' in (tmp_path / "a.svg").read_text()  # 120 mm of 72 points an inch
    code, _, err = run(*sweep, "--format", "pdf")
    assert code == 2
    assert "ends in '.svg', and --format is pdf" in err
    assert run("paper", "--figure", 2, "--points", 200, "--out", tmp_path, "--format", "pdf", "--width", "0.09")[0] == 0
    (page,) = pypdf.PdfReader(tmp_path / "figure-2.pdf").pages
    assert float(page.mediabox.width) / 72 * MM == pytest.approx(90.0, abs=0.01)
    assert not list(tmp_path.glob("*.png"))


def test_options_of_figures_without_figures_are_refused(run):
    for options in (["--width", "88mm"], ["--format", "pdf"], ["--font-size", "8"], ["--no-title"]):
        code, _, err = run("statics", "motion-base", *options)
        assert code == 2
        assert f"{options[0]} is of figures, and none is written. Give --out as well." in err
    assert run("statics", "motion-base", "--width", "-1", "--out", ".")[0] == 2
    assert run("statics", "motion-base", "--font-size", "0", "--out", ".")[0] == 2
    code, _, err = run("statics", "nothing", "--width", "10m", "--out", ".")  # before anything else
    assert code == 2
    assert "width is 10 m; it must be from 0.01 to 1 m" in err


def test_bad_arguments_of_print():
    for given in ({"width": 0.0}, {"width": float("nan")}, {"font_size": -1}):
        with pytest.raises(fx.ArgumentError, match="must be finite and > 0"), plots.for_print(**given):
            pass
    for given in ({"width": 1e30}, {"width": 1.01}, {"width": 1e-9}, {"font_size": 101.0}):
        with pytest.raises(fx.ArgumentError, match="it must be from"), plots.for_print(**given):
            pass
    with pytest.raises(fx.errors.OutputError, match="no format of figures"):
        plots.save(plots.frequencies(np.arange(1.0, 7.0)), "six.doc")


@pytest.mark.parametrize("name", ["path.motors", "envelope.pairs", "response.stepped_ratio"])
def test_numbers_below_a_narrow_axis_do_not_touch(name, tmp_path):
    with plots.for_print(width=0.088, title=False):
        figure = style.figure_of(figures.prepared(name)())
        plots.save(figure, tmp_path / "narrow.pdf")
    figure.draw_without_rendering()
    for ax in figure.axes:
        low, high = sorted(ax.get_xlim())
        labels = [tick.label1 for tick in ax.xaxis.get_major_ticks() if low <= tick.get_loc() <= high]
        ends = [label.get_window_extent() for label in labels if label.get_visible() and label.get_text()]
        for left, right in itertools.pairwise(sorted(ends, key=lambda box: box.x0)):
            assert right.x0 > left.x1 + 2


def test_a_figure_that_is_saved_is_laid_out_and_drawn_once(tmp_path, monkeypatch):
    drawn, laid_out = [], []
    figure = fx.plots.frequencies(fx.natural_modes(fx.load("motion-base")).omega).figure
    engine = figure.get_layout_engine()
    figure.set_figwidth(9.0)  # in narrow ones words are fitted before
    draw, execute = Figure.draw, type(engine).execute
    monkeypatch.setattr(Figure, "draw", lambda self, renderer: drawn.append(self) or draw(self, renderer))
    monkeypatch.setattr(type(engine), "execute", lambda self, fig: laid_out.append(fig) or execute(self, fig))
    plots.save(figure, tmp_path / "once.png")
    assert (drawn, laid_out) == ([figure], [figure])
    monkeypatch.undo()
    figure.savefig(tmp_path / "twice.png", dpi=160)
    once, twice = (np.asarray(Image.open(tmp_path / f"{name}.png")) for name in ("once", "twice"))
    np.testing.assert_array_equal(once, twice)
    assert figure.get_layout_engine() is engine
