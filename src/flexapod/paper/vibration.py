"""Figures 7-9: the complete machine on a shaking base, in time and by frequency, beside its tangent.

The paper prints manipulator II's pose, the base's amplitude and two frequencies, of which its data do not give the
first (corrections E8 and D): the machine's own third natural frequency takes its place. It prints no span of time.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.loading import load
from flexapod.excitation.sines import harmonic
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.modes import natural_modes
from flexapod.paper import Claim, Part, Settings, agrees
from flexapod.plots import response, simulation
from flexapod.plots.style import entitle
from flexapod.pose import Pose
from flexapod.simulation.integrator import IntegratorOptions, integrate
from flexapod.simulation.run import SimulationRun
from flexapod.vibration.frequency_response import transmissibility
from flexapod.vibration.grid import frequency_grid
from flexapod.vibration.harmonic import complex_poles, steady_response
from flexapod.vibration.stepped import stepped_sine

DESIGN, POSE = "mukherjee-ii", (0.0, 0.0, 0.085)
AMPLITUDE = 1e-6  # m, along z
PRINTED, AWAY = 749.715, 550.136  # rad/s
DURATION = 1.0  # s
YAW = AXES.index("yaw")


def draw(name: str, settings: Settings) -> Part:
    """One of Figures 7-9, with what the paper shows, what is the same and what differs."""
    return {"figure-7": _at_resonance, "figure-8": _away, "figure-9": _ratio}[name](settings)


def _at_resonance(settings: Settings) -> Part:
    omega = float(natural_modes(load(DESIGN), Pose(POSE), joint=settings.joint).omega[2])
    shaken = _shake(omega, settings.joint)
    early, late = _largest(shaken, 0.0, 0.1), _largest(shaken, 0.9, 1.0)
    growth = late[YAW] / early[YAW]
    numbers = {
        "omega_rad_s": omega,
        "omega_printed_rad_s": PRINTED,
        "growth_of_yaw": growth,
        "apart_from_tangent": shaken.apart,
    }
    claims = (
        Claim(
            "With the base moved at the second natural frequency the response grows.",
            f"Rotation about z, which is the third mode, is {growth:.1f} times larger in the last tenth of "
            f"{DURATION:g} s than in the first, within {shaken.apart:.1g} of the tangent's solution.",
            agrees(growth > 5),
        ),
        Claim(
            f'The second natural frequency is {PRINTED:g} "Hz".',
            f"{omega:.3f} rad/s, {omega / PRINTED - 1:+.1%}: the third mode, the second distinct resonance, as the "
            "first two modes are a near-repeated pair.",
            agrees(abs(omega / PRINTED - 1) < 1e-3),
            "The unit is rad/s (E8). No reading of the printed data that was tried gives the number exactly; it is not "
            "tuned to. With the upper legs' mass centre of manipulator I it comes within 0.1 %: see Readings.",
        ),
        _OPEN_SPAN,
    )
    title = f"Fig. 7: base z, 1 µm at the third mode, {omega:.3f} rad/s (paper: {PRINTED:g})"
    caption = f"Displacement from equilibrium of the complete machine, base moved along z, 1 µm at {omega:.3f} rad/s."
    return _in_time(7, shaken, title, caption, numbers, claims)


_OPEN_SPAN = Claim(
    "The amplitudes drawn in the six panels.",
    f"Drawn over {DURATION:g} s from rest.",
    "open",
    "The paper's span of time and scales cannot be read from its text.",
)


def _away(settings: Settings) -> Part:
    shaken = _shake(AWAY, settings.joint)
    ratio = _largest(shaken, 0.5, 1.0) / _largest(shaken, 0.0, 0.5)
    numbers = {"omega_rad_s": AWAY, "second_half_over_first": ratio, "apart_from_tangent": shaken.apart}
    claims = (
        Claim(
            f"At {AWAY:g}, away from the natural frequencies, the response is of another nature.",
            "Bounded: forced and free vibration beat, and the largest displacement of the second half is "
            f"{ratio.max():.2f} times that of the first at most.",
            agrees(bool(ratio.max() < 1.2)),
        ),
        _OPEN_SPAN,
    )
    title = f"Fig. 8: base z, 1 µm at {AWAY:g} rad/s, away from every mode"
    caption = f"Displacement from equilibrium of the complete machine, base moved along z, 1 µm at {AWAY:g} rad/s."
    return _in_time(8, shaken, title, caption, numbers, claims)


def _ratio(settings: Settings) -> Part:
    hexapod, pose, joint = load(DESIGN), Pose(POSE), settings.joint
    resonances = complex_poles(linearise(hexapod, pose, joint=joint)).imag[:3]
    near = resonances[:, None] * (1 + np.array([-4, -2, -1, -0.5, -0.2, 0.2, 0.5, 1, 2, 4]) * 1e-3)
    omega = np.sort(np.concatenate([np.linspace(50.0, 800.0, 170), near.ravel()]))
    stepped = stepped_sine(hexapod, pose, omega=omega, amplitude=AMPLITUDE, axis="z", joint=joint)
    fine = frequency_grid(hexapod, pose, omega_min=50.0, omega_max=800.0, samples=4000, joint=joint)
    line = transmissibility(hexapod, pose, omega=fine, joint=joint).absolute.sel(base="z")
    figure = response.stepped_ratio(stepped, resonances, line)
    title = "Fig. 9: ratio of response to base amplitude, base z, 1 µm"
    entitle(figure, f"{title}; dotted: the tangent's modes")
    apart = float(np.nanmedian(np.abs(stepped.response - stepped.linear) / np.abs(stepped.linear)))
    peaks = _peaks(omega, stepped.ratio.values)
    elsewhere = [w for w in peaks if np.abs(w / resonances - 1).min() > 1e-3]
    numbers = {
        "frequencies": omega.size,
        "found": int((stepped.status == "found").sum()),
        "resonances_rad_s": resonances,
        "peaks_rad_s": peaks,
        "peaks_elsewhere": len(elsewhere),
        "median_apart_from_tangent": apart,
    }
    caption = (
        f"Ratio of response to base amplitude at {omega.size} frequencies, base moved along z, 1 µm. Dots: the "
        "complete machine; line: the tangent; dotted: its modes, of which the first two count as one resonance."
    )
    claims = (
        Claim(
            "Up to a little above the second natural frequency, the machine resonates where the linear model says.",
            f"Peaks at {_words(peaks)} rad/s, {len(elsewhere) or 'none'} of them more than 0.1 % away from the "
            f"tangent's {_words(resonances)} rad/s.",
            agrees(len(peaks) >= 2 and not elsewhere),
        ),
        Claim(
            "The ratio makes sense as long as the base's amplitude is small: then the response is linear in it.",
            f"At 1 µm the non-linear ratios lie on the tangent's curve, {apart:.1g} apart in the median.",
            agrees(apart < 1e-3),
        ),
    )
    return Part("figure-9", title, figure, caption, numbers, claims, _ratio_table(stepped))


def _ratio_table(stepped: xr.Dataset) -> pd.DataFrame:
    table = stepped.ratio.to_pandas()
    table.insert(0, "status", stepped.status.values)
    return table.rename_axis("omega_rad_s")


def _words(frequencies: Iterable[float]) -> str:
    return ", ".join(f"{omega:.2f}" for omega in frequencies)


def _peaks(omega: Array, ratio: Array) -> list[float]:
    """Frequencies at which the ratio (n, 6) of any output stands out of its neighbours by more than a tenth."""
    inner = ratio[1:-1]
    peak = (inner > 1.1 * ratio[:-2]) & (inner > 1.1 * ratio[2:])
    return [float(w) for w in omega[1:-1][peak.any(axis=1)]]


class _Shaken(NamedTuple):
    times: Array
    displacement: Array  # (m, 6)
    bound: Array  # (m, 6)
    apart: float  # from the tangent's solution, relative to the largest displacement, worst output


def _shake(omega: float, joint: JointModel) -> _Shaken:
    hexapod, pose = load(DESIGN), Pose(POSE)
    times = np.linspace(0.0, DURATION, 12001)
    run = SimulationRun(hexapod, pose, base_motion=harmonic("z", AMPLITUDE, omega))
    path = integrate([run], times, joint=joint, options=IntegratorOptions(rtol=1e-10), motions=False)
    found = path.displacement[0]
    tangent = _FromRest(linearise(hexapod, pose, joint=joint), omega)
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


def _in_time(
    number: int, shaken: _Shaken, title: str, caption: str, numbers: dict[str, Any], claims: tuple[Claim, ...]
) -> Part:
    figure = simulation.displacements(
        shaken.times, shaken.displacement, bound=shaken.bound, bound_name="bound by the tangent"
    )
    entitle(figure, title)
    columns = [f"{axis}_{'rad' if i > 2 else 'm'}" for i, axis in enumerate(AXES)]
    table = pd.DataFrame(shaken.displacement, index=pd.Index(shaken.times, name="time_s"), columns=columns)
    return Part(f"figure-{number}", title, figure, caption, numbers, claims, table)
