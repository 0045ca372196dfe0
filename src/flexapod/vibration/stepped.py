"""Fig. 9's experiment on the complete non-linear machine: the base shaken at one frequency after the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.linalg import eigh, expm
from scipy.spatial.transform import Rotation

from flexapod.conventions import AXES, Array, Complex, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import harmonic
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.pose import Motion, Pose
from flexapod.simulation.integrator import IntegratorOptions, integrate
from flexapod.simulation.run import SimulationRun
from flexapod.vibration.harmonic import frequencies, steady_response

__all__ = ["stepped_sine"]

_SAMPLES = 64  # of a period
_HARMONICS = 6
_ITERATIONS = 12
_STALLED = 1e-5  # corrections that shrink no more below this are rounding, which a resonance of a high mode enlarges
_LARGEST = 0.1  # of a leg's length: the largest motion of a joint, by the tangent, that is tried

STATUS = ("found", "not_found", "too_large")


def stepped_sine(
    hexapod: Hexapod,
    pose: Pose,
    omega: ArrayLike,
    amplitude: float,
    axis: str,
    *,
    joint: JointModel = "universal",
    tolerance: float = 1e-7,
    progress: Callable[[float], object] | None = None,
) -> xr.Dataset:
    """Steady response of the non-linear machine to a base moved by `amplitude * sin(omega t)` along one axis.

    omega: (n,) rad/s, > 0. amplitude: m, or rad for "roll", "pitch", "yaw". At every frequency the periodic motion is
    found by shooting: a start on the tangent's steady state, one period of the full equations of motion (Eq. 35), then
    a correction of the twelve start values by the period's closing error through I - e^{AT} of the tangent, improved by
    Broyden's updates, until the correction is below `tolerance` of the motion, or shrinks no more (`closing_error` says
    where). So there is no transient that friction would have to end. All frequencies run at once on all threads.

    Dataset over omega and output (inertial axes, from the equilibrium): response, complex fundamental per base
    amplitude (`x = Re(response * amplitude * e^{i omega t})` for a base at `Re(amplitude * e^{i omega t})`); ratio, its
    modulus; linear, the tangent's response; peak, largest displacement per base amplitude; harmonics, moduli of the
    first six (the first is ratio). status (omega): "found"; "not_found" where shooting ends without a periodic motion;
    "too_large" where the tangent moves a joint by more than a tenth of a leg's length. Other values are NaN there.

    Raises: ArgumentError for frequencies that are not positive, an unknown axis or a wrong amplitude; PoseError for a
    batch of poses; SingularPoseError where no leg forces hold the pose.
    Source: Section 5, Fig. 9; C. G. Broyden, Math. Comp. 19 (1965), for the updates.
    """
    w = frequencies(omega)
    if (w == 0).any():
        raise ArgumentError("omega holds zero; a stepped sine needs frequencies > 0. Use transmissibility at zero.")
    if axis not in AXES:
        raise ArgumentError(f"axis is {axis!r}; the base moves along one of {', '.join(AXES)}")
    if not (np.isfinite(amplitude) and amplitude > 0):
        raise ArgumentError(f"amplitude is {amplitude!r}; it must be finite and > 0 (m, or rad about an axis)")
    shaker = _Shaker(hexapod, pose, linearise(hexapod, pose, joint=joint), float(amplitude), axis, joint)
    linear = shaker.linear_response(w)
    found = _shoot(shaker, w, linear, tolerance, progress)
    return _dataset(shaker, w, linear, found)


class _Found(NamedTuple):
    samples: Array  # (n, _SAMPLES, 6) displacement over one period
    status: np.ndarray
    closing: Array  # size of the last correction, relative to the motion
    periods: np.ndarray  # periods integrated


@dataclass(frozen=True)
class _Shaker:
    hexapod: Hexapod
    pose: Pose
    tangent: Linearisation
    amplitude: float
    axis: str
    joint: JointModel

    def linear_response(self, omega: Array) -> Complex:
        """(n, 6): absolute motion per base motion."""
        j = AXES.index(self.axis)
        return steady_response(self.tangent, omega).relative[:, :, j] + self.tangent.carry[:, j]

    def travel(self, response: Complex) -> Array:
        """(n,): largest motion of a platform joint by a linear response, over the leg's length."""
        arms = self.hexapod.platform_joints @ self.pose.matrix.T
        moves = response[:, None, :3] + np.cross(response[:, None, 3:], arms)
        reach = np.linalg.norm(moves, axis=-1) / self.tangent.rest.leg_length
        return self.amplitude * reach.max(axis=1)

    def one_period(self, omega: Array, state: Array) -> tuple[Array, Array, Array]:
        """Displacements (n, _SAMPLES, 6), state (n, 12) after a period, and which runs came so far."""
        shaken = [harmonic(self.axis, self.amplitude, w) for w in omega]
        runs = [
            SimulationRun(self.hexapod, self.pose, base_motion=motion, start=self._motion(z))
            for motion, z in zip(shaken, state, strict=True)
        ]
        times = (2 * np.pi / omega)[:, None] * np.arange(_SAMPLES + 1) / _SAMPLES
        path = integrate(runs, times, joint=self.joint, options=IntegratorOptions(rtol=1e-11))
        end = np.concatenate([path.displacement[:, -1], path.platform[:, -1, 12:18]], axis=1)
        return path.displacement[:, :-1], end, path.status == "complete"

    def _motion(self, state: Array) -> Motion:
        turned = Rotation.from_rotvec(state[3:6]).as_matrix() @ self.pose.matrix
        return Motion(Pose(self.pose.position + state[:3], turned), state[6:9], state[9:])


