"""Designs: lossless files, changes, the layout the core takes, the packaged machines and the short forms."""

import copy
import pickle
import subprocess
import sys
from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from flexapod import _core
from flexapod.design.changes import parse_assignments
from flexapod.design.design_file import packaged_designs, template
from flexapod.design.hexapod import Hexapod
from flexapod.design.home import Home
from flexapod.design.loading import load
from flexapod.design.parts import Damping, LegPart, Legs, Limits
from flexapod.errors import DesignError
from flexapod.mechanics.kinematics import condition_number
from flexapod.pose import Pose

# Warnings that each packaged design must raise, by the key they start with.
PACKAGED = {
    "cubic-isolator": [],
    "dehaeze-cubic": [],
    "dehaeze-general": [],
    "dietmaier-40": [],
    "genhexkins": [],
    "motion-base": [],
    "mukherjee-i": ["platform.inertia", "legs.lower.inertia (all legs)", "legs.upper.inertia (all legs)"],
    "mukherjee-ii": ["legs.lower.inertia (all legs)", "legs.upper.inertia (all legs)"],
    "nairck-6-6": [],
    "precision-positioner": [],
    "roboop-stewart": [],
    "rubin-camera-hexapod": [],
    "rubin-m2-hexapod": [],
    "taghirad-6-3": ["Joints coincide"],
    "wolfram-stewart": [],
}

SMALL = """
[base.circle]
radius = 0.5
angles_deg = [0, 60, 120, 180, 240, 300]
[platform.circle]
radius = 0.3
angles_deg = [20, 40, 140, 160, 260, 280]
[platform]
mass = 10
mass_center = [0, 0, 0]
inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
[legs]
stiffness = 1e7
"""


def force_transformation(hexapod: Hexapod, position: np.ndarray) -> np.ndarray:
    """H at zero orientation, written out here so that the short forms are judged by other code than the package's."""
    legs = position + hexapod.platform_joints - hexapod.base_joints
    s = legs / np.linalg.norm(legs, axis=1, keepdims=True)
    return np.vstack([s.T, np.cross(hexapod.platform_joints, s).T])


# ---- files -----------------------------------------------------------------------------------------------------------

numbers = st.floats(-10, 10, allow_subnormal=True)
positive = st.floats(1e-6, 1e9)


def vectors(*shape: int) -> st.SearchStrategy[np.ndarray]:
    return hnp.arrays(np.float64, shape, elements=numbers)


@st.composite
def inertias(draw: st.DrawFn, *shape: int) -> np.ndarray:
    root = draw(hnp.arrays(np.float64, (*shape, 3, 3), elements=st.floats(-3, 3)))
    matrix = root @ np.swapaxes(root, -1, -2) + 0.1 * np.eye(3)
    return (matrix + np.swapaxes(matrix, -1, -2)) / 2


@st.composite
def joints(draw: st.DrawFn) -> np.ndarray:
    return draw(vectors(6, 3)) + 100 * np.arange(6)[:, None] * [1, 0, 0]  # apart, whatever is drawn


@st.composite
def parts(draw: st.DrawFn) -> LegPart:
    if draw(st.booleans()):
        return LegPart(draw(st.floats(0, 10)), draw(vectors(3)), draw(inertias()))
    mass = draw(hnp.arrays(np.float64, 6, elements=st.floats(0, 10)))
    return LegPart(mass, draw(vectors(6, 3)), draw(inertias(6)))


@st.composite
def designs(draw: st.DrawFn) -> Hexapod:
    one_or_six = st.one_of(positive, hnp.arrays(np.float64, 6, elements=positive))
    low = draw(st.floats(0, 1))
    limits = Limits(
        draw(st.sampled_from([None, [low, low + 1], [[low, low + 1 + leg] for leg in range(6)], [[low, 2]] * 6])),
        draw(st.none() | st.floats(0.1, 3.1)),
        draw(st.none() | st.floats(0.1, 3.1)),
        draw(st.none() | st.floats(0, 1)),
    )
    axes = draw(vectors(6, 3))
    axes[np.linalg.norm(axes, axis=1) < 1e-3] = [0, 1, 0]
    return Hexapod(
        name=draw(st.text(st.characters(exclude_categories=["Cs"]), min_size=1).filter(str.strip)),
        gravity=draw(vectors(3)),
        base_joints=draw(joints()),
        universal_axes=axes,
        platform_joints=draw(joints()),
        platform_mass=draw(positive),
        platform_mass_center=draw(vectors(3)),
        platform_inertia=draw(inertias()),
        legs=Legs(draw(one_or_six), Damping(*(draw(one_or_six) for _ in range(3))), draw(parts()), draw(parts())),
        limits=limits,
        home=draw(st.none() | st.builds(Home, vectors(3), vectors(3).map(lambda rpy: rpy / 2))),
    )


