"""Envelopes: ends found again by bisection, random poses inside, a published workspace, speeds by hand."""

import csv
import io
import json
import os

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.cases import case
from tests.helpers.plain import file, plain_machine

import flexapod as fx
from flexapod.workspace.rays import trace
from flexapod.workspace.travel_limits import Bounds, Displacements, TravelLimits

AXES = ("x", "y", "z", "roll", "pitch", "yaw")
POINT = np.array([0.05, -0.1, 0.2])


@pytest.fixture(scope="module")
def machine():
    return plain_machine("motion-base")


@pytest.fixture(scope="module")
def found(machine):
    return fx.envelope(machine)


def displaced(machine, six, point=(0, 0, 0)):
    """Poses displaced from home about a point of the platform, written anew."""
    six, point = np.atleast_2d(six), np.asarray(point, dtype=float)
    home = machine.home
    turned = Rotation.from_euler("xyz", six[:, 3:]).as_matrix() @ home.matrix
    return fx.Pose(home.position + home.matrix @ point + six[:, :3] - turned @ point, turned)


def bisected(holds, far):
    """How far a motion holds, by halving from home."""
    low, high = 0.0, far
    while high - low > 1e-12:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


@pytest.mark.parametrize("name", ["motion-base", "precision-positioner", "cubic-isolator"])
@pytest.mark.parametrize("point", [(0, 0, 0), tuple(POINT / 10)])
def test_ends_of_axes_are_those_of_bisection(name, point):
    machine = plain_machine(name)
    found = fx.envelope(machine, point=point, directions=4)
    for k, axis in enumerate(found.axes):
        for end, stops in ((axis.least, axis.stopped_at_least), (axis.most, axis.stopped_at_most)):
            unit = np.sign(end) * np.eye(6)[k]
            along = displaced(machine, np.linspace(0, abs(end), 400)[:, None] * unit, point)
            assert fx.check_limits(machine, along).ok.all()
            far = bisected(lambda s, unit=unit: fx.check_limits(machine, displaced(machine, s * unit, point)).ok.all(),
                           1.1 * abs(end))  # fmt: skip
            assert abs(end) == pytest.approx(far, abs=1e-9)
            just = fx.check_limits(machine, displaced(machine, (abs(end) + 1e-8) * unit, point)[0]).exceeded
            assert just
            for words in just:  # "leg 3: length ... is above ..." is among the stops
                leg, what = (
                    words.split(":")[0],
                    "length" if "length" in words else "joint" if "joint" in words else "dist",
                )
                assert any(leg.split()[-1] in stop and what in stop for stop in stops)


def test_bounds_of_index_and_condition(machine):
    index, cond = 25.5, 12.0
    found = fx.envelope(machine, index=index, condition_number=cond, directions=8)

    def holds(pose):
        ok = fx.check_limits(machine, pose).ok & (fx.stability_index(machine, pose) >= index)
        return bool((ok & (fx.condition_number(machine, pose) <= cond)).all())

    stops = set()
    for k, axis in enumerate(found.axes):
        far = bisected(lambda s, k=k: holds(displaced(machine, s * np.eye(6)[k])), 2.0)
        assert axis.most == pytest.approx(far, abs=1e-9)
        assert axis.least_index >= index * (1 - 1e-9)
        stops |= set(axis.stopped_at_most)
    assert {"bound of the index", "bound of cond(H)"} & stops
    assert found.box.least_index >= index * (1 - 1e-9)
    rows = np.random.default_rng(3).uniform(-1, 1, (4000, 6)) * found.box.half
    assert holds(displaced(machine, rows))
    other = fx.envelope(machine, condition_number=3.0, characteristic_length=1.6, directions=4)
    ends = [(k, axis.most) for k, axis in enumerate(other.axes) if axis.stopped_at_most == ("bound of cond(H)",)]
    assert ends
    for k, end in ends:
        at = displaced(machine, end * np.eye(6)[k])[0]
        assert fx.condition_number(machine, at, characteristic_length=1.6) == pytest.approx(3.0, rel=1e-9)


def test_no_random_pose_of_the_box_is_outside(machine, found):
    """100 000 poses of the box, and its faces; and the pose that stops it is on a face, and beyond it a limit."""
    draws = np.random.default_rng(1).uniform(-1, 1, (100_000, 6))
    draws[::2] /= np.abs(draws[::2]).max(axis=1, keepdims=True)
    assert fx.check_limits(machine, displaced(machine, draws * found.box.half)).ok.all()
    assert np.abs(found.box.at / found.box.half).max() == pytest.approx(1.0, rel=1e-9)
    assert not fx.check_limits(machine, displaced(machine, found.box.at * (1 + 1e-7))).ok.any()
    assert found.box.share < min(pair.share for pair in found.pairs)


