"""The widget behind `flexapod.view`. It needs anywidget, so it is imported when a view is made."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import anywidget
import traitlets

from flexapod.checks import whole
from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, FlexapodError
from flexapod.mechanics.inputs import single_pose
from flexapod.pose import Pose
from flexapod.report.notebook import at_pose
from flexapod.web.geometry import in_degrees, pose_at
from flexapod.web.plain import plain
from flexapod.web.pose_ranges import drawn
from flexapod.web.state import snapshot


class _PoseTrait(traitlets.TraitType[Pose, Any]):
    """A pose that the legs can take; None is the home pose."""

    def validate(self, obj: Any, value: Any) -> Pose:
        pose = single_pose(obj.hexapod, value)
        obj.state_at(_six(pose))
        return pose

    def set(self, obj: Any, value: Any) -> None:
        """Set it; sliders that ask for a pose which was refused return, whether or not it is another pose."""
        super().set(obj, value)
        obj.settle()


class _ModeTrait(traitlets.TraitType[int | None, Any]):
    """The number of a mode, or None."""

    def validate(self, obj: Any, value: Any) -> int | None:
        if value is None:
            return None
        if whole(value, "mode") > 6:
            raise ArgumentError(f"mode is {value!r}; it must be a mode from 1 to 6, or None for none that moves.")
        return int(value)


class MachineView(anywidget.AnyWidget):
    """A machine in 3-D with its sliders and modes, as `flexapod.view` makes it.

    What a page needs is in the traits that are synchronised: the machine (`_drawn`), the pose that is asked for in m
    and degrees (`_six`), the answer (`_snapshot`), or why there is none (`_refused`). Where the pose that is asked for
    is refused, `pose` is still that of the machine which is shown.
    """

    _esm = Path(__file__).parent / "static" / "view.js"

    pose = _PoseTrait()
    mode = _ModeTrait(default_value=None, allow_none=True).tag(sync=True)
    _drawn: Any = traitlets.Dict().tag(sync=True)
    _six: Any = traitlets.List().tag(sync=True)
    _snapshot: Any = traitlets.Dict().tag(sync=True)
    _refused: Any = traitlets.Dict(default_value=None, allow_none=True).tag(sync=True)

    _last: tuple[list[float], dict[str, Any]] = ([], {})

    def __init__(self, hexapod: Hexapod, pose: Pose, joint: JointModel = "universal") -> None:
        self.hexapod, self.joint = hexapod, joint
        six = _six(pose)
        start = None if hexapod.home is not None else six
        super().__init__(_drawn=plain(drawn(hexapod, start)), _six=six, _snapshot=self.state_at(six), pose=pose)

    def state_at(self, six: list[float]) -> dict[str, Any]:
        """What is shown of the machine at a pose in m and degrees. Raises PoseError where it can take none."""
        if six != self._last[0]:  # a pose is asked for once to be checked, and once to be shown
            self._last = six, plain(snapshot(self.hexapod, six, self.joint))
        return self._last[1]

    @traitlets.observe("pose")
    def _placed(self, change: Any) -> None:
        """The pose was set, here or by a slider: only what was set here is not shown yet."""
        if pose_at(self._snapshot["pose"]) != change.new:
            self._show(_six(change.new), change.new)

    @traitlets.observe("_six")
    def _asked(self, change: Any) -> None:
        """A slider was moved, or follows a pose that was set here and is shown already."""
        self._refused = None
        if change.new == self._snapshot["pose"]:
            return
        try:
            self.state_at(change.new)
        except FlexapodError as error:
            self._refused = {"pose": change.new, "words": str(error)}
        else:
            self._show(change.new, pose_at(change.new))

    def settle(self) -> None:
        """Have the sliders where the machine is, if they are where it cannot go."""
        if self._refused:
            self._show(_six(self.pose), self.pose)

    def _show(self, six: list[float], pose: Pose) -> None:
        state = self.state_at(six)
        with self.hold_sync():
            self._snapshot, self._refused = state, None
            self._six, self.pose = six, pose

    def __repr__(self) -> str:
        return f"<view of {self.hexapod.name} at {self.pose}>"

    def _repr_mimebundle_(self, **kwargs: Any) -> tuple[dict[str, Any], dict[str, Any]] | None:
        """The widget; and a picture of it for what shows no widgets."""
        bundle: tuple[dict[str, Any], dict[str, Any]] | None = super()._repr_mimebundle_(**kwargs)
        if bundle is None:
            return None
        data, metadata = bundle
        return {**data, "text/html": at_pose(self.hexapod, self.pose, self.joint)}, metadata


def _six(pose: Pose) -> list[float]:
    """A pose in m and degrees."""
    return in_degrees([*pose.position, *pose.rpy])
