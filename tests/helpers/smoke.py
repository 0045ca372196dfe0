"""Is an installed Flexapod whole? Run with what is installed and nothing but its required packages:

    python tests/helpers/smoke.py

The core against stored answers of an independent code, a sweep, a simulation, the command line, files of a wheel.
"""

import json
import subprocess
import sys
import tempfile
from importlib import metadata, resources
from pathlib import Path

import numpy as np

import flexapod as fx

CASES = json.loads((Path(__file__).parents[1] / "data" / "golden.json").read_text(encoding="utf-8"))["cases"]
FILES = ["py.typed", "_core.pyi", "__init__.pyi", "mechanics/__init__.pyi", "design/machines/template.toml"]
FILES += ["report/page.css", "web/static/index.html", "notebook/static/view.js"]


def check_natural_frequencies() -> None:
    """Against eigenvalues of the stored J_p and H."""
    for case in CASES:
        if case["design"] != "II":
            continue
        machine = fx.load("mukherjee-ii").replace({"gravity": case["gravity"]})
        platform, base = (fx.Pose(case[body]["position"], case[body]["rotation"]) for body in ("platform", "base"))
        found = fx.natural_modes(machine, platform, base=base, joint=case["joint"]).omega
        H = np.array(case["H"])
        squares = np.linalg.eigvals(np.linalg.solve(case["J_p"], H * machine.legs.stiffness @ H.T))
        np.testing.assert_allclose(found, np.sqrt(np.sort(squares.real)), rtol=1e-8)


def check_sweep() -> None:
    """Poses in lanes against poses one by one."""
    machine = fx.load("precision-positioner")
    poses = fx.random_poses(fx.Box.about(fx.home_pose(machine), 0.01, 0.05), 500, seed=1)
    swept = fx.sweep(machine, poses, quantities=["omega_1"])
    single = fx.natural_modes(machine, fx.Pose.from_rpy(*poses.rows(0, 500).T)).omega[:, 0]
    np.testing.assert_allclose(swept["omega_1"].values, single, rtol=1e-9)


def check_simulation() -> None:
    """Shaken at a hundredth of its frequency, a platform all but rides with its base, and no energy gets lost."""
    machine = fx.load("cubic-isolator")
    shaking = fx.harmonic("z", 1e-4, 0.01 * fx.stability_index(machine, fx.home_pose(machine)))
    run = fx.simulate(machine, fx.home_pose(machine), base_motion=shaking, duration=0.05)
    assert run.attrs["energy_error"] < 1e-6, run.attrs
    assert np.abs(run.relative_displacement).max() < 0.02 * 1e-4  # 0.01 from the start, where velocity jumps


def check_command_line() -> None:
    """A report of a new design."""
    with tempfile.TemporaryDirectory() as folder:
        for arguments in (["new", "mine.toml"], ["check", "mine.toml"], ["report", "mine.toml", "--out", "out"]):
            subprocess.run([sys.executable, "-m", "flexapod", *arguments], cwd=folder, check=True, capture_output=True)
        assert (Path(folder) / "out" / "mine.html").stat().st_size > 50_000


def check_files() -> None:
    missing = [name for name in FILES if not resources.files("flexapod").joinpath(name).is_file()]
    assert not missing, missing
    assert metadata.version("flexapod") == fx.__version__
    assert any(file.name == "LICENSE" for file in metadata.files("flexapod") or ())


def main() -> None:
    for check in (check_files, check_natural_frequencies, check_sweep, check_simulation, check_command_line):
        check()
        print(f"{check.__name__}: good")
    print(f"flexapod {fx.__version__} in {Path(fx.__file__).parent} is whole")


if __name__ == "__main__":
    main()
