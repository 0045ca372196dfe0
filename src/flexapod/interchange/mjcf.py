"""MuJoCo's MJCF: a free platform, six legs of two hinges and a slide, closed by equality constraints."""

from __future__ import annotations

import math
import warnings
import xml.etree.ElementTree as ET
from os import PathLike
from pathlib import Path

import numpy as np

from flexapod import __version__
from flexapod.checks import level_outside, positive
from flexapod.conventions import TWO_PI, Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import DesignError
from flexapod.interchange.multibody import Body, Leg, Machine, at_rest
from flexapod.interchange.xml_files import add, document, note_left_out
from flexapod.mechanics.modes import natural_modes
from flexapod.output_files import output_path, write_file
from flexapod.pose import PoseLike

STEPS = 50  # of a simulation for each period of the fastest mode
SOCKET = 1e-3  # part of the platform that goes to each spherical joint with friction, where it has so much to give
LEFT = 0.9  # of the platform's mass and moments must stay with it
LEAST = 2e-14  # of a mass and of a moment of inertia: MuJoCo takes no moments below 1e-14
MASSES, FORCES = ("kg", "g", "mg", "ug", "ng", "pg"), ("N", "mN", "uN", "nN", "pN", "fN")
THICK = 0.02  # radius of a drawn leg, of its length


def write_mjcf(
    path: str | PathLike[str],
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    timestep: float | None = None,
) -> Path:
    """Write the hexapod at rest as a MuJoCo model (MJCF).

    At joint positions zero the platform stands at the pose, held by the springs of the legs. Motors ``leg1`` to
    ``leg6`` push beside the springs, in N. All numbers are in SI units, except for very small machines (see Notes).

    Parameters
    ----------
    path : str or path-like
        The file to write.
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform stands: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    timestep : float, optional
        Time step of the model, s. By default a fiftieth of the shortest natural period, or less where legs have so
        little mass that they could swing on their springs before MuJoCo closes the loops.

    Returns
    -------
    pathlib.Path
        The file written.

    Raises
    ------
    ArgumentError
        If the path or the time step is invalid.
    DesignError
        If a body has no mass, or an inertia that no solid body has (see `nearest_physical`).
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.
    OutputError
        If the file cannot be written.

    Warns
    -----
    UserWarning
        If masses and forces in the file are in smaller units than kg and N.

    Notes
    -----
    MuJoCo has no units, and refuses moments of inertia below 1e-14. Where a body has one, in machines of some
    millimetres, masses and forces are written in units a thousand or more times smaller, g and mN or mg and uN, with
    which the machine moves exactly as before; the file begins with them. Its motors take N all the same.

    The loops are closed by ``connect`` constraints. Where a spherical joint has friction, a ball joint with this
    friction carries a small piece cut out of the platform, and a ``weld`` joins the piece to the rest: together they
    have the platform's mass and inertia. Where it has stiffness, three hinges along the leg's axes stand for the ball
    joint, for a ball joint has one stiffness and a flexure two. The joints between base and legs are universal joints,
    as in the exact model. What the file leaves out of a design is said in a comment in it.

    Examples
    --------
    >>> fx.interchange.write_mjcf("motion-base.xml", fx.load("motion-base")).name
    'motion-base.xml'
    """
    return write_file(output_path(path), mjcf(hexapod, pose, timestep))


