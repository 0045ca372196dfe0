"""Loads of a path in numbers of each leg, and with payloads: against bodies put together by hand."""

import csv
import io

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import flexapod as fx

MACHINE = fx.load("motion-base")
MOTION = "t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n0.5,0.1,0,0.05,5,0,0\n1,0,0.1,0,0,5,10\n2,0,0,0,0,0,0\n"
ROWS = [[0, 0, 0, 0, 0, 0], [0.1, 0, 0.05, np.radians(5), 0, 0], [0, 0.1, 0, 0, np.radians(5), np.radians(10)], [0] * 6]
PATH = fx.Trajectory(ROWS, [0, 0.5, 1, 2], origin=MACHINE.home)


@pytest.fixture
def motion(tmp_path):
    file = tmp_path / "motion.csv"
    file.write_text(MOTION)
    return file


def together(machine, mass, at, inertia):
    """Platform and payload as one body, by sums over point masses that have the same mass, centre and inertia."""
    points, masses = [], []
    for m, centre, J in (
        (machine.platform_mass, machine.platform_mass_center, machine.platform_inertia),
        (mass, np.array(at), np.array(inertia)),
    ):
        second = np.trace(J) / 2 * np.eye(3) - J  # integral of r r^T dm
        value, axes = np.linalg.eigh(second)
        for k in range(3):  # a pair of masses along each principal axis
            arm = np.sqrt(3 * max(value[k], 0) / m) * axes[:, k]
            points += [centre + arm, centre - arm]
            masses += [m / 6, m / 6]
    r, w = np.array(points), np.array(masses)
    centre = w @ r / w.sum()
    d = r - centre
    J = (w[:, None, None] * ((d**2).sum(axis=1)[:, None, None] * np.eye(3) - d[:, :, None] * d[:, None])).sum(axis=0)
    return {"platform.mass": w.sum(), "platform.mass_center": centre, "platform.inertia": J}


def test_a_payload_is_part_of_the_platform():
    inertia = np.array([[4.0, 0.3, 0.1], [0.3, 5.0, -0.2], [0.1, -0.2, 6.0]])
    at = (0.1, -0.2, 0.6)
    case = fx.paths.PayloadCase("crate", 250.0, at, inertia)
    found = fx.paths.payload_loads(MACHINE, PATH, [fx.paths.PayloadCase("empty"), case], samples=50)
    loaded = MACHINE.replace(together(MACHINE, 250.0, at, inertia))
    expected = fx.paths.path_loads(loaded, PATH, samples=50)
    apart = found.leg_force.sel(case="crate") - expected.leg_force
    assert abs(apart).max() < 1e-12 * abs(expected.leg_force).max()
    np.testing.assert_array_equal(
        found.leg_force.sel(case="empty"), fx.paths.path_loads(MACHINE, PATH, samples=50).leg_force
    )
    assert float(found.least_index.sel(case="crate")) == pytest.approx(fx.path_index(loaded, PATH, samples=50).minimum)


def test_weight_of_a_payload_is_borne():
    """The vertical parts of all leg forces differ by the payload's weight and inertia: Newton's second law."""
    loads = fx.paths.payload_loads(
        MACHINE, PATH, [fx.paths.PayloadCase("empty"), fx.paths.PayloadCase("full", 300.0)], samples=60
    )
    motion = PATH(loads.time.values)
    H = fx.force_transformation(MACHINE, motion.pose)
    more = np.einsum("nij,nj->ni", H, (loads.leg_force.sel(case="full") - loads.leg_force.sel(case="empty")).values)
    expected = 300.0 * (motion.acceleration + np.array([0, 0, 9.81]))
    np.testing.assert_allclose(more[:, :3], expected, atol=1e-10 * 300 * 9.81)


def test_a_force_on_the_platform_is_a_case():
    case = fx.paths.PayloadCase("wind", force=(0, 500, 0), moment=(0, 0, 20))
    found = fx.paths.payload_loads(MACHINE, PATH, [case], samples=20).isel(case=0)
    expected = fx.paths.path_loads(MACHINE, PATH, samples=20, force=(0, 500, 0), moment=(0, 0, 20))
    np.testing.assert_array_equal(found.leg_force, expected.leg_force)


