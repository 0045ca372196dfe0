"""Draws the pictures of docs/conventions.md, of a packaged design: `python docs/images/draw_conventions.py`."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, Polygon

import flexapod as fx
from flexapod.plots import style

HERE = Path(__file__).parent
X, Y, Z = (color for _, color in style.TRIAD)
VECTOR = "#cc79a7"  # vectors of the equations; Okabe and Ito
MACHINE = fx.load("motion-base")


class Camera:
    """Orthographic projection onto a figure: azimuth and elevation of the eye, degrees."""

    def __init__(self, azimuth: float, elevation: float) -> None:
        a, e = np.radians([azimuth, elevation])
        right = [-np.sin(a), np.cos(a), 0.0]
        up = [-np.sin(e) * np.cos(a), -np.sin(e) * np.sin(a), np.cos(e)]
        self.axes = np.array([right, up])

    def __call__(self, points: np.ndarray) -> np.ndarray:
        return np.asarray(points) @ self.axes.T


class Drawing:
    """Lines, arrows and words in space, seen by a camera."""

    def __init__(self, ax: Axes, camera: Camera) -> None:
        self.ax, self.camera = ax, camera
        ax.set_aspect("equal")
        ax.set_axis_off()

    def line(self, *points, color: str = style.INK, width: float = 1.2, dashes: str = "-", order: float = 2) -> None:
        x, y = self.camera(np.array(points)).T
        self.ax.plot(x, y, color=color, lw=width, ls=dashes, solid_capstyle="round", zorder=order)

    def arrow(self, start, end, color: str, width: float = 1.8, head: float = 11, order: float = 5) -> None:
        a, b = self.camera(start), self.camera(end)
        arrow_style = {"arrowstyle": "-|>", "mutation_scale": head, "shrinkA": 0, "shrinkB": 0, "linewidth": width}
        self.ax.add_patch(FancyArrowPatch(a, b, color=color, zorder=order, **arrow_style))
        self.ax.update_datalim([a, b])

    def words(self, at, text: str, color: str = style.INK, shift=(0.0, 0.0), size: float = 13, **more) -> None:
        x, y = self.camera(at)
        more = {"ha": "center", "va": "center", "zorder": 9} | more
        box = {"boxstyle": "round,pad=0.12", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
        self.ax.annotate(text, (x, y), shift, textcoords="offset points", color=color, fontsize=size, bbox=box, **more)

    def plate(self, joints, color: str) -> None:
        order = np.argsort(np.arctan2(*(joints - joints.mean(axis=0))[:, 1::-1].T))
        flat = self.camera(joints[order])
        self.ax.add_patch(Polygon(flat, facecolor=color, alpha=0.16, edgecolor="none", zorder=1))
        self.ax.add_patch(Polygon(flat, fill=False, edgecolor=color, lw=1.4, zorder=1.5))
        self.ax.update_datalim(flat)

    def dots(self, points, color: str, size: float = 6) -> None:
        x, y = self.camera(points).T
        self.ax.plot(x, y, "o", ms=size, color=color, mec="white", mew=0.9, zorder=6, clip_on=False)

    def triad(self, pose: fx.Pose, length: float, names: tuple[str, str, str] = ("x", "y", "z")) -> None:
        for axis, color, name in zip(pose.matrix.T, (X, Y, Z), names, strict=True):
            end = pose.position + length * axis
            self.arrow(pose.position, end, color, 2.0)
            if name:
                out = self.camera(axis)
                out = out / max(float(np.linalg.norm(out)), 0.3)
                self.words(end, name, color, 9 * out, 11.5)

    def finish(self, margin: float = 0.02) -> None:
        self.ax.autoscale_view()
        self.ax.margins(margin)


def place(pose: fx.Pose, points) -> np.ndarray:
    return pose.position + np.asarray(points) @ pose.matrix.T


def machine_and_frames() -> plt.Figure:
    """Inertial, base and platform frames; leg numbers; t_b, t_p, q_b, q_p and S of one leg."""
    figure, ax = plt.subplots(figsize=(8.6, 6.6), facecolor="white")
    draw = Drawing(ax, Camera(-128, 24))
    base = fx.Pose.from_rpy(3.9, -0.5, 1.0, 0.0, 0.0, 0.15)
    seat = fx.Pose.from_rpy(0.1, -0.05, 2.5, 0.08, -0.1, 0.12)
    platform = fx.Pose(place(base, seat.position), base.matrix @ seat.matrix)
    b, p = place(base, MACHINE.base_joints), place(platform, MACHINE.platform_joints)
    inertial = fx.Pose((0.0, 0.0, 0.0))
    draw.plate(b, style.BASE)
    draw.plate(p, style.PLATFORM)
    for i in range(6):
        middle = b[i] + 0.55 * (p[i] - b[i])
        draw.line(b[i], middle, color=style.LEG, width=5.0)
        draw.line(middle, p[i], color=style.LEG, width=2.4)
        out = draw.camera(b[i] - base.position)
        draw.words(b[i], str(i + 1), size=11, shift=13 * out / np.linalg.norm(out))
    draw.dots(b, style.BASE)
    draw.dots(p, style.PLATFORM)
    shown = 4  # leg 5
    draw.arrow(inertial.position, base.position, style.FAINT)
    draw.arrow(inertial.position, platform.position, style.FAINT)
    draw.arrow(base.position, b[shown], VECTOR)
    draw.arrow(platform.position, p[shown], VECTOR)
    draw.arrow(b[shown], p[shown], VECTOR, 2.4, 14)
    for pose, name, shift in ((inertial, "G", (-12, -10)), (base, "B", (-2, -15)), (platform, "P", (-13, 9))):
        draw.triad(pose, 0.75)
        draw.words(pose.position, rf"$\mathbf{{{name}}}$", shift=shift, size=14)
    halfway = (
        (inertial.position, base.position, r"$\mathbf{t}_b$", style.INK, (4, -13)),
        (inertial.position, platform.position, r"$\mathbf{t}_p$", style.INK, (-10, 10)),
        (base.position, b[shown], r"$\mathbf{q}_b$", VECTOR, (-2, -14)),
        (platform.position, p[shown], r"$\mathbf{q}_p$", VECTOR, (10, 10)),
        (b[shown], p[shown], r"$\mathbf{S}$", VECTOR, (15, 0)),
    )
    for start, end, text, color, shift in halfway:
        draw.words(0.5 * (start + end), text, color, shift, 15)
    draw.finish()
    return figure


def one_leg() -> plt.Figure:
    """A leg's axes, its universal joint, its mass centres and lengths."""
    figure, ax = plt.subplots(figsize=(7.4, 6.4), facecolor="white")
    i, legs = 1, MACHINE.legs
    b, p = MACHINE.base_joints[i], place(fx.home_pose(MACHINE), MACHINE.platform_joints)[i]
    k, L = MACHINE.universal_axes[i], float(np.linalg.norm(p - b))
    s = (p - b) / L
    y = np.cross(k, s) / np.linalg.norm(np.cross(k, s))
    z, waist = np.cross(s, y), b + 0.62 * (p - b)
    draw = Drawing(ax, Camera(120, 14))
    draw.line(b, waist, color="#b9c0c8", width=15)
    draw.line(waist, p, color="#d7dce1", width=8, order=1.9)
    draw.line(b, p, color=style.FAINT, width=1.0, dashes=(0, (6, 3, 1, 3)), order=3)
    draw.line(b - 0.13 * L * k, b, color=style.INK, width=1.2, dashes="--", order=3)
    arrows = (
        (s, 0.36, X, r"$x = \mathbf{s}$", (30, -40)),
        (y, 0.36, Y, r"$y$, along $\mathbf{k}\times\mathbf{s}$", (26, -15)),
        (z, 0.36, Z, r"$z = x\times y$", (18, -12)),
        (k, 0.42, style.INK, r"$\mathbf{k}$, fixed in the base", (70, -2)),
    )
    for direction, length, color, name, shift in arrows:
        draw.arrow(b, b + length * L * direction, color, 2.2, 14)
        draw.words(b + length * L * direction, name, color, shift, 13)
    draw.dots(np.array([b]), style.BASE, 12)
    draw.dots(np.array([p]), style.PLATFORM, 12)
    centers = {"d": b + legs.lower.mass_center[i, 0] * s, "u": p + legs.upper.mass_center[i, 0] * s}
    for center in centers.values():
        x, height = draw.camera(center)
        ax.plot(x, height, marker="P", ms=11, color=style.INK, mec="white", mew=1.0, zorder=6)
    across = draw.camera(s)[::-1] * [-1, 1] / np.linalg.norm(draw.camera(s))  # to the left of the leg
    for start, end, off, text in (
        (b, centers["d"], 0.13, r"$\mathbf{r}_{d0}$"),
        (p, centers["u"], 0.13, r"$\mathbf{r}_{u0}$"),
        (b, p, 0.27, r"$L$"),
    ):
        _dimension(draw, start, end, off * L * across, text, both=text == "$L$")
    draw.words(p, "spherical joint, on the platform", style.PLATFORM, (16, 6), 11.5, ha="left")
    draw.words(b, "universal joint,\non the base", style.BASE, (-16, -44), 11.5, ha="right")
    draw.words(centers["d"], r"lower part: $m_d$, $\mathbf{I}_{d0}$", style.INK, (20, 2), 12, ha="left")
    draw.words(centers["u"], r"upper part: $m_u$, $\mathbf{I}_{u0}$", style.INK, (16, 2), 12, ha="left")
    draw.finish()
    return figure


