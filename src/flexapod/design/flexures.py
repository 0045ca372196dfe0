"""Flexure joints from their dimensions: stiffness, and the moment and angle that their material bears."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from flexapod import checks
from flexapod.conventions import Array
from flexapod.design.beam_integrals import Integrals, notch, straight
from flexapod.design.rectangle_torsion import notch_half, straight_half, twist
from flexapod.errors import ArgumentError
from flexapod.showing import in_notebooks

RECTANGLE, ROUND = 6 / 5, 10 / 9  # by how much shear strains a section more than if its stress were uniform
SOFTEST = 1e-100  # Pa, a modulus below which compliances overflow
LEAST, MOST = 1e-9, 1e3  # m, between which all dimensions of parts that are made lie
SLENDER = 1e5  # radius over thickness, beyond which a notch is no part that is made


@in_notebooks
@dataclass(frozen=True)
class Material:
    """What a flexure is made of.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus in Pa.
    strength : float
        Largest stress that is allowed, Pa: for joints that move for years the fatigue limit with its margin of safety.
    poisson_ratio : float
        Poisson's ratio; 0.3 is that of steel and near that of aluminium and titanium.

    Examples
    --------
    >>> steel = fx.design.flexures.Material(200e9, 400e6)
    >>> round(steel.shear_modulus / 1e9, 1)
    76.9
    """

    youngs_modulus: float
    strength: float
    poisson_ratio: float = 0.3

    @property
    def shear_modulus(self) -> float:
        """Shear modulus in Pa."""
        return self.youngs_modulus / (2 * (1 + self.poisson_ratio))


@in_notebooks
class Flexure(NamedTuple):
    """Stiffness and strength of a flexure between two bodies, at its middle.

    Attributes
    ----------
    bending : ndarray
        Stiffness against bending, N m/rad, (2,): about the soft axis, and about the axis across it. A round flexure has
        both the same.
    torsion : float
        Stiffness against torsion about the flexure's length, N m/rad.
    axial : float
        Stiffness along the flexure, N/m.
    shear : ndarray
        Stiffness across the flexure, N/m, (2,), of a force through its middle: the first moves as bending about the
        soft axis does.
    moment : float
        Largest bending moment about a soft axis that the strength allows, N m, without other loads.
    angle : float
        The bending angle of that moment, rad.
    """

    bending: Array
    torsion: float
    axial: float
    shear: Array
    moment: float
    angle: float


def leaf(length: float, thickness: float, width: float, material: Material) -> Flexure:
    """A leaf spring: a thin plate of constant thickness between two bodies, bent about its width.

    Parameters
    ----------
    length, thickness, width : float
        Dimensions of the part that bends, m, with thickness <= width and thickness <= length.
    material : Material
        Its material.

    Returns
    -------
    Flexure
        Its stiffness and what it bears.

    Raises
    ------
    ArgumentError
        For dimensions or material that no leaf has.

    Notes
    -----
    A beam after Timoshenko, with the energy's shear coefficient 6/5. Torsion is that of Saint-Venant's rectangle
    (Timoshenko and Goodier, Theory of Elasticity, 1970, section 109) whose ends cannot warp (V. Z. Vlasov, Thin-Walled
    Elastic Beams, 1961), with the shear of a plate: a leaf three times as wide as long is seven times as stiff as one
    that warps freely. Finite elements between rigid bodies are stiffer than this by up to 8 % in torsion and 10 %
    across, where a leaf is too wide to contract across its width.

    Examples
    --------
    >>> flexures = fx.design.flexures
    >>> steel = flexures.Material(200e9, 400e6)
    >>> spring = flexures.leaf(20e-3, 0.5e-3, 10e-3, steel)
    >>> spring.bending.round(2).tolist(), round(spring.angle, 3)
    ([1.04, 416.67], 0.16)
    """
    length, thickness, width = _lengths(length=length, thickness=thickness, width=width)
    _check(material)
    _thin(thickness, "length", length)
    _thin(thickness, "width", width)
    torsion = 1 / twist(straight_half(length, thickness), width, material.youngs_modulus, material.shear_modulus)
    return _rectangular(straight(length, thickness), thickness, width, material, torsion, 1.0)


def wire(length: float, diameter: float, material: Material) -> Flexure:
    """A round wire between two bodies, which bends alike about every axis across it.

    Parameters
    ----------
    length, diameter : float
        Dimensions of the part that bends, m, with diameter <= length.
    material : Material
        Its material.

    Returns
    -------
    Flexure
        Its stiffness and what it bears.

    Raises
    ------
    ArgumentError
        For dimensions or material that no wire has.

    Notes
    -----
    A beam after Timoshenko, with the energy's shear coefficient 10/9.

    Examples
    --------
    >>> flexures = fx.design.flexures
    >>> flexures.wire(20e-3, 2e-3, flexures.Material(200e9, 400e6)).bending.round(2).tolist()
    [7.85, 7.85]
    """
    length, diameter = _lengths(length=length, diameter=diameter)
    _check(material)
    _thin(diameter, "length", length, "diameter")
    return _round(straight(length, diameter), diameter, material, 1.0)


def circular_notch(radius: float, thickness: float, width: float, material: Material) -> Flexure:
    """A plate with a half circle cut from both faces, bent about its width where it is thinnest.

    Parameters
    ----------
    radius : float
        Radius of the two half circles, m.
    thickness : float
        Least thickness, between them, m, at most the radius and at most the width.
    width : float
        Width of the plate, m.
    material : Material
        Its material.

    Returns
    -------
    Flexure
        Its stiffness and what it bears.

    Raises
    ------
    ArgumentError
        For dimensions or material that no such notch has.

    Notes
    -----
    The closed forms of Paros and Weisbord (How to design flexure hinges, Machine Design 37, 1965) in full, without
    their approximation for thin notches, with shear as in Lobontiu (Compliant Mechanisms, 2003). Torsion is that of
    Saint-Venant's rectangles that change along the notch and cannot warp at its ends, as in `leaf`: within 8 % of
    finite elements for notches thinner than a tenth of the radius, and up to 25 % softer for thick ones. The stress
    where it is thinnest is greater than a beam's by the factor of Neuber (Theory of Notch Stresses, 1958) for deep
    notches in bending, which is within 1 % of that of plane finite elements.

    The bodies beside a notch yield too, which beam theory does not know: with s = thickness / radius a plane
    finite-element model bends more easily by the factor 1 + 0.4 s - 0.105 s^2, and is longer by 1 + 0.6 s^(1/2) -
    0.27 s, which are in the result.

    This is plane stress. A notch much wider than (radius thickness)^(1/2) cannot contract across its width, and is
    stiffer in bending by up to 1 / (1 - poisson_ratio^2), 10 % for steel. A published joint of two crossed notches
    (T. Dehaeze, stewart-simscape, mat/flexor_025) has 4.83 N m/rad in bending and 260 N m/rad in torsion by finite
    elements, and 4.65 and 269 N m/rad here. Along its axis and across, where it has 94.0 and 12.7 N/um, its two
    notches alone are 2.0 and 1.3 times as stiff: the body between them, which the slots of both cut, yields too and is
    no part of a notch.

    Examples
    --------
    >>> flexures = fx.design.flexures
    >>> notch = flexures.circular_notch(3e-3, 0.3e-3, 8e-3, flexures.Material(200e9, 400e6))
    >>> notch.bending.round(2).tolist()
    [3.14, 1105.88]
    """
    radius, thickness, width = _lengths(radius=radius, thickness=thickness, width=width)
    _check(material)
    _notched(thickness, radius)
    _thin(thickness, "width", width)
    torsion = 1 / twist(notch_half(radius, thickness), width, material.youngs_modulus, material.shear_modulus)
    ratio = thickness / (2 * radius)
    root = sqrt(ratio)
    concentration = 4 * ratio * root / (3 * (root + (ratio - 1) * np.arctan(root)))
    beam = _rectangular(notch(radius, thickness), thickness, width, material, torsion, concentration)
    s = thickness / radius
    more = 1 + 0.4 * s - 0.105 * s**2
    bending = beam.bending / np.array([more, 1.0])
    return beam._replace(
        bending=bending, axial=beam.axial / (1 + 0.6 * sqrt(s) - 0.27 * s), angle=beam.moment / float(bending[0])
    )


def round_notch(radius: float, diameter: float, material: Material) -> Flexure:
    """A round bar with a groove of half circles turned into it, which bends alike about every axis across it.

    Parameters
    ----------
    radius : float
        Radius of the half circle that is turned into the bar, m.
    diameter : float
        Least diameter, m, at most the radius.
    material : Material
        Its material.

    Returns
    -------
    Flexure
        Its stiffness and what it bears.

    Raises
    ------
    ArgumentError
        For dimensions or material that no such notch has.

    Notes
    -----
    The two-axis hinge of Paros and Weisbord (1965), in full: beams after Timoshenko whose diameter varies, as in
    Lobontiu (Compliant Mechanisms, 2003). The stress where it is thinnest is greater than a beam's by the factor of
    Neuber (Theory of Notch Stresses, 1958) for deep grooves in bending.

    The bodies beside a notch yield too, which beam theory does not know: with s = diameter / radius a finite-element
    model of the body of revolution yields more by the factor 1 + (0.27 - 0.31 p) s in bending, 1 + 0.135 s - 0.01 s^2
    in torsion and 1 + 0.84 (1 - 0.9 p) s / (1 + 1.2 s) along, with Poisson's ratio p. These are in the result.

    Examples
    --------
    >>> flexures = fx.design.flexures
    >>> neck = flexures.round_notch(4e-3, 1e-3, flexures.Material(200e9, 400e6))
    >>> neck.bending.round(2).tolist(), round(neck.torsion, 2)
    ([4.88, 4.88], 3.8)
    """
    radius, diameter = _lengths(radius=radius, diameter=diameter)
    _check(material)
    _notched(diameter, radius, "diameter")
    ratio, poisson = diameter / (2 * radius), material.poisson_ratio
    root = sqrt(ratio + 1)
    deep = 3 * (ratio + 1) + (1 + 4 * poisson) * root + (1 + poisson) / (1 + root)
    concentration = 0.75 / deep * (root + 1) * (3 * ratio - (1 - 2 * poisson) * root + 4 + poisson)
    beam = _round(notch(radius, diameter), diameter, material, concentration)
    s = diameter / radius
    bending = beam.bending / (1 + (0.27 - 0.31 * poisson) * s)
    return beam._replace(
        bending=bending,
        torsion=beam.torsion / (1 + 0.135 * s - 0.01 * s**2),
        axial=beam.axial / (1 + 0.84 * (1 - 0.9 * poisson) * s / (1 + 1.2 * s)),
        angle=beam.moment / float(bending[0]),
    )


def crossed(first: Flexure, second: Flexure) -> Flexure:
    """A universal joint: two flexures in series at one place, the second turned by 90 degrees about their length.

    Parameters
    ----------
    first, second : Flexure
        The two, each by itself.

    Returns
    -------
    Flexure
        Both in series: `bending[0]` is about the first one's soft axis, `bending[1]` about the second one's. `moment`
        is the smaller one, and `angle` the angle at which the first of the two reaches its own.

    Raises
    ------
    ArgumentError
        For what is no flexure.

    Notes
    -----
    All stiffnesses in series. Flexures with a distance between their middles are not described by this: a force across
    them then also bends them.

    Examples
    --------
    >>> flexures = fx.design.flexures
    >>> notch = flexures.circular_notch(3e-3, 0.3e-3, 8e-3, flexures.Material(200e9, 400e6))
    >>> flexures.crossed(notch, notch).bending.round(2).tolist()
    [3.13, 3.13]
    """
    for value, name in ((first, "first"), (second, "second")):
        checks.instance(value, Flexure, name, "such as flexures.leaf gives")
    return Flexure(
        _series(first.bending, second.bending[::-1]),
        float(_series(first.torsion, second.torsion)),
        float(_series(first.axial, second.axial)),
        _series(first.shear, second.shear[::-1]),
        min(first.moment, second.moment),
        min(first.angle, second.angle),
    )


def leg_keys(at_base: Flexure, at_platform: Flexure) -> dict[str, Array | float]:
    """The keys of a design file for legs with these flexures at their two ends, for `Hexapod.replace`.

    Parameters
    ----------
    at_base : Flexure
        At the base joint: its first soft axis is the axis that is fixed in the base.
    at_platform : Flexure
        At the platform joint; it must bend alike about both axes.

    Returns
    -------
    dict
        `legs.joint_stiffness`' bending at both ends, and torsion, in which the two are in series; their axial stiffness
        as `legs.series_stiffness`; their moments as `limits.universal_moment` and `limits.spherical_moment`.

    Raises
    ------
    ArgumentError
        For what is no flexure, and for a platform joint whose two bending stiffnesses differ by more than 1 %.

    Notes
    -----
    What flexures yield across the leg (`shear`) is not part of the model of the machine, and a design has one bending
    stiffness at the platform joint.

    Examples
    --------
    >>> flexures = fx.design.flexures
    >>> neck = flexures.round_notch(4e-3, 1e-3, flexures.Material(200e9, 400e6))
    >>> keys = flexures.leg_keys(neck, neck)
    >>> round(float(keys["legs.joint_stiffness.torsion"]), 3)
    1.898
    """
    for value, name in ((at_base, "at_base"), (at_platform, "at_platform")):
        checks.instance(value, Flexure, name, "such as flexures.wire gives")
    if abs(at_platform.bending[0] - at_platform.bending[1]) > 0.01 * at_platform.bending.max():
        first, second = at_platform.bending
        raise ArgumentError(
            f"at_platform bends with {first:.6g} and {second:.6g} N m/rad about its two axes; a design has one bending "
            "stiffness at the platform joint. Take a round flexure there, or two equal ones that are crossed."
        )
    return {
        "legs.joint_stiffness.universal": at_base.bending,
        "legs.joint_stiffness.spherical": float(at_platform.bending.mean()),
        "legs.joint_stiffness.torsion": float(_series(at_base.torsion, at_platform.torsion)),
        "legs.series_stiffness": np.array([at_base.axial, at_platform.axial]),
        "limits.universal_moment": at_base.moment,
        "limits.spherical_moment": at_platform.moment,
    }


def _rectangular(
    over: Integrals, thickness: float, width: float, material: Material, torsion: float, concentration: float
) -> Flexure:
    """A flexure of rectangular sections; over: the integrals of its thickness."""
    young, shear = material.youngs_modulus, material.shear_modulus
    (flat, flat_across), (cubed, cubed_across) = over(1), over(3)
    bending = np.array([young * width / (12 * cubed), young * width**3 / (12 * flat)])
    slide = RECTANGLE * flat / (shear * width)
    across = 12 / (young * width) * np.array([cubed_across, flat_across / width**2])
    moment = material.strength * width * thickness**2 / (6 * concentration)
    return Flexure(bending, torsion, young * width / flat, 1 / (across + slide), moment, moment / float(bending[0]))


def _round(over: Integrals, diameter: float, material: Material, concentration: float) -> Flexure:
    """A flexure of round sections; over: the integrals of its diameter."""
    young, shear = material.youngs_modulus, material.shear_modulus
    (area, _), (inertia, inertia_across) = over(2), over(4)
    bending = pi * young / (64 * inertia)
    across = 64 * inertia_across / (pi * young) + ROUND * 4 * area / (pi * shear)
    moment = material.strength * pi * diameter**3 / (32 * concentration)
    return Flexure(
        np.full(2, bending),
        pi * shear / (32 * inertia),
        pi * young / (4 * area),
        np.full(2, 1 / across),
        moment,
        moment / bending,
    )


def _series(one: Array | float, other: Array | float) -> Array:
    return np.asarray(1 / (1 / np.asarray(one) + 1 / np.asarray(other)))


def _lengths(**values: float) -> list[float]:
    found = [checks.positive(value, name, "m") for name, value in values.items()]
    for name, value in zip(values, found, strict=True):
        if not LEAST <= value <= MOST:
            raise ArgumentError(
                f"{name} is {value:.6g} m; it must be between {LEAST:g} and {MOST:g} m. Check its unit."
            )
    return found


def _check(material: Material) -> None:
    checks.instance(material, Material, "material", "flexures.Material(youngs_modulus, strength, poisson_ratio)")
    if checks.positive(material.youngs_modulus, "youngs_modulus", "Pa") < SOFTEST:
        raise ArgumentError(f"youngs_modulus is {material.youngs_modulus:.6g} Pa; it must be at least {SOFTEST:g}.")
    checks.positive(material.strength, "strength", "Pa")
    if not 0 <= checks.number(material.poisson_ratio, "poisson_ratio") < 0.5:
        raise ArgumentError(f"poisson_ratio is {material.poisson_ratio:.6g}; it must be >= 0 and < 0.5.")


def _thin(value: float, other: str, limit: float, name: str = "thickness") -> None:
    if value > limit:
        raise ArgumentError(
            f"{name} is {value:.6g} m, and {other} is {limit:.6g} m; a flexure has its {name} <= its {other}. Exchange "
            "them if they are in the wrong order; a part as thick as this does not bend as a beam does."
        )


def _notched(value: float, radius: float, name: str = "thickness") -> None:
    _thin(value, "radius", radius, name)
    if value * SLENDER < radius:
        raise ArgumentError(f"{name} is {value:.6g} m with radius {radius:.6g} m; it must be >= radius / {SLENDER:g}.")
