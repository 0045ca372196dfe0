"""The machine and its modes drawn in three dimensions. Without `ax` a new figure is made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod.conventions import LEGS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.mechanics.inputs import as_hexapod, single_pose
from flexapod.mechanics.kinematics import force_transformation
from flexapod.mechanics.modes import NaturalModes
from flexapod.plots.style import (
    BASE,
    FAINT,
    LEG,
    NARROW,
    PLATFORM,
    SHORTENED,
    STRETCHED,
    TRIAD,
    VIEW,
    across,
    ink,
    letters,
    new_axes,
    wide,
)
from flexapod.pose import Pose, PoseLike
from flexapod.rotations import rotation_from_vector

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d.axes3d import Axes3D


def machine(hexapod: Hexapod, pose: PoseLike | None = None, *, ax: Axes3D | None = None) -> Axes3D:
    """Draw the machine in 3-D at a pose: base, legs with their numbers, platform, and both frames, in m.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        One pose: a Pose, or x, y, z (m), roll, pitch, yaw (rad). Default: the home pose.
    ax : Axes3D, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    mpl_toolkits.mplot3d.axes3d.Axes3D
        The axes; their ``figure`` can be saved.

    Raises
    ------
    PoseError
        If the pose is a batch, or is left out and the design has no home pose.

    Notes
    -----
    Lower parts of the legs are thick. The cross is the platform's mass centre.

    Examples
    --------
    >>> ax = fx.plots.machine(fx.load("motion-base"))
    >>> ax.figure.savefig("machine.png")
    """
    where = single_pose(as_hexapod(hexapod), pose)
    ax = _axes_3d() if ax is None else ax
    b, p = hexapod.base_joints, _at(where, hexapod.platform_joints)
    size = _frame(ax, b, p)
    _plate(ax, b, BASE)
    _plate(ax, p, PLATFORM)
    for i in range(6):
        middle = b[i] + 0.55 * (p[i] - b[i])
        _line(ax, b[i], middle, color=LEG, lw=wide(4.5))
        _line(ax, middle, p[i], color=LEG, lw=wide(2.0))
    _numbers(ax, b, size)
    _points(ax, b, BASE)
    _points(ax, p, PLATFORM)
    _triad(ax, Pose(np.zeros(3)), 0.2 * size, names=True)
    _triad(ax, where, 0.14 * size, names=False)
    center = _at(where, hexapod.platform_mass_center[None])[0]
    ax.plot(
        *center[:, None], marker="P", ms=wide(8), color=PLATFORM, mec="white", mew=wide(0.8), ls="none", clip_on=False
    )
    _ticks(ax)
    return ax


def mode(
    hexapod: Hexapod, pose: PoseLike | None, modes: NaturalModes, number: int, *, ax: Axes3D | None = None
) -> Axes3D:
    """Draw one mode at a pose: the platform at rest (grey) and displaced, the legs coloured by their strain.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like or None
        One pose, that of the modes; None is the home pose.
    modes : NaturalModes
        The modes at the pose, from `natural_modes`.
    number : int
        Number of the mode, from 1 (the lowest) to 6.
    ax : Axes3D, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    mpl_toolkits.mplot3d.axes3d.Axes3D
        The axes; their ``figure`` can be saved.

    Raises
    ------
    PoseError
        If the pose is a batch, or is None and the design has no home pose.
    ArgumentError
        If there is no such mode, or the modes are those of many poses.

    Notes
    -----
    The displacement is enlarged so that its largest part is a sixth of the machine. A leg is the wider and the more
    coloured the more it is stretched (orange) or shortened (blue), relative to the leg that is strained most.

    Examples
    --------
    >>> hexapod = fx.load("motion-base")
    >>> ax = fx.plots.mode(hexapod, None, fx.natural_modes(hexapod), 1)
    >>> ax.figure.savefig("mode-1.png")
    """
    where = single_pose(as_hexapod(hexapod), pose)
    if np.shape(modes.omega) != (6,) or not 1 <= number <= 6:
        raise ArgumentError(
            f"mode {number} of modes of shape {np.shape(modes.omega)}: give modes of one pose and 1 to 6."
        )
    b, p = hexapod.base_joints, _at(where, hexapod.platform_joints)
    alone = ax is None
    ax = _axes_3d() if ax is None else ax
    size = _frame(ax, b, p, margin=0.12)
    if alone:  # without ticks it fills the page
        ax.set_position((0.0, 0.0, 1.0, 1.0))
        ax.set_box_aspect(np.ptp(np.reshape(ax.get_w_lims(), (3, 2)), axis=1), zoom=1.3)
    x = _enlarged(modes.shape[:, number - 1], p - where.position, size / 6)
    strain = force_transformation(hexapod, where).T @ x
    moved = _at(Pose(where.position + x[:3], rotation_from_vector(x[3:]) @ where.matrix), hexapod.platform_joints)
    _plate(ax, b, BASE)
    _plate(ax, p, FAINT, alpha=0.0, ls="--")
    _plate(ax, moved, PLATFORM)
    largest = max(float(np.abs(strain).max()), 1e-9 * size)
    for i in range(6):
        _line(ax, b[i], p[i], color=FAINT, lw=wide(0.8), ls="--")
        part = float(strain[i]) / largest
        _line(ax, b[i], moved[i], color=_strain_colour(part), lw=wide(1.6 + 3.4 * abs(part)))
    _numbers(ax, b, size)
    _points(ax, b, BASE)
    _points(ax, moved, PLATFORM)
    ax.set_axis_off()
    return ax


def _enlarged(twist: Array, joints: Array, travel: float) -> Array:
    """A mode's twist scaled so that the joint that moves most moves by `travel`, towards the positive axes."""
    moves = twist[:3] + np.cross(twist[3:], joints)
    largest = float(np.linalg.norm(moves, axis=1).max())
    if largest == 0:
        return twist
    mean = moves.mean(axis=0)
    lead = mean if np.linalg.norm(mean) > 0.3 * largest else twist[3:]
    sign = -1.0 if lead[np.abs(lead).argmax()] < 0 else 1.0
    return twist * (sign * travel / largest)


