"""A second, slow proof of a lower bound of omega_1 over a box, in ball arithmetic (FLINT), written apart from the core.

Inertia by partial velocities as in `exact_modes`; springs in joints by the rates about the joints' axes, a suspension by the twist of
its point, tables of stiffness by SciPy's. K - t J is enclosed over a box by evaluating it with balls that hold the box's
coordinates, and by its mean value form: the value at the centre plus derivatives over the box times the box. Both are
brought into the frame of the centre's modes, where Gershgorin's circles must lie right of zero.
"""

import numpy as np
from flint import arb, arb_mat, ctx
from scipy.interpolate import PchipInterpolator

from flexapod.design.stiffness_laws import HydraulicLaw, ScrewLaw

ctx.prec = 80


def proved(hexapod, box, level: float, most: int = 2000, reach: float = 0.0, load=None) -> int | None:
    """Boxes that it took to prove omega_1 >= level over a box (6, 2); None where `most` were not enough.

    reach: how far each coordinate of the joints and of the platform's mass centre may be from the design's, m. load: mass
    (kg) of a point on the platform and the ends of its place (3, 2), m.
    """
    t, open_boxes, looked = arb(float(level)) ** 2, [np.asarray(box, float)], 0
    while open_boxes:
        here = open_boxes.pop()
        looked += 1
        if looked > most:
            return None
        if not _positive(hexapod, here, t, reach, load):
            share = (here[:, 1] - here[:, 0]) / (box[:, 1] - box[:, 0])
            axis = int(np.argmax(share))
            middle = here[axis].mean()
            for side, other in ((0, 1), (1, 0)):
                half = here.copy()
                half[axis, other] = middle
                open_boxes.append(half)
                assert half[axis, side] == here[axis, side]
    return looked


def _positive(hexapod, box, t, reach, load) -> bool:
    balls = [_ball(low, high) for low, high in box]
    middle = [arb(float(x)) for x in box.mean(axis=1)]
    centre = _matrix(hexapod, middle, t, reach, load)[0]
    slopes = _matrix(hexapod, balls, t, reach, load)[1]
    A = centre
    for ball, point, slope in zip(balls, middle, slopes, strict=True):
        A = A + slope * (ball - point)
    C = _frame(centre)
    M = C * A * C.transpose()
    return all(M[i, i] - sum((abs(M[i, j]) for j in range(6) if j != i), arb(0)) > 0 for i in range(6))


def _ball(low: float, high: float) -> arb:
    return arb(low).union(arb(high))


def _frame(centre) -> arb_mat:
    """A matrix that makes the centre's one nearly the unit matrix; any one proves."""
    numbers = np.array([[float(centre[i, j].mid()) for j in range(6)] for i in range(6)])
    values, vectors = np.linalg.eigh(numbers)
    rows = vectors.T / np.sqrt(np.maximum(values, 1e-300))[:, None]
    return arb_mat(6, 6, [float(x) for x in rows.ravel()])


class _Jet:
    """A value and its six derivatives."""

    def __init__(self, value, slopes=None):
        self.value = value if isinstance(value, arb) else arb(value)
        self.slopes = slopes or [arb(0)] * 6

    def _chain(self, value, slope):
        return _Jet(value, [slope * d for d in self.slopes])

    def __add__(self, other):
        other = _jet(other)
        return _Jet(self.value + other.value, [a + b for a, b in zip(self.slopes, other.slopes, strict=True)])

    def __mul__(self, other):
        other = _jet(other)
        pairs = zip(self.slopes, other.slopes, strict=True)
        return _Jet(self.value * other.value, [a * other.value + self.value * b for a, b in pairs])

    __radd__, __rmul__ = __add__, __mul__

    def __neg__(self):
        return self._chain(-self.value, arb(-1))

    def __sub__(self, other):
        return self + -_jet(other)

    def sin(self):
        return self._chain(self.value.sin(), self.value.cos())

    def cos(self):
        return self._chain(self.value.cos(), -self.value.sin())

    def reciprocal(self):
        inverse = 1 / self.value
        return self._chain(inverse, -inverse * inverse)

    def rsqrt(self):
        root = 1 / self.value.sqrt()
        return self._chain(root, -root * root * root / 2)


