"""What a report says of a machine at a pose: results of the library, gathered, and what to beware of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from flexapod.conventions import TWO_PI, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics.cautions import SINGULAR, Caution, mode_clusters, platform_radius, pose_cautions
from flexapod.mechanics.joint_limits import JointAngles, joint_angles, leg_distance
from flexapod.mechanics.kinematics import condition_number, inverse_kinematics
from flexapod.mechanics.linearisation import DampedModes, linearise
from flexapod.mechanics.mode_shapes import EnergyShares, ModeDescription, describe_modes, energy_shares
from flexapod.mechanics.modes import advised_sampling_time, natural_modes
from flexapod.mechanics.statics import Equilibrium, hold
from flexapod.pose import Pose
from flexapod.report.influence import Influence, influences

_NOTHING = 1e-12  # of the highest frequency: what is below is rounding at a singular pose


class Conditioning(NamedTuple):
    """Condition number of H in metres, and with its moment rows divided by `length` (m)."""

    metres: float
    scaled: float
    length: float


@dataclass(frozen=True, eq=False)
class Findings:
    """Everything a report shows, in SI units. `rest`, `damped` and `influences` are None at a singular pose."""

    hexapod: Hexapod
    pose: Pose
    joint: JointModel
    omega: Array
    shape: Array
    descriptions: list[ModeDescription]
    shares: EnergyShares
    conditioning: Conditioning
    leg_length: Array
    angles: JointAngles
    leg_distance: float
    rest: Equilibrium | None
    damped: DampedModes | None
    clusters: list[list[int]]
    influences: list[Influence] | None
    cautions: list[Caution]
    changes: tuple[str, ...] = ()  # made to the design of this name, as KEY=VALUE

    @property
    def sampling_time(self) -> float:
        """Largest sensible sampling time, s."""
        return advised_sampling_time(self.omega[-1])


def gather(
    hexapod: Hexapod,
    pose: Pose,
    joint: JointModel = "universal",
    characteristic_length: float | None = None,
    changes: tuple[str, ...] = (),
) -> Findings:
    """Everything a report says of a machine at one pose.

    characteristic_length: m, for the condition number without units; default: the platform's joint radius.
    changes: what was changed in the design, in words, to be said beside its name.
    Raises PoseError at a pose that no leg can take. At a singular pose the index is zero and what needs leg forces is
    None.
    """
    omega, shape = natural_modes(hexapod, pose, joint=joint)
    shares = energy_shares(hexapod, pose, joint=joint)
    length = platform_radius(hexapod) if characteristic_length is None else characteristic_length
    conditioning = Conditioning(
        float(condition_number(hexapod, pose)),
        float(condition_number(hexapod, pose, characteristic_length=length)),
        length,
    )
    singular = not conditioning.scaled < SINGULAR
    if singular:  # what is left of the lowest mode is rounding: say so with plain zeros and infinities
        conditioning = Conditioning(np.inf, np.inf, length)
        omega = np.where((np.arange(6) == 0) | (omega < _NOTHING * omega[-1]), 0.0, omega)
        shares = EnergyShares(np.where(omega > 0, shares.strain, np.nan), shares.kinetic)
    rest, damped = (None, None) if singular else _at_rest(hexapod, pose, joint)
    clusters = mode_clusters(omega)
    return Findings(
        hexapod=hexapod,
        pose=pose,
        joint=joint,
        omega=omega,
        shape=shape,
        descriptions=describe_modes(hexapod, pose, joint=joint),
        shares=shares,
        conditioning=conditioning,
        leg_length=inverse_kinematics(hexapod, pose),
        angles=joint_angles(hexapod, pose),
        leg_distance=float(leg_distance(hexapod, pose)),
        rest=rest,
        damped=damped,
        clusters=clusters,
        influences=None if singular else influences(hexapod, pose, joint, clusters[0]),
        cautions=pose_cautions(hexapod, pose, omega, conditioning.scaled, damped),
        changes=changes,
    )


def _at_rest(hexapod: Hexapod, pose: Pose, joint: JointModel) -> tuple[Equilibrium | None, DampedModes | None]:
    try:
        return hold(hexapod, pose), linearise(hexapod, pose, joint=joint).modes()
    except SingularPoseError:
        return None, None


def as_dict(f: Findings) -> dict[str, Any]:
    """The findings under names that carry their units; arrays stay arrays, what is not available is None."""
    from flexapod import __version__

    return {
        "flexapod": __version__,
        "design": f.hexapod.name,
        "digest": f.hexapod.digest,
        "changes": f.changes,
        "pose_m_deg": [*f.pose.position, *np.degrees(f.pose.rpy)],
        "joint": f.joint,
        "stability_index_rad_s": f.omega[0],
        "omega_rad_s": f.omega,
        "frequency_hz": f.omega / TWO_PI,
        "mode_shapes": f.shape,
        "descriptions": [mode.text for mode in f.descriptions],
        "strain_energy_share_legs_modes": f.shares.strain,
        "kinetic_energy_share_platform_legs_modes": f.shares.kinetic,
        "condition_number": f.conditioning.metres,
        "condition_number_scaled": f.conditioning.scaled,
        "characteristic_length_m": f.conditioning.length,
        "sampling_time_s": f.sampling_time,
        "leg_lengths_m": f.leg_length,
        "leg_distance_m": f.leg_distance,
        "universal_angle_deg": np.degrees(f.angles.universal),
        "spherical_angle_deg": np.degrees(f.angles.spherical),
        "static_leg_force_n": f.rest.leg_force if f.rest else None,
        "unstretched_length_m": f.rest.unstretched_length if f.rest else None,
        "tangent": _damped_dict(f.damped) if f.damped else None,
        "influences": [one._asdict() for one in f.influences] if f.influences else None,
        "warnings": [caution.text for caution in f.cautions],
    }


def _damped_dict(damped: DampedModes) -> dict[str, Any]:
    return {
        "omega_rad_s": damped.omega,
        "damped_frequency_rad_s": np.abs(damped.pole.imag),
        "damping_ratio": damped.damping_ratio,
        "pole_real_rad_s": damped.pole.real,
        "pole_imag_rad_s": damped.pole.imag,
    }
