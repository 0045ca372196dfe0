"""What a study of the index over many poses says of the machine at rest at the pose of the least one.

The index leaves out weight and preload, so that it does not show by itself that a machine falls over.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError
from flexapod.mechanics.at_rest import pose_state
from flexapod.mechanics.cautions import UNHELD, Caution
from flexapod.pose import PoseLike

WHERE = "At the pose of the least index"


def cautions(
    hexapod: Hexapod, pose: PoseLike | None, joint: JointModel, what: str = WHERE, told: Collection[str] = UNHELD
) -> list[Caution]:
    """Whether the machine stands at a pose, and its legs along the axes of their joints. pose: None for home.

    what: words for the pose, or the machine.
    """
    if (pose is None and hexapod.home is None) or (isinstance(pose, np.ndarray) and not np.isfinite(pose).all()):
        return []
    try:
        found = pose_state(hexapod, pose, joint=joint).cautions
    except PoseError as error:
        return [Caution("least_index", f"{what}: {error}")]
    return [Caution(one.code, f"{what}: {one.text}", one.numbers) for one in found if one.code in told]
