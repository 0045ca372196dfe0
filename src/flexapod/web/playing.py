"""Time simulations for the page: a base motion from its form, the trajectory as float32 rows, and how to play it."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import flexapod as fx
from flexapod.excitation import Excitation, half_sine_shock, harmonic, sine_sweep, smooth_step
from flexapod.pose import Array
from flexapod.trajectory import Run, integrate
from flexapod.web import asking
from flexapod.web.encode import float32

KINDS = ("harmonic", "sweep", "shock", "step", "csv")
ROWS = 4000  #: instants of one simulation that the page gets
MOST_PERIODS = 2e5  #: of the highest mode, about a minute of computing
PLAYED = 8.0  #: seconds that a playback takes
DRAWN = 0.12  #: greatest displacement drawn, as a part of the platform's size

Message = tuple[dict[str, Any], bytes]


def simulation(spec: dict[str, Any]) -> Iterator[Message]:
    """One run of the complete machine on its moving base, from rest.

    Rows: time, platform and base displacement from rest (m and rotation vector), leg lengths, leg forces.
    """
    question = asking.question(spec)
    duration = asking.number(spec, "duration", 1.0, 1e-6, 1e4)
    highest = float(fx.natural_modes(question.hexapod, question.pose, question.joint).omega[-1])
    if duration * highest > 2 * np.pi * MOST_PERIODS:
        most = 2 * np.pi * MOST_PERIODS / highest
        raise asking.AskingError(f"duration is {duration:g} s; at most {most:.3g} s are simulated here. Use the library.")
    times = np.linspace(0.0, duration, ROWS)
    run = Run(question.hexapod, question.pose, base_motion=_motion(spec, duration))

    def compute(progress: Callable[[float], object]) -> Any:
        return integrate([run], times, joint=question.joint, progress=progress)

    found = yield from _with_progress(compute)
    rows = _rows(question, found, times)
    status = str(found.status[0])
    rows = rows[np.isfinite(rows).all(axis=1)]
    if not len(rows):
        raise asking.AskingError(f"the simulation ended at once ({status.replace('_', ' ')})")
    yield _head(question, rows, status, int(found.steps[0, 0])), float32(rows)


def _with_progress(compute: Callable[[Callable[[float], object]], Any]) -> Iterator[Message]:
    """Compute in a thread, and report how far it is."""
    news: queue.Queue[tuple[str, Any]] = queue.Queue()

    def work() -> None:
        try:
            news.put(("result", compute(lambda fraction: news.put(("fraction", fraction)))))
        except Exception as error:  # raised again below, in the job
            news.put(("error", error))

    threading.Thread(target=work, daemon=True).start()
    while True:
        what, value = news.get()
        if what == "result":
            return value
        if what == "error":
            raise value
        yield {"type": "progress", "done": value, "total": 1.0, "seconds": 0.0}, b""


def _motion(spec: dict[str, Any], duration: float) -> Excitation:
    """The base motion that a form describes; what never starts from rest rises over a tenth of the duration."""
    kind = asking.choice(spec, "kind", KINDS)
    if kind == "csv":
        return _recorded(spec.get("csv"))
    axis = asking.choice(spec, "axis", asking.COORDINATES)
    if kind == "shock":
        return half_sine_shock(
            axis, asking.number(spec, "peak", 10.0, -1e6, 1e6), asking.number(spec, "pulse", 0.011, 1e-6, 1e3)
        )
    amplitude = asking.number(spec, "amplitude", 1e-3, -1e3, 1e3)
    if kind == "step":
        return smooth_step(axis, amplitude, asking.number(spec, "pulse", 0.011, 1e-6, 1e3))
    omega = 2 * np.pi * asking.number(spec, "frequency", 5.0, 1e-6, 1e6)
    ramp = 0.1 * duration
    if kind == "sweep":
        end = 2 * np.pi * asking.number(spec, "end", 50.0, 1e-6, 1e6)
        return sine_sweep(axis, amplitude, omega, end, duration).ramped(ramp)
    return harmonic(axis, amplitude, omega).ramped(ramp)


def _recorded(text: Any) -> Excitation:
    """A base motion from the text of a CSV file: a line of names (t, x, y, z, roll, pitch, yaw; s, m, rad), then rows."""
    if not isinstance(text, str) or not text.strip():
        raise asking.AskingError("the CSV file is empty; it needs a line of names and rows of numbers")
    lines = [line for line in text.lstrip("\ufeff").splitlines() if line.strip() and not line.startswith("#")]
    names = [name.strip().lower() for name in lines[0].split(",")]
    if names[0] not in ("t", "time") or not names[1:] or not set(names[1:]) <= set(asking.COORDINATES):
        raise asking.AskingError(
            f"the first line of the CSV file is {lines[0][:80]!r}; it must name the columns: t and some of x, y, z, "
            "roll, pitch, yaw (s, m, rad), with commas between"
        )
    rows = [_numbers(line, number, len(names)) for number, line in enumerate(lines[1:], 2)]
    if len(rows) < 8:
        raise asking.AskingError(f"the CSV file has {len(rows)} rows of numbers; at least 8 are needed")
    table = np.array(rows)
    return fx.time_series(table[:, 0], table[:, 1:], names[1:])


def _numbers(line: str, number: int, count: int) -> list[float]:
    try:
        values = [float(cell) for cell in line.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not np.isfinite(values).all():
        raise asking.AskingError(f"row {number} of the CSV file is {line[:80]!r}; it must be {count} finite numbers")
    return values


def _rows(question: asking.Question, found: Any, times: Array) -> Array:
    """Time, displacements, leg lengths and forces of the one run, (m, 25)."""
    from scipy.spatial.transform import Rotation

    hexapod = question.hexapod
    platform, base = found.platform[0], found.base[0]
    good = np.isfinite(platform).all(axis=1) & np.isfinite(base).all(axis=1)
    turned = np.full((len(times), 3), np.nan)
    turned[good] = Rotation.from_matrix(base[good, 3:12].reshape(-1, 3, 3)).as_rotvec()
    length = np.full((len(times), 6), np.nan)
    poses = [fx.Pose(rows[good, :3], rows[good, 3:12].reshape(-1, 3, 3)) for rows in (platform, base)]
    length[good] = fx.inverse_kinematics(hexapod, *poses)
    force = hexapod.legs.stiffness * (found.unstretched_length[0] - length)
    return np.concatenate([times[:, None], found.displacement[0], base[:, :3], turned, length, force], axis=1)


def _head(question: asking.Question, rows: Array, status: str, steps: int) -> dict[str, Any]:
    """How to play the rows: how fast, how much larger, and what to say of them."""
    hexapod = question.hexapod
    size = float(np.linalg.norm(hexapod.platform_joints, axis=1).max())
    reach = [np.linalg.norm(rows[:, a : a + 3], axis=1) + np.linalg.norm(rows[:, a + 3 : a + 6], axis=1) * size for a in (1, 7)]
    largest = max(float(np.max(reach)), np.finfo(float).tiny)
    words = f"{rows[-1, 0]:.4g} s in {steps} steps"
    if status != "complete":
        words = f"Stopped at {rows[-1, 0]:.4g} s: {status.replace('_', ' ')}. {words}"
    return {
        "type": "run",
        "count": len(rows),
        "speed": rows[-1, 0] / PLAYED,
        "factor": max(1.0, DRAWN * size / largest) if largest < DRAWN * size else 1.0,
        "words": words,
    }
