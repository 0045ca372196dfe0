"""What the benchmarks ran on: processor, compiler, versions."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path


def version(package: str) -> str:
    """Of an installed distribution."""
    return metadata.version(package)


def missing(package: str) -> bool:
    """Is a distribution not installed?"""
    try:
        metadata.version(package)
    except metadata.PackageNotFoundError:
        return True
    return False


def machine() -> dict[str, str]:
    """Words about this machine and what Flexapod was built with, in the order in which they are told."""
    from flexapod import _core

    return {
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "instruction sets": ", ".join(_core.simd_available()),
        "sweeps use": _core.simd(),
        "compiler": _core.compiler,
        "system": f"{platform.system()} {platform.machine()}",
        "Python": platform.python_version(),
    }


def processor() -> str:
    """Name, with family and model where Linux tells them: a virtual machine often hides the name."""
    cpuinfo = Path("/proc/cpuinfo")
    if not cpuinfo.exists():
        return platform.processor() or platform.machine()
    found = dict(re.findall(r"^(model name|cpu family|model|cpu MHz)\s*:\s*(.+)$", cpuinfo.read_text(), re.MULTILINE))
    name = found.get("model name", platform.machine())
    numbers = [f"{word} {found[key]}" for word, key in (("family", "cpu family"), ("model", "model")) if key in found]
    clock = f"{float(found['cpu MHz']) / 1000:.1f} GHz" if "cpu MHz" in found else ""
    return ", ".join(part for part in (name, *numbers, clock) if part)


def keep_to_one_core() -> int | None:
    """Give this process, and what it starts, one core, so that every tool has the same; its number, or none if the
    system cannot do that.
    """
    if not hasattr(os, "sched_setaffinity"):
        return None
    core = max(_CORES)
    os.sched_setaffinity(0, {core})
    return core


@contextmanager
def all_cores() -> Iterator[None]:
    """Undo it for a while."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    now = os.sched_getaffinity(0)
    os.sched_setaffinity(0, _CORES)
    yield
    os.sched_setaffinity(0, now)


_CORES = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()
