"""What the poles of a closed loop say: stable or not, how well damped, how near the natural frequencies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.control.plant import Controller, Plant, damping_ratios, is_stable, poles
from flexapod.conventions import Array, Complex


class ClosedLoop(NamedTuple):
    """pole: (n,) complex rad/s, by size. damping_ratio: (n,). omega: (6,) natural frequencies without control, rad/s.

    distance: (n,) |pole - i omega|/omega to the nearest natural frequency. near: indices of vibrating poles nearer than
    the bound. worst_damping: the least damping ratio of all poles. stable: whether all decay. controller: as used.

    Source: conclusion 2.
    """

    pole: Complex
    damping_ratio: Array
    omega: Array
    distance: Array
    near: tuple[int, ...]
    worst_damping: float
    stable: bool
    controller: Controller


def assess(plant: Plant, controller: Controller, nearness: float = 0.1) -> ClosedLoop:
    """The closed loop's poles and what is to be said of them."""
    pole, omega = poles(plant, controller), plant.omega
    ratio = damping_ratios(pole)
    distance = distances(pole, omega)
    vibrating = pole.imag > 0
    near = tuple(np.flatnonzero(vibrating & (distance < nearness)).tolist())
    return ClosedLoop(pole, ratio, omega, distance, near, float(ratio.min()), bool(is_stable(pole, plant)), controller)


def unstable_words(found: ClosedLoop) -> str:
    """What is wrong with an unstable loop, and what to do."""
    worst = found.pole[int(np.argmax(found.pole.real))]
    if abs(worst.imag) < 1e-6 * abs(worst):
        worst = complex(worst.real)
    growth = f"grows e-fold in {1 / worst.real:.3g} s"
    how = f"oscillates at {abs(worst.imag):.5g} rad/s and {growth}" if worst.imag else growth
    remedy = "reduce the gains" if found.controller.dt is None else "reduce the gains, or sample faster"
    return (
        f"the machine is unstable with {found.controller.name}: the pole at {pole_words(worst)} rad/s {how}. To "
        f"cure it, {remedy}; an integral that takes the legs' static stiffness away needs a leak."
    )


def pole_words(pole: complex) -> str:
    """A pole and its conjugate, rad/s, in words."""
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
