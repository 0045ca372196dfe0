"""Time simulation of the complete machine on its moving base, as an xarray Dataset."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SimulationError
from flexapod.excitation.excitation import Excitation
from flexapod.mechanics.inputs import ZERO, PointLike
from flexapod.pose import Pose, unpack
from flexapod.progress import ProgressLike, with_progress
from flexapod.simulation.batch import simulate_many
from flexapod.simulation.integrator import Method
from flexapod.simulation.run import Load, SimulationRun, Start

REASONS = {
    "singular": "det H changes sign there, and no leg forces hold the platform. Start nearer to the equilibrium, drive "
    "it less, or go on through with stop_at_singular=False",
    "leg_collapsed": "the joints of a leg meet there, and its length passes through zero. Start nearer to the "
    "equilibrium, or drive it less",
    "joint_locked": "a leg lies along its universal joint's axis there, and the joint cannot turn. Choose an axis "
    "across the leg, or drive it less",
    "step_collapse": "no step was small enough for the accuracy asked for. Look at the motion so far, loosen rtol, or "
    "smooth what drives the machine",
    "not_finite": "the accelerations are not finite there. Look at the motion so far and at what drives the machine",
    "outside_stiffness_law": "a leg's commanded length leaves the range of legs.stiffness_law there. Command less, or "
    "give a law for such lengths",
    "max_steps": "the steps allowed were used up. Raise max_steps, loosen rtol, or shorten the duration",
}


@with_progress("simulation")
def simulate(
    hexapod: Hexapod,
    pose: Pose | ArrayLike | None = None,
    *,
    base_motion: Excitation | None = None,
    force: Load = None,
    moment: Load = None,
    leg_command: Excitation | None = None,
    duration: float | None = None,
    times: ArrayLike | None = None,
    samples: int | None = None,
    point: PointLike = ZERO,
    start: Start = "rest",
    base: Pose | ArrayLike | None = None,
    unstretched_length: ArrayLike | None = None,
    loss_frequency: float | None = None,
    joint: JointModel = "universal",
    method: Method = "automatic",
    rtol: float = 1e-9,
    atol: float | None = None,
    max_step: float = np.inf,
    max_steps: float = 1e8,
    stop_at_singular: bool = True,
    energies: bool = True,
    reactions: bool = False,
    threads: int | None = None,
    progress: ProgressLike = None,
) -> xr.Dataset:
    """Simulate the complete machine in time, from rest at a pose.

    The legs hold the pose under gravity and constant loads before t = 0. From then on the base, loads on the platform
    and leg commands drive it.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, optional
        Equilibrium pose, a Pose or x, y, z (m), roll, pitch, yaw (rad); the home pose by default.
    base_motion : Excitation, optional
        Motion of the base from its pose at rest, such as ``flexapod.harmonic("z", 1e-3, 20.0)``.
    force, moment : Excitation or array_like, optional
        Force (N) and moment (N m) on the platform at its reference point, in the platform's axes: three constants, or
        an Excitation of x, y, z.
    leg_command : Excitation, optional
        Change of the unstretched lengths of legs "1" to "6", m.
    duration : float, optional
        Length of the simulation, s. Default: where there is a recording, its length; of several the shortest. A
        recording that ends less than one of its samples earlier ends the simulation.
    times : array_like, optional
        Instants of the result, (m,) s, ascending from 0 or later.
    samples : int, optional
        Number of instants of the result, evenly spaced from 0 to `duration`. The default resolves the highest mode,
        with 20 samples in its period and at most 20 000 in all.
    point : array_like or str, optional
        Point of the platform whose motion is told, (3,) m, in its frame, or the name of a point of the design. Loads
        act at the reference point all the same.
    start : {"rest", "carried"}, Pose, Motion or array_like, optional
        State at t = 0: at the equilibrium with no velocity in the inertial frame ("rest"), moving rigidly with the base
        ("carried"), or a pose or motion of the platform in the inertial frame.
    base : Pose or array_like, optional
        Pose of the base at rest; the inertial frame by default.
    unstretched_length : array_like, optional
        Unstretched lengths of the legs, (6,) m, in place of those that hold the platform.
    loss_frequency : float, optional
        Frequency, rad/s, at which viscous friction takes as much as the design's loss factors, which it stands for (see
        `mechanics.viscous_equivalent`). Left out, loss factors are left out, with a warning.
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.
    method : {"automatic", "runge_kutta"}, optional
        Integrator: exponential Adams steps wherever they are quicker, or Runge-Kutta steps alone.
    rtol : float, optional
        Error of one step, relative to displacement and speed of the last periods of the slowest mode, 1e-15 to 1e-2.
    atol : float, optional
        Absolute part of that error, m; by default 1e-16 of the platform's size.
    max_step : float, optional
        Longest step, s.
    max_steps : float, optional
        Most steps of the integrator.
    stop_at_singular : bool, optional
        Whether the simulation ends where the force transformation H becomes singular.
    energies : bool, optional
        Whether the energy balance is computed.
    reactions : bool, optional
        Whether forces and moments in all joints are computed, as by `joint_reactions`.
    threads : int, optional
        Threads to use; all by default.
    progress : callable or False, optional
        Called with the share done, 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

    Returns
    -------
    xarray.Dataset
        Over `time` (s), of the platform's `point`:

        - displacement (time, output): from the equilibrium, inertial axes; `output` is x, y, z (m), roll, pitch, yaw
          (rotation vector, rad)
        - relative_displacement (time, output): the same as seen from the base, in its axes; relative_velocity and
          relative_acceleration: velocity, angular velocity and their rates for who stands on the base, in its axes
        - position, velocity, acceleration (time, axis), and rotation (time, axis, body_axis), angular_velocity,
          angular_acceleration (time, axis) of the platform, inertial axes; base_position, base_rotation of the base
        - leg_length, unstretched_length (m) and leg_force (N, positive: compression) (time, leg)
        - kinetic_energy, gravitational_energy, elastic_energy, energy_error (time) and work (time, source), J, with
          `energies`
        - the variables of `joint_reactions`, with `reactions`

        Attributes: energy_error, the largest one over the largest of kinetic energy and works; energy_rounding (J), the
        rounding of the stored energies, which hides a smaller error; point_m and point, the place and name of the
        point; method, steps, exponential_steps (of them), evaluations, warnings and the settings.

    Raises
    ------
    SimulationError
        If the platform passes through a singular pose, a leg through zero length, or the steps collapse. It carries
        `time`, `pose` and the Dataset so far as `result`.
    SingularPoseError
        If no leg forces hold the pose.
    PoseError
        If `pose` or `base` is not one pose, or no leg can take it.
    ArgumentError
        If an argument has a wrong name, shape or range.

    Warns
    -----
    UserWarning
        If a recording is sampled too coarsely for the machine, drifts, or begins off zero; if the design's loss factors
        are left out; if the motion exceeds a limit of the machine, or the energy balance is off.

    See Also
    --------
    simulate_many : many simulations at once.
    stepped_sine : steady response to a harmonic base motion.

    Notes
    -----
    Solves Eq. 35 of [1]_ by two methods, chosen by what a step costs and reaches. Near-linear motions are followed by
    exponential Adams steps [3]_ of orders up to 11, which solve the machine's linear part exactly and extrapolate what
    it leaves out; small vibrations take a fifth of the time so. All else, and what lies around corners of the
    excitations, is left to the Runge-Kutta method of order 8(5,3) of Dormand and Prince [2]_ with its interpolant of
    order 7. The orientation is integrated on SO(3).

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration (2007).
    .. [2] E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, Springer (1993).
    .. [3] M. Hochbruck and A. Ostermann, "Exponential integrators", Acta Numerica 19 (2010) 209-286.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> result = fx.simulate(hexapod, base_motion=fx.harmonic("z", 1e-6, 50.0), duration=0.1, samples=200)
    >>> result.displacement.dims
    ('time', 'output')
    >>> bool(result.attrs["energy_error"] < 1e-6)
    True
    """
    run = SimulationRun(
        hexapod,
        pose,
        base_motion=base_motion,
        force=force,
        moment=moment,
        leg_command=leg_command,
        start=start,
        base=base,
        unstretched_length=unstretched_length,
        loss_frequency=loss_frequency,
    )
    dataset = simulate_many(
        [run],
        duration,
        times=times,
        samples=samples,
        point=point,
        joint=joint,
        method=method,
        rtol=rtol,
        atol=atol,
        max_step=max_step,
        max_steps=max_steps,
        stop_at_singular=stop_at_singular,
        energies=energies,
        reactions=reactions,
        threads=threads,
        progress=progress or None,
    )
    if loss_frequency is not None:
        dataset.attrs["loss_frequency_rad_s"] = float(loss_frequency)
    return _complete(dataset.isel(run=0))


def _complete(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset of one run, with its numbers as attributes; raises SimulationError where it ended early."""
    told = (
        "status",
        "end_time",
        "steps",
        "evaluations",
        "exponential_steps",
        "energy_error_relative",
        "energy_rounding",
    )
    for name in told:
        if name in dataset:  # without energies there is no balance
            dataset.attrs[name.removesuffix("_relative")] = dataset[name].values.item()
    dataset = dataset.drop_vars(told, errors="ignore")
    last = dataset.attrs.pop("last")[0]
    status, end = dataset.attrs["status"], dataset.attrs["end_time"]
    if status == "complete":
        return dataset
    parts = unpack(last)
    where = Pose(parts["position"], parts["matrix"])
    result = dataset.sel(time=dataset.time <= end)
    remarks = "".join(f" {note[0].upper()}{note[1:]}" for note in dataset.attrs["warnings"])
    raise SimulationError(
        f"the simulation ended at t = {end:.9g} s in {where!r}: {REASONS[status]}.{remarks}", end, where, result
    )
