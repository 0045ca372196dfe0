"""The frequency response of the platform, from the exact tangent at rest."""

from __future__ import annotations

import xarray as xr
from numpy.typing import ArrayLike

from flexapod.conventions import AXES, LEGS, Array, Complex, JointModel, in_mixed_units, in_unit, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import response_attributes
from flexapod.mechanics.inputs import ZERO, PointLike, as_hexapod, as_point, point_attributes, single_pose
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.point_motion import shift
from flexapod.pose import Pose, PoseLike
from flexapod.vibration.grid import asked, grid_around
from flexapod.vibration.harmonic import complex_poles, leg_losses, losses, steady_response

MOTION_UNITS = [unit_of(axis) for axis in AXES]
WRENCH_UNITS = [unit_of(axis, "N", "N m") for axis in AXES]


def transmissibility(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    omega: ArrayLike | None = None,
    frequency: ArrayLike | None = None,
    point: PointLike = ZERO,
    loss_factor: ArrayLike | None = None,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> xr.Dataset:
    """Compute the frequency response of the platform to base motion, wrenches and leg commands.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, optional
        Pose of the platform, a Pose or x, y, z (m), roll, pitch, yaw (rad); the home pose by default.
    omega : array_like, optional
        Frequencies, (n,) rad/s, not negative; the grid of `vibration.frequency_grid` by default.
    frequency : array_like, optional
        The same in Hz, in place of `omega`.
    point : array_like or str, optional
        Output point, (3,) m, in the platform's frame, or the name of a point of the design.
    loss_factor : float or array_like, optional
        Structural damping of the legs' springs, one number or (6,), in place of `legs.loss_factor` of the design: their
        stiffness is K (1 + i loss_factor). It adds to the viscous friction. The joints have their own of the design.
    base : Pose or array_like, optional
        Pose of the base at rest; the inertial frame by default.
    force, moment : array_like, optional
        Constant force (N) and moment (N m) on the platform at its reference point, in the platform's axes, (3,).
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.

    Returns
    -------
    xarray.Dataset
        Complex amplitudes X of x(t) = Re(X exp(i omega t)), in inertial axes. The dimensions `output`, `base` and
        `wrench` are x, y, z, roll, pitch, yaw (rotation vector); their units stand in the coordinates `output_unit`,
        `base_unit` and `wrench_unit`.

        - absolute (omega, output, base): motion of the output point per motion of the base's reference point
        - relative (omega, output, base): the same less the rigid motion with the base
        - compliance (omega, output, wrench): motion per wrench at the output point
        - command (omega, output, leg): motion per change of a leg's unstretched length, output_unit/m
        - leg_force (omega, leg, base): change of a leg's spring force (positive: compression) per base motion, N

        The attribute `stability` is "stable" or "falls over"; then `caution` says that no motion of the machine
        approaches the response.

    Raises
    ------
    ArgumentError
        If frequencies or loss factors are negative or not finite, or an argument has a wrong shape.
    PoseError
        If `pose` is not one pose that the legs can take.
    SingularPoseError
        If no leg forces hold the pose.

    See Also
    --------
    random_response : response to a base that moves at random.
    stepped_sine : the same measurement on the non-linear machine.

    Notes
    -----
    The equations of motion, Eq. 34 of [1]_, are linearised exactly at rest and solved in the undamped modes, which
    keeps the response accurate next to a resonance. The response is infinite at an undamped resonance. A base rotation
    turns gravity with respect to the machine, which is kept.

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration (2007).

    Examples
    --------
    >>> response = fx.transmissibility(fx.load("cubic-isolator"), frequency=[1.0, 100.0])
    >>> abs(response.absolute.sel(output="z", base="z")).values.round(3)
    array([1.046, 0.016])
    """
    w = asked(omega, frequency)
    leg_losses(as_hexapod(hexapod), loss_factor)
    pose = single_pose(hexapod, pose)
    linear = linearise(hexapod, pose, base=base, force=force, moment=moment, joint=joint)
    eta = losses(hexapod, linear, loss_factor)
    if w is None:
        w = grid_around(complex_poles(linear, eta))
    to_point = shift(pose, as_point(hexapod, point))
    steady = steady_response(linear, w, eta)
    relative = to_point @ steady.relative
    arrays = {
        "absolute": to_point @ steady.absolute,
        "relative": relative,
        "compliance": to_point @ steady.wrench @ to_point.T,
        "command": to_point @ steady.command,
        "leg_force": leg_forces(linear, steady.relative, eta),
    }
    variables = {name: (RESPONSES[name][0], array, RESPONSES[name][1]) for name, array in arrays.items()}
    coordinates = {"omega": ("omega", w, in_unit("rad/s", "frequency")), **COORDINATES}
    return xr.Dataset(variables, coordinates, attributes(hexapod, pose, point, eta, linear))


COORDINATES = {
    **{axis: (axis, list(AXES)) for axis in ("output", "base", "wrench")},
    "leg": ("leg", list(LEGS)),
    "output_unit": ("output", MOTION_UNITS),
    "base_unit": ("base", MOTION_UNITS),
    "wrench_unit": ("wrench", WRENCH_UNITS),
}
RESPONSES: dict[str, tuple[tuple[str, ...], dict[str, str]]] = {
    "absolute": (
        ("omega", "output", "base"),
        in_mixed_units("output_unit/base_unit", "absolute transmissibility"),
    ),
    "relative": (
        ("omega", "output", "base"),
        in_mixed_units("output_unit/base_unit", "motion relative to the base per base motion"),
    ),
    "compliance": (("omega", "output", "wrench"), in_mixed_units("output_unit/wrench_unit", "compliance")),
    "command": (("omega", "output", "leg"), in_mixed_units("output_unit/m", "motion per leg command")),
    "leg_force": (("omega", "leg", "base"), in_mixed_units("N/base_unit", "leg force per base motion")),
}


def leg_forces(linear: Linearisation, relative: Complex, eta: Array) -> Complex:
    """(n, 6, 6) N: change of the legs' spring forces per displacement of the platform relative to the base."""
    stiffness = linear.leg_stiffness * (1 + 1j * eta[:6])
    return -stiffness[:, None] * (linear.H.T @ relative)


def attributes(hexapod: Hexapod, pose: Pose, point: PointLike, eta: Array, linear: Linearisation) -> dict[str, object]:
    """What a response was computed for, as attributes of its Dataset."""
    return {
        **origin(hexapod),
        "position_m": pose.position.tolist(),
        "rpy_rad": pose.rpy.tolist(),
        **point_attributes(hexapod, point),
        "loss_factor": eta[:6].tolist(),
        "joint_loss_factor": hexapod.legs.joint_stiffness.loss_factor.tolist(),
        **response_attributes(linear),
    }
