"""Five scripts of guesses, as a vibration engineer writes them before reading the manual.

Each line works, or raises an error that contains the right name (the words beside it).
"""

import re
import subprocess
import sys
import warnings

import numpy as np
import pytest
from tests.helpers.public import PUBLIC

import flexapod as fx
from flexapod._suggestions import WORDS, british

#: 1: load, modes at home in Hz, plot a mode, stiffness and mass matrix.
MODES = [
    ("h = fx.Hexapod.load('motion-base')", "flexapod.load"),
    ("h = fx.load_design('motion-base')", "did you mean load"),
    ("h = fx.load('motion_base')", "motion-base"),
    ("h = fx.load('motion-base')", None),
    ("m = fx.natural_frequencies(h)", "natural_modes"),
    ("m = fx.eigenfrequencies(h)", "natural_modes"),
    ("m = fx.modes(h)", "natural_modes"),
    ("m = fx.natural_mode(h)", "natural_modes"),
    ("m = h.natural_modes()", "flexapod.natural_modes(hexapod"),
    ("m = fx.natural_modes(h)", None),
    ("m = fx.natural_modes(h, h.home)", None),
    ("m = fx.natural_modes(h, [0, 0, 2.4, 0, 0, 0])", None),
    ("m = fx.natural_modes(h, fx.Pose([0, 0, 2.4]))", None),
    ("p = fx.Pose([0, 0, 2.4, 0, 0, 0])", "from_rpy"),
    ("p = fx.Pose.from_euler(0, 0, 2.4, pitch=5)", "from_rpy"),
    ("p = fx.Pose.from_rpy(0, 0, 2.4, pitch=5, degrees=True)", None),
    ("p.pitch", "rpy"),
    ("p.z", "position"),
    ("m.frequency", None),
    ("m.damping_ratio", None),
    ("m.shape", None),
    ("m.frequencies", "frequency"),
    ("m.hz", "frequency"),
    ("m.zeta", "damping_ratio"),
    ("m.mode_shapes", "shape"),
    ("fx.plot_mode(h, m, 1)", "plots.mode"),
    ("fx.plots.plot_mode(h, m, 1)", "plots.mode"),
    ("fx.plots.mode(h, h.home, m, 1)", None),
    ("K = fx.stiffness_matrix(h)", "linearise"),
    ("M = fx.mass_matrix(h)", "equations_of_motion"),
    ("J = fx.jacobian(h)", "force_transformation"),
    ("M = h.mass_matrix", "equations_of_motion"),
    ("lin = fx.linearize(h)", "linearise"),
    ("lin = fx.linearise(h)", None),
    ("lin.stiffness_matrix", "did you mean K"),
    ("lin.K, lin.M, lin.C", None),
    ("lin.modes().frequency, lin.modes().damping_ratio", None),
    ("lin.modes().freq", "frequency"),
    ("lin.poles", "modes()"),
]

#: 2: a frequency response.
RESPONSE = [
    ("h = fx.load('precision-positioner')", None),
    ("r = fx.frequency_response(h)", "transmissibility"),
    ("r = fx.frf(h)", "transmissibility"),
    ("r = fx.transfer_function(h)", "transmissibility"),
    ("r = fx.transmisibility(h)", "transmissibility"),
    ("r = fx.transmissibility(h)", None),
    ("r = fx.transmissibility(h, frequency=np.linspace(1, 100, 20))", None),
    ("r = fx.transmissibility(h, omega=np.linspace(10, 600, 20))", None),
    ("r = fx.transmissibility(h, omega=[10.0], frequency=[10.0])", "omega"),
    ("r = fx.transmissibility(h, frequency=[-1.0])", "frequency"),
    ("s = fx.linearise(h).state_space()", None),
    ("fx.lqg(h)", "control.lqg"),
    ("fx.LQR(h)", "control.lqg"),
    ("fx.control.linearise(h)", "flexapod.linearise"),
]

