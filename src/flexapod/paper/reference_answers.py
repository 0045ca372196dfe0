"""Answers of an independent engine that are stored with the package: states, and the platform's accelerations there.

The engine is Pinocchio, with the machine as a closed chain of rigid bodies (tests/oracles/closed_chain.py); the tests
check that the stored answers are what it gives.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.design.loading import load
from flexapod.paper.printed_errors import State
from flexapod.pose import Motion, Pose

_FILE = Path(__file__).parent / "engine.json"


class Answer(NamedTuple):
    """A state and the engine's accelerations (6,), m/s2 and rad/s2."""

    state: State
    engine: Array


def answers(kind: str) -> list[Answer]:
    """The answers of a kind: "moving", "spinning base", "carried" or "soft legs"."""
    stored = json.loads(_FILE.read_text(encoding="utf-8"))[kind]
    return [Answer(_state(case), np.array(case["engine"])) for case in stored]


def _state(case: dict[str, Any]) -> State:
    platform, base = (_motion(**case[body]) for body in ("platform", "base"))
    loads = (np.array(case[name]) for name in ("leg_force", "force", "moment"))
    return State(load(case["design"]).replace(case["changes"]), platform, base, *loads)


def _motion(position: Any, rotation: Any, **rates: Any) -> Motion:
    return Motion(Pose(position, rotation), **rates)


def disagreement(found: Array, engine: Array) -> tuple[float, float]:
    """Relative errors of the linear and of the angular acceleration."""
    parts = [(found[part], engine[part]) for part in (slice(3), slice(3, 6))]
    linear, angular = (float(np.linalg.norm(a - b) / np.linalg.norm(b)) for a, b in parts)
    return linear, angular
