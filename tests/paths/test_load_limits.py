"""Limits of leg force, rate, acceleration and power along paths and at rest, against what the mechanics gives."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx

WAY = "t,x,y,z,roll,pitch,yaw\n0,0,0,2.39,0,0,0\n0.5,0.3,0,2.45,0,0,0\n1,0,0,2.39,0,0,10\n"


@pytest.fixture(scope="module")
def loads():
    poses = fx.Pose.from_rpy([0, 0.3, 0], 0, [2.39, 2.45, 2.39], 0, 0, np.radians([0, 0, 10]))
    return fx.paths.path_loads(plain_machine("motion-base"), fx.Trajectory(poses, [0, 0.5, 1]))


@pytest.mark.parametrize(
    ("key", "size", "words"),
    [
        ("leg_compression", lambda d: d.leg_force, "force of leg"),
        ("leg_tension", lambda d: -d.leg_force, "force of leg"),
        ("leg_rate", lambda d: abs(d.leg_rate), "rate of leg"),
        ("leg_acceleration", lambda d: abs(d.leg_acceleration), "acceleration of leg"),
        ("leg_power", lambda d: abs(d.leg_force * d.leg_rate), "power of leg"),
    ],
)
def test_limits_along_a_path(result, run, tmp_path, loads, key, size, words):
    """A limit a little above the greatest value holds; one below it is exceeded where the value is above it."""
    (tmp_path / "way.csv").write_text(WAY)
    values = size(loads)
    largest = float(values.max())
    assert largest > 0
    line = ["path", "motion-base", tmp_path / "way.csv", "--set"]
    found = result(*line, f"limits.{key}={1.001 * largest!r}")
    assert found["loads_within_limits"]
    assert not any("the limit of" in text for text in found["warnings"])
    found = result(*line, f"limits.{key}={0.8 * largest!r}")
    assert not found["loads_within_limits"]
    (told,) = [text for text in found["warnings"] if "the limit of" in text]
    assert words in told
    legs = [str(k) for k in values.leg.values[(values.values > 0.8 * largest).any(axis=0)]]
    assert told.endswith(f"legs beyond it on the path: {', '.join(legs)}.")
    limited = plain_machine("motion-base").replace({f"limits.{key}": 0.8 * largest})
    poses = fx.Pose.from_rpy([0, 0.3, 0], 0, [2.39, 2.45, 2.39], 0, 0, np.radians([0, 0, 10]))
    again = fx.paths.path_loads(limited, fx.Trajectory(poses, [0, 0.5, 1]))
    expected = (values.values <= 0.8 * largest).all(axis=1)
    np.testing.assert_array_equal(again.loads_within_limits, expected)
    assert limited.digest != plain_machine("motion-base").digest


def test_check_tells_forces_at_rest(result):
    force = float(fx.hold(plain_machine("motion-base")).leg_force.max())
    found = result("check", "motion-base", "--set", f"limits.leg_compression={0.9 * force!r}")
    assert not found["ok"]
    assert found["limits_exceeded"][0].startswith("leg 1: force at rest 7911 N is above 7120 N")
    assert result("check", "motion-base", "--set", f"limits.leg_compression={1.1 * force!r}")["limits_exceeded"] == []


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("leg_compression", -1, "must be >= 0"),
        ("leg_rate", 0, "Give a speed > 0"),
        ("leg_power_kW", -2, "Give a power > 0"),
        ("leg_tension_kg", 1, "kN"),
        ("leg_acceleration", [1, 2], "one number"),
    ],
)
def test_limits_that_cannot_be(key, value, words):
    with pytest.raises(fx.DesignError, match=words):
        plain_machine("motion-base").replace({f"limits.{key}": value})


def test_limits_of_loads_are_written_and_read():
    machine = plain_machine("motion-base").replace({"limits.leg_compression_kN": 20, "limits.leg_rate_mm_per_s": 300})
    again = fx.Hexapod.from_toml(machine.to_toml())
    assert again == machine
    assert (again.limits.leg_compression, again.limits.leg_rate) == (20e3, 0.3)
    assert "leg_rate" in again.limits.of_motions
    assert fx.check_limits(machine).ok  # its weight is less than that


def test_a_load_on_the_way_counts_in_the_limits_of_loads_alone():
    """A rope carries 90 % of the weight: the legs do not bear what they would bear alone at rest."""
    free = plain_machine("motion-base")
    machine = free.replace({"limits.leg_compression": 0.5 * float(fx.hold(free).leg_force.max())})
    rope = -0.9 * machine.platform_mass * machine.gravity
    centre = machine.platform_mass_center
    path = fx.Trajectory([[0, 0, 2.39, 0, 0, 0], [0.01, 0, 2.39, 0, 0, 0]], [0.0, 10.0])
    assert not fx.check_limits(machine).ok
    carried = fx.paths.path_loads(machine, path, force=rope, moment=np.cross(centre, rope))
    assert carried.within_limits.all()
    assert carried.loads_within_limits.all()
    alone = fx.paths.path_loads(machine, path)
    assert alone.within_limits.all()
    assert not alone.loads_within_limits.any()
