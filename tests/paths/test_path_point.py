"""The motion of a point of the platform along a path."""

import json

import numpy as np
import pytest

import flexapod as fx

MACHINE = fx.load("motion-base").replace({"points.eye": [0.2, -0.1, 1.1]})
ROWS = [[0, 0, 0, 0, 0, 0], [0.3, 0.1, 0.1, 0.1, 0, 0.1], [-0.1, 0.2, -0.1, 0, 0.1, 0], [0, 0, 0, 0, 0, 0]]
PATH = fx.Trajectory(ROWS, [0, 1, 2, 3], origin=MACHINE.home)


def test_the_motion_of_a_point_is_the_derivative_of_its_place():
    """By central differences of the place itself, which know nothing of rotating frames."""
    found = fx.paths.path_loads(MACHINE, PATH, samples=40, point="eye")
    inner = found.time.values[1:-1]

    def place(t):
        pose = PATH(t).pose
        return pose.position + pose.matrix @ MACHINE.points["eye"]

    np.testing.assert_allclose(found.position[1:-1], place(inner), rtol=1e-14, atol=1e-15)
    h = 1e-4
    velocity = (place(inner + h) - place(inner - h)) / (2 * h)
    acceleration = (place(inner + h) - 2 * place(inner) + place(inner - h)) / h**2
    np.testing.assert_allclose(found.velocity[1:-1], velocity, atol=1e-6)  # h^2 times the third derivative
    np.testing.assert_allclose(found.acceleration[1:-1], acceleration, atol=2e-5)  # and rounding / h^2
    assert found.attrs["point"] == "eye"
    assert found.attrs["point_m"] == [0.2, -0.1, 1.1]
    assert found.velocity.attrs["units"] == "m/s"


def test_a_name_is_its_place_and_legs_do_not_depend_on_it():
    named, placed, plain = (
        fx.paths.path_loads(MACHINE, PATH, samples=20, point=point) for point in ("eye", [0.2, -0.1, 1.1], [0, 0, 0])
    )
    np.testing.assert_array_equal(named.acceleration, placed.acceleration)
    np.testing.assert_array_equal(named.leg_force, plain.leg_force)
    np.testing.assert_array_equal(plain.position, PATH(plain.time.values).pose.position)
    np.testing.assert_array_equal(plain.velocity, PATH(plain.time.values).velocity)
    cases = fx.paths.payload_loads(MACHINE, PATH, [fx.paths.PayloadCase("one")], samples=20, point="eye")
    assert cases.attrs["point"] == "eye"
    np.testing.assert_array_equal(cases.position.isel(case=0), named.position)
    with pytest.raises(fx.ArgumentError, match="point is 'eyes', which is no point"):
        fx.paths.path_loads(MACHINE, PATH, point="eyes")
    with pytest.raises(fx.ArgumentError, match="point is 'eyes', which is no point"):
        fx.paths.payload_loads(MACHINE, PATH, [fx.paths.PayloadCase("one")], point="eyes")


def test_path_tells_of_a_point(run, tmp_path):
    MACHINE.save(tmp_path / "m.toml")
    (tmp_path / "motion.csv").write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0.3,0,0.1,0,5,0\n2,0,0,0,0,0,0\n")
    given = ("path", tmp_path / "m.toml", tmp_path / "motion.csv", "--from-home")
    code, out, _ = run(*given, "--point", "eye")
    assert code == 0
    assert "Motion of eye (0.2, -0.1, 1.1) m" in out
    code, out, _ = run(*given, "--point", "200mm", "-100mm", "1.1", "--json")
    found = json.loads(out)
    assert found["point_m"] == [0.2, -0.1, 1.1]
    assert found["greatest_position_m"][2] > 3.5
    code, out, _ = run(*given, "--point", "eye", "--csv")
    assert {"position_of_eye_x_m", "velocity_of_eye_y_m_per_s", "acceleration_of_eye_z_m_per_s2"} <= set(
        out.splitlines()[0].split(",")
    )
    code, out, _ = run(*given, "--csv")
    assert "position_x_m" not in out.splitlines()[0].split(",")  # that is x_m
    code, _, err = run(*given, "--point", "eyes")
    assert code == 2
    assert "point is 'eyes'" in err
