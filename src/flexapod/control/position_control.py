"""Position control on the exact tangent: PD and PID laws, their poles, and how near these come to the machine's
natural frequencies (the paper's conclusion 2)."""

from __future__ import annotations

import warnings
from itertools import product
from typing import Unpack

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.control.closed_loop_poles import ClosedLoop, assess, distances, nearest, pole_words, unstable_words
from flexapod.control.controllers import PID
from flexapod.control.plant import Law, Plant, damping_ratios, is_stable, poles
from flexapod.conventions import Array, Complex
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, UnstableError
from flexapod.mechanics.linearisation import RestOptions, linearise
from flexapod.pose import Pose


class GainWarning(UserWarning):
    """Gains that put poles of the closed loop near natural frequencies of the machine.

    Source: conclusion 2.
    """


def closed_loop(
    hexapod: Hexapod,
    pose: Pose,
    law: Law,
    *,
    nearness: float = 0.1,
    unstable: str = "raise",
    **rest: Unpack[RestOptions],
) -> ClosedLoop:
    """Poles (rad/s) of the machine at a pose under a control law, on the exact tangent.

    law: a PID, a ForceFeedback or VelocityFeedback, or any Controller, sampled ones included. Warns (GainWarning) when
    a pole lies within `nearness` of a natural frequency, as the paper demands. rest: as for `linearise`.

    Raises: UnstableError for gains that make the machine unstable, unless unstable="keep"; PoseError and
    SingularPoseError as `linearise`.
    Source: conclusion 2.
    """
    plant = Plant(linearise(hexapod, pose, **rest))
    controller = law.on(plant.linear)
    found = assess(plant, controller, nearness)
    if not found.stable and unstable != "keep":
        raise UnstableError(unstable_words(found))
    if found.near:
        first = found.near[0]
        warnings.warn(
            f"{len(found.near)} poles of {controller.name} lie within {nearness:.0%} of a natural frequency, such as "
            f"{pole_words(found.pole[first])} rad/s beside {nearest(found.pole[first], found.omega):.5g} rad/s; the "
            "machine may vibrate more than without control. Move the gains away.",
            GainWarning,
            stacklevel=2,
        )
    return found


def gain_map(
    hexapod: Hexapod,
    pose: Pose,
    kp: ArrayLike,
    kd: ArrayLike,
    *,
    law: PID | None = None,
    nearness: float = 0.1,
    **rest: Unpack[RestOptions],
) -> xr.Dataset:
    """Closed-loop poles over a range of proportional and derivative gains, kp (m,) and kd (n,).

    law: what else the loop is (space, actuator, ki, bandwidth); default: PD on the legs by forces. Dataset over
    (kp, kd): `distance`, the least relative distance of a vibrating pole to a natural frequency (infinite when none
    vibrates); `worst_damping`; `stable`; `near` (bool); `pole` (kp, kd, pole), rad/s. Warns (GainWarning) where gains
    put poles within `nearness` of a natural frequency.

    Raises: ArgumentError for gains that are no rows of numbers; PoseError and SingularPoseError as `linearise`.
    Source: conclusion 2.
    """
    rows = {"kp": _row(kp, "kp"), "kd": _row(kd, "kd")}
    base = law or PID()
    plant = Plant(linearise(hexapod, pose, **rest))
    shape = (rows["kp"].size, rows["kd"].size)
    found = [_with(base, p, d).on(plant.linear) for p, d in product(*rows.values())]
    pole = np.stack([poles(plant, controller) for controller in found]).reshape(*shape, -1)
    dataset = _map(rows, pole, plant, base, nearness).assign_attrs(design=hexapod.name, digest=hexapod.digest)
    near = dataset.near.values
    if near.any():
        warnings.warn(
            f"{int(near.sum())} of {near.size} pairs of gains put a pole within {nearness:.0%} of a natural frequency; "
            "there the machine may vibrate more than without control. Choose gains where `near` is False.",
            GainWarning,
            stacklevel=2,
        )
    return dataset


def _map(rows: dict[str, Array], pole: Complex, plant: Plant, law: PID, nearness: float) -> xr.Dataset:
    distance = np.where(pole.imag > 0, distances(pole, plant.omega), np.inf).min(axis=-1)
    grid = ("kp", "kd")
    return xr.Dataset(
        {
            "distance": (grid, distance, {"long_name": "least distance of poles to natural frequencies, relative"}),
            "worst_damping": (grid, damping_ratios(pole).min(axis=-1), {"long_name": "least damping ratio"}),
            "stable": (grid, is_stable(pole, plant)),
            "near": (grid, distance < nearness),
            "pole": ((*grid, "pole_number"), pole, {"units": "rad/s"}),
        },
        {
            "kp": ("kp", rows["kp"], {"long_name": "proportional gain", "units": _unit(law, 0)}),
            "kd": ("kd", rows["kd"], {"long_name": "derivative gain", "units": _unit(law, 1)}),
        },
        {
            "space": law.space,
            "actuator": law.actuator,
            "nearness": nearness,
            "natural_frequencies_rad_s": plant.omega.tolist(),
        },
    )


def _with(law: PID, kp: float, kd: float) -> PID:
    return PID(float(kp), float(kd), law.ki, law.space, law.actuator, law.bandwidth)


def _row(value: ArrayLike, name: str) -> Array:
    row = np.atleast_1d(np.asarray(value, dtype=np.float64))
    if row.ndim != 1 or not row.size or not np.isfinite(row).all() or np.unique(row).size != row.size:
        raise ArgumentError(f"{name} has shape {row.shape}; give a row of different, finite gains")
    return row


def _unit(law: PID, rates: int) -> str:
    """Unit of a single gain, for a position (0) or a rate (1)."""
    if law.actuator == "command":
        return ("1", "s")[rates]
    return ("N/m", "N s/m")[rates] if law.space == "joint" else ("1/s2", "1/s")[rates]
