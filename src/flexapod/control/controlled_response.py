"""Transmissibility of base motion to the platform with and without control."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.control.closed_loop_poles import assess, instability_message
from flexapod.control.linear_controller import ControlLaw, Controller, controller_for
from flexapod.control.loop_response import loop_response, lossy
from flexapod.control.plant import Plant
from flexapod.conventions import AXES, JointModel, in_mixed_units, in_unit, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError
from flexapod.mechanics.cautions import response_attributes
from flexapod.mechanics.inputs import ZERO, PointLike, as_point, point_attributes, single_pose
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.point_motion import shift
from flexapod.pose import Pose, PoseLike
from flexapod.vibration.grid import asked, grid_around
from flexapod.vibration.harmonic import complex_poles


def controlled_transmissibility(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    controller: ControlLaw,
    omega: ArrayLike | None = None,
    frequency: ArrayLike | None = None,
    point: PointLike = ZERO,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> xr.Dataset:
    """Compute the transmissibility of base motion to the platform with and without control.

    Loss factors of the design are exact in the responses.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    controller : ControlLaw
        A PID, ForceFeedback or VelocityFeedback, or a Controller. A sampled one acts with its hold.
    omega : array_like, shape (n,), optional
        Angular frequencies > 0, rad/s; below pi/dt for a sampled controller. By default the grid of
        `vibration.frequency_grid` for the machine without control, as far as it lies below 0.99 pi/dt.
    frequency : array_like, shape (n,), optional
        The same in Hz, in place of `omega`.
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
        Complex ``controlled`` and ``passive`` (omega, output, base), the absolute displacement of the output point (m,
        rad) per displacement of the base (m, rad); and ``leg_force`` (omega, leg, base), N per displacement of the
        base.
        Attributes: ``stability`` of the loop ("stable" or "unstable"), ``passive_stability`` of the machine without
        control ("stable" or "falls over"), and ``caution``, what that means where one of them does not decay;
        ``loss_factor``, of the legs' springs, and ``joint_loss_factor``.

    Raises
    ------
    ArgumentError
        If a frequency is not positive or too high for a sampled controller, or another argument is invalid.
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.

    Notes
    -----
    The response of the hexapod linearised with exact derivatives (see `flexapod.linearise`) in closed loop. Springs
    with a loss factor eta have the stiffness K (1 + i eta), in the machine and in the leg forces that are measured, as
    in `flexapod.transmissibility`; forces of the controller act beside them. Stability is judged by the poles, in which
    loss factors are left out: `mechanics.viscous_equivalent` makes friction of them.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> law = fx.control.VelocityFeedback(300.0)
    >>> found = fx.control.controlled_transmissibility(hexapod, controller=law, omega=[30.0])
    >>> passive, controlled = (abs(found[name].sel(output="z", base="z")) for name in ("passive", "controlled"))
    >>> round(float(passive[0]), 1), round(float(controlled[0]), 1)
    (9.8, 1.4)
    """
    w = asked(omega, frequency)
    where = single_pose(hexapod, pose)
    to_point = shift(where, as_point(hexapod, point))
    plant = Plant(linearise(hexapod, where, base=base, force=force, moment=moment, joint=joint))
    law = controller_for(plant.linear, controller)
    if w is None:
        w = grid_around(complex_poles(plant.linear, plant.linear.losses))
        w = w if law.dt is None else w[w < 0.99 * np.pi / law.dt]
    if not w.size or w.min() == 0:
        raise ArgumentError("omega is empty or holds zero; the loop needs frequencies > 0.")
    if law.dt is not None and w.max() >= np.pi / law.dt:
        raise ArgumentError(
            f"omega reaches {w.max():.5g} rad/s; a controller sampled every {law.dt:.5g} s has a response only "
            f"below {np.pi / law.dt:.5g} rad/s"
        )
    whole = lossy(plant)
    controlled, passive = loop_response(whole, w, law), loop_response(whole, w, None)
    grid, ratio = ("omega", "output", "base"), "output_unit/base_unit"
    units = [unit_of(axis) for axis in AXES]
    return xr.Dataset(
        {
            "controlled": (
                grid,
                to_point @ controlled.absolute[..., :6],
                in_mixed_units(ratio, "transmissibility with control"),
            ),
            "passive": (
                grid,
                to_point @ passive.absolute[..., :6],
                in_mixed_units(ratio, "transmissibility without control"),
            ),
            "leg_force": (
                ("omega", "leg", "base"),
                controlled.force[..., :6],
                in_mixed_units("N/base_unit", "leg force per base displacement"),
            ),
        },
        {
            "omega": ("omega", w, in_unit("rad/s")),
            "output": list(AXES),
            "base": list(AXES),
            "output_unit": ("output", units),
            "base_unit": ("base", units),
        },
        response_origin(hexapod, where, point, plant, law),
    )


def response_origin(hexapod: Hexapod, pose: Pose, point: PointLike, plant: Plant, law: Controller) -> dict[str, object]:
    """What a response under control was computed for, as attributes of its Dataset."""
    return {
        **origin(hexapod),
        "controller": law.name,
        "position_m": pose.position.tolist(),
        "rpy_rad": pose.rpy.tolist(),
        **point_attributes(hexapod, point),
        "loss_factor": hexapod.legs.loss_factor.tolist(),
        "joint_loss_factor": hexapod.legs.joint_stiffness.loss_factor.tolist(),
        **_stability(plant, law),
    }


def _stability(plant: Plant, law: Controller) -> dict[str, str]:
    """Whether the loop and the machine without control decay, and what it means where one does not."""
    loop, passive = assess(plant, law), response_attributes(plant.linear)
    texts = (
        [] if loop.stable else [f"No motion approaches the response with control: {instability_message(loop, plant)}"]
    )
    if passive["caution"]:
        texts.append(f"Without control: {passive['caution']}")
    return {
        "stability": "stable" if loop.stable else "unstable",
        "passive_stability": passive["stability"],
        "caution": " ".join(texts),
    }
