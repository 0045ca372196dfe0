"""Position control on the exact tangent: PD and PID laws, their poles, and how near these come to the machine's
natural frequencies (the paper's conclusion 2)."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from itertools import product
from typing import Literal, NamedTuple, Unpack, get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.errors import ArgumentError, UnstableError
from flexapod.feedback import Complex, Controller, Law, Measure, Plant, damping_ratios, is_stable, poles, six_by_six
from flexapod.hexapod import Hexapod
from flexapod.linear import Linearisation, RestOptions, linearise
from flexapod.pose import Array, Pose

Space = Literal["joint", "task"]
Actuator = Literal["force", "command"]


class GainWarning(UserWarning):
    """Gains that put poles of the closed loop near natural frequencies of the machine."""


@dataclass(frozen=True)
class PID:
    """Proportional, derivative and integral gains of a position loop.

    space="joint": the six leg lengths are controlled, each by its own leg for a single number or six. space="task":
    the platform's displacement and rotation vector. actuator="force": leg forces beside the springs.
    actuator="command": changes of the legs' unstretched lengths d, which act as forces K d.

    Units of kp, kd, ki, each a number, six, or a 6 x 6 matrix:
    joint, force: N/m, N s/m, N/(m s) of leg length. Command (either space): 1, s, 1/s, since a length answers a
    length; in task space the platform's error is turned into leg lengths by H^T. Task, force: a wrench, N/m and N m/rad
    and so on, which the legs produce through H^-1; there a single number is per unit of inertia (1/s2, 1/s, 1/s3), so
    that it means the same for translations and rotations.

    bandwidth: rad/s of the filter through which the derivative is taken from the measured position; None: the rate
    itself is measured.
    """

    kp: ArrayLike = 0.0
    kd: ArrayLike = 0.0
    ki: ArrayLike = 0.0
    space: Space = "joint"
    actuator: Actuator = "force"
    bandwidth: float | None = None

    def __post_init__(self) -> None:
        for name, value, known in (("space", self.space, Space), ("actuator", self.actuator, Actuator)):
            if value not in get_args(known):
                raise ArgumentError(f"{name} is {value!r}; it must be {' or '.join(map(repr, get_args(known)))}")
        for name in ("kp", "kd", "ki"):
            six_by_six(getattr(self, name), name)
        if self.bandwidth is not None and not (np.isfinite(self.bandwidth) and self.bandwidth > 0):
            raise ArgumentError(f"bandwidth is {self.bandwidth} rad/s; it must be > 0")

    def on(self, linear: Linearisation) -> Controller:
        """The controller at a pose. States: the integral, then the derivative's filter, where there are any."""
        kp, kd, ki = (self._force(getattr(self, name), name, linear) for name in ("kp", "kd", "ki"))
        position, rate = ("leg_length", "leg_rate") if self.space == "joint" else ("position", "velocity")
        measures: tuple[Measure, ...] = (position,) if self.bandwidth is not None else (position, rate)  # type: ignore[assignment]
        width = 6 * len(measures)
        zero, one = np.zeros((6, 6)), np.eye(6)
        D = -kp if self.bandwidth is not None else np.hstack([-kp, -kd])
        A, B, C = np.zeros((0, 0)), np.zeros((0, width)), np.zeros((6, 0))
        if ki.any():
            A, B, C = zero, np.hstack([one, *[zero] * (len(measures) - 1)]), -ki
        if self.bandwidth is not None:  # kd N s/(s + N) = kd N - kd N^2/(s + N)
            N, n = self.bandwidth, len(A)
            A = np.block([[A, np.zeros((n, 6))], [np.zeros((6, n)), -N * one]])
            B, C, D = np.vstack([B, N * one]), np.hstack([C, N * kd]), D - N * kd
        return Controller(A, B, C, D, measures, f"{self.space}-space PID")

    def _force(self, value: ArrayLike, name: str, linear: Linearisation) -> Array:
        """The gain from measured positions to leg forces."""
        gain = six_by_six(value, name)
        K_legs = linear.leg_stiffness[:, None]
        if self.space == "joint":
            return gain if self.actuator == "force" else K_legs * gain
        if self.actuator == "command":
            return K_legs * (linear.H.T @ gain)
        return np.linalg.solve(linear.H, linear.M @ gain if np.ndim(value) == 0 else gain)