def test_extremes_and_means_of_a_motion_that_has_a_closed_form():
    """A massless-legged machine that moves as a sine along z: forces, rates and their means by hand."""
    a, w, n = 0.002, 2 * np.pi, 24
    machine = fx.Hexapod.from_circles(
        1.0, 0.5, 1.0, base_half_angle=10, platform_half_angle=12, degrees=True,
        platform_mass=10.0, platform_inertia=[1, 1, 1], stiffness=1e7,
    )  # fmt: skip
    t = np.linspace(0, 1, n + 1)
    path = fx.Trajectory(np.c_[0 * t, 0 * t, 1 + a * np.sin(w * t), 0 * t, 0 * t, 0 * t], t, ends="periodic")
    loads = fx.paths.path_loads(machine, path, samples=4800)
    s = np.linspace(0, 1, 100_001)
    z = 1 + a * np.sin(w * s)
    flat = (machine.platform_joints - machine.base_joints)[:, :2]
    length = np.sqrt((flat**2).sum(axis=1) + z[:, None] ** 2)
    rate = z[:, None] / length * (a * w * np.cos(w * s))[:, None]
    H = fx.force_transformation(machine, fx.Pose(np.c_[0 * z, 0 * z, z]))
    wrench = np.zeros((s.size, 6))
    wrench[:, 2] = 10 * (9.81 - a * w**2 * np.sin(w * s))
    force = np.linalg.solve(H, wrench[..., None])[..., 0]
    for name, values in (("rate", rate), ("force", force), ("power", force * rate)):
        size = np.abs(values).max()
        mean = np.sqrt(np.trapezoid(values**2, s, axis=0))
        np.testing.assert_allclose(loads[f"rms_{name}"], mean, atol=1e-5 * size)
        np.testing.assert_allclose(loads[f"least_{name}"], values.min(axis=0), atol=1e-5 * size)
        np.testing.assert_allclose(loads[f"greatest_{name}"], values.max(axis=0), atol=1e-5 * size)


def test_series_are_the_library_s_numbers(run, motion):
    code, out, err = run("path", "motion-base", motion, "--from-home", "--csv")
    assert code == 0, err
    rows = list(csv.DictReader(io.StringIO(out)))
    loads = fx.paths.path_loads(MACHINE, PATH)
    assert len(rows) == loads.time.size
    np.testing.assert_array_equal([float(row["time_s"]) for row in rows], loads.time)
    for leg in loads.leg.values:
        for name, unit in (("leg_length", "m"), ("leg_rate", "m_per_s"), ("leg_acceleration", "m_per_s2"), ("leg_force", "N"), ("power", "W")):  # fmt: skip
            read = [float(row[f"{name}_{leg}_{unit}"]) for row in rows]
            np.testing.assert_allclose(read, loads[name].sel(leg=leg), rtol=1e-9, atol=1e-9)
    assert [float(row["z_m"]) for row in rows] == pytest.approx(PATH(loads.time.values).pose.position[:, 2])
    assert not any("moment" in title for title in rows[0])


def test_moments_of_springs_in_the_joints_are_in_the_series(run, result, motion):
    soft = ["--set", "legs.joint_stiffness.spherical=300"]
    code, out, err = run("path", "motion-base", motion, "--from-home", "--csv", *soft)
    assert code == 0, err
    rows = list(csv.DictReader(io.StringIO(out)))
    machine = MACHINE.replace({"legs.joint_stiffness.spherical": 300})
    expected = fx.joint_moments(machine, PATH([float(row["time_s"]) for row in rows]).pose).bending_moment
    read = [[float(row[f"bending_moment_{leg}_N_m"]) for leg in range(1, 7)] for row in rows]
    np.testing.assert_allclose(read, expected, rtol=1e-9, atol=1e-9)
    found = result("path", "motion-base", motion, "--from-home", *soft)
    np.testing.assert_allclose(found["leg_peak_bending_moment_N_m"], expected.max(axis=0), rtol=1e-9)


