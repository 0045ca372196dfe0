"""A new number of each leg is one line in the core and one in the schema: everything else follows."""

import os
import shutil
import subprocess
import sys
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import flexapod as fx

ROOT = Path(__file__).resolve().parents[2]
nanobind = pytest.importorskip("nanobind", reason="the core is built with nanobind")
COMPILER = shutil.which("clang++") or shutil.which("c++")  # without optimisation, Clang takes half of GCC's time
CCACHE = shutil.which("ccache")  # has what was compiled from the same text, in whichever folder that was

CORE = "src/core/model/design.hpp", 'FIELD(T, C_p, "legs.damping.prismatic"', 'FIELD(T, lead, "legs.lead", "m") \\\n  '
SCHEMA = (
    "src/flexapod/design/schema.py",
    '    "legs.damping.prismatic": Key(',
    '    "legs.lead": Key("lead of the actuator\'s screw", "length", _LEGS, least=0.0, default=0.005),\n',
)

USE = """
import numpy as np
import flexapod as fx
from flexapod import _core
from flexapod.design.layout import PLACES, describe, entries, numbers

assert _core.plain_size == 217
machine = fx.load("motion-base").replace({"legs.lead_mm": [4, 5, 6, 7, 8, 9], "legs.stiffness": [2e7, 3e7, 4e7, 5e7, 6e7, 7e7]})
assert np.array_equal(machine.legs.more["lead"], np.arange(4, 10) / 1000)
assert np.array_equal(machine.packed[PLACES["legs.lead"]], machine.legs.more["lead"])
assert np.array_equal(machine.packed[PLACES["legs.stiffness"]], machine.legs.stiffness)
assert np.array_equal(machine.packed[PLACES["legs.upper.inertia"]], machine.legs.upper.inertia)
assert fx.Hexapod.from_toml(machine.to_toml()) == machine
assert fx.load("motion-base").legs.more["lead"][3] == 0.005  # its default
try:
    machine.replace({"legs.lead": -1.0})
except fx.errors.DesignError as error:
    assert "legs.lead is -1 m" in str(error)
else:
    raise AssertionError("the schema's range is not held")

# What searches and robustness vary.
index, rule, unit = entries("legs.lead_mm[2]")
assert numbers(machine)[index] == 0.006 and unit == 0.001 and describe(int(index[0])) == "legs.lead[2]"
assert numbers(machine)[PLACES["home.position"]].tolist() == machine.home.position.tolist()
from flexapod.optimisation.design_map import DesignMap
design = DesignMap(machine, [fx.Variable("legs.lead_mm[2]", 1, 10), fx.Variable("legs.stiffness[4]", 1e7, 1e8)])
other = design.hexapod_at(np.array([0.002, 8e7]))
assert other.legs.more["lead"][2] == 0.002 and other.legs.stiffness[4] == 8e7
from flexapod.optimisation.ensemble import Ensemble
drawn = Ensemble(machine, fx.Uncertain("legs.lead", 0.1, each=False)).designs(np.array([[0.0], [1.0]]))
assert np.allclose(drawn[:, PLACES["legs.lead"]] / machine.legs.more["lead"], [[0.9] * 6, [1.1] * 6])

# What the mechanics makes of it: nothing, and nothing else has moved.
home = machine.home
sensitivity = fx.mechanics.frequency_sensitivity(machine)
step = 1e3
stiffer = machine.replace({"legs.stiffness[3]": machine.legs.stiffness[3] + step})
rise = fx.natural_modes(stiffer).omega - fx.natural_modes(machine).omega
assert np.allclose(rise / step, sensitivity.stiffness[:, 3], rtol=1e-3, atol=1e-12)
print(fx.natural_modes(machine).omega.tobytes().hex())
"""


def line_added(folder: Path, place: tuple[str, str, str]) -> None:
    """One line before another one."""
    name, before, line = place
    text = (folder / name).read_text()
    assert text.count(before) == 1
    (folder / name).write_text(text.replace(before, line + before))


