"""How long Flexapod takes to start: `import flexapod` and every command, most with little to compute.

The commands run in a terminal, and their first output is the first sign that is seen in it. They take turns, so that a
busy machine slows all of them alike; the least time of each is what it takes, the median what it took. Modules are
compiled before, as those of an installed package are. An argument says how many turns.
"""

import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

from benchmarks._contest import OURS, Contender, Contest, Plan

TURNS = 15
SHORT = {  # commands of the shell, and what is asked of them, s
    "flexapod designs": 0.5,
    "flexapod cite": 0.5,
    "flexapod new machine.toml --force": 0.5,
    "flexapod check motion-base": 0.5,
    "flexapod kinematics motion-base lengths.csv": 0.5,
    "flexapod export motion-base --out motion-base.xml": 0.5,
    "flexapod statics motion-base --elevation 90:15:6": 0.5,
    "flexapod response motion-base --points 10": 0.5,
    "flexapod simulate motion-base --harmonic z 1mm 5Hz --duration 0.1": 0.5,
    "flexapod control motion-base velocity --gain 10": 0.5,
    "flexapod path mukherjee-i waypoints.csv --bound 150": 0.5,
    "flexapod envelope cubic-isolator": 0.5,
    "flexapod certify mukherjee-ii --around 0.0005 0.5 --at-least 1Hz": 0.5,
    "flexapod optimise mukherjee-ii --around 0.005 5 --keep mass --vary platform.mass=2:6 --trials 3": 0.5,
    "flexapod robust motion-base --uncertain platform.mass=5% --samples 512 --sensitivity 0": 0.5,
    "flexapod report motion-base": 0.5,
    "flexapod paper --figure 8 --out paper": 0.5,
    "flexapod animate motion-base": 0.5,
    "flexapod serve motion-base --no-open --port 0": 0.5,
    "flexapod sweep motion-base --around 0.1 5 --points 1000": 0.5,
    "flexapod sweep motion-base --around 0.1 5 --points 1000000 --out swept.nc": 1.0,
}
LIMITS = {"import flexapod": 0.3, "flexapod modes": 0.5, **SHORT}  # s, what a user does not notice and does not mind

MODES = "modes mukherjee-ii --pose 0 0 0.085 0 0 0 --joint spin_free --json"
COMMANDS = {
    "python -c pass": [sys.executable, "-c", "pass"],
    "import flexapod": [sys.executable, "-c", "import flexapod"],
    "import flexapod, load": [sys.executable, "-c", "import flexapod as fx; fx.load('mukherjee-ii')"],
    "flexapod modes": [sys.executable, "-m", "flexapod", *MODES.split()],
    **{line: [sys.executable, "-m", *line.split()] for line in SHORT},
}
FILES = {
    "lengths.csv": "leg1,leg2,leg3,leg4,leg5,leg6\n1.9,1.9,1.9,1.9,1.9,1.9\n",
    "waypoints.csv": "t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0,0,0.9,0,0,0\n",
}
UNSEEN = re.compile(rb"\x1b\[[0-9;?]*[A-Za-z]|\s")  # what only moves the terminal's cursor


def seconds(command: list[str], folder: str) -> tuple[float, float]:
    """Wall time of one run in a folder to its first output, or to its end where there is none, and to its end.

    A server is ended at its first output.
    """
    compiled = {**os.environ, "PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": str(Path(folder, "compiled"))}
    screen, terminal = os.openpty()
    start, first, seen, serves = time.perf_counter(), None, b"", "serve" in command
    run = subprocess.Popen(
        command, stdout=terminal, stderr=terminal, cwd=folder, env=compiled, preexec_fn=_let_the_clock_go_first
    )
    os.close(terminal)
    while more := _read(screen):
        seen += more
        if first is None and UNSEEN.sub(b"", seen):
            first = time.perf_counter() - start
            if serves:
                run.send_signal(signal.SIGINT)
    code, end = run.wait(), time.perf_counter() - start
    os.close(screen)
    if code and not serves:
        raise subprocess.CalledProcessError(code, command, seen)
    return end if first is None else first, end


def _let_the_clock_go_first() -> None:
    """A command yields to who times it where the real-time scheduler runs both."""
    if os.sched_getscheduler(0) == os.SCHED_RR:
        os.sched_setparam(0, os.sched_param(1))


def _read(screen: int) -> bytes:
    """What comes next on the terminal; nothing where the command has ended."""
    try:
        return os.read(screen, 2**16)
    except OSError:  # Linux says so when nobody writes any more
        return b""


OTHERS = {  # what a script of each must import to begin
    "SciPy": ("scipy", "numpy, scipy.linalg"),
    "Pinocchio": ("pin", "pinocchio"),
    "MuJoCo": ("mujoco-core", "mujoco"),
    "Exudyn": ("exudyn", "exudyn, exudyn.utilities"),
    "JAX": ("jax", "jax, jax.numpy"),
}


def contests(plan: Plan) -> list[Contest]:
    """A fresh process: Flexapod to its first result, the others to the end of their import."""
    first = "import flexapod as fx; fx.natural_modes(fx.load('mukherjee-ii'), fx.Pose([0, 0, 0.085]))"
    contenders = [Contender(OURS, "flexapod", "import, load a design, its natural frequencies", _script(first))]
    for tool, (package, modules) in OTHERS.items():
        if plan.has(package):
            contenders.append(Contender(tool, package, f"import {modules}", _script(f"import {modules}")))
    return [Contest("Start-up", "process", "", contenders)]


def _script(code: str) -> Callable[[], float]:
    """Processor time of a Python process, its start included."""

    def run() -> float:
        before = of_children()
        subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
        return of_children() - before

    def of_children() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    return run


def main() -> None:
    """Print least and median times, each to the first output and to the end, and the limit where there is one."""
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in COMMANDS}
    turns = int(sys.argv[1]) if len(sys.argv) > 1 else TURNS
    with tempfile.TemporaryDirectory() as folder:
        for name, rows in FILES.items():
            Path(folder, name).write_text(rows, encoding="utf-8")
        for _ in range(1 + turns):
            for name, command in COMMANDS.items():
                times[name].append(seconds(command, folder))
    for name, taken in times.items():
        first, whole = zip(*taken[1:], strict=True)  # the first turn compiles modules
        least = f"least {min(first):.3f} {min(whole):.3f} s, median {median(first):.3f} {median(whole):.3f} s"
        print(f"{name:98s} {least}{f'  (limit {LIMITS[name]:.1f} s)' if name in LIMITS else ''}")


if __name__ == "__main__":
    main()
