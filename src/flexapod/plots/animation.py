"""Moving pictures of a mode or of a simulated motion, enlarged by a factor that the picture states.

GIF needs nothing more; MP4 needs the extra "video" (imageio-ffmpeg).
"""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from flexapod.checks import instance, numbers, positive, whole
from flexapod.conventions import TWO_PI, Array, JointModel, metric
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.mechanics.inputs import as_hexapod, single_pose
from flexapod.mechanics.mode_shapes import describe_modes
from flexapod.mechanics.modes import natural_modes
from flexapod.mechanics.point_motion import displacement_at
from flexapod.optional import needed
from flexapod.output_files import check_file, completed
from flexapod.plots.style import BASE, FAINT, LEG, PLATFORM, VIEW, entitle, ink, letters, wide
from flexapod.pose import Pose, PoseLike
from flexapod.progress import ProgressLike, with_progress
from flexapod.rotations import rotation_from_vector, vector_from_rotation

if TYPE_CHECKING:
    from matplotlib.animation import AbstractMovieWriter
    from matplotlib.figure import Figure

__all__ = ["animate_mode", "animate_simulation"]

_TRAVEL = 0.12  # of the machine's size: the largest joint motion shown, where no factor is given
_WIDEST = 100.0  # sizes of the machine: motions shown larger than this are seen no more
_FPS = 16
_DPI = 100
_PER_PERIOD = 16  # frames of a period that show a vibration


@with_progress("frames")
def animate_mode(
    hexapod: Hexapod,
    pose: PoseLike | None,
    number: int,
    path: str | Path,
    *,
    joint: JointModel = "universal",
    amplitude: float = 1e-6,
    exaggeration: float | None = None,
    progress: ProgressLike = None,
) -> float:
    """Write one period of a mode to a file that loops.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like
        One pose: a Pose, or x, y, z in m and roll, pitch, yaw in rad; None for the home pose.
    number : int
        Which mode, from 1 (the lowest) to 6.
    path : str or Path
        The file, which ends in .gif or .mp4.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.
    amplitude : float
        Motion of the platform joint that moves most, m; a mode has no size of its own.
    exaggeration : float, optional
        How many times larger it is shown. Left out, so that it is an eighth of the machine.
    progress : callable or False, optional
        Is told the share done, 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

    Returns
    -------
    float
        The factor of enlargement, which stands in the picture with the amplitude.

    Raises
    ------
    ArgumentError
        For a mode, an amplitude or an enlargement that cannot be shown, or another ending.
    PoseError
        For a batch of poses, or a pose that no leg can take.
    MissingExtraError
        For .mp4 where the extra "video" is not installed.
    OutputError
        If the file cannot be written.

    See Also
    --------
    flexapod.natural_modes : Frequencies and shapes of the modes.

    Notes
    -----
    The mode is that of Eq. 5 of the paper, drawn as rotation vector and translation of the platform in 32 pictures.

    Examples
    --------
    >>> fx.animate_mode(fx.load("cubic-isolator"), None, 1, "mode.gif")  # doctest: +SKIP
    35000.0
    """
    pose = single_pose(hexapod, pose)
    if whole(number, "number") > 6:
        raise ArgumentError(f"number is {number!r}; it must be a mode from 1 to 6.")
    positive(amplitude, "amplitude", "m")
    modes = natural_modes(hexapod, pose, joint=joint)
    twist = modes.shape[:, number - 1]
    arms = hexapod.platform_joints @ pose.matrix.T
    twist = twist * (amplitude / _travel(arms + pose.position, pose, twist[None]))
    phase = TWO_PI * np.arange(2 * _PER_PERIOD) / (2 * _PER_PERIOD)
    omega = modes.omega[number - 1]
    words = describe_modes(hexapod, pose, joint=joint)[number - 1].text
    title = f"{hexapod.name}, mode {number}: {omega:.5g} rad/s ({omega / TWO_PI:.5g} Hz)\n{words}"
    film = _Film(hexapod, pose, Pose(np.zeros(3)), np.cos(phase)[:, None] * twist, np.zeros((phase.size, 6)))
    note = f"largest joint motion {_length(amplitude)}"
    return film.write(path, title, [note] * phase.size, exaggeration, progress or None)


