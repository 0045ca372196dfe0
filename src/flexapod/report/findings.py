"""What a report says of a machine at a pose: results of the library, gathered, and what to beware of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from flexapod.conventions import TWO_PI, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.mechanics.at_rest import Stability, pose_state
from flexapod.mechanics.cautions import Caution, Tangent, platform_radius
from flexapod.mechanics.inputs import as_hexapod, single_pose
from flexapod.mechanics.joint_limits import JointAngles, joint_angles, leg_distance
from flexapod.mechanics.kinematics import condition_number, inverse_kinematics
from flexapod.mechanics.leg_bending import LegBending, leg_bending
from flexapod.mechanics.linearisation import DampedModes
from flexapod.mechanics.mode_shapes import EnergyShares, ModeDescription, energy_shares
from flexapod.mechanics.modes import advised_sampling_time, mode_clusters
from flexapod.mechanics.statics import Equilibrium
from flexapod.pose import Pose, PoseLike
from flexapod.report.influence import Influence, influences


class Conditioning(NamedTuple):
    """Condition number of H in metres, and with its moment rows divided by `length` (m)."""

    metres: float
    scaled: float
    length: float


@dataclass(frozen=True, eq=False)
class Findings:
    """Everything a report shows, in SI units. `rest`, `tangent` and `influences` are None at a singular pose."""

    hexapod: Hexapod
    pose: Pose
    joint: JointModel
    stability: Stability
    omega: Array
    shape: Array
    descriptions: list[ModeDescription]
    shares: EnergyShares
    conditioning: Conditioning
    leg_length: Array
    angles: JointAngles
    leg_distance: float
    rest: Equilibrium | None
    tangent: Tangent | None
    bending: LegBending
    clusters: list[list[int]]
    influences: list[Influence] | None
    cautions: list[Caution]
    changes: tuple[str, ...] = ()  # made to the design of this name, as KEY=VALUE

    @property
    def damped(self) -> DampedModes | None:
        """The modes of the exact tangent by modulus."""
        return None if self.tangent is None else self.tangent.modes

    @property
    def sampling_time(self) -> float:
        """Largest sensible sampling time, s."""
        return advised_sampling_time(self.omega[-1])

    @property
    def tangent_differs(self) -> bool:
        """Whether weight and preload change a frequency so much that Eq. 5 is not to be relied on."""
        return any(caution.code in ("preload", "unstable") for caution in self.cautions)

    @property
    def unstable(self) -> bool:
        """Whether the machine falls away from this pose."""
        return self.stability == "falls over"

    def to_dict(self) -> dict[str, Any]:
        """The findings under names that carry their units; arrays stay arrays, what is not available is None."""
        from flexapod import __version__

        return {
            "flexapod": __version__,
            **origin(self.hexapod),
            "changes": self.changes,
            "pose_m_deg": [*self.pose.position, *np.degrees(self.pose.rpy)],
            "joint": self.joint,
            "stability": self.stability,
            "stability_index_rad_s": self.omega[0],
            "omega_rad_s": self.omega,
            "frequency_hz": self.omega / TWO_PI,
            "mode_shapes": self.shape,
            "descriptions": [mode.text for mode in self.descriptions],
            "strain_energy_share_legs_modes": self.shares.strain,
            "strain_energy_share_joints_modes": self.shares.joints,
            "strain_energy_share_suspension_modes": self.shares.suspension,
            "kinetic_energy_share_platform_legs_modes": self.shares.kinetic,
            "leg_bending_rad_s": self.bending.omega,
            "condition_number": self.conditioning.metres,
            "condition_number_scaled": self.conditioning.scaled,
            "characteristic_length_m": self.conditioning.length,
            "sampling_time_s": self.sampling_time,
            "leg_lengths_m": self.leg_length,
            "leg_distance_m": self.leg_distance,
            "universal_angle_deg": np.degrees(self.angles.universal),
            "spherical_angle_deg": np.degrees(self.angles.spherical),
            "static_leg_force_n": self.rest.leg_force if self.rest else None,
            "unstretched_length_m": self.rest.unstretched_length if self.rest else None,
            "tangent": _tangent_dict(self.tangent) if self.tangent else None,
            "influences": [one._asdict() for one in self.influences] if self.influences else None,
            "warnings": [caution.text for caution in self.cautions],
        }

    def _repr_html_(self) -> str:
        """The report in a frame of its own, for a notebook."""
        from flexapod.report.studies.machine import study

        return study(self)._repr_html_()


def gather(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    joint: JointModel = "universal",
    characteristic_length: float | None = None,
    changes: tuple[str, ...] = (),
) -> Findings:
    """Gather everything that a report says of a machine at one pose.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        One pose: a Pose, or x, y, z (m), roll, pitch, yaw (rad). Default: the home pose.
    joint : {"universal", "spin_free"}, optional
        Model of the base joints.
    characteristic_length : float, optional
        Length in m by which the moments of the unitless condition number are divided. Default: the mean radius of the
        platform's joints.
    changes : tuple of str, optional
        What was changed in the design, in words, to be said beside its name.

    Returns
    -------
    Findings
        The results. In a notebook they show themselves as a page.

    Raises
    ------
    PoseError
        If a leg cannot take the pose.

    Notes
    -----
    At a singular pose the index is zero, and what needs leg forces is None. The results are those of the library's
    functions at the pose; `mechanics.cautions` holds the thresholds of the cautions.

    Examples
    --------
    >>> found = fx.report.gather(fx.load("motion-base"))
    >>> round(float(found.omega[0]), 2), [one.code for one in found.cautions]
    (28.05, ['near_repeated'])
    """
    pose = single_pose(as_hexapod(hexapod), pose)
    state = pose_state(hexapod, pose, joint=joint)
    omega = state.modes.omega
    shares = energy_shares(hexapod, pose, joint=joint)
    length = platform_radius(hexapod) if characteristic_length is None else characteristic_length
    conditioning = Conditioning(
        state.condition_shown(condition_number(hexapod, pose)),
        state.condition_shown(condition_number(hexapod, pose, characteristic_length=length)),
        length,
    )
    if state.singular:
        strain, joints, suspension = (
            np.where(omega > 0, part, np.nan) for part in (shares.strain, shares.joints, shares.suspension)
        )
        shares = EnergyShares(strain, shares.kinetic, joints, suspension)
    clusters = mode_clusters(omega)
    return Findings(
        hexapod=hexapod,
        pose=pose,
        joint=joint,
        stability=state.stability,
        omega=omega,
        shape=state.modes.shape,
        descriptions=state.descriptions,
        shares=shares,
        conditioning=conditioning,
        leg_length=inverse_kinematics(hexapod, pose),
        angles=joint_angles(hexapod, pose),
        leg_distance=float(leg_distance(hexapod, pose)),
        rest=None if state.linear is None else state.linear.rest,
        tangent=state.tangent,
        bending=leg_bending(hexapod, pose),
        clusters=clusters,
        influences=None if state.singular else influences(hexapod, pose, joint, clusters[0]),
        cautions=state.cautions,
        changes=changes,
    )


def _tangent_dict(tangent: Tangent) -> dict[str, Any]:
    """The damped modes by modulus, and for each undamped mode the number of the one that moves as it does."""
    damped, pairs = tangent.modes, tangent.pairs
    return {
        "omega_rad_s": damped.omega,
        "damped_frequency_rad_s": np.abs(damped.pole.imag),
        "damping_ratio": damped.damping_ratio,
        "pole_real_rad_s": damped.pole.real,
        "pole_imag_rad_s": damped.pole.imag,
        "descriptions": [mode.text for mode in tangent.words],
        "of_undamped_mode": [int(j) + 1 if j >= 0 else None for j in pairs.damped],
        "overlap": pairs.overlap,
    }
