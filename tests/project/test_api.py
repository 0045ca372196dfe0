"""The public names: they resolve, and importing is light."""

import subprocess
import sys

import pytest
from tests.helpers.public import PUBLIC, call_name

import flexapod as fx

#: What scripts rely on at the top.
KEPT = [
    "load",
    "Pose",
    "Motion",
    "Hexapod",
    "home_pose",
    "inverse_kinematics",
    "forward_kinematics",
    "force_transformation",
    "condition_number",
    "joint_angles",
    "check_limits",
    "equations_of_motion",
    "forward_dynamics",
    "inverse_dynamics",
    "hold",
    "static_equilibrium",
    "natural_modes",
    "stability_index",
    "linearise",
    "transmissibility",
    "random_response",
    "simulate",
    "sweep",
    "worst_pose",
    "optimise",
    "robustness",
    "plan_path",
    "path_index",
    "PathRequirements",
    "Box",
    "Workspace",
    "random_poses",
    "harmonic",
    "describe_modes",
    "FlexapodError",
]


def test_what_scripts_rely_on_is_at_the_top():
    assert set(KEPT) <= set(fx.__all__)


@pytest.mark.parametrize("name", sorted(PUBLIC))
def test_every_name_resolves_and_is_documented(name):
    found = fx
    for part in call_name(name).split("."):
        found = getattr(found, part)
    assert found is PUBLIC[name]
    assert len((found.__doc__ or "").split()) >= 3
    assert found.__module__.startswith("flexapod.")


def test_dir_is_all_and_unknown_names_are_attribute_errors():
    assert sorted(fx.__all__) == list(fx.__all__)
    assert set(fx.__all__) <= set(dir(fx))
    with pytest.raises(AttributeError, match="no_such_thing"):
        fx.no_such_thing  # noqa: B018


def modules_after(code: str) -> set[str]:
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\nimport sys\nprint(*sys.modules)"], capture_output=True, text=True, check=True
    )
    return {name.split(".")[0] for name in done.stdout.split()}


HEAVY = {"matplotlib", "scipy", "xarray", "pandas", "control", "tomlkit", "click", "rich"}


def test_import_is_light():
    assert not modules_after("import flexapod") & (HEAVY | {"numpy"})


def test_natural_modes_need_no_heavy_module():
    code = "import flexapod as fx\nfx.natural_modes(fx.load('mukherjee-ii'), fx.Pose([0, 0, 0.085]))"
    assert not modules_after(code) & HEAVY