@with_progress("frames")
def animate_simulation(
    dataset: xr.Dataset,
    hexapod: Hexapod,
    path: str | Path,
    *,
    base: PoseLike | None = None,
    exaggeration: float | None = None,
    window: tuple[float, float] | None = None,
    frames: int = 96,
    progress: ProgressLike = None,
) -> float:
    """Write a simulation to a file that moves.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of `flexapod.simulate`.
    hexapod : Hexapod
        The machine that was simulated.
    path : str or Path
        The file, which ends in .gif or .mp4.
    base : Pose or array_like, optional
        Pose of the base at rest, as it was simulated. Left out, the inertial frame.
    exaggeration : float, optional
        How many times larger the displacements of platform and base from rest are shown. Left out, so that the largest
        is an eighth of the machine.
    window : tuple of float, optional
        First and last time, s. Left out, the last part in which the main oscillation has 16 frames a period.
    frames : int
        How many pictures.
    progress : callable or False, optional
        Is told the share done, 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

    Returns
    -------
    float
        The factor of enlargement, which stands in the picture.

    Raises
    ------
    ArgumentError
        For a dataset, window or enlargement that cannot be shown, or another ending.
    MissingExtraError
        For .mp4 where the extra "video" is not installed.
    OutputError
        If the file cannot be written.

    See Also
    --------
    flexapod.simulate : Simulate the machine in time.

    Notes
    -----
    The displacements are interpolated linearly between the instants of the dataset.

    Examples
    --------
    >>> machine = fx.load("cubic-isolator")
    >>> shaken = fx.simulate(machine, base_motion=fx.harmonic("z", 1e-4, 30.0), duration=0.2)
    >>> fx.animate_simulation(shaken, machine, "shaken.gif", frames=2)
    130.0
    """
    as_hexapod(hexapod)
    whole(frames, "frames", 2)
    film, times = _simulated(
        dataset, hexapod, Pose(np.zeros(3)) if base is None else single_pose(hexapod, base, "base")
    )
    own = _last_periods(times, film.platform, frames)
    first, last = own if window is None else numbers(window, "window", (2,)).tolist()
    if not times[0] <= first < last <= times[-1]:
        raise ArgumentError(f"window is {window!r} s; it must ascend within {times[0]:.6g} to {times[-1]:.6g} s")
    at = np.linspace(first, last, frames)
    moves, feet = (np.stack([np.interp(at, times, x) for x in values.T], 1) for values in (film.platform, film.base))
    slowed = frames / _FPS / (last - first)
    speed = f"slowed {slowed:.3g} times" if slowed > 1 else f"{1 / slowed:.3g} times as fast"
    notes = [f"t = {t:.5g} s, {speed}" for t in at]
    shown = film._replace(platform=moves, base=feet)
    return shown.write(path, f"{hexapod.name}: simulation", notes, exaggeration, progress or None)


