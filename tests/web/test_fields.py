"""Fields of the page: what is wrong with what was typed or chosen, and what the plots say at the cursor."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.web.acts import box_of, number, pause, saved, type_in

import flexapod as fx


def choose(page: Any, file: Path) -> None:
    """Choose the recording of a motion. The page begins to read it at once: another reading ends later."""
    chosen = page.locator("#time input[type=file]")
    chosen.set_input_files(file)
    chosen.evaluate("async input => { await input.files[0].text() }")
    pause(page, 0.1)


def test_a_wrong_coordinate_is_answered_in_words(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    type_in(page, "z", "8o")
    row = page.locator("[data-part=pose]", has=page.get_by_label("z", exact=True))
    words = row.locator(".wrong", has_text="z is 8o; give a number of mm. Shown: 85 mm.")
    words.wait_for()
    box = page.get_by_label("z", exact=True)
    assert box.get_attribute("aria-describedby") == words.get_attribute("id")
    type_in(page, "z", "200")
    row.locator(".hint", has_text="outside the pose box: ").wait_for()
    assert words.count() == 0
    type_in(page, "z", "85")
    row.locator(".hint").wait_for(state="hidden")


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("none.csv", None, "Choose a CSV file first."),
        ("empty.csv", b"", "empty.csv is empty; choose a file with a row of column names and rows of numbers."),
        ("large.csv", b"time,z\n" + b"0,0\n" * 1_100_000, "large.csv has 4400007 bytes; at most 4194304 are taken."),
        ("latin.csv", "time,z_µm\n0,0\n".encode("latin-1"), "latin.csv is not text in UTF-8"),
        ("wrong.csv", b"time,w\n0,0\n1,1\n", "w"),
    ],
)
def test_a_recording_that_cannot_be_used_says_why(
    name: str, content: bytes | None, words: str, opened: Any, tmp_path: Path
) -> None:
    """It once asked for a file that was chosen."""
    page = opened("design=mukherjee-ii&tab=time&motion=csv&duration=0.01")
    if content is not None:
        file = tmp_path / name
        file.write_bytes(content)
        choose(page, file)
    page.locator("#simulate").click()
    page.locator("#time .progress-words.wrong", has_text=words).wait_for()


def test_a_recording_with_semicolons_and_decimal_commas_is_read(opened: Any, tmp_path: Path) -> None:
    file = tmp_path / "german.csv"
    rows = [f"{t:.5f};{1e3 * t**2:.7f}".replace(".", ",") for t in np.linspace(0, 0.01, 50)]
    file.write_text("\n".join(["time;z_mm", *rows]), encoding="utf-8")
    page = opened("design=mukherjee-ii&tab=time&motion=csv&duration=0.01")
    choose(page, file)
    page.locator("#simulate").click()
    page.locator("#time .progress-words", has_text="steps").wait_for()
    choose(page, file)  # another file is another question, the same is not
    assert page.locator("#time .of-before").is_hidden()


@pytest.mark.parametrize(("label", "text"), [("amplitude", "abc"), ("frequency", "0"), ("duration", "1e9")])
def test_a_wrong_number_of_a_motion_is_refused_at_its_field_in_its_unit(label: str, text: str, opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=time")
    type_in(page, label, text)
    page.locator("#time .field .wrong", has_text=f"{label} is {text}; it must be a number from").wait_for()
    assert page.get_by_label(label, exact=True).get_attribute("aria-invalid") == "true"


def test_plots_tell_their_values_at_the_cursor(opened: Any) -> None:
    """Of the response by a wrench, whose components have names and units of their own."""
    page = opened("design=motion-base&tab=response&response=compliance&panels=one&frequency_unit=rad&output=3")
    page.locator("#response .panels[data-answer=current]").wait_for()
    page.locator("#response .lines canvas").first.wait_for()
    assert page.locator("#response .key").all_text_contents() == ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
    over = page.locator("#response .u-over").first
    box = box_of(over)
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"])
    tip = page.locator("#response .tip:visible")
    tip.wait_for()
    rows = dict(line.split("  ") for line in tip.text_content().split("\n"))
    omega = number(rows["frequency, rad/s"])
    data = fx.transmissibility(fx.load("motion-base"), omega=[omega])["compliance"]
    found = float(abs(data.sel(output="z", wrench="z")).item())
    assert number(rows["Fz"]) == pytest.approx(found, rel=2e-3)
    heights = page.locator("#response .u-cursor-pt").evaluate_all(
        "points => points.map(p => new DOMMatrix(getComputedStyle(p).transform).f)"
    )
    inside = [0 < height < box["height"] for height in heights]
    assert inside == [False, False, True, False, False, False]  # z by Fx is rounding, which stretches no axis
    picture = saved(page, lambda: page.get_by_label("Response as SVG").click()).decode()
    assert "m/N or m/(N m)" in picture
    page.mouse.move(0, 0)
    page.locator("#response .tip:visible").wait_for(state="detached")


def test_a_phase_is_not_drawn_through_its_jump_and_has_ticks_at_right_angles(opened: Any) -> None:
    page = opened("design=motion-base&tab=response&panels=phase&output=3")
    page.locator("#response .panels[data-answer=current]").wait_for()
    page.locator("#response .lines canvas").first.wait_for()
    picture = saved(page, lambda: page.get_by_label("Response as SVG").click()).decode()
    for tick in ("−180", "−90", "0", "90", "180"):
        assert f">{tick}<" in picture
