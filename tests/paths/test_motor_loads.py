"""Motors along a path: textbook screws, conservation of energy, held loads, and the motor's curve."""

import json
import math

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.mechanics.energies import energy

MACHINE = plain_machine("motion-base")
SMOOTH = MACHINE.replace({f"legs.damping.{name}": 0.0 for name in ("prismatic", "universal", "spherical")})
HOME = MACHINE.home
ROWS = [[0, 0, 0, 0, 0, 0], [0.3, 0.1, 0.1, 0.1, 0, 0.1], [-0.1, 0.2, -0.1, 0, 0.1, 0], [0, 0, 0, 0, 0, 0]]
CLOSED = fx.Trajectory(ROWS, [0, 1, 2, 3], origin=HOME)
OPEN = fx.Trajectory(ROWS[:3], [0, 1, 2], origin=HOME)
MOVING = fx.Trajectory(ROWS[:3], [0, 1, 2], origin=HOME, ends="free")
DRIVE = {
    "lead_mm": [20, 20, 20, 10, 10, 40],
    "efficiency": [0.9, 0.9, 0.6, 0.9, 0.45, 0.95],
    "gear_ratio": [1, 2, 3, 0.5, 1, 1],
    "gear_efficiency": [1, 0.95, 0.9, 1, 0.9, 0.97],
    "rotor_inertia_kg_cm2": 70,
    "gear_inertia_kg_cm2": 5,
    "screw_inertia_kg_cm2": 30,
}
CURVE = {"speeds_rpm": [0, 2000, 3000], "peak_torques": [100, 100, 60], "continuous_torques": [40, 30, 20]}


def driven(machine=MACHINE, motor=None, **drive):
    return machine.replace({"drive": {**(drive or DRIVE), **({"motor": motor} if motor else {})}})


def by_hand(machine, time, force, rate, acceleration):
    """A result of path_loads with numbers of one's own, the same for all legs."""
    found = fx.paths.path_loads(machine, fx.Trajectory(ROWS, time[0] + np.array([0, 1, 2, 3]), origin=HOME), samples=8)
    kept = found[["leg_length"]].isel(time=[0] * len(time)).assign_coords(time=("time", time))
    legs = {"leg_force": force, "leg_rate": rate, "leg_acceleration": acceleration}
    return kept.assign({name: (("time", "leg"), np.tile(value, (6, 1)).T) for name, value in legs.items()})


def test_a_textbook_power_screw():
    """R. L. Mott, Machine Elements in Mechanical Design, Example Problem 17-1: an Acme screw raises 12 500 lbf.

    It gives 1809 lbf in to raise and an efficiency of 27.5 %; to lower, its Eq. 17-11 is worked out here.
    """
    lbf, inch, load = 4.4482216152605, 0.0254, 12_500
    diameter, friction, cosine, tangent = 1.3429, 0.15, 0.968, 0.0592
    lower = load * diameter / 2 * (friction - cosine * tangent) / (cosine + friction * tangent)
    backwards = -lower * 2 * math.pi / (load * 0.25)
    machine = driven(lead_in=0.25, efficiency=0.275, back_efficiency=backwards)
    time, rate = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.01, 0.01, -0.01, -0.01])
    dataset = by_hand(machine, time, np.full(4, load * lbf), rate, np.zeros(4))
    torque = fx.paths.motor_loads(machine, dataset).motor_torque.values / (lbf * inch)
    np.testing.assert_allclose(torque[:2], 1809, rtol=1e-3)  # as printed, with an efficiency of three digits
    np.testing.assert_allclose(torque[2:], -lower, rtol=1e-12)  # it locks itself: lowering takes torque downwards
    default = fx.paths.motor_loads(driven(lead_in=0.25, efficiency=0.275), dataset.assign_attrs(digest=MACHINE.digest))
    np.testing.assert_allclose(default.motor_torque[2:] / (lbf * inch), -lower, rtol=0.03)


