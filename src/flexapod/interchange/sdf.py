"""SDF, which has universal and ball joints, springs and loops: the machine as a world that a simulator can open."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from os import PathLike
from pathlib import Path

import numpy as np

from flexapod import __version__
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.interchange.multibody import Body, Leg, Machine, at_rest
from flexapod.interchange.xml_files import add, document, note_left_out, say
from flexapod.output_files import output_path, write_file
from flexapod.pose import Pose, PoseLike

VERSION = "1.9"
UNLIMITED = 1e16  # SDF's own value for no limit


def write_sdf(path: str | PathLike[str], hexapod: Hexapod, pose: PoseLike | None = None) -> Path:
    """Write the hexapod at rest as an SDF world.

    Links stand where they are at the pose, in the base frame and SI units. Legs are universal, prismatic (with spring,
    rest position and damping) and ball joints; the loops are closed.

    Parameters
    ----------
    path : str or path-like
        The file to write.
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform stands: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.

    Returns
    -------
    pathlib.Path
        The file written.

    Raises
    ------
    ArgumentError
        If the path is invalid.
    DesignError
        If a body has no mass, or an inertia that no solid body has (see `nearest_physical`).
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.
    OutputError
        If the file cannot be written.

    Notes
    -----
    The format is SDF 1.9. It has no friction and no stiffness of ball joints, which are left out: a comment in the file
    says what is. The joints between base and legs are universal joints, as in the exact model.

    Examples
    --------
    >>> fx.interchange.write_sdf("motion-base.sdf", fx.load("motion-base")).name
    'motion-base.sdf'
    """
    return write_file(output_path(path), sdf(at_rest(hexapod, pose, "sdf")))


def sdf(machine: Machine) -> str:
    """The text of the SDF file."""
    root = ET.Element("sdf", version=VERSION)
    root.append(ET.Comment(f" Written by Flexapod {__version__} for {machine.pose!r}; SI units, base frame. "))
    note_left_out(root, machine.left_out)
    world = add(root, "world", name="hexapod")
    say(world, "gravity", machine.gravity)
    model = add(world, "model", name=machine.name)
    add(model, "link", name="base")
    _joint(model, "fixed", "base_fixed", "world", "base")
    _link(model, "platform", machine.pose.position, machine.pose.matrix, machine.platform)
    for leg in machine.legs:
        _leg(model, leg)
    return document(root)


def _leg(model: ET.Element, leg: Leg) -> None:
    lower, upper = f"{leg.name}_lower", f"{leg.name}_upper"
    end = leg.base_joint + leg.length * leg.axes[:, 0]
    _link(model, lower, leg.base_joint, leg.axes, leg.lower)
    _link(model, upper, end, leg.axes, leg.upper)
    universal = _joint(model, "universal", f"{leg.name}_universal", "base", lower)
    for n, (tag, axis) in enumerate((("axis", leg.axis), ("axis2", np.array([0.0, 1.0, 0.0])))):
        dynamics = _axis(universal, tag, axis, leg.universal)
        if leg.universal_stiffness[n]:
            say(dynamics, "spring_reference", leg.universal_rest[n])
            say(dynamics, "spring_stiffness", leg.universal_stiffness[n])
    slide = _joint(model, "prismatic", f"{leg.name}_slide", lower, upper)
    dynamics = _axis(slide, "axis", np.array([1.0, 0.0, 0.0]), leg.prismatic, leg.travel)
    say(dynamics, "spring_reference", leg.force / leg.stiffness)
    say(dynamics, "spring_stiffness", leg.stiffness)
    ball = _joint(model, "ball", f"{leg.name}_spherical", upper, "platform")
    say(ball, "pose", np.concatenate([leg.platform_joint, np.zeros(3)]))


def _link(model: ET.Element, name: str, position: Array, rotation: Array, body: Body) -> None:
    link = add(model, "link", name=name)
    say(link, "pose", np.concatenate([position, Pose(position, rotation).rpy]))
    inertial = add(link, "inertial")
    say(inertial, "pose", np.concatenate([body.center, np.zeros(3)]))
    say(inertial, "mass", body.mass)
    inertia = add(inertial, "inertia")
    for name, (i, j) in {"xx": (0, 0), "xy": (0, 1), "xz": (0, 2), "yy": (1, 1), "yz": (1, 2), "zz": (2, 2)}.items():
        say(inertia, f"i{name}", body.inertia[i, j])


def _joint(model: ET.Element, kind: str, name: str, parent: str, child: str) -> ET.Element:
    joint = add(model, "joint", name=name, type=kind)
    say(joint, "parent", parent)
    say(joint, "child", child)
    return joint


def _axis(
    joint: ET.Element, tag: str, along: Array, damping: float, travel: tuple[float, float] | None = None
) -> ET.Element:
    """An axis in the child's frame; returns its `dynamics`."""
    axis = add(joint, tag)
    say(axis, "xyz", along)
    limit = add(axis, "limit")
    low, high = travel or (-UNLIMITED, UNLIMITED)
    say(limit, "lower", low)
    say(limit, "upper", high)
    dynamics = add(axis, "dynamics")
    say(dynamics, "damping", damping)
    return dynamics
