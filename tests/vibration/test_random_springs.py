"""Random vibration of machines with all kinds of springs, from the command line, against matrices made of energies."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import flexapod as fx

ALL = [
    ("cubic-isolator", {"legs.joint_stiffness.spherical": 20, "legs.series_stiffness_N_per_um": 1,
                        "suspension.stiffness": [1e5, 1e5, 1e5, 1e4, 1e4, 1e4], "suspension.point": [0, 0, 0],
                        "suspension.damping": [100, 100, 100, 10, 10, 10], "legs.damping.spherical": 0.01}),
    ("motion-base", {"legs.joint_stiffness.universal": [5000, 3000], "suspension.point": [0.1, 0, 0],
                     "suspension.stiffness": [1e6, 1e6, 1e6, 1e5, 1e5, 1e5]}),  # oil in its legs
    ("precision-positioner", {"legs.stiffness_law.kind": "screw", "legs.stiffness_law.axial_rigidity": 2e7,
                              "legs.stiffness_law.fixed": 5e7, "legs.stiffness_law.zero_length": 0.05,
                              "legs.joint_stiffness.torsion": 5}),
]  # fmt: skip
AT, TOLD = np.array([0.0, 0.0, 0.1]), np.array([0.05, 0.0, 0.2])
POUND = 4.4482216152605  # N
WIND = "Frequency [Hz];force_y_lbf2/Hz;moment_z\n0,5;0,2;0,01\n5;0,2;0,01\n50;0,002;0,0001\n"
FLOOR = "frequency_hz,z_mm2/s4/Hz\n1,1\n50,1\n100,0.01\n"


def quadratic(form):
    """The symmetric matrix of x^T A x, from its values at unit vectors and at sums of two."""
    one = np.eye(6)
    found = np.diag([form(v) for v in one])
    for i in range(6):
        for j in range(i):
            found[i, j] = found[j, i] = (form(one[i] + one[j]) - found[i, i] - found[j, j]) / 2
    return found


class Energies:
    """Mass, friction, stiffness and what a base that moves along z adds, all from energies of the moving machine."""

    def __init__(self, machine, pose):
        self.machine, self.pose = machine, pose
        self.unstretched = fx.hold(machine, pose).unstretched_length
        self.M = quadratic(lambda v: 2 * self.moving(v).kinetic)
        self.C = quadratic(lambda v: self.moving(v).dissipation)
        fine, coarse = (quadratic(lambda v, h=h: self.bent(h * v) / h**2) for h in (2e-4, 4e-4))
        self.K = (4 * fine - coarse) / 3
        self.M_base = np.array([self.moving(v, 1).kinetic - self.moving(v).kinetic for v in np.eye(6)])
        self.M_base -= self.moving(np.zeros(6), 1).kinetic

    def moving(self, v, up=0.0):
        platform = fx.Motion(self.pose, velocity=v[:3], angular_velocity=v[3:])
        return fx.energy(self.machine, platform, base=fx.Motion(fx.Pose(np.zeros(3)), velocity=[0, 0, up]))

    def potential(self, q):
        pose = fx.Pose(self.pose.position + q[:3], Rotation.from_rotvec(q[3:]).as_matrix() @ self.pose.matrix)
        found = fx.energy(self.machine, pose, unstretched_length=self.unstretched)
        return found.elastic + found.gravitational

    def bent(self, q):
        return self.potential(q) - 2 * self.potential(np.zeros(6)) + self.potential(-q)

    def lever(self, point):
        T = np.eye(6)
        T[:3, 3:] = np.cross(np.eye(3), self.pose.matrix @ point).T
        return T


def table(hertz, knots, values):
    return np.exp(np.interp(np.log(hertz), np.log(knots), np.log(values)))


def rms(hertz, density):
    return np.sqrt(np.trapezoid(density, hertz, axis=0))


@pytest.mark.parametrize(("name", "springs"), ALL)
def test_rms_of_machines_with_all_springs_is_that_of_their_energies(result, tmp_path, name, springs):
    (tmp_path / "wind.csv").write_text(WIND)
    (tmp_path / "floor.csv").write_text(FLOOR)
    changes = [word for key, value in springs.items() for word in ("--set", f"{key}={value}")]
    found = result("response", name, *changes, "--points", 20, "--load", tmp_path / "wind.csv", "--at", 0, 0, "10cm",
                   "--psd", tmp_path / "floor.csv", "--point", "50mm", 0, 0.2)["random_rms_by_source"]  # fmt: skip
    machine = fx.load(name).replace(springs)
    of = Energies(machine, fx.home_pose(machine))
    for source, ends in (("wind", (0.5, 50)), ("base", (1, 100))):
        hertz = np.geomspace(*ends, 40001)
        w = 2 * np.pi * hertz[:, None, None]
        dynamic = of.K + 1j * w * of.C - w**2 * of.M
        if source == "wind":
            force = table(hertz, [0.5, 5, 50], POUND**2 * np.array([0.2, 0.2, 0.002]))
            moment = table(hertz, [0.5, 5, 50], [0.01, 0.01, 1e-4])
            answer = np.linalg.solve(dynamic, of.lever(AT).T[:, [1, 5]])
            density = np.stack([force, moment], axis=-1)
        else:
            push = w[..., 0] ** 2 * of.M_base + 1j * w[..., 0] * of.C[2] + of.K[2]
            answer = np.linalg.solve(dynamic, push[..., None])
            density = 1e-6 * table(hertz, [1, 50, 100], [1, 1, 0.01])[:, None] / w[..., 0] ** 4
        moved = (np.abs(of.lever(TOLD) @ answer) ** 2 @ density[..., None])[..., 0]
        for quantity, power in (("displacement", 0), ("acceleration", 4)):
            expected = rms(hertz, moved * w[..., 0] ** power)
            np.testing.assert_allclose(found[source][quantity], expected, rtol=1e-6, atol=1e-7 * expected.max())
