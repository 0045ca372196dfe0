"""A hexapod as a closed chain of rigid bodies in Pinocchio: the oracle of the tests.

It shares nothing with the library but the design's numbers. Base and platform are free-flying bodies; each leg is a
universal joint on the base (first axis k fixed in the base, second axis y fixed in the leg) and a prismatic joint
along the leg; six three-dimensional point constraints close the loops at the spherical joints. The base's motion is
prescribed, so its six accelerations are known and its six rows of the equations give the wrench on it.

The tree is built anew for every state with all its joints at zero and the placements taken from the geometry:
no angle has to be solved for, and the closure holds to rounding. Arguments are duck-typed: `hexapod` needs the
attributes of `flexapod.design.hexapod.Hexapod`, `platform` and `base` those of `flexapod.Motion`. Springs of joints and a
suspension act where the design has them (`sprung`, `suspension`).
"""

from collections.abc import Callable
from functools import cached_property
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from tests.oracles import chain_springs

WORLD_AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
# The platform comes before the base: Pinocchio's algorithms take a joint's descendants to follow it without a gap.
PLATFORM, BASE, LEGS = slice(0, 6), slice(6, 12), slice(12, 30)
FREE = np.r_[PLATFORM, LEGS]
PLATFORM_JOINT, BASE_JOINT = 1, 2
ZERO = np.zeros(3)


class JointForces(NamedTuple):
    """What the joints carry, in inertial axes. Forces are in N, moments in N m."""

    spherical_force: np.ndarray  # (6, 3) on each leg at its spherical joint
    spherical_moment: np.ndarray  # (6, 3) on each leg: friction and springs
    prismatic_force: np.ndarray  # (6, 3) of the lower on the upper part, leg force and friction included
    prismatic_moment: np.ndarray  # (6, 3) of the lower on the upper part about the platform joint
    universal_force: np.ndarray  # (6, 3) of the base on each leg
    universal_moment: np.ndarray  # (6, 3) of the base on each leg about its base joint, friction included
    base_force: np.ndarray  # (3,) of all legs and of a suspension on the base
    base_moment: np.ndarray  # (3,) of them on the base about the base's reference point


class ClosedChain:
    """The closed chain of one design; every method takes one state."""

    def __init__(self, hexapod: Any) -> None:
        self.hexapod = hexapod

    def acceleration(self, platform, base, leg_force=None, force=ZERO, moment=ZERO):
        """Linear acceleration of the platform's reference point and its angular acceleration, inertial axes.

        `leg_force` (6,) pushes the platform away when positive; `force` and `moment` act on the platform at its
        reference point, in its own axes.
        """
        tree = _Tree(self.hexapod, platform, base)
        qdd, _ = tree.forward_dynamics(leg_force, force, moment)
        return tree.platform_acceleration(qdd)

    def joint_forces(self, platform, base, leg_force=None, force=ZERO, moment=ZERO) -> JointForces:
        """Forces and moments in the joints while the platform moves as `acceleration` says."""
        tree = _Tree(self.hexapod, platform, base)
        return tree.joint_forces(leg_force, force, moment)

    def mass_matrix(self, platform, base) -> np.ndarray:
        """J_p (6, 6): the inertia of platform and legs, projected on the motions that the loops allow."""
        tree = _Tree(self.hexapod, platform, base)
        return tree.allowed_platform.T @ tree.mass @ tree.allowed_platform

    def base_matrix(self, platform, base) -> np.ndarray:
        """J_b (6, 6): how the base's acceleration enters the platform's equations, with the sign of Eq. 34."""
        tree = _Tree(self.hexapod, platform, base)
        return -tree.allowed_platform.T @ tree.mass @ tree.allowed_base

    def bias(self, platform, base) -> np.ndarray:
        """eta (6,): gravity, velocity terms and joint friction; no leg force."""
        tree = _Tree(self.hexapod, platform, base)
        drift = np.zeros(30)
        # The free flyers' coordinates are spatial accelerations; eta is what the equations leave when the points'
        # classical accelerations are zero.
        drift[BASE], drift[PLATFORM] = _spatial_acceleration(base, ZERO), _spatial_acceleration(platform, ZERO)
        gap = -tree.closure_drift - tree.closure[:, :12] @ drift[:12]
        drift[LEGS] = np.linalg.solve(tree.closure[:, LEGS], gap)
        left = tree.mass @ drift + tree.nonlinear - tree.applied_force(None, ZERO, ZERO)
        return tree.allowed_platform.T @ left

    def kinetic_energy(self, platform, base) -> float:
        """Kinetic energy of platform and legs, J."""
        tree = _Tree(self.hexapod, platform, base)
        return pin.computeKineticEnergy(tree.model, tree.data, tree.q, tree.v)

    def potential_energy(self, platform, base) -> float:
        """Energy of platform and legs in gravity, zero at the inertial origin, J."""
        tree = _Tree(self.hexapod, platform, base)
        return pin.computePotentialEnergy(tree.model, tree.data, tree.q)

    def dissipation(self, platform, base) -> float:
        """Power lost in the eighteen joints' friction, W."""
        tree = _Tree(self.hexapod, platform, base)
        return -float(tree.v @ tree.friction())

    def stiffness_matrix(self, platform, base, axial) -> np.ndarray:
        """K (6, 6) of all springs, unstressed at the pose, with the legs' axial stiffness (6,)."""
        tree = _Tree(self.hexapod, platform, base)
        return tree.stiffness(axial)


