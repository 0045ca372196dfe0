"""Numbers of a design that can be computed with and are hardly meant: units, signs, legs joined in a wrong order."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from flexapod.conventions import LEG_PAIRS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.stiffness_laws import HydraulicLaw
from flexapod.design.universal_axes import legs_at
from flexapod.mechanics.inputs import states
from flexapod.mechanics.joint_limits import leg_distances
from flexapod.mechanics.kinematics import condition_number, home_pose, inverse_kinematics
from flexapod.mechanics.springs import axial_stiffness
from flexapod.mechanics.statics import Equilibrium
from flexapod.pose import Pose

FAR = 10.0  # times the machine's size: a mass centre or radius of gyration beyond is no part of it
NEAR = 0.01  # of the machine's size: a radius of gyration within is that of a point
LONG = 30.0  # times the joint circles: a leg beyond is a thread
SIZES = (5e-4, 50.0)  # radii of joint circles that have been built, m
GRAVITIES = (0.5, 30.0)  # m/s2: from that of a small moon to that of Jupiter
SAG = 0.25  # of a leg's length: by so much no leg is compressed at rest
TOUCH = 0.01  # of a leg's length: legs are thicker
SINGULAR_EVERYWHERE = 1e6  # condition number without units that no pose betters: joints typed with six digits
POSES = 64  # tried for that
STIFF_ACROSS = 1.0  # times the axial stiffness: joints that bend so little make a leg stiffer across than along it
FREE = 1e-9  # of the axial stiffness: joints that hold so little turn freely
SHARE_LEFT = 0.02  # of a leg's own stiffness: springs in series that leave less are the machine's stiffness
LOSSES = 0.5  # a loss factor above is rubber's


class Caution(NamedTuple):
    """A caution: a code for programs, words for readers, and the numbers in the words."""

    code: str
    text: str
    numbers: Mapping[str, float] = MappingProxyType({})


def mean_radius(joints: Array) -> float:
    """Mean distance of the joints of a plate from their centre, m."""
    return float(np.linalg.norm(joints - joints.mean(axis=0), axis=1).mean())


def implausible(hexapod: Hexapod) -> list[Caution]:
    """Numbers of a design that are hardly meant, whatever the pose."""
    return list(_implausible(hexapod))


@lru_cache(maxsize=64)  # a page asks for pose after pose of one design
def _implausible(hexapod: Hexapod) -> list[Caution]:
    return [*_sizes(hexapod), *_bodies(hexapod), *_gravity(hexapod), *_springs(hexapod), *_drive(hexapod)]


def _drive(hexapod: Hexapod) -> list[Caution]:
    """A motor with a screw in legs of oil."""
    law, drive = hexapod.legs.stiffness_law, hexapod.drive
    if drive is None or not isinstance(law, HydraulicLaw):
        return []
    text = (
        "legs.stiffness_law is that of hydraulic cylinders, and [drive] is a motor with a screw in each leg: a machine "
        "has one or the other. The motor's torque and speed are not those of the pump. Leave [drive] out, or give the "
        "stiffness of the screws."
    )
    return [Caution("drive", text)]


def _sizes(hexapod: Hexapod) -> list[Caution]:
    """Joint circles of a size that nobody builds, or that fit neither each other nor the home pose."""
    radii = {"base": mean_radius(hexapod.base_joints), "platform": mean_radius(hexapod.platform_joints)}
    large, small = sorted(radii, key=lambda plate: -radii[plate])
    keys = {plate: _key_of_joints(hexapod, plate) for plate in radii}
    circle = f"The {large}'s joints are {radii[large]:.4g} m from their centre"
    found = []
    if not SIZES[0] < radii[large] < SIZES[1]:
        text = (
            f"{circle} ({keys[large]}). A number in another unit than m says so in its key, as in {keys[large]}_mm: "
            "check the units of all lengths."
        )
        found.append(Caution("size", text, {"radius": radii[large]}))
    if radii[large] > LONG * radii[small]:
        text = f"{circle}, the {small}'s {radii[small]:.4g} m. Check the units of {keys[large]} and {keys[small]}."
        found.append(Caution("size", text, {"radius": radii[large], "other": radii[small]}))
    leg = _leg_length(hexapod)
    if leg is not None and hexapod.home is not None and leg > LONG * radii[large]:
        text = (
            f"At home the legs are {leg:.4g} m long, {leg / radii[large]:.3g} times the radius of the larger joint "
            f"circle. Check home.position, {hexapod.home.position.tolist()} m: in mm it is home.position_mm."
        )
        found.append(Caution("size", text, {"leg_length": leg, "radius": radii[large]}))
    return found


def _bodies(hexapod: Hexapod) -> list[Caution]:
    """Mass centres and radii of gyration outside the machine."""
    leg = _leg_length(hexapod) or 0.0
    size = max(mean_radius(hexapod.base_joints), mean_radius(hexapod.platform_joints), leg)
    center = hexapod.platform_mass_center - hexapod.platform_joints.mean(axis=0)
    found = _body("platform", hexapod.platform_mass, center, hexapod.platform_inertia, size, "the platform's joints")
    for side, joint in (("lower", "base"), ("upper", "platform")):
        part = getattr(hexapod.legs, side)
        if leg and part.mass.any():
            farthest = int(np.argmax(np.linalg.norm(part.mass_center, axis=1)))
            numbers = float(part.mass[farthest]), part.mass_center[farthest], part.inertia[farthest]
            found += _body(f"legs.{side}", *numbers, leg, f"the leg's {joint} joint")
    return found


def _body(table: str, mass: float, center: Array, inertia: Array, size: float, origin: str) -> list[Caution]:
    found = []
    away = float(np.linalg.norm(center))
    if mass > 0 and away > FAR * size:
        text = (
            f"{table}.mass_center is {away:.4g} m from {origin}, {away / size:.3g} times the machine's size of "
            f"{size:.3g} m. In mm it is {table}.mass_center_mm."
        )
        found.append(Caution("mass_center", text, {"distance": away, "size": size}))
    gyration = float(radii_of_gyration(mass, inertia).max())
    if gyration > FAR * size or (table == "platform" and gyration < NEAR * size):
        remedy = f"That is a point: check the units of {table}.inertia, of the mass, and of the joints."
        if gyration > size:
            remedy = f"It is in kg m2 about the body's own mass centre; in kg mm2 it is {table}.inertia_kg_mm2."
        text = (
            f"{table}.inertia gives a radius of gyration of {gyration:.3g} m with {mass:.4g} kg, "
            f"{gyration / size:.3g} times the machine's size of {size:.3g} m. {remedy}"
        )
        found.append(Caution("radius_of_gyration", text, {"radius": gyration, "size": size}))
    return found


def radii_of_gyration(mass: float, inertia: Array) -> Array:
    """Of a body about its principal axes, m, (3,), ascending; zero without mass or where no body has the inertia."""
    moments = np.linalg.eigvalsh(inertia)
    return np.sqrt(np.maximum(moments, 0.0) / mass) if mass > 0 else np.zeros(3)


def _gravity(hexapod: Hexapod) -> list[Caution]:
    size = float(np.linalg.norm(hexapod.gravity))
    if size and not GRAVITIES[0] < size < GRAVITIES[1]:
        text = (
            f"gravity is {hexapod.gravity.tolist()} m/s2, {size / 9.80665:.3g} times the Earth's. In mm/s2 it is "
            "gravity_mm_per_s2; without weight it is [0, 0, 0]."
        )
        return [Caution("gravity", text, {"gravity": size})]
    home = home_pose(hexapod)
    up = np.array([0.0, 0.0, 1.0])
    if home is not None:
        up = home.position + home.matrix @ hexapod.platform_joints.mean(axis=0) - hexapod.base_joints.mean(axis=0)
    if hexapod.gravity[2] > 0 and hexapod.gravity @ up > 0:
        text = (
            f"gravity is {hexapod.gravity.tolist()} m/s2: it points along +z, from the base to the platform, so that "
            "the machine hangs from its base. If z points upwards, gravity is [0, 0, -9.81]."
        )
        return [Caution("gravity", text, {"gravity": size})]
    return []


def _springs(hexapod: Hexapod) -> list[Caution]:
    """Springs in series, in joints and of a suspension that fit neither the legs nor the machine's size, and losses."""
    return [*_series(hexapod), *_joint_springs(hexapod), *_suspension(hexapod), *_losses(hexapod)]


