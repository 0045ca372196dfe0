"""What is asked: a design, at its worst where it is uncertain, a region in numbers, and which of its poses count."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np

from flexapod.checks import number, positive
from flexapod.conventions import LEG_PAIRS, LEGS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.packing import PLACES
from flexapod.design.strays import MOST, Stray, rows_of, strayed
from flexapod.errors import ArgumentError, DesignError, PoseError, shown
from flexapod.mechanics.inputs import as_hexapod, as_joint
from flexapod.pose import Pose
from flexapod.workspace.box import Box, Workspace
from flexapod.workspace.limit_margins import refuse_force_limits
from flexapod.workspace.proof import Boxes, PathPieces, Place, Prover
from flexapod.workspace.region import Curve, RegionLike, as_region, home_of

MOST_BOXES = 10**6
_WIDEST = 4 * np.pi  # of a range of an angle, rad


@runtime_checkable
class Straying(Protocol):
    """A number of a design that is only known up to a spread, such as `fx.Uncertain`."""

    @property
    def words(self) -> str:
        """What is assumed, for readers."""
        ...

    def at_worst(self, hexapod: Hexapod) -> Hexapod:
        """The design with it at the end of its range at which the index is least at every pose."""
        ...

    def strays(self, hexapod: Hexapod) -> list[Stray]:
        """What it adds to the design, where it has no such end and the proof is for all of its range."""
        ...


@runtime_checkable
class Carried(Straying, Protocol):
    """A load on the platform beside that of the design, such as `fx.optimisation.Payload`."""

    def load(self, hexapod: Hexapod) -> tuple[float, ...]:
        """Its greatest mass, kg, and the middle of its place, m, (4,)."""
        ...


@runtime_checkable
class PolynomialCurve(Curve, Protocol):
    """A path whose pieces are polynomials, such as `fx.Trajectory`."""

    def polynomials(self) -> tuple[Array, Array, Array]:
        """Pieces, middle orientation and spans, as `flexapod.workspace.proof.PathPieces` has them."""
        ...


#: Whatever a certificate is asked for over.
Asked: TypeAlias = "RegionLike | Sequence[Box | Workspace]"
Uncertainty: TypeAlias = "Straying | Iterable[Straying]"


@dataclass(frozen=True)
class Question:
    """A design at its worst, and where; within_limits: whether only poses within its limits count.

    nominal: the digest of the design as it was given. assumed: what is uncertain, in words. strays: what may lie
    anywhere in a range. payload: where something strays, mass (kg) and place (m) of a load beside the design's, (4,),
    or nothing.
    """

    hexapod: Hexapod
    joint: JointModel
    place: Place
    within_limits: bool
    nominal: str
    assumed: tuple[str, ...]
    strays: tuple[Stray, ...] = ()
    payload: tuple[float, ...] = ()

    def design(self, values: Sequence[float] = ()) -> Hexapod:
        """The design whose strays have values from -1 to 1, none: 0. Raises ArgumentError where it is none."""
        try:
            return strayed(self.hexapod, self.strays, values, self.payload)
        except DesignError as error:
            raise ArgumentError(f"what is uncertain leads to what is no hexapod: {error}") from error

    def prover(self, kind: str, threads: int, limits: bool | None = None) -> Prover:
        """The prover of a claim, a name of `_core.CertificateKind`."""
        limits = self.within_limits if limits is None else limits
        return Prover(
            self.hexapod,
            self.joint,
            kind,
            self.place,
            limits,
            strays=self.strays,
            payload=self.payload,
            threads=threads,
        )


def question(
    hexapod: Hexapod,
    region: Asked,
    joint: JointModel,
    uncertain: Uncertainty = (),
    within_limits: bool = False,
) -> Question:
    """The question of some arguments. Raises DesignError, ArgumentError or PoseError for wrong ones."""
    as_joint(joint)
    place = place_of(as_hexapod(hexapod), region)
    if within_limits and not limited(hexapod):
        raise ArgumentError(
            f"within_limits is True, but {hexapod.name!r} has no limits, so that all poses are. Leave it out, or add "
            "[limits] to the design."
        )
    if within_limits:
        refuse_force_limits(hexapod)
        refuse_moments(hexapod, joint)
    given = listed(uncertain)
    worst, strays, payload = _ranges(hexapod, given)
    _check_strays(strays, within_limits)
    words = tuple(one.words for one in given)
    return Question(worst, joint, place, within_limits, hexapod.digest, words, tuple(strays), payload)


def listed(uncertain: Uncertainty) -> list[Straying]:
    """What is uncertain, one by one. Raises ArgumentError for what is no such thing."""
    given: list[Straying] = [uncertain] if isinstance(uncertain, Straying) else list(uncertain)
    for one in given:
        if not isinstance(one, Straying):
            raise ArgumentError(f"uncertain holds {shown(one)}; give fx.Uncertain or fx.optimisation.Payload.")
    return given


def _ranges(hexapod: Hexapod, given: list[Straying]) -> tuple[Hexapod, list[Stray], tuple[float, ...]]:
    """The design at its worst, what strays, and a payload that is no part of the design because something does."""
    worst, strays = hexapod, []  # type: tuple[Hexapod, list[Stray]]
    loads = [one for one in given if isinstance(one, Carried)]
    for one in given:
        more = one.strays(hexapod)
        if not more and one not in loads:
            worst = _at_worst(one, worst)
        strays += more
    if strays and len(loads) > 1:
        raise ArgumentError(
            f"uncertain holds {len(loads)} payloads; beside places that stray, one is proved. Put the others into the "
            "design (platform.mass, platform.mass_center, platform.inertia)."
        )
    if strays:
        return worst, strays, loads[0].load(hexapod) if loads else ()
    for load in loads:
        worst = _at_worst(load, worst)
    return worst, [], ()


def refuse_all_but_places(hexapod: Hexapod, uncertain: Uncertainty) -> None:
    """Raises ArgumentError for what is uncertain beside places: limits have no worst end of it."""
    for one in listed(uncertain):
        if isinstance(one, Carried) or not one.strays(hexapod):
            raise ArgumentError(
                f"{one.words}: limits are proved over uncertain places of joints alone. Leave it out, or certify the "
                "limits of several designs."
            )


def refuse_parted_joints(asked: Question) -> None:
    """Raises ArgumentError where legs share a joint that strays from itself: they would be two legs that touch."""
    hexapod = asked.hexapod
    if hexapod.limits.leg_distance is None or not asked.strays:
        return
    rows = rows_of(asked.strays)
    for plate, joints in (("base", hexapod.base_joints), ("platform", hexapod.platform_joints)):
        numbers = PLACES[f"{plate}.joints"]
        extent = np.ptp(joints, axis=0).max()
        for i, j in LEG_PAIRS:
            shared = np.abs(joints[i] - joints[j]).max() <= 1e-9 * extent
            if shared and (rows[:, numbers[i]] != rows[:, numbers[j]]).any():
                raise ArgumentError(
                    f"legs {LEGS[i]} and {LEGS[j]} share a joint of the {plate}, whose place is uncertain for each of "
                    "them, and the design limits their distance (limits.leg_distance). Leave that limit out, or let "
                    "all coordinates of the key stray together (each is False)."
                )


def _check_strays(strays: list[Stray], within_limits: bool) -> None:
    """Raises ArgumentError where so many numbers, or the limits of such a design, are more than can be proved."""
    numbers = [number for one in strays for number in one.numbers]
    if len(set(numbers)) < len(numbers):
        raise ArgumentError("uncertain names a number of the design twice. Give each of them once.")
    if len(strays) > MOST:
        raise ArgumentError(f"{len(strays)} places are uncertain independently; at most {MOST} are proved together.")
    if strays and within_limits:
        raise ArgumentError(
            f"{strays[0].words} is uncertain, and so is which poses are within the limits. Leave within_limits out, or "
            "certify several designs."
        )


def refuse_moments(hexapod: Hexapod, joint: JointModel) -> None:
    """Raises ArgumentError where a limit is one that is proved in the exact joint model only."""
    if joint == "spin_free" and hexapod.limits.universal_moment is not None:
        raise ArgumentError(
            f"{hexapod.name!r} limits the moment of its universal joints (limits.universal_moment); which poses keep "
            "that is proved in the exact joint model only. Take the joint model universal, or leave the limits out."
        )


def limited(hexapod: Hexapod) -> bool:
    """Whether a design limits its poses; the range of a stiffness law does."""
    return hexapod.limits.given or hexapod.legs.stiffness_law is not None


def _at_worst(one: Straying, hexapod: Hexapod) -> Hexapod:
    try:
        return one.at_worst(hexapod)
    except DesignError as error:
        raise ArgumentError(f"{one!r} leads to what is no hexapod: {error}") from error


def place_of(hexapod: Hexapod, region: Asked) -> Place:
    """A region in numbers. Raises ArgumentError or PoseError for what is none."""
    if isinstance(region, PolynomialCurve):
        pieces, middle, spans = region.polynomials()
        return PathPieces(pieces, middle, spans)
    if isinstance(region, list | tuple) and region and all(isinstance(one, Box | Workspace) for one in region):
        return Boxes(_checked(np.concatenate([_boxes(hexapod, one) for one in region])))
    return Boxes(_checked(_boxes(hexapod, region)))  # type: ignore[arg-type]


def _boxes(hexapod: Hexapod, region: RegionLike) -> Array:
    where = as_region(region)
    home = home_of(hexapod, where)
    box = where.box(home)
    if box is not None:
        return np.stack([box.low, box.high], axis=-1)[None]
    return np.repeat(where.rows(home, 0)[:, :, None], 2, axis=2)


def _checked(boxes: Array) -> Array:
    if len(boxes) > MOST_BOXES:
        raise ArgumentError(f"the region has {len(boxes)} boxes or poses; at most {MOST_BOXES} are proved together.")
    turn = float(np.ptp(boxes[:, 3:], axis=2).max())
    if turn > _WIDEST:
        raise ArgumentError(
            f"an angle of the region ranges over {np.degrees(turn):.4g} degrees; at most two turns make sense. Are its "
            "angles in rad?"
        )
    return boxes


def checked_level(value: float | None, name: str, unit: str) -> float | None:
    """What is to be proved: a number > 0, or None."""
    return None if value is None else positive(value, name, unit)


def checked_gap(gap: float) -> float:
    """A gap of bounds, a share above 0 and below 1."""
    if not 1e-9 <= number(gap, "gap") < 1:
        raise ArgumentError(f"gap is {gap}; it is a share of what a pose has, at least 1e-9 and below 1, as 0.01.")
    return float(gap)


def known_poses(place: Place, samples: int) -> Array:
    """Poses of a region, rows (n, 6) or, of a path, (n, 12): boxes of no width, or points along the path."""
    if isinstance(place, Boxes):
        return place.parts[:, :, 0]
    rows = []
    for piece, low, high in place.parts:
        at = np.linspace(low, high, max(2, samples // len(place.parts)))
        six = np.stack([np.polynomial.polynomial.polyval(at, one) for one in place.pieces[int(piece)]], axis=-1)
        rows.append(six)
    return rotated(np.concatenate(rows), place.middle)


def rotated(six: Array, middle: Array) -> Array:
    """Rows (n, 12), position and matrix, of positions and rotation vectors (n, 6) that turn a middle orientation."""
    from scipy.spatial.transform import Rotation

    matrices = Rotation.from_rotvec(six[:, 3:]).as_matrix() @ middle
    return Pose(six[:, :3], matrices).packed


def none_known(place: Place) -> PoseError:
    """What is told where no pose of a region can be computed."""
    return PoseError(f"none of the {len(place.parts)} poses can be computed. Look at the status of a sweep of them.")
