"""What is known of a region before anything is proved: its most adverse pose, by sweeps and descents."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from flexapod import _core
from flexapod.certificates.question import Question, known_poses, none_known, rotated
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.strays import strayed_numbers
from flexapod.mechanics.inputs import as_joint
from flexapod.mechanics.joint_limits import check_limits
from flexapod.workspace.box import Box, Workspace
from flexapod.workspace.descents import BoxSearch, SquaredFrequency
from flexapod.workspace.limit_margins import LimitMargins, margins_to_keep, none_within
from flexapod.workspace.proof import Boxes, Place, six_of
from flexapod.workspace.quantities import evaluate, kernel_limits
from flexapod.workspace.worst import worst_pose

_SAMPLES, _STARTS = 2**13, 12  # of a region; each of its boxes gets a part of them
_FEWEST = 64
_ALONG = 2000  # poses along a path
_ROUNDS = 3  # of a pose that is adverse and strays that are at it
Quantity: TypeAlias = Literal["omega_1", "cond_H"]


class Known(NamedTuple):
    """The most adverse value that a pose was found to have, and the pose, (6,), or (12,) on a path.

    strayed: of the strays in the design that has it; none: all are 0.
    """

    value: float
    pose: Array
    singular: bool = False
    strayed: tuple[float, ...] = ()


def least_index(question: Question, threads: int) -> Known:
    """The least index that is known of a region. Raises PoseError where no pose can be computed, or none counts."""
    return _most_adverse(question, threads, "omega_1", _least_index)


def _most_adverse(
    question: Question, threads: int, quantity: Quantity, search: Callable[[Question, int], Known]
) -> Known:
    """What a search finds for the design as it is, and for one whose strays are as adverse as may be at that pose."""
    found = search(of_strays(question), threads)
    if not question.strays or found.singular:
        return found
    for _ in range(_ROUNDS):
        there = strayed_from(question, found, quantity)
        if there.strayed == found.strayed:
            break
        other = search(of_strays(question, there.strayed), threads)._replace(strayed=there.strayed)
        found = other if other.singular or not worse_of(quantity, there.value, other.value) else there
        if found.singular:
            break
    return found


def worse_of(quantity: Quantity, value: Any, than: Any) -> Any:
    """Whether a value of a quantity is more adverse than another, or each of some values."""
    return value < than if quantity == "omega_1" else value > than


def of_strays(question: Question, values: tuple[float, ...] = ()) -> Question:
    """The question of the one design whose strays have these values, none: 0. Raises ArgumentError where it is none."""
    return replace(question, hexapod=question.design(values), strays=(), payload=())


def strayed_from(question: Question, known: Known, quantity: Quantity) -> Known:
    """The same pose with the strays at the ends to which their slopes there point, if that is more adverse."""
    each, own = np.arange(len(question.strays)), np.array(known.strayed or np.zeros(len(question.strays)))
    ends = np.tile(own, (2, len(own), 1))
    ends[0, each, each], ends[1, each, each] = -1.0, 1.0
    at_least, at_most = (_values(question, end, known.pose, quantity) for end in ends)
    signs = tuple(np.where(worse_of(quantity, at_most, at_least), 1.0, -1.0).tolist())
    value = _value(question, signs, known.pose, quantity)
    return known._replace(value=value, strayed=signs) if worse_of(quantity, value, known.value) else known


def _value(question: Question, values: tuple[float, ...], pose: Array, quantity: Quantity) -> float:
    design = question.design(values)
    return float(evaluate(design, pose[None], (quantity,), question.joint, 1)[quantity][0])


def _values(question: Question, values: Array, pose: Array, quantity: Quantity) -> Array:
    """(m,) a quantity of the designs whose strays have rows of values (m, n), unchecked."""
    designs = strayed_numbers(question.hexapod, question.strays, values, question.payload)
    joint, asked, limits = as_joint(question.joint), _core.SWEEP_ARRAYS[quantity], kernel_limits(question.hexapod)
    found = [_core.sweep(design, joint, pose[None], asked, limits, 1)[quantity][0] for design in designs]
    return np.array(found)


def _least_index(question: Question, threads: int) -> Known:
    free, rest = _free_boxes(question)
    found = [_least_of_box(question, box, len(free), threads) for box in free]
    if len(rest) or not free:
        found.append(_of_poses(question, rest, "omega_1", threads))
    return min(found, key=lambda one: one.value)


def legs_alone(question: Question) -> Question:
    """The question of a machine with nothing but springs along its legs: singular poses are those of its geometry.

    Within the limits, it stays as it is: springs say which poses these are.
    """
    if question.within_limits:
        return question
    return replace(question, hexapod=without_springs(question.hexapod))


def without_springs(hexapod: Hexapod) -> Hexapod:
    """A design without springs beside its legs, and without a stiffness law."""
    changes: dict[str, Any] = {}
    if hexapod.legs.stiffness_law is not None:
        changes |= {"legs.stiffness_law": None, "legs.stiffness": 1.0}
    if hexapod.legs.joint_stiffness.any:
        changes["legs.joint_stiffness"] = None
    if hexapod.suspension is not None:
        changes["suspension"] = None
    return hexapod.replace(changes) if changes else hexapod


def greatest_condition(question: Question, threads: int) -> Known:
    """The greatest cond(H) that is known of a region. Raises PoseError as `least_index`."""
    return _most_adverse(question, threads, "cond_H", _greatest_condition)


def _greatest_condition(question: Question, threads: int) -> Known:
    free, rest = _free_boxes(question)
    count = max(_FEWEST, _SAMPLES // max(1, len(free)))
    rows = [Workspace(box).rows(np.zeros(6), count) for box in free]
    found = [_of_poses(question, poses, "cond_H", threads) for poses in rows]
    if len(rest) or not free:
        found.append(_of_poses(question, rest, "cond_H", threads))
    return max(found, key=lambda one: one.value)


def _free_boxes(question: Question) -> tuple[list[Box], Array]:
    """The boxes that have a range, and the poses of the others or along the path."""
    place = question.place
    if not isinstance(place, Boxes):
        return [], known_poses(place, _ALONG)
    boxes = [Box(*part) for part in place.parts]
    free = np.array([bool(box.free) for box in boxes])
    return [box for box in boxes if box.free], known_poses(place, 0)[~free]


def _least_of_box(question: Question, box: Box, count: int, threads: int) -> Known:
    worst = worst_pose(
        question.hexapod,
        box,
        joint=question.joint,
        samples=max(_FEWEST, _SAMPLES // count),
        starts=max(2, _STARTS // count),
        threads=threads,
        all_poses=not question.within_limits,
    )
    return Known(worst.omega_1, worst.pose, worst.singular)


def _of_poses(question: Question, rows: Array, quantity: str, threads: int) -> Known:
    wanted = (quantity, *(("within_limits",) if question.within_limits else ()))
    found = evaluate(question.hexapod, rows, wanted, question.joint, threads)
    values = found[quantity]
    if not np.isfinite(values).any():
        raise none_known(question.place)
    if question.within_limits:
        values = np.where(found["within_limits"], values, np.nan)
        if not np.isfinite(values).any():
            raise none_within(len(rows))
    at = int(np.nanargmin(values) if quantity == "omega_1" else np.nanargmax(values))
    return Known(float(values[at]), rows[at], quantity == "omega_1" and found_singular(found, at))


def least_of_corners(question: Question, box: Box, threads: int) -> Known:
    """The least index at a box's corners; where all poses count, 0 of one that is outside the range of a law."""
    ends = [np.unique([low, high]) for low, high in zip(box.low, box.high, strict=True)]
    rows = np.stack(np.meshgrid(*ends, indexing="ij"), axis=-1).reshape(-1, len(ends))
    design = question.design()
    wanted = ("omega_1", *(("within_limits",) if question.within_limits else ()))
    found = evaluate(design, rows, wanted, question.joint, threads)
    values = np.nan_to_num(found["omega_1"])
    if question.within_limits:
        values = np.where(found["within_limits"], values, np.inf)
    at = int(values.argmin())
    return Known(float(values[at]), rows[at])