def _series(hexapod: Hexapod) -> list[Caution]:
    left = 1.0 / (1.0 + hexapod.legs.stiffness * hexapod.legs.series_compliance)  # NaN where a law says the stiffness
    worst = int(np.argmin(left))
    if not left[worst] < SHARE_LEFT:
        return []
    text = (
        f"legs.series_stiffness leaves {left[worst]:.3g} of the {hexapod.legs.stiffness[worst]:.4g} N/m of leg "
        f"{worst + 1}. In N/um it is legs.series_stiffness_N_per_um; what legs.stiffness holds already is left out."
    )
    return [Caution("series_stiffness", text, {"leg": worst + 1, "share": float(left[worst])})]


def _joint_springs(hexapod: Hexapod) -> list[Caution]:
    """Joints that make a leg stiffer across than along it, that hold nothing, or whose moment is limited to no end."""
    joints, found = hexapod.legs.joint_stiffness, []
    leg = _leg_length(hexapod)
    home = home_pose(hexapod)
    along = np.zeros(6) if home is None else axial_stiffness(hexapod, inverse_kinematics(hexapod, home))[0]
    for name, each in (("universal", joints.universal.max(axis=1)), ("spherical", joints.spherical)):
        key = f"legs.joint_stiffness.{name}"
        if leg and each.any():
            share = each / leg**2 / along
            worst = int(np.argmax(share))
            if share[worst] > STIFF_ACROSS:
                text = (
                    f"{key} is {each[worst]:.4g} N m/rad: at the end of a leg of {leg:.3g} m it is {share[worst]:.3g} "
                    f"times the leg's axial stiffness of {along[worst]:.4g} N/m. In N mm/rad it is {key}_N_mm_per_rad."
                )
                found.append(Caution("joint_stiffness", text, {"stiffness": float(each[worst]), "share": share[worst]}))
            elif share[worst] < FREE:
                text = (
                    f"{key} is {each[worst]:.4g} N m/rad: at the end of a leg of {leg:.3g} m it is {share[worst]:.3g} "
                    "times the leg's axial stiffness, which is nothing. Check its unit, or leave it out."
                )
                found.append(Caution("joint_stiffness", text, {"stiffness": float(each[worst]), "share": share[worst]}))
        if getattr(hexapod.limits, f"{name}_moment") is not None and not each.any():
            text = f"limits.{name}_moment limits the moment of a joint without stiffness. Give {key}, or leave it out."
            found.append(Caution("idle_limit", text))
    return found


