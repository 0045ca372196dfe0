"""The closed loop of a control law, and maps of it over position gains, against the natural frequencies."""

from __future__ import annotations

import warnings
from dataclasses import replace
from itertools import product
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.checks import level_outside, not_negative, numbers, one_of
from flexapod.control.closed_loop_poles import (
    ClosedLoop,
    assess,
    creep_words,
    distances,
    instability_message,
    nearest,
    pole_text,
)
from flexapod.control.controllers import PID, pid_units
from flexapod.control.linear_controller import ControlLaw, controller_for
from flexapod.control.losses import warn_of_losses
from flexapod.control.plant import Plant, damping_ratios, is_stable, poles
from flexapod.conventions import Array, Complex, JointModel, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError, UnstableError
from flexapod.mechanics.inputs import ZERO
from flexapod.mechanics.linearisation import linearise
from flexapod.pose import PoseLike

NO_CONTROL = PID()


class GainWarning(UserWarning):
    """Warning of gains that put poles of the closed loop near natural frequencies.

    Notes
    -----
    There the platform may vibrate more than without control (the paper's conclusion 2).

    Examples
    --------
    >>> import warnings
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", fx.control.GainWarning)
    ...     loop = fx.control.closed_loop(fx.load("cubic-isolator"))
    >>> len(loop.near)
    6
    """