@given(designs())
@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_design_survives_its_file_bit_for_bit(hexapod):
    again = Hexapod.from_toml(hexapod.to_toml())
    assert again.packed.tobytes() == hexapod.packed.tobytes()
    assert again == hexapod
    assert hash(again) == hash(hexapod)
    assert again.digest == hexapod.digest
    assert again.warnings == hexapod.warnings
    assert again.to_toml() == hexapod.to_toml()
    assert again.limits == hexapod.limits
    assert pickle.loads(pickle.dumps(hexapod)) == hexapod
    assert hexapod.replace({}) == hexapod


@pytest.mark.parametrize("name", PACKAGED)
def test_packaged_designs_load_and_warn_as_they_should(name, tmp_path):
    hexapod = load(name)
    assert hexapod.name == name
    starts = [warning.split(":")[0] for warning in hexapod.warnings]
    assert starts == PACKAGED[name]
    assert all("no rigid body has it" in warning or "Joints coincide" in warning for warning in hexapod.warnings)
    hexapod.save(tmp_path / "copy.toml")
    assert load(tmp_path / "copy.toml") == hexapod
    assert load(str(tmp_path / "copy.toml")) == hexapod


@pytest.mark.parametrize("name", PACKAGED)
def test_packaged_designs_are_within_their_limits_at_home(name):
    hexapod = load(name)
    home = hexapod.home
    position, _ = home
    length = np.linalg.norm(position + hexapod.platform_joints @ home.matrix.T - hexapod.base_joints, axis=1)
    if hexapod.limits.leg_length is not None:
        low, high = np.transpose(hexapod.limits.leg_length)
        assert (length > low).all()
        assert (length < high).all()
    assert condition_number(hexapod) < 150


def test_packaged_designs_are_listed_without_the_template():
    assert packaged_designs() == sorted(PACKAGED)


def test_template_loads_under_any_name():
    for name in ("my hexapod", 'a "quoted" \\ näme\n'):
        hexapod = Hexapod.from_toml(template(name))
        assert hexapod.name == name
        assert hexapod.warnings == ()
        assert hexapod.home is not None


def test_a_file_with_every_documented_key():
    text = """
name = "my hexapod"
gravity = [0.0, 0.0, -9.81]
[base]
joints = [[0.6, 0.2, 0.0], [0.1, 0.5, 0.1], [-0.3, 0.3, 0.1], [-0.3, -0.4, 0.0], [0.2, -0.3, -0.05], [0.5, -0.2, 0.0]]
universal_axes = [[-0.81, 0.27, 0.0], [0.2, 0.9, 0.3], [0.9, 0.3, 0.1], [1, 0, 0], [0.7, 0.7, 0], [-0.9, 0.3, -0.1]]
[platform]
joints = [[0.3, 0.0, 0.1], [0.3, 0.2, 0], [0, 0.3, 0], [-0.2, 0.1, -0.1], [-0.15, -0.2, -0.05], [0.15, -0.15, -0.05]]
mass = 40.0
mass_center = [0.04, 0.03, -0.06]
inertia = [[0.06, 0, 0], [0, 0.06, 0], [0, 0, 0.1]]
[legs]
stiffness = 2e8
[legs.damping]
prismatic = 0.001
universal = 0.0001
spherical = 0.0002
[legs.lower]
mass = 3.0
mass_center = [0.4, 0.14, -0.18]
inertia = [[0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]]
[legs.upper]
mass = 1.0
mass_center = [-0.4, 0.0, 0.0]
inertia = [[0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]]
[limits]
"""
    hexapod = Hexapod.from_toml(text)
    assert hexapod.name == "my hexapod"
    np.testing.assert_array_equal(hexapod.legs.stiffness, [2e8] * 6)
    np.testing.assert_array_equal(hexapod.legs.lower.mass_center, [[0.4, 0.14, -0.18]] * 6)
    np.testing.assert_array_equal(hexapod.legs.damping.spherical, [0.0002] * 6)
    np.testing.assert_allclose(np.linalg.norm(hexapod.universal_axes, axis=1), 1, rtol=1e-15)
    assert hexapod.limits == Limits()
    assert hexapod.home is None


