"""Isolation of the platform from a shaking base by LQG and H-infinity controllers, made by python-control.

All weights are plain ratios: the designs scale rotations by the platform's size, forces by the acceleration they give
and measurements by what a shaken base makes of them, so that the same numbers suit a small and a large machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Unpack

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.control.plant import MEASURES, Controller, Law, Measure, Plant, is_stable, poles
from flexapod.conventions import AXES, Array, Complex
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, UnstableError
from flexapod.mechanics.linearisation import RestOptions, linearise
from flexapod.optional import needed
from flexapod.pose import Pose


def lqg(
    hexapod: Hexapod,
    pose: Pose,
    *,
    measure: Measure | Sequence[Measure] = "acceleration",
    effort: float = 0.1,
    stroke: float = 0.1,
    noise: float = 0.1,
    **rest: Unpack[RestOptions],
) -> Controller:
    """The controller of least mean square absolute acceleration under white base acceleration (LQG), 12 states.

    measure: what it sees, one or several of "acceleration", "leg_force", "leg_length", "leg_rate", "position",
    "velocity". effort: weight of leg forces against acceleration (1: as dear as the acceleration they cause).
    stroke: weight of relative displacement times omega_1^2, which holds the platform over a base that drifts. noise:
    sensor noise relative to the shaken base's signal. Small weights ask for more of the machine. rest: `linearise`'s.

    Raises: ArgumentError for a measure that is none or a weight that is not > 0; UnstableError where no controller
    exists; PoseError and SingularPoseError as `linearise`; MissingExtraError without python-control.
    Source: H. Kwakernaak and R. Sivan, Linear Optimal Control Systems (1972); the weights are our own.
    """
    task = _Task(Plant(linearise(hexapod, pose, **rest)), _measures(measure))
    _positive(effort=effort, stroke=stroke, noise=noise)
    control = needed("control", "control", "LQG design needs python-control")
    drift = stroke * task.omega_1**2 / (task.plant.omega_0 * task.pace)
    held = np.hstack([np.diag(drift / task.axis), np.zeros((6, 6))])
    Q = task.C_a.T @ task.C_a + held.T @ held
    R = task.D_a.T @ task.D_a + effort**2 * np.eye(6)
    A, B, E, C = task.A, task.B, task.E, task.C
    gain = _riccati(control, A, B, Q, R, task.C_a.T @ task.D_a)
    V = noise**2 * np.eye(len(C)) + task.G @ task.G.T
    observer = _riccati(control, A.T, C.T, E @ E.T, V, E @ task.G.T).T
    A_c = A - B @ gain - observer @ (C - task.D @ gain)
    return task.controller(A_c, observer, -gain, np.zeros((6, len(C))), "LQG isolation")


def h_infinity(
    hexapod: Hexapod,
    pose: Pose,
    *,
    measure: Measure | Sequence[Measure] = "acceleration",
    corner: float | None = None,
    depth: float = 3.0,
    effort: float = 0.1,
    noise: float = 0.1,
    bandwidth: float | None = None,
    **rest: Unpack[RestOptions],
) -> Controller:
    """The controller with the least worst-case weighted transmissibility of base acceleration (H-infinity), 24 states.

    The weight on the platform's absolute acceleration is depth (s + corner)/(s + depth corner): 1 below `corner`
    (rad/s; default half the lowest natural frequency), where the platform has to follow the base, rising to `depth`
    above it. The weight on forces rises from `effort` to that of acceleration at `bandwidth` (rad/s; default twice the
    highest natural frequency), beyond which the controller does nothing. noise, measure: as for `lqg`. Needs slycot
    (extra "control"). The bound reached, gamma, is in the controller's name: transmissibility is at most gamma over
    the weight at every frequency.

    Raises: ArgumentError for a measure that is none or a weight that is not > 0; UnstableError where no controller is
    found; PoseError and SingularPoseError as `linearise`; MissingExtraError without slycot.
    Source: J. C. Doyle, K. Glover, P. P. Khargonekar and B. A. Francis (1989), by SLICOT's SB10AD; the weights are our
    own.
    """
    task = _Task(Plant(linearise(hexapod, pose, **rest)), _measures(measure))
    omega = task.plant.omega
    low = 0.5 * float(omega[0]) if corner is None else corner
    high = 2.0 * float(omega[-1]) if bandwidth is None else bandwidth
    _positive(effort=effort, noise=noise, corner=low, depth=depth, bandwidth=high)
    system = _weighted(task, _Weights(low / task.pace, depth, high / task.pace, effort, noise))
    gamma, matrices = _suboptimal(system, len(task.C))
    name = f"H-infinity isolation (gamma {gamma:.3g})"
    A, B, C, D = matrices
    found = task.controller(A, B, C, D, name)
    if not is_stable(poles(task.plant, found), task.plant):
        raise UnstableError(f"{name}: the design is too badly conditioned to be used. Raise effort and noise.")
    return found


def controlled_transmissibility(
    hexapod: Hexapod, pose: Pose, law: Law, omega: ArrayLike, **rest: Unpack[RestOptions]
) -> xr.Dataset:
    """Transmissibility of base motion to the platform with and without control, on the tangent.

    law: as for `closed_loop`. omega: (n,) rad/s, > 0. Complex `controlled` and `passive` over (omega, output, base):
    absolute displacement of the platform (m, rad) per displacement of the base. A sampled controller acts with its
    hold; frequencies must then be below pi/dt. `leg_force`: N per base displacement, (omega, leg, base).

    Raises: ArgumentError for frequencies that are not > 0, or beyond what a sampled controller has; PoseError and
    SingularPoseError as `linearise`.
    Source: own, on the tangent of part C.
    """
    w = np.atleast_1d(np.asarray(omega, dtype=np.float64))
    if w.ndim != 1 or not w.size or not np.isfinite(w).all() or w.min() <= 0:
        raise ArgumentError(f"omega has shape {w.shape}; give a row of finite frequencies > 0, rad/s")
    plant = Plant(linearise(hexapod, pose, **rest))
    controller = law.on(plant.linear)
    if controller.dt is not None and w.max() >= np.pi / controller.dt:
        raise ArgumentError(
            f"omega reaches {w.max():.5g} rad/s; a controller sampled every {controller.dt:.5g} s has a response only "
            f"below {np.pi / controller.dt:.5g} rad/s"
        )
    controlled, force = _response(plant, w, controller)
    passive, _ = _response(plant, w, None)
    grid = ("omega", "output", "base")
    return xr.Dataset(
        {
            "controlled": (grid, controlled, {"long_name": "transmissibility with control"}),
            "passive": (grid, passive, {"long_name": "transmissibility without control"}),
            "leg_force": (("omega", "leg", "base"), force, {"long_name": "leg force per base displacement"}),
        },
        {"omega": ("omega", w, {"units": "rad/s"}), "output": list(AXES), "base": list(AXES)},
        {"design": hexapod.name, "digest": hexapod.digest, "controller": controller.name},
    )


def _response(plant: Plant, omega: Array, controller: Controller | None) -> tuple[Complex, Complex]:
    """Absolute displacement and leg force per base displacement."""
    s = 1j * omega[:, None, None]
    base = np.concatenate([s**2 * np.eye(6), np.broadcast_to(np.eye(6), (*s.shape[:1], 6, 6))], axis=1)
    right = np.concatenate([np.broadcast_to(plant.B, (*s.shape[:1], 12, 6)), plant.E @ base], axis=2)
    z = np.linalg.solve(s * np.eye(12) - plant.A, right.astype(complex))
    y = plant.C @ z + np.concatenate([np.broadcast_to(plant.D, (*s.shape[:1], *plant.D.shape)), plant.G @ base], axis=2)
    by_force, by_base = y[..., :6], y[..., 6:]
    force = np.zeros((omega.size, 6, 6), dtype=complex)
    if controller is not None:
        rows = plant.measured(controller.measures)
        K = _gain_at(controller, omega)
        force = np.linalg.solve(np.eye(6) - K @ by_force[:, rows], K @ by_base[:, rows])
    rows = plant.measured(("acceleration",))
    return (by_base[:, rows] + by_force[:, rows] @ force) / s**2, force


def _gain_at(controller: Controller, omega: Array) -> Complex:
    s = 1j * omega[:, None, None]
    K = controller
    at, hold = (s, 1.0) if K.dt is None else (np.exp(s * K.dt), (1 - np.exp(-s * K.dt)) / (s * K.dt))
    if K.order == 0:
        return np.asarray(hold * np.broadcast_to(K.D, (omega.size, *K.D.shape)), dtype=np.complex128)
    inner = np.linalg.solve(at * np.eye(K.order) - K.A, np.broadcast_to(K.B, (omega.size, *K.B.shape)).astype(complex))
    return np.asarray(hold * (K.C @ inner + K.D), dtype=np.complex128)


class _Weighted(NamedTuple):
    """The generalised plant of an H-infinity problem."""

    A: Array
    B: Array
    C: Array
    D: Array


class _Weights(NamedTuple):
    """Of an H-infinity problem, frequencies over the pace."""

    corner: float
    depth: float
    bandwidth: float
    effort: float
    noise: float


def _weighted(task: _Task, weights: _Weights) -> _Weighted:
    """Inputs base acceleration, sensor noise, force; outputs weighted acceleration and force, then measurement.

    Weights have a state for each signal: on acceleration x' = a - depth corner x, depth (a + corner (1 - depth) x); on
    force (depth s/bandwidth + effort)/(s/(far bandwidth) + 1) with `far` so high that it only makes it proper.
    """
    corner, depth, bandwidth, effort, noise = weights
    far = 30.0
    pole, rise = far * bandwidth, far * depth  # the force's weight is rise - pole (rise - effort)/(s + pole)
    one, o, m = np.eye(6), np.zeros, len(task.C)
    A = np.block(
        [
            [task.A, o((12, 12))],
            [task.C_a, -depth * corner * one, o((6, 6))],
            [o((6, 18)), -pole * one],
        ]
    )
    B = np.block([[task.E, o((12, m)), task.B], [task.G_a, o((6, m)), task.D_a], [o((6, 6 + m)), one]])
    C = np.block(
        [
            [depth * task.C_a, depth * corner * (1 - depth) * one, o((6, 6))],
            [o((6, 18)), -pole * (rise - effort) * one],
            [task.C, o((m, 12))],
        ]
    )
    D = np.block(
        [
            [depth * task.G_a, o((6, m)), depth * task.D_a],
            [o((6, 6)), o((6, m)), rise * one],
            [task.G, noise * np.eye(m), task.D],
        ]
    )
    return _Weighted(A, B, C, D)


def _suboptimal(system: _Weighted, measurements: int) -> tuple[float, tuple[Array, ...]]:
    """A bound gamma a fifth above the least one, and its central controller.

    SLICOT's SB10AD, the routine behind control.hinfsyn, but with gamma given: the optimal controllers that hinfsyn
    gives have poles near infinity, which no sampled controller can follow.
    """
    slycot = needed("slycot", "control", "H-infinity design needs slycot")
    A, B, C, D = system
    sizes = (len(A), B.shape[1], len(C), 6, measurements)

    def attempt(gamma: float) -> tuple[Array, ...] | None:
        try:
            return tuple(np.asarray(m) for m in slycot.sb10ad(*sizes, gamma, A, B, C, D, job=4)[1:5])
        except slycot.exceptions.SlycotError:
            return None

    high = 1.0
    while attempt(high) is None:
        high *= 4.0
        if high > 1e9:
            raise UnstableError(
                "no H-infinity controller was found: the measurement may not show every motion, or a weight is too "
                "small. Raise effort and noise."
            )
    low = high / 4.0
    while attempt(low) is not None:
        high, low = low, low / 4.0
    while high > 1.01 * low:
        middle = float(np.sqrt(high * low))
        low, high = (low, middle) if attempt(middle) is not None else (middle, high)
    for room in (1.2, 1.1, 1.4, 1.05, 2.0, 1.0):  # the routine fails here and there for reasons of rounding
        found = attempt(room * high)
        if found is not None:
            return room * high, found
    raise UnstableError("the H-infinity design is too badly conditioned. Raise effort and noise, or lower the depth.")


class _Task:
    """The plant without units: time in 1/pace, base and platform acceleration over one (rotations at the platform's
    size), forces by the acceleration they give, measurements by what unit base acceleration gives at rest."""

    def __init__(self, plant: Plant, measures: tuple[Measure, ...]) -> None:
        self.plant, self.measures = plant, measures
        linear = plant.linear
        self.omega_1 = float(plant.omega[0])
        self.pace = float(np.sqrt(plant.omega[0] * plant.omega[-1]))
        size = float(np.linalg.norm(linear.H[3:], axis=0).mean())  # the legs' lever about the reference
        self.axis = np.repeat([1.0, 1.0 / size], 3)  # of a unit motion: m, and rad
        rows = plant.measured(("acceleration",))
        D_a = plant.D[rows] / self.axis[:, None]
        self.force = 1.0 / np.linalg.norm(D_a, axis=0)
        self.signal = np.concatenate([self._signal(name) for name in measures])
        seen = plant.measured(measures)
        # States scaled to the pace: z/pace, so that A z, B f and E w over pace are all of order one.
        self.A = plant.A / self.pace
        self.B = plant.B * self.force
        self.E = plant.E[:, :6] * self.axis
        self.C_a = plant.C[rows] / self.axis[:, None] / self.pace
        self.D_a = D_a * self.force
        self.G_a = plant.G[rows][:, :6] * self.axis / self.axis[:, None]
        self.C = plant.C[seen] / self.signal[:, None] / self.pace
        self.D = plant.D[seen] * self.force / self.signal[:, None]
        self.G = plant.G[seen][:, :6] * self.axis / self.signal[:, None]

    def _signal(self, name: Measure) -> Array:
        linear = self.plant.linear
        push = (linear.M @ linear.carry + linear.M_b) * self.axis
        force = np.linalg.norm(np.linalg.solve(linear.H, push), axis=1)
        length = force / linear.leg_stiffness
        still = {"leg_force": force, "leg_length": length, "leg_rate": length * self.omega_1, "acceleration": self.axis}
        still |= {"position": self.axis / self.omega_1**2, "velocity": self.axis / self.omega_1}
        return still[name]

    def controller(self, A: Array, B: Array, C: Array, D: Array, name: str) -> Controller:
        """A controller of the plant without units, with them."""
        out, into = self.force[:, None], 1.0 / self.signal
        return Controller(A * self.pace, B * into * self.pace, out * C, out * D * into, self.measures, name)


def _riccati(control: Any, A: Array, B: Array, Q: Array, R: Array, S: Array) -> Array:
    """The optimal gain R^-1 (B^T X + S^T)."""
    try:
        _, _, gain = control.care(A, B, Q, R, S)
    except (ValueError, np.linalg.LinAlgError, ArithmeticError) as error:
        raise UnstableError(
            f"no optimal controller exists for these weights: {error}. The measurement may not show every motion, or a "
            "weight is zero; raise the weights."
        ) from error
    return np.asarray(gain)


def _measures(measure: Measure | Sequence[Measure]) -> tuple[Measure, ...]:
    names = (measure,) if isinstance(measure, str) else tuple(measure)
    wrong = [name for name in names if name not in MEASURES]
    if wrong or not names or len(set(names)) < len(names):
        raise ArgumentError(f"measure is {measure!r}; give one or several of {', '.join(MEASURES)}")
    return names


def _positive(**weights: float) -> None:
    for name, value in weights.items():
        if not (np.isfinite(value) and value > 0):
            raise ArgumentError(f"{name} is {value}; it must be > 0")
