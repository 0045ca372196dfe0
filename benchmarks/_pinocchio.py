"""Pinocchio on the same machine: natural frequencies pose by pose, on the model of tests/oracles/closed_chain.py."""

import numpy as np
import pinocchio as pin
from tests.oracles.closed_chain import _add_legs, _add_platform, bench_constraint_dynamics

import flexapod as fx

__all__ = ["PinocchioModes", "bench_constraint_dynamics"]


class PinocchioModes:
    """One model for all poses: fixed base, free platform, six universal and prismatic legs cut at the platform."""

    def __init__(self, hexapod) -> None:
        self.hexapod, self.model = hexapod, pin.Model()
        origin, home = fx.Pose([0, 0, 0]), fx.home_pose(hexapod)
        _add_platform(self.model, hexapod, origin)
        self.legs = _add_legs(self.model, hexapod, home, origin, parent=0)
        self.data = self.model.createData()
        self.home = self._leg_coordinates(home)

    def _leg_coordinates(self, pose):
        """Turn about k from a fixed direction, tilt, length; one row a leg."""
        h = self.hexapod
        S = pose.matrix @ h.platform_joints[..., None]
        S = S[..., 0] + pose.position - h.base_joints
        k = h.universal_axes
        y = np.cross(k, S)
        along = np.einsum("ij,ij->i", k, S)
        fixed = np.cross(k, np.roll(k, 1, axis=1) + np.array([0.3, -0.2, 0.1]))
        turn = np.arctan2(np.einsum("ij,ij->i", k, np.cross(fixed, y)), np.einsum("ij,ij->i", fixed, y))
        return np.stack([turn, -np.arctan2(along, np.linalg.norm(y, axis=1)), np.linalg.norm(S, axis=1)], axis=1)

    def __call__(self, six):
        model, data = self.model, self.data
        pose = fx.Pose.from_rpy(*six)
        q = pin.neutral(model)
        q[:7] = pin.SE3ToXYZQUAT(pin.SE3(np.array(pose.matrix), np.array(pose.position)))
        q[7:] = (self._leg_coordinates(pose) - self.home).ravel()
        mass = np.triu(pin.crba(model, data, q))
        mass += np.triu(mass, 1).T
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        frame = [
            [pin.getFrameJacobian(model, data, f, pin.LOCAL_WORLD_ALIGNED)[:3] for f in (leg.end, leg.socket)]
            for leg in self.legs
        ]
        closure = np.vstack([end - socket for end, socket in frame])
        allowed = np.zeros((24, 6))
        allowed[:6] = np.kron(np.eye(2), pose.matrix.T)
        allowed[6:] = np.linalg.solve(closure[:, 6:], -closure[:, :6] @ allowed[:6])
        H = allowed[8::3].T  # rates of the prismatic joints
        B = np.linalg.solve(np.linalg.cholesky(allowed.T @ mass @ allowed), H * np.sqrt(self.hexapod.legs.stiffness))
        sigma_H = np.linalg.svd(H, compute_uv=False)
        return np.linalg.svd(B, compute_uv=False)[::-1], sigma_H[0] / sigma_H[-1]
