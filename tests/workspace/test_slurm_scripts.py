"""The batch scripts of the manual, run as they stand there with stand-ins for Slurm's commands and variables."""

import contextlib
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from tests.helpers.documents import blocks
from tests.helpers.stores import content

pytest.importorskip("distributed")
PAGE = Path(__file__).parents[2] / "docs" / "cluster.md"
SCRIPTS = {block.title: block.text for block in blocks(PAGE.read_text(encoding="utf-8")) if block.language == "bash"}

#: Runs a command as many times as --ntasks says, side by side; refuses options that Slurm's srun has not.
SRUN = """#!/bin/bash
tasks=1
while [[ ${1-} == --* ]]; do
  case $1 in
    --ntasks=*) tasks=${1#--ntasks=} ;;
    --nodes=*|--overlap) ;;
    *) echo "srun: unrecognized option $1" >&2; exit 1 ;;
  esac
  shift
done
trap 'kill $(jobs -p) 2>/dev/null; wait; exit 143' TERM
for ((task = 0; task < tasks; task++)); do SLURM_PROCID=$task "$@" & pids="${pids-} $!"; done
code=0
for pid in $pids; do wait "$pid" || code=$?; done
exit $code
"""
FLEXAPOD = f"""#!/bin/bash
exec "{sys.executable}" -m flexapod "$@"
"""
DASK = f"""#!/bin/bash
exec "{sys.executable}" -c 'from dask.__main__ import main; main()' "$@"
"""
SCONTROL = """#!/bin/bash
echo "$@" >> requeued
"""
FEWER = {"--points 1000000000": "--points 6000 --chunk 500", "FLEXAPOD_SIMD=avx2": "FLEXAPOD_SIMD=baseline"}


@pytest.fixture
def node(tmp_path):
    """A folder with stand-ins for the commands: (script name, variables, replacements) -> exit code."""
    (tmp_path / "bin").mkdir()
    for name, text in {"srun": SRUN, "flexapod": FLEXAPOD, "dask": DASK, "scontrol": SCONTROL}.items():
        (tmp_path / "bin" / name).write_text(text)
        (tmp_path / "bin" / name).chmod(0o755)

    def start(name, others=(), **variables):
        text = SCRIPTS[name]
        for shown, run in {**FEWER, **dict(others)}.items():
            assert shown in text, shown
            text = text.replace(shown, run)
        path = f"{tmp_path / 'bin'}:{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path, "SLURM_JOB_ID": "42", **variables}
        with (tmp_path / "bin" / "said").open("w") as said:
            return subprocess.Popen(
                ["bash", "-c", text], cwd=tmp_path, env=environment, stderr=said, start_new_session=True
            )

    start.folder = tmp_path
    return start


def finished(process, folder):
    """The exit code of a job and what was said; its end is the end of all its steps, as Slurm has it."""
    try:
        code = process.wait(timeout=600)
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    return code, (folder / "bin" / "said").read_text()


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The store of one run."""
    folder = tmp_path_factory.mktemp("whole")
    line = ["sweep", "mukherjee-i", "--around", "0.1", "20", "--points", "6000", "--chunk", "500", "--no-summary"]
    environment = {**os.environ, "FLEXAPOD_SIMD": "baseline"}
    run = [sys.executable, "-m", "flexapod", *line, "--out", "map.zarr"]
    subprocess.run(run, cwd=folder, env=environment, check=True, capture_output=True)
    return content(folder / "map.zarr")


def test_the_manual_has_both_scripts():
    assert set(SCRIPTS) == {"map.sbatch", "array.sbatch"}
    for text in SCRIPTS.values():
        assert text.startswith("#!/bin/bash\n#SBATCH --job-name=")
        assert re.search(r"^#SBATCH --time=\d\d:\d\d:\d\d$", text, re.MULTILINE)
        subprocess.run(["bash", "-n"], input=text, text=True, check=True)


def test_scheduler_and_workers_as_job_steps(node, whole):
    code, said = finished(node("map.sbatch", SLURM_NTASKS="2"), node.folder)
    assert code == 0, said
    assert content(node.folder / "map.zarr") == whole
    assert sorted(path.name for path in node.folder.iterdir()) == ["bin", "map.zarr"]  # no address left


def test_a_job_whose_time_is_up_queues_itself_and_goes_on(node, whole):
    code, said = finished(
        node("map.sbatch", {"--time-limit 110min": "--time-limit 1us"}, SLURM_NTASKS="1"), node.folder
    )
    assert code == 3, said
    assert "the time is up, with 0 of 6000 poses" in said
    assert (node.folder / "requeued").read_text() == "requeue 42\n"
    code, said = finished(node("map.sbatch", SLURM_NTASKS="1"), node.folder)
    assert code == 0, said
    assert content(node.folder / "map.zarr") == whole


def job(node, number, count=3):
    return node(
        "array.sbatch",
        SLURM_ARRAY_TASK_ID=str(number),
        SLURM_ARRAY_TASK_COUNT=str(count),
        SLURM_CPUS_PER_TASK="1",
    )


def test_an_array_of_jobs_at_once_writes_the_store_of_one_run(node, whole):
    jobs = [job(node, number) for number in (2, 1, 3)]
    for process in jobs:
        code, said = finished(process, node.folder)
        assert code == 0, said
    assert content(node.folder / "map.zarr") == whole
