"""Notches by finite elements of nine nodes, which know nothing of beams: plane stress, and bodies of revolution.

A quarter of the notch is meshed, with one body beside it that is as deep as the notch's mouth and as long. What beam
theory gives for the bodies is taken off again, so that what they yield near the notch is the notch's.
"""

from itertools import product

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)
COLUMNS, ROWS = (36, 24), 12  # elements along the notch, along the body beside it, and over half the thickness


def plane(radius, thickness, poisson, *, finer=1):
    """Compliances times Young's modulus times width, in bending (1/m2) and along the notch."""
    law = _plane_stress(poisson)
    depth = thickness + 2 * radius
    mesh = _Mesh(radius, thickness, finer)
    found = []
    for pull, held, beam, load in (
        (lambda y: y, mesh.dofs(2, middle=[0], neutral=[0], pinned=[1]), 12 / depth**2, depth**3 / 12),
        (np.ones_like, mesh.dofs(2, middle=[0], neutral=[1], pinned=[]), 1.0, depth),
    ):
        work = mesh.work(2, law, _plane_strain, lambda y: 1.0, 0, pull, held)
        found.append(2 * (2 * work / load**2 - beam))
    return tuple(found)


def stressed(radius, thickness, poisson, *, finer=1):
    """How many times a beam's stress there is where the notch is thinnest, in bending: Young's modulus times strain."""
    law = _plane_stress(poisson)
    mesh = _Mesh(radius, thickness, finer)
    held = mesh.dofs(2, middle=[0], neutral=[0], pinned=[1])
    moved, _ = mesh.solve(2, law, _plane_strain, lambda y: 1.0, 0, lambda y: y, held)
    nodes = mesh.number[
        :3, -3:
    ].ravel()  # of the element at the free edge; nothing but the stress along it is left there
    slopes = np.stack([np.outer(_slope(-1), _line(1)).ravel(), np.outer(_line(-1), _slope(1)).ravel()])
    along, _ = np.linalg.solve(slopes @ np.stack([mesh.x.ravel()[nodes], mesh.y.ravel()[nodes]], 1), slopes)
    moment = (thickness + 2 * radius) ** 3 / 12
    return float(along @ moved[2 * nodes] / (6 * moment / thickness**2))


def revolved(radius, diameter, poisson, *, finer=1):
    """Compliances times Young's modulus in bending, along, and in torsion.

    Displacements along and outwards go with the cosine of the angle about the axis in bending, those around with the
    sine (Fourier's elements; Zienkiewicz and Taylor, The Finite Element Method, 2, chapter 9).
    """
    lame, shear = poisson / ((1 + poisson) * (1 - 2 * poisson)), 1 / (2 * (1 + poisson))
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += lame

    def strain_of(wave):
        def strain(shape, along, over, r):
            matrix, round_ = np.zeros((len(r), 6, 27)), shape / r[:, None]
            w, u, v = slice(0, 27, 3), slice(1, 27, 3), slice(2, 27, 3)
            matrix[:, 0, w], matrix[:, 1, u] = along, over
            matrix[:, 2, u], matrix[:, 2, v] = round_, wave * round_
            matrix[:, 3, w], matrix[:, 3, u] = over, along
            matrix[:, 4, w], matrix[:, 4, v] = -wave * round_, along
            matrix[:, 5, u], matrix[:, 5, v] = -wave * round_, over - round_
            return matrix

        return strain

    depth = diameter + 2 * radius
    mesh = _Mesh(radius, diameter, finer)
    full, half = lambda r: 2 * np.pi * r, lambda r: np.pi * r
    inertia = np.pi * depth**4 / 64
    found = []
    for wave, about, of, pull, held, beam, load in (
        (1, half, 0, lambda r: r, mesh.dofs(3, middle=[0], neutral=[0], pinned=[1]), depth / inertia, inertia),
        (0, full, 0, np.ones_like, mesh.dofs(3, middle=[0], neutral=[1, 2], pinned=[]), 4 / (np.pi * depth), None),
        (0, full, 2, lambda r: r, mesh.dofs(3, middle=[2], neutral=[1, 2], pinned=[0]), None, 2 * inertia),
    ):
        load = np.pi * depth**2 / 4 if load is None else load
        beam = depth / (2 * inertia * shear) if beam is None else beam
        work = mesh.work(3, law, strain_of(wave), about, of, pull, held)
        found.append(2 * (work / load**2 - beam))
    return tuple(found)


