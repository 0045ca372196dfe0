"""Frequency responses at a pose, and the motion when the base is shaken at one frequency."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexapod.conventions import AXES, LEGS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.linearisation import linearise
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
    from flexapod.vibration.frequency_response import transmissibility  # loads xarray, which the server does without

    question, quantity = requests.question(asked), requests.choice(asked, "quantity", QUANTITIES)
    loss = _loss_factor(asked)
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
        "losses": _losses(question.hexapod, loss),
        "caution": data.attrs["caution"],
    }


def _loss_factor(asked: dict[str, Any]) -> float | None:
    """The loss factor of the legs that the page asks for; 0 there stands for those of the design."""
    return requests.number(asked, "loss_factor", 0.0, 0.0, 2.0) or None


def _losses(hexapod: Hexapod, given: float | None) -> str:
    """In words, which loss factors act in a response; given: of the legs in place of those of the design."""
    legs = hexapod.legs.loss_factor if given is None else np.full(6, given)
    joints = hexapod.legs.joint_stiffness.loss_factor * hexapod.legs.joint_stiffness.any
    source = "of the design" if given is None else "of the box"
    acting = [
        f"{_between(factor)} in the {where}, {whose}"
        for factor, where, whose in ((legs, "legs", source), (joints, "joints", "of the design"))
        if factor.any()
    ]
    return f"Loss factors that act: {'; '.join(acting)}." if acting else "No loss factors act."


def _between(values: Array) -> str:
    """One number, or the least and the greatest of several."""
    low, high = f"{values.min():.4g}", f"{values.max():.4g}"
    return low if low == high else f"{low} to {high}"


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
    from flexapod.vibration.frequency_response import transmissibility  # loads xarray, which the server does without

    question, axis = requests.question(asked), requests.choice(asked, "axis", AXES)
    omega, loss = requests.number(asked, "omega", 1.0, 1e-9, 1e9), _loss_factor(asked)
    data = transmissibility(question.hexapod, question.pose, omega=[omega], loss_factor=loss, joint=question.joint)
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
