"""URDF, which is a tree and has no springs, with a file beside it that closes the loops and adds what is missing."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from flexapod import __version__
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.interchange.multibody import Body, Leg, Machine, at_rest
from flexapod.interchange.xml_files import add, document, note_left_out
from flexapod.output_files import output_path, write_file
from flexapod.pose import Pose, PoseLike

UNLIMITED = 1e9  # URDF wants a number for every limit of a sliding joint
_ALONG = {"x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}


def write_urdf(path: str | PathLike[str], hexapod: Hexapod, pose: PoseLike | None = None) -> tuple[Path, Path]:
    """Write the hexapod at rest as URDF, with a JSON file for what URDF cannot hold.

    URDF describes a tree: the platform hangs on leg 1 by three hinges through its spherical joint. The file
    ``NAME.loops.json`` names the five point constraints that close the other legs, the springs of legs and joints with
    their rest positions, the friction of the spherical joints, gravity, and what both files leave out. At joint
    positions zero the platform stands at the pose, at rest. All numbers are in SI units.

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
    tuple of pathlib.Path
        The URDF file and the JSON file.

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
        If a file cannot be written.

    Notes
    -----
    The joints between base and legs are universal joints, as in the exact model.

    Examples
    --------
    >>> [file.name for file in fx.interchange.write_urdf("motion-base.urdf", fx.load("motion-base"))]
    ['motion-base.urdf', 'motion-base.loops.json']
    """
    file = output_path(path)
    machine = at_rest(hexapod, pose, "urdf")
    write_file(file, urdf(machine))
    beside = json.dumps(loops(machine, file.name), indent=2)
    return file, write_file(file.with_suffix(".loops.json"), beside + "\n")


def urdf(machine: Machine) -> str:
    """The text of the URDF file."""
    robot = ET.Element("robot", name=machine.name)
    robot.append(
        ET.Comment(f" Written by Flexapod {__version__} for {machine.pose!r}; loops, springs: .loops.json beside it. ")
    )
    note_left_out(robot, machine.left_out)
    add(robot, "link", name="base")
    for leg in machine.legs:
        _leg(robot, leg)
    _platform(robot, machine)
    return document(robot)


def loops(machine: Machine, name: str) -> dict[str, Any]:
    """What URDF cannot say, for JSON: m, N, N/m, N m s/rad, m/s2."""
    first, *others = machine.legs
    return {
        "format": "flexapod loops 1",
        "urdf": name,
        "design": machine.name,
        "gravity": machine.gravity.tolist(),
        "platform_position": machine.pose.position.tolist(),
        "platform_rotation": machine.pose.matrix.tolist(),
        "closures": [
            {
                "type": "point",
                "link_a": f"{leg.name}_upper",
                "point_a": [0.0, 0.0, 0.0],
                "link_b": "platform",
                "point_b": leg.platform_joint.tolist(),
                "spherical_damping": leg.spherical,
                **_closing_springs(leg),
            }
            for leg in others
        ],
        "springs": [
            {
                "joint": f"{leg.name}_slide",
                "stiffness": leg.stiffness,
                "rest_position": leg.force / leg.stiffness,
                "force_here": leg.force,
            }
            for leg in machine.legs
        ]
        + [spring for leg in machine.legs for spring in _hinge_springs(leg, leg is first)],
        "not_here": list(machine.left_out),
        "platform_joints": [f"{first.name}_spherical_{axis}" for axis in _ALONG],
    }


def _hinge_springs(leg: Leg, carries_platform: bool) -> list[dict[str, Any]]:
    """Springs about the hinges of the base joint, and of the platform joint where it is three hinges of the tree."""
    names = ["universal_k", "universal_y", *([f"spherical_{axis}" for axis in _ALONG] if carries_platform else [])]
    stiffness = np.concatenate([leg.universal_stiffness, leg.spherical_stiffness])
    rest = np.concatenate([leg.universal_rest, leg.spherical_rest])
    return [
        {"joint": f"{leg.name}_{name}", "stiffness": float(k), "rest_position": float(at), "force_here": float(k * at)}
        for name, k, at in zip(names, stiffness, rest, strict=False)
        if k
    ]


def _closing_springs(leg: Leg) -> dict[str, Any]:
    """Springs of a platform joint that closes a loop: about the axes of link_a, from here."""
    if not leg.sprung:
        return {}
    return {
        "spherical_stiffness": leg.spherical_stiffness.tolist(),
        "spherical_rest": leg.spherical_rest.tolist(),
    }


def _leg(robot: ET.Element, leg: Leg) -> None:
    for part in ("cross", "lower", "upper"):
        link = add(robot, "link", name=f"{leg.name}_{part}")
        if part != "cross":
            _inertial(link, getattr(leg, part))
    names = [f"{leg.name}_{joint}" for joint in ("universal_k", "universal_y", "slide")]
    links = ["base", f"{leg.name}_cross", f"{leg.name}_lower", f"{leg.name}_upper"]
    _joint(robot, "continuous", names[0], links[0:2], leg.base_joint, leg.axes, axis=leg.axis, damping=leg.universal)
    _joint(robot, "continuous", names[1], links[1:3], np.zeros(3), np.eye(3), axis=_ALONG["y"], damping=leg.universal)
    end = np.array([leg.length, 0.0, 0.0])
    slide = _joint(robot, "prismatic", names[2], links[2:4], end, np.eye(3), axis=_ALONG["x"], damping=leg.prismatic)
    low, high = leg.travel or (-leg.length, leg.length)
    add(slide, "limit", lower=low, upper=high, effort=UNLIMITED, velocity=UNLIMITED)


def _platform(robot: ET.Element, machine: Machine) -> None:
    """Three hinges through the first leg's end, and the platform fixed to the last.

    They lie along the platform's axes, or where they have springs along the leg's, in which bending and torsion differ.
    """
    first = machine.legs[0]
    between = first.axes.T @ machine.pose.matrix
    turn, last = (np.eye(3), between) if first.sprung else (between, np.eye(3))
    parent = f"{first.name}_upper"
    for axis, along in _ALONG.items():
        child = f"socket_{axis}"
        add(robot, "link", name=child)
        name = f"{first.name}_spherical_{axis}"
        _joint(robot, "continuous", name, [parent, child], np.zeros(3), turn, axis=along, damping=first.spherical)
        parent, turn = child, np.eye(3)
    _inertial(add(robot, "link", name="platform"), machine.platform)
    _joint(robot, "fixed", "platform_fixed", [parent, "platform"], -(last @ first.platform_joint), last)


def _joint(
    robot: ET.Element,
    kind: str,
    name: str,
    links: list[str],
    position: Array,
    rotation: Array,
    *,
    axis: Array | list[float] | None = None,
    damping: float = 0.0,
) -> ET.Element:
    joint = add(robot, "joint", name=name, type=kind)
    add(joint, "parent", link=links[0])
    add(joint, "child", link=links[1])
    add(joint, "origin", xyz=position, rpy=Pose(position, rotation).rpy)
    if axis is not None:
        add(joint, "axis", xyz=axis)
        add(joint, "dynamics", damping=damping, friction=0.0)
    return joint


def _inertial(link: ET.Element, of: Body) -> None:
    inertial = add(link, "inertial")
    add(inertial, "origin", xyz=of.center, rpy=np.zeros(3))
    add(inertial, "mass", value=of.mass)
    I = of.inertia
    add(inertial, "inertia", ixx=I[0, 0], ixy=I[0, 1], ixz=I[0, 2], iyy=I[1, 1], iyz=I[1, 2], izz=I[2, 2])