def test_what_may_be_left_out():
    hexapod = Hexapod.from_toml(SMALL)
    assert hexapod.name == "hexapod"
    np.testing.assert_array_equal(hexapod.gravity, [0, 0, -9.81])
    assert hexapod.legs.damping == Damping()
    assert hexapod.legs.lower == hexapod.legs.upper == LegPart.massless()
    assert "legs.lower" not in hexapod.to_toml()


def test_a_nameless_file_names_its_design(tmp_path):
    (tmp_path / "shaker.toml").write_text(SMALL)
    assert load(tmp_path / "shaker.toml").name == "shaker"


def test_a_file_with_a_byte_order_mark_and_windows_line_ends(tmp_path):
    (tmp_path / "windows.toml").write_bytes(b"\xef\xbb\xbf" + SMALL.replace("\n", "\r\n").encode())
    assert load(tmp_path / "windows.toml").platform_mass == 10


# ---- values ----------------------------------------------------------------------------------------------------------


def test_arrays_are_read_only_and_stay_so_in_copies():
    hexapod = load("mukherjee-i")
    for design in (hexapod, copy.deepcopy(hexapod), pickle.loads(pickle.dumps(hexapod))):
        assert design == hexapod
        for array in (
            design.base_joints,
            design.universal_axes,
            design.legs.stiffness,
            design.legs.upper.inertia,
            design.home.position,
            design.packed,
        ):
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 1
    with pytest.raises(FrozenInstanceError):
        hexapod.platform_mass = 1.0


def test_a_design_does_not_see_later_changes_of_the_arrays_it_was_made_from():
    stiffness = np.full(6, 1e7)
    legs = Legs(stiffness)
    stiffness[0] = -1
    assert legs.stiffness[0] == 1e7


def test_equality_and_digest_go_by_value():
    one, other = load("mukherjee-ii"), load("mukherjee-ii")
    assert one == other
    assert len({one, other}) == 1
    heavy = one.replace({"platform.mass": 400})
    renamed = one.replace({"name": "other"})
    limited = one.replace({"limits.leg_distance": 0.01})
    moved = one.replace({"home.position": [0, 0, 0.09]})
    assert len({one, heavy, renamed, limited, moved}) == 5
    assert renamed.digest == one.digest
    assert len({design.digest for design in (one, heavy, limited, moved)}) == 4
    assert one != "mukherjee-ii"
    # Minus zero and zero are the same number, so they make the same design.
    assert one.replace({"gravity": [-0.0, -0.0, -9.81]}).digest == one.digest


def test_packed_layout():
    hexapod = load("mukherjee-i").replace(
        {
            "legs.stiffness": [1, 2, 3, 4, 5, 6],
            "legs.damping.prismatic": [10, 20, 30, 40, 50, 60],
            "legs.damping.universal": 0.5,
            "legs.damping.spherical": 0.25,
            "platform.inertia": [[1, 0.04, 0.05], [0.04, 2, 0.06], [0.05, 0.06, 2.5]],
        }
    )
    packed = hexapod.packed
    assert packed.shape == (_core.design_size,)
    assert packed.dtype == np.float64
    np.testing.assert_array_equal(packed[:3], hexapod.gravity)
    np.testing.assert_array_equal(packed[3:21].reshape(6, 3), hexapod.base_joints)
    np.testing.assert_array_equal(packed[21:39].reshape(6, 3), hexapod.universal_axes)
    np.testing.assert_array_equal(packed[39:57].reshape(6, 3), hexapod.platform_joints)
    np.testing.assert_array_equal(packed[57:67], [40, 0.04, 0.03, -0.06, 1, 2, 2.5, 0.04, 0.05, 0.06])
    legs = packed[67 : _core.plain_size].reshape(6, 24)
    np.testing.assert_array_equal(legs[:, 0], [1, 2, 3, 4, 5, 6])
    np.testing.assert_array_equal(legs[:, 1], [10, 20, 30, 40, 50, 60])
    np.testing.assert_array_equal(legs[:, 2:4], [[0.5, 0.25]] * 6)
    np.testing.assert_array_equal(
        legs[2, 4:14], [3, 0.4, 0.14, -0.18, 0.010, 0.002, 0.001, 0.005, 0.007, 0.003], strict=False
    )
    np.testing.assert_array_equal(legs[5, 14:], [1, -0.6, -0.08, 0.08, 0.005, 0.002, 0.003, 0.002, 0.002, 0.001])


