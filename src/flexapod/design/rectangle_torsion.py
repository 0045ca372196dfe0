"""Torsion of flexures with rectangular sections, whose ends are held by bodies and cannot warp."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from flexapod.conventions import Array

SECTIONS = 400  # from the middle of a flexure to an end


def torsion_constant(one: float | Array, other: float | Array) -> Array:
    """Torsion constant of rectangles in m4, by Saint-Venant's series."""
    thin, wide = np.minimum(one, other), np.maximum(one, other)
    odd = np.arange(1, 40, 2)
    series = np.sum(np.tanh(odd * pi / 2 * np.asarray(wide / thin)[..., None]) / odd**5.0, axis=-1)
    return np.asarray(wide * thin**3 / 3 * (1 - 192 * thin / (pi**5 * wide) * series))


def warping_constant(one: float | Array, other: float | Array) -> Array:
    """Integral of the square of the warping of rectangles that twist by 1 rad/m, in m6, by Saint-Venant's series.

    The thinner, the nearer it is to (thickness width)^3 / 144.
    """
    b, a = (np.asarray(half)[..., None] / 2 for half in (np.minimum(one, other), np.maximum(one, other)))
    k = np.arange(1, 40, 2) * pi / (2 * a)
    t = np.tanh(k * b)
    less = np.sum(32 * (k * b - t) / k**7 - 16 * (t / k - b * (1 - t**2)) / k**6, axis=-1) / a[..., 0]
    return np.asarray(4 / 9 * (a * b)[..., 0] ** 3 - less)


def notch_half(radius: float, thickness: float) -> tuple[Array, Array]:
    """Places from the middle of a notch to its mouth, and the thickness there; close where it is thinnest."""
    near = min(1.0, sqrt(thickness / radius))
    angle = near * np.sinh(np.linspace(0.0, np.arcsinh(pi / 2 / near), SECTIONS))
    return radius * np.sin(angle), thickness + 2 * radius * (1 - np.cos(angle))


def straight_half(length: float, thickness: float) -> tuple[Array, Array]:
    """The same of a constant thickness."""
    return np.linspace(0.0, length / 2, SECTIONS), np.full(SECTIONS, thickness)


def twist(half: tuple[Array, Array], width: float, young: float, shear: float) -> float:
    """Angle in rad by which a moment of 1 N m twists a flexure of rectangular sections whose ends cannot warp.

    half: places from its middle to an end, and its thickness there. The sections warp with x times Saint-Venant's
    warping function, where x(s) is found by linear finite elements of the energy for each length
    (E I_w x'^2 + G A (twist - x)^2 + G C (twist + x)^2 / 4) / 2. A is that of a plate's shear, and C makes a long
    flexure twist as Saint-Venant's.
    """
    from scipy.linalg import solveh_banded  # takes longer to load than all else that a design needs

    place, height = half
    steps, height = np.diff(place), (height[1:] + height[:-1]) / 2
    plate = shear * 5 / 72 * np.minimum(height, width) * np.maximum(height, width) ** 3
    twisting = 1 / (1 / (shear * torsion_constant(height, width)) - 1 / (4 * plate))
    both, difference = plate + twisting / 4, plate - twisting / 4
    across = young * warping_constant(height, width) / steps
    along = plate * twisting / both * steps / 6
    push = difference / both * steps / 2
    matrix = np.zeros((2, place.size))  # the diagonal above, and the diagonal
    matrix[0, 1:] = along - across
    matrix[1, :-1] = across + 2 * along
    matrix[1, 1:] += across + 2 * along
    load = np.append(push, 0.0) + np.append(0.0, push)
    warp = np.append(solveh_banded(matrix[:, :-1], load[:-1]), 0.0)
    return 2 * float(np.sum((1 + difference * (warp[1:] + warp[:-1]) / 2) / both * steps))