class _ModalState:
    """States as modal amplitudes: omega_m q and its rate, in which the free motion of every mode is a circle."""

    def __init__(self, tangent: Linearisation) -> None:
        square, shape = eigh(0.5 * (tangent.K + tangent.K.T), tangent.M)
        natural = np.sqrt(np.abs(square))
        stiffness, friction = (shape.T @ m @ shape for m in (tangent.K, tangent.C))
        zero = np.zeros((6, 6))
        self.rate = np.block([[zero, np.diag(natural)], [-stiffness / natural, -friction]])
        inverse = shape.T @ tangent.M
        self.from_state = np.block([[natural[:, None] * inverse, zero], [zero, inverse]])

    def closing(self, omega: Array) -> Array:
        """(n, 12, 12): the change of start values that closes a period, per closing error, by the tangent."""
        free = expm(self.rate * (2 * np.pi / omega)[:, None, None])
        return np.linalg.pinv(np.eye(12) - free, rcond=1e-15)


def _shoot(
    shaker: _Shaker, omega: Array, linear: Complex, tolerance: float, progress: Callable[[float], object] | None
) -> _Found:
    n = omega.size
    found = _Found(np.full((n, _SAMPLES, 6), np.nan), np.full(n, STATUS[1], "U9"), np.full(n, np.nan), np.zeros(n, int))
    possible = shaker.travel(linear) < _LARGEST  # false where infinite
    found.status[~possible] = STATUS[2]
    active = np.flatnonzero(possible)
    modal = _ModalState(shaker.tangent)
    to_state = np.linalg.inv(modal.from_state)
    start = shaker.amplitude * np.concatenate([linear.imag, (1j * omega[:, None] * linear).imag], axis=1)[active]
    z, gain = start @ modal.from_state.T, modal.closing(omega[active])
    step, error, last = None, None, np.full(active.size, np.inf)
    for _ in range(_ITERATIONS):
        if active.size == 0:
            break
        samples, end, complete = shaker.one_period(omega[active], z @ to_state.T)
        found.samples[active] = samples
        found.periods[active] += 1
        change = end @ modal.from_state.T - z
        if step is not None and error is not None:
            gain = _broyden(gain, step, change - error)
        error = change
        step = np.einsum("nij,nj->ni", gain, error)
        size = np.linalg.norm(step, axis=1) / np.linalg.norm(z, axis=1)
        found.closing[active] = size
        done = complete & ((size < tolerance) | ((size < _STALLED) & (size > 0.5 * last)))
        found.status[active[done]] = STATUS[0]
        keep = complete & ~done & (size < 1.0)
        z, gain, step, error, active = (z + step)[keep], gain[keep], step[keep], error[keep], active[keep]
        last = size[keep]
        if progress is not None:
            progress(1.0 - active.size / n)
    return found


def _broyden(gain: Array, step: Array, change: Array) -> Array:
    """Broyden's rank-one update of minus the inverse Jacobian, so that it explains the last step's change."""
    explained = np.einsum("nij,nj->ni", gain, change)
    back = np.einsum("ni,nij->nj", step, gain)
    scale = np.einsum("ni,ni->n", step, explained)
    usable = np.abs(scale) > 1e-14 * np.linalg.norm(step, axis=1) * np.linalg.norm(explained, axis=1)
    weight = np.where(usable, 1.0, 0.0) / np.where(usable, scale, 1.0)
    return gain - weight[:, None, None] * np.einsum("ni,nj->nij", step + explained, back)


def _dataset(shaker: _Shaker, omega: Array, linear: Complex, found: _Found) -> xr.Dataset:
    good = found.status == STATUS[0]
    samples = np.where(good[:, None, None], found.samples, np.nan)
    spectrum = 2.0 / _SAMPLES * np.fft.rfft(samples, axis=1) / shaker.amplitude
    response = 1j * spectrum[:, 1]  # the base moves as a sine
    along = ("omega", "output")
    dataset = xr.Dataset(
        {
            "response": (along, response, {"long_name": "response per base amplitude"}),
            "ratio": (along, np.abs(response), {"long_name": "ratio of response amplitude to base amplitude"}),
            "linear": (along, linear, {"long_name": "tangent's response per base amplitude"}),
            "peak": (along, np.abs(samples).max(axis=1) / shaker.amplitude, {"long_name": "peak per base amplitude"}),
            "harmonics": (("omega", "harmonic", "output"), np.abs(spectrum[:, 1 : _HARMONICS + 1])),
            "status": ("omega", found.status),
            "closing_error": ("omega", found.closing, {"long_name": "last correction relative to the motion"}),
            "periods": ("omega", found.periods, {"long_name": "periods integrated"}),
        },
        {
            "omega": ("omega", omega, {"units": "rad/s", "long_name": "base frequency"}),
            "output": list(AXES),
            "output_unit": ("output", ["m", "m", "m", "rad", "rad", "rad"]),
            "harmonic": np.arange(1, _HARMONICS + 1),
        },
        {
            "design": shaker.hexapod.name,
            "digest": shaker.hexapod.digest,
            "axis": shaker.axis,
            "amplitude": shaker.amplitude,
            "amplitude_unit": "m" if AXES.index(shaker.axis) < 3 else "rad",
            "joint": shaker.joint,
            "position_m": shaker.pose.position.tolist(),
            "rpy_rad": shaker.pose.rpy.tolist(),
        },
    )
    for name in ("response", "ratio", "linear", "peak", "harmonics"):
        dataset[name].attrs["units"] = f"output_unit/{dataset.attrs['amplitude_unit']}"
    return dataset