def test_a_box_keeps_the_proportions_given(machine):
    half = np.array([0.25, 0.25, 0.2, *np.radians([20, 20, 0])])
    box = fx.envelope(machine, proportions=half, directions=4).box
    np.testing.assert_allclose(box.half, box.share * half, rtol=1e-14)
    draws = np.random.default_rng(2).uniform(-1, 1, (20_000, 6)) * box.half
    assert fx.check_limits(machine, displaced(machine, draws)).ok.all()
    corners = np.array(np.meshgrid(*[[-1, 1]] * 6)).reshape(6, -1).T * half
    by_hand = min(
        bisected(lambda s, row=row: fx.check_limits(machine, displaced(machine, s * row)).ok.all(), 1.0)
        for row in np.unique(corners, axis=0)
    )
    assert box.share <= by_hand + 1e-9  # corners are a part of the box


def test_pairs(machine, found):
    """Inside each boundary nothing is exceeded, just outside something is; the rectangle lies inside."""
    random = np.random.default_rng(4)
    for pair in found.pairs:
        at = [AXES.index(name) for name in pair.axes]

        def holds(two, at=at):
            rows = np.zeros((len(two), 6))
            rows[:, at] = two
            return fx.check_limits(machine, displaced(machine, rows)).ok

        assert holds(pair.boundary * random.uniform(0, 1, (len(pair.boundary), 1))).all()
        assert holds(pair.boundary * (1 - 1e-11)).all()
        assert not holds(pair.boundary * (1 + 1e-7)).any()
        travels = np.array([[found.axes[k].least, found.axes[k].most] for k in at])
        corner = pair.share * travels[:, 0] + random.uniform(0, 1, (2000, 2)) * pair.share * np.ptp(travels, axis=1)
        assert holds(corner).all()
        larger = travels[:, 0] + random.uniform(0, 1, (20_000, 2)) * np.ptp(travels, axis=1)
        assert not holds(larger * min(1.0, 1.02 * pair.share)).all() or pair.share == 1


def test_a_published_workspace():
    """The boundary that its author found by bisection to 0.0005 mm and degrees."""
    machine = fx.load(case("nairck", "nairck.toml"))
    expected = json.loads(case("nairck", "expected.json").read_text())
    points = np.array(expected["boundary_mm"]) / 1e3
    rays = np.zeros((len(points), 6))
    rays[:, :3] = points / np.linalg.norm(points, axis=1, keepdims=True)
    limits = TravelLimits(machine, Displacements(machine.home, np.zeros(3)), Bounds(None, None, None), "universal")
    gap = trace(limits, rays).reach - np.linalg.norm(points, axis=1)
    assert (gap > -1e-9).all()
    assert (gap < 0.6e-6).all()
    axes = {axis.axis: axis for axis in fx.envelope(machine, directions=4).axes}
    for axis, scale, kind in (("z", 1e3, "mm"), ("yaw", 180 / np.pi, "deg")):
        on_axis = [p[2] for p in expected[f"boundary_{kind}"] if np.hypot(p[0], p[1]) == 0]
        assert scale * axes[axis].most == pytest.approx(max(on_axis), abs=6e-4)
        assert scale * axes[axis].least == pytest.approx(min(on_axis), abs=6e-4)


def test_a_machine_without_limits_is_stopped_by_singular_poses():
    machine = fx.load("mukherjee-i")
    found = fx.envelope(machine, directions=4)
    pitch = found.axes[4]
    assert pitch.stopped_at_most == ("singular pose",)
    at = displaced(machine, [0, 0, 0, 0, pitch.most, 0])[0]
    assert fx.condition_number(machine, at) > 1e6
    sides = np.linalg.det(fx.force_transformation(machine, displaced(machine, np.outer(
        np.linspace(pitch.least, pitch.most, 500)[1:-1], np.eye(6)[4]))))  # fmt: skip
    assert (np.sign(sides) == np.sign(sides[0])).all()


