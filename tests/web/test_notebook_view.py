"""The view for notebooks in a real browser: what it shows against the library, poses both ways, several views at once."""

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from tests.helpers.waiting import until
from tests.web.acts import box_of, frames, moves, number, pause, rests, type_in
from tests.web.browser import PATIENCE
from tests.web.cells import Notebook

import flexapod as fx

pytest.importorskip("anywidget")

MACHINE = fx.load("mukherjee-ii")
HOME = fx.Pose([0.0, 0.0, 0.085])
QUIET = re.compile("GPU stall due to ReadPixels|Multiple instances of Three.js")  # a module of its own for each view


class Opened:
    """Notebooks, each in a context of its own, and what they asked for and complained of."""

    def __init__(self, browser: Any) -> None:
        self.browser = browser
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.contexts: list[Any] = []

    def __call__(self, style: str = "", kernel: bool = True, **options: Any) -> Notebook:
        context = self.browser.new_context(viewport={"width": 960, "height": 900}, **options)
        context.set_default_timeout(PATIENCE)
        self.contexts.append(context)
        page = context.new_page()
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on(
            "console",
            lambda m: m.type in ("error", "warning") and not QUIET.search(m.text) and self.complaints.append(m.text),
        )
        return Notebook(page, style, kernel)


@pytest.fixture
def notebook(browser: Any) -> Iterator[Opened]:
    """`notebook()` is a page for views. After the test: no complaint, and nothing was asked of any network."""
    opened = Opened(browser)
    yield opened
    for context in opened.contexts:
        context.close()
    assert opened.complaints == []
    assert all(url.startswith(("about:", "data:", "blob:")) for url in opened.requests)


def shown_hz(cell: Any) -> list[float]:
    return [number(text) for text in cell.locator(".modes tbody td:nth-child(2)").all_text_contents()]


def wait_for_hz(cell: Any, expected: float) -> None:
    cell.locator("#frequency", has_text=re.compile(f"^{re.escape(f'{expected:#.5g}'.rstrip('.'))}$")).wait_for()


def hz(pose: fx.Pose, machine: fx.Hexapod = MACHINE) -> np.ndarray:
    return fx.natural_modes(machine, pose).omega / (2 * np.pi)


def test_it_shows_the_machine_s_frequencies_and_modes(notebook: Opened) -> None:
    cell = notebook().show(fx.view(MACHINE, HOME))
    np.testing.assert_allclose(shown_hz(cell), hz(HOME), rtol=6e-5)  # five digits are shown
    words = cell.locator(".modes .words").all_text_contents()[1:]
    assert words == [mode.text for mode in fx.describe_modes(MACHINE, HOME)] or len(words) == 5
    assert until(lambda: frames(cell.locator(".scene")) > 0)


def test_a_slider_moves_the_pose_in_python(notebook: Opened) -> None:
    view = fx.view(MACHINE, HOME)
    seen: list[fx.Pose] = []
    view.observe(lambda change: seen.append(change.new), "pose")
    cell = notebook().show(view)
    slider = cell.get_by_label("x slider")
    slider.focus()
    for _ in range(4):
        slider.press("ArrowRight")
    x = number(cell.get_by_label("x", exact=True).input_value()) / 1000
    assert x > 0
    wait_for_hz(cell, hz(fx.Pose([x, 0, 0.085]))[0])
    assert view.pose.position[0] == pytest.approx(x, abs=1e-12)
    assert seen[-1] == view.pose
    type_in(cell, "pitch", "5")
    wait_for_hz(cell, hz(view.pose)[0])
    assert view.pose.rpy[1] == pytest.approx(np.radians(5.0), abs=1e-12)