#: 3: an own machine in Python.
OWN = [
    ("inertia = [2.0, 2.0, 4.0]", None),
    ("given = dict(platform_mass=60.0, platform_inertia=inertia, stiffness=2e7)", None),
    ("h = fx.StewartPlatform()", "Hexapod"),
    ("h = fx.Hexapod.from_circle(0.5, 0.3, 0.5)", "from_circles"),
    ("h = fx.Hexapod.from_circles(0.5, 0.3, 0.5, **given)", "base_half_angle"),
    ("angles = dict(base_half_angle=10, platform_half_angle=10, degrees=True)", None),
    ("h = fx.Hexapod.from_circles(0.5, 0.3, 0.5, **angles, **given)", None),
    ("parts = dict(platform_mass=60.0, platform_mass_center=[0, 0, 0], platform_inertia=inertia)", None),
    ("parts.update(base_joints=h.base_joints, platform_joints=h.platform_joints)", None),
    ("g = fx.Hexapod(**parts, legs=2e7)", "Legs"),
    ("g = fx.Hexapod(**parts, legs=fx.Legs(2e7))", "design.Legs"),
    ("g = fx.Hexapod(**parts, legs=fx.design.Legs(2e7), home=[0, 0, 0.5, 0, 0, 0])", None),
    ("g.replace(platform_mass=70)", "platform.mass"),
    ("g.replace({'platform_mass': 70})", "platform.mass"),
    ("g.replace({'platform.mass': 70}).platform_mass", None),
    ("g.replace({'stiffness': 1e7})", "legs.stiffness"),
    ("g.mass", "platform_mass"),
    ("g.stiffness", "legs.stiffness"),
    ("g.save('own.toml')", None),
    ("fx.load('own.toml')", None),
    ("fx.natural_modes('own.toml')", "flexapod.load"),
    ("fx.natural_modes(g).frequency", None),
    ("fx.workspaces(g)", "workspace"),
]

#: 4: a random vibration.
RANDOM = [
    ("h = fx.load('precision-positioner')", None),
    ("r = fx.random_vibration(h)", "random_response"),
    ("r = fx.psd(h)", "random_response"),
    ("floor = fx.vc_curve('C')", "VC-C"),
    ("floor = fx.vc_curve('VC-C')", None),
    ("r = fx.random_response(h, psd=floor, axis='z')", None),
    ("r = fx.random_response(h, psd=floor, axis='up')", "'z'"),
    ("motion = fx.random_motion('z', floor, seed=1)", None),
    ("fx.monte_carlo(h)", "robustness"),
    ("fx.ground_noise('low')", "excitation.ground_noise"),
]

#: 5: a time simulation and a sweep.
TIME = [
    ("h = fx.load('cubic-isolator')", None),
    ("u = fx.sine('z', 1e-4, 30.0)", "harmonic"),
    ("u = fx.harmonic('z', 1e-4, 30.0)", None),
    ("s = fx.integrate(h, base_motion=u)", "simulate"),
    ("s = fx.simulate(h, base=u, duration=0.05)", "base"),
    ("s = fx.simulate(h, base_motion=u, duration=0.05)", None),
    ("s = fx.simulate(h, base_motion=u, duration=0.05, joint='universl')", "universal"),
    ("box = fx.Box.about(h.home, 0.005, 0.02)", None),
    ("d = fx.sweep(h, box, samples=16)", None),
    ("d = fx.sweep(h)", None),
    ("d = fx.sweep(h, fx.Workspace.about_home(0.005, 0.02), samples=16)", None),
    ("d = fx.sweep(h, box, quantities='frequency', samples=16)", "omega"),
    ("w = fx.worst_pose(h, box)", None),
    ("t = fx.Path(fx.Pose([[0, 0, 0.1], [0, 0, 0.11]]), [0, 1])", "Trajectory"),
    ("fx.optimize(h, [])", "optimise"),
    ("fx.optimization", "optimise"),
]


@pytest.mark.parametrize(
    "script", [MODES, RESPONSE, OWN, RANDOM, TIME], ids=["modes", "response", "own", "random", "time"]
)
def test_guesses_work_or_are_answered_with_the_right_name(script, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {"fx": fx, "np": np}
    for line, right in script:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            if right is None:
                exec(line, names)
                continue
            with pytest.raises((fx.FlexapodError, AttributeError)) as caught:
                exec(line, names)
        assert right in str(caught.value), f"{line}: {caught.value}"


@pytest.mark.parametrize("word", WORDS)
def test_every_answer_is_a_public_name(word):
    assert word not in fx.__all__
    found = fx
    for part in re.match(r"[\w.]+\w", WORDS[word])[0].split("."):
        found = getattr(found, part)
    with pytest.raises(AttributeError, match=re.escape(WORDS[word])):
        getattr(fx, word)


@pytest.mark.parametrize("name", [name for name in PUBLIC if name not in fx.__all__])
def test_a_name_of_a_package_is_found_from_the_top(name):
    if name in WORDS or name in dir(fx.errors):
        return
    with pytest.raises(AttributeError, match=rf"did you mean [\w.]+\.{name}\b"):
        getattr(fx, name)


def test_spelling():
    assert [british(word) for word in ("optimize", "linearized", "analyze", "size", "resize", "centre")] == [
        "optimise",
        "linearised",
        "analyse",
        "size",
        "resize",
        "center",
    ]


def test_private_names_and_modules_are_told_plainly():
    with pytest.raises(AttributeError, match="_nothing"):
        fx._nothing  # noqa: B018
    code = "import flexapod as fx\nfx.paper"  # in a process of its own: once imported, the module is an attribute
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "write import flexapod.paper" in done.stderr
