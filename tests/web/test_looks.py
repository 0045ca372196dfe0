"""What the page looks like: contrast, a phone, paper, and what is read aloud."""

import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.helpers.waiting import until
from tests.web.acts import box_of, pause, rests, turn_to, type_in

SOURCES = Path(__file__).parents[2] / "web" / "src"
STYLE = (SOURCES / "widgets" / "common.css").read_text(encoding="utf-8")
THEME = (SOURCES / "charts" / "theme.ts").read_text(encoding="utf-8")
TABS = ("Modes", "Legs", "Workspace", "Response", "Time", "Design")
SCHEMES = {"light": ":root, :host {", "dark": ":root[data-theme='dark'], :host([data-theme='dark']) {"}


def palette(scheme: str) -> dict[str, str]:
    """The colours of a scheme by their names in the style sheet."""
    block = STYLE.split(SCHEMES[scheme])[1].split("}")[0]
    return dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", block))


def listed(name: str) -> list[str]:
    return re.findall(r"#[0-9a-f]{6}", THEME.split(f"export const {name} = [")[1].split("]")[0])


def luminance(colour: str) -> float:
    """Relative luminance by WCAG 2."""
    digits = colour[1:] if len(colour) == 7 else "".join(2 * digit for digit in colour[1:])
    parts = np.array(list(bytes.fromhex(digits))) / 255
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(a: str, b: str) -> float:
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


def test_contrast_is_that_of_the_standard() -> None:
    assert contrast("#ffffff", "#000000") == pytest.approx(21)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_text_lines_and_borders_can_be_seen(scheme: str) -> None:
    """WCAG AA: 4.5 for text, 3 for lines of plots and borders of fields."""
    colours = palette(scheme)
    for text in ("text", "muted", "accent", "bad"):
        for ground in ("panel", "raised", f"{text}-soft"):
            if ground in colours:
                assert contrast(colours[text], colours[ground]) > 4.5, (text, ground)
    for ground in ("panel", "raised"):
        assert contrast(colours["edge"], colours[ground]) > 3, ground
    for line in listed("ON_LIGHT" if scheme == "light" else "ON_DARK"):
        assert contrast(line, colours["panel"]) > 3, line


