"""The equations of docs/theory/ as they stand there, in NumPy, against the core; and where their links lead."""

import re
from operator import attrgetter
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from tests.helpers.drawn import machines, situations
from tests.helpers.support import EPS, JOINTS, center, relative, size

import flexapod as fx

both_models = pytest.mark.parametrize("joint", JOINTS)
E = np.eye(3)


def tilde(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


class Leg:
    """One leg at one state: geometry, projector and partial velocities (theory/legs.md)."""

    def __init__(self, case, i, joint):
        h, p, b = case.hexapod, case.platform, case.base
        R_p, R_b = p.pose.matrix, b.pose.matrix
        self.q_p, self.q_b, k = R_p @ h.platform_joints[i], R_b @ h.base_joints[i], R_b @ h.universal_axes[i]
        self.S = p.pose.position + self.q_p - b.pose.position - self.q_b
        self.L = np.linalg.norm(self.S)
        self.s = s = self.S / self.L
        self.k, self.y = k, np.cross(k, s) / np.linalg.norm(np.cross(k, s))
        self.n = n = np.cross(k, self.y)
        T = np.column_stack([s, self.y, np.cross(s, self.y)])
        self.universal = joint == "universal"
        self.nu = n / (n @ s) if self.universal else np.zeros(3)
        P = E - np.outer(s, self.nu)
        self.W = P @ tilde(s) / self.L
        lower, upper = h.legs.lower, h.legs.upper
        self.m_d, self.m_u = lower.mass[i], upper.mass[i]
        self.r_d, self.r_u = T @ lower.mass_center[i], T @ upper.mass_center[i]
        self.I = T @ (lower.inertia[i] + upper.inertia[i]) @ T.T
        self.G_d, self.G_u = -tilde(self.r_d) @ self.W, E - tilde(self.r_u) @ self.W

    def Q_p(self):
        return self.m_d * self.G_d.T @ self.G_d + self.m_u * self.G_u.T @ self.G_u + self.W.T @ self.I @ self.W

    def Q_b(self):
        d, u = self.m_d * self.G_d.T @ (E - self.G_d), self.m_u * self.G_u.T @ (E - self.G_u)
        return -(d + u - self.W.T @ self.I @ self.W)

    def spin(self):
        """kappa: the force at the platform joint of a unit angular acceleration along the leg."""
        d, u = self.m_d * self.G_d.T @ np.cross(self.s, self.r_d), self.m_u * self.G_u.T @ np.cross(self.s, self.r_u)
        return d + u + self.W.T @ self.I @ self.s

    def load(self, case, i):
        """F_s without an actuator's force, and f, with all accelerations of platform and base zero."""
        h, p, b, s, L = case.hexapod, case.platform, case.base, self.s, self.L
        w_b, c = b.angular_velocity, h.legs.damping
        S1 = p.velocity + np.cross(p.angular_velocity, self.q_p) - b.velocity - np.cross(w_b, self.q_b)
        u_p = np.cross(p.angular_velocity, np.cross(p.angular_velocity, self.q_p))
        u_b = np.cross(w_b, np.cross(w_b, self.q_b))
        S2, L1 = u_p - u_b, s @ S1
        w = self.W @ S1 + s * (self.nu @ w_b)
        w_rel = w - w_b
        A = (np.cross(s, S2) - L * (w @ s) * np.cross(s, w) - 2 * L1 * (w - s * (w @ s))) / L
        if self.universal:
            n_rate = np.cross(np.cross(w_b, self.k), self.y) + np.cross(self.k, np.cross(w, self.y))
            A = A - s * ((A @ self.n + w_rel @ n_rate) / (self.n @ s))
        a_d = u_b + np.cross(A, self.r_d) + np.cross(w, np.cross(w, self.r_d)) - h.gravity
        a_u = u_p + np.cross(A, self.r_u) + np.cross(w, np.cross(w, self.r_u)) - h.gravity
        f = c.spherical[i] * (w - p.angular_velocity)
        moment = self.I @ A + np.cross(w, self.I @ w) + c.universal[i] * w_rel + f
        F_s = self.G_d.T @ (self.m_d * a_d) + self.G_u.T @ (self.m_u * a_u) + self.W.T @ moment
        return F_s + s * c.prismatic[i] * L1, f


def arm(q):
    """[E; q~]: a force at q as a wrench."""
    return np.vstack([E, tilde(q)])


@both_models
@given(case=situations())
def test_equations_of_motion_as_written(joint, case, measured):
    h, R = case.hexapod, case.platform.pose.matrix
    legs = [Leg(case, i, joint) for i in range(6)]
    R_p, I = R @ h.platform_mass_center, R @ h.platform_inertia @ R.T
    J_p = h.platform_mass * arm(R_p) @ arm(R_p).T
    J_p[3:, 3:] += I
    J_p += sum(arm(leg.q_p) @ leg.Q_p() @ arm(leg.q_p).T for leg in legs)
    J_b = sum(
        arm(leg.q_p) @ (leg.Q_b() @ arm(leg.q_b).T - np.hstack([np.zeros((3, 3)), np.outer(leg.spin(), leg.nu)]))
        for leg in legs
    )
    w = case.platform.angular_velocity
    eta = arm(R_p) @ (h.platform_mass * (np.cross(w, np.cross(w, R_p)) - h.gravity))
    eta[3:] += np.cross(w, I @ w)
    for i, leg in enumerate(legs):
        F_s, f = leg.load(case, i)
        eta += arm(leg.q_p) @ F_s - np.concatenate([np.zeros(3), f])
    found = fx.equations_of_motion(h, case.platform, base=case.base, joint=joint)
    # Sums of some hundred products; eta's parts cancel tenfold.
    measured("theory/J_p", relative(found.J_p, J_p), 1e-12)
    measured("theory/J_b", relative(found.J_b, J_b), 1e-12)
    measured("theory/eta", relative(found.eta, eta), 1e-11)


@given(hexapod=machines())
def test_stiffness_of_massless_legs_as_written(hexapod, measured):
    """theory/rest.md: springs, geometric stiffness of loaded legs, the platform's weight, a load that turns along."""
    h, pose = hexapod.replace({"legs.lower": None, "legs.upper": None}), center(hexapod)
    load = h.platform_mass * np.array([3.0, -5.0, 8.0, 0.2, -0.1, 0.3]) * np.repeat([1.0, size(h)], 3)
    found = fx.linearise(h, pose, force=load[:3], moment=load[3:])
    R = pose.matrix
    K = np.zeros((6, 6))
    for i, (F, k) in enumerate(zip(found.rest.leg_force, h.legs.stiffness, strict=True)):
        q = R @ h.platform_joints[i]
        S = pose.position + q - h.base_joints[i]
        L = np.linalg.norm(S)
        s = S / L
        across = E - np.outer(s, s)
        K += arm(q) @ (k * np.outer(s, s) - F / L * across) @ arm(q).T
        K[3:, 3:] -= F * tilde(s) @ tilde(q)
    K[3:, 3:] -= h.platform_mass * tilde(h.gravity) @ tilde(R @ h.platform_mass_center)
    K[:3, 3:] += tilde(R @ load[:3])
    K[3:, 3:] += tilde(R @ load[3:])
    scale = np.repeat([1.0, 1 / size(h)], 3)
    measured("rest/closed-form", relative(found.K * np.outer(scale, scale), K * np.outer(scale, scale)), 1000 * EPS)


# --- links ------------------------------------------------------------------------------------------------------------

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(DOCS.rglob("*.md"))


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(DOCS)))
def test_links_to_the_code_lead_somewhere(path):
    text = path.read_text(encoding="utf-8")
    for file, symbol in re.findall(r"\]\(core:([\w.]+)#(\w+)\)", text):
        assert re.search(rf"\b{symbol}\b", (DOCS.parent / "src" / "core" / file).read_text(encoding="utf-8")), symbol
    for name in re.findall(r"\]\[flexapod\.([\w.]+)\]", text):
        attrgetter(name)(fx)  # raises AttributeError where there is none


def test_the_theory_names_what_implements_it():
    """Every page of the theory links functions of the core or of the library."""
    pages = sorted((DOCS / "theory").glob("*.md"))
    assert len(pages) >= 9
    for path in pages:
        assert re.search(r"\]\(core:|\]\[flexapod\.", path.read_text(encoding="utf-8")), path.name