def test_cases_stand_side_by_side(run, result, motion, tmp_path):
    table = tmp_path / "cases.csv"
    table.write_text('case,mass_kg,z_mm,ixx,iyy,izz,force_y\n"crate, full",250,600,4,5,6,0\nwind,0,0,0,0,0,900\n')
    line = ["path", "motion-base", motion, "--from-home", "--payload", "100kg", 0, 0, "500mm", "--payloads", table]
    found = result(*line)
    assert found["payloads"]["case"] == ["design", "100 kg at 0 0 0.5 m", "crate, full", "wind"]
    cases = [
        fx.paths.PayloadCase("a", 100, (0, 0, 0.5)),
        fx.paths.PayloadCase("b", 250, (0, 0, 0.6), (4, 5, 6)),
        fx.paths.PayloadCase("c", force=(0, 900, 0)),
    ]
    expected = fx.paths.payload_loads(MACHINE, PATH, cases)
    for name in ("least_force_N", "greatest_force_N", "rms_force_N", "greatest_power_W"):
        variable = name.rsplit("_", 1)[0]
        np.testing.assert_allclose(found["payloads"][f"leg_{name}"][1:], expected[variable], rtol=1e-9)
        assert found["payloads"][f"leg_{name}"][0] == found[f"leg_{name}"]
    code, out, _ = run(*line, "--csv")
    rows = list(csv.DictReader(io.StringIO(out)))
    assert code == 0
    assert [row["case"] for row in rows[:: len(rows) // 4]] == found["payloads"]["case"]
    code, out, _ = run(*line)
    assert "The worst case of each leg" in out
    limit = f"limits.leg_compression={max(found['leg_peak_force_N']) + 100}"
    limited = result(*line, "--set", limit, "--out", tmp_path)
    (told,) = limited["warnings"]  # once, with the worst of them
    assert told.startswith("With the payloads 100 kg at 0 0 0.5 m, crate, full, wind; with ")
    peaks = dict(zip(found["payloads"]["case"], np.max(found["payloads"]["leg_peak_force_N"], axis=1), strict=True))
    worst = max(peaks, key=peaks.get)
    assert f"with {worst}, the worst: The force of leg" in told
    assert f"Drawn is the payload {worst}, which needs most of all." in (tmp_path / "path.html").read_text()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("case,mass\n", "there are no rows"),
        ("case,mass\na,-1\n", r"line 2: mass of the payload 'a' is -1.0 kg; it must be finite and >= 0"),
        ("case,mass\na,1\na,2\n", "two payloads are called 'a'"),
        (
            "case,mass\na,1\ndesign,1\n",
            "line 3: a payload is called 'design', as the machine without payloads is called",
        ),
        (
            "mass,ixx,iyy,izz\n1,1,1,-5\n",
            "line 2: inertia of the payload '1' is of no body: its smallest principal moment",
        ),
        ("case,mass,ixx,iyy,izz\na,0,1,1,1\n", "mass of the payload 'a' is 0 although it has an inertia"),
        ("case,weight\na,1\n", "column 'weight' is unknown"),
        ("case,mass_m\na,1\n", "has the unit 'm'; it may be kg"),
        ("case,mass\n,1\n", "line 2: name of a payload is ''"),
    ],
)
def test_wrong_payloads_are_told(run, motion, tmp_path, text, words):
    (tmp_path / "cases.csv").write_text(text)
    code, _, err = run("path", "motion-base", motion, "--from-home", "--payloads", tmp_path / "cases.csv")
    assert code == 2
    assert words in err


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: fx.paths.payload_loads(MACHINE, PATH, []), "has 0 cases"),
        (lambda: fx.paths.payload_loads(MACHINE, PATH, [12.0]), "a payload is 12.0; it must be a PayloadCase"),
        (lambda: fx.paths.payload_loads(MACHINE, PATH, fx.paths.PayloadCase("a")), "must be a list of"),
        (lambda: fx.paths.PayloadCase("a", np.nan), "must be finite and >= 0"),
        (lambda: fx.paths.PayloadCase("a", 1, (0, 0)), r"shape \(2,\)"),
        (lambda: fx.paths.PayloadCase("a", 1, inertia=np.triu(np.ones((3, 3)))), "is not symmetric"),
    ],
)
def test_wrong_cases_are_told(build, words):
    with pytest.raises(fx.ArgumentError, match=words):
        build()