def test_a_ball_screw_axis_sized_by_hand():
    """A vertical axis of 50 kg goes up and rests, by the formulas of makers of ball screws.

    Torque of the load F P / (2 pi eta), of acceleration J alpha with J the mass's m (P / 2 pi)^2 / eta and what turns,
    effective torque the root of sum T^2 t / sum t (THK, General Catalog, "Studying the Driving Motor").
    """
    mass, g, lead, eta, inertia, rise, speed, ends = 50.0, 9.81, 0.01, 0.9, 3e-4, 0.2, 0.3, 0.6
    machine = driven(motor=CURVE, lead=lead, efficiency=eta, rotor_inertia=2e-4, screw_inertia=1e-4)
    a, h = speed / rise, 1e-9
    time = np.array([0, rise, rise + h, ends, ends + h, ends + rise])
    acceleration = np.array([a, a, 0, 0, -a, -a])
    rate = np.array([1e-6, speed, speed, speed, speed, 1e-6])
    dataset = by_hand(machine, time, mass * (g + acceleration), rate, acceleration)
    load = mass * g * lead / (2 * math.pi * eta)
    alpha = 2 * math.pi * a / lead
    turned = (mass * (lead / (2 * math.pi)) ** 2 / eta + inertia) * alpha
    found = fx.paths.motor_loads(machine, dataset)
    expected = [load + turned, load + turned, load, load, load - turned, load - turned]
    np.testing.assert_allclose(found.motor_torque[:, 2], expected, rtol=1e-12)
    effective = math.sqrt(
        ((load + turned) ** 2 * rise + load**2 * (ends - rise) + (load - turned) ** 2 * rise) / (ends + rise)
    )
    np.testing.assert_allclose(found.rms_torque, effective, rtol=1e-7)
    np.testing.assert_allclose(found.peak_speed, 2 * math.pi * speed / lead, rtol=1e-12)


@pytest.mark.parametrize("path", [CLOSED, OPEN, MOVING], ids=["closed", "open", "moving"])
@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_energy_is_kept(path, joint):
    """What the motors give is energy of machine and rotating parts, and heat in screws and gears, of each kind worked out."""
    machine = driven(SMOOTH)
    loads = fx.paths.path_loads(machine, path, samples=6000, joint=joint)
    found = fx.paths.motor_loads(machine, loads)
    given = found.motor_power.integrate("time").values
    ends = [energy(SMOOTH, path(float(t)), joint=joint) for t in (path.times[0], path.times[-1])]
    stored = (ends[1].kinetic + ends[1].gravitational) - (ends[0].kinetic + ends[0].gravitational)
    drive, rate = machine.drive, loads.leg_rate.values
    screw, motor = 2 * np.pi * rate / drive.lead, 2 * np.pi * drive.gear_ratio * rate / drive.lead
    spun = 0.5 * ((drive.rotor_inertia + drive.gear_inertia) * motor**2 + drive.screw_inertia * screw**2)
    heat = found.drive_loss.integrate("time").values
    assert given.sum() == pytest.approx(
        stored + (spun[-1] - spun[0]).sum() + heat.sum(), abs=2e-6 * np.abs(given).sum()
    )
    np.testing.assert_allclose(found.total_power.integrate("time"), given.sum(), rtol=1e-12)
    np.testing.assert_allclose(found.driving_energy - found.returned_energy, given, atol=1e-9 * np.abs(given).max())
    assert found.drive_loss.min() >= 0


def test_heat_of_screw_and_gear():
    """Friction of the screw by the force on it, and of the gear by the power that comes through it."""
    machine = driven(SMOOTH)
    loads = fx.paths.path_loads(machine, CLOSED, samples=200)
    found, drive = fx.paths.motor_loads(machine, loads), machine.drive
    power = (loads.leg_force * loads.leg_rate).values
    taken = np.where(power > 0, power * (1 / drive.efficiency - 1), -power * (1 - drive.backwards))
    screw = 2 * np.pi / drive.lead
    through = power + taken + drive.screw_inertia * screw**2 * (loads.leg_rate * loads.leg_acceleration).values
    lost = np.where(through > 0, through * (1 / drive.gear_efficiency - 1), -through * (1 - drive.gear_efficiency))
    np.testing.assert_allclose(found.drive_loss, taken + lost, atol=1e-9 * np.abs(power).max())


