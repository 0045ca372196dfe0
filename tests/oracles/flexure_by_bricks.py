"""Flexures of rectangular sections between rigid bodies, by bricks of 27 nodes: no beam, no plate, no rigid section.

An eighth is meshed: x along the flexure, y over its width, z over its thickness, each from the middle. What is zero on a
plane of symmetry, and how the end moves, makes the load case.
"""

from itertools import product

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)

#: How the end moves for a movement of 1/2, and which displacements vanish on the planes x = 0, y = 0, z = 0.
CASES = {
    "torsion": (lambda y, z: (0 * y, -z, y), ("yz", "xz", "xy")),
    "bending": (lambda y, z: (z, 0 * y, 0 * y), ("x", "y", "xy")),
    "axial": (lambda y, z: (1 + 0 * y, 0 * y, 0 * y), ("x", "y", "z")),
    "shear": (lambda y, z: (0 * y, 0 * y, 1 + 0 * y), ("yz", "y", "xy")),
    "wide shear": (lambda y, z: (0 * y, 1 + 0 * y, 0 * y), ("yz", "xz", "z")),
}


def stiffness(case, half, thickness, width, poisson, *, elements=(14, 8, 2)):
    """Stiffness over Young's modulus; half: x of the section planes from the middle to the end, as a function of a
    parameter from 0 to 1, and thickness: of the same parameter."""
    place, bricks = _mesh(half, thickness, width, elements)
    values = _bricks(place[bricks], _law(poisson))
    dofs = (3 * bricks[:, :, None] + np.arange(3)).reshape(len(bricks), -1)
    rows = np.repeat(dofs, dofs.shape[1], axis=1).ravel()
    columns = np.tile(dofs, dofs.shape[1]).ravel()
    matrix = coo_matrix((values.ravel(), (rows, columns))).tocsr()
    moves, planes = CASES[case]
    moved = np.zeros((len(place), 3))
    held = np.zeros((len(place), 3), dtype=bool)
    for axis, names in enumerate(planes):
        held[np.ix_(place[:, axis] == 0, ["xyz".index(name) for name in names])] = True
    end = place[:, 0] == place[:, 0].max()
    moved[end] = np.stack(moves(place[end, 1], place[end, 2]), 1) / 2
    held[end] = True
    moved, free = moved.ravel(), ~held.ravel()
    moved[free] = spsolve(matrix[free][:, free].tocsc(), -(matrix @ moved)[free])
    return float(8 * moved @ (matrix @ moved))


def _mesh(half, thickness, width, elements):
    """Nodes (n, 3), and the 27 of each brick."""
    along, wide, over = (np.linspace(0, 1, 2 * n + 1) for n in elements)
    heights = np.array([thickness(one) / 2 for one in along])
    shape = (along.size, wide.size, over.size)
    x = np.broadcast_to(np.array([half(one) for one in along])[:, None, None], shape)
    y = np.broadcast_to(width / 2 * np.sin(wide * np.pi / 2)[None, :, None], shape)  # finer at the free edge
    z = heights[:, None, None] * np.broadcast_to(over, shape)
    number = np.arange(x.size).reshape(shape)
    starts = product(*(range(0, n - 2, 2) for n in shape))
    bricks = np.array([number[i : i + 3, j : j + 3, k : k + 3].ravel() for i, j, k in starts])
    return np.stack([x.ravel(), y.ravel(), z.ravel()], 1), bricks


def _law(poisson):
    lame, shear = poisson / ((1 + poisson) * (1 - 2 * poisson)), 1 / (2 * (1 + poisson))
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += lame
    return law


def _bricks(corners, law):
    """Stiffness matrices of bricks whose nodes are at corners, (n, 27, 3)."""
    total = np.zeros((len(corners), 81, 81))
    for (r, a), (s, b), (t, c) in product(zip(POINTS, WEIGHTS, strict=True), repeat=3):
        lines, slopes = [_line(q) for q in (r, s, t)], [_slope(q) for q in (r, s, t)]
        local = np.stack(
            [np.einsum("i,j,k->ijk", *(slopes[n] if n == m else lines[n] for n in range(3))).ravel() for m in range(3)]
        )
        jacobian = local @ corners
        x, y, z = np.moveaxis(np.linalg.solve(jacobian, np.broadcast_to(local, (len(corners), 3, 27))), 1, 0)
        strain = np.zeros((len(corners), 6, 81))
        strain[:, 0, 0::3], strain[:, 1, 1::3], strain[:, 2, 2::3] = x, y, z
        strain[:, 3, 0::3], strain[:, 3, 1::3] = y, x
        strain[:, 4, 0::3], strain[:, 4, 2::3] = z, x
        strain[:, 5, 1::3], strain[:, 5, 2::3] = z, y
        total += (a * b * c * np.linalg.det(jacobian))[:, None, None] * (strain.transpose(0, 2, 1) @ law @ strain)
    return total


def _line(s):
    return np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2])


def _slope(s):
    return np.array([s - 0.5, -2 * s, s + 0.5])