class _Leg(NamedTuple):
    """Indices of one leg's joints and frames in the tree."""

    lower: int  # joint that carries the lower part, at the base joint
    upper: int  # joint that carries the upper part, at the platform joint
    end: int  # frame: the leg's end
    socket: int  # frame: the platform's joint


class _Tree:
    """The open tree at one state, its closure constraints and their solution."""

    def __init__(self, hexapod, platform, base) -> None:
        self.hexapod, self.platform, self.base = hexapod, platform, base
        self.model, self.legs = _open_tree(hexapod, platform.pose, base.pose)
        self.data = self.model.createData()
        self.q = pin.neutral(self.model)
        pin.computeJointJacobians(self.model, self.data, self.q)
        pin.updateFramePlacements(self.model, self.data)
        jacobian = [(self._jacobian(leg.end), self._jacobian(leg.socket)) for leg in self.legs]
        self.closure = np.vstack([end[:3] - socket[:3] for end, socket in jacobian])
        self.relative_spin = [end[3:] - socket[3:] for end, socket in jacobian]
        self.v = self._velocity()

    def _jacobian(self, frame: int) -> np.ndarray:
        return pin.getFrameJacobian(self.model, self.data, frame, WORLD_AXES)

    def _velocity(self) -> np.ndarray:
        """Joint rates from the two plates' motions: the legs' rates are those that keep the loops closed."""
        v = np.zeros(30)
        v[BASE] = _in_body(self.base, self.base.velocity, self.base.angular_velocity)
        v[PLATFORM] = _in_body(self.platform, self.platform.velocity, self.platform.angular_velocity)
        v[LEGS] = np.linalg.solve(self.closure[:, LEGS], -self.closure[:, :12] @ v[:12])
        return v

    @cached_property
    def mass(self) -> np.ndarray:
        upper = np.triu(pin.crba(self.model, self.data, self.q))
        return upper + np.triu(upper, 1).T

    @cached_property
    def nonlinear(self) -> np.ndarray:
        return pin.nonLinearEffects(self.model, self.data, self.q, self.v).copy()

    @cached_property
    def closure_drift(self) -> np.ndarray:
        """Acceleration with which the loops' points would part if all joint accelerations were zero, (18,)."""
        pin.forwardKinematics(self.model, self.data, self.q, self.v, np.zeros(30))
        apart = [self._point_acceleration(leg.end) - self._point_acceleration(leg.socket) for leg in self.legs]
        return np.concatenate(apart)

    def _point_acceleration(self, frame: int) -> np.ndarray:
        return pin.getFrameClassicalAcceleration(self.model, self.data, frame, WORLD_AXES).linear

    @cached_property
    def allowed_platform(self) -> np.ndarray:
        """Joint accelerations (30, 6) for unit accelerations of the platform in inertial axes, base held."""
        return self._allowed(PLATFORM, self.platform.pose.matrix)

    @cached_property
    def allowed_base(self) -> np.ndarray:
        """Joint accelerations (30, 6) for unit accelerations of the base in inertial axes, platform held."""
        return self._allowed(BASE, self.base.pose.matrix)

    def _allowed(self, body: slice, rotation: np.ndarray) -> np.ndarray:
        motions = np.zeros((30, 6))
        motions[body] = np.kron(np.eye(2), rotation.T)
        motions[LEGS] = np.linalg.solve(self.closure[:, LEGS], -self.closure[:, body] @ motions[body])
        return motions

    def applied_force(self, leg_force, force, moment) -> np.ndarray:
        """Generalised forces of the legs, the external load, friction and springs, (30,)."""
        tau = self.friction() + self.springs()
        tau[PLATFORM] += np.concatenate([force, moment])
        if leg_force is not None:
            tau[LEGS][2::3] += leg_force
        return tau

    def friction(self) -> np.ndarray:
        damping = self.hexapod.legs.damping
        coefficient = np.stack([damping.universal, damping.universal, damping.prismatic], axis=1).ravel()
        # k and y are perpendicular, so the universal joint's moment C_u (W - omega_b) has just these two components.
        tau = np.zeros(30)
        tau[LEGS] = -coefficient * self.v[LEGS]
        for spin, c in zip(self.relative_spin, damping.spherical, strict=True):
            tau -= c * spin.T @ (spin @ self.v)
        return tau

    @property
    def sprung(self) -> bool:
        return getattr(self.hexapod, "sprung", False)

    @cached_property
    def spring_moments(self) -> np.ndarray:
        """Of the springs in the platform's joints on the platform, inertial axes, (6, 3)."""
        if not self.sprung:
            return np.zeros((6, 3))
        return chain_springs.platform_moments(self.hexapod, self.platform.pose, self.base.pose)

    def springs(self) -> np.ndarray:
        """Generalised forces of the springs in the joints and of a suspension, (30,)."""
        tau = np.zeros(30)
        if not self.sprung:
            return tau
        angles = chain_springs.universal_angles(self.hexapod, self.platform.pose, self.base.pose)
        moments = -self.hexapod.legs.joint_stiffness.universal * angles
        tau[LEGS] = np.column_stack([moments, np.zeros(6)]).ravel()
        for spin, moment in zip(self.relative_spin, self.spring_moments, strict=True):
            tau -= spin.T @ moment
        if self.hexapod.suspension is not None:
            tau[PLATFORM] += _in_body(self.platform, *self._suspension())
        return tau

    def _suspension(self) -> tuple[np.ndarray, np.ndarray]:
        if getattr(self.hexapod, "suspension", None) is None:
            return ZERO, ZERO
        return chain_springs.suspension_load(self.hexapod, self.platform, self.base)

    def stiffness(self, axial) -> np.ndarray:
        """Of the joints' coordinates, projected on the motions that the loops allow."""
        springs = self.hexapod.legs.joint_stiffness
        along = np.column_stack([springs.universal, axial]).ravel()
        rates = self.allowed_platform[LEGS]
        K = rates.T @ (along[:, None] * rates)
        for i, spin in enumerate(self.relative_spin):
            s = chain_springs.leg_axes(self.hexapod, i, self.platform.pose, self.base.pose)[:, 0]
            turn = spin @ self.allowed_platform
            twist = s @ turn
            bend = turn - np.outer(s, twist)
            K += springs.spherical[i] * bend.T @ bend + springs.torsion[i] * np.outer(twist, twist)
        return K

    def forward_dynamics(self, leg_force, force, moment) -> tuple[np.ndarray, np.ndarray]:
        """Joint accelerations (30,) and the constraint forces on the legs' ends (18,), the base's motion given."""
        base_qdd = _spatial_acceleration(self.base, self.base.acceleration, self.base.angular_acceleration)
        tau = self.applied_force(leg_force, force, moment)
        right = tau[FREE] - self.nonlinear[FREE] - self.mass[FREE, BASE] @ base_qdd
        gap = -self.closure_drift - self.closure[:, BASE] @ base_qdd
        accelerations, constraint_force = _solve_kkt(self.mass[np.ix_(FREE, FREE)], self.closure[:, FREE], right, gap)
        qdd = np.empty(30)
        qdd[BASE], qdd[FREE] = base_qdd, accelerations
        return qdd, constraint_force

    def platform_acceleration(self, qdd: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Classical acceleration of the reference point, and angular acceleration, in inertial axes."""
        v, a = self.v[PLATFORM], qdd[PLATFORM]
        rotation = np.asarray(self.platform.pose.matrix)
        return rotation @ (a[:3] + np.cross(v[3:], v[:3])), rotation @ a[3:]

    def joint_forces(self, leg_force, force, moment) -> JointForces:
        qdd, constraint_force = self.forward_dynamics(leg_force, force, moment)
        spherical_force = constraint_force.reshape(6, 3)
        damping = self.hexapod.legs.damping.spherical
        spherical_moment = np.array([-c * spin @ self.v for c, spin in zip(damping, self.relative_spin, strict=True)])
        spherical_moment -= self.spring_moments
        suspension = self._suspension()
        in_platform = np.split(_in_body(self.platform, *suspension), 2)
        loads = force + in_platform[0], moment + in_platform[1]
        self._recursive_newton_euler(qdd, *loads, spherical_force, spherical_moment)
        prismatic = [self._transmitted(leg.upper) for leg in self.legs]
        universal = [self._transmitted(leg.lower) for leg in self.legs]
        base = self._transmitted(BASE_JOINT)
        return JointForces(
            spherical_force,
            spherical_moment,
            *(np.array(part) for part in zip(*prismatic, strict=True)),
            *(np.array(part) for part in zip(*universal, strict=True)),
            -base[0] - suspension[0],  # the base is massless: what holds it passes all to the legs and the suspension
            -base[1] - suspension[1] - np.cross(self.platform.pose.position - self.base.pose.position, suspension[0]),
        )

    def _recursive_newton_euler(self, qdd, force, moment, spherical_force, spherical_moment) -> None:
        """Inverse dynamics of the open tree with the closure's forces as external ones; leaves them in data.f."""
        external = [pin.Force.Zero() for _ in range(self.model.njoints)]
        external[PLATFORM_JOINT] = pin.Force(np.asarray(force, float), np.asarray(moment, float))
        for leg, f, m in zip(self.legs, spherical_force, spherical_moment, strict=True):
            for sign, frame in ((1.0, leg.end), (-1.0, leg.socket)):
                placement, joint = self.data.oMf[frame], self.model.frames[frame].parentJoint
                to_joint = self.data.oMi[joint].inverse() * pin.SE3(np.eye(3), placement.translation)
                external[joint] = external[joint] + to_joint.act(pin.Force(sign * f, sign * m))
        pin.rnea(self.model, self.data, self.q, self.v, qdd, pin.StdVec_Force(external))

    def _transmitted(self, joint: int) -> tuple[np.ndarray, np.ndarray]:
        """Force and moment that a joint passes on to its child, at the joint's origin, inertial axes."""
        rotation, wrench = self.data.oMi[joint].rotation, self.data.f[joint]
        return rotation @ wrench.linear, rotation @ wrench.angular


def _open_tree(hexapod, platform, base) -> tuple[pin.Model, list[_Leg]]:
    """The tree with every joint at zero in the given poses: base, platform, then leg by leg."""
    model = pin.Model()
    model.gravity = pin.Motion(np.asarray(hexapod.gravity, float), ZERO)
    _add_platform(model, hexapod, platform)
    model.addJoint(0, pin.JointModelFreeFlyer(), _placement(base), "base")
    return model, _add_legs(model, hexapod, platform, base, parent=BASE_JOINT)


def _add_platform(model, hexapod, platform) -> None:
    joint = model.addJoint(0, pin.JointModelFreeFlyer(), _placement(platform), "platform")
    body = _inertia(hexapod.platform_mass, hexapod.platform_mass_center, hexapod.platform_inertia)
    model.appendBodyToJoint(joint, body, pin.SE3.Identity())


def _add_legs(model, hexapod, platform, base, parent: int) -> list[_Leg]:
    """Adds the six legs to joint `parent`: the base, or the universe where the base is fixed to it."""
    origin = _placement(base) if parent == 0 else pin.SE3.Identity()
    ends = hexapod.platform_joints @ np.asarray(platform.matrix).T + (platform.position - base.position)
    ends = ends @ np.asarray(base.matrix)  # in base axes
    legs = []
    for i in range(6):
        start, k = np.asarray(hexapod.base_joints[i]), np.asarray(hexapod.universal_axes[i])
        length = np.linalg.norm(ends[i] - start)
        s = (ends[i] - start) / length
        y = np.cross(k, s) / np.linalg.norm(np.cross(k, s))
        cross = np.column_stack([np.cross(y, k), y, k])  # the universal joint's cross, second axis y, third axis k
        leg_axes = np.column_stack([s, y, np.cross(s, y)])
        first = model.addJoint(parent, pin.JointModelRZ(), origin * pin.SE3(cross, start), f"universal k {i}")
        lower = model.addJoint(first, pin.JointModelRY(), pin.SE3(cross.T @ leg_axes, ZERO), f"universal y {i}")
        along = pin.SE3(np.eye(3), np.array([length, 0.0, 0.0]))
        upper = model.addJoint(lower, pin.JointModelPX(), along, f"prismatic {i}")
        for joint, part in ((lower, hexapod.legs.lower), (upper, hexapod.legs.upper)):
            body = _inertia(part.mass[i], part.mass_center[i], part.inertia[i])
            model.appendBodyToJoint(joint, body, pin.SE3.Identity())
        socket = pin.SE3(np.eye(3), np.array(hexapod.platform_joints[i]))
        frames = [(f"end {i}", upper, pin.SE3.Identity()), (f"socket {i}", PLATFORM_JOINT, socket)]
        legs.append(_Leg(lower, upper, *(model.addFrame(pin.Frame(n, j, p, pin.OP_FRAME)) for n, j, p in frames)))
    return legs


def _inertia(mass, center, about_center) -> pin.Inertia:
    """Set field by field: the constructor refuses inertias that no body can have, and the paper's legs are such."""
    body = pin.Inertia.Zero()
    body.mass, body.lever, body.inertia = float(mass), np.array(center, float), np.array(about_center, float)
    return body


def _placement(pose) -> pin.SE3:
    return pin.SE3(np.array(pose.matrix, float), np.array(pose.position, float))


def _in_body(motion, linear, angular) -> np.ndarray:
    """Two inertial vectors, one under the other, in the body's axes."""
    rotation = np.asarray(motion.pose.matrix)
    return np.concatenate([rotation.T @ linear, rotation.T @ angular])


def _spatial_acceleration(motion, linear, angular=ZERO) -> np.ndarray:
    """A free flyer's coordinates of the classical acceleration of its reference point."""
    return _in_body(motion, linear - np.cross(motion.angular_velocity, motion.velocity), angular)


def _solve_kkt(mass, closure, force, gap) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations and multipliers of M a = force + J^T lambda, J a = gap, scaled and refined once.

    M need not be positive definite (a leg's printed inertia is not), so the whole system goes to LU.
    """
    n, m = mass.shape[0], closure.shape[0]
    kkt = np.block([[mass, -closure.T], [closure, np.zeros((m, m))]])
    right = np.concatenate([force, gap])
    scale = 1.0 / np.sqrt(np.abs(np.diag(mass)))
    rows = 1.0 / np.linalg.norm(closure * scale, axis=1)
    balance = np.concatenate([scale, rows])
    scaled = balance[:, None] * kkt * balance
    solution = np.zeros(n + m)
    for _ in range(2):
        solution += balance * np.linalg.solve(scaled, balance * (right - kkt @ solution))
    return solution[:n], solution[n:]


class Bench(NamedTuple):
    """Pinocchio's own constrained forward dynamics of the same machine, ready to be timed."""

    run: Callable[[], np.ndarray]  # one call of pinocchio.constraintDynamics: joint accelerations (24,)
    acceleration: np.ndarray  # of the platform in that call, linear and angular, inertial axes (6,)
    velocity: np.ndarray  # of the platform, m/s and rad/s (6,)
    leg_force: np.ndarray  # N
    error: float  # relative difference of the platform's acceleration from ClosedChain's
    accuracy: float  # the proximal method's settings
    mu: float
    max_iterations: int
    iterations: int  # used in the call that gave `error`


def bench_constraint_dynamics(hexapod, pose, accuracy=1e-12, mu=1e-8, max_iterations=20) -> Bench:
    """`pinocchio.constraintDynamics` on a fixed base with the legs attached to the universe.

    The state is the given pose with a platform that moves (all velocity terms count) under gravity and leg forces.
    `mu` regularises the constraints and the proximal iterations remove its effect again.
    """
    length = float(np.linalg.norm(hexapod.platform_joints[0] + pose.position - hexapod.base_joints[0]))
    still = SimpleNamespace(pose=SimpleNamespace(position=ZERO, matrix=np.eye(3)))
    still.velocity = still.angular_velocity = still.acceleration = still.angular_acceleration = ZERO
    platform = SimpleNamespace(pose=pose, velocity=length * np.array([0.3, -0.2, 0.4]))
    platform.angular_velocity = np.array([0.5, 0.7, -0.6])
    leg_force = 3.0 * hexapod.platform_mass * np.array([1.0, 2.0, -1.0, 0.5, -0.3, 1.5])
    tree = _Tree(hexapod, platform, still)
    model = pin.Model()
    model.gravity = pin.Motion(np.asarray(hexapod.gravity, float), ZERO)
    _add_platform(model, hexapod, pose)
    legs = _add_legs(model, hexapod, pose, still.pose, parent=0)
    constraints = pin.StdVec_RigidConstraintModel()
    for leg in legs:
        end, socket = model.frames[leg.end], model.frames[leg.socket]
        ends = (end.parentJoint, end.placement, socket.parentJoint, socket.placement)
        closed = pin.RigidConstraintModel(pin.ContactType.CONTACT_3D, model, *ends, pin.ReferenceFrame.LOCAL)
        constraints.append(closed)
    constraint_data = pin.StdVec_RigidConstraintData()
    constraint_data.extend([closed.createData() for closed in constraints])
    data, q = model.createData(), pin.neutral(model)
    settings = pin.ProximalSettings(accuracy, mu, max_iterations)
    v, tau = tree.v[FREE].copy(), tree.applied_force(leg_force, ZERO, ZERO)[FREE].copy()
    pin.initConstraintDynamics(model, data, constraints, constraint_data)

    def run() -> np.ndarray:
        return pin.constraintDynamics(model, data, q, v, tau, constraints, constraint_data, settings)

    expected = np.concatenate(tree.platform_acceleration(tree.forward_dynamics(leg_force, ZERO, ZERO)[0]))
    found = np.concatenate(tree.platform_acceleration(run()))
    error = float(np.linalg.norm(found - expected) / np.linalg.norm(expected))
    velocity = np.concatenate([platform.velocity, platform.angular_velocity])
    return Bench(run, found, velocity, leg_force, error, accuracy, mu, max_iterations, settings.iter)