def test_a_gear_without_loss_changes_no_power():
    loads = fx.paths.path_loads(MACHINE, CLOSED, samples=50)
    one, other = (
        fx.paths.motor_loads(driven(lead=0.02, efficiency=0.9, gear_ratio=ratio, screw_inertia=1e-3), loads)
        for ratio in (1.0, 7.0)
    )
    np.testing.assert_allclose(one.motor_power, other.motor_power, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(7 * other.motor_torque, one.motor_torque, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(other.reflected_mass, one.reflected_mass, rtol=1e-12)


def test_a_screw_that_locks_itself_holds_without_torque_and_gives_nothing_back():
    machine = driven(lead=0.005, efficiency=0.3)
    loads = fx.paths.path_loads(machine, CLOSED, samples=200)
    found = fx.paths.motor_loads(machine, loads)
    assert (np.abs(loads.leg_force[0]) > 1000).all()
    np.testing.assert_array_equal(found.motor_torque[[0, -1]], 0.0)
    np.testing.assert_array_equal(found.returned_energy, 0.0)
    assert (found.drive_loss.integrate("time") > 0).all()
    held = fx.paths.motor_loads(machine, loads, hold=3.0)
    np.testing.assert_allclose(held.rms_torque, found.rms_torque / np.sqrt(2), rtol=1e-12)  # half the cycle is at rest


def test_held_loads_are_in_the_mean():
    """The motor holds what its screw would give back: at rest friction helps."""
    machine = driven(motor=CURVE, lead=0.02, efficiency=0.8, gear_ratio=2, gear_efficiency=0.9, rotor_inertia=0.01)
    loads = fx.paths.path_loads(machine, OPEN, samples=300)
    found, held = (fx.paths.motor_loads(machine, loads, hold=time) for time in (0.0, 5.0))
    torque = loads.static_force.values[-1] * 0.02 / (2 * math.pi) * (2 - 1 / 0.8) / 2 * 0.9
    np.testing.assert_allclose(found.motor_torque[-1], torque, rtol=1e-9)
    np.testing.assert_allclose(held.rms_torque**2 * 7, found.rms_torque**2 * 2 + 5 * torque**2, rtol=1e-9)
    np.testing.assert_allclose(held.rms_speed**2 * 7, found.rms_speed**2 * 2, rtol=1e-12)
    for name in ("peak_torque", "driving_energy", "peak_factor"):
        np.testing.assert_array_equal(held[name], found[name])


def test_the_room_beside_the_curve():
    machine = driven(motor=CURVE, lead=0.02, efficiency=0.9, rotor_inertia=0.007)
    found = fx.paths.motor_loads(machine, fx.paths.path_loads(machine, CLOSED, samples=200))
    rpm = np.abs(found.motor_speed.values) * 30 / np.pi
    can = np.where(rpm <= 2000, 100.0, 100 - 0.04 * (rpm - 2000))
    np.testing.assert_allclose(found.peak_factor, (can / np.abs(found.motor_torque.values)).min(axis=0), rtol=1e-12)
    for k in range(6):
        at = found.sel(time=float(found.peak_time[k])).isel(leg=k)
        assert abs(at.motor_torque) * found.peak_factor[k] == pytest.approx(
            machine.drive.motor.peak(float(at.motor_speed))
        )
    warm = 40 - found.rms_speed * 30 / np.pi / 200
    np.testing.assert_allclose(found.continuous_factor, warm / found.rms_torque, rtol=1e-12)
    np.testing.assert_allclose(found.speed_factor, 3000 / rpm.max(axis=0), rtol=1e-12)
    slow = machine.replace({"drive.motor.max_speed_rpm": 1000})
    beyond = fx.paths.motor_loads(slow, fx.paths.path_loads(slow, CLOSED, samples=200))
    too_fast = rpm.max(axis=0) > 1000
    assert 0 < too_fast.sum() < 6
    np.testing.assert_array_equal(beyond.peak_factor.values == 0, too_fast)
    np.testing.assert_array_equal(beyond.speed_factor.values < 1, too_fast)


def test_springs_of_the_legs_give_way_as_fast_as_the_force_changes():
    loads = fx.paths.path_loads(MACHINE, CLOSED, samples=3000)
    found = fx.paths.motor_loads(driven(), loads)
    step = np.diff(loads.leg_force, axis=0) / np.diff(loads.time)[:, None]
    np.testing.assert_allclose(found.yield_rate, np.abs(step).max(axis=0) / 8e6, rtol=1e-3)


def test_payloads_and_loads_of_the_design_without_its_drive():
    cases = [fx.paths.PayloadCase("empty"), fx.paths.PayloadCase("full", 500.0, (0, 0, 1))]
    machine = driven(motor=CURVE)
    together = fx.paths.motor_loads(machine, fx.paths.payload_loads(machine, CLOSED, cases, samples=50))
    alone = fx.paths.motor_loads(machine, fx.paths.path_loads(MACHINE, CLOSED, samples=50))
    assert together.motor_torque.dims == ("case", "time", "leg")
    for name in ("motor_torque", "rms_torque", "peak_factor", "total_power"):
        np.testing.assert_allclose(together[name].sel(case="empty"), alone[name], rtol=1e-13)
    assert (together.rms_torque.sel(case="full") > alone.rms_torque).any()


def test_a_machine_at_rest():
    """Nothing turns; the ratio of speeds is infinite, and torques are those that hold."""
    machine = driven(motor=CURVE, lead=0.02, efficiency=0.9)
    still = fx.Trajectory([ROWS[0], ROWS[0]], [0, 2], origin=HOME)
    found = fx.paths.motor_loads(machine, fx.paths.path_loads(machine, still, samples=20), hold=1.0)
    np.testing.assert_array_equal(found.motor_speed, 0.0)
    np.testing.assert_array_equal(found.speed_factor, np.inf)
    np.testing.assert_allclose(found.rms_torque, np.abs(found.motor_torque[0]), rtol=1e-9)


def test_what_makes_no_sense_is_refused():
    machine = driven()
    loads = fx.paths.path_loads(machine, MOVING, samples=20)
    with pytest.raises(fx.ArgumentError, match=r"'motion-base' has no drive\. Add \[drive\] with lead and efficiency"):
        fx.paths.motor_loads(MACHINE, loads)
    with pytest.raises(fx.ArgumentError, match=r"hold is for a path that ends at rest; leg \d has"):
        fx.paths.motor_loads(machine, loads, hold=1.0)
    with pytest.raises(fx.ArgumentError, match=r"hold is -1\.0 s; it must be"):
        fx.paths.motor_loads(machine, loads, hold=-1.0)
    with pytest.raises(fx.ArgumentError, match="dataset is of another design, 'motion-base'"):
        fx.paths.motor_loads(machine.replace({"platform.mass": 4001}), loads)
    with pytest.raises(fx.ArgumentError, match="dataset lacks leg_force"):
        fx.paths.motor_loads(machine, loads[["leg_rate"]])
    with pytest.raises(fx.ArgumentError, match="dataset is 3; it must be"):
        fx.paths.motor_loads(machine, 3)


@pytest.fixture
def files(tmp_path):
    driven(motor=CURVE, lead=0.02, efficiency=0.9, rotor_inertia=0.007).save(tmp_path / "driven.toml")
    (tmp_path / "motion.csv").write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0.3,0,0.1,0,5,0\n2,0,0,0,0,0,0\n")
    return tmp_path


def test_path_tells_of_motors(run, files):
    given = ("path", files / "driven.toml", files / "motion.csv", "--from-home")
    code, out, _ = run(*given, "--hold", "1", "--payload", "500", "0", "0", "1", "--out", files / "out")
    assert code == 0
    for words in (
        "The motors turn with the leg lengths of the path.",
        "Motors beside their curve",
        "Motors with the",
    ):
        assert words in out
    assert (files / "out" / "path-motors.png").stat().st_size > 10_000
    page = (files / "out" / "path.html").read_text()
    assert "1 s at rest at its end" in page
    assert "Torque and speed of the motors" in page
    header = (files / "out" / "path.csv").read_text().splitlines()[0].split(",")
    assert {"case", "motor_speed_1_rad_per_s", "motor_torque_6_N_m", "motor_power_3_W"} <= set(header)
    code, out, _ = run(*given, "--hold", "1s", "--json")
    motors = json.loads(out)["motors"]
    assert motors["hold_s"] == 1.0
    assert len(motors["rms_torque_N_m"]) == 6


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (("drive.motor.max_speed_rpm=500",), "rpm, beyond 500 rpm, its greatest speed"),
        (("drive.lead_mm=50",), "N m, its peak torque at that speed"),
        (("drive.lead_mm=32",), "its continuous torque at"),
        (("legs.stiffness=1e4", "drive.lead_mm=20"), "The springs of the legs give way at up to"),
        (("drive.efficiency=0.4",), "screws lock themselves"),
    ],
)
def test_path_tells_what_motors_cannot(run, files, changes, words):
    sets = [part for change in changes for part in ("--set", change)]
    code, out, err = run("path", files / "driven.toml", files / "motion.csv", "--from-home", *sets)
    assert code == 0
    assert words in out + err


def test_options_of_motors_need_motors(run, files):
    code, _, err = run("path", "motion-base", files / "motion.csv", "--from-home", "--hold", "1")
    assert code == 2
    assert "--hold is for motors, and 'motion-base' has none. Add [drive]" in err
    code, _, err = run(
        "path", files / "driven.toml", files / "motion.csv", "--from-home", "--hold", "1", "--ends", "free"
    )
    assert code == 2
    assert "hold is for a path that ends at rest" in err