def test_repr_is_short_and_says_which_machine():
    text = repr(load("mukherjee-ii"))
    assert "mukherjee-ii" in text
    assert "4 kg" in text
    assert "8e+07 N/m" in text
    assert len(text) < 160


# ---- changes ---------------------------------------------------------------------------------------------------------


def test_replace_by_key_unit_index_and_text():
    hexapod = load("mukherjee-ii")
    assert hexapod.replace({"platform.mass": 400.0}).platform_mass == 400.0
    assert hexapod.platform_mass == 4.0
    assert hexapod.replace({"platform.mass_g": 500}).platform_mass == 0.5
    assert hexapod.replace({"platform.mass": "400"}).platform_mass == 400.0
    np.testing.assert_array_equal(hexapod.replace({"legs.stiffness_N_per_um": 20}).legs.stiffness, [2e7] * 6)
    np.testing.assert_array_equal(
        hexapod.replace({"legs.stiffness[2]": 1e7}).legs.stiffness, [8e7, 8e7, 1e7, 8e7, 8e7, 8e7]
    )
    np.testing.assert_array_equal(
        hexapod.replace({"legs.stiffness_N_per_um[5]": "10"}).legs.stiffness, [8e7, 8e7, 8e7, 8e7, 8e7, 1e7]
    )
    assert hexapod.replace({"base.joints_mm[1][2]": 3}).base_joints[1, 2] == 0.003
    np.testing.assert_array_equal(hexapod.replace({"base.joints[1]": [1, 2, 3]}).base_joints[1], [1, 2, 3])
    np.testing.assert_array_equal(
        hexapod.replace({"platform.mass_center": np.array([0, 0, 0.1])}).platform_mass_center, [0, 0, 0.1]
    )
    assert hexapod.replace({"name": "other"}).name == "other"


def test_replace_two_sides_of_a_matrix_at_once():
    changes = {"platform.inertia[0][1]": 1e-5, "platform.inertia[1][0]": 1e-5}
    assert load("mukherjee-ii").replace(changes).platform_inertia[1, 0] == 1e-5


def test_replace_the_whole_and_one_leg_of_it():
    changed = load("mukherjee-ii").replace({"legs.stiffness": 1e6, "legs.stiffness[0]": 2e6})
    np.testing.assert_array_equal(changed.legs.stiffness, [2e6, 1e6, 1e6, 1e6, 1e6, 1e6])


def test_replace_gives_parts_to_massless_legs_and_takes_them_away():
    hexapod = Hexapod.from_toml(SMALL)
    heavy = hexapod.replace({"legs.lower": {"rod": {"mass": 3, "length": 0.5}}, "legs.upper.mass": 1})
    np.testing.assert_array_equal(heavy.legs.lower.mass_center[0], [0.25, 0, 0])
    np.testing.assert_array_equal(heavy.legs.upper.mass, [1] * 6)
    assert heavy.replace({"legs.lower": None, "legs.upper": None}) == hexapod


def test_replace_takes_optional_keys_out():
    hexapod = load("motion-base")
    assert hexapod.replace({"home": None}).home is None
    assert hexapod.replace({"limits": None}).limits == Limits()
    assert hexapod.replace({"limits.leg_length": None}).limits.leg_length is None
    with pytest.raises(DesignError, match=r"platform\.mass .*Add it"):
        hexapod.replace({"platform.mass": None})


