"""Without an optional package everything else works, and what needs it says how to install it."""

import re
import sys
from pathlib import Path

import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx


@pytest.fixture
def hidden(monkeypatch):
    """Makes packages look as if they were not installed."""

    def hide(*names):
        for loaded in list(sys.modules):
            if loaded.partition(".")[0] in names:
                monkeypatch.delitem(sys.modules, loaded)
        for name in names:
            monkeypatch.setitem(sys.modules, name, None)

    return hide


def isolator():
    hexapod = fx.load("cubic-isolator")
    return hexapod, fx.home_pose(hexapod)


def small_sweep(axes=("x",)):
    hexapod = fx.load("motion-base")
    return fx.sweep(hexapod, fx.pose_grid(z=2.4, **{name: [0.0, 0.1] for name in axes}), quantities=["omega_1"])


def plan():
    return fx.plan_path(
        fx.load("mukherjee-i"), fx.Pose.from_rpy(0, 0, 0.89, 0, -0.57, -0.18),
        fx.Pose.from_rpy(0, 0, 0.89, 0, 0.78, 0.92), 110.0,
    )  # fmt: skip


def surface():
    from flexapod.plots.sweep import iso_surface

    return iso_surface(small_sweep(("x", "y", "yaw")))


def saved(name):
    from flexapod.workspace.store.file_formats import save

    save(small_sweep(), name)


def workers():
    with fx.workspace.cluster("local"):
        pass


STIFFNESS = fx.Variable("legs.stiffness", 1e6, 1e8)
NEEDS = [
    ("control", "control", lambda: fx.linearise(*isolator()).to_control()),
    ("control", "control", lambda: fx.control.lqg(*isolator())),
    ("control", "control",
     lambda: fx.control.ForceFeedback(20.0, 5.0).on(fx.linearise(*isolator())).sampled(1e-3, "zoh")),
    ("slycot", "control", lambda: fx.control.h_infinity(*isolator())),
    ("ompl", "plan", plan),
    ("optuna", "optimise", lambda: fx.optimise(plain_machine("precision-positioner"), [STIFFNESS], trials=2)),
    ("SALib", "optimise", lambda: fx.robustness(fx.load("motion-base"), [fx.Uncertain("platform.mass", 0.1)],
                                                samples=16, sensitivity=16)),
    ("skimage", "sweep", surface),
    ("h5netcdf", "sweep", lambda: saved("sweep.nc")),
    ("pyarrow", "sweep", lambda: saved("sweep.parquet")),
    ("zarr", "sweep", lambda: fx.workspace.SweepStore.create("s.zarr", fx.load("motion-base"), fx.pose_grid(z=[2.4]))),
    ("distributed", "sweep", workers),
    ("anywidget", "notebook", lambda: fx.view(*isolator())),
    ("imageio_ffmpeg", "video", lambda: fx.animate_mode(*isolator(), 1, "mode.mp4")),
]  # fmt: skip


@pytest.mark.parametrize(("package", "extra", "use"), NEEDS, ids=[f"{p}-{n}" for n, (p, _, _) in enumerate(NEEDS)])
def test_the_extra_to_install_is_told(package, extra, use, hidden, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    hidden(package)
    with pytest.raises(fx.errors.MissingExtraError, match=re.escape(f"pip install 'flexapod[{extra}]'")):
        use()
    assert list(tmp_path.iterdir()) == []  # nothing half written


def test_every_extra_is_named_in_the_packages_list():
    """An extra that an error names is one that pip knows."""
    declared = (Path(__file__).parents[2] / "pyproject.toml").read_text()
    for _, extra, _ in NEEDS:
        assert re.search(rf"^{extra} = \[", declared, re.MULTILINE)


def test_what_needs_none_of_them_works(hidden):
    hidden(*{package for package, _, _ in NEEDS})
    hexapod, pose = isolator()
    assert fx.stability_index(hexapod, pose) > 0
    law = fx.control.ForceFeedback(20.0, 5.0).on(fx.linearise(hexapod, pose)).sampled(1e-3)
    assert fx.control.closed_loop(hexapod, pose, law, nearness=0.0).stable
    assert fx.optimise(fx.load("precision-positioner"), [fx.Variable("platform.mass", 20, 30)], trials=0).index > 0


@pytest.mark.parametrize(
    ("package", "command"),
    [
        ("control", "control cubic-isolator lqg"),
        ("slycot", "control cubic-isolator h-infinity"),
        ("starlette", "serve"),
        ("uvicorn", "serve"),
        ("imageio_ffmpeg", "animate cubic-isolator --out mode.mp4"),
    ],
)
def test_a_command_exits_with_2(package, command, hidden, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    hidden(package)
    code, _, err = run(*command.split())
    assert code == 2
    assert "pip install 'flexapod[" in err
