"""Flexures from their dimensions: beams integrated by SciPy, finite elements, a table of torsion, a published joint."""

import numpy as np
import pytest
from scipy.integrate import quad
from tests.oracles import flexure_by_bricks, notch_by_elements

import flexapod as fx
from flexapod.design import flexures

STEEL = flexures.Material(200e9, 400e6)
SHEAR = STEEL.shear_modulus
LEAF = flexures.leaf(20e-3, 0.5e-3, 10e-3, STEEL)
WIRE = flexures.wire(15e-3, 1.2e-3, STEEL)


def bent_by_moment(height, inertia, half):
    """Angle between the ends of a beam under a moment of 1 N m: the curvature, integrated by SciPy."""
    thin = half * np.array([-1e-1, -1e-2, 1e-2, 1e-1])
    return quad(lambda x: 1 / (STEEL.youngs_modulus * inertia(height(x))), -half, half, points=thin, limit=500)[0]


def pushed_across(height, inertia, area, coefficient, half):
    """Deflection under a force of 1 N across the beam's middle, its ends kept parallel: the work of moment and shear."""
    young = STEEL.youngs_modulus
    thin = half * np.array([-1e-1, -1e-2, 1e-2, 1e-1])

    def work(x):
        h = height(x)
        return x**2 / (young * inertia(h)) + coefficient / (SHEAR * area(h))

    return quad(work, -half, half, points=thin, limit=500)[0]


def notch(radius, thickness):
    return lambda x: thickness + 2 * (radius - np.sqrt(np.maximum(radius**2 - x**2, 0)))


RECTANGLE = {"inertia": lambda h: 8e-3 * h**3 / 12, "area": lambda h: 8e-3 * h, "coefficient": 1.2}
CIRCLE = {"inertia": lambda h: np.pi * h**4 / 64, "area": lambda h: np.pi * h**2 / 4, "coefficient": 10 / 9}


@pytest.mark.parametrize("ratio", [0.01, 0.1, 0.5, 1.0])
@pytest.mark.parametrize("section", [RECTANGLE, CIRCLE], ids=["flat", "round"])
def test_notches_are_beams_of_varying_section(ratio, section):
    """But for what the bodies beside them yield, which is taken off here as the docstrings state it."""
    radius, thickness = 3e-3, 3e-3 * ratio
    height = notch(radius, thickness)
    if section is RECTANGLE:
        found = flexures.circular_notch(radius, thickness, 8e-3, STEEL)
        more, longer = 1 + 0.4 * ratio - 0.105 * ratio**2, 1 + 0.6 * np.sqrt(ratio) - 0.27 * ratio
    else:
        found = flexures.round_notch(radius, thickness, STEEL)
        more, longer = 1 + 0.177 * ratio, 1 + 0.84 * 0.73 * ratio / (1 + 1.2 * ratio)
    bent = bent_by_moment(height, section["inertia"], radius)
    assert found.bending[0] * bent * more == pytest.approx(1, rel=1e-5)
    along = quad(lambda x: 1 / section["area"](height(x)), 0, radius, limit=500)[0] * 2 / STEEL.youngs_modulus
    assert found.axial * along * longer == pytest.approx(1, rel=1e-5)
    across = pushed_across(height, section["inertia"], section["area"], section["coefficient"], radius)
    assert found.shear[0] * across == pytest.approx(1, rel=1e-5)


def test_stiff_axis_of_a_notch():
    found = flexures.circular_notch(3e-3, 0.3e-3, 8e-3, STEEL)
    height = notch(3e-3, 0.3e-3)
    wide = {"inertia": lambda h: h * 8e-3**3 / 12, "area": RECTANGLE["area"], "coefficient": 1.2}
    assert found.bending[1] * bent_by_moment(height, wide["inertia"], 3e-3) == pytest.approx(1, rel=1e-5)
    assert found.shear[1] * pushed_across(height, **wide, half=3e-3) == pytest.approx(1, rel=1e-5)