def test_replace_with_a_short_form_makes_the_axes_tangent_again_and_single_joints_do_not():
    hexapod = load("mukherjee-i")
    circle = {"base.circle.radius": 0.5, "base.circle.angles_deg": [0, 60, 120, 180, 240, 300]}
    round_base = hexapod.replace(circle)
    np.testing.assert_allclose(round_base.universal_axes[0], [0, 1, 0], atol=1e-15)
    moved = hexapod.replace({"base.joints[0][0]": 0.7})
    np.testing.assert_array_equal(moved.universal_axes, hexapod.universal_axes)


def test_assignments_of_a_command_line():
    changes = parse_assignments(["platform.mass=400", "legs.stiffness_N_per_um[2] = 20", "gravity=[0, 0, -1.62]"])
    moon = load("mukherjee-ii").replace(changes)
    assert moon.platform_mass == 400
    assert moon.legs.stiffness[2] == 2e7
    assert moon.gravity[2] == -1.62


# ---- short forms and units -------------------------------------------------------------------------------------------


def test_circle_is_the_published_joint_pattern():
    """The 20 N/um hexapod of Dehaeze's dynamics study: its compliance 60 mm above the platform joints."""
    hexapod = Hexapod.from_toml(
        SMALL.replace("radius = 0.5", "radius_mm = 115")
        .replace("[0, 60, 120, 180, 240, 300]", "[-10, 10, 110, 130, 230, 250]")
        .replace("radius = 0.3", "radius_mm = 90\nheight_mm = -60")
        .replace("[20, 40, 140, 160, 260, 280]", "[-50, 50, 70, 170, 190, -70]")
        .replace("stiffness = 1e7", "stiffness_N_per_um = 20")
    )
    H = force_transformation(hexapod, np.array([0, 0, 0.12]))
    C = np.linalg.inv(H @ np.diag(hexapod.legs.stiffness) @ H.T)
    published = [4.750e-8, 4.750e-8, 2.099e-8, 5.186e-6, 5.186e-6, 1.707e-6]
    np.testing.assert_allclose(np.diag(C), published, rtol=3e-4)  # their four printed digits
    np.testing.assert_allclose([C[0, 4], C[1, 3]], [3.209e-7, -3.209e-7], rtol=2e-4)


# H and MO_B (plate to plate, point above moving plate), Hc, FOc in mm; printed K_thx, K_thz, K15.
CUBES = [
    (100, -50, 100, 50, 0.015, 0.06, 0.0),
    (100, 20, 100, 50, 0.025, 0.06, -0.14),
    (80, -30, 100, 50, 0.015, 0.06, 0.0),
    (100, -50, 150, 60, 0.034, 0.14, 0.02),
]


@pytest.mark.parametrize(("H", "MO_B", "Hc", "FOc", "k_thx", "k_thz", "k15"), CUBES)
@pytest.mark.parametrize("middle", [0.2, 0.9])
def test_cubic_is_the_published_one(H, MO_B, Hc, FOc, k_thx, k_thz, k15, middle):
    """Stiffness of cubic hexapods, k = 1 N/m (Dehaeze, cubic-configuration): exact by formula, and to the print."""
    d = (FOc - (H + MO_B)) / 1000
    text = SMALL[SMALL.index("[platform]") :].replace("1e7", "1")
    text += f"[cubic]\nheight_mm = {Hc}\nmiddle = {middle}\n"
    text += f"center_in_base_mm = [0, 0, {FOc}]\ncenter_in_platform = [0, 0, {d}]\n"
    hexapod = Hexapod.from_toml(text)
    np.testing.assert_allclose(hexapod.home.position, [0, 0, (H + MO_B) / 1000], atol=1e-15)
    H6 = force_transformation(hexapod, hexapod.home.position)
    K = H6 @ H6.T
    hc = Hc / 1000
    exact = np.diag([2, 2, 2, 1.5 * hc**2 + 2 * d**2, 1.5 * hc**2 + 2 * d**2, 6 * hc**2])
    exact[0, 4] = exact[4, 0] = 2 * d
    exact[1, 3] = exact[3, 1] = -2 * d
    np.testing.assert_allclose(K, exact, atol=1e-14)
    np.testing.assert_allclose([K[3, 3], K[5, 5], K[0, 4]], [k_thx, k_thz, k15], atol=6e-4 if k_thz == 0.06 else 6e-3)
    length = np.linalg.norm(hexapod.home.position + hexapod.platform_joints - hexapod.base_joints, axis=1)
    np.testing.assert_allclose(length, middle * np.sqrt(3) * hc, rtol=1e-14)