def _suspension(hexapod: Hexapod) -> list[Caution]:
    """A suspension that turns about a point far outside the machine: numbers in other units than SI."""
    if hexapod.suspension is None:
        return []
    linear, angular = np.diag(hexapod.suspension.stiffness).reshape(2, 3).max(axis=1)
    size = max(mean_radius(hexapod.base_joints), mean_radius(hexapod.platform_joints), _leg_length(hexapod) or 0.0)
    radius = float(np.sqrt(angular / linear)) if linear > 0 else 0.0
    if radius < FAR * size:
        return []
    text = (
        f"suspension.stiffness is {linear:.4g} N/m and {angular:.4g} N m/rad: springs {radius:.3g} m from their "
        f"centre, {radius / size:.3g} times the machine's size of {size:.3g} m. Rows and columns are in SI units, "
        "translations first."
    )
    return [Caution("suspension", text, {"radius": radius, "size": size})]


def _losses(hexapod: Hexapod) -> list[Caution]:
    given = {
        "legs.loss_factor": hexapod.legs.loss_factor,
        "legs.joint_stiffness.loss_factor": hexapod.legs.joint_stiffness.loss_factor,
    }
    return [
        Caution(
            "loss_factor",
            f"{key} is {factor.max():.4g}; metal structures have 0.001 to 0.05, rubber up to 1. 2 % is 0.02.",
            {"loss_factor": float(factor.max())},
        )
        for key, factor in given.items()
        if factor.max() > LOSSES
    ]