def test_speeds_by_hand(machine):
    limits = {
        "leg_rate": 0.4,
        "leg_acceleration": 3.0,
        "leg_compression_kN": 30,
        "leg_tension_kN": 20,
        "leg_power_kW": 3,
    }
    limited = machine.replace({f"limits.{key}": value for key, value in limits.items()})
    found = fx.envelope(limited, point=POINT, directions=4)
    home = machine.home
    jacobian = fx.force_transformation(machine).T
    rest = fx.hold(machine).leg_force
    for k, axis in enumerate(found.axes):
        unit = np.eye(6)[k]
        twist = np.concatenate([unit[:3] - np.cross(unit[3:], home.matrix @ POINT), unit[3:]])
        rate = jacobian @ twist
        allowed = np.concatenate([0.4 / np.abs(rate), 3000.0 / np.abs(rate * rest)])
        assert axis.velocity.value == pytest.approx(allowed.min(), rel=1e-12)
        assert axis.velocity.least <= axis.velocity.value
        kind = "rate" if allowed.argmin() < 6 else "power"
        assert axis.velocity.stops.startswith(kind)
        a = axis.acceleration.value
        peak = []
        for sign in (1, -1):
            motion = fx.Motion(home, acceleration=sign * a * twist[:3], angular_acceleration=sign * a * twist[3:])
            force = fx.inverse_dynamics(machine, motion)
            leg = fx.leg_rates(machine, motion).acceleration
            peak.append(max((force / 30e3).max(), (-force / 20e3).max(), np.abs(leg / 3).max()))
        assert max(peak) == pytest.approx(1.0, rel=1e-9)  # the first limit is met, and no other exceeded
    free = fx.envelope(machine, directions=4).axes[0]
    assert (free.velocity.value, free.velocity.stops) == (np.inf, "")


def test_static_leg_forces_stop_motions(machine):
    strong = float(np.abs(fx.hold(machine).leg_force).max())
    limited = machine.replace({"limits.leg_compression": 1.3 * strong, "limits.leg_tension": 0.0})
    found = fx.envelope(limited, directions=8)
    ended = [(k, axis.most, stop) for k, axis in enumerate(found.axes) for stop in axis.stopped_at_most]
    ended = [(k, most, stop) for k, most, stop in ended if "compression" in stop or "tension" in stop]
    assert ended
    for k, most, stop in ended:
        force = fx.hold(machine, displaced(machine, most * np.eye(6)[k])[0]).leg_force[int(stop[-1]) - 1]
        assert force == pytest.approx(1.3 * strong if "compression" in stop else 0.0, rel=1e-9, abs=1e-5)
    rows = np.random.default_rng(5).uniform(-1, 1, (2000, 6)) * found.box.half
    forces = fx.hold(machine, displaced(machine, rows)).leg_force
    assert forces.min() > -1e-6
    assert forces.max() < 1.3 * strong * (1 + 1e-9)
    with pytest.raises(fx.PoseError, match=r"legs? 1.*: force at rest"):
        fx.envelope(machine.replace({"limits.leg_compression": 0.9 * strong}))


def test_a_home_at_its_limit_does_not_move_beyond(machine):
    low = fx.inverse_kinematics(machine).max()
    found = fx.envelope(machine.replace({"limits.leg_length": [1.0, float(low)]}), directions=8)
    z = found.axes[2]
    assert z.most == pytest.approx(0.0, abs=1e-9)
    assert z.least < -0.1
    assert found.box.share == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "more", "error", "words"),
    [
        (
            {"limits.leg_length": [1.0, 2.0]},
            {},
            fx.PoseError,
            r"beyond limits: legs 1, 2, 3, 4, 5, 6: length 2\.706 m is above 2 m",
        ),
        ({}, {"index": 1000.0}, fx.PoseError, r"28\.054 rad/s, below the bound of 1000 rad/s"),
        ({}, {"index": -1.0}, fx.ArgumentError, "index is -1"),
        ({}, {"condition_number": 0.5}, fx.ArgumentError, "it must be > 1"),
        ({}, {"characteristic_length": 1.0}, fx.ArgumentError, "Give both"),
        ({}, {"proportions": [0] * 6}, fx.ArgumentError, "one > 0"),
        ({}, {"proportions": [-1, 0, 0, 0, 0, 0]}, fx.ArgumentError, "must be >= 0"),
        ({}, {"point": [0, 0]}, fx.ArgumentError, r"shape \(2,\)"),
        ({}, {"directions": 10}, fx.ArgumentError, "multiple of 4"),
        ({}, {"joint": "ball"}, fx.ArgumentError, "joint is 'ball'"),
        ({"home": None}, {}, fx.PoseError, "names no home pose"),
    ],
)
def test_what_is_refused(machine, change, more, error, words):
    with pytest.raises(error, match=words):
        fx.envelope(machine.replace(change) if change else machine, **more)


