"""The page in a real browser: what a user does, and the numbers it shows against the library."""

import base64
import re
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.helpers.waiting import until
from tests.web.acts import address, box_of, frames, moves, number, pause, rests, saved, type_in, wait_for_index
from tests.web.browser import PATIENCE

import flexapod as fx

MACHINE = fx.load("mukherjee-ii")


def shown_omega(page: Any) -> list[float]:
    return [number(text) for text in page.locator("#modes-table tbody td:nth-child(2)").all_text_contents()]


def omega_at(x: float, y: float, z: float, *rpy_deg: float, machine: fx.Hexapod = MACHINE) -> np.ndarray:
    return fx.natural_modes(machine, fx.Pose.from_rpy(x, y, z, *np.radians(rpy_deg or (0, 0, 0)))).omega


def test_a_pose_by_number_gives_the_library_s_frequencies(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    type_in(page, "z", "90")
    type_in(page, "pitch", "5")
    expected = omega_at(0, 0, 0.09, 0, 5, 0)
    wait_for_index(page, expected[0])
    np.testing.assert_allclose(shown_omega(page), expected, rtol=6e-5)  # five digits are shown
    condition = fx.condition_number(MACHINE, fx.Pose.from_rpy(0, 0, 0.09, 0, np.radians(5), 0))
    assert number(page.locator("#condition").text_content()) == pytest.approx(condition, rel=6e-4)


def test_a_pose_by_slider_is_the_pose_that_the_number_shows(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    slider = page.get_by_label("x slider")
    slider.focus()
    for _ in range(4):
        slider.press("ArrowRight")
    x = number(page.get_by_label("x", exact=True).input_value()) / 1000
    assert x > 0
    wait_for_index(page, omega_at(x, 0, 0.085)[0])
    box = box_of(slider)
    page.mouse.click(box["x"] + 0.2 * box["width"], box["y"] + box["height"] / 2)
    moved = number(page.get_by_label("x", exact=True).input_value()) / 1000
    assert moved < 0
    wait_for_index(page, omega_at(moved, 0, 0.085)[0])


def test_payload_and_stiffness_update_live_and_are_undone(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    type_in(page, "Platform + payload kg", "400")
    heavy = MACHINE.replace({"platform.mass": 400})
    wait_for_index(page, omega_at(0, 0, 0.085, machine=heavy)[0])
    type_in(page, "Leg stiffness N/m", "4e7")
    wait_for_index(page, omega_at(0, 0, 0.085, machine=heavy.replace({"legs.stiffness": 4e7}))[0])
    page.get_by_role("button", name="Reset", exact=True).click()
    wait_for_index(page, omega_at(0, 0, 0.085)[0])


def test_a_wrong_number_is_refused_at_its_field(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    type_in(page, "Platform + payload kg", "-4")
    message = page.locator(".row.wide .wrong", has_text="platform.mass is -4 kg; it must be > 0")
    message.wait_for()
    assert page.get_by_label("Platform + payload kg", exact=True).get_attribute("aria-invalid") == "true"
    type_in(page, "Platform + payload kg", "8")
    wait_for_index(page, omega_at(0, 0, 0.085, machine=MACHINE.replace({"platform.mass": 8}))[0])
    assert message.count() == 0


def test_a_mode_is_animated_and_described(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    scene = page.locator(".scene")
    assert rests(scene)  # nothing moves: nothing is drawn
    page.get_by_role("button", name="Animate mode 3").click()
    assert moves(scene)
    words = fx.describe_modes(MACHINE, fx.Pose([0, 0, 0.085]))[2].text
    assert words in page.locator(".detail").text_content()
    amplitude = page.locator("output[for=amplitude]").text_content()
    page.get_by_label("Amplitude drawn").press("End")
    assert page.locator("output[for=amplitude]").text_content() != amplitude
    page.keyboard.press("Escape")
    page.locator("h1").click()
    page.keyboard.press("0")
    assert rests(scene)


def test_a_click_in_the_cloud_moves_the_machine_to_that_pose(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=workspace")
    page.locator("#cloud[data-points='100000']").wait_for()
    plot = page.locator("#cloud .plot")
    box = box_of(plot)
    tip = page.locator("#cloud .tip")
    for share in np.linspace(0.25, 0.85, 25):  # look for a point near the middle of the plot
        page.mouse.move(box["x"] + 64 + share * (box["width"] - 148), box["y"] + 0.8 * box["height"])
        if tip.is_visible():
            break
    shown = re.match(r"ω₁ (\S+) rad/s   cond\(H\) (\S+)", tip.text_content())
    assert shown
    page.mouse.down()
    page.mouse.up()
    index, condition = number(shown[1]), number(shown[2])
    page.locator("#index", has_text=shown[1]).wait_for()
    x, y, z = (number(page.get_by_label(c, exact=True).input_value()) / 1000 for c in "xyz")
    rpy = [number(page.get_by_label(c, exact=True).input_value()) for c in ("roll", "pitch", "yaw")]
    assert omega_at(x, y, z, *rpy)[0] == pytest.approx(index, rel=1e-4)
    pose = fx.Pose.from_rpy(x, y, z, *np.radians(rpy))
    assert fx.condition_number(MACHINE, pose) == pytest.approx(condition, rel=1e-4)


def test_worst_pose_and_slice_move_the_machine(opened: Any) -> None:
    page = opened("design=precision-positioner&tab=workspace")
    page.get_by_role("button", name="Worst pose").click()
    words = page.locator("#worst .progress-words", has_text="rad/s, found by")
    words.wait_for()
    machine = fx.load("precision-positioner")
    found = float(re.search(r"(\S+) rad/s", words.text_content())[1])
    wait_for_index(page, found)
    lowest = number(page.locator("#cloud-table tbody td").first.text_content())
    assert found <= lowest * 1.0001
    six = [number(page.get_by_label(c, exact=True).input_value()) for c in ("x", "y", "z", "roll", "pitch", "yaw")]
    assert omega_at(*(np.array(six[:3]) / 1000), *six[3:], machine=machine)[0] == pytest.approx(found, rel=1e-4)
    page.locator("#slice .progress-words", has_text="14").wait_for()
    box = box_of(page.locator("#slice .plot"))
    page.locator("#slice .plot").click(position={"x": 64 + 0.5 * (box["width"] - 154), "y": 0.3 * box["height"]})
    x = page.get_by_label("x", exact=True)
    assert until(lambda: abs(number(x.input_value())) < 1)  # mm: the middle of the box


def test_response_panels_and_the_shaken_base(opened: Any) -> None:
    page = opened("design=motion-base&tab=response")
    page.locator("#response .lines canvas").nth(5).wait_for()
    machine = fx.load("motion-base")
    page.get_by_label("Shaking frequency, Hz").fill("14.9")
    page.locator("#shake").click()
    words = page.locator("#shake-words", has_text="times as far as the base's")
    words.wait_for()
    shown = number(re.search(r"moves (\S+) times", words.text_content())[1])
    home = fx.home_pose(machine)
    data = fx.transmissibility(machine, home, omega=[2 * np.pi * 14.9])
    assert shown == pytest.approx(abs(data["absolute"].sel(output="z", base="z").values[0]), rel=6e-3)
    assert moves(page.locator(".scene"))


def test_a_simulation_plays(opened: Any) -> None:
    page = opened("design=motion-base&tab=time")
    page.locator("#simulate").click()
    page.locator("#time .progress-words", has_text="steps").wait_for()
    assert page.locator("#time .lines canvas").count() == 3
    now = page.locator("#time .now")
    first = now.text_content()
    assert until(lambda: now.text_content() != first)
    table = saved(page, lambda: page.get_by_role("button", name="Simulation as CSV").click()).decode()
    rows = np.genfromtxt(table.splitlines(), delimiter=",", names=True)
    assert rows["time_s"][-1] == pytest.approx(1.0)
    held = fx.hold(fx.load("motion-base"), fx.home_pose(fx.load("motion-base"))).leg_force
    assert rows["leg_1_force_n"][0] == pytest.approx(held[0], rel=1e-5)  # the page has float32


def test_a_design_with_an_error_says_so_at_its_line(opened: Any, tmp_path: Path) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    index = page.locator("#index").text_content()
    text = MACHINE.to_toml().replace("mass = 4.0", "mass = -4.0")
    file = tmp_path / "bad.toml"
    file.write_text(text)
    page.set_input_files("#design-file", file)
    message = page.locator(".errors li", has_text="platform.mass is -4 kg")
    message.wait_for()
    line = next(i for i, row in enumerate(text.splitlines(), 1) if row.startswith("mass = -4.0"))
    assert message.text_content().startswith(f"line {line}:")
    assert page.locator(".gutter .bad").text_content() == str(line)
    assert page.locator("#index").text_content() == index  # the machine shown is the one before
    area = page.get_by_label("Design file (TOML)")
    area.fill(text.replace("mass = -4.0", "mass = 16.0"))
    wait_for_index(page, omega_at(0, 0, 0.085, machine=MACHINE.replace({"platform.mass": 16}))[0])
    assert page.locator(".errors li").count() == 0


def test_a_design_is_saved_as_it_is_shown(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=design")
    page.get_by_label("platform.mass kg").fill("12")
    page.get_by_label("platform.mass kg").press("Enter")
    heavy = MACHINE.replace({"platform.mass": 12})
    wait_for_index(page, omega_at(0, 0, 0.085, machine=heavy)[0])
    text = saved(page, lambda: page.get_by_role("button", name="Save TOML").click()).decode()
    assert fx.Hexapod.from_toml(text) == heavy


def test_a_state_is_shared_by_its_address(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    type_in(page, "z", "91.5")
    type_in(page, "Platform + payload kg", "40")
    expected = omega_at(0, 0, 0.0915, machine=MACHINE.replace({"platform.mass": 40}))[0]
    wait_for_index(page, expected)
    other = opened(address(page, "%3A40%7D&pose=0,0,0.0915"))
    wait_for_index(other, expected)
    assert other.get_by_label("z", exact=True).input_value() == "91.5"


def test_two_pages_do_not_see_each_other(opened: Any) -> None:
    one, other = opened("design=mukherjee-ii&tab=modes"), opened("design=mukherjee-ii&tab=modes")
    type_in(one, "z", "95")
    type_in(one, "Platform + payload kg", "100")
    wait_for_index(one, omega_at(0, 0, 0.095, machine=MACHINE.replace({"platform.mass": 100}))[0])
    type_in(other, "y", "3")
    wait_for_index(other, omega_at(0, 0.003, 0.085)[0])
    assert other.get_by_label("z", exact=True).input_value() == "85"


def test_a_long_job_is_cancelled_and_blocks_nobody(opened: Any) -> None:
    page, other = (
        opened("design=mukherjee-i&tab=time&frequency=1e5&amplitude=1e-6"),
        opened("design=mukherjee-ii&tab=modes"),
    )
    page.get_by_label("duration").fill("60")  # minutes of computing
    page.locator("#simulate").click()
    page.get_by_role("button", name="Cancel").last.wait_for()
    page.locator("#time .progress-words", has_text="%").wait_for()
    type_in(other, "z", "95")
    wait_for_index(other, omega_at(0, 0, 0.095)[0])
    cancel = page.locator("#time .runner button")
    cancel.click()
    page.locator("#time .progress-words", has_text="Cancelled").wait_for()
    page.get_by_label("duration").fill("0.01")
    page.locator("#simulate").click()
    page.locator("#time .progress-words", has_text="steps").wait_for()


def test_downloads_open(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    table = saved(page, lambda: page.get_by_role("button", name="Table of modes as CSV").click()).decode()
    lines = table.splitlines()
    assert lines[0].startswith("mode,omega_rad_s,frequency_hz")
    np.testing.assert_allclose([float(row.split(",")[1]) for row in lines[1:]], omega_at(0, 0, 0.085), rtol=1e-14)
    assert saved(page, lambda: page.get_by_label("3-D view as PNG").click()).startswith(b"\x89PNG")
    picture = ElementTree.fromstring(saved(page, lambda: page.get_by_label("3-D view as SVG").click()))
    assert len(picture.findall("{*}polygon")) > 500
    page.get_by_role("tab", name="Workspace").click()
    page.locator("#cloud[data-points='100000']").wait_for()
    cloud = ElementTree.fromstring(saved(page, lambda: page.get_by_label("Cloud as SVG").click()))
    assert cloud.find("{*}image").get("href").startswith("data:image/png")
    assert saved(page, lambda: page.get_by_label("Cloud as PNG").click()).startswith(b"\x89PNG")
    rows = saved(page, lambda: page.get_by_role("button", name="Cloud as CSV").click()).decode().splitlines()
    assert len(rows) == 100_001
    page.get_by_role("tab", name="Response").click()
    page.locator("#response .lines canvas").nth(5).wait_for()
    panels = ElementTree.fromstring(saved(page, lambda: page.get_by_label("Response as SVG").click()))
    assert len(panels.findall("{*}svg")) == 6
    assert saved(page, lambda: page.get_by_label("Response as PNG").click()).startswith(b"\x89PNG")


def test_limits_exceeded_stand_by_the_leg(opened: Any) -> None:
    page = opened("design=precision-positioner&tab=legs")
    type_in(page, "z", "270")
    page.locator("#limits", has_text="exceeded").wait_for()
    machine = fx.load("precision-positioner")
    exceeded = fx.check_limits(machine, fx.Pose([0, 0, 0.27])).exceeded
    assert page.locator(".notes .exceeded").all_text_contents() == [f"▲ {words}" for words in exceeded]
    assert page.locator("#legs-table tr.exceeded").count() == 6


def test_by_keyboard_alone(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    page.get_by_role("tab", name="Modes").focus()
    page.keyboard.press("ArrowRight")
    assert page.get_by_role("tab", name="Legs").get_attribute("aria-selected") == "true"
    assert page.locator("#legs-table").is_visible()
    page.keyboard.press("2")
    assert until(lambda: "mode=2" in page.evaluate("location.hash"))
    page.keyboard.press("0")
    scene = page.locator(".scene")
    assert rests(scene)  # else the mode would draw what the key is to draw
    page.locator(".scene canvas").focus()
    before = frames(scene)
    page.keyboard.press("ArrowLeft")
    assert until(lambda: frames(scene) > before)
    unnamed = page.evaluate(
        "[...document.querySelectorAll('input, select, button, textarea')].filter(e => !("
        "e.getAttribute('aria-label') || e.labels?.[0]?.textContent || (e.matches('button') && e.textContent)"
        ")).map(e => e.outerHTML)"
    )
    assert unnamed == []


def test_without_webgl_tables_and_plots_still_work(browser: Any, server: str) -> None:
    context = browser.new_context()
    context.set_default_timeout(PATIENCE)
    page = context.new_page()
    page.add_init_script(
        "const real = HTMLCanvasElement.prototype.getContext;"
        "HTMLCanvasElement.prototype.getContext = function (kind, ...more) {"
        " return /webgl/.test(kind) ? null : real.call(this, kind, ...more) }"
    )
    page.goto(f"{server}#design=mukherjee-ii&tab=workspace")
    page.locator("#index:not(:empty)").wait_for()
    assert "WebGL is missing" in page.locator(".scene").text_content()
    page.locator("#cloud[data-points='100000']").wait_for()
    context.close()


def test_an_address_with_a_broken_design_shows_what_is_wrong(opened: Any) -> None:
    text = MACHINE.to_toml().replace("mass = 4.0", "mass = -4.0")
    packer = zlib.compressobj(wbits=-15)
    packed = base64.urlsafe_b64encode(packer.compress(text.encode()) + packer.flush()).decode().rstrip("=")
    page = opened(f"toml={packed}")
    page.locator(".errors li", has_text="platform.mass is -4 kg").wait_for()
    pause(page, 0.5)  # what else the page loads must not wipe it out
    assert page.locator(".errors li").count() == 1
    assert page.get_by_label("Design file (TOML)").input_value() == text


def test_a_design_of_one_s_own_is_shared_whole(opened: Any, tmp_path: Path) -> None:
    own = MACHINE.replace({"name": "täst", "platform.mass": 7.5})
    file = tmp_path / "own.toml"
    own.save(file)
    page = opened("design=motion-base&tab=modes")
    page.set_input_files("#design-file", file)
    expected = omega_at(0, 0, 0.085, machine=own)[0]
    wait_for_index(page, expected)
    wait_for_index(opened(address(page, "toml=")), expected)


def test_a_broken_draft_is_saved_as_it_is_written(opened: Any, tmp_path: Path) -> None:
    """It was once saved as the machine before, and the draft was lost."""
    text = MACHINE.to_toml().replace("mass = 4.0", "mass = -4.0")
    file = tmp_path / "bad.toml"
    file.write_text(text)
    page = opened("design=motion-base&tab=modes")
    page.set_input_files("#design-file", file)
    page.locator(".errors li").wait_for()
    assert saved(page, lambda: page.get_by_role("button", name="Save TOML").click()).decode() == text
    page.locator("#design .hint", has_text="as it is written; it is not the machine shown").wait_for()
    with page.expect_response("**/api/design"):  # changes the machine shown, and leaves the draft
        type_in(page, "Platform + payload kg", "500")
    pause(page, 0.2)
    assert page.get_by_label("Design file (TOML)").input_value() == text
    page.get_by_label("View of the design").select_option("form")
    heavy = fx.load("motion-base").replace({"platform.mass": 500.0})
    shown = saved(page, lambda: page.get_by_role("button", name="Save TOML").click()).decode()
    assert fx.Hexapod.from_toml(shown) == heavy


def test_a_simulation_tells_its_speed_ramp_and_rotation_vectors(opened: Any) -> None:
    page = opened("design=motion-base&tab=time")
    assert "rises over the first tenth of the duration" in page.locator("#time").text_content()
    page.clock.install()
    page.locator("#simulate").click()
    page.locator("#time .progress-words", has_text="The motion rises over the first 0.1 s").wait_for()
    now = page.locator("#time .now")
    assert "8.00 times slower" in now.text_content()
    page.get_by_role("button", name="Pause").click()
    page.get_by_label("Speed", exact=True).select_option("1")
    assert "in real time" in now.text_content()
    page.get_by_label("Speed", exact=True).select_option("100")
    assert "100 times slower" in now.text_content()
    start = number(now.text_content().split(" s")[0])
    page.get_by_role("button", name="Play").click()
    page.clock.fast_forward(10_000)
    gone = (number(now.text_content().split(" s")[0]) - start) % 1.0
    assert gone == pytest.approx(0.1, abs=0.02)  # s in ten seconds
    names = page.locator("#time .keys").first.text_content()
    assert "about y" in names
    assert "pitch" not in names
    head = saved(page, lambda: page.get_by_role("button", name="Simulation as CSV").click()).decode().splitlines()[0]
    assert "platform_rotation_vector_y_rad" in head
    assert "pitch" not in head
