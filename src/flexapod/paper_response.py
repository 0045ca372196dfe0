"""Figures 7, 8 and 9 of the paper on the machine of its Appendix A.2.

Each function writes a picture and a table into a directory and returns what it found: numbers, and in words what the
paper shows, what is the same and what differs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from flexapod import plots_response
from flexapod.excitation import harmonic
from flexapod.hexapod import load
from flexapod.linear import AXES, Linearisation, linearise
from flexapod.modal import natural_modes
from flexapod.pose import Array, Pose
from flexapod.response import transmissibility
from flexapod.steady import complex_poles, steady_response
from flexapod.stepped import stepped_sine
from flexapod.trajectory import Method, Run, integrate

POSE = (0.0, 0.0, 0.085)
AMPLITUDE = 1e-6  # m, along z
PRINTED, AWAY = 749.715, 550.136  # rad/s (corrections E8)
DURATION = 1.0  # s; the paper's is not known
YAW = AXES.index("yaw")

Progress = Callable[[float], object] | None


def figure_7(out: Path, progress: Progress = None) -> dict[str, Any]:
    """Fig. 7: the base shaken at the second distinct resonance; writes figure-7.png and .csv."""
    omega = float(natural_modes(load("mukherjee-ii"), Pose(POSE), "spin_free").omega[2])
    shaken = _shake(omega, progress)
    title = f"Fig. 7: base z, 1 µm at the third mode, {omega:.3f} rad/s (paper: {PRINTED:g})"
    _save(out, "figure-7", shaken, title)
    early, late = _largest(shaken, 0.0, 0.1), _largest(shaken, 0.9, 1.0)
    return {
        "omega_rad_s": omega,
        "omega_printed_rad_s": PRINTED,
        "omega_universal_rad_s": float(natural_modes(load("mukherjee-ii"), Pose(POSE)).omega[2]),
        "growth_of_yaw": late[YAW] / early[YAW],
        "apart_from_tangent": shaken.apart,
        "paper": f"At the second natural frequency ({PRINTED:g} 'Hz', meant in rad/s) the oscillation grows.",
        "same": f"It grows: rotation about z, the third mode's motion, is {late[YAW] / early[YAW]:.1f} times larger in "
        f"the last tenth of {DURATION:g} s than in the first, in step with the tangent's bound.",
        "different": f"The frequency: {omega:.3f} rad/s for the data as printed, {omega / PRINTED - 1:.1%} from "
        f"{PRINTED:g} (see the readings).",
    }


def figure_8(out: Path, progress: Progress = None) -> dict[str, Any]:
    """Fig. 8: the base shaken away from every resonance; writes figure-8.png and .csv."""
    shaken = _shake(AWAY, progress)
    _save(out, "figure-8", shaken, f"Fig. 8: base z, 1 µm at {AWAY:g} rad/s, away from every mode")
    early, late = _largest(shaken, 0.0, 0.5), _largest(shaken, 0.5, 1.0)
    return {
        "omega_rad_s": AWAY,
        "second_half_over_first": late / early,
        "apart_from_tangent": shaken.apart,
        "paper": f"At {AWAY:g} rad/s, away from the natural frequencies, the response is of the other nature: bounded.",
        "same": "It is bounded: forced and free vibration beat, and the largest displacement of the second half is "
        f"{(late / early).max():.2f} times that of the first half at most.",
        "different": f"Nothing that can be told: the paper's span of time is not printed, here it is {DURATION:g} s.",
    }


def figure_9(out: Path, progress: Progress = None) -> dict[str, Any]:
    """Fig. 9: response over base amplitude against frequency; writes figure-9.png and .csv."""
    hexapod, pose = load("mukherjee-ii"), Pose(POSE)
    poles = complex_poles(linearise(hexapod, pose, joint="spin_free"))
    resonances = poles.imag[:3]
    near = resonances[:, None] * (1 + np.array([-4, -2, -1, -0.5, -0.2, 0.2, 0.5, 1, 2, 4]) * 1e-3)
    omega = np.sort(np.concatenate([np.linspace(50.0, 800.0, 170), near.ravel()]))
    stepped = stepped_sine(hexapod, pose, omega, AMPLITUDE, "z", joint="spin_free", progress=progress)
    fine = np.union1d(omega, np.concatenate([np.linspace(50, 800, 4000), near.ravel(), resonances]))
    line = transmissibility(hexapod, pose, fine, joint="spin_free").absolute.sel(base="z")
    figure = plots_response.stepped_ratio(stepped, resonances, line)
    figure.suptitle(
        "Fig. 9: ratio of response to base amplitude, base z, 1 µm; dotted: the tangent's modes", fontsize=12
    )
    figure.savefig(out / "figure-9.png")
    table = stepped.ratio.to_pandas()
    table.insert(0, "status", stepped.status.values)
    table.to_csv(out / "figure-9.csv", index_label="omega_rad_s")
    apart = np.abs(stepped.response - stepped.linear) / np.abs(stepped.linear)
    found = stepped.status.values == "found"
    peaks = _peaks(omega, stepped.ratio.values)
    elsewhere = [w for w in peaks if np.abs(w / resonances - 1).min() > 1e-3]
    return {
        "frequencies": omega.size,
        "found": int(found.sum()),
        "resonances_rad_s": resonances,
        "peaks_rad_s": peaks,
        "peaks_elsewhere": len(elsewhere),
        "median_apart_from_tangent": float(np.nanmedian(apart)),
        "paper": "Up to a little above the second natural frequency, it peaks at the linear model's frequencies.",
        "same": f"It peaks at {_words(peaks)} rad/s, {len(elsewhere) or 'none'} of them more than 0.1 % away from the "
        f"tangent's {_words(resonances)} rad/s, "
        "of which the first two count as one resonance. The non-linear ratios lie on the tangent's curve: "
        f"{float(np.nanmedian(apart)):.1g} apart in the median.",
        "different": f"The second frequency by {resonances[2] / PRINTED - 1:.1%} (see the readings). "
        "At a peak itself nothing but friction limits the ratio.",
    }


def _words(frequencies: Iterable[float]) -> str:
    return ", ".join(f"{omega:.2f}" for omega in frequencies)


def _peaks(omega: Array, ratio: Array) -> list[float]:
    """Frequencies at which the ratio (n, 6) of any output stands out of its neighbours by more than a tenth."""
    inner = ratio[1:-1]
    peak = (inner > 1.1 * ratio[:-2]) & (inner > 1.1 * ratio[2:])
    return omega[1:-1][peak.any(axis=1)].tolist()


class _Shaken(NamedTuple):
    times: Array
    displacement: Array  # (m, 6)
    bound: Array  # (m, 6)
    apart: float  # from the tangent's solution, relative to the largest displacement, worst output


def _shake(omega: float, progress: Progress) -> _Shaken:
    hexapod, pose = load("mukherjee-ii"), Pose(POSE)
    times = np.linspace(0.0, DURATION, 12001)
    run = Run(hexapod, pose, base_motion=harmonic("z", AMPLITUDE, omega))
    path = integrate([run], times, joint="spin_free", method=Method(rtol=1e-10), motions=False, progress=progress)
    found = path.displacement[0]
    tangent = _FromRest(linearise(hexapod, pose, joint="spin_free"), omega)
    apart = np.abs(found - tangent.displacement(times)).max(axis=0) / np.abs(found).max(axis=0)
    return _Shaken(times, found, tangent.bound(times), float(apart.max()))


class _FromRest:
    """The tangent's motion from rest while the base moves by AMPLITUDE sin(omega t) along z, in its twelve modes.

    Relative to the base, a mode's amplitude is f (e^{i omega t} - e^{pt}) + g (e^{-i omega t} - e^{pt}) + y_0 e^{pt}:
    forced vibration, the free vibration that it sets off, and that of a platform left behind by the starting base.
    """

    def __init__(self, linear: Linearisation, omega: float) -> None:
        self.omega, self.carry = omega, AMPLITUDE * linear.carry[:, 2]
        M_inv = np.linalg.inv(linear.M)
        A = np.block([[np.zeros((6, 6)), np.eye(6)], [-M_inv @ linear.K, -M_inv @ linear.C]])
        self.pole, vectors = np.linalg.eig(A)
        self.shape = vectors[:6]
        steady = AMPLITUDE * steady_response(linear, np.array([omega])).relative[0, :, 2]
        state = np.concatenate([steady, 1j * omega * steady])  # motion Im(state e^{i omega t})
        left_behind = np.concatenate([np.zeros(6), -omega * self.carry])
        self.f, self.g, self.y_0 = np.linalg.solve(
            vectors, np.stack([state / 2j, -state.conj() / 2j, left_behind], 1)
        ).T

    def displacement(self, times: Array) -> Array:
        """(m, 6) m, rad: absolute motion."""
        turning, free = np.exp(1j * self.omega * times)[:, None], np.exp(np.outer(times, self.pole))
        modes = self.f * (turning - free) + self.g * (turning.conj() - free) + self.y_0 * free
        return (modes @ self.shape.T).real + np.sin(self.omega * times)[:, None] * self.carry

    def bound(self, times: Array) -> Array:
        """(m, 6): what the motion cannot exceed: the sum of all parts' sizes, of which the nearest mode's may beat."""
        decay = np.exp(np.outer(times, self.pole.real))
        slow = np.exp(1j * np.outer(times, self.omega - np.abs(self.pole.imag)))
        nearest = np.abs(np.abs(self.pole.imag) - self.omega)
        beat = np.where(nearest <= 1.000001 * nearest.min(), np.abs(slow - decay), 1 + decay)
        ahead = self.pole.imag > 0
        met, opposed = np.where(ahead, (np.abs(self.f), np.abs(self.g)), (np.abs(self.g), np.abs(self.f)))
        size = met * beat + opposed * (1 + decay) + np.abs(self.y_0) * decay
        return size @ np.abs(self.shape).T + np.abs(self.carry)


def _largest(shaken: _Shaken, first: float, last: float) -> Array:
    """(6,): largest displacement between two fractions of the time."""
    n = len(shaken.times)
    return np.abs(shaken.displacement[int(first * n) : int(last * n)]).max(axis=0)


def _save(out: Path, name: str, shaken: _Shaken, title: str) -> None:
    figure = plots_response.displacements(shaken.times, shaken.displacement, shaken.bound, "bound by the tangent")
    figure.suptitle(title, fontsize=12)
    figure.savefig(out / f"{name}.png")
    table = pd.DataFrame(
        shaken.displacement, index=shaken.times, columns=[f"{a}_{'rad' if i > 2 else 'm'}" for i, a in enumerate(AXES)]
    )
    table.to_csv(out / f"{name}.csv", index_label="time_s")
