"""The springs of a machine in words and columns: of its legs, joints and suspension, with their losses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import LEGS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.joint_springs import joint_moments
from flexapod.mechanics.springs import axial_stiffness
from flexapod.mechanics.viscous_losses import has_losses
from flexapod.pose import Pose
from flexapod.report.numbers import brief
from flexapod.report.study import Column, Table

LAWS = {"screw": "a screw's", "hydraulic": "two columns of oil", "table": "a table's"}


def assumptions(hexapod: Hexapod) -> str:
    """What the model of this machine takes its legs, joints and plates to be, in a sentence."""
    legs = hexapod.legs
    axial = "Legs are axial springs"
    if legs.series_stiffness.size:
        axial += " with others in series"
    if legs.stiffness_law is not None:
        axial += f", whose stiffness follows their length ({LAWS[legs.stiffness_law.kind.name]})"
    if legs.joint_stiffness.any:
        joints = "their joints resist turning as springs that are without moment in the rest pose"
    else:
        joints = "their joints turn without resistance but friction"
    held = ", a suspension stands beside them" if hexapod.suspension is not None else ""
    return f"{axial}, {joints}{held}, the plates are rigid, the base is fixed."


def facts(hexapod: Hexapod, length: Array) -> dict[str, str]:
    """The stiffness of the legs at these lengths, and of what stands beside it."""
    legs = hexapod.legs
    plain = legs.stiffness_law is None and not legs.series_stiffness.size
    name = "Leg stiffness" if plain else "Leg stiffness here, with springs in series"
    found = {name: spread(axial_stiffness(hexapod, length)[0], 1e-6, "N/\u00b5m")}
    if legs.joint_stiffness.any:
        joints = legs.joint_stiffness
        for title, values in (
            ("Base joints", joints.universal),
            ("Platform joints, bending", joints.spherical),
            ("Legs, torsion", joints.torsion),
        ):
            found[title] = spread(values, 1.0, "N m/rad")
    if hexapod.suspension is not None:
        stiff = np.diag(hexapod.suspension.stiffness)[:3]
        found["Suspension, x y z"] = ", ".join(brief(1e-6 * float(k)) for k in stiff) + " N/\u00b5m"
    if has_losses(hexapod):
        found["Loss factors, legs and joints"] = (
            f"{spread(legs.loss_factor)}, {spread(legs.joint_stiffness.loss_factor)}"
        )
    return found


def spread(values: Array, scale: float = 1.0, unit: str = "") -> str:
    """One number, or the least and the greatest of several."""
    low, high = brief(scale * float(values.min())), brief(scale * float(values.max()))
    return f"{low if low == high else f'{low} to {high}'} {unit}".rstrip()


def moments(hexapod: Hexapod, pose: Pose, joint: JointModel, beyond: dict[str, NDArray[np.bool_]]) -> list[Table]:
    """The moments of the joints' springs, leg by leg; beyond: which are above a limit, by quantity."""
    if not hexapod.legs.joint_stiffness.any:
        return []
    found, joints = joint_moments(hexapod, pose, joint=joint), hexapod.legs.joint_stiffness
    universal = np.hypot(*np.moveaxis(found.universal_moment, -1, 0))
    told = [_without_rounding(universal, joints.universal.max(axis=1))]
    told += [_without_rounding(found.bending_moment, joints.spherical)]
    told += [_without_rounding(found.torsion_moment, joints.torsion)]
    columns = [
        Column("leg", LEGS),
        Column("universal moment", told[0], "N m", marked=beyond.get("universal joint moment N m")),
        Column("spherical moment", told[1], "N m", marked=beyond.get("spherical joint moment N m")),
        Column("torsion", told[2], "N m"),
    ]
    note = "Of the springs in the joints: across the leg at the base, across it at the platform, and about it."
    return [Table(columns, note, "Moments of the joints")]


def _without_rounding(moment: Array, stiffness: Array) -> Array:
    """Moments of joints, 0 where the joint is turned by no more than the rounding of its angle."""
    return np.where(np.abs(moment) > 1e-12 * stiffness, moment, 0.0)
