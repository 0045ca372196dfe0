"""Integrals over frequency of densities with sharp resonances: panels that shrink towards every pole."""

from __future__ import annotations

import numpy as np

from flexapod.conventions import Array, Complex

_NODES = 8  # Gauss points of a panel: a pole is at least its panel's width away, so they err by about 1e-10


def graded(grid: Array, poles: Complex) -> Array:
    """Panel edges: the grid, octaves of its lowest frequency, and steps that double away from every pole."""
    low, high = grid[0], grid[-1]
    edges = [grid, low * 2.0 ** np.arange(1, np.ceil(np.log2(high / low)))]
    for pole in poles:
        width = max(abs(pole.real), 1e-13 * abs(pole))
        steps = width * 2.0 ** np.arange(-1, np.ceil(np.log2(high / width)))
        edges += [pole.imag + steps, pole.imag - steps]
    merged = np.unique(np.concatenate(edges))
    return merged[(merged >= low) & (merged <= high)]


class Panels:
    """Gauss quadrature over panels; omega: every panel's lower edge and nodes, then the last edge."""

    def __init__(self, edges: Array) -> None:
        x, self._weights = np.polynomial.legendre.leggauss(_NODES)
        self._half = 0.5 * np.diff(edges)
        nodes = edges[:-1, None] + self._half[:, None] * (1 + x)
        self.omega = np.append(np.column_stack([edges[:-1], nodes]).ravel(), edges[-1])
        powers = np.arange(_NODES)  # integral of the nodes' interpolant from the lower edge to each node
        antiderivative = (x[:, None] ** (powers + 1) - (-1.0) ** (powers + 1)) / (powers + 1)
        self._to_nodes = antiderivative @ np.linalg.inv(x[:, None] ** powers)

    def cumulated(self, density: Array) -> Array:
        """Integral (n, 6) of a density (n, 6) from the lowest frequency to each of `omega`."""
        at_nodes = density[:-1].reshape(self._half.size, _NODES + 1, 6)[:, 1:]
        scaled = self._half[:, None, None] * at_nodes
        whole = np.cumsum(np.einsum("k,pkj->pj", self._weights, scaled), axis=0)
        before = np.concatenate([np.zeros((1, 6)), whole])
        inside = before[:-1, None] + np.concatenate(
            [np.zeros((self._half.size, 1, 6)), self._to_nodes @ scaled], axis=1
        )
        bounded = np.clip(inside, before[:-1, None], whole[:, None])  # an interpolant may overshoot
        return np.maximum.accumulate(np.concatenate([bounded.reshape(-1, 6), whole[-1:]]))