class ClosedLoop(NamedTuple):
    """pole: (n,) complex rad/s, by size. damping_ratio: (n,). omega: (6,) natural frequencies without control, rad/s.

    distance: (n,) |pole - i omega|/omega to the nearest natural frequency. near: indices of vibrating poles nearer than
    the bound. worst_damping: the least damping ratio of all poles. stable: whether all decay. controller: as used.
    """

    pole: Complex
    damping_ratio: Array
    omega: Array
    distance: Array
    near: tuple[int, ...]
    worst_damping: float
    stable: bool
    controller: Controller


def closed_loop(
    hexapod: Hexapod,
    pose: Pose,
    law: Law,
    *,
    nearness: float = 0.1,
    unstable: str = "raise",
    **rest: Unpack[RestOptions],
) -> ClosedLoop:
    """Poles of the machine at a pose under a control law, on the exact tangent.

    law: a PID, a ForceFeedback or VelocityFeedback, or any Controller, sampled ones included. Warns (GainWarning) when
    a pole lies within `nearness` of a natural frequency, as the paper demands. Raises UnstableError for gains that make
    the machine unstable, unless unstable="keep". rest: as for `linearise`.
    """
    plant = Plant(linearise(hexapod, pose, **rest))
    controller = law.on(plant.linear)
    found = assess(plant, controller, nearness)
    if not found.stable and unstable != "keep":
        raise UnstableError(unstable_words(found))
    if found.near:
        first = found.near[0]
        warnings.warn(
            f"{len(found.near)} poles of {controller.name} lie within {nearness:.0%} of a natural frequency, such as "
            f"{_pole_words(found.pole[first])} rad/s beside {nearest(found.pole[first], found.omega):.5g} rad/s; the machine may "
            "vibrate more than without control. Move the gains away.",
            GainWarning,
            stacklevel=2,
        )
    return found


def assess(plant: Plant, controller: Controller, nearness: float = 0.1) -> ClosedLoop:
    """The closed loop's poles and what is to be said of them."""
    pole, omega = poles(plant, controller), plant.omega
    ratio = damping_ratios(pole)
    distance = distances(pole, omega)
    vibrating = pole.imag > 0
    near = tuple(np.flatnonzero(vibrating & (distance < nearness)).tolist())
    return ClosedLoop(pole, ratio, omega, distance, near, float(ratio.min()), is_stable(pole, plant), controller)


def unstable_words(found: ClosedLoop) -> str:
    """What is wrong with an unstable loop, and what to do."""
    worst = found.pole[int(np.argmax(found.pole.real))]
    if abs(worst.imag) < 1e-6 * abs(worst):
        worst = complex(worst.real)
    growth = f"grows e-fold in {1 / worst.real:.3g} s"
    how = f"oscillates at {abs(worst.imag):.5g} rad/s and {growth}" if worst.imag else growth
    remedy = "reduce the gains" if found.controller.dt is None else "reduce the gains, or sample faster"
    return (
        f"the machine is unstable with {found.controller.name}: the pole at {_pole_words(worst)} rad/s {how}. To cure it, {remedy}; "
        "an integral that takes the legs' static stiffness away needs a leak."
    )


def _pole_words(pole: complex) -> str:
    return f"{pole.real:.4g}" + (f" +- {abs(pole.imag):.5g}i" if pole.imag else "")


def nearest(pole: complex, omega: Array) -> float:
    """The natural frequency nearest to a pole, rad/s."""
    return float(omega[np.argmin(np.abs(pole - 1j * omega) / omega)])


