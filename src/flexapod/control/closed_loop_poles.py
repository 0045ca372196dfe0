"""Poles of a closed loop: stability, damping, and distance to the natural frequencies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.control.linear_controller import Controller, Measurement
from flexapod.control.plant import Plant, damping_ratios, is_stable, poles
from flexapod.conventions import Array, Complex
from flexapod.mechanics.cautions import stands
from flexapod.mechanics.modes import advised_sampling_time
from flexapod.showing import in_notebooks

_KEPT_DAMPING = 0.2  # of the continuous loop: a sampled one that keeps less is sampled too slowly
_HALVINGS = 20
_TOLD_AS_CREEP = 0.02  # of the lowest natural frequency: slower decay is the law's work on stiffness or friction
_NEUTRAL = 1e-9  # the same: below, a pole is at zero but for rounding, and its motion neither decays nor grows
#: What slow decay means, by what a law of each leg measures.
_CREEP_MEANS: dict[tuple[Measurement, ...], str] = {
    ("leg_force",): "a gain not far above takes the stiffness away, and the platform falls over",
    ("leg_rate",): "the loops are dampers so strong that the legs hardly yield",
}


@in_notebooks
class ClosedLoop(NamedTuple):
    """Poles of a hexapod under control, as `closed_loop` gives them.

    Attributes
    ----------
    pole : ndarray of complex, shape (n,)
        Poles, rad/s, by modulus.
    damping_ratio : ndarray, shape (n,)
        Damping ratio of each pole.
    omega : ndarray, shape (6,)
        Natural frequencies without control, rad/s.
    distance : ndarray, shape (n,)
        abs(pole - i omega)/omega for the nearest natural frequency.
    near : tuple of int
        Indices of the vibrating poles whose distance is below the bound asked for.
    worst_damping : float
        The smallest damping ratio of all poles.
    stable : bool
        Whether all poles decay.
    controller : Controller
        The controller of the loop.
    """

    pole: Complex
    damping_ratio: Array
    omega: Array
    distance: Array
    near: tuple[int, ...]
    worst_damping: float
    stable: bool
    controller: Controller

    @property
    def cautions(self) -> tuple[str, ...]:
        """What to beware of in the loop, in words; empty where there is nothing."""
        return tuple(filter(None, (near_words(self), creep_words(self))))


def near_words(loop: ClosedLoop) -> str:
    """That vibrating poles lie near natural frequencies, where some do."""
    if not loop.near:
        return ""
    first = loop.pole[loop.near[0]]
    return (
        f"{len(loop.near)} poles of the closed loop lie near a natural frequency, such as {pole_text(first)} rad/s "
        f"beside {nearest(first, loop.omega):.5g} rad/s; there the machine may vibrate more than without control."
    )


def creep_words(loop: ClosedLoop) -> str:
    """That legs with loops of their own let the platform creep, where one does: a pole near zero that does not swing.

    Force feedback can nearly take the static stiffness away, velocity feedback can be a damper that hardly yields.
    """
    means = _CREEP_MEANS.get(loop.controller.measures)
    pole = loop.pole
    still = np.abs(pole.imag) < 1e-3 * np.abs(pole.real)
    slow = pole[still & (pole.real < -_NEUTRAL * loop.omega[0]) & (pole.real > -_TOLD_AS_CREEP * loop.omega[0])]
    if means is None or not slow.size:
        return ""
    rate = float(-slow.real.max())
    return (
        f"A motion without oscillation decays only in {1 / rate:.3g} s (a pole at -{rate:.3g} rad/s, which no damping "
        f"ratio shows): {means}. Take a smaller gain."
    )


def assess(plant: Plant, controller: Controller, nearness: float = 0.1) -> ClosedLoop:
    """Poles of the closed loop, with damping, stability and distance to the natural frequencies."""
    pole, omega = poles(plant, controller), plant.omega
    ratio = damping_ratios(pole)
    distance = distances(pole, omega)
    vibrating = pole.imag > 0
    near = tuple(np.flatnonzero(vibrating & (distance < nearness)).tolist())
    return ClosedLoop(pole, ratio, omega, distance, near, float(ratio.min()), bool(is_stable(pole, plant)), controller)


def loop_sampling_time(plant: Plant, controller: Controller, longest: float, delay: int = 0) -> float:
    """Largest sensible sampling time of a continuous controller, s, at most `longest`, which the machine alone allows.

    Where the sampled loop is unstable with that, or keeps less than a fifth of the damping, the loop is faster than the
    machine, as where forces and not springs hold the platform. Then it is a twentieth of a period of the loop's fastest
    pole, halved until the sampled loop keeps its damping.
    """
    ideal = assess(plant, controller)
    if not ideal.stable:
        return longest
    wanted = _KEPT_DAMPING * ideal.worst_damping

    def keeps(dt: float) -> bool:
        loop = assess(plant, controller.sampled(dt, delay=delay))
        return loop.stable and loop.worst_damping >= wanted

    if keeps(longest):
        return longest
    dt = min(longest, advised_sampling_time(float(np.abs(ideal.pole).max())))
    for _ in range(_HALVINGS):
        if keeps(dt):
            break
        dt /= 2
    return dt


def instability_message(found: ClosedLoop, plant: Plant) -> str:
    """What is wrong with an unstable loop, and the remedy."""
    worst = found.pole[int(np.argmax(found.pole.real))]
    if abs(worst.imag) < 1e-6 * abs(worst):
        worst = complex(worst.real)
    growth = f"grows e-fold in {1 / worst.real:.3g} s"
    how = f"oscillates at {abs(worst.imag):.5g} rad/s and {growth}" if worst.imag else growth
    remedy = "reduce the gains" if found.controller.dt is None else "reduce the gains, or sample faster"
    unstable = f"the machine is unstable with {found.controller.name}: the pole at {pole_text(worst)} rad/s {how}."
    if not stands(plant.linear.modes()):
        return (
            f"{unstable} Without control it falls over under its own weight, and this law does not hold it. Stiffen "
            "the legs or lower the mass centre, or choose a law that holds it, as joint-space PID with high gains."
        )
    return f"{unstable} To cure it, {remedy}; an integral that takes the legs' static stiffness away needs a leak."


def pole_text(pole: complex) -> str:
    """A pole and its conjugate, rad/s, as text."""
    return f"{pole.real:.4g}" + (f" +- {abs(pole.imag):.5g}i" if pole.imag else "")


def nearest(pole: complex, omega: Array) -> float:
    """The natural frequency nearest to a pole, rad/s."""
    return float(omega[np.argmin(np.abs(pole - 1j * omega) / omega)])


def distances(pole: Complex, omega: Array) -> Array:
    """(...) least |p - i omega_i|/omega_i over the natural frequencies, of p or its conjugate, whichever is above."""
    upper = pole.real + 1j * np.abs(pole.imag)
    return (np.abs(upper[..., None] - 1j * omega) / omega).min(axis=-1)


def least_damping(pole: Complex) -> float:
    """The least damping ratio of vibrating or growing poles; 1 when there are none."""
    size = np.abs(pole).max()
    matter = (np.abs(pole.imag) > 1e-9 * size) | (pole.real > 1e-9 * size)
    return float(damping_ratios(pole[matter]).min(initial=1.0))