def test_leaf_and_wire_are_uniform_beams():
    inertia = 10e-3 * 0.5e-3**3 / 12
    assert LEAF.bending[0] == pytest.approx(200e9 * inertia / 20e-3)
    assert LEAF.axial == pytest.approx(200e9 * 10e-3 * 0.5e-3 / 20e-3)
    guided = 20e-3**3 / (12 * 200e9 * inertia) + 1.2 * 20e-3 / (SHEAR * 10e-3 * 0.5e-3)  # both ends held parallel
    assert LEAF.shear[0] == pytest.approx(1 / guided)
    inertia = np.pi * 1.2e-3**4 / 64
    assert WIRE.bending == pytest.approx([200e9 * inertia / 15e-3] * 2)
    assert WIRE.torsion == pytest.approx(2 * SHEAR * inertia / 15e-3)
    guided = 15e-3**3 / (12 * 200e9 * inertia) + 10 / 9 * 15e-3 / (SHEAR * np.pi * 0.6e-3**2)
    assert WIRE.shear == pytest.approx([1 / guided] * 2)


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.5, 1.0])
def test_flat_notches_bend_and_stretch_as_finite_elements_do(ratio):
    """Within 2 %; in bending within 0.5 %."""
    bent, stretched = notch_by_elements.plane(1.0, ratio, 0.3)
    found = flexures.circular_notch(1.0, ratio, 1.0, flexures.Material(1.0, 1.0))
    assert found.bending[0] * bent == pytest.approx(1, abs=0.005)
    assert found.axial * stretched == pytest.approx(1, abs=0.02)


@pytest.mark.parametrize(("ratio", "poisson"), [(0.1, 0.3), (0.5, 0.3), (1.0, 0.0), (1.0, 0.3), (0.4, 0.45)])
def test_round_notches_yield_as_finite_elements_do(ratio, poisson):
    bent, stretched, turned = notch_by_elements.revolved(1.0, ratio, poisson)
    found = flexures.round_notch(1.0, ratio, flexures.Material(1.0, 1.0, poisson))
    assert found.bending[0] * bent == pytest.approx(1, abs=0.02)
    assert found.axial * stretched == pytest.approx(1, abs=0.02)
    assert found.torsion * turned == pytest.approx(1, abs=0.005)


@pytest.mark.parametrize(("ratio", "factor"), [(1, 0.1406), (1.5, 0.196), (2, 0.229), (4, 0.281), (10, 0.312)])
def test_torsion_of_rectangles_is_that_of_the_published_table(ratio, factor):
    """Timoshenko and Goodier, Theory of Elasticity, section 109: torsion constants over width thickness^3."""
    found = flexures.leaf(5.0, 1e-3, ratio * 1e-3, STEEL)  # so long that its ends, which cannot warp, do not count
    assert found.torsion * 5.0 / (SHEAR * ratio * 1e-12) == pytest.approx(factor, rel=3e-3)


@pytest.mark.parametrize(("length", "width"), [(20, 5), (10, 10), (10, 30), (10, 1)])
def test_leaves_twist_between_bodies_as_finite_elements_do(length, width):
    """Within 8 %: a leaf much wider than long is a plate, which cannot contract across either. Saint-Venant's torsion alone
    has 96 % of it where the leaf is long and 13 % where it is wide."""
    found = flexures.leaf(float(length), 1.0, float(width), flexures.Material(1.0, 1.0))
    elements = flexure_by_bricks.stiffness("torsion", lambda s: length / 2 * s, lambda s: 1.0, width, 0.3)
    assert 0.92 < found.torsion / elements < 1.005


@pytest.mark.parametrize(("ratio", "width", "least"), [(1 / 12, 6.2, 0.95), (0.05, 1.0, 0.92), (0.33, 1.33, 0.8)])
def test_notches_twist_between_bodies_as_finite_elements_do(ratio, width, least):
    """Within 8 % as long as they are thin. Bodies as stiff as those of the elements are none, so what is found is less."""

    def angle(s):  # close where the notch is thinnest
        return np.sqrt(ratio) * np.sinh(s * np.arcsinh(np.pi / 2 / np.sqrt(ratio)))

    elements = flexure_by_bricks.stiffness(
        "torsion", lambda s: np.sin(angle(s)), lambda s: ratio + 2 * (1 - np.cos(angle(s))), width, 0.3
    )
    found = flexures.circular_notch(1.0, ratio, width, flexures.Material(1.0, 1.0))
    assert least < found.torsion / elements < 1.0


@pytest.mark.parametrize("ratio", [0.05, 0.3, 1.0])
def test_stress_at_the_notch(ratio):
    """Against the stress of the plane elements, within 1 %; a groove turned into a bar concentrates less."""
    thickness = 3e-3 * ratio
    flat = flexures.circular_notch(3e-3, thickness, 8e-3, STEEL)
    factor = STEEL.strength * 8e-3 * thickness**2 / 6 / flat.moment
    assert factor == pytest.approx(notch_by_elements.stressed(1.0, ratio, STEEL.poisson_ratio), rel=0.01)
    turned = flexures.round_notch(3e-3, thickness, STEEL)
    assert 1 < STEEL.strength * np.pi * thickness**3 / 32 / turned.moment < factor
    for one in (flat, turned, LEAF, WIRE):
        assert one.angle * one.bending[0] == pytest.approx(one.moment)
    assert LEAF.angle == pytest.approx(2 * STEEL.strength * 20e-3 / (STEEL.youngs_modulus * 0.5e-3))