def distances(pole: Complex, omega: Array) -> Array:
    """(...) least |p - i omega_i|/omega_i over the natural frequencies, of p or its conjugate, whichever is above."""
    upper = pole.real + 1j * np.abs(pole.imag)
    return (np.abs(upper[..., None] - 1j * omega) / omega).min(axis=-1)


def gain_map(
    hexapod: Hexapod,
    pose: Pose,
    kp: ArrayLike,
    kd: ArrayLike,
    *,
    law: PID | None = None,
    nearness: float = 0.1,
    **rest: Unpack[RestOptions],
) -> xr.Dataset:
    """Closed-loop poles over a range of proportional and derivative gains, kp (m,) and kd (n,).

    law: what else the loop is (space, actuator, ki, bandwidth); default: PD on the legs by forces. Dataset over
    (kp, kd): `distance`, the least relative distance of a vibrating pole to a natural frequency (infinite when none
    vibrates); `worst_damping`; `stable`; `near` (bool); `pole` (kp, kd, pole), rad/s. Warns (GainWarning) where gains
    put poles within `nearness` of a natural frequency. Raises ArgumentError for gains that are no rows of numbers.
    """
    rows = {"kp": _row(kp, "kp"), "kd": _row(kd, "kd")}
    base = law or PID()
    plant = Plant(linearise(hexapod, pose, **rest))
    shape = (rows["kp"].size, rows["kd"].size)
    found = [_with(base, p, d).on(plant.linear) for p, d in product(*rows.values())]
    pole = np.stack([poles(plant, controller) for controller in found]).reshape(*shape, -1)
    omega = plant.omega
    distance = np.where(pole.imag > 0, distances(pole, omega), np.inf).min(axis=-1)
    near = distance < nearness
    grid = ("kp", "kd")
    dataset = xr.Dataset(
        {
            "distance": (grid, distance, {"long_name": "least distance of poles to natural frequencies, relative"}),
            "worst_damping": (grid, damping_ratios(pole).min(axis=-1), {"long_name": "least damping ratio"}),
            "stable": (grid, (pole.real < 1e-11 * plant.omega_0).all(axis=-1)),
            "near": (grid, near),
            "pole": ((*grid, "pole_number"), pole, {"units": "rad/s"}),
        },
        {
            "kp": ("kp", rows["kp"], {"long_name": "proportional gain", "units": _unit(base, 0)}),
            "kd": ("kd", rows["kd"], {"long_name": "derivative gain", "units": _unit(base, 1)}),
        },
        {
            "design": hexapod.name,
            "digest": hexapod.digest,
            "space": base.space,
            "actuator": base.actuator,
            "nearness": nearness,
            "natural_frequencies_rad_s": omega.tolist(),
        },
    )
    if near.any():
        warnings.warn(
            f"{int(near.sum())} of {near.size} pairs of gains put a pole within {nearness:.0%} of a natural frequency; "
            "there the machine may vibrate more than without control. Choose gains where `near` is False.",
            GainWarning,
            stacklevel=2,
        )
    return dataset


def _with(law: PID, kp: float, kd: float) -> PID:
    return PID(float(kp), float(kd), law.ki, law.space, law.actuator, law.bandwidth)


def _row(value: ArrayLike, name: str) -> Array:
    row = np.atleast_1d(np.asarray(value, dtype=np.float64))
    if row.ndim != 1 or not row.size or not np.isfinite(row).all() or np.unique(row).size != row.size:
        raise ArgumentError(f"{name} has shape {row.shape}; give a row of different, finite gains")
    return row


def _unit(law: PID, rates: int) -> str:
    """Unit of a single gain, for a position (0) or a rate (1)."""
    if law.actuator == "command":
        return ("1", "s")[rates]
    return ("N/m", "N s/m")[rates] if law.space == "joint" else ("1/s2", "1/s")[rates]
