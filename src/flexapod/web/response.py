"""Frequency responses at a pose, and the motion when the base is shaken at one frequency."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexapod.conventions import AXES, LEGS, Array
from flexapod.mechanics.linearisation import linearise
from flexapod.vibration.frequency_response import transmissibility
from flexapod.vibration.grid import grid_around
from flexapod.vibration.harmonic import complex_poles, losses
from flexapod.web import requests
from flexapod.web.answers import FrequencyResponse, ShakenBase
from flexapod.web.geometry import farthest

WRENCH = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")  #: names of its components
QUANTITIES = ("absolute", "relative", "compliance", "command", "leg_force")
POINTS = 400  #: frequencies over the range, beside those at the resonances
ABOVE = 3.0  #: highest frequency, over the highest natural frequency
DRAWN = 0.15  #: greatest displacement drawn, as a share of the platform's size


def response(asked: dict[str, Any]) -> FrequencyResponse:
    """Magnitude and phase of one quantity by output, input and frequency."""
    question, quantity = requests.question(asked), requests.choice(asked, "quantity", QUANTITIES)
    loss = requests.number(asked, "loss_factor", 0.0, 0.0, 2.0) or None  # 0: those of the design
    linear = linearise(question.hexapod, question.pose, joint=question.joint)
    modes = linear.modes()
    omega = grid_around(
        complex_poles(linear, losses(question.hexapod, linear, loss)),
        omega_max=ABOVE * modes.omega.max(),
        samples=POINTS,
    )
    data = transmissibility(question.hexapod, question.pose, omega=omega, loss_factor=loss, joint=question.joint)
    values = data[quantity]
    _, outputs, inputs = values.dims
    z = np.moveaxis(values.to_numpy(), 0, -1)
    legs = [f"leg {n}" for n in LEGS]
    names = {"leg": legs, "wrench": list(WRENCH), **{axis: list(AXES) for axis in ("output", "base")}}
    units = {"leg": ["N" if quantity == "leg_force" else "m"] * 6, **_units(data)}
    return {
        "omega": omega,
        "magnitude": _short(np.abs(z)),
        "phase": _short(np.degrees(np.angle(z))),
        "outputs": names[str(outputs)],
        "inputs": names[str(inputs)],
        "output_units": units[str(outputs)],
        "input_units": units[str(inputs)],
        "modes": [{"name": str(i + 1), "omega": p.imag} for i, p in enumerate(modes.pole) if p.imag > 0],
        "caution": data.attrs["caution"],
    }


def _units(data: Any) -> dict[str, list[str]]:
    """Units of the axes of outputs and inputs."""
    return {axis: data[f"{axis}_unit"].to_numpy().tolist() for axis in ("output", "base", "wrench")}


def _short(values: Array) -> Array:
    """Values rounded to five digits: more than a plot shows, in half the bytes."""
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 10.0 ** (4 - np.floor(np.log10(np.abs(values))))
        return np.where(np.isfinite(scale), np.round(values * scale) / scale, values)


def shake(asked: dict[str, Any]) -> ShakenBase:
    """The platform's complex displacement for a unit motion of the base along one axis."""
    question, axis = requests.question(asked), requests.choice(asked, "axis", AXES)
    omega = requests.number(asked, "omega", 1.0, 1e-9, 1e9)
    data = transmissibility(question.hexapod, question.pose, omega=[omega], joint=question.joint)
    moved = data["absolute"].to_numpy()[0, :, AXES.index(axis)]
    base = np.eye(6)[AXES.index(axis)]
    hexapod = question.hexapod
    size = farthest(hexapod.platform_joints)
    largest = max(
        _reach(np.abs(moved), hexapod.platform_joints), _reach(base, hexapod.base_joints), np.finfo(float).tiny
    )
    return {
        "platform": {"real": moved.real, "imag": moved.imag},
        "base": base,
        "ratio": abs(moved[AXES.index(axis)]),
        "reach": DRAWN * size / largest,
    }


def _reach(twist: Array, joints: Array) -> float:
    """An upper bound of the displacement of the farthest joint, m."""
    return float(np.linalg.norm(twist[:3]) + np.linalg.norm(twist[3:]) * farthest(joints))
