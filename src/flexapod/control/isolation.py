"""Isolation of the platform from a moving base: controllers by LQG and H-infinity design.

All weights are ratios without units: the designs scale rotations by the platform's size, forces by the acceleration
they give and measurements by what a moving base makes of them, so that the same numbers suit small and large hexapods.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import positive
from flexapod.control.h_infinity_synthesis import suboptimal_controller, weighted_plant
from flexapod.control.linear_controller import Controller, Measurement
from flexapod.control.losses import plant_with_losses
from flexapod.control.plant import is_stable, poles
from flexapod.control.scaled_plant import ScaledPlant, measurements
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, UnstableError
from flexapod.mechanics.inputs import ZERO
from flexapod.optional import needed
from flexapod.pose import PoseLike

_HEAVIEST = 1e30  # of a weight


def lqg(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    measure: Measurement | Sequence[Measurement] = "acceleration",
    effort: float = 0.1,
    stroke: float = 0.1,
    noise: float = 0.1,
    loss_frequency: float | None = None,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Controller:
    """Design the controller with the least mean square platform acceleration under white base acceleration (LQG).

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    measure : str or sequence of str, optional
        What the controller measures: one or several of "acceleration", "leg_force", "leg_length", "leg_rate",
        "position" and "velocity".
    effort : float, optional
        Weight of leg forces against platform acceleration; at 1 a force counts like the acceleration it causes. Small
        weights ask for more of the actuators.
    stroke : float, optional
        Weight of relative displacement times omega_1^2, which keeps the platform over a base that drifts.
    noise : float, optional
        Sensor noise relative to the signal that the moving base causes.
    loss_frequency : float, optional
        Frequency, rad/s, at which viscous friction of the plant takes as much as the loss factors of the design (see
        `mechanics.viscous_equivalent`). Left out, loss factors are left out, and the controller's name says so.
    base : Pose or array_like, shape (6,), optional
        Pose of the base in the inertial frame. The identity by default.
    force, moment : array_like, shape (3,), optional
        Static force (N) and moment (N m) on the platform at its reference point, in its frame.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.

    Returns
    -------
    Controller
        A continuous controller with 12 states.

    Raises
    ------
    ArgumentError
        If a measurement is unknown, a weight is not positive, or another argument is invalid.
    UnstableError
        If no controller exists for these weights.
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.
    MissingExtraError
        If python-control is not installed.

    Notes
    -----
    Linear-quadratic-Gaussian control after Kwakernaak and Sivan [1]_, of the absolute acceleration of the platform.

    References
    ----------
    .. [1] H. Kwakernaak and R. Sivan, Linear Optimal Control Systems, Wiley (1972).

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> controller = fx.control.lqg(hexapod)
    >>> controller.order
    12
    >>> fx.control.closed_loop(hexapod, None, controller.sampled(2e-3), nearness=0).stable
    True
    """
    for name, value in (("effort", effort), ("stroke", stroke), ("noise", noise)):
        _weight(value, name)
    measures = measurements(measure)
    plant, told = plant_with_losses(hexapod, pose, loss_frequency, base=base, force=force, moment=moment, joint=joint)
    task = ScaledPlant(plant, measures)
    control = needed("control", "control", "LQG design needs python-control")
    drift = stroke * task.omega_1**2 / (task.plant.omega_0 * task.pace)
    held = np.hstack([np.diag(drift / task.axis), np.zeros((6, 6))])
    Q = task.C_a.T @ task.C_a + held.T @ held
    R = task.D_a.T @ task.D_a + effort**2 * np.eye(6)
    A, B, E, C = task.A, task.B, task.E, task.C
    gain = _riccati(control, A, B, Q, R, task.C_a.T @ task.D_a)
    V = noise**2 * np.eye(len(C)) + task.G @ task.G.T
    observer = _riccati(control, A.T, C.T, E @ E.T, V, E @ task.G.T).T
    A_c = A - B @ gain - observer @ (C - task.D @ gain)
    return task.controller(A_c, observer, -gain, np.zeros((6, len(C))), f"LQG isolation{told}")


def h_infinity(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    measure: Measurement | Sequence[Measurement] = "acceleration",
    corner: float | None = None,
    depth: float = 3.0,
    effort: float = 0.1,
    noise: float = 0.1,
    bandwidth: float | None = None,
    loss_frequency: float | None = None,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Controller:
    """Design the controller with the least worst-case weighted transmissibility of base acceleration (H-infinity).

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    measure : str or sequence of str, optional
        What the controller measures: one or several of "acceleration", "leg_force", "leg_length", "leg_rate",
        "position" and "velocity".
    corner : float, optional
        Frequency, rad/s, below which the platform has to follow the base. Half the lowest natural frequency by default.
    depth : float, optional
        Weight of the platform's acceleration far above the corner.
    effort : float, optional
        Weight of leg forces at low frequencies; at 1 a force counts like the acceleration it causes.
    noise : float, optional
        Sensor noise relative to the signal that the moving base causes.
    bandwidth : float, optional
        Frequency, rad/s, at which the weight of forces reaches that of acceleration, and beyond which the controller
        does nothing. Twice the highest natural frequency by default.
    loss_frequency : float, optional
        Frequency, rad/s, at which viscous friction of the plant takes as much as the loss factors of the design (see
        `mechanics.viscous_equivalent`). Left out, loss factors are left out, and the controller's name says so.
    base : Pose or array_like, shape (6,), optional
        Pose of the base in the inertial frame. The identity by default.
    force, moment : array_like, shape (3,), optional
        Static force (N) and moment (N m) on the platform at its reference point, in its frame.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.

    Returns
    -------
    Controller
        A continuous controller with 24 states. Its name holds the bound gamma that was reached: the transmissibility is
        at most gamma over the weight at every frequency.

    Raises
    ------
    ArgumentError
        If a measurement is unknown, a weight or a frequency is not positive, or another argument is invalid.
    UnstableError
        If no controller is found.
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.
    MissingExtraError
        If slycot is not installed.

    Notes
    -----
    The weight of the absolute acceleration is depth (s + corner)/(s + depth corner), which rises from 1 to `depth`.
    The problem is solved after Doyle and others [1]_ by SLICOT's SB10AD.

    References
    ----------
    .. [1] J. C. Doyle, K. Glover, P. P. Khargonekar and B. A. Francis, State-space solutions to standard H2 and
       H-infinity control problems, IEEE Transactions on Automatic Control 34 (1989).

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> controller = fx.control.h_infinity(hexapod)
    >>> controller.order
    24
    """
    measures = measurements(measure)
    for name, value in (("corner", corner), ("bandwidth", bandwidth)):
        if value is not None:
            positive(value, name, "rad/s")
    for name, value in (("depth", depth), ("effort", effort), ("noise", noise)):
        _weight(value, name)
    plant, told = plant_with_losses(hexapod, pose, loss_frequency, base=base, force=force, moment=moment, joint=joint)
    task = ScaledPlant(plant, measures)
    omega = task.plant.omega
    low = 0.5 * float(omega[0]) if corner is None else corner
    high = 2.0 * float(omega[-1]) if bandwidth is None else bandwidth
    system = weighted_plant(
        task, corner=low / task.pace, depth=depth, bandwidth=high / task.pace, effort=effort, noise=noise
    )
    gamma, (A, B, C, D) = suboptimal_controller(system, len(task.C))
    name = f"H-infinity isolation (gamma {gamma:.3g}{told})"
    found = task.controller(A, B, C, D, name)
    if not is_stable(poles(task.plant, found), task.plant):
        raise UnstableError(f"{name}: the design is too badly conditioned to be used. Raise effort and noise.")
    return found


def _weight(value: float, name: str) -> None:
    """Raises ArgumentError for what is no weight, or one whose square no number holds."""
    if positive(value, name) > _HEAVIEST:
        raise ArgumentError(f"{name} is {value:g}; it must be at most {_HEAVIEST:g}.")


def _riccati(control: Any, A: Array, B: Array, Q: Array, R: Array, S: Array) -> Array:
    """The optimal gain R^-1 (B^T X + S^T)."""
    try:
        _, _, gain = control.care(A, B, Q, R, S)
    except (ValueError, np.linalg.LinAlgError, ArithmeticError, RuntimeError, Warning) as error:
        raise UnstableError(
            f"no optimal controller exists for these weights: {' '.join(str(error).split()).rstrip('.')}. The "
            "measurement may not show every motion, or a weight is too small: raise noise or effort."
        ) from error
    return np.asarray(gain)