def mjcf(hexapod: Hexapod, pose: PoseLike | None = None, timestep: float | None = None) -> str:
    """The text of `write_mjcf`'s file."""
    if timestep is not None:
        positive(timestep, "timestep", "s")
    machine = at_rest(hexapod, pose)
    if timestep is None:
        timestep = _timestep(hexapod, machine)
    smaller = _smaller(machine)
    machine, units = machine.scaled(1000.0**smaller), "SI units"
    if smaller:
        units = f"m, s, {MASSES[smaller]}, {FORCES[smaller]}"
        warnings.warn(
            f"MuJoCo takes no moments of inertia as small as those of {hexapod.name!r}: masses in its model are in "
            f"{MASSES[smaller]} and forces in {FORCES[smaller]}. It moves as before; the motors take N.",
            UserWarning,
            stacklevel=level_outside(),
        )
    root = ET.Element("mujoco", model=machine.name)
    root.append(ET.Comment(f" Written by Flexapod {__version__} for {machine.pose!r}; {units}, base frame. "))
    note_left_out(root, machine.left_out)
    add(root, "compiler", angle="radian", autolimits="true")
    option = add(
        root,
        "option",
        timestep=timestep,
        gravity=machine.gravity,
        integrator="RK4",  # implicit ones damp the joints but not the forces that close the loops, which then part
        solver="Newton",
        iterations="100",
        tolerance=1e-14,
    )
    add(option, "flag", contact="disable")
    defaults = add(root, "default")
    add(defaults, "geom", contype="0", conaffinity="0", rgba=[0.6, 0.65, 0.7, 1.0])
    add(defaults, "equality", solref=[2 * timestep, 1.0], solimp=[0.9999, 0.9999, 0.001])
    rest, sockets = _divided(machine)
    _bodies(add(root, "worldbody"), machine, rest, sockets)
    equality, actuator = add(root, "equality"), add(root, "actuator")
    for leg in machine.legs:
        _close(equality, leg)
        gear = 1000.0**smaller if smaller else None
        add(actuator, "motor", name=leg.name, joint=f"{leg.name}_slide", gear=gear)
    return document(root)


def _smaller(machine: Machine) -> int:
    """How many thousands smaller the units of mass and force must be, for MuJoCo to take all bodies."""
    rest, sockets = _divided(machine)
    parts = [part for leg in machine.legs for part in (leg.lower, leg.upper)]
    bodies = [rest, *parts, *(piece for piece in sockets if piece is not None)]
    least = min(min(body.mass, float(np.linalg.eigvalsh(body.inertia)[0])) for body in bodies)
    smaller = max(0, math.ceil(math.log(LEAST / least, 1000)))
    if smaller >= len(MASSES):
        raise DesignError(
            f"a body of {machine.name!r} has a moment of inertia of {least:.3g} kg m2; MuJoCo takes none below 1e-14, "
            f"even with masses in {MASSES[-1]}. Give its bodies more mass."
        )
    return smaller


def _timestep(hexapod: Hexapod, machine: Machine) -> float:
    fastest = float(natural_modes(hexapod, machine.pose).omega[-1])
    lightest = min(math.sqrt(leg.upper.mass / leg.stiffness) for leg in machine.legs)
    return min(TWO_PI / fastest / STEPS, lightest / 2)


def _divided(machine: Machine) -> tuple[Body, list[Body | None]]:
    """What is left of the platform, and the piece of it at each spherical joint, about that joint; None: no friction.

    Pieces are balls of equal mass. Moments are those of second order about the platform's reference point, 4 x 4 with
    the first moments and the mass, so that bodies add up; a solid body's are positive definite.
    """
    whole = _moments(machine.platform)
    size = float(np.linalg.eigvalsh(machine.platform.inertia)[0])
    ball = Body(machine.platform.mass, np.zeros(3), size * np.eye(3))
    pieces = [ball._replace(center=leg.platform_joint) for leg in machine.legs if _socketed(leg)]
    if not pieces:
        return machine.platform, [None] * 6
    taken = np.sum([_moments(piece) for piece in pieces], axis=0)
    root = np.linalg.inv(np.linalg.cholesky(whole))
    share = min(SOCKET, (1 - LEFT) / float(np.linalg.eigvalsh(root @ taken @ root.T)[-1]))
    piece = ball._replace(mass=share * ball.mass, inertia=share * ball.inertia)
    return _of_moments(whole - share * taken), [piece if _socketed(leg) else None for leg in machine.legs]


def _socketed(leg: Leg) -> bool:
    """Whether the spherical joint carries a piece of the platform: it has friction or stiffness."""
    return leg.spherical > 0 or leg.sprung


def _moments(body: Body) -> Array:
    moments = np.empty((4, 4))
    moments[:3, :3] = (
        np.trace(body.inertia) / 2 * np.eye(3) - body.inertia + body.mass * np.outer(body.center, body.center)
    )
    moments[:3, 3] = moments[3, :3] = body.mass * body.center
    moments[3, 3] = body.mass
    return moments