def beyond_limits(question: Question, parts: Array) -> tuple[Known, str] | None:
    """A pose in one of some parts, with strays at which it breaks a limit, and the limit; None where none is found.

    Pose and strays are at the ends to which the slopes in the middle point.
    """
    ends = np.vstack([np.zeros(len(question.strays)), np.eye(len(question.strays))])
    of_designs = [LimitMargins(question.design(values), joint=question.joint) for values in ends]
    for part in parts:
        six, half = middle_of(question.place, part)
        (margins, slopes), *others = [of_design(six) for of_design in of_designs]
        moved = np.array([values for values, _ in others]) - margins
        worst = int((margins - np.abs(moved).sum(axis=0) - np.abs(slopes) @ half).argmin())
        strays = tuple(np.where(moved[:, worst] > 0, -1.0, 1.0).tolist())
        at = six - np.sign(slopes[worst]) * half
        if not check_limits(question.design(strays), at, joint=question.joint).ok:
            return Known(float("nan"), at, strayed=strays), of_designs[0].names[worst]
    return None


def found_singular(found: dict[str, Array], at: int) -> bool:
    """Whether a pose of a sweep is singular."""
    return bool(found["status"][at] == 1)


def lowered(question: Question, at: Array) -> Known:
    """Where a descent on the index ends that begins at a pose (12,) of a region's boxes; the pose itself on a path."""
    index = SquaredFrequency(question.hexapod, question.joint, mode=1)
    place = question.place
    if not isinstance(place, Boxes):
        six = six_of(at, np.zeros((1, 6, 2)))
        return Known(index.root(six), at)
    six = six_of(at, place.parts)
    inside = ((place.parts[:, :, 0] <= six) & (six <= place.parts[:, :, 1])).all(axis=1)
    if not inside.any():
        return Known(index.root(six), six)
    box = Box(*place.parts[int(inside.argmax())])
    if not box.free:
        return Known(index.root(six), six)
    limits = margins_to_keep(question.hexapod, not question.within_limits, question.joint)
    end = BoxSearch(index, box, limits, 1, 0, 1).descend(six)
    return min(Known(index.root(six), six), Known(index.root(end), end), key=lambda one: one.value)


def middle_of(place: Place, part: Array) -> tuple[Array, Array]:
    """x, y, z, roll, pitch, yaw in the middle of a part of a region, and half its widths: none on a path."""
    if isinstance(place, Boxes):
        return part.mean(axis=1), np.ptp(part, axis=1) / 2
    piece, low, high = part
    six = np.array([np.polynomial.polynomial.polyval((low + high) / 2, one) for one in place.pieces[int(piece)]])
    return six_of(rotated(six[None], place.middle)[0], np.zeros((1, 6, 2))), np.zeros(len(six))


def six_numbers_of(pose: Array, question: Question) -> Array:
    """Six numbers of a pose (6,) or (12,)."""
    if len(pose) == 6:
        return pose
    boxes = question.place.parts if isinstance(question.place, Boxes) else np.zeros((1, 6, 2))
    return six_of(pose, boxes)