def test_the_command(result, run, tmp_path, machine, monkeypatch):
    expected = fx.envelope(machine, proportions=[0.25, 0.25, 0.2, *np.radians([20, 20, 25])], index=20.0)
    line = ["envelope", file("motion-base"), "--proportions", "250mm", 0.25, 0.2, 20, 20, 25, "--index", 20]
    found = result(*line, "--out", tmp_path / "here")
    names = {"envelope.csv", "envelope-pairs.csv", "envelope-pairs.png", "envelope.html"}
    assert {file.name for file in (tmp_path / "here").iterdir()} == names
    assert found["box"]["half_ranges_m_rad"] == expected.box.half.tolist()
    assert found["axes"]["x"]["most"] == expected.axes[0].most
    code, out, _ = run(*line, "--csv")
    assert code == 0
    assert out == (tmp_path / "here" / "envelope.csv").read_text()
    rows = list(csv.DictReader(io.StringIO(out)))
    assert [float(row["least"]) for row in rows] == [axis.least for axis in expected.axes]
    pairs = list(csv.DictReader(io.StringIO((tmp_path / "here" / "envelope-pairs.csv").read_text())))
    assert len(pairs) == 15 * 48
    monkeypatch.setenv("COLUMNS", "160")
    code, out, _ = run("envelope", "motion-base")
    assert "greatest length of legs 3, 4" in out
    code, out, _ = run("envelope", "mukherjee-i")
    assert "only singular poses stop motions" in out
    assert run("envelope", "motion-base", "--csv", "--json")[0] == 2
    code, _, err = run("envelope", file("motion-base"), "--set", "limits.leg_length=[1,2]")
    assert code == 2
    assert "Begin at another pose, or widen the limits" in err


def test_moments_of_joints_stop_motions(machine):
    springs = {"legs.joint_stiffness.universal": 2e4, "legs.joint_stiffness.spherical": 1e4}
    limited = machine.replace({**springs, "limits.universal_moment": 2e3, "limits.spherical_moment": 1.5e3})
    found = fx.envelope(limited, directions=8)
    stops = {stop for axis in found.axes for stop in axis.stopped_at_most}
    assert any(stop.startswith("moment of the") for stop in stops)
    for k, axis in enumerate(found.axes):
        far = bisected(lambda s, k=k: fx.check_limits(limited, displaced(machine, s * np.eye(6)[k])).ok.all(), 2.0)
        assert axis.most == pytest.approx(far, abs=1e-9)
    rows = np.random.default_rng(6).uniform(-1, 1, (5000, 6)) * found.box.half
    assert fx.check_limits(limited, displaced(machine, rows)).ok.all()


def closeness(machine, poses):
    """det H with moments over the platform's size and columns of length 1, written anew: it tells singular poses."""
    joints = machine.platform_joints - machine.platform_joints.mean(axis=0)
    H = fx.force_transformation(machine, poses) / np.repeat([1.0, np.linalg.norm(joints, axis=1).max()], 3)[:, None]
    return np.linalg.det(H / np.linalg.norm(H, axis=-2, keepdims=True))


@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii"])
def test_without_limits_motions_end_where_the_determinant_does(name):
    """At 1e-9 of it; manipulator II, which is symmetric, has multiple zeros, to which plain secants creep."""
    machine = fx.load(name)
    side = np.sign(closeness(machine, machine.home))
    found = fx.envelope(machine, directions=4)
    ends = [end * np.eye(6)[k] for k, axis in enumerate(found.axes) for end in (axis.least, axis.most)]
    for pair in found.pairs:
        at = [AXES.index(name) for name in pair.axes]
        travels = np.array([[found.axes[k].least, found.axes[k].most] for k in at])
        corner = np.zeros((2, 2, 6))
        corner[..., at] = np.moveaxis(np.meshgrid(*travels, indexing="ij"), 0, -1)
        shares = [side * closeness(machine, displaced(machine, pair.share * row)) for row in corner.reshape(4, 6)]
        assert min(shares) > 0
    stopped = [end for end in ends if np.abs(end[3:]).sum() < 3]  # others turn for half a turn
    assert len(stopped) > 4
    for end in stopped:
        reach = np.abs(end).max()
        unit = end / reach
        if side * closeness(machine, displaced(machine, (reach + 1e-6) * unit))[0] > 1e-9:
            continue  # followed as far as four leg lengths
        least = bisected(
            lambda s, u=unit: side * closeness(machine, displaced(machine, s * u))[0] >= 1e-9, reach + 1e-6
        )
        assert reach == pytest.approx(least, abs=1e-9)


