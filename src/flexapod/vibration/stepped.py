"""The steady response of the complete non-linear machine to a base shaken at one frequency after the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.checks import one_of, positive
from flexapod.conventions import AXES, TWO_PI, Array, Complex, JointModel, in_mixed_units, in_unit, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError
from flexapod.excitation.sines import harmonic
from flexapod.mechanics.cautions import response_attributes
from flexapod.mechanics.inputs import ZERO, PointLike, as_point, point_attributes, single_pose
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.point_motion import displacement_at, shift
from flexapod.mechanics.symmetric_pencil import pencil_modes
from flexapod.pose import Motion, Pose, PoseLike, unpack
from flexapod.progress import ProgressLike, with_progress
from flexapod.rotations import rotation_from_vector
from flexapod.simulation.integrator import IntegratorOptions, integrate
from flexapod.simulation.run import SimulationRun
from flexapod.vibration.grid import asked, grid_around
from flexapod.vibration.harmonic import complex_poles, losses, steady_response

_STEPS = 100  # of the default grid, beside the points around resonances
_SAMPLES = 64  # of a period
_HARMONICS = 6
_ITERATIONS = 12
_STALLED = 1e-5  # corrections that shrink no more below this are rounding, which a resonance of a high mode enlarges
_SLOWEST = 1e-9  # of the highest frequency: a period with more oscillations in it cannot be followed
_LARGEST = 0.1  # of a leg's length: the largest motion of a joint, by the tangent, that is tried

STATUS = ("found", "not_found", "too_large")


@with_progress("stepped sine")
def stepped_sine(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    axis: str,
    amplitude: float,
    omega: ArrayLike | None = None,
    frequency: ArrayLike | None = None,
    point: PointLike = ZERO,
    joint: JointModel = "universal",
    tolerance: float = 1e-7,
    progress: ProgressLike = None,
) -> xr.Dataset:
    """Compute the steady response of the non-linear machine to a base shaken at one frequency after the other.

    The base moves by ``amplitude * sin(omega t)`` along one axis.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, optional
        Pose of the platform at rest, a Pose or x, y, z (m), roll, pitch, yaw (rad); the home pose by default.
    axis : {"x", "y", "z", "roll", "pitch", "yaw"}
        Axis along or about which the base moves.
    amplitude : float
        Amplitude of the base, m, or rad for a rotation.
    omega : array_like, optional
        Frequencies, (n,) rad/s, > 0; by default the grid of `vibration.frequency_grid` with 100 samples.
    frequency : array_like, optional
        The same in Hz, in place of `omega`.
    point : array_like or str, optional
        Output point, (3,) m, in the platform's frame, or the name of a point of the design.
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.
    tolerance : float, optional
        Largest last correction of a periodic motion, relative to the motion.
    progress : callable or False, optional
        Called with the share done, 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

    Returns
    -------
    xarray.Dataset
        Over `omega` (rad/s) and `output` (x, y, z, roll, pitch, yaw of the output point; from the equilibrium, inertial
        axes):

        - response: complex fundamental per base amplitude, x = Re(response * amplitude * exp(i omega t)) for a base at
          Re(amplitude * exp(i omega t))
        - ratio: its modulus
        - linear: response of the machine linearised at rest
        - peak: largest displacement per base amplitude
        - harmonics (omega, harmonic, output): moduli of the first six harmonics, per base amplitude
        - status (omega): "found"; "not_found" where no periodic motion was found; "too_large" where the linear response
          moves a joint by more than a tenth of a leg's length. The other values are NaN there.
        - closing_error (omega): last correction, relative to the motion; periods (omega): periods integrated

    Raises
    ------
    ArgumentError
        If a frequency or the amplitude is not > 0, or the axis is unknown.
    PoseError
        If `pose` is not one pose that the legs can take.
    SingularPoseError
        If no leg forces hold the pose.

    See Also
    --------
    transmissibility : the linear response, at once for all axes.

    Notes
    -----
    It is the experiment of Fig. 9 of [1]_. The periodic motion at each frequency is found by shooting: from the linear
    steady state, one period of the full equations of motion (Eq. 35) is integrated, and the twelve start values are
    corrected by the period's closing error through I - exp(A T) of the linearised machine, improved by Broyden's
    updates [2]_, until the correction is below `tolerance` or shrinks no more. So there is no transient for friction to
    end. All frequencies run at once on all threads. Loss factors of the design act as the viscous friction that takes
    as much at the frequency of the base (see `mechanics.viscous_equivalent`), and exactly in `linear`.

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration (2007).
    .. [2] C. G. Broyden, "A class of methods for solving nonlinear simultaneous equations", Mathematics of Computation
       19 (1965).

    Examples
    --------
    >>> response = fx.stepped_sine(fx.load("cubic-isolator"), axis="z", amplitude=1e-6, omega=[20.0, 40.0])
    >>> response.status.values.tolist()
    ['found', 'found']
    """
    one_of(axis, "axis", AXES)
    positive(amplitude, "amplitude", unit_of(axis))
    pose = single_pose(hexapod, pose)
    tangent = linearise(hexapod, pose, joint=joint)
    eta = losses(hexapod, tangent, None)
    w, poles = asked(omega, frequency), complex_poles(tangent, eta)
    if w is None:
        w = grid_around(poles, samples=_STEPS)
    if (w == 0).any():
        raise ArgumentError("omega holds zero; a stepped sine needs frequencies > 0. Use transmissibility at zero.")
    if w.min() < _SLOWEST * np.abs(poles).max():
        raise ArgumentError(
            f"omega holds {w.min():.6g} rad/s; a stepped sine needs at least {_SLOWEST:g} of the highest natural "
            f"frequency, {np.abs(poles).max():.6g} rad/s, to follow a period. Use transmissibility below that."
        )
    shaker = _Shaker(hexapod, pose, tangent, eta, float(amplitude), axis, joint)
    linear = shaker.linear_response(w)
    positive(tolerance, "tolerance")
    found = _shoot(shaker, w, linear, tolerance, progress or None)
    arm = pose.matrix @ as_point(hexapod, point)
    told = _dataset(shaker, w, linear @ shift(pose, as_point(hexapod, point)).T, _at_point(found, arm))
    return told.assign_attrs(response_attributes(tangent) | point_attributes(hexapod, point))


def _at_point(found: _Found, arm: Array) -> _Found:
    """The same of a point at an arm (3,) m from the reference point, inertial axes at rest."""
    return found._replace(samples=displacement_at(found.samples, arm))


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
    losses: Array
    amplitude: float
    axis: str
    joint: JointModel

    def linear_response(self, omega: Array) -> Complex:
        """(n, 6): absolute motion per base motion."""
        j = AXES.index(self.axis)
        return steady_response(self.tangent, omega, self.losses).absolute[:, :, j]

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
            SimulationRun(self.hexapod, self.pose, base_motion=motion, start=self._motion(z), loss_frequency=w)
            for motion, z, w in zip(shaken, state, omega, strict=True)
        ]
        times = (TWO_PI / omega)[:, None] * np.arange(_SAMPLES + 1) / _SAMPLES
        path = integrate(runs, times, joint=self.joint, options=IntegratorOptions(rtol=1e-11))
        parts = unpack(path.platform[:, -1])
        end = np.concatenate([path.displacement[:, -1], parts["velocity"], parts["angular_velocity"]], axis=1)
        return path.displacement[:, :-1], end, path.status == "complete"

    def _motion(self, state: Array) -> Motion:
        turned = rotation_from_vector(state[3:6]) @ self.pose.matrix
        return Motion(Pose(self.pose.position + state[:3], turned), state[6:9], state[9:])


class _ModalState:
    """States as modal amplitudes: omega_m q and its rate, in which the free motion of every mode is a circle."""

    def __init__(self, tangent: Linearisation, losses: Array) -> None:
        square, shape = pencil_modes(0.5 * (tangent.K + tangent.K.T), tangent.M)
        natural = np.sqrt(np.abs(square))
        stiffness, friction = (shape.T @ m @ shape for m in (tangent.K, tangent.C))
        zero = np.zeros((6, 6))
        self.rate = np.block([[zero, np.diag(natural)], [-stiffness / natural, -friction]])
        stretched = shape.T @ tangent.springs
        self.lost = np.zeros((12, 12))  # what losses add to the rates, times the frequency
        self.lost[6:, 6:] = -(stretched * losses) @ stretched.T
        inverse = shape.T @ tangent.M
        self.from_state = np.block([[natural[:, None] * inverse, zero], [zero, inverse]])

    def closing(self, omega: Array) -> Array:
        """(n, 12, 12): the change of start values that closes a period, per closing error, by the tangent."""
        from scipy.linalg import expm

        w = omega[:, None, None]
        free = expm((self.rate + self.lost / w) * (TWO_PI / w))
        return np.linalg.pinv(np.eye(12) - free, rcond=1e-15)


def _shoot(
    shaker: _Shaker, omega: Array, linear: Complex, tolerance: float, progress: Callable[[float], object] | None
) -> _Found:
    n = omega.size
    found = _Found(np.full((n, _SAMPLES, 6), np.nan), np.full(n, STATUS[1], "U9"), np.full(n, np.nan), np.zeros(n, int))
    possible = shaker.travel(linear) < _LARGEST  # false where infinite
    found.status[~possible] = STATUS[2]
    active = np.flatnonzero(possible)
    modal = _ModalState(shaker.tangent, shaker.losses)
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
    per = partial(in_mixed_units, f"output_unit/{unit_of(shaker.axis)}")
    return xr.Dataset(
        {
            "response": (along, response, per("response per base amplitude")),
            "ratio": (along, np.abs(response), per("ratio of response amplitude to base amplitude")),
            "linear": (along, linear, per("tangent's response per base amplitude")),
            "peak": (along, np.abs(samples).max(axis=1) / shaker.amplitude, per("peak per base amplitude")),
            "harmonics": (("omega", "harmonic", "output"), np.abs(spectrum[:, 1 : _HARMONICS + 1]), per("")),
            "status": ("omega", found.status),
            "closing_error": ("omega", found.closing, in_unit("1", "last correction relative to the motion")),
            "periods": ("omega", found.periods, in_unit("1", "periods integrated")),
        },
        {
            "omega": ("omega", omega, in_unit("rad/s", "base frequency")),
            "output": list(AXES),
            "output_unit": ("output", [unit_of(axis) for axis in AXES]),
            "harmonic": np.arange(1, _HARMONICS + 1),
        },
        {
            **origin(shaker.hexapod),
            "axis": shaker.axis,
            "amplitude": shaker.amplitude,
            "amplitude_unit": unit_of(shaker.axis),
            "joint": shaker.joint,
            "position_m": shaker.pose.position.tolist(),
            "rpy_rad": shaker.pose.rpy.tolist(),
        },
    )
