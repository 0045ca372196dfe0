"""A long sweep to a Zarr store: time, rate, peak memory and size; then killed in the middle and resumed.

    python benchmarks/zarr_sweep.py --points 100000000 --killed-points 10000000 --directory /some/disk

Every run is the command line in a process of its own, so that memory and start-up are what a user has.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SWEEP = ["sweep", "mukherjee-i", "--around", "0.1", "20", "--no-summary"]


def command(points: int, out: Path, *more: str) -> list[str]:
    """The command line of one run."""
    return [sys.executable, "-m", "flexapod", *SWEEP, "--points", str(points), "--out", str(out), *more]


def timed(arguments: list[str]) -> tuple[float, float]:
    """Seconds, and peak memory of the process in MiB."""
    start = time.perf_counter()
    process = subprocess.Popen(arguments, stderr=subprocess.DEVNULL)
    _, code, usage = os.wait4(process.pid, 0)
    if code:
        raise SystemExit(f"{' '.join(arguments)} ended with {code}")
    return time.perf_counter() - start, usage.ru_maxrss / 1024


def size(path: Path) -> int:
    """Bytes in a directory."""
    return sum(file.stat().st_size for file in path.rglob("*") if file.is_file())


def content(path: Path) -> str:
    """One digest of the names and bytes of all files in a directory."""
    digest = hashlib.sha256()
    for file in sorted(path.rglob("*")):
        if file.is_file():
            digest.update(str(file.relative_to(path)).encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def long_run(points: int, directory: Path) -> None:
    """Time, rate, peak memory; the tenth part of it for how memory grows; and the time of its summary."""
    for count in (points // 10, points):
        out = directory / f"{count}.zarr"
        seconds, peak = timed(command(count, out))
        gib = size(out) / 2**30
        print(
            f"{count:>13,} poses: {seconds:8.1f} s, {count / seconds:12,.0f} poses/s, peak memory {peak:6.0f} MiB, "
            f"{gib:6.2f} GiB on disk"
        )
        if count == points:
            resumed = [part for part in command(count, out, "--resume") if part != "--no-summary"]
            start = time.perf_counter()
            subprocess.run(resumed, check=True, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            print(f"{'':>13} its summary, read from disk: {time.perf_counter() - start:.1f} s")
        shutil.rmtree(out)


def killed(points: int, directory: Path) -> None:
    """SIGKILL when about half is on the disk, resume, and compare with a run in one go."""
    whole, pieces = directory / "whole.zarr", directory / "pieces.zarr"
    timed(command(points, whole))
    half = size(whole) / 2
    process = subprocess.Popen(command(points, pieces), stderr=subprocess.DEVNULL)
    while not pieces.exists() or size(pieces) < half:
        if process.poll() is not None:
            raise SystemExit("the run ended before it could be killed; give more --killed-points")
        time.sleep(0.05)
    process.send_signal(signal.SIGKILL)
    process.wait()
    written = size(pieces) / size(whole)
    seconds, _ = timed(command(points, pieces, "--resume"))
    same = content(whole) == content(pieces)
    print(
        f"{points:>13,} poses: killed with {written:.0%} of the bytes written, resumed in {seconds:.1f} s; "
        f"same bytes: {'yes' if same else 'NO'} ({content(whole)}, {content(pieces)})"
    )
    if not same:
        raise SystemExit(1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=100_000_000)
    parser.add_argument("--killed-points", type=int, default=10_000_000)
    parser.add_argument("--directory", type=Path, default=None, help="where to write; default: the temporary directory")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=given.directory) as directory:
        long_run(given.points, Path(directory))
        killed(given.killed_points, Path(directory))


if __name__ == "__main__":
    main()