def test_a_pose_from_python_moves_the_sliders(notebook: Opened) -> None:
    view = fx.view(MACHINE, HOME)
    cell = notebook().show(view)
    view.pose = fx.Pose.from_rpy(0.001, -0.002, 0.09, 0.0, 0.0, np.radians(7.0))
    wait_for_hz(cell, hz(view.pose)[0])
    fields = [number(cell.get_by_label(name, exact=True).input_value()) for name in ("x", "y", "z", "yaw")]
    assert fields == pytest.approx([1.0, -2.0, 90.0, 7.0], abs=1e-9)
    cell.get_by_label("Unit of lengths").select_option("m")
    assert number(cell.get_by_label("z", exact=True).input_value()) == pytest.approx(0.09, abs=1e-12)
    cell.get_by_role("button", name="Home").click()
    wait_for_hz(cell, hz(HOME)[0])
    assert view.pose == HOME


def test_a_mode_moves_and_is_told_to_python(notebook: Opened) -> None:
    view = fx.view(MACHINE, HOME)
    cell = notebook().show(view)
    scene = cell.locator(".scene")
    assert rests(scene)  # nothing moves: nothing is drawn
    cell.get_by_role("button", name="Animate mode 3").click()
    assert moves(scene)
    assert view.mode == 3
    slower = hz(HOME)[2] / 0.7
    assert f"{slower:.3g}" in cell.locator(".pace").text_content().replace("e+0", "e")
    view.mode = None
    assert rests(scene)
    assert cell.locator(".pace").text_content() == "Choose a mode to see it move."


def test_a_pose_that_no_leg_can_take_is_told_and_the_machine_stays(notebook: Opened) -> None:
    machine = MACHINE.replace({"platform.joints": MACHINE.base_joints.tolist()})
    view = fx.view(machine, HOME)
    cell = notebook().show(view)
    assert "The pose is singular" in cell.locator(".notes .grave").text_content()
    assert cell.locator("#stability").text_content() == "singular"
    type_in(cell, "z", "0")
    words = cell.locator(".words.refused")
    words.wait_for()
    assert "leg 1 has length 0 m at this pose" in words.text_content()
    assert "the last pose that it could take" in words.text_content()
    assert view.pose == HOME
    assert cell.locator(".stage.stale").count() == 1
    view.pose = HOME  # the sliders return, though it is the same pose
    words.wait_for(state="hidden")
    assert number(cell.get_by_label("z", exact=True).input_value()) == 85.0
    assert cell.locator(".stale").count() == 0


def test_what_is_no_number_is_told_at_its_field(notebook: Opened) -> None:
    view = fx.view(MACHINE, HOME)
    cell = notebook().show(view)
    type_in(cell, "z", "high")
    message = cell.locator(".row .wrong", has_text="z is high; give a number of mm. Shown: 85 mm.")
    message.wait_for()
    type_in(cell, "z", "85")
    message.wait_for(state="detached")
    assert view.pose == HOME


def test_limits_are_told_in_words(notebook: Opened) -> None:
    machine = fx.load("precision-positioner")
    view = fx.view(machine)
    cell = notebook().show(view)
    assert cell.locator("#limits").text_content() == "within"
    x, y, z = machine.home.position
    view.pose = [x, y, z + 0.03, 0, 0, 0]
    exceeded = fx.check_limits(machine, view.pose).exceeded
    assert exceeded
    cell.locator("#limits", has_text=f"{len(exceeded)} exceeded").wait_for()
    assert cell.locator(".notes .exceeded").all_text_contents() == [f"▲ {words}" for words in exceeded]


def test_two_views_on_a_page_are_independent(notebook: Opened) -> None:
    book = notebook()
    first, second = fx.view(MACHINE, HOME), fx.view(fx.load("motion-base"))
    cells = [book.show(first, "600px", "first"), book.show(second, "600px", "second")]
    before = shown_hz(cells[1])
    type_in(cells[0], "z", "90")
    wait_for_hz(cells[0], hz(fx.Pose([0, 0, 0.09]))[0])
    cells[0].get_by_role("button", name="Animate mode 2").click()
    assert shown_hz(cells[1]) == before
    assert second.pose == fx.load("motion-base").home
    assert (first.mode, second.mode) == (2, None)
    assert cells[1].locator(".chosen").count() == 0