def _jet(x) -> _Jet:
    return x if isinstance(x, _Jet) else _Jet(x if isinstance(x, arb) else float(x))


def _dot(a, b):
    return sum((x * y for x, y in zip(a, b, strict=True)), _Jet(0.0))


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _times(rows, v):
    return [_dot(row, v) for row in rows]


def _matrix(hexapod, coordinates, t, reach, load):
    """K - t J in base axes, and its derivatives by the coordinates."""
    x = []
    for i, value in enumerate(coordinates):
        slopes = [arb(0)] * 6
        slopes[i] = arb(1)
        x.append(_Jet(value, slopes))
    R = _rotation(*x[3:])
    # Twists as columns: what a unit velocity of the platform, then a unit angular velocity, does.
    A = [[_Jet(0.0) for _ in range(6)] for _ in range(6)]
    _add_body(
        A,
        -t,
        [_jet(0.0)] * 3,
        _times(R, _vector(hexapod.platform_mass_center, reach)),
        R,
        hexapod.platform_mass,
        hexapod.platform_inertia,
    )
    if load is not None:
        mass, ends = load
        at = [_Jet(_ball(low, high)) for low, high in ends]
        _add_body(A, -t, [_jet(0.0)] * 3, _times(R, at), R, mass, np.zeros((3, 3)))
    for i in range(6):
        q = _times(R, _vector(hexapod.platform_joints[i], reach))
        S = [a + b - c for a, b, c in zip(x[:3], q, _vector(hexapod.base_joints[i], reach), strict=True)]
        u = _dot(S, S).rsqrt()
        s = [u * a for a in S]
        h = [*s, *_cross(q, s)]
        k = _axial_stiffness(hexapod, i, _dot(S, S) * u)
        for a in range(6):
            for b in range(6):
                A[a][b] = A[a][b] + k * h[a] * h[b]
        _add_leg(A, -t, hexapod, i, q, s, u)
    if hexapod.suspension is not None:
        _add_suspension(A, hexapod.suspension, R)
    value = arb_mat(6, 6, [A[a][b].value for a in range(6) for b in range(6)])
    slopes = [arb_mat(6, 6, [A[a][b].slopes[d] for a in range(6) for b in range(6)]) for d in range(6)]
    return value, slopes


def _add_leg(A, factor, hexapod, i, q, s, u):
    """The two bodies of a leg with the exact universal joint: each velocity is linear in the twist."""
    k = _vector(hexapod.universal_axes[i])
    y = _cross(k, s)
    c = _dot(y, y).rsqrt()
    y = [c * a for a in y]
    axes = list(zip(s, y, _cross(s, y), strict=True))  # rows: leg axes as columns
    n = _cross(y, k)
    inverse = _dot(n, s).rsqrt()
    inverse = inverse * inverse  # n.s is the sine of the angle between leg and axis
    velocity, omega = [], []
    for column in range(6):
        unit = [_jet(float(column % 3 == r)) for r in range(3)]
        v = unit if column < 3 else _cross(unit, q)
        across = [u * a for a in _cross(s, v)]
        spin = _dot(n, across) * inverse
        omega.append([a - spin * b for a, b in zip(across, s, strict=True)])
        velocity.append(v)
    _add_joints(A, hexapod.legs.joint_stiffness, i, omega, k, y, s)
    for part, at_platform in ((hexapod.legs.lower, False), (hexapod.legs.upper, True)):
        r = _times(axes, _vector(part.mass_center[i]))
        speed = [
            [a + b for a, b in zip(v if at_platform else [_jet(0.0)] * 3, _cross(w, r), strict=True)]
            for v, w in zip(velocity, omega, strict=True)
        ]
        _add_energy(A, factor, speed, omega, axes, part.mass[i], part.inertia[i])