class _Film(NamedTuple):
    """Small displacements (n, 6) of platform and base from where they rest."""

    hexapod: Hexapod
    pose: Pose
    base_pose: Pose
    platform: Array
    base: Array

    def write(
        self,
        path: str | Path,
        title: str,
        notes: list[str],
        exaggeration: float | None,
        progress: Callable[[float], object] | None = None,
    ) -> float:
        travel = max(_travel(self.top, self.pose, self.platform), _travel(self.feet, self.base_pose, self.base))
        if travel == 0:
            raise ArgumentError("nothing moves in what is to be shown; choose a window or a simulation with motion")
        if not np.isfinite(travel):
            raise ArgumentError("the motion is larger than numbers can be; give a smaller one")
        size = float(np.ptp(np.vstack([self.top, self.feet]), axis=0).max())
        factor = (
            float(f"{_TRAVEL * size / travel:.2g}") if exaggeration is None else positive(exaggeration, "exaggeration")
        )
        if factor * travel > _WIDEST * size:
            raise ArgumentError(
                f"exaggeration is {factor:.6g}, which shows motions {factor * travel / size:.3g} times as large as the "
                f"machine. Give at most {_WIDEST * size / travel:.3g}."
            )
        figure, draw = _stage(self.top, self.feet, size + 2 * factor * travel)
        entitle(figure, title)
        _as_picture(figure)
        caption = figure.text(0.5, 0.03, "", ha="center", color=ink(), fontsize=letters("axes.labelsize"))
        writer, settings = _writer(Path(path))
        with completed(path) as making, settings, writer.saving(figure, str(making), dpi=_DPI):
            for i, (x, x_b) in enumerate(zip(factor * self.platform, factor * self.base, strict=True)):
                draw(*self.joints(x, x_b))
                caption.set_text(f"motion shown {factor:.6g} times larger; {notes[i]}")
                writer.grab_frame()
                if progress is not None:
                    progress((i + 1) / len(notes))
        return factor

    @property
    def top(self) -> Array:
        """(6, 3) m: the platform's joints at rest."""
        return self.pose.position + self.hexapod.platform_joints @ self.pose.matrix.T

    @property
    def feet(self) -> Array:
        """(6, 3) m: the base's joints at rest."""
        return self.base_pose.position + self.hexapod.base_joints @ self.base_pose.matrix.T

    def joints(self, x: Array, x_b: Array) -> tuple[Array, Array]:
        """Joints of platform and base, displaced."""
        return _moved(self.top, self.pose, x), _moved(self.feet, self.base_pose, x_b)


def _moved(joints: Array, pose: Pose, x: Array) -> Array:
    turn = rotation_from_vector(x[3:])
    return pose.position + x[:3] + (joints - pose.position) @ turn.T


def _stage(top: Array, feet: Array, width: float) -> tuple[Figure, Callable[[Array, Array], None]]:
    """A figure with the platform at rest in grey, and what moves the drawn joints of platform and base."""
    from matplotlib.colors import to_rgba
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    figure = Figure(figsize=(6, 5.6))
    ax: Any = figure.add_axes((0.0, 0.06, 1.0, 0.84), projection="3d")
    order, order_b = _around(top), _around(feet)
    ghost = {"facecolor": (0, 0, 0, 0), "edgecolor": FAINT, "linewidth": 1.0, "linestyle": "--"}
    ax.add_collection3d(Poly3DCollection([top[order]], **ghost))
    plates = []
    for joints, color in ((feet[order_b], BASE), (top[order], PLATFORM)):
        plates.append(Poly3DCollection([joints], facecolor=to_rgba(color, 0.25), edgecolor=color, linewidth=wide(1.5)))
        ax.add_collection3d(plates[-1])
    legs = [
        ax.plot(*np.zeros((3, 2)), color=LEG, lw=wide(2.4), marker="o", ms=wide(4), mec="white", mew=wide(0.5))[0]
        for _ in range(6)
    ]
    both = np.vstack([top, feet])
    middle = 0.5 * (both.max(axis=0) + both.min(axis=0))
    spread = 0.5 * width
    ax.set(**{f"{axis}lim": (m - spread, m + spread) for axis, m in zip("xyz", middle, strict=True)})
    ax.set_box_aspect((1, 1, 1), zoom=1.35)
    ax.set_proj_type("ortho")
    ax.view_init(**VIEW)
    ax.set_axis_off()

    def draw(platform: Array, base: Array) -> None:
        plates[0].set_verts([base[order_b]])
        plates[1].set_verts([platform[order]])
        for i, leg in enumerate(legs):
            leg.set_data_3d(*np.stack([base[i], platform[i]], axis=1))

    return figure, draw


def _as_picture(figure: Figure) -> None:
    """The words of a figure as they are drawn, below its axes: to lay them out takes longer than to draw a machine."""
    from matplotlib import rc_context

    axes, words = figure.axes, list(figure.texts)
    drawn = io.BytesIO()
    for ax in axes:
        ax.set_visible(False)
    with rc_context({"savefig.bbox": None}):
        figure.savefig(drawn, format="rgba", dpi=_DPI)
    for ax in axes:
        ax.set_visible(True)
    for word in words:
        word.remove()
    width = int(figure.get_figwidth() * _DPI + 1e-8)
    pixels = np.frombuffer(drawn.getvalue(), np.uint8).reshape(-1, width, 4)
    covered = np.flatnonzero((pixels != pixels[0, 0]).any(axis=(1, 2)))
    if covered.size:
        first, last = covered[[0, -1]]
        figure.figimage(pixels[first : last + 1], 0, len(pixels) - 1 - last, origin="upper", zorder=-1)


