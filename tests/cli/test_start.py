"""What a command loads before its answer is there: a package that takes long to load only where its work needs it."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.attack.test_command_lines import RIGHT

pytest.importorskip("optuna")
pytest.importorskip("ompl")

ROOT = Path(__file__).parents[2]

#: Packages that take a tenth of a second or more to load.
SLOW = {
    "control", "dask", "distributed", "h5netcdf", "matplotlib", "ompl", "optuna", "pandas", "pint", "pyarrow", "SALib", "skimage", "slycot", "starlette",
    "uvicorn", "xarray", "zarr", "scipy.integrate", "scipy.interpolate", "scipy.linalg", "scipy.optimize", "scipy.signal", "scipy.spatial",
    "scipy.stats",
}  # fmt: skip
TABLES = {"xarray", "pandas"}
ALGEBRA = {"scipy.linalg"}
SPACE = ALGEBRA | {"scipy.spatial"}
SEARCH = SPACE | {"scipy.optimize"}
SPLINES = SEARCH | {"scipy.interpolate", "scipy.integrate"}
#: What the command lines of the attack may load.
MAY = {
    "animate": TABLES | SPACE | {"matplotlib"},
    "certify": SEARCH | {"matplotlib"},
    "check": ALGEBRA,  # for legs that bend, as for modes and sweep
    "cite": set(),
    "control": TABLES | SEARCH,
    "designs": set(),
    "envelope": set(),
    "export": set(),
    "kinematics": set(),
    "modes": ALGEBRA,
    "new": set(),
    "path": TABLES | SPLINES,
    "response": TABLES | ALGEBRA,
    "simulate": TABLES,
    "statics": TABLES | SPACE,
    "sweep": TABLES | ALGEBRA,
}
#: Those that draw, or search for minutes: what they load does not matter beside that.
LONG = {"optimise", "paper", "report", "robust", "serve"}

#: Runs command lines, each in a fork of its own, so that Python starts once, and says what each has loaded.
LOADED = """
import json, os, sys
lines, slow = json.loads(sys.stdin.read())
from flexapod import __main__ as shell
for line in lines:
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        sys.argv = ["flexapod", *line]
        keep = os.dup(1)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        code = shell.run()
        sys.stdout.flush()
        os.write(keep, (json.dumps([line[0], code, [name for name in slow if sys.modules.get(name)]]) + "\\n").encode())
        os._exit(0)
    os.waitpid(child, 0)
"""


@pytest.mark.skipif(os.name != "posix", reason="forks")
def test_a_command_loads_no_more_than_it_needs(tmp_path):
    rows = "t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0,0,0.9,0,0,0\n"
    (tmp_path / "way.csv").write_text(rows)
    (tmp_path / "lengths.csv").write_text("leg1,leg2,leg3,leg4,leg5,leg6\n" + ",".join(["0.12"] * 6) + "\n")
    assert set(MAY) == set(RIGHT) - LONG
    given = json.dumps([[[name, *RIGHT[name]] for name in MAY], sorted(SLOW)])
    done = subprocess.run(
        [sys.executable, "-c", LOADED], input=given, capture_output=True, text=True, check=True, cwd=tmp_path
    )
    found = {name: (code, set(loaded)) for name, code, loaded in map(json.loads, done.stdout.splitlines())}
    assert set(found) == set(MAY)
    assert {name: code for name, (code, _) in found.items() if code} == {}
    more = {name: sorted(loaded - MAY[name]) for name, (_, loaded) in found.items() if loaded - MAY[name]}
    assert more == {}


def test_a_command_ends_without_a_search_for_garbage():
    script = (
        "import gc, sys; from flexapod import __main__ as shell; sys.argv = ['flexapod', 'designs']; code = shell.run()\n"
        "sys.exit(code or not gc.get_freeze_count() > 10 * len(gc.get_objects()))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(os.name != "posix", reason="forks")
def test_a_store_without_a_cluster_does_without_dask(tmp_path):
    line = ["sweep", "motion-base", "--around", "0.1", "5", "--points", "64", "--out", "map.zarr"]
    given = json.dumps([[line, [*line, "--resume", "--worst"]], ["dask", "zarr"]])
    done = subprocess.run(
        [sys.executable, "-c", LOADED], input=given, capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert [json.loads(line) for line in done.stdout.splitlines()] == [["sweep", 0, ["zarr"]]] * 2


def test_the_server_leaves_tables_to_its_processes_and_they_do_without_dask():
    script = """
import json, sys, flexapod.web.app
from flexapod.web import worker
from tests.web.asked import ASKED
print(sorted({"xarray", "pandas"} & set(sys.modules)))
import flexapod.web.preloaded
before = set(sys.modules)
print(worker._answer("response", json.dumps({**ASKED, "quantity": "absolute"}).encode())[0]["status"])
print(len(set(sys.modules) - before), [name for name in ("dask", "pint", "pyarrow") if sys.modules.get(name)])
"""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=60, cwd=ROOT
    )
    assert done.stdout == "[]\n200\n0 []\n"