def closed_loop(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    controller: ControlLaw = NO_CONTROL,
    *,
    nearness: float = 0.1,
    unstable: Literal["raise", "keep"] = "raise",
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> ClosedLoop:
    """Compute the poles of the hexapod under a controller, linearised at a pose.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    controller : ControlLaw, optional
        A PID, ForceFeedback or VelocityFeedback, or a Controller, which may be sampled. No control by default.
    nearness : float, optional
        Relative distance to a natural frequency below which a pole is reported as near.
    unstable : {"raise", "keep"}, optional
        Whether an unstable loop raises UnstableError or is returned.
    base : Pose or array_like, shape (6,), optional
        Pose of the base in the inertial frame. The identity by default.
    force, moment : array_like, shape (3,), optional
        Static force (N) and moment (N m) on the platform at its reference point, in its frame.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.

    Returns
    -------
    ClosedLoop
        The poles, with their damping and their distance to the natural frequencies.

    Raises
    ------
    ArgumentError
        If an argument other than the pose is invalid.
    UnstableError
        If the loop is unstable and `unstable` is "raise".
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.

    Warns
    -----
    GainWarning
        If a vibrating pole lies within `nearness` of a natural frequency, or if the legs' own loops let the platform
        creep. The result has these words too, as `cautions`.

    Notes
    -----
    The paper's conclusion 2 demands gains that keep the poles away from the natural frequencies. The hexapod is
    linearised with exact derivatives (see `flexapod.linearise`); poles of a sampled loop are log(z)/dt.

    Loss factors of the design are left out, with a warning, for poles and motions in time have viscous friction only:
    `mechanics.viscous_equivalent` makes friction of them.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> loop = fx.control.closed_loop(hexapod, None, fx.control.VelocityFeedback(400.0))
    >>> loop.stable, round(loop.worst_damping, 2)
    (True, 0.66)
    """
    not_negative(nearness, "nearness")
    one_of(unstable, "unstable", ("raise", "keep"))
    plant = Plant(linearise(hexapod, pose, base=base, force=force, moment=moment, joint=joint))
    warn_of_losses(hexapod)
    law = controller_for(plant.linear, controller)
    found = assess(plant, law, nearness)
    if not found.stable and unstable == "raise":
        raise UnstableError(instability_message(found, plant))
    if found.near:
        first = found.near[0]
        warnings.warn(
            f"{len(found.near)} poles of {law.name} lie within {nearness:.0%} of a natural frequency, such as "
            f"{pole_text(found.pole[first])} rad/s beside {nearest(found.pole[first], found.omega):.5g} rad/s; the "
            "machine may vibrate more than without control. Move the gains away.",
            GainWarning,
            stacklevel=level_outside(),
        )
    if creeping := creep_words(found):
        warnings.warn(creeping, GainWarning, stacklevel=level_outside())
    return found


def gain_map(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    kp: ArrayLike,
    kd: ArrayLike,
    controller: PID = NO_CONTROL,
    nearness: float = 0.1,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> xr.Dataset:
    """Compute the closed-loop poles over a range of proportional and derivative gains.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    kp : array_like, shape (m,)
        Different proportional gains, in the units of `PID`.
    kd : array_like, shape (n,)
        Different derivative gains, in the units of `PID`.
    controller : PID, optional
        Everything else about the loop: space, actuator, integral gain and bandwidth. By default leg forces against leg
        lengths and rates.
    nearness : float, optional
        Relative distance to a natural frequency below which a pole is reported as near.
    base : Pose or array_like, shape (6,), optional
        Pose of the base in the inertial frame. The identity by default.
    force, moment : array_like, shape (3,), optional
        Static force (N) and moment (N m) on the platform at its reference point, in its frame.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.

    Returns
    -------
    xarray.Dataset
        Over (kp, kd): ``distance``, the smallest relative distance of a vibrating pole to a natural frequency (infinite
        if none vibrates); ``worst_damping``; ``stable``; ``near``; and ``pole`` (kp, kd, pole_number) in rad/s.

    Raises
    ------
    ArgumentError
        If the gains are not rows of different numbers, or another argument is invalid.
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.

    Warns
    -----
    GainWarning
        If some gains put a pole within `nearness` of a natural frequency.

    Notes
    -----
    See `closed_loop`, and the paper's conclusion 2.

    Loss factors of the design are left out, with a warning, for poles and motions in time have viscous friction only:
    `mechanics.viscous_equivalent` makes friction of them.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> found = fx.control.gain_map(hexapod, kp=[2e3, 4e3], kd=[300.0, 400.0])
    >>> bool(found.stable.all()), bool(found.near.any())
    (True, False)
    """
    rows = {"kp": _different(kp, "kp"), "kd": _different(kd, "kd")}
    not_negative(nearness, "nearness")
    plant = Plant(linearise(hexapod, pose, base=base, force=force, moment=moment, joint=joint))
    warn_of_losses(hexapod)
    shape = (rows["kp"].size, rows["kd"].size)
    laws = [replace(controller, kp=p, kd=d).on(plant.linear) for p, d in product(*rows.values())]
    pole = np.stack([poles(plant, law) for law in laws]).reshape(*shape, -1)
    dataset = _map(rows, pole, plant, controller, nearness).assign_attrs(**origin(hexapod))
    near = dataset.near.values
    if near.any():
        warnings.warn(
            f"{int(near.sum())} of {near.size} pairs of gains put a pole within {nearness:.0%} of a natural frequency; "
            "there the machine may vibrate more than without control. Choose gains where `near` is False.",
            GainWarning,
            stacklevel=level_outside(),
        )
    return dataset


def _map(rows: dict[str, Array], pole: Complex, plant: Plant, controller: PID, nearness: float) -> xr.Dataset:
    distance = np.where(pole.imag > 0, distances(pole, plant.omega), np.inf).min(axis=-1)
    grid = ("kp", "kd")
    by_position, by_rate, _ = pid_units(controller)
    return xr.Dataset(
        {
            "distance": (grid, distance, in_unit("1", "least distance of poles to natural frequencies, relative")),
            "worst_damping": (grid, damping_ratios(pole).min(axis=-1), in_unit("1", "least damping ratio")),
            "stable": (grid, is_stable(pole, plant)),
            "near": (grid, distance < nearness),
            "pole": ((*grid, "pole_number"), pole, in_unit("rad/s")),
        },
        {
            "kp": ("kp", rows["kp"], in_unit(by_position, "proportional gain")),
            "kd": ("kd", rows["kd"], in_unit(by_rate, "derivative gain")),
        },
        {
            "space": controller.space,
            "actuator": controller.actuator,
            "nearness": nearness,
            "natural_frequencies_rad_s": plant.omega.tolist(),
        },
    )


def _different(value: ArrayLike, name: str) -> Array:
    row = numbers(np.atleast_1d(value), name)
    if not row.size or np.unique(row).size != row.size:
        raise ArgumentError(f"{name} has shape {row.shape}; give a row of different, finite gains")
    return row