@pytest.mark.parametrize(
    ("moments", "warns"),
    [
        ((0, 0, 0), False),
        ((0, 1, 1), False),  # a rod
        ((1, 1, 2), False),  # a plate
        ((1, 1, 2.0001), True),  # a plate of few digits
        ((0, 0, 1), True),
    ],
)
def test_flat_payloads_are_taken_and_what_is_no_body_is_told(moments, warns):
    """As those of a design: at any size, and however the body is turned."""
    for seed in range(20):
        axes = Rotation.random(random_state=seed).as_matrix()
        inertia = axes @ np.diag(moments) @ axes.T * 10.0 ** (seed % 9 - 5)
        found = fx.paths.PayloadCase("a", 1.0, inertia=inertia).warnings
        assert len(found) == warns
        assert not warns or found[0].startswith("inertia: no rigid body has it; its largest principal moment")
        if moments[0]:  # the design's own platform, which must have an extent across every axis
            assert bool(MACHINE.replace({"platform.inertia": inertia}).warnings) == warns
    loads = fx.paths.payload_loads(MACHINE, PATH, [fx.paths.PayloadCase("a", 1.0, inertia=moments)])
    assert bool(loads.warning.values[0]) == warns
    if not warns:
        by_hand = MACHINE.replace(together(MACHINE, 1.0, (0, 0, 0), np.diag(moments)))
        np.testing.assert_allclose(loads.leg_force[0], fx.paths.path_loads(by_hand, PATH).leg_force, rtol=1e-9)


def test_a_payload_of_few_digits_is_told(result, motion, tmp_path):
    (tmp_path / "cases.csv").write_text("case,mass,ixx,iyy,izz\nplate,6,0.3333,0.3333,0.6667\n")
    line = ["path", "motion-base", motion, "--from-home", "--payloads", tmp_path / "cases.csv"]
    assert [text for text in result(*line)["warnings"] if "plate" in text] == [
        "With the payload plate: inertia: no rigid body has it; its largest principal moment 0.6667 kg m2 exceeds the sum "
        "of the other two, 0.6666. Results are computed with it as given."
    ]  # fmt: skip


def test_a_motion_is_joined_to_home(run, result, motion):
    motion.write_text("t,x,y,z,roll,pitch,yaw\n0,0.1,0,0,0,0,0\n1,0,0.1,0,0,5,10\n2,0.1,0,0,0,0,0\n")
    line = ["path", "motion-base", motion, "--from-home"]
    found = result(*line, "--home-time", "1500ms")
    assert found["duration_s"] == 5.0
    np.testing.assert_allclose(
        [pose[:2] for pose in found["waypoints_m_deg"]], [[0.1, 0], [0, 0.1], [0.1, 0]], atol=1e-15
    )
    assert found["waypoints_s"] == [0, 1, 2]  # those of the file
    joined = fx.Trajectory([[0.1, 0, 0, 0, 0, 0], [0, 0.1, 0, 0, 0, 0]], [0, 1]).between([0, 0, 0.1, 0, 0, 0], 1.0)
    assert (len(joined.times), joined.joined) == (4, "rest")
    shown = [run(*line, *more, "--ends", "free", "--csv")[1] for more in ([], ["--home-time", 1.5])]
    alone, joined = ({float(row["time_s"]): row for row in csv.DictReader(io.StringIO(text))} for text in shown)
    for t in (0, 1, 2):  # in motion, with the forces of the motion alone
        for name in ("x_m", "yaw_rad", "velocity_x_m_per_s", "leg_rate_1_m_per_s", "leg_force_1_N", "power_6_W"):
            assert float(joined[t][name]) == pytest.approx(float(alone[t][name]), rel=1e-9, abs=1e-12), name
    assert float(joined[0]["velocity_x_m_per_s"]) < -0.1
    code, _, err = run("path", "motion-base", "--from", *[0, 0, 2.39, 0, 0, 0], "--to", *[0, 0, 2.4, 0, 0, 0], "--bound", 1, "--home-time", 1)  # fmt: skip
    assert code == 2
    assert "--home-time is for the motion of a FILE" in err
