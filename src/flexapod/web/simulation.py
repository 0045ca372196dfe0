"""The job of a time simulation: base motion from the form, rows of results as float32, and how to play them."""

from __future__ import annotations

import queue
import threading
import warnings
from collections.abc import Callable, Generator, Iterator
from typing import Any

import numpy as np

from flexapod.conventions import AXES, TWO_PI, Array
from flexapod.errors import SimulationError
from flexapod.excitation.excitation import Excitation
from flexapod.excitation.piecewise import half_sine_shock, smooth_step
from flexapod.excitation.recordings import parse_time_series
from flexapod.excitation.sines import harmonic, sine_sweep
from flexapod.mechanics.modes import natural_modes
from flexapod.rotations import vector_from_rotation
from flexapod.web import requests
from flexapod.web.answers import Message, SimulationRun
from flexapod.web.encode import float32
from flexapod.web.geometry import farthest

KINDS = ("harmonic", "sweep", "shock", "step", "csv")
ROWS = 4000  #: instants of one simulation that are sent
MOST_PERIODS = 2e5  #: of the highest mode: bounds the computing
PLAYED = 8.0  #: duration of a playback, s
RAMP = 0.1  #: share of the duration over which a sine rises
RISING = "The motion rises over the first {:.4g} s: peaks there are smaller than asked."
DRAWN = 0.12  #: greatest displacement drawn, as a share of the platform's size


def simulation(spec: dict[str, Any]) -> Iterator[Message]:
    """Simulate the non-linear machine on its moving base, from rest.

    Rows: time, displacements of platform and base from rest (m, rotation vector), leg lengths, leg forces.
    """
    from flexapod.simulation.time_simulation import simulate  # loads xarray, which the server does without

    question = requests.question(spec)
    duration = requests.number(spec, "duration", 1.0, 1e-6, 1e4)
    highest = float(natural_modes(question.hexapod, question.pose, joint=question.joint).omega[-1])
    if duration * highest > TWO_PI * MOST_PERIODS:
        most = TWO_PI * MOST_PERIODS / highest
        raise requests.RequestError(
            f"duration is {duration:g} s; at most {most:.3g} s are simulated here. Use the library."
        )
    motion = _motion(spec, duration)

    def compute(progress: Callable[[float], object]) -> tuple[Any, list[str]]:
        options = {"joint": question.joint, "samples": ROWS, "progress": progress}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                data = simulate(question.hexapod, question.pose, base_motion=motion, duration=duration, **options)
                stopped = []
            except SimulationError as error:
                data, stopped = error.result, [str(error)]
        return data, stopped + [str(w.message) for w in caught]

    data, words = yield from _with_progress(compute)
    if data is None or data.sizes["time"] < 2:
        raise requests.RequestError(" ".join(words) or "the simulation ended at once")
    rows = _rows(data)
    steps = f"{rows[-1, 0]:.4g} s in {data.attrs['steps']} steps." if "steps" in data.attrs else ""
    rise = RISING.format(RAMP * duration) if spec.get("kind", KINDS[0]) in ("harmonic", "sweep") else ""
    told = [word[0].upper() + word[1:] for word in (*words, steps, rise) if word]
    yield _run(question, rows, " ".join(told)), float32(rows)


def _with_progress(compute: Callable[[Callable[[float], object]], Any]) -> Generator[Message, None, Any]:
    """Compute in a thread, and yield its progress."""
    news: queue.Queue[tuple[str, Any]] = queue.Queue()

    def work() -> None:
        try:
            result = compute(lambda fraction: news.put(("fraction", fraction)))
            news.put(("fraction", 1.0))  # a very short simulation ends before its first report
            news.put(("result", result))
        except Exception as error:  # raised again below
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
    """The base motion of a form. Sines, which do not start from rest, rise over a share of the duration."""
    kind = requests.choice(spec, "kind", KINDS)
    if kind == "csv":
        text = spec.get("csv")
        if not isinstance(text, str):
            raise requests.RequestError("csv must be the text of a CSV file")
        return parse_time_series(text)
    axis = requests.choice(spec, "axis", AXES)
    if kind == "shock":
        return half_sine_shock(
            axis, requests.number(spec, "peak", 10.0, -1e6, 1e6), requests.number(spec, "pulse", 0.011, 1e-6, 1e3)
        )
    amplitude = requests.number(spec, "amplitude", 1e-3, -1e3, 1e3)
    if kind == "step":
        return smooth_step(axis, amplitude, requests.number(spec, "pulse", 0.011, 1e-6, 1e3))
    omega = TWO_PI * requests.number(spec, "frequency", 5.0, 1e-6, 1e6)
    ramp = RAMP * duration
    if kind == "sweep":
        end = TWO_PI * requests.number(spec, "end", 50.0, 1e-6, 1e6)
        return sine_sweep(axis, amplitude, omega, end, duration).ramped(ramp)
    return harmonic(axis, amplitude, omega).ramped(ramp)


def _rows(data: Any) -> Array:
    """Time, displacements of platform and base, leg lengths and forces, (n, 25)."""
    turned = vector_from_rotation(data["base_rotation"].to_numpy())
    parts = [data["displacement"], data["base_position"], turned, data["leg_length"], data["leg_force"]]
    return np.concatenate([data["time"].to_numpy()[:, None], *(np.asarray(part) for part in parts)], axis=1)


def _run(question: requests.Question, rows: Array, words: str) -> SimulationRun:
    """How to play the rows: speed, factor of displacements, and remarks."""
    size = farthest(question.hexapod.platform_joints)
    moved, turned = (np.linalg.norm(rows[:, [[a, a + 1, a + 2] for a in at]], axis=2) for at in ((1, 7), (4, 10)))
    largest = max(float((moved + turned * size).max()), np.finfo(float).tiny)
    return {
        "type": "run",
        "count": len(rows),
        "speed": rows[-1, 0] / PLAYED,
        "factor": max(1.0, DRAWN * size / largest) if largest < DRAWN * size else 1.0,
        "words": words,
    }