def _dimension(draw: Drawing, start, end, off, text: str, both: bool) -> None:
    """A length beside the leg, with thin lines from its ends."""
    a, b = draw.camera(start), draw.camera(end)
    for at in (a, b):
        draw.ax.plot(*np.array([at + 0.15 * off, at + 1.12 * off]).T, color=style.FAINT, lw=0.8, zorder=1)
    arrow_style = {"arrowstyle": "<|-|>" if both else "-|>", "mutation_scale": 10, "shrinkA": 0, "shrinkB": 0}
    draw.ax.add_patch(FancyArrowPatch(a + off, b + off, color=style.INK, linewidth=1.1, zorder=4, **arrow_style))
    draw.ax.update_datalim([a + off, b + off])
    x, y = (a + b) / 2 + off
    box = {"boxstyle": "round,pad=0.12", "facecolor": "white", "edgecolor": "none"}
    draw.ax.text(x, y, text, fontsize=14, ha="center", va="center", bbox=box, zorder=9, color=style.INK)


def signs() -> plt.Figure:
    """Above: what the sign of a leg force means. Below: roll, pitch, yaw about fixed axes, in this order."""
    figure = plt.figure(figsize=(10.2, 6.9), facecolor="white")
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.0, 1.05))
    cases = (
        (0.82, r"$L < L_0$: compressed, $F > 0$", "the leg pushes the plates apart", style.SHORTENED),
        (1.0, r"$L = L_0$: unloaded, $F = 0$", "", style.LEG),
        (1.18, r"$L > L_0$: stretched, $F < 0$", "the leg pulls them together", style.STRETCHED),
    )
    for ax, (length, title, words, color) in zip(upper.subplots(1, 3), cases, strict=True):
        _leg_force(ax, length, title, words, color)
    angles = np.radians([35.0, 25.0, 40.0])
    names = (
        "no rotation\n",
        r"roll about $x$" + "\n" + r"$\mathbf{R}_x$",
        r"then pitch about $y$" + "\n" + r"$\mathbf{R}_y\mathbf{R}_x$",
        r"then yaw about $z$" + "\n" + r"$\mathbf{R} = \mathbf{R}_z\mathbf{R}_y\mathbf{R}_x$",
    )
    for n, (ax, name) in enumerate(zip(lower.subplots(1, 4), names, strict=True)):
        _turned_plate(ax, np.where(np.arange(3) < n, angles, 0.0), n, name)
    upper.subplots_adjust(0.02, 0.0, 0.98, 0.86)
    lower.subplots_adjust(0.01, 0.02, 0.99, 0.82, wspace=0.02)
    return figure


