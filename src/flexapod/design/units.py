"""Units that a key of a design file may carry in its name: `joints_mm`, `stiffness_N_per_um`, `angles_deg`.

Inside the library everything is SI and radians. A key without a unit is SI.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

_LB, _LBF = 45359237, 44482216152605  # pound in 1e-8 kg, and its weight in 1e-13 N; both are exact

# dimension -> unit -> (multiply by, divide by). Two numbers, because x / 1000 is rounded once and x * 0.001 is not:
# `radius_mm = 115` then is bit for bit `radius = 0.115`. The first unit of each dimension is the SI one.
UNITS: dict[str, dict[str, tuple[float, float]]] = {
    "length": {"m": (1, 1), "cm": (1, 1e2), "mm": (1, 1e3), "um": (1, 1e6), "in": (254, 1e4), "ft": (3048, 1e4)},
    "mass": {"kg": (1, 1), "g": (1, 1e3), "t": (1e3, 1), "lb": (_LB, 1e8)},
    "inertia": {
        "kg_m2": (1, 1),
        "kg_cm2": (1, 1e4),
        "kg_mm2": (1, 1e6),
        "g_m2": (1, 1e3),
        "g_cm2": (1, 1e7),
        "g_mm2": (1, 1e9),
        "lb_in2": (_LB * 254**2, 1e16),
        "lb_ft2": (_LB * 3048**2, 1e16),
        "lbf_in_s2": (_LBF * 127, 5e16),
        "lbf_ft_s2": (_LBF * 3048, 1e17),
    },
    "stiffness": {
        "N_per_m": (1, 1),
        "N_per_mm": (1e3, 1),
        "N_per_um": (1e6, 1),
        "N_per_nm": (1e9, 1),
        "kN_per_m": (1e3, 1),
        "kN_per_mm": (1e6, 1),
        "MN_per_m": (1e6, 1),
        "lbf_per_in": (_LBF, 254e9),
        "lbf_per_ft": (_LBF, 3048e9),
    },
    "damping": {
        "N_s_per_m": (1, 1),
        "N_s_per_mm": (1e3, 1),
        "kN_s_per_m": (1e3, 1),
        "lbf_s_per_in": (_LBF, 254e9),
        "lbf_s_per_ft": (_LBF, 3048e9),
    },
    "angular damping": {
        "N_m_s_per_rad": (1, 1),
        "N_mm_s_per_rad": (1, 1e3),
        "N_m_s_per_deg": (180, math.pi),
        "lbf_in_s_per_rad": (_LBF * 127, 5e16),
        "lbf_ft_s_per_rad": (_LBF * 3048, 1e17),
    },
    "angular stiffness": {
        "N_m_per_rad": (1, 1),
        "N_mm_per_rad": (1, 1e3),
        "N_m_per_mrad": (1e3, 1),
        "kN_m_per_rad": (1e3, 1),
        "N_m_per_deg": (180, math.pi),
        "N_mm_per_deg": (180, 1e3 * math.pi),
        "lbf_in_per_rad": (_LBF * 127, 5e16),
        "lbf_ft_per_rad": (_LBF * 3048, 1e17),
        "lbf_in_per_deg": (_LBF * 127 * 180, 5e16 * math.pi),
    },
    "bending stiffness": {"N_m2": (1, 1), "N_mm2": (1, 1e6), "kN_m2": (1e3, 1), "lbf_in2": (_LBF * 254**2, 1e21)},
    "force": {"N": (1, 1), "mN": (1, 1e3), "kN": (1e3, 1), "MN": (1e6, 1), "lbf": (_LBF, 1e13)},
    "moment": {
        "N_m": (1, 1),
        "N_mm": (1, 1e3),
        "kN_m": (1e3, 1),
        "lbf_in": (_LBF * 127, 5e16),
        "lbf_ft": (_LBF * 3048, 1e17),
    },
    "pressure": {
        "Pa": (1, 1),
        "kPa": (1e3, 1),
        "MPa": (1e6, 1),
        "GPa": (1e9, 1),
        "bar": (1e5, 1),
        "psi": (_LBF, 254**2 * 1e5),
    },
    "area": {"m2": (1, 1), "cm2": (1, 1e4), "mm2": (1, 1e6), "in2": (254**2, 1e8)},
    "acceleration": {
        "m_per_s2": (1, 1),
        "mm_per_s2": (1, 1e3),
        "ft_per_s2": (3048, 1e4),
        "in_per_s2": (254, 1e4),
        "g": (980665, 1e5),
    },
    "angle": {"rad": (1, 1), "mrad": (1, 1e3), "deg": (math.pi, 180)},
    "velocity": {
        "m_per_s": (1, 1),
        "mm_per_s": (1, 1e3),
        "um_per_s": (1, 1e6),
        "in_per_s": (254, 1e4),
        "ft_per_s": (3048, 1e4),
    },
    "angular velocity": {
        "rad_per_s": (1, 1),
        "mrad_per_s": (1, 1e3),
        "deg_per_s": (math.pi, 180),
        "rpm": (math.pi, 30),
    },
    "power": {"W": (1, 1), "mW": (1, 1e3), "kW": (1e3, 1)},
}

_LENGTHS = {**UNITS["length"], "nm": (1, 1e9)}
_ANGLES = {**UNITS["angle"], "urad": (1, 1e6)}
#: What tables and command lines name besides: more units, and dimensions that no key of a design has. SI first.
QUANTITIES: dict[str, dict[str, tuple[float, float]]] = {
    **UNITS,
    "length": _LENGTHS,
    "angle": _ANGLES,
    "time": {"s": (1, 1), "ms": (1, 1e3), "us": (1, 1e6), "min": (60, 1), "h": (3600, 1)},
    "frequency": {"rad_per_s": (1, 1), "Hz": (2 * math.pi, 1), "kHz": (2e3 * math.pi, 1), "rpm": (math.pi, 30)},
    "velocity": {f"{unit}_per_s": factor for unit, factor in _LENGTHS.items()},
    "acceleration": {f"{unit}_per_s2": factor for unit, factor in _LENGTHS.items()}
    | {"ft_per_s2": (3048, 1e4), "g": (980665, 1e5), "mg": (980665, 1e8)},
    "angular velocity": {f"{unit}_per_s": factor for unit, factor in _ANGLES.items()} | UNITS["angular velocity"],
    "angular acceleration": {f"{unit}_per_s2": factor for unit, factor in _ANGLES.items()},
}

ALL_UNITS = frozenset(unit for units in UNITS.values() for unit in units)


def si_unit(dimension: str | None) -> str:
    """The SI unit of a dimension as it stands in a key; "" for a pure number."""
    return next(iter(QUANTITIES[dimension])) if dimension else ""


def printed(unit: str) -> str:
    """A unit as people write it: `N_s_per_m` -> `N s/m`."""
    return unit.replace("_per_", "/").replace("_", " ")


def to_si(value: ArrayLike, dimension: str, unit: str) -> NDArray[np.float64]:
    """Numbers in the SI unit of their dimension."""
    multiply, divide = UNITS[dimension][unit]
    if multiply == divide == 1:
        return np.asarray(value, dtype=np.float64)
    with np.errstate(over="ignore"):  # an infinite result is refused with the value as it was given
        return np.asarray(value, dtype=np.float64) * multiply / divide