def test_cubic_by_edge_is_cubic_by_height():
    text = SMALL[SMALL.index("[platform]") :] + "[cubic]\nmiddle = 0.5\n"
    by_edge = Hexapod.from_toml(text + "edge = 0.3\n")
    by_height = Hexapod.from_toml(text + f"height = {0.3 / np.sqrt(3)}\n")
    np.testing.assert_allclose(by_edge.packed, by_height.packed, rtol=1e-15, atol=1e-16)
    np.testing.assert_allclose(by_edge.base_joints[:, 2], 0, atol=1e-16)
    directions = by_edge.home.position + by_edge.platform_joints - by_edge.base_joints
    cosines = directions @ directions.T / 0.15**2
    np.testing.assert_allclose(np.sort(np.abs(cosines), axis=1), [[0, 0, 0, 0, 1, 1]] * 6, atol=1e-14)


def test_default_axes_are_tangent_to_the_base_circle():
    hexapod = Hexapod.from_toml(SMALL)
    joints, axes = hexapod.base_joints, hexapod.universal_axes
    np.testing.assert_allclose(np.cross([0, 0, 1], joints / 0.5), axes, atol=1e-15)


def test_rod_is_a_uniform_cylinder_from_its_joint():
    rod = "[legs.lower.rod]\nmass = 3\nlength_mm = 400\nradius_mm = 20\n[legs.upper.rod]\nmass_g = 500\nlength = 0.2\n"
    legs = Hexapod.from_toml(SMALL + rod).legs
    # Moments of a cylinder by adding up thin slices: an independent sum with an error of (1 / slices)^2.
    x = (np.arange(4000) + 0.5) / 4000 * 0.4 - 0.2
    across = 3 * ((x**2).mean() + 0.02**2 / 4)
    np.testing.assert_allclose(np.diag(legs.lower.inertia[3]), [3 * 0.02**2 / 2, across, across], rtol=1e-6)
    np.testing.assert_array_equal(legs.lower.mass_center, [[0.2, 0, 0]] * 6)
    np.testing.assert_array_equal(legs.upper.mass_center, [[-0.1, 0, 0]] * 6)
    np.testing.assert_allclose(np.diag(legs.upper.inertia[0]), [0, 0.5 * 0.2**2 / 12, 0.5 * 0.2**2 / 12], rtol=1e-15)


@pytest.mark.parametrize(
    ("plain", "with_unit"),
    [
        ("mass = 10", "mass_g = 10000"),
        ("mass = 10", "mass_t = 0.01"),
        ("mass_center = [0, 0, 0]", "mass_center_mm = [0, 0, 0]"),
        ("inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]", "inertia_kg_mm2 = [[1e6, 0, 0], [0, 1e6, 0], [0, 0, 1e6]]"),
        ("inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]", "inertia_g_mm2 = [[1e9, 0, 0], [0, 1e9, 0], [0, 0, 1e9]]"),
        ("stiffness = 1e7", "stiffness_N_per_um = 10"),
        ("stiffness = 1e7", "stiffness_N_per_mm = 1e4"),
        ("radius = 0.5", "radius_mm = 500"),
        ("radius = 0.5", "radius_m = 0.5"),
        ("[base.circle]", "gravity_mm_per_s2 = [0, 0, -9810]\n[base.circle]"),
    ],
)
def test_a_unit_in_the_key_gives_the_same_number_to_the_last_bit(plain, with_unit):
    assert plain in SMALL
    assert Hexapod.from_toml(SMALL.replace(plain, with_unit)) == Hexapod.from_toml(SMALL)