def test_lines_that_share_a_plot_differ_without_colour() -> None:
    """Rotations from translations and from each other, by their dashes."""
    dashes = THEME.split("export const DASHES = [")[1].split("\n")[0]
    kinds = re.findall(r"\[([\d, ]*)\]", dashes)
    assert len(kinds) == 6
    assert len(set(kinds[3:])) == 3
    assert "" not in kinds[3:]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_borders_dots_and_labels_are_drawn_in_these_colours(scheme: str, opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=workspace", color_scheme=scheme)
    page.locator("#cloud .plot[data-answer=current]").wait_for()
    colours = palette(scheme)
    for control in ("input.number", "select", "header button"):
        shown = page.locator(control).first.evaluate("e => getComputedStyle(e).borderTopColor")
        if control != "header button" or shown != "rgba(0, 0, 0, 0)":
            assert tuple(map(int, re.findall(r"\d+", shown)))[:3] == tuple(bytes.fromhex(colours["edge"][1:]))
    page.locator("#cloud[data-points]").wait_for()
    drawn = page.locator("#cloud canvas").evaluate("""canvas => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height)
      const found = new Set()
      for (let i = 0; i < data.length; i += 4)
        if (data[i + 3]) found.add('#' + [0, 1, 2].map(k => data[i + k].toString(16).padStart(2, '0')).join(''))
      return [...found]
    }""")
    assert len(drawn) > 3
    assert min(contrast(dot, colours["panel"]) for dot in drawn) > 3
    with page.expect_download() as download:  # numbers of legs stand on a halo, for their legs are of any colour
        page.get_by_label("3-D view as SVG").click()
    picture = Path(download.value.path()).read_text(encoding="utf-8")
    labels = re.findall(r"<text[^>]*fill=\"(#\w+)\" stroke=\"(#\w+)\"[^>]*paint-order=\"stroke\"[^>]*>(\w)<", picture)
    assert {name for *_, name in labels} >= {*"123456", "G", "x"}
    assert min(contrast(fill, halo) for fill, halo, _ in labels) > 7


@pytest.mark.parametrize("values", [(1.5e-15, 1.826e16, 7.9e-5), (-1.2345e-12, 9.99e22, 1.5e16)])
def test_numbers_of_the_readout_do_not_overlap(values: tuple[float, ...], opened: Any) -> None:
    """They once ran into each other where they were very small or large."""
    page = opened("design=motion-base&tab=modes")

    def changed(route: Any) -> None:
        answer = route.fetch().json()
        answer["index"], answer["condition"], answer["legs"]["force"][0] = values
        answer["frequency"][0], answer["limits"] = (
            1e-16,
            {
                "any": True,
                "ok": False,
                "exceeded": ["leg 1: long"] * 19,
                "by_leg": [[]] * 6,
            },
        )
        route.fulfill(json=answer)

    page.route("**/api/state", changed)
    for width in (1280, 1000, 390):
        page.set_viewport_size({"width": width, "height": 800})
        type_in(page, "yaw", str(width / 1000))
        page.locator("#limits", has_text="19 exceeded").wait_for()
        edge = box_of(page.locator(".readout"))
        boxes = page.locator(".readout .figure:visible").evaluate_all(
            "cells => cells.map(c => { const a = c.getBoundingClientRect(); const t = document.createRange();"
            " t.selectNodeContents(c); const b = t.getBoundingClientRect();"
            " return [a.left, a.right, a.top, b.left, b.right] })"
        )
        for left, right, _, text_left, text_right in boxes:
            assert left <= text_left < text_right <= right
            assert text_right <= edge["x"] + edge["width"]
        for one, other in pairwise(boxes):
            assert one[2] != other[2] or one[1] <= other[0] + 2
    page.unroute_all(behavior="wait")


def test_limits_are_not_read_aloud_at_each_pose(opened: Any) -> None:
    page = opened("design=precision-positioner&tab=modes")
    type_in(page, "z", "270")
    page.locator("#limits", has_text="exceeded").wait_for()
    count = page.locator("#limits").text_content()
    spoken = page.locator(".readout [aria-live]")
    page.locator(".readout [aria-live]", has_text=f"Limits: {count}").wait_for()
    assert "leg" not in spoken.text_content()
    type_in(page, "yaw", "0.1")
    pause(page, 1.3)
    assert "Limits" not in spoken.text_content()  # as before
    assert spoken.text_content().startswith("Index")
    for region in page.locator("[aria-live], [role=alert], [role=status]").all():
        assert region.locator(".exceeded").count() == 0


def test_with_reduced_motion_modes_are_drawn_still_and_play_plays(opened: Any) -> None:
    page = opened("design=motion-base&tab=modes", reduced_motion="reduce")
    scene = page.locator(".scene")
    page.get_by_role("button", name="Animate mode 3").click()
    assert "Drawn still, at its greatest displacement" in page.locator(".detail").text_content()
    assert rests(scene)
    turn_to(page, "Time")
    page.locator("#simulate").click()
    play = page.get_by_role("button", name="Play", exact=True)
    play.wait_for()
    now = page.locator("#time .now")
    first = now.text_content()
    assert first.startswith("0 s")
    pause(page, 0.4)
    assert now.text_content() == first  # nothing moves by itself
    play.click()
    assert until(lambda: now.text_content() != first)
    page.get_by_role("button", name="Pause").click()


@pytest.mark.parametrize("tab", TABS)
def test_fits_a_phone(tab: str, opened: Any) -> None:
    """Nothing is cut, and no tab is out of sight."""
    page = opened(f"design=motion-base&tab={tab.lower()}&mode=2")
    page.set_viewport_size({"width": 390, "height": 844})
    assert until(lambda: page.evaluate("document.documentElement.scrollWidth") <= 390)
    box_of(page.get_by_role("tablist"))
    sides = page.get_by_role("tab").evaluate_all(
        "tabs => tabs.map(tab => tab.getBoundingClientRect()).map(box => [box.left, box.right])"
    )
    assert len(sides) == len(TABS)
    assert all(0 <= left < right <= 390 for left, right in sides)
    cut = page.evaluate(
        "[...document.querySelectorAll('.panel:not([hidden]) :is(td, th, h2, button, select)')].filter(e => "
        "e.offsetParent && e.getBoundingClientRect().right > 386).map(e => e.outerHTML)"
    )
    assert cut == []


@pytest.mark.parametrize("slider", ["z slider", "Leg stiffness slider"])
def test_on_a_phone_the_machine_is_in_sight_of_its_sliders(slider: str, opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    page.set_viewport_size({"width": 390, "height": 844})
    hand = page.get_by_label(slider, exact=True)
    box_of(hand)
    hand.evaluate("e => e.scrollIntoView({ block: 'end' })")
    box, scene = box_of(hand), box_of(page.locator(".scene canvas"))
    assert scene["y"] >= 0
    assert scene["height"] > 150
    assert scene["y"] + scene["height"] <= box["y"]
    assert box["y"] + box["height"] <= 845


@pytest.mark.parametrize("scheme", SCHEMES)
def test_on_paper_data_lie_on_their_axes(scheme: str, opened: Any) -> None:
    """Once they lay beside them: the canvas had the place that it has on the screen."""
    page = opened("design=motion-base&tab=workspace", color_scheme=scheme)
    page.locator("#slice .progress-words", has_text="14").wait_for()
    page.emulate_media(media="print", color_scheme=scheme)
    page.set_viewport_size({"width": 700, "height": 1000})

    def where(part: str) -> dict[str, float] | None:
        return page.locator(part).first.bounding_box()

    def together(place: str) -> bool:
        data, axes = where(f"{place} canvas"), where(f"{place} .plot > svg g rect[fill=none]")
        return data is not None and axes is not None and data == pytest.approx(axes, abs=1.5)

    assert until(lambda: together("#cloud") and together("#slice"))  # the page is laid out anew
    assert page.evaluate("document.documentElement.dataset.theme") == "light"
    assert page.locator(".tabs").is_hidden()
    scene = page.locator(".scene canvas")
    assert scene.evaluate("e => getComputedStyle(e).objectFit") == "contain"  # not stretched
    turn_to_response = "document.querySelector('#tab-response').click()"
    page.emulate_media(media="screen", color_scheme=scheme)
    page.evaluate(turn_to_response)
    page.locator("#response .lines canvas").nth(5).wait_for()
    page.emulate_media(media="print", color_scheme=scheme)
    page.locator("#response .printed svg").nth(5).wait_for()
    assert page.locator("#response .uplot:visible").count() == 0
    page.emulate_media(media="screen", color_scheme=scheme)
    page.locator("#response .printed").first.wait_for(state="detached")
    assert until(lambda: page.evaluate("document.documentElement.dataset.theme") == scheme)
