"""A second, slow proof of a lower bound of omega_1 over a box, in ball arithmetic (FLINT), written apart from the core.

Inertia by partial velocities as in `exact_modes`. K - t J is enclosed over a box by evaluating it with balls that hold the box's
coordinates, and by its mean value form: the value at the centre plus derivatives over the box times the box. Both are
brought into the frame of the centre's modes, where Gershgorin's circles must lie right of zero.
"""

import numpy as np
from flint import arb, arb_mat, ctx

ctx.prec = 80


def proved(hexapod, box, level: float, most: int = 2000) -> int | None:
    """Boxes that it took to prove omega_1 >= level over a box (6, 2); None where `most` were not enough."""
    t, open_boxes, looked = arb(float(level)) ** 2, [np.asarray(box, float)], 0
    while open_boxes:
        here = open_boxes.pop()
        looked += 1
        if looked > most:
            return None
        if not _positive(hexapod, here, t):
            share = (here[:, 1] - here[:, 0]) / (box[:, 1] - box[:, 0])
            axis = int(np.argmax(share))
            middle = here[axis].mean()
            for side, other in ((0, 1), (1, 0)):
                half = here.copy()
                half[axis, other] = middle
                open_boxes.append(half)
                assert half[axis, side] == here[axis, side]
    return looked


def _positive(hexapod, box, t) -> bool:
    balls = [_ball(low, high) for low, high in box]
    middle = [arb(float(x)) for x in box.mean(axis=1)]
    centre, slopes = _matrix(hexapod, middle, t)[0], _matrix(hexapod, balls, t)[1]
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


def _matrix(hexapod, coordinates, t):
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
        _times(R, _vector(hexapod.platform_mass_center)),
        R,
        hexapod.platform_mass,
        hexapod.platform_inertia,
    )
    for i in range(6):
        q = _times(R, _vector(hexapod.platform_joints[i]))
        S = [a + b - c for a, b, c in zip(x[:3], q, _vector(hexapod.base_joints[i]), strict=True)]
        u = _dot(S, S).rsqrt()
        s = [u * a for a in S]
        h = [*s, *_cross(q, s)]
        k = _jet(hexapod.legs.stiffness[i])
        for a in range(6):
            for b in range(6):
                A[a][b] = A[a][b] + k * h[a] * h[b]
        _add_leg(A, -t, hexapod, i, q, s, u)
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
    for part, at_platform in ((hexapod.legs.lower, False), (hexapod.legs.upper, True)):
        r = _times(axes, _vector(part.mass_center[i]))
        speed = [
            [a + b for a, b in zip(v if at_platform else [_jet(0.0)] * 3, _cross(w, r), strict=True)]
            for v, w in zip(velocity, omega, strict=True)
        ]
        _add_energy(A, factor, speed, omega, axes, part.mass[i], part.inertia[i])


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


def _vector(v):
    return [_jet(float(x)) for x in v]
