"""The function that shows a machine in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import single_pose
from flexapod.optional import needed
from flexapod.pose import PoseLike

if TYPE_CHECKING:
    from flexapod.notebook.machine_view import MachineView


def view(hexapod: Hexapod, pose: PoseLike | None = None, *, joint: JointModel = "universal") -> MachineView:
    """Show a machine in a notebook: in 3-D, with sliders of its pose and modes that move.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Where it stands at first, one pose: a Pose, or x, y, z in m and roll, pitch, yaw in rad. Left out, the home
        pose.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    MachineView
        A widget (of anywidget) that shows itself where a cell ends with it. Its traits are `pose`, a Pose, and `mode`,
        the mode that moves, from 1 to 6, or None. Both follow the controls, can be set, and can be watched by
        `view.observe(function, "pose")`. `view.hexapod` is the machine.

    Raises
    ------
    PoseError
        For a batch of poses, or a pose that no leg can take; the same where `view.pose` is set.
    ArgumentError
        For an unknown joint model.
    MissingExtraError
        Where the extra "notebook" is not installed.

    See Also
    --------
    flexapod.animate_mode : A mode as a file that moves.

    Notes
    -----
    The frequencies are those of `natural_modes` (Eq. 5 of the paper), the cautions those of the report. Nothing is
    loaded from a network. The widget's sliders have mm and degrees, `pose` has m and rad.

    Examples
    --------
    >>> view = fx.view(fx.load("motion-base"))
    >>> view.pose = [0.1, 0, 2.4, 0, 0.1, 0]
    >>> view.pose
    Pose(x=0.1 y=0 z=2.4 m, roll=0 pitch=5.7296 yaw=0 deg)
    >>> view.mode = 1  # moves from now on
    """
    start = single_pose(hexapod, pose)
    needed("anywidget", "notebook", "a view of the machine in a notebook needs anywidget")
    from flexapod.notebook.machine_view import MachineView

    return MachineView(hexapod, start, joint)