def _plane_stress(poisson):
    return np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson) / 2]]) / (1 - poisson**2)


def _plane_strain(shape, along, over, y):
    matrix = np.zeros((len(y), 3, 18))
    matrix[:, 0, ::2], matrix[:, 1, 1::2] = along, over
    matrix[:, 2, ::2], matrix[:, 2, 1::2] = over, along
    return matrix


class _Mesh:
    """A quarter of the notch and its body: x along, y over half the thickness, (columns, rows) of nodes."""

    def __init__(self, radius, thickness, finer):
        depth = thickness + 2 * radius
        angle = np.linspace(0, np.pi / 2, 2 * COLUMNS[0] * finer + 1)
        body = radius + depth * np.linspace(0, 1, 2 * COLUMNS[1] * finer + 1)[1:] ** 1.5
        along = np.concatenate([radius * np.sin(angle), body])
        half = np.concatenate([thickness / 2 + radius * (1 - np.cos(angle)), np.full(body.size, depth / 2)])
        over = np.linspace(0, 1, 2 * ROWS * finer + 1)
        self.x = np.broadcast_to(along[:, None], (along.size, over.size))
        self.y = half[:, None] * over
        self.number = np.arange(self.x.size).reshape(self.x.shape)

    def dofs(self, kinds, middle, neutral, pinned):
        """Which displacements are zero: those of the middle section, of the line y = 0, and of the node in both."""
        held = np.zeros((self.x.size, kinds), dtype=bool)
        held[np.ix_(self.number[0], middle)] = True
        held[np.ix_(self.number[:, 0], neutral)] = True
        held[self.number[0, 0], pinned] = True
        return held.ravel()

    def work(self, kinds, law, strain, about, of, pull, held):
        """Twice the energy under a stress on the end, in the displacement `of`."""
        moved, load = self.solve(kinds, law, strain, about, of, pull, held)
        return float(moved @ load)

    def solve(self, kinds, law, strain, about, of, pull, held):
        """Displacements under that stress, and its loads."""
        firsts = product(range(0, self.x.shape[0] - 2, 2), range(0, self.x.shape[1] - 2, 2))
        nodes = np.stack([self.number[i : i + 3, j : j + 3].ravel() for i, j in firsts])
        place = (kinds * nodes[..., None] + np.arange(kinds)).reshape(len(nodes), -1)
        values = _elements(self.x.ravel()[nodes], self.y.ravel()[nodes], law, strain, about)
        rows, columns = (np.broadcast_to(p, values.shape).ravel() for p in (place[:, :, None], place[:, None]))
        load = self._load(kinds, about, of, pull)
        stiffness = coo_matrix((values.ravel(), (rows, columns))).tocsc()
        free, moved = ~held, np.zeros(load.size)
        moved[free] = spsolve(stiffness[free][:, free], load[free])
        return moved, load

    def _load(self, kinds, about, of, pull):
        load = np.zeros(self.x.size * kinds)
        for j in range(0, self.x.shape[1] - 2, 2):
            edge = self.y[-1, j : j + 3]
            for point, weight in zip(POINTS, WEIGHTS, strict=True):
                y = _line(point) @ edge
                size = weight * (edge[2] - edge[0]) / 2 * about(y) * pull(y)
                load[kinds * self.number[-1, j : j + 3] + of] += size * _line(point)
        return load


def _elements(x, y, law, strain, about):
    """(elements, n, n): their stiffness, of nodes (elements, 9)."""
    total, nodes = 0.0, np.stack([x, y], -1)
    for (one, first), (other, second) in product(zip(POINTS, WEIGHTS, strict=True), repeat=2):
        shape = np.outer(_line(one), _line(other)).ravel()
        slopes = np.stack([np.outer(_slope(one), _line(other)).ravel(), np.outer(_line(one), _slope(other)).ravel()])
        jacobian, r = slopes @ nodes, y @ shape
        along, over = np.moveaxis(np.linalg.inv(jacobian) @ slopes, 1, 0)
        matrix, size = strain(shape, along, over, r), first * second * np.linalg.det(jacobian) * about(r)
        total = total + size[:, None, None] * (matrix.swapaxes(1, 2) @ (law @ matrix))
    return total


def _line(s):
    return np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2])


def _slope(s):
    return np.array([s - 0.5, -2 * s, s + 0.5])
