"""Modes of K v = omega^2 M v with symmetric matrices, M positive definite.

By NumPy: SciPy's function is as accurate, but takes longer to load than most commands take to run.
"""

from __future__ import annotations

import numpy as np

from flexapod.conventions import Array


def pencil_modes(K: Array, M: Array) -> tuple[Array, Array]:
    """Squares of the frequencies (n,), rising, and shapes (n, n) as columns with v^T M v = 1."""
    factor, standard = _standard(K, M)
    square, vectors = np.linalg.eigh(standard)
    return square, np.linalg.solve(factor.T, vectors)


def pencil_squares(K: Array, M: Array) -> Array:
    """The squares of the frequencies alone (n,), rising."""
    return np.asarray(np.linalg.eigvalsh(_standard(K, M)[1]), dtype=np.float64)


def _standard(K: Array, M: Array) -> tuple[Array, Array]:
    """The Cholesky factor L of M, and L^-1 K L^-T."""
    factor = np.asarray(np.linalg.cholesky(M), dtype=np.float64)
    half = np.linalg.solve(factor, K)
    return factor, np.asarray(np.linalg.solve(factor, half.T), dtype=np.float64)
