"""Vibration under control by random motion of the base and random loads: spectra and RMS values."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.control.closed_loop_poles import assess, instability_message
from flexapod.control.controlled_response import response_origin
from flexapod.control.linear_controller import ControlLaw, Controller, controller_for
from flexapod.control.loop_response import LoopResponse, loop_response, lossy
from flexapod.control.plant import Plant, poles
from flexapod.conventions import Array, Complex, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, UnstableError
from flexapod.excitation.spectra import Quantity
from flexapod.mechanics.inputs import ZERO, PointLike, as_hexapod, as_point, single_pose
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.point_motion import shift
from flexapod.pose import PoseLike
from flexapod.vibration.random_sources import Answers, RandomLoad, Shaking, Source
from flexapod.vibration.random_vibration import stationary
from flexapod.vibration.source_spectrum import Density


def controlled_random_response(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    controller: ControlLaw,
    psd: Density | None = None,
    loads: RandomLoad | Sequence[RandomLoad] = (),
    omega: ArrayLike | None = None,
    frequency: ArrayLike | None = None,
    of: Quantity = "acceleration",
    axis: str | None = None,
    point: PointLike = ZERO,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> xr.Dataset:
    """Compute spectra and RMS values of a controlled machine, of random motion of the base and random loads.

    Loss factors of the design are exact.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    controller : ControlLaw
        A PID, ForceFeedback or VelocityFeedback, or a Controller. A sampled one acts with its hold.
    psd : Spectrum, dict of str to Spectrum, array_like or callable, optional
        One-sided power spectral density of the base's motion, as `flexapod.random_response` takes it. A base at rest by
        default.
    loads : RandomLoad or sequence of RandomLoad, optional
        Random forces and moments at points of the platform, independent of each other and of the base.
    omega, frequency : array_like, optional
        Frequencies of a table, (n,) rad/s or Hz, ascending and > 0. The first and the last bound the band.
    of : {"acceleration", "velocity", "displacement"}, optional
        What a table or function is the density of. A Spectrum says it itself.
    axis : {"x", "y", "z", "roll", "pitch", "yaw"}, optional
        Axis of the base that moves, where `psd` is of one axis.
    point : array_like or str, optional
        Output point, (3,) m, in the platform's frame, or the name of a point of the design.
    base : Pose or array_like, shape (6,), optional
        Pose of the base in the inertial frame. The identity by default.
    force, moment : array_like, shape (3,), optional
        Static force (N) and moment (N m) on the platform at its reference point, in its frame.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.

    Returns
    -------
    xarray.Dataset
        What `flexapod.random_response` gives, where leg_force (N) is that of springs and actuators together, and
        actuator_force (N) over `leg`, that of the actuators alone: what they must be able to give.

    Raises
    ------
    ArgumentError
        If there is neither `psd` nor a load, `psd` cannot be a spectral density, a spectrum reaches beyond pi/dt of a
        sampled controller, or a motion in the band has no damping.
    UnstableError
        If the loop is not stable.
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.

    See Also
    --------
    flexapod.random_response : the same without control.
    controlled_transmissibility : the frequency response behind it.

    Notes
    -----
    The densities are those of the hexapod linearised with exact derivatives, in closed loop; force limits and noise are
    left out, which `simulate_control` has. Of a sampled controller the motion at the frequencies of the excitation is
    told; what the held forces add beyond pi/dt is left out.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> floor = {"psd": fx.vc_curve("VC-A"), "axis": "z"}
    >>> law = fx.control.VelocityFeedback(300.0)
    >>> found = fx.control.controlled_random_response(hexapod, controller=law, **floor)
    >>> passive = fx.random_response(hexapod, **floor)
    >>> ratio = (found.rms_acceleration / passive.rms_acceleration).sel(output="z")
    >>> round(float(ratio), 2), round(float(found.rms_actuator_force[0]), 3)
    (0.39, 0.036)
    """
    pose = single_pose(as_hexapod(hexapod), pose)
    to_point = shift(pose, as_point(hexapod, point))
    plant = Plant(linearise(hexapod, pose, base=base, force=force, moment=moment, joint=joint))
    law = controller_for(plant.linear, controller)
    loop = assess(plant, law)
    if not loop.stable:
        raise UnstableError(f"The random response never becomes stationary: {instability_message(loop, plant)}")
    whole = lossy(plant)
    found = poles(whole, law)
    if law.dt is not None:
        found = found[np.abs(found.imag) < 0.999 * np.pi / law.dt]  # what alternates from sample to sample is no mode
    sources = Shaking(psd, loads, omega, frequency, of, axis).sources(hexapod, pose, found)
    for source in sources:
        _check_sampling(source, law)
    origin = response_origin(hexapod, pose, point, plant, law)
    return stationary(sources, found, lambda w: _answers(loop_response(whole, w, law), to_point), origin)


def _answers(found: LoopResponse, to_point: Array) -> Answers:
    """The loop's answers to the base, whose columns come first, and to wrenches."""

    def amplitudes(of: slice) -> dict[str, Complex]:
        return {
            "displacement": to_point @ found.absolute[..., of],
            "relative": to_point @ found.relative[..., of],
            "leg_force": found.leg_force[..., of],
            "actuator_force": found.force[..., of],
        }

    return Answers(amplitudes(slice(6)), amplitudes(slice(6, 12)))


def _check_sampling(source: Source, law: Controller) -> None:
    """Faster shaking would be seen as slow one by the samples."""
    top = float(source.spectrum.grid[-1])
    if law.dt is not None and top > np.pi / law.dt:
        raise ArgumentError(
            f"the spectrum of {source.name} reaches {top:.5g} rad/s; what is above {np.pi / law.dt:.5g} rad/s (pi/dt) "
            f"is seen as slower motion by a controller sampled every {law.dt:.5g} s. Sample at least every "
            f"{np.pi / top:.4g} s (dt, on the command line --dt), or end the spectrum below."
        )
