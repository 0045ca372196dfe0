"""Other claims about every pose of a region: none is singular, cond(H) is bounded, the limits are kept."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike

from flexapod.certificates.certificate import Certificate
from flexapod.certificates.known import greatest_condition, least_index, legs_alone
from flexapod.certificates.proving import Setup, prove
from flexapod.certificates.question import (
    Asked,
    Uncertainty,
    checked_gap,
    checked_level,
    limited,
    question,
    refuse_all_but_places,
    refuse_moments,
    refuse_parted_joints,
)
from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.progress import ProgressLike, with_progress
from flexapod.workspace.limit_margins import refuse_force_limits
from flexapod.workspace.store.dask_cluster import Cluster


@with_progress("certificate")
def certify_regular(
    hexapod: Hexapod,
    region: Asked = None,
    *,
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
    """Prove that no pose of a region is singular, or find one that is.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    region : Box, Workspace, Trajectory, Pose, array_like or sequence of Box, optional
        Where, as for `certify`. Default: the home pose.
    within_limits : bool, optional
        Whether only poses within the design's limits count.
    uncertain : Uncertain or sequence of them, optional
        Places of joints that stray, as for `certify`; other numbers of a design do not matter here.
    time_limit, threads, cluster, path, resume, progress, stop : optional
        As for `certify`.

    Returns
    -------
    Certificate
        Proved, refuted by a pose at which det H is zero, or undecided.

    Raises
    ------
    DesignError
        If `hexapod` is not a Hexapod.
    ArgumentError
        If a number is invalid.
    PoseError
        If no pose of the region can be computed, or none within the limits is found.
    OutputError
        If the file cannot be written, or cannot be gone on with.

    See Also
    --------
    certify : A bound on the stability index.

    Notes
    -----
    As `certify` with a bound of zero, after a search for a singular pose like that of `worst_pose`. A box in which
    det H has both signs is refuted: between the two poses there is a singular one. Other interval methods for this are
    in chapter 6 of Merlet, *Parallel Robots* (2006).

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> fx.certify_regular(machine, fx.Workspace.about_home(0.1, 0.1)).status
    'proved'
    """
    asked = question(hexapod, region, "universal", uncertain, within_limits)
    setup = Setup.of(
        time_limit=time_limit,
        threads=threads,
        progress=progress or None,
        stop=stop,
        cluster=cluster,
        path=path,
        resume=resume,
    )
    return prove(asked, "regular", None, 0.0, setup, lambda: least_index(legs_alone(asked), setup.threads))


@with_progress("certificate")
def certify_limits(
    hexapod: Hexapod,
    region: Asked = None,
    *,
    joint: JointModel = "universal",
    uncertain: Uncertainty = (),
    time_limit: float | None = None,
    threads: int | None = None,
    cluster: Cluster | None = None,
    path: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: ProgressLike = None,
    stop: Callable[[], bool] | None = None,
) -> Certificate:
    """Prove that every pose of a region is within the design's limits, or find one that is not.

    Parameters
    ----------
    hexapod : Hexapod
        The machine, with limits.
    region : Box, Workspace, Trajectory, Pose, array_like or sequence of Box, optional
        Where, as for `certify`. Default: the home pose.
    joint : {"universal", "spin_free"}, optional
        Joint model, which only moments in universal joints depend on; these are proved in the exact one.
    uncertain : Uncertain or sequence of them, optional
        Places of joints that stray: every design in their ranges keeps its limits.
    time_limit, threads, cluster, path, resume, progress, stop : optional
        As for `certify`.

    Returns
    -------
    Certificate
        Proved, refuted by a pose with the limit that it breaks, or undecided.

    Raises
    ------
    DesignError
        If `hexapod` is not a Hexapod.
    ArgumentError
        If the design has no limits, one that is not proved in this joint model, something else than places is
        uncertain, legs share a joint that strays for each of them while their distance is limited, or a number is
        invalid.
    PoseError
        If the region is none.
    OutputError
        If the file cannot be written, or cannot be gone on with.

    See Also
    --------
    check_limits : The limits at poses.

    Notes
    -----
    Lengths of legs, angles of joints, distances of legs and moments of springs in joints are enclosed over boxes as the
    index is, see `certify`. The limits are those of `check_limits`: the range of a stiffness law is one of them, and
    moments are those of the exact joint model. Where joints stray, so do the directions from which angles are measured:
    those of the legs at the home pose, and where springs are unstressed.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> fx.certify_limits(machine, fx.Workspace.about_home(0.05, 0.05)).status
    'proved'
    """
    asked = question(hexapod, region, joint, uncertain)
    refuse_all_but_places(hexapod, uncertain)
    refuse_parted_joints(asked)
    if not limited(hexapod):
        raise ArgumentError(f"{hexapod.name!r} has no limits, so that there is nothing to prove. Add [limits] to it.")
    refuse_force_limits(hexapod)
    refuse_moments(hexapod, joint)
    setup = Setup.of(
        time_limit=time_limit,
        threads=threads,
        progress=progress or None,
        stop=stop,
        cluster=cluster,
        path=path,
        resume=resume,
    )
    return prove(asked, "limits", None, 0.0, setup)


@with_progress("certificate")
def certify_condition_number(
    hexapod: Hexapod,
    region: Asked = None,
    *,
    at_most: float | None = None,
    gap: float = 0.01,
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
    """Prove that the condition number of H is at most a bound at every pose of a region.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    region : Box, Workspace, Trajectory, Pose, array_like or sequence of Box, optional
        Where, as for `certify`. Default: the home pose.
    at_most : float, optional
        The bound to prove, in metres as the quantity cond_H of `sweep`. Left out, the closest bound is proved that is
        within `gap` of the greatest.
    gap : float, optional
        How far the bound may be from what a pose has, as a share of that.
    within_limits : bool, optional
        Whether only poses within the design's limits count.
    uncertain : Uncertain or sequence of them, optional
        Places of joints that stray, as for `certify`; other numbers of a design do not matter here.
    time_limit, threads, cluster, path, resume, progress, stop : optional
        As for `certify`.

    Returns
    -------
    Certificate
        Proved, refuted by a pose, or undecided; the greatest condition number lies between `lower` and `upper`.

    Raises
    ------
    DesignError
        If `hexapod` is not a Hexapod.
    ArgumentError
        If a number is invalid.
    PoseError
        If no pose of the region can be computed, or none within the limits is found.
    OutputError
        If the file cannot be written, or cannot be gone on with.

    See Also
    --------
    condition_number : At poses.

    Notes
    -----
    cond(H) <= c over a box if for some mu both H H^T - mu E and c^2 mu E - H H^T are positive definite there, which is
    tested as in `certify`.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> found = fx.certify_condition_number(machine, fx.Workspace.about_home(0.05, 0.05), at_most=5.0)
    >>> found.status
    'proved'
    """
    asked = question(hexapod, region, "universal", uncertain, within_limits)
    wanted, gap = checked_level(at_most, "at_most", ""), checked_gap(gap)
    setup = Setup.of(
        time_limit=time_limit,
        threads=threads,
        progress=progress or None,
        stop=stop,
        cluster=cluster,
        path=path,
        resume=resume,
    )
    return prove(asked, "condition", wanted, gap, setup, lambda: greatest_condition(asked, setup.threads))