def test_angles_and_limits_and_home_with_units():
    text = SMALL + (
        "[limits]\nleg_length_mm = [[500, 700], [500, 700], [500, 700], [500, 700], [500, 700], [400, 800]]\n"
        "universal_angle_deg = 45\nspherical_angle = 0.5\nleg_distance_mm = 60\n"
        "[home]\nposition_mm = [0, 0, 500]\norientation_deg = [0, 90, 180]\n"
    )
    hexapod = Hexapod.from_toml(text)
    np.testing.assert_array_equal(hexapod.limits.leg_length[5], [0.4, 0.8])
    assert hexapod.limits.universal_angle == np.pi / 4
    assert hexapod.limits.spherical_angle == 0.5
    assert hexapod.limits.leg_distance == 0.06
    position, rpy = hexapod.home
    np.testing.assert_array_equal(position, [0, 0, 0.5])
    np.testing.assert_array_equal(rpy, [0, np.pi / 2, np.pi])


# ---- the paper's machines --------------------------------------------------------------------------------------------


def test_manipulator_two_has_the_published_condition_number():
    hexapod = load("mukherjee-ii")
    position, _ = hexapod.home
    np.testing.assert_array_equal(position, [0, 0, 0.085])
    condition = np.linalg.cond(force_transformation(hexapod, position))
    assert condition == pytest.approx(136.7985, abs=5e-5)  # the digits printed


def test_manipulator_two_without_leg_mass_has_the_published_frequencies():
    hexapod = load("mukherjee-ii")
    H = force_transformation(hexapod, hexapod.home.position)
    root = np.linalg.inv(np.diag([2.0, 2, 2, 0.01, 0.01, 0.01]))  # square root of mass 4 and inertia 1e-4
    omega = np.sort(np.linalg.svd(root @ H * np.sqrt(hexapod.legs.stiffness), compute_uv=False))
    published = [1226.969, 1229.873, 9819.538, 16564.807, 67114.551, 67248.287]
    np.testing.assert_allclose(omega, published, atol=6e-4)  # three printed decimals


def test_readings_of_the_appendix():
    one, two = load("mukherjee-i"), load("mukherjee-ii")
    np.testing.assert_array_equal(one.legs.upper.mass_center[0], [-0.6, -0.08, 0.08])
    np.testing.assert_array_equal(two.legs.upper.mass_center[0], [-0.6, -0.008, 0.008])
    np.testing.assert_array_equal(two.legs.upper.inertia[0][2], [0.2e-5, 0.1e-5, 0.3e-5])
    np.testing.assert_array_equal(one.universal_axes, two.universal_axes)
    np.testing.assert_allclose(np.linalg.norm(one.universal_axes, axis=1), 1, rtol=1e-15)
    assert (one.platform_mass, two.platform_mass) == (40, 4)