def _axes_3d() -> Axes3D:
    ax: Any = new_axes(6.0, 6.0, projection="3d")
    if across(ax) < NARROW:
        ax.set_position((0.0, 0.03, 0.9, 0.97))
    return ax


def _at(pose: Pose, points: Array) -> Array:
    return pose.position + points @ pose.matrix.T


def _frame(ax: Axes3D, b: Array, p: Array, margin: float = 0.06) -> float:
    """Equal scales around the machine, seen without perspective; returns its size, m."""
    points = np.vstack([b, p])
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    low, high = low - margin * size, high + margin * size
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.set_box_aspect(high - low, zoom=1.15 if across(ax) > NARROW else 0.95)
    ax.set_proj_type("ortho")
    ax.view_init(**VIEW)
    return size


def _ticks(ax: Axes3D) -> None:
    for axis, name in ((ax.xaxis, "x, m"), (ax.yaxis, "y, m"), (ax.zaxis, "z, m")):
        axis.set_pane_color((1, 1, 1, 0))
        axis.line.set_color(FAINT)
        axis._axinfo["grid"].update(color=FAINT, linewidth=wide(0.3))
        axis.set_label_text(name, color=ink())
        axis.set_major_locator(_few())
    ax.tick_params(colors=ink(), labelsize=letters("xtick.labelsize"))


def _few() -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(4)


def _plate(ax: Axes3D, joints: Array, color: str, alpha: float = 0.22, ls: str = "-") -> None:
    """The outline of six joints, in order of their angle about their centre."""
    from matplotlib.colors import to_rgba
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    spread = joints - joints.mean(axis=0)
    first, second = np.linalg.svd(spread)[2][:2]
    order = np.argsort(np.arctan2(spread @ second, spread @ first))
    face = to_rgba(color, alpha)
    ax.add_collection3d(
        Poly3DCollection(
            [joints[order]], facecolor=face, edgecolor=color, linewidth=wide(1.4), linestyle=ls, clip_on=False
        )
    )


def _line(ax: Axes3D, start: Array, end: Array, **style: Any) -> None:
    ax.plot(*np.stack([start, end], axis=1), solid_capstyle="round", clip_on=False, **style)


def _numbers(ax: Axes3D, b: Array, size: float) -> None:
    """The numbers of the legs, outside their base joints; those of legs that meet there stand together."""
    outward = b - b.mean(axis=0)
    length = np.maximum(np.linalg.norm(outward, axis=1, keepdims=True), 1e-12)
    places = b + 0.08 * size * outward / length - [0, 0, 0.03 * size]
    same = np.linalg.norm(b[:, None] - b, axis=2) < 1e-6 * size
    for first in np.unique(same.argmax(axis=1)):
        number = ", ".join(leg for leg, here in zip(LEGS, same[first], strict=True) if here)
        ax.text(
            *places[first],
            number,
            color=ink(),
            ha="center",
            va="center",
            fontsize=letters("axes.labelsize"),
            fontweight="bold",
        )


def _points(ax: Axes3D, points: Array, color: str) -> None:
    ax.plot(*points.T, "o", ms=wide(5), color=color, mec="white", mew=wide(0.6), clip_on=False)


def _triad(ax: Axes3D, frame: Pose, length: float, names: bool) -> None:
    for i, (name, color) in enumerate(TRIAD):
        tip = frame.position + length * frame.matrix[:, i]
        _line(ax, frame.position, tip, color=color, lw=wide(1.6))
        if names:
            place = frame.position + 1.22 * length * frame.matrix[:, i]
            ax.text(*place, name, color=color, fontsize=letters(), ha="center", va="center")


def _strain_colour(part: float) -> Any:
    """From grey (no strain) to orange (stretched, 1) or blue (shortened, -1)."""
    from matplotlib.colors import to_rgb

    end = np.array(to_rgb(STRETCHED if part > 0 else SHORTENED))
    weight = min(1.0, abs(part)) ** 0.7
    return tuple((1 - weight) * np.array(to_rgb(FAINT)) + weight * end)
