"""Animations: frames, the factor that they state, files that other programs read, bad input."""

import sys

import numpy as np
import pytest
from matplotlib.text import Text
from PIL import Image, ImageSequence
from tests.helpers.states import CENTER

import flexapod as fx
from flexapod.plots import animation

II = fx.Pose(CENTER["mukherjee-ii"])


@pytest.fixture(scope="module")
def paper():
    return fx.load("mukherjee-ii")


@pytest.fixture(scope="module")
def simulation(paper):
    return fx.simulate(paper, II, base_motion=fx.harmonic("z", 1e-5, 492.0), duration=0.1, samples=401)


@pytest.fixture
def stills(monkeypatch):
    """What is drawn: joints of platform and base in every frame, and the words under them."""
    drawn: list[tuple[np.ndarray, np.ndarray]] = []
    stage = animation._stage

    def recording(top, feet, width):
        figure, draw = stage(top, feet, width)
        return figure, lambda platform, base: (drawn.append((platform, base)), draw(platform, base))

    monkeypatch.setattr(animation, "_stage", recording)
    return drawn


def test_a_mode_moves_as_its_shape_times_the_stated_factor(paper, tmp_path, stills):
    path = tmp_path / "mode.gif"
    factor = fx.animate_mode(paper, II, 4, path, amplitude=2e-6)
    assert factor == float(f"{factor:.2g}")  # a number that reads well
    assert 0.1 < factor * 2e-6 / 0.086 < 0.14  # about an eighth of the machine, whose joints span 86 mm
    shape = fx.natural_modes(paper, II).shape[:, 3]
    arms = paper.platform_joints
    moves = shape[:3] + np.cross(shape[3:], arms)
    first, feet = stills[0]
    shown = first - (II.position + arms)
    np.testing.assert_allclose(np.linalg.norm(shown, axis=1).max(), factor * 2e-6, rtol=0.01)  # turned by 0.1 rad
    along = np.sum(shown * moves) / np.linalg.norm(shown) / np.linalg.norm(moves)
    assert abs(along) > 0.99
    np.testing.assert_array_equal(feet, paper.base_joints)
    halfway = stills[len(stills) // 2][0] - (II.position + arms)
    np.testing.assert_allclose(halfway, -shown, atol=0.02 * np.abs(shown).max())
    distances = [np.linalg.norm(platform[0] - platform[3]) for platform, _ in stills]
    np.testing.assert_allclose(distances, np.linalg.norm(arms[0] - arms[3]), rtol=1e-12)  # enlarged, but still rigid
    with Image.open(path) as picture:
        assert picture.n_frames == len(stills) == 32
        assert picture.info["loop"] == 0


def test_a_simulation_shows_its_displacements_and_its_base(paper, simulation, tmp_path, stills, monkeypatch):
    path = tmp_path / "run.gif"
    said: list[str] = []
    write = Text.set_text
    monkeypatch.setattr(Text, "set_text", lambda self, words: (said.append(str(words)), write(self, words))[1])
    done: list[float] = []
    factor = fx.animate_simulation(
        simulation, paper, path, exaggeration=500, window=(0.02, 0.05), frames=5, progress=done.append
    )
    assert factor == 500
    assert sum("motion shown 500 times larger; t = " in words for words in said) == 5
    assert done == [0.2, 0.4, 0.6, 0.8, 1.0]
    at = np.linspace(0.02, 0.05, 5)
    for t, (platform, feet) in zip(at, stills, strict=True):
        lift = 1e-5 * np.sin(492.0 * t)
        # The samples are 0.25 ms apart, joined by straight lines: (492 * 2.5e-4)^2 / 8 of the amplitude.
        np.testing.assert_allclose(feet - paper.base_joints, np.tile([0, 0, 500 * lift], (6, 1)), atol=500 * 2.1e-8)
        x = np.array([np.interp(t, simulation.time, simulation.displacement[:, i]) for i in range(6)])
        expected = 500 * (x[:3] + np.cross(x[3:], paper.platform_joints))
        moved = platform - II.position - paper.platform_joints
        np.testing.assert_allclose(moved, expected, atol=0.02 * np.abs(expected).max())  # second order of 0.02 rad
    with Image.open(path) as picture:
        assert picture.n_frames == 5


def test_pictures_have_one_title_and_the_colours_that_were_drawn(paper, tmp_path):
    fx.animate_mode(paper, II, 1, tmp_path / "mode.gif")
    with Image.open(tmp_path / "mode.gif") as picture:
        frames = [np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(picture)]
    heads = [frame[:50] for frame in frames]
    assert all(np.array_equal(head, heads[0]) for head in heads)
    assert (heads[0] < 100).any()  # ink
    assert (heads[0][-1] == 255).all()
    assert all((np.abs(frame - np.array([0x4A, 0x54, 0x60])).max(axis=-1) < 8).any() for frame in frames)  # legs
    assert not np.array_equal(frames[0], frames[8])


def test_the_default_window_shows_the_oscillation_and_not_its_aliases(paper, simulation, tmp_path, stills):
    fx.animate_simulation(simulation, paper, tmp_path / "run.gif", frames=12)
    heights = np.array([feet[0, 2] for _, feet in stills])
    turns = np.count_nonzero(np.diff(np.sign(np.diff(heights))))
    assert 1 <= turns <= 3  # 12 frames of 16 a period


def test_mp4(paper, tmp_path):
    reader = pytest.importorskip("imageio_ffmpeg")
    path = tmp_path / "mode.mp4"
    fx.animate_mode(paper, II, 2, path)
    frames, seconds = reader.count_frames_and_secs(str(path))
    assert frames == 32
    assert seconds == pytest.approx(2.0, abs=0.1)


def test_mp4_without_the_extra_names_it(paper, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(ImportError, match=r"flexapod\[video\]"):
        fx.animate_mode(paper, II, 1, tmp_path / "mode.mp4")


def test_bad_arguments(paper, simulation, tmp_path):
    gif = tmp_path / "a.gif"
    with pytest.raises(fx.ArgumentError, match="number is 7"):
        fx.animate_mode(paper, II, 7, gif)
    with pytest.raises(fx.ArgumentError, match="amplitude"):
        fx.animate_mode(paper, II, 1, gif, amplitude=-1.0)
    with pytest.raises(fx.ArgumentError, match="exaggeration"):
        fx.animate_mode(paper, II, 1, gif, exaggeration=0.0)
    with pytest.raises(fx.ArgumentError, match=r"neither \.gif nor \.mp4"):
        fx.animate_mode(paper, II, 1, tmp_path / "a.png")
    with pytest.raises(fx.errors.OutputError, match="is no directory"):
        fx.animate_mode(paper, II, 1, tmp_path / "none" / "a.gif")
    with pytest.raises(fx.PoseError, match="batch"):
        fx.animate_mode(paper, fx.Pose([[0, 0, 0.08]]), 1, gif)
    with pytest.raises(fx.ArgumentError, match="window"):
        fx.animate_simulation(simulation, paper, gif, window=(0.05, 0.2))
    with pytest.raises(fx.ArgumentError, match="frames"):
        fx.animate_simulation(simulation, paper, gif, frames=1)
    with pytest.raises(fx.ArgumentError, match="one simulation"):
        fx.animate_simulation(simulation.expand_dims("run"), paper, gif)
    still = fx.simulate(paper, II, duration=0.01, samples=5)
    with pytest.raises(fx.ArgumentError, match="nothing moves"):
        fx.animate_simulation(still * 0 + still.isel(time=0), paper, gif)
    assert not gif.exists()
