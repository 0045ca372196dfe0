"""[home.turned]: the home pose by angles of another order, about a pivot."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx

TURNED = """[home.turned]
position = [0.1, 0, 2.39]
angles_deg = [10, 20, -15]
rotation_order = "ZXZ"
pivot_mm = [0, 0, 300]
"""


def text(home):
    whole = plain_machine("motion-base").to_toml()
    return whole[: whole.index("[home]")] + home


@pytest.fixture
def hexapod():
    return fx.Hexapod.from_toml(text(TURNED))


def expected(angles=(10, 20, -15), order="ZXZ", pivot=(0, 0, 0.3)):
    return fx.Pose.from_angles([0.1, 0, 2.39], angles, order, degrees=True, pivot=pivot)


def same(home, pose):
    np.testing.assert_allclose(home.position, pose.position, atol=1e-15)
    np.testing.assert_allclose(home.matrix, pose.matrix, atol=1e-15)


def test_home_in_another_order(hexapod):
    same(hexapod.home, expected())
    plain = fx.Hexapod.from_toml(text("[home.turned]\nposition = [0.1, 0, 2.39]\nangles_deg = [10, 20, -15]\n"))
    same(plain.home, fx.Pose.from_rpy(0.1, 0, 2.39, 10, 20, -15, degrees=True))


def test_it_stays_the_source_and_any_key_can_be_changed(hexapod):
    again = fx.Hexapod.from_toml(hexapod.to_toml())
    assert 'rotation_order = "ZXZ"' in hexapod.to_toml()
    assert again.digest == hexapod.digest
    same(hexapod.replace({"home.turned.angles_deg[2]": 5}).home, expected((10, 20, 5)))
    same(hexapod.replace({"home.turned.rotation_order": "XYZ"}).home, expected(order="XYZ"))
    same(hexapod.replace({"home.turned.pivot": [0.1, 0, 0]}).home, expected(pivot=(0.1, 0, 0)))


def test_a_plain_key_takes_its_place(hexapod):
    moved = hexapod.replace({"home.position": [0, 0, 2.4]})
    assert moved.home.position.tolist() == [0, 0, 2.4]
    assert "turned" not in moved.to_toml()
    assert fx.Hexapod.from_toml(moved.to_toml()).digest == moved.digest


@pytest.mark.parametrize(
    ("home", "words"),
    [
        (TURNED.replace("ZXZ", "abc"), "home.turned: the rotation order is 'abc'"),
        (TURNED.replace('"ZXZ"', "3"), 'it must be text. Write home.turned.rotation_order = "XYZ"'),
        (TURNED.replace("angles_deg", "#"), "home.turned.angles is missing"),
        (TURNED + "[home]\nposition = [0, 0, 2]\n", "both given"),
    ],
)
def test_what_is_no_home(home, words):
    with pytest.raises(fx.DesignError, match=words):
        fx.Hexapod.from_toml(text(home))


def test_check_prints_it_back(run, tmp_path):
    (tmp_path / "d.toml").write_text(text(TURNED))
    code, out, _ = run("check", tmp_path / "d.toml")
    lines = " ".join(out.split())
    assert code in (0, 1)
    assert "home.turned.rotation_order ZXZ" in lines
    assert "home.turned.angles [10, 20, -15] deg" in lines
    code, out, _ = run("check", tmp_path / "d.toml", "--set", "home.turned.rotation_order=XYZ")
    assert "home.turned.rotation_order XYZ" in " ".join(out.split())