def _leg_force(ax: Axes, length: float, title: str, words: str, color: str) -> None:
    """Two plates, a spring between them, and the force of the leg on each."""
    ax.set_axis_off()
    ax.set_aspect("equal")
    ax.set_xlim(-0.95, 0.95)
    ax.set_ylim(-0.42, 1.3)
    ax.set_title(title, fontsize=12.5, color=style.INK, pad=2)
    for y, plate, name in ((0.0, style.BASE, "base"), (length, style.PLATFORM, "platform")):
        ax.plot([-0.5, 0.5], [y, y], color=plate, lw=5, solid_capstyle="round")
        ax.text(0.6, y, name, color=plate, fontsize=11, va="center")
    t = np.linspace(0, 1, 400)
    coil = 0.09 * np.sin(2 * np.pi * 9 * t) * ((t > 0.08) & (t < 0.92))
    ax.plot(coil, 0.03 + (length - 0.06) * t, color=color, lw=2.0)
    arrow_style = {"arrowstyle": "<|-|>", "mutation_scale": 9, "shrinkA": 0, "shrinkB": 0, "linewidth": 1.0}
    ax.add_patch(FancyArrowPatch((-0.68, 0), (-0.68, length), color=style.INK, **arrow_style))
    ax.text(-0.76, length / 2, "$L$", fontsize=13, ha="right", va="center", color=style.INK)
    ax.plot([-0.78, 0.2], [1.0, 1.0], color=style.FAINT, lw=0.9, ls=(0, (4, 3)), zorder=0)
    if length != 1.0:
        ax.text(-0.82, 1.0, "$L_0$", fontsize=12, ha="right", va="center", color=style.FAINT)
    sign = np.sign(1.0 - length)
    for start, direction in ((length, sign), (0.0, -sign)):
        if sign:
            arrow = {"arrowstyle": "-|>", "mutation_scale": 15, "shrinkA": 0, "shrinkB": 0, "linewidth": 2.4}
            end = start + 0.36 * direction
            ax.add_patch(FancyArrowPatch((0.3, start), (0.3, end), color=VECTOR, zorder=6, **arrow))
            ax.text(0.37, start + 0.24 * direction, "$|F|$", color=VECTOR, fontsize=12, va="center")
    ax.text(0.0, -0.52, words, fontsize=11, ha="center", va="center", color=style.INK)


