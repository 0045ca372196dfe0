"""Every script that draws pictures of the manual still runs, and draws what it is said to: unrendered, in a copy of docs/."""

import runpy
import shutil
import sys
from functools import partial
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from tests.docs.test_site import DOCS, pictures

import flexapod as fx

#: Those that photograph pages: that pages work is tested with them, and here that the scripts find what they use.
PHOTOGRAPHS = {"draw_page.py", "draw_tutorial.py", "draw_view.py"}
#: What takes long, in fewer steps.
CHEAP = {
    "optimise": {"trials": 1, "samples": 8, "verify": 16},
    "robustness": {"samples": 64, "sensitivity": 16},
    "certify": {"gap": 0.5},
}


@pytest.fixture
def images(tmp_path):
    """docs/images of a copy that has the pages and no picture."""
    folder = tmp_path / "docs" / "images"
    folder.mkdir(parents=True)
    for page in DOCS.glob("*.md"):
        (folder.parent / page.name).symlink_to(page)
    return folder


def _cheaply(call, settings, *given, **named):
    return call(*given, **{**named, **settings})


def _unrendered(figure, place, **named):
    Path(place).touch()


@pytest.mark.parametrize("script", sorted(set(pictures.values()) - PHOTOGRAPHS))
def test_a_script_draws_its_pictures(script, images, monkeypatch):
    pytest.importorskip("optuna")
    pytest.importorskip("ompl")
    for name, settings in CHEAP.items():
        monkeypatch.setattr(fx, name, partial(_cheaply, getattr(fx, name), settings))
    monkeypatch.setattr(Figure, "savefig", _unrendered)
    monkeypatch.setattr(sys, "path", [*sys.path])
    runpy.run_path(shutil.copy(DOCS / "images" / script, images), run_name="__main__")
    drawn = {picture.name for picture in images.iterdir()} - {script}
    assert drawn == {name for name, by in pictures.items() if by == script}


@pytest.mark.parametrize("script", sorted(PHOTOGRAPHS))
def test_a_script_that_photographs_finds_what_it_uses(script, monkeypatch):
    pytest.importorskip("playwright")
    monkeypatch.setattr(sys, "path", [*sys.path])
    assert callable(runpy.run_path(str(DOCS / "images" / script))["draw"])
