"""What one simulation is given: a machine at rest, and what drives it from t = 0."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, replace
from typing import Literal

from numpy.typing import ArrayLike

from flexapod.checks import positive
from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, shown
from flexapod.excitation.excitation import Excitation
from flexapod.mechanics.inputs import as_hexapod, single_base, single_pose
from flexapod.mechanics.viscous_losses import viscous_equivalent
from flexapod.pose import Motion, Pose
from flexapod.showing import in_notebooks

Load = Excitation | ArrayLike | None
Start = Literal["rest", "carried"] | Pose | Motion | ArrayLike


@in_notebooks
@dataclass(frozen=True, eq=False)
class SimulationRun:
    """One simulation of `simulate_many`: a machine at rest on its base, and what drives it from t = 0.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, optional
        The equilibrium pose in the inertial frame, a Pose or x, y, z (m), roll, pitch, yaw (rad); the home pose by
        default. The legs' unstretched lengths are those that hold the platform there under gravity and the constant
        loads.
    base_motion : Excitation, optional
        Motion of the base (x, y, z in m, roll, pitch, yaw in rad) from its pose at rest, `base`.
    force, moment : Excitation or array_like, optional
        Force (N) and moment (N m) on the platform at its reference point, in the platform's axes: three constants, or
        an Excitation of x, y, z, which adds to the load at rest.
    leg_command : Excitation, optional
        Change of the unstretched lengths of legs "1" to "6", m.
    start : {"rest", "carried"}, Pose, Motion or array_like, optional
        State at t = 0: at the equilibrium with no velocity in the inertial frame ("rest"), moving rigidly with the base
        ("carried"), or a pose or motion of the platform in the inertial frame.
    base : Pose or array_like, optional
        Pose of the base at rest; the inertial frame by default.
    unstretched_length : array_like, optional
        Unstretched lengths of the legs, (6,) m, in place of those that hold the platform. The leg lengths at the pose
        let the platform ring under gravity.
    loss_frequency : float, optional
        Frequency, rad/s, at which viscous friction takes as much as the loss factors of the design, which it stands for
        (see `mechanics.viscous_equivalent`). Left out, loss factors are left out, with a warning.

    Raises
    ------
    ArgumentError
        If `base_motion` or `leg_command` is not an Excitation, or `base` is one.
    PoseError
        If `pose` or `base` is not one pose.

    See Also
    --------
    simulate_many : simulate many runs at once.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> run = fx.simulation.SimulationRun(hexapod, base_motion=fx.harmonic("z", 1e-6, 200.0))
    >>> fx.simulate_many([run], 0.01, samples=3).displacement.shape
    (1, 3, 6)
    """

    hexapod: Hexapod
    pose: Pose | ArrayLike | None = None
    _: KW_ONLY
    base_motion: Excitation | None = None
    force: Load = None
    moment: Load = None
    leg_command: Excitation | None = None
    start: Start = "rest"
    base: Pose | ArrayLike | None = None
    unstretched_length: ArrayLike | None = None
    loss_frequency: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "pose", single_pose(as_hexapod(self.hexapod), self.pose))
        if isinstance(self.base, Excitation):
            raise ArgumentError(
                "base is an Excitation; it must be the pose of the base at rest. Did you mean base_motion?"
            )
        object.__setattr__(self, "base", single_base(self.hexapod, self.base))
        if self.loss_frequency is not None:
            positive(self.loss_frequency, "loss_frequency", "rad/s")
        for name in ("base_motion", "leg_command"):
            value = getattr(self, name)
            if not (value is None or isinstance(value, Excitation)):
                raise ArgumentError(
                    f"{name} is {shown(value)}; it must be an Excitation, such as flexapod.harmonic makes one."
                )

    def with_friction(self, joint: JointModel) -> SimulationRun:
        """Give the run of the machine with friction in place of its loss factors, where `loss_frequency` is given."""
        if self.loss_frequency is None:
            return self
        machine = viscous_equivalent(self.hexapod, self.loss_frequency, self.pose, base=self.base, joint=joint)
        return replace(self, hexapod=machine, loss_frequency=None)

    def histories(self) -> dict[str, Excitation]:
        """Give what drives the machine in time, by name."""
        uses = {
            "base_motion": self.base_motion,
            "force": self.force,
            "moment": self.moment,
            "leg_command": self.leg_command,
        }
        return {name: use for name, use in uses.items() if isinstance(use, Excitation)}