def _add_joints(A, springs, i, omega, k, y, s):
    """The universal joint turns about its axis in the base and about y; above, the leg bends and twists."""
    first, second = ([_dot(w, axis) for w in omega] for axis in (k, y))
    turn = [[_jet(float(column - 3 == r)) - w[r] for r in range(3)] for column, w in enumerate(omega)]
    twist = [_dot(w, s) for w in turn]
    k_1, k_2, bend, torsion = map(_jet, (*springs.universal[i], springs.spherical[i], springs.torsion[i]))
    for a in range(6):
        for b in range(6):
            along = twist[a] * twist[b]
            A[a][b] += k_1 * first[a] * first[b] + k_2 * second[a] * second[b] + torsion * along
            A[a][b] += bend * (_dot(turn[a], turn[b]) - along)


def _add_suspension(A, suspension, R):
    p, twists = _times(R, _vector(suspension.point)), []
    for column in range(6):
        unit = [_jet(float(column % 3 == r)) for r in range(3)]
        none = [_jet(0.0)] * 3
        twists.append([*unit, *none] if column < 3 else [*_cross(unit, p), *unit])
    for a in range(6):
        force = [_dot(_vector(row), twists[a]) for row in suspension.stiffness]
        for b in range(6):
            A[a][b] += _dot(force, twists[b])


def _axial_stiffness(hexapod, i, L):
    law, compliance = hexapod.legs.stiffness_law, _jet(hexapod.legs.series_compliance[i])
    if law is None:
        return (_jet(1 / arb(float(hexapod.legs.stiffness[i]))) + compliance).reciprocal()
    if isinstance(law, ScrewLaw):
        own = _jet(1 / arb(float(law.fixed[i]))) + (L - law.zero_length[i]) * (1 / arb(float(law.axial_rigidity[i])))
        return (own + compliance).reciprocal()
    if isinstance(law, HydraulicLaw):
        x = L - law.shortest[i]
        below = _jet(law.area_1[i]) * (x + law.dead_1[i]).reciprocal()
        above = _jet(law.area_2[i]) * (_jet(law.stroke[i]) - x + law.dead_2[i]).reciprocal()
        k = _jet(law.bulk_modulus[i]) * (below + above)
    else:
        k = _in_table(PchipInterpolator(law.lengths, law.stiffnesses), L)
    return (k.reciprocal() + compliance).reciprocal()


def _in_table(table, L) -> _Jet:
    """All values and slopes of the pieces that a ball of lengths meets."""
    found = None
    for j, (start, stop) in enumerate(zip(table.x[:-1], table.x[1:], strict=True)):
        part = L.value.intersection(_ball(start, stop)) if L.value.overlaps(_ball(start, stop)) else None
        if part is None:
            continue
        s, (c, b, a, value) = part - arb(float(start)), (arb(float(number)) for number in table.c[:, j])
        both = value + s * (a + s * (b + s * c)), a + s * (2 * b + 3 * c * s)
        found = both if found is None else tuple(one.union(other) for one, other in zip(found, both, strict=True))
    return L._chain(*found)


def _add_body(A, factor, at, centre, axes, mass, inertia):
    speed, omega = [], []
    for column in range(6):
        unit = [_jet(float(column % 3 == r)) for r in range(3)]
        omega.append(unit if column >= 3 else at)
        speed.append(unit if column < 3 else _cross(unit, centre))
    _add_energy(A, factor, speed, omega, axes, mass, inertia)


def _add_energy(A, factor, speed, omega, axes, mass, inertia):
    """factor (m v_a . v_b + w_a . I w_b)."""
    columns = list(zip(*axes, strict=True))
    own = [_times(columns, w) for w in omega]  # in the body's axes
    m = _jet(mass)
    moment = [[_dot(_vector(row), w) for row in np.asarray(inertia, float)] for w in own]
    for a in range(6):
        for b in range(6):
            A[a][b] = A[a][b] + _jet(factor) * (m * _dot(speed[a], speed[b]) + _dot(own[a], moment[b]))


def _rotation(roll, pitch, yaw):
    sr, cr, sp, cp, sy, cy = roll.sin(), roll.cos(), pitch.sin(), pitch.cos(), yaw.sin(), yaw.cos()
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]


def _vector(v, reach=0.0):
    return [_Jet(_ball(float(x) - reach, float(x) + reach)) for x in v]