def test_a_suspension_bears_its_share(machine):
    """Leg forces that stop motions are those that remain for the legs: found again by the equilibrium at rest."""
    strong = float(np.abs(fx.hold(machine).leg_force).max())
    hung = machine.replace(
        {
            "suspension.stiffness": [2e4, 2e4, 4e4, 1e4, 1e4, 1e4],
            "limits.leg_compression": 1.4 * strong,
            "limits.leg_tension": 0.1 * strong,
        }
    )
    found = fx.envelope(hung, directions=4)
    ended = 0
    for k, axis in enumerate(found.axes):
        for end, stops in ((axis.least, axis.stopped_at_least), (axis.most, axis.stopped_at_most)):
            force = fx.hold(hung, displaced(hung, end * np.eye(6)[k])[0]).leg_force
            assert force.max() <= 1.4 * strong * (1 + 1e-9)
            for stop in stops:
                if stop.startswith("greatest compression"):
                    ended += 1
                    assert force[int(stop[-1]) - 1] == pytest.approx(1.4 * strong, rel=1e-9)
    assert ended > 4
    plain = fx.hold(machine, displaced(machine, found.axes[2].most * np.eye(6)[2])[0]).leg_force.max()
    assert plain < strong  # without the suspension nothing would be exceeded there


POSES = int(os.environ.get("ENVELOPE_POSES", "20000"))  # a whole run: ENVELOPE_POSES=1000000


@pytest.mark.parametrize("name", ["motion-base", "precision-positioner", "mukherjee-i", "jointed"])
def test_drawn_poses_of_the_box_keep_everything(name):
    """With bounds of the index and of cond(H), springs, and limits of moments and forces, poses drawn anew each time."""
    machine, bounds = fx.load("motion-base" if name == "jointed" else name), {}
    if name == "jointed":
        strong = float(np.abs(fx.hold(machine).leg_force).max())
        machine = machine.replace(
            {
                "legs.joint_stiffness.universal": 2e4,
                "legs.joint_stiffness.spherical": 1e4,
                "limits.universal_moment": 2e3,
                "limits.spherical_moment": 1.5e3,
                "limits.leg_compression": 2 * strong,
                "suspension.stiffness": [2e4, 2e4, 4e4, 1e4, 1e4, 1e4],
            }
        )
    elif name == "mukherjee-i":
        bounds = {"index": 0.6 * fx.stability_index(machine), "condition_number": 2 * fx.condition_number(machine)}
    found = fx.envelope(machine, directions=4, **bounds)
    random = np.random.default_rng()
    for start in range(0, POSES, 100_000):
        draws = random.uniform(-1, 1, (min(100_000, POSES - start), 6))
        draws[::2] /= np.abs(draws[::2]).max(axis=1, keepdims=True)
        poses = displaced(machine, draws * found.box.half)
        assert fx.check_limits(machine, poses).ok.all()
        if bounds:
            swept = fx.sweep(machine, poses, quantities=("omega_1", "cond_H"))
            assert swept.omega_1.values.min() >= bounds["index"] * (1 - 1e-9)
            assert swept.cond_H.values.max() <= bounds["condition_number"] * (1 + 1e-9)
        if machine.limits.leg_compression is not None:
            force = fx.inverse_dynamics(machine, poses)
            assert force.max() <= machine.limits.leg_compression * (1 + 1e-9)


def test_ends_are_found_in_a_few_steps(machine, monkeypatch):
    limits = TravelLimits(machine, Displacements(machine.home, np.zeros(3)), Bounds(None, None, None), "universal")
    looked, margins = [], TravelLimits.margins
    monkeypatch.setattr(
        TravelLimits, "margins", lambda self, rows: looked.append(len(rows)) or margins(self, rows)
    )  # those of `trace` that narrow its ends
    ends = trace(limits, np.concatenate([-np.eye(6), np.eye(6)]))
    assert all(ends.stops)
    assert len(looked) < 20