def _of_moments(moments: Array) -> Body:
    mass, center = float(moments[3, 3]), moments[:3, 3] / moments[3, 3]
    about = moments[:3, :3] - mass * np.outer(center, center)
    return Body(mass, center, np.trace(about) * np.eye(3) - about)


def _bodies(world: ET.Element, machine: Machine, rest: Body, sockets: list[Body | None]) -> None:
    reach = float(np.ptp([leg.base_joint for leg in machine.legs], axis=0).max())
    height = float(machine.pose.position[2])
    add(world, "light", pos=[0.0, -reach, height + 2 * reach], dir=[0.0, 0.3, -1.0])
    base = add(world, "body", name="base")
    for leg, socket in zip(machine.legs, sockets, strict=True):
        _leg(base, leg, socket)
    platform = add(world, "body", name="platform", pos=machine.pose.position, xyaxes=machine.pose.matrix.T[:2])
    add(platform, "freejoint", name="platform")
    _inertial(platform, rest)
    middle = np.mean([leg.platform_joint for leg in machine.legs], axis=0)
    for leg in machine.legs:
        ends = np.concatenate([middle, leg.platform_joint])
        add(platform, "geom", type="capsule", fromto=ends, size=THICK * leg.length, rgba=[0.0, 0.45, 0.7, 1.0])


def _leg(base: ET.Element, leg: Leg, socket: Body | None) -> None:
    lower = add(base, "body", name=f"{leg.name}_lower", pos=leg.base_joint, xyaxes=leg.axes.T[:2])
    for n, (name, axis) in enumerate((("k", leg.axis), ("y", np.array([0.0, 1.0, 0.0])))):
        springs = _spring(leg.universal_stiffness[n], leg.universal_rest[n])
        joint = {"name": f"{leg.name}_universal_{name}", "axis": axis, "damping": leg.universal, **springs}
        add(lower, "joint", type="hinge", **joint)
    _inertial(lower, leg.lower)
    half = leg.length / 2
    add(lower, "geom", type="capsule", fromto=[0.0, 0.0, 0.0, half, 0.0, 0.0], size=THICK * leg.length)
    upper = add(lower, "body", name=f"{leg.name}_upper", pos=[leg.length, 0.0, 0.0])
    add(
        upper,
        "joint",
        name=f"{leg.name}_slide",
        type="slide",
        axis=[1.0, 0.0, 0.0],
        stiffness=leg.stiffness,
        springref=leg.force / leg.stiffness,
        damping=leg.prismatic,
        range=leg.travel,
    )
    _inertial(upper, leg.upper)
    add(upper, "geom", type="capsule", fromto=[-half, 0.0, 0.0, 0.0, 0.0, 0.0], size=0.6 * THICK * leg.length)
    if socket is not None:
        piece = add(upper, "body", name=f"{leg.name}_socket")
        _ball(piece, leg)
        _inertial(piece, socket)


def _ball(piece: ET.Element, leg: Leg) -> None:
    """The spherical joint: a ball, or with stiffness three hinges along the leg's axes."""
    if not leg.sprung:
        add(piece, "joint", name=f"{leg.name}_spherical", type="ball", damping=leg.spherical)
        return
    for n, axis in enumerate("xyz"):
        springs = _spring(leg.spherical_stiffness[n], leg.spherical_rest[n])
        joint = {"name": f"{leg.name}_spherical_{axis}", "axis": np.eye(3)[n], "damping": leg.spherical, **springs}
        add(piece, "joint", type="hinge", **joint)


def _spring(stiffness: float, rest: float) -> dict[str, float]:
    """Attributes of a hinge's spring, none without stiffness."""
    return {"stiffness": float(stiffness), "springref": float(rest)} if stiffness else {}


def _close(equality: ET.Element, leg: Leg) -> None:
    name, anchor = f"{leg.name}_closed", [0.0, 0.0, 0.0]
    if _socketed(leg):
        add(equality, "weld", name=name, body1="platform", body2=f"{leg.name}_socket", anchor=anchor)
    else:
        add(equality, "connect", name=name, body1=f"{leg.name}_upper", body2="platform", anchor=anchor)


def _inertial(body: ET.Element, of: Body) -> None:
    six = of.inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    add(body, "inertial", mass=of.mass, pos=of.center, fullinertia=six)