def test_loading_a_design_imports_nothing_slow():
    code = (
        "import sys, flexapod.design.loading as h; before = set(sys.modules); h.load('mukherjee-ii'); "
        "new = set(sys.modules) - before; "
        "print(new & {'tomlkit', 'scipy', 'xarray', 'matplotlib', 'difflib'}, 'tomlkit' in before)"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "set() False"


# ---- made in Python --------------------------------------------------------------------------------------------------


def test_home_is_a_pose_that_keeps_its_angles():
    machine = load("mukherjee-i").replace({"home.orientation": [0.1, -0.2, 7 / 3]})
    home = machine.home
    assert isinstance(home, Pose)
    assert home == Pose.from_rpy(*home.position, 0.1, -0.2, 7 / 3)
    np.testing.assert_array_equal(home.rpy, [0.1, -0.2, 7 / 3])
    position, rpy = home
    assert position.tolist() == home.position.tolist()
    assert rpy.tolist() == home.rpy.tolist()
    assert pickle.loads(pickle.dumps(home)) == copy.deepcopy(home) == home


def parts_of(machine: Hexapod, **changes) -> dict:
    names = ("base_joints", "platform_joints", "platform_mass", "platform_mass_center", "platform_inertia", "legs")
    return {name: getattr(machine, name) for name in names} | changes


def test_a_home_may_be_any_pose():
    machine = load("mukherjee-ii")
    for home in ([0, 0, 0.1, 0.2, 0.1, -0.3], Pose.from_rpy(0, 0, 0.1, 0.2, 0.1, -0.3)):
        made = Hexapod(**parts_of(machine, home=home))
        np.testing.assert_allclose(made.home.rpy, [0.2, 0.1, -0.3], rtol=1e-15)
        assert Hexapod.from_toml(made.to_toml()) == made
    with pytest.raises(DesignError, match=r"home has batch axes \(2,\)"):
        Hexapod(**parts_of(machine, home=Pose(np.zeros((2, 3)))))


def test_axes_and_products_of_inertia_may_be_left_out():
    small = Hexapod.from_toml(SMALL)
    made = Hexapod(**parts_of(small, platform_inertia=[0.1, 0.2, 0.25]))
    np.testing.assert_array_equal(made.universal_axes, small.universal_axes)
    np.testing.assert_array_equal(made.platform_inertia, np.diag([0.1, 0.2, 0.25]))
    assert small.replace({"platform.inertia_g_m2": [100, 200, 250]}).platform_inertia.tolist() == (
        np.diag([0.1, 0.2, 0.25]).tolist()
    )
    assert LegPart(1.0, [0, 0, 0], [1, 2, 3]) == LegPart(1.0, [0, 0, 0], np.diag([1.0, 2, 3]))


def test_from_circles_is_the_short_form_of_the_file():
    file = Hexapod.from_toml(template("machine"))
    made = Hexapod.from_circles(
        0.5,
        0.3,
        0.5,
        base_half_angle=10,
        platform_half_angle=10,
        degrees=True,
        platform_mass=60.0,
        platform_mass_center=[0, 0, 0.05],
        platform_inertia=[1.95, 1.95, 3.675],
        stiffness=20e6,
        damping=Damping(200.0, 0.1, 0.1),
        lower=file.legs.lower,
        upper=LegPart.rod(1.0, 0.35, 0.015, upper=True),
        limits=file.limits,
        name=file.name,
    )
    assert made == file
    radians = Hexapod.from_circles(
        0.5,
        0.3,
        0.5,
        base_angles=np.radians([50, 70, 170, 190, 290, 310]),
        platform_half_angle=np.radians(10),
        platform_mass=60.0,
        platform_inertia=[1.95, 1.95, 3.675],
        stiffness=20e6,
        damping=200.0,
    )
    np.testing.assert_allclose(radians.base_joints, file.base_joints, atol=1e-15)
    np.testing.assert_allclose(radians.platform_joints, file.platform_joints, atol=1e-15)
    np.testing.assert_array_equal(radians.legs.damping.prismatic, 200.0)


def test_circles_need_one_of_half_angle_and_angles():
    given = {"platform_mass": 1.0, "platform_inertia": [1, 1, 1], "stiffness": 1e6, "platform_half_angle": 0.1}
    with pytest.raises(DesignError, match="base_half_angle and base_angles are both missing"):
        Hexapod.from_circles(0.5, 0.3, 0.5, **given)
    with pytest.raises(DesignError, match=r"base.circle.radius is -0.5 m; it must be > 0"):
        Hexapod.from_circles(-0.5, 0.3, 0.5, base_half_angle=0.1, **given)
    with pytest.raises(DesignError, match=r"base_half_angle is -0.1 rad; it must be >= 0"):
        Hexapod.from_circles(0.5, 0.3, 0.5, base_half_angle=-0.1, **given)
    assert "Joints coincide" in Hexapod.from_circles(0.5, 0.3, 0.5, base_half_angle=0, **given).warnings[0]


def test_keys_by_keyword_and_fields_names():
    machine = load("mukherjee-ii")
    assert machine.replace(gravity=[0, 0, 0]).gravity.tolist() == [0, 0, 0]
    for wrong in ({"platform_mass": 5.0}, {"platform_mass_g": 5000.0}):
        with pytest.raises(DesignError, match=r"Did you mean platform\.mass"):
            machine.replace(wrong)
        with pytest.raises(DesignError, match=r"Did you mean platform\.mass"):
            machine.replace(**wrong)
    with pytest.raises(DesignError, match=r"legs\.lower is 3; it must be a LegPart"):
        Legs(1e7, lower=3)
