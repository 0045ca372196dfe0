"""The main parameters of a design, which have sliders on the page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from flexapod.design.hexapod import Hexapod
from flexapod.errors import DesignError
from flexapod.web.answers import Parameter
from flexapod.web.geometry import mean_radius

RADII = {"base.radius", "platform.radius"}  #: keys of the page only: joints scaled from the z axis


class _Slider(NamedTuple):
    """A parameter: its key, name, unit, how to read it, whether the slider is logarithmic."""

    key: str
    label: str
    unit: str
    read: Callable[[Hexapod], float]
    logarithmic: bool = True


_SLIDERS = (
    _Slider("platform.mass", "Platform + payload", "kg", lambda h: h.platform_mass),
    _Slider("legs.stiffness", "Leg stiffness", "N/m", lambda h: float(h.legs.stiffness.mean())),
    _Slider("legs.damping.prismatic", "Leg damping", "N s/m", lambda h: float(h.legs.damping.prismatic.mean())),
    _Slider("base.radius", "Base radius", "m", lambda h: mean_radius(h.base_joints)),
    _Slider("platform.radius", "Platform radius", "m", lambda h: mean_radius(h.platform_joints)),
    _Slider("platform.mass_center[2]", "Mass centre, z", "m", lambda h: float(h.platform_mass_center[2]), False),
    _Slider("legs.lower.mass", "Lower leg mass", "kg", lambda h: float(h.legs.lower.mass.mean())),
    _Slider("legs.upper.mass", "Upper leg mass", "kg", lambda h: float(h.legs.upper.mass.mean())),
)


def main_parameters(hexapod: Hexapod, original: Hexapod) -> list[Parameter]:
    """The main parameters of a hexapod beside those of the design without changes.

    The stiffness of legs with a stiffness law is none: it is another at each length.
    """
    size = mean_radius(original.base_joints)
    return [
        {
            "key": slider.key,
            "label": slider.label,
            "unit": slider.unit,
            "logarithmic": slider.logarithmic,
            "original": slider.read(original),
            "value": slider.read(hexapod),
            "size": size,
        }
        for slider in _SLIDERS
        if np.isfinite([slider.read(original), slider.read(hexapod)]).all()
    ]


def with_radius(hexapod: Hexapod, key: str, radius: Any) -> Hexapod:
    """The hexapod with the joints of one plate scaled in x and y to a mean distance from the z axis."""
    if isinstance(radius, bool) or not isinstance(radius, int | float) or not 0 < radius < 1e6:
        raise DesignError(f"{key} is {radius!r} m; it must be a number > 0.")
    plate = key.split(".")[0]
    if any(form.table == f"{plate}.circle" for form in hexapod.short_forms):
        return hexapod.replace({f"{plate}.circle.radius": radius})
    joints = getattr(hexapod, f"{plate}_joints")
    scale = radius / mean_radius(joints)
    return hexapod.replace({f"{plate}.joints": joints * [scale, scale, 1.0]})
