"""Certificates checked anew: the same claim of the same design and region, proved by other boxes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from os import PathLike

import numpy as np

from flexapod.certificates import proving
from flexapod.certificates.certificate import Certificate
from flexapod.certificates.file import read_certificate
from flexapod.certificates.known import without_springs
from flexapod.certificates.question import Question
from flexapod.errors import ArgumentError
from flexapod.mechanics.joint_limits import check_limits
from flexapod.progress import ProgressLike, with_progress
from flexapod.workspace.proof import Boxes, Place, Prover, Standing, run
from flexapod.workspace.quantities import evaluate

CUT = 0.382  # where boxes are cut: elsewhere than in the proof
_ROUNDING = 1e-9  # relative, of a value at a pose computed anew


@with_progress("check of a certificate")
def check_certificate(
    certificate: Certificate | str | PathLike[str],
    *,
    time_limit: float | None = None,
    threads: int | None = None,
    progress: ProgressLike = None,
    stop: Callable[[], bool] | None = None,
) -> Certificate:
    """Prove what a certificate says anew, by boxes that are cut elsewhere.

    Parameters
    ----------
    certificate : Certificate, str or path-like
        The certificate, or its file.
    time_limit : float, optional
        How long to try, s.
    threads : int, optional
        Number of threads, default one for each core.
    progress : callable or False, optional
        Called with the share of the volume that is decided, from 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.
    stop : callable, optional
        Called often; when it returns True, the check ends with what it has.

    Returns
    -------
    Certificate
        What the check found: "proved" where all that the certificate says is proved is proved again, "refuted" where a
        pose breaks it, or breaks the claim as the certificate says itself.

    Raises
    ------
    OutputError
        If the file cannot be read, is no certificate, or was changed since it was written.
    ArgumentError
        If nothing is proved or refuted by it, or the pose that it names is not what it says.

    See Also
    --------
    certify : Make one.

    Notes
    -----
    Only the design, the joint model, the region and the bound are taken from the certificate. Boxes are cut at 38 % of
    their width instead of the middle, so that none of the boxes of the proof comes again.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> found = fx.certify(machine, fx.Box.about(fx.home_pose(machine), 0.02, 0.02))
    >>> fx.certificates.check_certificate(found).status
    'proved'
    """
    given = certificate if isinstance(certificate, Certificate) else read_certificate(certificate)
    setup = proving.Setup.of(time_limit=time_limit, threads=threads, progress=progress or None, stop=stop)
    _check_pose(given)
    if given.status == "refuted":
        return given
    level = _level(given)
    limits = given.within_limits or given.claim == "limits"
    prover = Prover(
        given.hexapod,
        given.joint,
        given.claim,
        given.place,
        limits,
        strays=given.strays,
        payload=given.payload,
        cut=CUT,
        threads=setup.threads,
    )
    found = run(prover, Standing("undecided", level, np.nan, given.place.parts), 0.0, setup.watch)
    return _made(given, level, found)


def _level(given: Certificate) -> float:
    """What is proved of the whole region."""
    level = {"index": given.lower, "condition": given.upper}.get(given.claim, 0.0 if given.proved else np.nan)
    if not (np.isfinite(level) and (level > 0 or given.claim in ("regular", "limits"))):
        raise ArgumentError(
            "this certificate is undecided and proves nothing of the whole region, so that there is nothing to check. "
            "Go on with it (resume)."
        )
    return float(level)


def _made(given: Certificate, level: float, found: Standing) -> Certificate:
    """The certificate of the check; the pose is that of the one that is checked, unless another breaks it."""
    asked = Question(
        given.hexapod,
        given.joint,
        given.place,
        given.within_limits,
        given.nominal,
        given.assumed,
        given.strays,
        given.payload,
    )
    bound = level if given.claim in ("index", "condition") else None
    made = proving.certificate(asked, given.claim, bound, given.gap, found)
    if found.status == "refuted":
        return made
    if given.claim == "index":
        made = replace(made, upper=given.upper)
    elif given.claim == "condition":
        made = replace(made, lower=given.lower)
    return replace(made, pose=given.pose, strayed=given.strayed)


def _check_pose(given: Certificate) -> None:
    """Raises ArgumentError where the pose of a certificate is not in its region, or has not what it says."""
    if given.pose is None:
        if given.status == "refuted":
            raise ArgumentError("the certificate says that a pose breaks the claim, and names none.")
        return
    if isinstance(given.place, Boxes) and not _inside(given.place, given.pose):
        raise ArgumentError(f"the pose of the certificate, {given.pose.tolist()}, is not in its region.")
    said, name = {"index": (given.upper, "omega_1"), "condition": (given.lower, "cond_H")}.get(given.claim, (None, ""))
    if said is not None:
        value = float(evaluate(given.adverse, given.pose[None], (name,), given.joint, 1)[name][0])
        scale = _omega_6(given) if name == "omega_1" else value
        if abs(value - said) > _ROUNDING * scale:
            raise ArgumentError(f"the pose of the certificate has {value:.9g}, and it says {said:.9g}.")
    if given.status == "refuted" and not _breaks(given):
        raise ArgumentError("the pose of the certificate does not break the claim, as it says.")


def _omega_6(given: Certificate) -> float:
    assert given.pose is not None
    return float(evaluate(given.adverse, given.pose[None], ("omega",), given.joint, 1)["omega"][0, -1])


def _inside(place: Place, pose: np.ndarray) -> bool:
    room = _ROUNDING * np.maximum(1.0, np.abs(place.parts).max(axis=(0, 2)))
    return bool(((place.parts[:, :, 0] - room <= pose) & (pose <= place.parts[:, :, 1] + room)).all(axis=1).any())


def _breaks(given: Certificate) -> bool:
    assert given.pose is not None
    if given.claim == "limits":
        return not check_limits(given.adverse, given.pose, joint=given.joint).ok
    if given.claim == "index" and given.broken:
        return bool(np.isnan(evaluate(given.adverse, given.pose[None], ("omega_1",), given.joint, 1)["omega_1"][0]))
    if given.claim == "index" and given.wanted is not None:
        return given.upper < given.wanted
    if given.claim == "condition":
        return given.wanted is not None and given.lower > given.wanted
    design = without_springs(given.adverse) if given.claim == "regular" else given.adverse
    omega = evaluate(design, given.pose[None], ("omega",), given.joint, 1)["omega"][0]
    return bool(omega[0] <= 1e-6 * omega[-1])
