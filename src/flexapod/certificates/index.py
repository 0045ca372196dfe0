"""A lower bound of the stability index that is proved at every pose of a region."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike

from flexapod.certificates.certificate import Certificate
from flexapod.certificates.known import least_index
from flexapod.certificates.proving import Setup, prove
from flexapod.certificates.question import Asked, Question, Uncertainty, checked_gap, checked_level, question
from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.progress import ProgressLike, with_progress
from flexapod.workspace.store.dask_cluster import Cluster


@with_progress("certificate")
def certify(
    hexapod: Hexapod,
    region: Asked = None,
    *,
    at_least: float | None = None,
    gap: float = 0.01,
    joint: JointModel = "universal",
    within_limits: bool = False,
    uncertain: Uncertainty = (),
    time_limit: float | None = None,
    threads: int | None = None,
    cluster: Cluster | None = None,
    path: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: ProgressLike = None,
    stop: Callable[[], bool] | None = None,
) -> Certificate:
    """Prove that the stability index is at least a bound at every pose of a region, or find a pose where it is less.

    Parameters
    ----------
    hexapod : Hexapod
        The machine. Its numbers count as exact.
    region : Box, Workspace, Trajectory, Pose, array_like or sequence of Box, optional
        Where: a box in any of the six coordinates, several boxes, all of a path as it is run, or single poses. Default:
        the home pose.
    at_least : float, optional
        The bound to prove, rad/s. Left out, the closest bound is proved that is within `gap` of the least index.
    gap : float, optional
        How far the bound may be from what a pose has, as a share of that; where `at_least` is left out.
    joint : {"universal", "spin_free"}, optional
        Joint model.
    within_limits : bool, optional
        Whether only poses within the design's limits count. Default: all do.
    uncertain : Uncertain, Payload or sequence of them, optional
        Stiffnesses, masses, moments of inertia, payloads and their places, and places of joints and of the platform's
        mass centre that stray: the bound holds for every design in their ranges. How close it comes is limited by how
        far places stray, so that `gap` may not be reached.
    time_limit : float, optional
        How long to try, s; then the best bound that is proved is given.
    threads : int, optional
        Number of threads, default one for each core.
    cluster : Cluster, optional
        Computers that share the boxes, of `flexapod.workspace.cluster`.
    path : str or path-like, optional
        File in which the certificate is kept: written every minute, and at the end.
    resume : bool, optional
        Whether to go on with what is in the file.
    progress : callable or False, optional
        Called with the share of the volume that is decided, from 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.
    stop : callable, optional
        Called often; when it returns True, the proof ends with what it has.

    Returns
    -------
    Certificate
        Whether it is proved, refuted by a pose, or undecided; between which numbers the least index lies.

    Raises
    ------
    DesignError
        If `hexapod` is not a Hexapod.
    ArgumentError
        If a number is invalid, or uncertain numbers have no worst end.
    PoseError
        If no pose of the region can be computed, or none within the limits is found.
    OutputError
        If the file cannot be written, or cannot be gone on with.

    See Also
    --------
    worst_pose : The least index that is found, without a proof.
    certified_box : The largest box for which a bound holds.
    certify_regular : That no pose is singular.

    Notes
    -----
    omega_1^2 >= t at every pose of a box if K - t J is positive definite there, K being the stiffness of all springs at
    the platform: along the legs, in their joints, and a suspension. Its entries are enclosed by
    Taylor models of third order in the coordinates (Makino and Berz, 2003) with bounded rounding, and matrices at the
    corners of the box are tested [1]_; a box for which this does not decide is cut. What counts as exact are the
    numbers of the design and of the region. Places that stray are further variables of the models, of the first order,
    so that many of them cost little. A pose that leaves the range of the design's stiffness law has no index and
    refutes the claim, unless only poses within the limits count, of which that range is one.

    References
    ----------
    .. [1] J. Rohn, "Positive definiteness and stability of interval matrices", SIAM Journal on Matrix Analysis and
       Applications 15 (1994), 175-184.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> box = fx.Box.about(fx.home_pose(machine), 0.05, np.radians(2))
    >>> found = fx.certify(machine, box)
    >>> found.status, found.lower >= 0.99 * found.upper
    ('proved', True)
    >>> fx.certify(machine, box, at_least=30.0).status
    'refuted'
    """
    asked = question(hexapod, region, joint, uncertain, within_limits)
    wanted, gap = checked_level(at_least, "at_least", "rad/s"), checked_gap(gap)
    setup = Setup.of(
        time_limit=time_limit,
        threads=threads,
        progress=progress or None,
        stop=stop,
        cluster=cluster,
        path=path,
        resume=resume,
    )
    return prove_index(asked, wanted, gap, setup)


def prove_index(asked: Question, wanted: float | None, gap: float, setup: Setup) -> Certificate:
    """The certificate of a question about the index."""
    return prove(asked, "index", wanted, gap, setup, lambda: least_index(asked, setup.threads))