def test_one_view_shown_twice_is_one_pose(notebook: Opened) -> None:
    book = notebook()
    view = fx.view(MACHINE, HOME)
    cells = [book.show(view, "450px"), book.show(view, "450px")]
    type_in(cells[0], "z", "90")
    for cell in cells:
        wait_for_hz(cell, hz(fx.Pose([0, 0, 0.09]))[0])
        assert number(cell.get_by_label("z", exact=True).input_value()) == 90.0
    book.page.evaluate("cells[0].leave()")  # its output is cleared; the other one goes on
    assert cells[0].locator(".machine").count() == 0
    type_in(cells[1], "z", "85")
    wait_for_hz(cells[1], hz(HOME)[0])


def test_without_a_kernel_the_last_state_is_shown_and_modes_move(notebook: Opened) -> None:
    view = fx.view(MACHINE, HOME)
    cell = notebook(kernel=False).show(view)
    np.testing.assert_allclose(shown_hz(cell), hz(HOME), rtol=6e-5)
    scene = cell.locator(".scene")
    assert rests(scene)
    cell.get_by_role("button", name="Animate mode 1").click()
    assert moves(scene)
    type_in(cell, "z", "90")
    words = cell.locator(".words.refused")
    words.wait_for()
    assert "No answer yet: the kernel is busy, or there is none behind this page." in words.text_content()
    np.testing.assert_allclose(shown_hz(cell), hz(HOME), rtol=6e-5)
    cell.get_by_role("button", name="Home").click()
    words.wait_for(state="hidden")


@pytest.mark.parametrize(
    ("style", "theme"),
    [("background: white; color: #222", "light"), ("background: #111; color: rgba(255, 255, 255, 0.87)", "dark"),
     ("background: #111; color: oklch(0.9 0 0)", "dark")],
)  # fmt: skip
@pytest.mark.parametrize("width", ["400px", "900px"])
def test_it_has_the_theme_of_the_notebook_and_fits_its_cell(
    notebook: Opened, style: str, theme: str, width: str
) -> None:
    book = notebook(style)
    cell = book.show(fx.view(MACHINE, HOME), width)
    cell.locator(f".flexapod-view[data-theme={theme}]").wait_for()
    wide = box_of(cell.locator(".machine"))["width"]
    assert wide == pytest.approx(float(width[:-2]), abs=1)
    left = box_of(cell)["x"]
    rights = cell.locator(".machine :is(button, input, select, output, td, th):visible").evaluate_all(
        "parts => parts.map(part => part.getBoundingClientRect().right)"
    )
    assert max(rights) <= left + wide + 0.5
    book.page.evaluate("document.body.style.color = 'black'; document.body.style.background = 'white'")
    cell.locator(".flexapod-view[data-theme=light]").wait_for()


def test_keys_stay_in_the_view_and_the_wheel_scrolls_the_notebook(notebook: Opened) -> None:
    book = notebook("height: 3000px")
    cell = book.show(fx.view(MACHINE, HOME), "500px")
    assert cell.locator("[data-lm-suppress-shortcuts=true] .machine").count() == 1  # what JupyterLab looks for
    box = box_of(cell.locator(".scene"))
    book.page.mouse.move(box["x"] + 50, box["y"] + 150)
    book.page.mouse.wheel(0, 200)
    book.page.wait_for_function("scrollY > 100")
    book.page.evaluate("scrollTo(0, 0)")
    scene = cell.locator(".scene")
    assert rests(scene)
    before = frames(scene)
    book.page.mouse.click(box["x"] + 50, box["y"] + 150)
    book.page.mouse.wheel(0, 200)
    assert until(lambda: frames(scene) > before)
    pause(book.page, 0.3)
    assert book.page.evaluate("scrollY") == 0