def check_path(path: Path) -> None:
    """Raises ArgumentError, MissingExtraError or OutputError, before the work, for a file that cannot be one."""
    if path.suffix.lower() not in (".gif", ".mp4"):
        raise ArgumentError(f"{path.name} is neither .gif nor .mp4; give the path one of these endings")
    if path.suffix.lower() == ".mp4":
        _ffmpeg()
    check_file(path)


def _ffmpeg() -> str:
    return str(needed("imageio_ffmpeg", "video", "an MP4 needs imageio-ffmpeg, a .gif does not").get_ffmpeg_exe())


def _writer(path: Path) -> tuple[AbstractMovieWriter, Any]:
    from matplotlib import rc_context
    from matplotlib.animation import FFMpegWriter

    from flexapod.plots.gif import GifWriter

    check_path(path)
    if path.suffix.lower() == ".gif":
        return GifWriter(fps=_FPS), nullcontext()
    writer = FFMpegWriter(fps=_FPS, codec="libx264", extra_args=["-pix_fmt", "yuv420p"])
    return writer, rc_context({"animation.ffmpeg_path": _ffmpeg()})


def _simulated(dataset: xr.Dataset, hexapod: Hexapod, base: Pose) -> tuple[_Film, Array]:
    """The displacements of a simulation and its times, s."""
    instance(dataset, xr.Dataset, "dataset", "as fx.simulate gives it")
    if "run" in dataset.dims or "displacement" not in dataset:
        raise ArgumentError("the dataset is not that of one simulation; choose one of several with .isel(run=...)")
    if dataset.time.size < 2:
        raise ArgumentError("the simulation has fewer than two instants; nothing moves")
    told = dataset.displacement.transpose("time", "output").values
    turned = dataset.base_rotation.transpose("time", "axis", "body_axis").values @ base.matrix.T
    moved = dataset.base_position.transpose("time", "axis").values - base.position
    feet = np.concatenate([moved, vector_from_rotation(turned)], axis=1)
    start = dataset.isel(time=0)  # its displacement from rest gives rest
    matrix = rotation_from_vector(told[0, 3:]).T @ start.rotation.transpose("axis", "body_axis").values
    arm = matrix @ np.asarray(dataset.attrs.get("point_m", (0.0, 0.0, 0.0)))
    pose = Pose(start.position.values - told[0, :3] - arm, matrix)
    return _Film(hexapod, pose, base, displacement_at(told, -arm), feet), dataset.time.values


def _last_periods(times: Array, displacement: Array, frames: int) -> tuple[float, float]:
    """The end of a simulation, short enough to show its main oscillation with _PER_PERIOD frames a period."""
    main = displacement[:, np.ptp(displacement[:, :3], axis=0).argmax()]
    turns = np.count_nonzero(np.diff(np.sign(main - main.mean()))) / 2
    whole = times[-1] - times[0]
    part = min(1.0, frames / _PER_PERIOD / turns) if turns > 1 else 1.0
    return float(times[-1] - part * whole), float(times[-1])


def _travel(joints: Array, pose: Pose, twists: Array) -> float:
    """Largest displacement of a joint by small displacements (n, 6) about a pose."""
    x = twists[:, None]
    return float(np.linalg.norm(x[..., :3] + np.cross(x[..., 3:], joints - pose.position), axis=-1).max())


def _around(joints: Array) -> NDArray[np.intp]:
    """Order of joints by their angle about their centre."""
    spread = joints - joints.mean(axis=0)
    first, second = np.linalg.svd(spread)[2][:2]
    return np.argsort(np.arctan2(spread @ second, spread @ first))


def _length(metres: float) -> str:
    factor, unit = metric(metres, "m")
    return f"{metres * factor:.4g} {unit}"
