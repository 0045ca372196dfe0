"""The notebooks of the manual: kept without outputs, short, run from the first cell to the last, and checked by themselves."""

import ast
import importlib.util
import json
import re
from pathlib import Path

import pytest
from matplotlib import pyplot as plt

DOCS = Path(__file__).parents[2] / "docs"
NOTEBOOKS = {path.stem: path for path in sorted((DOCS / "notebooks").glob("*.ipynb"))}
KERNEL = ("nbclient", "ipykernel")


def cells(name):
    return json.loads(NOTEBOOKS[name].read_text(encoding="utf-8"))["cells"]


def code(name):
    return ["".join(cell["source"]) for cell in cells(name) if cell["cell_type"] == "code"]


def hook():
    spec = importlib.util.spec_from_file_location("notebooks", DOCS / "_hooks" / "notebooks.py")
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def test_there_is_one_for_each_job_and_two_to_begin_with():
    jobs = {"telescope_secondary", "laboratory_isolator", "thesis_figures", "motion_simulator"}
    assert set(NOTEBOOKS) == jobs | {"first_steps", "damping_and_response"}
    navigation = (DOCS.parent / "mkdocs.yml").read_text(encoding="utf-8")
    assert all(f"notebooks/{name}.md" in navigation for name in NOTEBOOKS)


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_is_short_and_has_no_outputs(name):
    for cell in cells(name):
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            assert cell["execution_count"] is None
    lines = [line for text in code(name) for line in text.splitlines() if line.strip()]
    assert len(lines) < 60
    assert all(len(line) <= 120 for line in lines)
    assert cells(name)[0]["source"][0].startswith("# ")


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_says_how_its_numbers_are_checked_and_checks_them(name):
    told = [k for k, cell in enumerate(cells(name)) if "**Is it right?**" in "".join(cell["source"])]
    assert told
    assert all(
        any("assert" in "".join(cell["source"]) for cell in cells(name)[k + 1 :] if cell["cell_type"] == "code")
        for k in told
    )


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_runs(name, tmp_path, monkeypatch):
    """In this process; what a cell ends with shows itself as it would in a notebook."""
    monkeypatch.chdir(tmp_path)
    space = {"__name__": "__main__"}
    for number, text in enumerate(code(name)):
        tree = ast.parse(text)
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, f"{name}, cell {number}", "exec"), space)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), f"{name}, cell {number}", "eval"), space)
            view = getattr(value, "_repr_html_", None)
            assert view is None or len(view() or "") < 200_000  # Matplotlib may give None
    plt.close("all")


def test_a_kernel_makes_a_page_of_it():
    for package in KERNEL:
        pytest.importorskip(package)
    notebooks = hook()
    text, pictures = notebooks.page(notebooks.run(NOTEBOOKS["first_steps"]), "first_steps")
    assert len(pictures) == 2
    assert all(picture.startswith(b"\x89PNG") for picture in pictures.values())
    assert all(f"]({file})" in text for file in pictures)
    assert "156.695411 Hz; by hand 156.695411 Hz" in text
    assert text.count('<div class="result">') == 3  # the machine, its legs, and a picture in place of the view
    assert "<Axes" not in text
    assert not re.search(r"Traceback|Warning", text)


@pytest.fixture(scope="module")
def kernel():
    """The client of a kernel, which takes seconds to start."""
    for package in KERNEL:
        pytest.importorskip(package)
    from jupyter_client.manager import start_new_kernel

    manager, client = start_new_kernel(kernel_name="python3", startup_timeout=300)
    yield client
    client.stop_channels()
    manager.shutdown_kernel(now=True)


@pytest.fixture
def shown_by_kernel(kernel):
    """What a kernel shows of a cell: the messages that hold data. Names of the cells before are gone."""

    def shown(text):
        found = []
        for cell in ("%reset -f", text):
            reply = kernel.execute_interactive(cell, output_hook=found.append, timeout=300)
            assert reply["content"]["status"] == "ok"
        return [one for one in found if "data" in one["content"]]

    return shown


def test_a_figure_that_a_cell_ends_with_is_shown_once(shown_by_kernel):
    """Of several panels, too, which no call of pyplot made."""
    messages = shown_by_kernel("import flexapod as fx\nfx.plot(fx.transmissibility(fx.load('cubic-isolator')))")
    assert [one["content"]["data"].get("image/png", "")[:4] for one in messages] == ["iVBO"]


def test_a_kernel_shows_progress_and_takes_it_away(shown_by_kernel):
    messages = shown_by_kernel(
        "import flexapod as fx\nfrom flexapod import progress\nprogress.AFTER = 0.0\n"
        "run = fx.simulate(fx.load('precision-positioner'), duration=0.05)"
    )
    shown = [one["content"]["data"]["text/html"] for one in messages]
    assert any('simulation <progress value="' in text for text in shown)
    assert shown[-1] == ""
    places = {one["content"]["transient"]["display_id"] for one in messages}
    assert len(places) == 1
