"""The report: what it says is what the library says, at every kind of pose, in one file that needs nothing else."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation
from tests.helpers.plain import file, plain_machine
from tests.helpers.support import MACHINES

import flexapod as fx
from flexapod import plots
from flexapod.cli import main
from flexapod.plots import style
from flexapod.report import gather
from flexapod.report import page as whole
from flexapod.report.numbers import brief, shown
from flexapod.report.studies.machine import study
from flexapod.rotations import rotation_from_vector

matplotlib.use("Agg")


def page(findings):
    return whole(study(findings))


CASES = Path(__file__).parents[1] / "data" / "cases"
SINGULAR = fx.Pose.from_rpy(0, 0, 0.244, 0, 0, np.pi / 2)  # of precision-positioner: hexagon over hexagon, turned


@pytest.fixture(scope="module")
def reports():
    """Findings and page of every packaged design at home, made once."""
    made = {}

    def get(name):
        if name not in made:
            h = plain_machine(name)
            findings = gather(h, fx.home_pose(h))
            made[name] = (findings, page(findings))
        return made[name]

    return get


class Elements(HTMLParser):
    """Every element of a page, and that each one is closed."""

    VOID = ("meta", "link", "br", "img", "use")

    def __init__(self, text):
        super().__init__()
        self.found, self.open, self.words = [], [], []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


@pytest.mark.parametrize("name", MACHINES)
def test_the_page_is_whole_and_needs_nothing_else(reports, name):
    findings, said = reports(name)
    elements = Elements(said)
    tags = [tag for tag, _ in elements.found]
    assert tags.count("svg") == 8  # machine, frequencies, six modes
    assert not {"script", "link", "img", "iframe"} & set(tags)
    for tag, attributes in elements.found:
        for key in ("src", "href", "xlink:href"):
            target = attributes.get(key)
            assert target is None or target.startswith("#"), f"<{tag} {key}={target}>"
    assert "@import" not in said
    assert not re.search(r"url\((?!#)", said)
    ids = [attributes["id"] for _, attributes in elements.found if "id" in attributes]
    assert len(ids) == len(set(ids))
    assert {target[1:] for target in re.findall(r'(?:href="|url\()(#[^")]+)', said)} <= set(ids)
    text = " ".join(elements.words)
    for omega in findings.omega:
        assert shown(omega, 6) in text
        assert shown(omega / (2 * np.pi), 5) in text
    for description in findings.descriptions:
        assert description.text[1:] in text
    assert shown(findings.conditioning.metres) in text
    for value in (*findings.rest.leg_force, *findings.damped.damping_ratio[:1]):
        assert shown(value, 4) in text or shown(value, 3) in text


@pytest.mark.parametrize("name", MACHINES)
def test_the_neutral_colours_follow_light_and_dark(reports, name):
    _, html = reports(name)
    body = html[html.index("<body>") :]
    for color in (style.INK, style.FAINT, style.BASE, style.LEG, style.PLATFORM, "#000000"):
        assert color not in body
    css = html[: html.index("</style>")]
    assert set(re.findall(r"var\(--([a-z]+)", body)) <= set(re.findall(r"--([a-z-]+):", css))


def test_findings_are_the_librarys():
    h = plain_machine("motion-base")
    pose = fx.Pose.from_rpy(0.2, -0.1, 2.5, 0.05, 0.1, -0.2)
    f = gather(h, pose, joint="spin_free")
    omega = fx.natural_modes(h, pose, joint="spin_free").omega
    damped = fx.linearise(h, pose, joint="spin_free").modes()
    assert np.array_equal(f.omega, omega)
    assert np.array_equal(f.damped.pole, damped.pole)
    assert np.array_equal(f.rest.leg_force, fx.hold(h, pose).leg_force)
    assert f.conditioning.metres == fx.condition_number(h, pose)
    assert f.conditioning.scaled == fx.condition_number(
        h, pose, characteristic_length=1.6
    )  # the radius of its platform joints
    assert f.sampling_time == pytest.approx(2 * np.pi / (20 * omega[-1]), rel=1e-15)


def test_influences_are_what_small_changes_do():
    # Manipulator I off home: six distinct frequencies. The effects are first-order ones, so that halving a change
    # leaves a difference of second order: with changes of 1e-4 of those in the report about 1e-4 of the effect.
    h = fx.load("mukherjee-i")
    pose = fx.Pose.from_rpy(0.05, 0.15, 0.85, 0.1, -0.1, 0.2)
    found = {one.change: one for one in gather(h, pose).influences}
    index, part = fx.stability_index(h, pose), 1e-4
    move = 0.01 * np.linalg.norm(h.platform_joints, axis=1).max()
    changes = {
        "platform mass + 1 %": {"platform.mass": h.platform_mass * (1 + 0.01 * part)},
        "platform inertia + 1 %": {"platform.inertia": h.platform_inertia * (1 + 0.01 * part)},
        "stiffness of leg 6 + 1 %": {"legs.stiffness[5]": h.legs.stiffness[5] * (1 + 0.01 * part)},
        "mass of the legs' lower parts + 1 %": {"legs.lower.mass": h.legs.lower.mass * (1 + 0.01 * part)},
    }
    for plate, joints in (("platform", h.platform_joints), ("base", h.base_joints)):
        one = found[f"{plate} joint 6 moved by {move * 1e3:.2g} mm"]
        changes[one.change] = {f"{plate}.joints[5]": joints[5] + part * move * np.array(one.direction)}
    center = found[f"platform mass centre moved by {move * 1e3:.2g} mm"]
    moved = h.platform_mass_center + part * move * np.array(center.direction)
    changes[center.change] = {"platform.mass_center": moved}
    for change, values in changes.items():
        effect = (fx.stability_index(h.replace(values), pose) / index - 1) / part
        # 1e-3: second-order part 1e-4, and rounding 1e-13 over changes of 1e-7 to 1e-9.
        assert found[change].effect == pytest.approx(effect, rel=1e-3, abs=1e-8), change
    assert found["stiffness of all legs + 1 %"].effect == pytest.approx(0.005, rel=1e-12)  # omega ~ sqrt(K)


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (None, {"bulk_modulus": "bulk modulus of the oil"}),  # that of the packaged design
        ({"kind": "screw", "axial_rigidity": 2e8, "fixed": 5e7, "zero_length": 0.5},
         {"axial_rigidity": "axial rigidity of the legs", "fixed": "fixed stiffness of the legs"}),
        ({"kind": "table", "lengths": [1.5, 2.5, 4.0], "stiffnesses": [9e6, 8e6, 5e6]},
         {"stiffnesses": "stiffness of all legs at all lengths"}),
    ],
)  # fmt: skip
def test_influences_of_a_stiffness_law(law, words):
    h = fx.load("motion-base").replace({} if law is None else {"legs.stiffness_law": law})
    pose = fx.Pose.from_rpy(0.05, 0.15, 2.4, 0.1, -0.05, 0.1)  # six distinct frequencies
    found = {one.change: one for one in gather(h, pose).influences if one.group == "stiffness"}
    assert found.keys() == {f"{name} + 1 %" for name in words.values()}
    for key, name in words.items():
        values, part = h.values()[f"legs.stiffness_law.{key}"], 1e-4
        up, down = (fx.stability_index(h.replace({f"legs.stiffness_law.{key}": values * (1 + s * part)}), pose) for s in (1, -1))  # fmt: skip
        assert found[f"{name} + 1 %"].effect == pytest.approx(0.01 * (up - down) / (up + down) / part, rel=1e-6)
    assert sum(one.effect for one in found.values()) == pytest.approx(0.005, rel=1e-9)  # omega ~ sqrt(K)


def test_the_effect_on_repeated_modes_is_that_on_their_mean():
    h = plain_machine("precision-positioner")  # threefold symmetry: modes 1 and 2 are one pair
    pose = fx.home_pose(h)
    f = gather(h, pose)
    assert f.clusters[0] == [0, 1]
    one = next(one for one in f.influences if one.change == "stiffness of leg 1 + 1 %")
    part = 1e-3
    changed = h.replace({"legs.stiffness[0]": h.legs.stiffness[0] * (1 + 0.01 * part)})
    before, after = (fx.natural_modes(x, pose).omega[:2].mean() for x in (h, changed))
    assert one.effect == pytest.approx((after / before - 1) / part, rel=1e-3)  # second order: 1e-5; rounding: 1e-8


def test_a_singular_pose_is_reported():
    h = plain_machine("precision-positioner")
    f = gather(h, SINGULAR)
    assert f.omega[0] == 0
    assert f.rest is f.damped is f.influences is None
    assert "The pose is singular" in f.cautions[0].text
    text = " ".join(Elements(page(f)).words)
    assert "not available" in text
    assert np.isfinite(f.shares.strain[:, 1:]).all()
    assert np.isnan(f.shares.strain[:, 0]).all()


def test_near_a_singular_pose_it_warns():
    f = gather(plain_machine("precision-positioner"), fx.Pose.from_rpy(0, 0, 0.244, 0, 0, np.radians(89.5)))
    assert f.cautions[0].text.startswith("Near a singular pose")
    assert f.rest is not None
    assert np.abs(f.rest.leg_force).max() > 0


def test_a_machine_that_falls_over_is_said_to():
    # The isolator on springs twenty times softer: its weight, above them, wins.
    h = plain_machine("cubic-isolator").replace({"legs.stiffness": 500.0})
    f = gather(h, fx.home_pose(h))
    assert (f.damped.pole.real > 0).any()
    assert any(one.text.startswith("Not stable at rest") for one in f.cautions)
    assert any(one.text.startswith("Weight and preload change mode") for one in f.cautions)
    assert "Not stable at rest" in page(f)


def test_what_to_beware_of_is_said(reports):
    f, html = reports("mukherjee-ii")
    assert any("Modes 1 and 2 are nearly repeated" in one.text for one in f.cautions)
    assert all(text in [one.text for one in f.cautions] for text in f.hexapod.warnings)
    assert html.count("<li>") == len(f.cautions)
    h = plain_machine("motion-base")
    high = gather(h, fx.Pose([0, 0, 3.5]))
    (told,) = [one for one in high.cautions if one.code == "limit"]
    assert told.text.startswith("Limit exceeded: legs 1, 2, 3, 4, 5, 6: length 3.")
    assert "6 exceeded" in page(high)
    assert page(high).count('<td class="over">') == 6
    overdamped = h.replace({"legs.damping.prismatic": 1e7})
    assert any("does not vibrate" in one.text for one in gather(overdamped, fx.home_pose(h)).cautions)
    homeless = h.replace({"home": None})
    assert any("has no home pose" in one.text for one in gather(homeless, fx.home_pose(h)).cautions)
    assert gather(h.replace({"legs.stiffness[0]": 7e6}), fx.Pose.from_rpy(0.1, 0.2, 2.4, 0, 0.1, 0)).cautions == []


def test_names_cannot_break_the_page():
    h = plain_machine("motion-base").replace({"name": '<script>alert("x")</script> & co'})
    said = page(gather(h, fx.home_pose(h)))
    assert "<script" not in said
    assert "&lt;script&gt;" in said
    Elements(said)


def test_the_command_prints_a_summary_and_writes_the_page(tmp_path, capsys):
    out = tmp_path / "deep" / "down"
    assert main(["report", "mukherjee-ii", "--out", str(out)]) == 0
    text = capsys.readouterr().out
    assert "492.239 rad/s = 78.342 Hz" in text  # corrections' table, universal
    assert "Warning: " in text
    file = out / "mukherjee-ii.html"
    assert str(file) in text.replace("\n", "")
    assert "492.239" in file.read_text(encoding="utf-8")


def test_the_command_prints_json(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["report", "mukherjee-ii", "--set", "platform.mass=400", "--joint", "spin_free", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["stability_index_rad_s"] == pytest.approx(119.656, abs=6e-4)  # corrections' table, M = 400
    assert found["changes"] == ["platform.mass=400"]
    assert found["html"] is None
    assert not list(tmp_path.iterdir())
    pose = ["--pose", "0", "0", "0.244", "0", "0", "90"]
    assert main(["report", file("precision-positioner"), *pose, "--json", "--out", "."]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["stability_index_rad_s"] == 0
    assert found["static_leg_force_n"] is found["tangent"] is found["condition_number"] is None
    assert (tmp_path / "precision-positioner.html").exists()


def test_an_odd_name_makes_a_plain_file(tmp_path, capsys):
    assert main(["report", "motion-base", "--set", "name=../a b/ü", "--out", str(tmp_path)]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["a-b-ü.html"]
    assert "name=../a b/ü" in " ".join(capsys.readouterr().out.split())  # changes are said
    assert "name=../a b/ü" in (tmp_path / "a-b-ü.html").read_text(encoding="utf-8")


def test_a_place_that_cannot_be_written_exits_with_2(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["report", "motion-base", "--out", str(tmp_path / "file" / "below")]) == 2
    assert "--out" in capsys.readouterr().err


def test_the_machine_is_drawn_where_it_is():
    h = fx.load("mukherjee-i")
    pose = fx.Pose.from_rpy(0.1, 0.2, 0.8, 0.1, 0.2, 0.3)
    ax = plots.machine(h, pose, ax=Figure().add_subplot(projection="3d"))
    drawn = np.concatenate([np.stack(line.get_data_3d(), axis=1) for line in ax.lines])
    for point in (*h.base_joints, *(pose.position + h.platform_joints @ pose.matrix.T)):
        assert np.linalg.norm(drawn - point, axis=1).min() < 1e-12


@pytest.mark.parametrize("number", range(1, 7))
def test_a_mode_is_drawn_as_a_rigid_motion(number):
    h = fx.load("mukherjee-i")
    pose = fx.home_pose(h)
    ax = plots.mode(h, None, fx.natural_modes(h, pose), number, ax=Figure().add_subplot(projection="3d"))
    lines = [np.stack(line.get_data_3d(), axis=1) for line in ax.lines]
    moved = next(points for points in reversed(lines) if len(points) == 6)
    rest = pose.position + h.platform_joints

    def distances(points):
        return np.linalg.norm(points[:, None] - points[None], axis=-1)

    assert np.allclose(distances(moved), distances(rest), rtol=0, atol=1e-12)
    points = np.vstack([h.base_joints, rest])
    size = np.ptp(points, axis=0).max()
    travel = np.linalg.norm(moved - rest, axis=1).max()
    assert 0.14 * size < travel < 0.18 * size  # a sixth, but for the turn being finite


def test_legs_are_coloured_by_their_strain():
    h = plain_machine("motion-base")
    modes = fx.natural_modes(h, fx.home_pose(h))
    heave = [d.dominant for d in fx.describe_modes(h, fx.home_pose(h))].index("z")
    ax = plots.mode(h, None, modes, heave + 1, ax=Figure().add_subplot(projection="3d"))
    legs = [line for line in ax.lines if line.get_linewidth() > 4]
    assert len(legs) == 6  # heave, upwards, stretches all alike
    orange = matplotlib.colors.to_rgb(style.STRETCHED)
    assert all(np.allclose(matplotlib.colors.to_rgb(line.get_color()), orange, atol=0.01) for line in legs)


def test_plots_refuse_what_they_cannot_draw():
    h = plain_machine("motion-base")
    batch = fx.Pose(np.array([[0, 0, 2.3], [0, 0, 2.4]]))
    with pytest.raises(fx.PoseError, match="batch axes"):
        plots.machine(h, batch)
    with pytest.raises(fx.ArgumentError, match="1 to 6"):
        plots.mode(h, None, fx.natural_modes(h, fx.home_pose(h)), 7)
    with pytest.raises(fx.PoseError, match="no home pose"):
        plots.machine(h.replace({"home": None}))


def test_rotation_is_rodrigues():
    for vector in ([0.3, -1.2, 0.7], [0, 0, 1e-9], [0, 0, 0]):
        exact = Rotation.from_rotvec(vector).as_matrix()
        assert np.allclose(rotation_from_vector(vector), exact, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (492.2391, 6, "492.239"),
        (16158.9, 6, "16158.9"),
        (0.0087857, 3, "0.00879"),
        (999.96, 4, "1000"),
        (0.0, 4, "0"),
        (-0.0, 4, "0"),
        (5.598e-6, 3, "5.60e-6"),
        (2.5e9, 3, "2.50e9"),
        (-7910.6, 4, "-7911"),
        (np.inf, 4, "\u221e"),
        (np.nan, 4, "\u2013"),
        (None, 4, "\u2013"),
    ],
)
def test_numbers_are_shown(value, digits, text):
    assert shown(value, digits) == text


def test_given_numbers_are_shown_without_trailing_zeros():
    assert [brief(x) for x in (40.0, 0.4, 1234.0, 2e9)] == ["40", "0.4", "1234", "2.000e9"]


def test_legs_without_a_load_have_no_force_of_rounding():
    """Three struts of the secondary mirror bear nothing: their force is 0, not 1e-15 N."""
    h = fx.load(CASES / "tangential-struts" / "m2-mass.toml")
    findings = gather(h, fx.home_pose(h))
    table = next(section for section in study(findings).sections if section.title == "Legs").items[0]
    force = next(column for column in table.columns if column.title == "static force").values
    assert np.any(findings.rest.leg_force[3:] != 0)
    assert np.array_equal(force, [*findings.rest.leg_force[:3], 0, 0, 0])