def compile_in(folder: Path, command: list[str]) -> None:
    """Run a compiler in a folder whose name does not matter to ccache, nor when its files were written."""
    sloppy = "pch_defines,time_macros,include_file_mtime,include_file_ctime"
    kept = {"CCACHE_BASEDIR": str(folder), "CCACHE_NOHASHDIR": "1", "CCACHE_DEPEND": "1", "CCACHE_SLOPPINESS": sloppy}
    subprocess.run(command, cwd=folder, env={**os.environ, **kept}, check=True)


def build(folder: Path) -> None:
    """The core for any processor, unoptimised; what all bindings include is compiled once."""
    package = Path(nanobind.__file__).parent
    core = Path("src", "core")  # within the folder
    include = [core, package / "include", package / "ext" / "robin_map" / "include", sysconfig.get_path("include")]
    clang = "clang" in Path(COMPILER).name
    common = [*filter(None, [CCACHE, COMPILER]), "-std=c++20", "-O0", "-fPIC", "-fvisibility=hidden", "-MD"]
    common += [f"-I{path}" for path in include]
    common += ["-Xclang", "-fno-pch-timestamp"] if clang else []
    kernel = ["-Dflexapod=flexapod_baseline", '-DFLEXAPOD_ISA="baseline"']
    binding = ["-DNDEBUG", '-DFLEXAPOD_COMPILER="a test"']
    (folder / "shared.hpp").write_text('#include "bindings/arrays.hpp"\n#include "bindings/bind.hpp"\n')
    ahead = f"shared.hpp.{'pch' if clang else 'gch'}"
    compile_in(folder, [*common, *binding, "-x", "c++-header", "shared.hpp", "-o", ahead])
    sources = {name: [core / path.relative_to(folder / core) for path in (folder / core).glob(name)]
               for name in ("bindings/*.cpp", "*/kernel.cpp")}  # fmt: skip
    jobs = [(source, [*binding, "-include", "shared.hpp"]) for source in sources["bindings/*.cpp"]]
    jobs += [(source, kernel) for source in sources["*/kernel.cpp"]]
    jobs += [(package / "src" / "nb_combined.cpp", ["-DNDEBUG", "-fno-strict-aliasing"])]

    def compiled(job: tuple[Path, list[str]]) -> Path:
        source, options = job
        target = Path(f"{source.parent.name}_{source.stem}.o")
        compile_in(folder, [*common, *options, "-c", str(source), "-o", str(target)])
        return target

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(compiled, jobs))
    library = Path("src", "flexapod") / f"_core{sysconfig.get_config_var('EXT_SUFFIX')}"
    undefined = ["-undefined", "dynamic_lookup"] if sys.platform == "darwin" else ["-pthread"]
    compile_in(folder, [COMPILER, "-shared", *undefined, *map(str, objects), "-o", str(library)])


@pytest.mark.skipif(COMPILER is None or os.name != "posix", reason="no C++ compiler")
def test_a_number_of_each_leg_is_one_line_in_the_core_and_one_in_the_schema(tmp_path):
    ignored = shutil.ignore_patterns("_core*.so", "__pycache__", "static", "web")
    shutil.copytree(ROOT / "src", tmp_path / "src", ignore=ignored)
    line_added(tmp_path, CORE)
    line_added(tmp_path, SCHEMA)
    build(tmp_path)
    packages = [path for path in sys.path if path.endswith("site-packages")]
    outside = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path / "src"), *packages])}
    command = [sys.executable, "-S", "-c", USE]  # -S: no import hook of an editable install
    run = subprocess.run(command, env=outside, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    same = fx.load("motion-base").replace({"legs.stiffness": [2e7, 3e7, 4e7, 5e7, 6e7, 7e7]})
    omega = np.frombuffer(bytes.fromhex(run.stdout))
    np.testing.assert_allclose(omega, fx.natural_modes(same).omega, rtol=1e-12)  # rounding of another instruction set