def legs_that_cross(hexapod: Hexapod, pose: Pose) -> list[Caution]:
    """Legs whose axes meet, or pass one another nearer than legs are thick."""
    distance = leg_distances(hexapod, states(hexapod, pose)).reshape(len(LEG_PAIRS))
    least = TOUCH * float(inverse_kinematics(hexapod, pose).mean())
    pairs = [pair for pair, apart in zip(LEG_PAIRS, distance, strict=True) if apart < least]
    if not pairs:
        return []
    which = ", ".join(f"{i + 1} and {j + 1}" for i, j in pairs) if len(pairs) < 7 else f"{len(pairs)} pairs of them"
    nearest = float(distance.min())
    told = f"{nearest:.3g} m" if nearest > 1e-9 * least else "0 m"
    text = (
        f"Legs cross or touch here: {which}; the nearest axes are {told} apart. Check that the joints of base and "
        "platform are numbered in the same sense: leg 1 joins base joint 1 to platform joint 1."
    )
    return [Caution("legs_cross", text, {"pairs": len(pairs), "distance": nearest})]


def soft_legs(hexapod: Hexapod, rest: Equilibrium) -> list[Caution]:
    """Legs that the weight compresses or stretches by a large part of their length. rest: what holds the machine."""
    change = np.abs(rest.unstretched_length - rest.leg_length)
    share = change / rest.leg_length
    worst = int(np.argmax(share))
    if share[worst] < SAG:
        return []
    force = rest.leg_force[worst]
    stiffness = abs(force) / change[worst]
    text = (
        f"At rest leg {worst + 1} is {'shortened' if force > 0 else 'stretched'} by {change[worst]:.3g} m, "
        f"{share[worst]:.3g} times its length, under {abs(force):.4g} N. Check legs.stiffness, {stiffness:.4g} N/m "
        "(in N/um it is legs.stiffness_N_per_um), platform.mass and gravity."
    )
    return [Caution("soft_legs", text, {"leg": worst + 1, "change": float(change[worst])})]


def singular_everywhere(hexapod: Hexapod, pose: Pose, condition: float) -> float | None:
    """The least condition number of H without units at `POSES` poses about a singular one, if all are bad.

    condition: that at the pose. None where one of the poses is better, or where none can be taken.
    """
    if condition < SINGULAR_EVERYWHERE:
        return None
    length = float(inverse_kinematics(hexapod, pose).mean())
    rng = np.random.default_rng(0)
    away = rng.uniform(-1, 1, (POSES, 6)) * np.repeat([0.3 * length, 0.6], 3)
    turned = Pose.from_rpy(0, 0, 0, *away[:, 3:].T).matrix @ pose.matrix
    there = Pose(pose.position + away[:, :3], turned)
    radius = mean_radius(hexapod.platform_joints)
    found = np.asarray(condition_number(hexapod, there, characteristic_length=radius))
    taken = found[~np.isnan(found)]
    return float(taken.min()) if taken.size and taken.min() > SINGULAR_EVERYWHERE else None


def _leg_length(hexapod: Hexapod) -> float | None:
    """Mean length of the legs at home, m; None without a home."""
    home = home_pose(hexapod)
    if home is None:
        return None
    return float(np.linalg.norm(legs_at(hexapod.base_joints, hexapod.platform_joints, home), axis=1).mean())


def _key_of_joints(hexapod: Hexapod, plate: str) -> str:
    """The key that says where the joints of a plate are."""
    for form in hexapod.short_forms:
        if f"{plate}.joints" in form.made:
            return f"{form.table}.{next(key for key in ('radius', 'edge', 'height') if key in form.given)}"
    return f"{plate}.joints"