def _turned_plate(ax: Axes, angles, turns: int, name: str) -> None:
    draw = Drawing(ax, Camera(-60, 24))
    pose = fx.Pose.from_rpy(0, 0, 0, *angles)
    outline = np.array([[-1, -0.7, 0], [1, -0.7, 0], [1, 0.7, 0], [-1, 0.7, 0]])
    flat = draw.camera(outline)
    ax.add_patch(Polygon(flat, fill=False, edgecolor=style.FAINT, lw=1.0, ls=(0, (4, 3)), zorder=1))
    turned = draw.camera(place(pose, outline))
    ax.add_patch(Polygon(turned, facecolor=style.PLATFORM, alpha=0.2, edgecolor="none", zorder=2))
    ax.add_patch(Polygon(turned, fill=False, edgecolor=style.PLATFORM, lw=1.6, zorder=2))
    draw.arrow((0, 0, 0), pose.matrix @ [0.95, 0, 0], style.PLATFORM, 1.6)
    draw.arrow((0, 0, 0), pose.matrix @ [0, 0, 0.9], style.PLATFORM, 1.6)
    for axis, (color, label) in enumerate(((X, "$x$"), (Y, "$y$"), (Z, "$z$"))):
        direction = np.eye(3)[axis]
        strong = axis == turns - 1
        draw.arrow((0, 0, 0), 1.5 * direction, color, 2.6 if strong else 1.0, 14 if strong else 9, order=4)
        out = draw.camera(direction)
        draw.words(1.5 * direction, label, color, 11 * out / np.linalg.norm(out), 13)
        if strong:
            _turn(draw, direction, color)
    ax.set_xlim(-1.75, 1.75)
    ax.set_ylim(-1.35, 1.75)
    ax.set_title(name, fontsize=12, color=style.INK, pad=3)


def _turn(draw: Drawing, axis, color: str) -> None:
    """The right-hand sense of a turn about an axis."""
    first = np.roll(axis, 1)
    second = np.cross(axis, first)
    t = np.radians(np.linspace(-60, 200, 60))
    circle = 1.12 * axis + 0.26 * (np.outer(np.cos(t), first) + np.outer(np.sin(t), second))
    draw.line(*circle[:-6], color=color, width=1.8, order=6)
    draw.arrow(circle[-8], circle[-1], color, 1.8, 11, order=6)


FIGURES = (("frames", machine_and_frames), ("leg", one_leg), ("signs", signs))


def main() -> None:
    plt.rcParams |= {"mathtext.fontset": "stix", "svg.hashsalt": "flexapod", "svg.fonttype": "path"}
    for name, make in FIGURES:
        make().savefig(HERE / f"{name}.svg", bbox_inches="tight", pad_inches=0.06, metadata={"Date": None})


if __name__ == "__main__":
    main()
