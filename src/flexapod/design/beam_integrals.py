"""Integrals over beams whose thickness is constant or that of a notch."""

from collections.abc import Callable
from math import comb, pi, sqrt

import numpy as np

#: Of a length coordinate x from the flexure's middle and a thickness h: the integrals of h^-n and of x^2 h^-n over x.
Integrals = Callable[[int], tuple[float, float]]


def straight(length: float, thickness: float) -> Integrals:
    """The integrals of a constant thickness."""
    return lambda n: (length / thickness**n, length**3 / (12 * thickness**n))


def notch(radius: float, thickness: float) -> Integrals:
    """The integrals of the thickness t + 2 R (1 - cos u) over x = R sin u, |u| <= 90 degrees.

    With q = a - b cos u = h / t, where a = 1 + b and b = 2 R / t, they are sums of integrals of powers of q, for which
    there is a recurrence (Gradshteyn and Ryzhik, Table of Integrals, 2.554).
    """
    b = 2 * radius / thickness
    a = 1 + b
    square = 1 + 2 * b  # a^2 - b^2
    power = {-2: a**2 * pi - 4 * a * b + b**2 * pi / 2, -1: a * pi - 2 * b, 0: pi}
    power[1] = 4 / sqrt(square) * np.arctan(sqrt(square))
    for n in (2, 3, 4):
        ends = 2 * b / a ** (n - 1)
        power[n] = (ends + (2 * n - 3) * a * power[n - 1] - (n - 2) * power[n - 2]) / ((n - 1) * square)

    def cosine(m: int, n: int) -> float:
        """The integral of cos^m / q^n."""
        return float(sum(comb(m, k) * a ** (m - k) * (-1) ** k * power[n - k] for k in range(m + 1)) / b**m)

    def over(n: int) -> tuple[float, float]:
        scale = radius / thickness**n
        return scale * cosine(1, n), scale * radius**2 * (cosine(1, n) - cosine(3, n))

    return over
