"""Derivatives of frequencies by the springs of a design, against differences of designs with other numbers."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx

PLAIN = plain_machine("precision-positioner")
SPRUNG = PLAIN.replace(
    {
        "legs.series_stiffness": [[9e7, 3e7], [8e7, 3e7], [9e7, 4e7], [7e7, 3e7], [9e7, 3e7], [9e7, 2e7]],
        "legs.joint_stiffness": {"universal": [200, 300], "spherical": 150, "torsion": 100},
        "suspension.stiffness": [2e6, 3e6, 5e6, 2e4, 1e4, 2e4],
        "suspension.point_mm": [5, 10, 50],
    }
)
LAWS = {
    "screw": {"kind": "screw", "fixed": 7e7, "axial_rigidity": 1.6e7, "zero_length": 0.16},
    "hydraulic": {
        "kind": "hydraulic",
        "bulk_modulus_GPa": 1.4,
        "area_1_cm2": 20,
        "area_2_cm2": 12,
        "dead_1_mm": 10,
        "dead_2_mm": 12,
        "stroke": 0.06,
        "shortest": 0.24,
    },
    "table": {"kind": "table", "lengths": [0.24, 0.262, 0.275, 0.29], "stiffnesses": [7e7, 5e7, 4.5e7, 4.4e7]},
}
POSE = fx.Pose.from_rpy(0.002, -0.003, 0.246, 0.01, -0.02, 0.01)


def machine(law):
    return SPRUNG if law == "constant" else SPRUNG.replace({"legs.stiffness_law": LAWS[law]})


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize("law", ["constant", *LAWS])
def test_derivatives_by_springs_are_those_of_differences(law, joint):
    hexapod = machine(law)
    found = fx.frequency_sensitivity(hexapod, POSE, joint=joint).springs
    own = [key for key in hexapod.values() if key.startswith(("legs.stiffness_law.", "legs.series", "suspension."))]
    assert set(own) - {"legs.stiffness_law.kind", "suspension.damping"} <= set(found)
    rng = np.random.default_rng(5)
    for key, by in found.items():
        value = hexapod.values()[key]
        assert by.shape == (6, *value.shape)
        scale = np.abs(value).max() or 1.0
        way = rng.standard_normal(value.shape) * scale
        if key == "suspension.stiffness":
            way = way @ way.T / scale  # symmetric, and as positive as the matrix
            by = np.stack([np.triu(each) for each in by])
        step = 1e-5
        ends = [
            fx.natural_modes(hexapod.replace({key: (value + sign * step * way).tolist()}), POSE, joint=joint).omega
            for sign in (1, -1)
        ]
        slope = (ends[0] - ends[1]) / (2 * step)
        exact = (by * way).reshape(6, -1).sum(axis=1)
        floor = 1e-9 / step * ends[0]  # rounding of the differences
        assert (np.abs(exact - slope) <= 1e-5 * np.abs(slope).max() + floor).all(), (key, exact, slope)


def test_springs_in_series_of_one_frequency_each():
    """Legs alike and in series alike: omega^2 is in proportion to k / (1 + k c), so that each derivative is known."""
    hexapod = PLAIN.replace({"legs.series_stiffness": [9e7, 3e7]})
    omega = fx.natural_modes(hexapod).omega
    by = fx.frequency_sensitivity(hexapod).springs["legs.series_stiffness"].sum(axis=1)
    k = 1 / (1 / PLAIN.legs.stiffness[0] + 1 / 9e7 + 1 / 3e7)
    np.testing.assert_allclose(by, 0.5 * omega[:, None] * k / np.array([9e7, 3e7]) ** 2, rtol=1e-10)
