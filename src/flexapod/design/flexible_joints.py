"""Springs in the joints of the legs, and between base and platform beside the legs."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np

from flexapod.conventions import Array
from flexapod.design.value import Value
from flexapod.errors import DesignError

SHAPES = {"universal": (6, 2), "spherical": (6,), "torsion": (6,), "loss_factor": (6,)}
_ROUNDING = 1e-9  # relative: what printing with ten digits does to a matrix that is just semidefinite


@dataclass(frozen=True, eq=False, repr=False)
class JointStiffness(Value):
    """Rotational stiffness of the joints of the legs, such as of flexures; zero where left out.

    Parameters
    ----------
    universal : array_like
        Of the base joint about its first axis (fixed in the base) and its second, N m/rad: one number, a pair, six
        numbers or six pairs, stored as (6, 2). In the spin_free model, across the leg.
    spherical : array_like
        Of the platform joint, bending across the leg, N m/rad, one or six, stored as (6,).
    torsion : array_like
        Between leg and platform about the leg, N m/rad, one or six, stored as (6,). Flexures at both ends that twist
        are springs in series: 1 / (1 / k_1 + 1 / k_2).
    loss_factor : array_like
        Structural loss factor of these springs, one or six, stored as (6,).

    Raises
    ------
    DesignError
        For numbers of another shape, below zero, or not finite.

    Notes
    -----
    The joints are without moment in the rest pose of the design: `Legs.joint_rest`, or the home pose.

    Examples
    --------
    >>> joints = fx.design.JointStiffness(universal=[15.0, 20.0], spherical=15.0, torsion=10.0)
    >>> joints.universal[5].tolist()
    [15.0, 20.0]
    """

    universal: Array = field(default_factory=lambda: np.zeros((6, 2)))
    spherical: Array = field(default_factory=lambda: np.zeros(6))
    torsion: Array = field(default_factory=lambda: np.zeros(6))
    loss_factor: Array = field(default_factory=lambda: np.zeros(6))

    def __post_init__(self) -> None:
        self.set_checked("universal", self.universal, "legs.joint_stiffness.universal")
        if self.universal.shape == (6,):  # both axes of each joint
            self.hold("universal", np.stack([self.universal, self.universal], axis=1))
        for name, shape in SHAPES.items():
            self.set_checked(name, getattr(self, name), f"legs.joint_stiffness.{name}", shape)

    @property
    def any(self) -> bool:
        """Whether any joint has a stiffness."""
        return bool(self.universal.any() or self.spherical.any() or self.torsion.any())

    @property
    def given(self) -> bool:
        """Whether any number is not zero."""
        return any(getattr(self, item.name).any() for item in fields(self))


@dataclass(frozen=True, eq=False, repr=False)
class Suspension(Value):
    """A spring and damper between base and platform beside the legs, without force in the rest pose.

    Parameters
    ----------
    stiffness : array_like
        6 x 6, symmetric and positive semidefinite, in the axes of the base, translations (m) before rotations (rad):
        N/m, N/rad and N m/rad. Six numbers are its diagonal.
    damping : array_like, optional
        The same for velocities: N s/m, N s/rad and N m s/rad.
    point : array_like, optional
        Where on the platform it acts, platform frame, m, (3,); the origin where left out.

    Raises
    ------
    DesignError
        For matrices that are not symmetric, or not positive semidefinite.

    Notes
    -----
    Displacements are those of the point and the rotation vector of the platform from the rest pose, seen from the base:
    `Legs.joint_rest`, or the home pose.

    Examples
    --------
    >>> springs = fx.design.Suspension([2e4, 2e4, 5e4, 100.0, 100.0, 200.0])
    >>> springs.stiffness.shape
    (6, 6)
    """

    stiffness: Array = field(default_factory=lambda: np.zeros((6, 6)))
    damping: Array = field(default_factory=lambda: np.zeros((6, 6)))
    point: Array = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        for item in fields(self):
            self.set_checked(item.name, getattr(self, item.name), f"suspension.{item.name}")
        for name in ("stiffness", "damping"):
            _check_semidefinite(f"suspension.{name}", getattr(self, name))


def _check_semidefinite(name: str, matrix: Array) -> None:
    """Raises DesignError for a symmetric matrix by which some displacement gives energy."""
    diagonal = np.diag(matrix)
    negative = np.flatnonzero(diagonal < 0)
    if negative.size:
        i = negative[0]
        raise DesignError(
            f"{name}[{i}][{i}] is {diagonal[i]:.6g}; numbers on the diagonal must be >= 0. Check its sign."
        )
    root = np.sqrt(diagonal)
    bound = root[:, None] * root
    beyond = np.argwhere(np.abs(matrix) > (1 + _ROUNDING) * bound)
    if beyond.size:
        i, j = beyond[0]
        raise DesignError(
            f"{name} is not positive semidefinite: [{i}][{j}] is {matrix[i, j]:.6g}, beyond {bound[i, j]:.6g}, the "
            f"root of [{i}][{i}] times [{j}][{j}]. Check its signs, units and the order of rows: translations first."
        )
    scale = np.where(root > 0, root, 1.0)
    least = float(np.linalg.eigvalsh(matrix / scale[:, None] / scale)[0])
    if least < -_ROUNDING:
        raise DesignError(
            f"{name} is not positive semidefinite: scaled to ones on its diagonal, it has the eigenvalue {least:.3g}; "
            "none may be < 0. Check its signs, units and the order of its rows: translations first."
        )
