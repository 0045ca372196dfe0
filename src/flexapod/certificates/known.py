"""What is known of a region before anything is proved: its most adverse pose, by sweeps and descents."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from flexapod.certificates.question import Question, known_poses, none_known
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.workspace.box import Box, Workspace
from flexapod.workspace.descents import BoxSearch, SquaredFrequency
from flexapod.workspace.limit_margins import margins_to_keep, none_within
from flexapod.workspace.proof import Boxes, six_of
from flexapod.workspace.quantities import evaluate
from flexapod.workspace.worst import worst_pose

_SAMPLES, _STARTS = 2**13, 12  # of a region; each of its boxes gets a part of them
_FEWEST = 64
_ALONG = 2000  # poses along a path


class Known(NamedTuple):
    """The most adverse value that a pose was found to have, and the pose, (6,), or (12,) on a path."""

    value: float
    pose: Array
    singular: bool = False


def least_index(question: Question, threads: int) -> Known:
    """The least index that is known of a region. Raises PoseError where no pose can be computed, or none counts."""
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


def six_numbers_of(pose: Array, question: Question) -> Array:
    """Six numbers of a pose (6,) or (12,)."""
    if len(pose) == 6:
        return pose
    boxes = question.place.parts if isinstance(question.place, Boxes) else np.zeros((1, 6, 2))
    return six_of(pose, boxes)
