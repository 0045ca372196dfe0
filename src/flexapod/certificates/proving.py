"""What the certificates have in common: a proof with a watch beside it and a file behind it, made a certificate."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import numpy as np

from flexapod import _core
from flexapod.certificates import file
from flexapod.certificates.certificate import Certificate, Claim
from flexapod.certificates.known import Known, beyond_limits, lowered, of_strays, six_numbers_of, strayed_from
from flexapod.certificates.question import Question
from flexapod.checks import positive, stop_asked, thread_count
from flexapod.conventions import LEG_PAIRS, LEGS
from flexapod.errors import ArgumentError, OutputError, shown
from flexapod.output_files import check_file, output_path
from flexapod.workspace.proof import Standing, Watch, closest, run
from flexapod.workspace.store.dask_cluster import Cluster

KEEP = 60.0  # s between two times that a certificate is written
_TRIED = 100  # parts that are left, of which it is seen whether a limit breaks in them
_UNKNOWN = np.full(12, np.nan)
_CLOSE = 1e-9  # relative, of numbers that went through a file or a root


@dataclass(frozen=True)
class Setup:
    """How a proof is run: threads, the watch beside it, and the file that keeps it."""

    threads: int
    watch: Watch
    path: Path | None
    resume: bool

    @classmethod
    def of(
        cls,
        *,
        time_limit: float | None,
        threads: int | None,
        progress: Callable[[float], object] | None,
        stop: Callable[[], bool] | None,
        cluster: Cluster | None = None,
        path: str | PathLike[str] | None = None,
        resume: bool = False,
        most: float = np.inf,
    ) -> Setup:
        """From the arguments that every certificate has. most: boxes. Raises ArgumentError or OutputError."""
        until = np.inf if time_limit is None else time.monotonic() + positive(time_limit, "time_limit", "s")
        if resume and path is None:
            raise ArgumentError("resume is True, but no path is given: what is to be gone on with? Give the file.")
        if cluster is not None and not isinstance(cluster, Cluster):
            raise ArgumentError(
                f"cluster is {shown(cluster)}; it must be what flexapod.workspace.cluster gives, or None."
            )
        take = None if cluster is None else cluster.take_turn
        watch = Watch(progress=progress, stop=stop_asked(stop), until=until, most=most, take=take)
        place = None if path is None else check_file(output_path(path))
        return cls(thread_count(threads), watch, place, resume)


def prove(
    asked: Question,
    claim: Claim,
    wanted: float | None,
    gap: float,
    setup: Setup,
    known: Callable[[], Known] | None = None,
) -> Certificate:
    """The certificate of a claim. known: finds the most adverse pose that is known before; for claims with a bound."""
    earlier = _earlier(asked, claim, wanted, gap, setup)
    if earlier is not None and earlier.status != "undecided":
        return earlier
    keeper = _Keeper(asked, claim, wanted, gap, setup.path)
    watch = replace(setup.watch, keep=keeper)
    prover = asked.prover(claim, setup.threads, limits=True if claim == "limits" else None)
    start = _begun(asked, wanted, known) if earlier is None else _gone_on(earlier, wanted, gap)
    if _broken(claim, wanted, start):
        found = replace(start, status="refuted")
    elif wanted is None and claim in ("index", "condition") and (earlier is None or len(start.left) == 0):
        found = closest(prover, start, gap, watch)
    else:
        found = run(prover, start, gap if wanted is None and claim in ("index", "condition") else 0.0, watch)
    return keeper.last(found)


def _begun(asked: Question, wanted: float | None, known: Callable[[], Known] | None) -> Standing:
    """Where a proof begins: nothing is proved."""
    level = np.nan if wanted is None else wanted
    if known is None:
        return Standing("undecided", level, np.nan, asked.place.parts)
    first = known()
    status = "refuted" if first.singular and wanted is None else "undecided"
    return Standing(status, level, first.value, asked.place.parts, at=first.pose, strayed=first.strayed)


def _broken(claim: Claim, wanted: float | None, start: Standing) -> bool:
    """Whether a pose that is known breaks the claim."""
    if wanted is None or np.isnan(start.value):
        return start.status == "refuted"
    return start.value < wanted if claim == "index" else claim == "condition" and start.value > wanted


def _gone_on(earlier: Certificate, wanted: float | None, gap: float) -> Standing:
    """Where an undecided proof goes on; without parts left where the last of its bounds was not the wanted one."""
    index = earlier.claim == "index"
    value = earlier.upper if index else earlier.lower
    floor = earlier.lower if index else earlier.upper
    aim = value * (1 - gap if index else 1 + gap)
    close = earlier.level >= aim * (1 - _CLOSE) if index else earlier.level <= aim * (1 + _CLOSE)
    pose = _UNKNOWN if earlier.pose is None else earlier.pose
    return Standing(
        status="undecided",
        level=earlier.level,
        value=value,
        left=earlier.left if wanted is not None or close or np.isnan(value) else earlier.left[:0],
        floor=floor if floor > 0 else np.nan,
        at=pose,
        strayed=earlier.strayed,
        decided=1.0 - earlier.share_left,
        outside=earlier.share_outside,
        boxes=earlier.boxes,
        seconds=earlier.seconds,
    )


def _earlier(asked: Question, claim: Claim, wanted: float | None, gap: float, setup: Setup) -> Certificate | None:
    """What the file has of the same question. Raises OutputError where it is of another one."""
    if not setup.resume or setup.path is None or not setup.path.exists():
        return None
    found = file.read_certificate(setup.path)
    given = _identity(asked, claim, wanted, gap)
    there = {
        "claim": found.claim,
        "design": found.hexapod.digest,
        "joint model": found.joint,
        "region": file.region_data(found.place),
        "bound": found.wanted,
        "gap": found.gap,
        "within_limits": found.within_limits,
        "uncertain places": (found.strays, found.payload),
    }
    other = [name for name, value in given.items() if there[name] != value]
    if other:
        raise OutputError(
            f"{setup.path} is the certificate of another question: its {' and '.join(other)} differ. Give the same "
            "arguments, or another file."
        )
    return found


def _identity(asked: Question, claim: Claim, wanted: float | None, gap: float) -> dict[str, object]:
    return {
        "claim": claim,
        "design": asked.hexapod.digest,
        "joint model": asked.joint,
        "region": file.region_data(asked.place),
        "bound": wanted,
        "gap": gap,
        "within_limits": asked.within_limits,
        "uncertain places": (asked.strays, asked.payload),
    }


class _Keeper:
    """Makes certificates of standings, and writes them: every minute, and the last."""

    def __init__(self, asked: Question, claim: Claim, wanted: float | None, gap: float, path: Path | None) -> None:
        self._of = asked, claim, wanted, gap
        self._path = path
        self._next = time.monotonic() + KEEP

    def __call__(self, standing: Standing) -> None:
        if self._path is not None and time.monotonic() >= self._next:
            file.write_certificate(certificate(*self._of, standing), self._path)
            self._next = time.monotonic() + KEEP

    def last(self, standing: Standing) -> Certificate:
        """The certificate at the end; its pose is what a descent finds from that of the proof."""
        asked, claim = self._of[:2]
        met = len(standing.at) == len(_UNKNOWN) and bool(np.isfinite(standing.at).all())  # by the prover
        if claim == "index" and standing.status != "undecided" and met and standing.broken < 0:
            better = lowered(of_strays(asked), standing.at)
            if asked.strays:
                better = strayed_from(asked, better, "omega_1")
            if better.value < standing.value:
                standing = replace(standing, value=better.value, at=better.pose, strayed=better.strayed)
        words = ""
        if claim == "limits" and standing.status == "undecided" and asked.strays:
            standing, words = _strayed_beyond(asked, standing)
        found = certificate(*self._of, standing)
        if words:
            found = replace(found, broken=words)
        if self._path is not None:
            file.write_certificate(found, self._path)
        return found


def _strayed_beyond(asked: Question, standing: Standing) -> tuple[Standing, str]:
    """The standing with a design of the ranges and a pose that break a limit, and its words, if a part has such."""
    beyond = beyond_limits(asked, standing.left[:_TRIED])
    if beyond is not None:
        found, words = beyond
        return replace(standing, status="refuted", at=found.pose, strayed=found.strayed), words
    return standing, ""


def certificate(asked: Question, claim: Claim, wanted: float | None, gap: float, standing: Standing) -> Certificate:
    """The certificate of a proof that came so far."""
    known, floor = standing.value, standing.floor
    bounds = {
        "index": (0.0 if np.isnan(floor) else floor, known),
        "condition": (known, np.inf if np.isnan(floor) else floor),
    }
    lower, upper = bounds.get(claim, (np.nan, np.nan))
    return Certificate(
        claim=claim,
        status=standing.status,  # type: ignore[arg-type]
        hexapod=asked.hexapod,
        joint=asked.joint,
        place=asked.place,
        wanted=wanted,
        gap=gap,
        within_limits=asked.within_limits,
        assumed=asked.assumed,
        nominal=asked.nominal,
        strays=asked.strays,
        payload=asked.payload,
        strayed=standing.strayed,
        lower=lower,
        upper=upper,
        pose=six_numbers_of(standing.at, asked) if np.isfinite(standing.at).all() else None,
        broken=_broken_limit(standing),
        level=standing.level,
        left=standing.left,
        share_left=1.0 - standing.decided,
        share_outside=standing.outside,
        boxes=standing.boxes,
        seconds=standing.seconds,
    )


def _broken_limit(standing: Standing) -> str:
    """The limit that a pose breaks, in words."""
    if standing.broken < 0:
        return ""
    limit = _core.BrokenLimit(standing.broken)
    if limit is _core.BrokenLimit.distance:
        i, j = LEG_PAIRS[standing.leg]
        return f"distance of legs {LEGS[i]} and {LEGS[j]}"
    return f"{limit.name.replace('_', ' ')} of leg {LEGS[standing.leg]}"
