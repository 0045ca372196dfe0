"""J_p, H and what follows from them by array operations: for NumPy with LAPACK, and for JAX under jit(vmap).

`xp` is either `numpy` or `jax.numpy`. The equations are those that a user of these would write from the paper and its
corrections, with the leg's partial velocities in leg axes.
"""

import numpy as np

import flexapod as fx


def array_modes(xp, hexapod: fx.Hexapod, poses):
    """Natural frequencies, ascending, and cond(H) of poses (..., 6), by LAPACK."""
    J, H = array_matrices(xp, hexapod, poses)
    B = xp.linalg.solve(xp.linalg.cholesky(J), H * np.sqrt(hexapod.legs.stiffness))
    sigma_H = xp.linalg.svd(H, compute_uv=False)
    return xp.linalg.svd(B, compute_uv=False)[..., ::-1], sigma_H[..., 0] / sigma_H[..., -1]


def array_matrices(xp, hexapod: fx.Hexapod, poses):
    """J_p and H, each (..., 6, 6), by matrices over the leading axes of `poses`."""
    R = rotations(xp, poses[..., 3:])
    q = xp.einsum("...ij,kj->...ki", R, xp.asarray(hexapod.platform_joints))
    S = poses[..., None, :3] + q - xp.asarray(hexapod.base_joints)
    L = xp.linalg.norm(S, axis=-1, keepdims=True)
    s = S / L
    y = xp.cross(xp.broadcast_to(xp.asarray(hexapod.universal_axes), s.shape), s)
    y = y / xp.linalg.norm(y, axis=-1, keepdims=True)
    axes = xp.stack([s, y, xp.cross(s, y)], axis=-1)  # leg axes as columns
    H = xp.swapaxes(xp.concatenate([s, xp.cross(q, s)], axis=-1), -1, -2)
    return platform_matrix(xp, hexapod, R) + leg_matrices(xp, hexapod, axes, L[..., None], q), H


def leg_matrices(xp, hexapod, axes, L, q):
    """The sum of the legs' inertias at the platform, from partial velocities in leg axes (universal joints)."""
    k = xp.einsum("...lij,li->...lj", axes, xp.asarray(hexapod.universal_axes))  # k in leg axes: (k.s, 0, k.z)
    tau = (k[..., 0] / k[..., 2])[..., None, None]
    W = (tau * np.array([[0.0, 1, 0], [0, 0, 0], [0, 0, 0]]) + np.array([[0.0, 0, 0], [0, 0, -1], [0, 1, 0]])) / L
    Q = 0.0
    for part, moves in ((hexapod.legs.lower, 0.0), (hexapod.legs.upper, 1.0)):
        G = moves * np.eye(3) - tilde(np, np.asarray(part.mass_center)) @ W
        m = np.asarray(part.mass)[:, None, None]
        Q = Q + m * (xp.swapaxes(G, -1, -2) @ G) + xp.swapaxes(W, -1, -2) @ (np.asarray(part.inertia) @ W)
    Q = axes @ Q @ xp.swapaxes(axes, -1, -2)
    qt = tilde(xp, q)
    side = xp.concatenate([xp.broadcast_to(xp.eye(3), qt.shape), qt], axis=-2)
    return (side @ Q @ xp.swapaxes(side, -1, -2)).sum(axis=-3)


def platform_matrix(xp, hexapod, R):
    M, r = hexapod.platform_mass, tilde(xp, R @ np.asarray(hexapod.platform_mass_center))
    I = R @ np.asarray(hexapod.platform_inertia) @ xp.swapaxes(R, -1, -2) - M * r @ r
    top = xp.concatenate([xp.broadcast_to(M * xp.eye(3), r.shape), -M * r], axis=-1)
    return xp.concatenate([top, xp.concatenate([M * r, I], axis=-1)], axis=-2)


def tilde(xp, a):
    zero = xp.zeros_like(a[..., 0])
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    rows = ([zero, -z, y], [z, zero, -x], [-y, x, zero])
    return xp.stack([xp.stack(row, axis=-1) for row in rows], axis=-2)


def rotations(xp, rpy):
    (cr, cp, cy), (sr, sp, sy) = ([f(rpy[..., i]) for i in range(3)] for f in (xp.cos, xp.sin))
    rows = (
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    )
    return xp.stack([xp.stack(row, axis=-1) for row in rows], axis=-2)