def test_a_published_joint_is_what_its_finite_elements_say():
    """T. Dehaeze, stewart-simscape: the joint of mat/flexor_025.step and its super-element mat/flexor_025.mat, which has
    4.83 N m/rad in bending, 260 N m/rad in torsion, 94.0 N/um along and 12.7 N/um across.

    Read from the file's cylinders: two crossed notches of 3 mm radius with centres 3.125 mm from the axis, so 0.25 mm
    thick, in a bar of 20 mm; two slots of 0.7 mm (radii 3 and 2.3 mm) of the other notch leave 18.6 mm of the width.
    Its steel is not named: 200 GPa. Between plane stress, as here, and a notch too wide to contract across.
    """
    thickness, width = 2 * (3.125e-3 - 3e-3), 20e-3 - 2 * (3e-3 - 2.3e-3)
    hinge = flexures.circular_notch(3e-3, thickness, width, STEEL)
    joint = flexures.crossed(hinge, hinge)
    assert joint.bending == pytest.approx([4.83, 4.83], rel=0.05)
    assert joint.bending[0] < 4.83 < joint.bending[0] / (1 - STEEL.poisson_ratio**2)
    assert joint.torsion == pytest.approx(260, rel=0.05)
    # The body between the two hinges, cut by both slots, yields as well. It is no part of the hinges: along the joint as
    # much again as they do, across it a quarter of the whole.
    assert joint.axial / 94.0e6 == pytest.approx(2.0, rel=0.05)
    assert joint.shear / 12.7e6 == pytest.approx([1.28, 1.28], rel=0.05)


def test_crossed_flexures_are_in_series():
    both = flexures.crossed(LEAF, flexures.leaf(20e-3, 0.4e-3, 10e-3, STEEL))
    assert both.bending[0] == pytest.approx(1 / (1 / LEAF.bending[0] + 1 / (200e9 * 0.4e-3 * 1e-6 / 12 / 20e-3)))
    assert both.bending[1] < both.bending[0]  # about the second one's soft axis
    assert both.axial == pytest.approx(1 / (1 / 50e6 + 1 / 40e6))
    assert both.moment < LEAF.moment
    assert both.angle == LEAF.angle  # the thinner one bends further


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: flexures.leaf(20e-3, 12e-3, 10e-3, STEEL), "thickness <= its width"),
        (lambda: flexures.leaf(1e-3, 2e-3, 10e-3, STEEL), "thickness <= its length"),
        (lambda: flexures.leaf(-1.0, 1e-3, 10e-3, STEEL), "length is -1.0 m"),
        (lambda: flexures.wire(1e-3, 2e-3, STEEL), "diameter <= its length"),
        (lambda: flexures.wire(np.nan, 2e-3, STEEL), "length is nan m"),
        (lambda: flexures.wire(2.0, 5e-324, STEEL), "diameter is 4.94066e-324 m; it must be between 1e-09 and 1000 m"),
        (lambda: flexures.leaf(1e300, 1e-3, 10e-3, STEEL), "length is 1e.300 m; it must be between"),
        (lambda: flexures.circular_notch(1e-3, 2e-3, 10e-3, STEEL), "thickness <= its radius"),
        (lambda: flexures.circular_notch(1e-3, 2e-9, 10e-3, STEEL), "must be >= radius"),
        (lambda: flexures.round_notch(1e-3, 0.0, STEEL), "diameter is 0"),
        (lambda: flexures.round_notch(1e-3, 1e-4, 200e9), "it must be a Material"),
        (lambda: flexures.round_notch(1e-3, 1e-4, flexures.Material(0.0, 1e6)), "youngs_modulus is 0"),
        (lambda: flexures.wire(1e-2, 1e-4, flexures.Material(5e-324, 1e6)), "at least 1e-100"),
        (lambda: flexures.round_notch(1e-3, 1e-4, flexures.Material(1e9, -1e6)), "strength is"),
        (lambda: flexures.round_notch(1e-3, 1e-4, flexures.Material(1e9, 1e6, 0.5)), "poisson_ratio is 0.5"),
        (lambda: flexures.crossed(LEAF, 3.0), "second is 3"),
        (lambda: flexures.leg_keys(3.0, WIRE), "at_base is 3"),
        (lambda: flexures.leg_keys(WIRE, LEAF), "Take a round flexure"),
    ],
)
def test_dimensions_that_no_flexure_has(call, words):
    with pytest.raises(fx.errors.ArgumentError, match=words):
        call()
