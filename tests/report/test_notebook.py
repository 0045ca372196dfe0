"""How designs and results show themselves in notebooks: small, with units, and safe."""

import html
import re
import xml.etree.ElementTree as ET

import numpy as np
import xarray as xr
from IPython.core.interactiveshell import InteractiveShell
from tests.helpers.public import CLASSES, PUBLIC

import flexapod as fx
from flexapod.report.numbers import shown
from flexapod.showing import teach_datasets

BASE = fx.load("motion-base")


def fragment(thing):
    """What a notebook is given, which is well-formed and small."""
    text = thing._repr_html_()
    assert len(text) < 150_000
    ET.fromstring(f"<all>{text}</all>")
    return text


def words(text):
    """The words of a fragment, without tags and drawings."""
    text = re.sub(r"<(style|svg)\b.*?</\1>", " ", text, flags=re.DOTALL)
    return " ".join(re.sub(r"<[^>]+>", " ", text).split())


def test_every_public_result_has_a_view():
    for name in CLASSES:
        kind = PUBLIC[name]
        if hasattr(kind, "_fields") or "__dataclass_fields__" in vars(kind) or name == "SweepStore":
            assert callable(getattr(kind, "_repr_html_", None)), name


def test_a_machine_shows_its_drawing_and_its_inputs():
    text = fragment(BASE)
    assert text.count("<svg") == 1
    told = words(text)
    assert told.startswith("motion-base")
    assert "hydraulic" in told
    assert "base x, mm" in told
    assert "gravity" in told
    without = fragment(BASE.replace({"home": None}))
    assert "<svg" not in without


def test_two_drawings_of_a_page_have_names_of_their_own():
    first, second = (set(re.findall(r'id="([^"]+)"', BASE._repr_html_())) for _ in range(2))
    assert first
    assert not first & second


def test_modes_are_a_table_in_hertz():
    modes = fx.natural_modes(BASE)
    text = fragment(modes)
    told = words(text)
    assert "mode Hz rad/s" in told
    for omega in modes.omega:
        assert f"{omega / (2 * np.pi):.5g}" in told
    assert text.count("<svg") == 1
    damped = fx.linearise(BASE).modes()
    assert "damping ratio" in words(fragment(damped))


def test_modes_of_many_poses_are_told_by_their_range():
    many = fx.natural_modes(BASE, fx.Pose(BASE.home.position + np.array([[0, 0, 0], [0, 0, 0.01]])))
    assert "omega 2 × 6," in words(fragment(many))


def test_parts_and_results_tell_meaning_and_unit():
    assert "stiffness" in words(fragment(BASE.legs))
    assert "N/m" in words(fragment(BASE.legs))
    assert "damping Damping" in words(fragment(BASE.legs))
    assert "0x" not in words(fragment(BASE.legs))
    assert "leg_length" in words(fragment(BASE.limits))
    held = fx.hold(BASE)
    assert "leg_force" in words(fragment(held))
    worst = fx.worst_pose(BASE, fx.Box.about(BASE.home, 0.05, 0.05), samples=64, starts=2)
    told = words(fragment(worst))
    assert f"{worst.omega_1:.5g}" in told
    assert "rad/s" in told


def test_names_of_users_are_text():
    odd = BASE.replace({"name": "<script>alert(1)</script> & <b>"})
    text = fragment(odd)
    assert "<script" not in text
    assert "&lt;script&gt;" in text


def test_colours_follow_the_page():
    """Ink is that of the notebook; no word is black or white by itself."""
    text = fragment(BASE)
    assert "--ink: currentColor" in text
    assert "#20262d" not in text
    assert "#000000" not in re.sub(r"clip-path.*?;", "", text).replace("stroke: #000000", "")


def test_an_envelope_shows_how_far_and_how_fast():
    """The numbers of its page: travels in mm and degrees, what stops them, and the largest box."""
    machine = fx.load("motion-base")
    found = fx.envelope(machine, directions=8)
    page = found._repr_html_()
    for axis in found.axes:
        assert axis.axis in page
    assert shown(1e3 * found.axes[0].most) in page
    assert "Largest box" in page
    assert shown(found.axes[0].least_index) in page


def test_a_dataset_says_what_its_numbers_are_above_xarrays_view(monkeypatch):
    shell = InteractiveShell()
    monkeypatch.setattr("IPython.get_ipython", lambda: shell)
    teach_datasets()
    isolator = fx.load("cubic-isolator")
    law = fx.control.ForceFeedback(26.0, leak=2.9)
    found = fx.control.controlled_transmissibility(isolator, controller=law, omega=[10.0, 20.0])

    def shown_by_kernel(dataset):
        return shell.display_formatter.format(dataset)[0]["text/html"]

    told, _, plain = shown_by_kernel(found).partition("<div><svg")
    assert plain
    ET.fromstring(f"<all>{told}</all>")
    told = words(told)
    assert told.startswith("cubic-isolator")
    most = shown(float(abs(found.controlled).max()))
    assert f"controlled omega (2), output (6), base (6) amplitude up to {most} (m or rad)/(m or rad)" in told
    assert "transmissibility with control" in told
    assert shown_by_kernel(xr.Dataset({"own": ("x", [1.0])})).startswith("<div><svg")
    falling = fx.transmissibility(
        isolator.replace({"legs.joint_stiffness": None, "legs.stiffness": 1000}), omega=[10.0]
    )
    assert falling.attrs["caution"]
    assert falling.attrs["caution"] in html.unescape(words(shown_by_kernel(falling)))
