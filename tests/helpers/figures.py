"""Every function of the plots with arguments that it draws, by its name; the results are computed once."""

import inspect
from functools import cache, partial
from importlib import import_module
from pkgutil import iter_modules

import numpy as np

import flexapod as fx
from flexapod import plots

_HELP = {"style", "printing", "animation", "sweep_axes", "results", "shared"}  # modules that draw nothing by themselves


def functions():
    """Public functions of the plots that draw, by module and name."""
    found = {}
    for module in iter_modules(plots.__path__):
        if module.name in _HELP:
            continue
        code = import_module(f"flexapod.plots.{module.name}")
        for name, thing in vars(code).items():
            drawn = inspect.isfunction(thing) and thing.__module__ == code.__name__ and not name.startswith("_")
            if drawn and name != "auto":  # which chooses among the others
                found[f"{module.name}.{name}"] = thing
    return found


@cache
def isolator():
    return fx.load("cubic-isolator")


@cache
def base():
    return fx.load("motion-base")


@cache
def searched():
    aim = fx.optimisation.LeastIndex(fx.Box.about(fx.home_pose(fx.load("precision-positioner")), 0.002, 0.02))
    return fx.optimise(
        fx.load("precision-positioner"),
        [fx.Variable("platform.mass", 20, 30)],
        aim,
        trials=4,
        samples=32,
        verify=64,
    )


@cache
def fronted():
    hexapod = fx.load("precision-positioner")
    aim = fx.optimisation.LeastIndex(fx.Box.about(fx.home_pose(hexapod), 0.002, 0.02))
    return fx.pareto_front(
        hexapod,
        [fx.Variable("platform.mass", 20, 30)],
        fx.optimisation.TotalMass(),
        aim,
        trials=8,
        samples=32,
        refine=0,
    )


@cache
def uncertain():
    return fx.robustness(base(), fx.Uncertain("legs.stiffness_law.bulk_modulus", 0.1), samples=64, sensitivity=64)


@cache
def volume():
    grid = fx.pose_grid(x=np.linspace(-0.1, 0.1, 6), y=np.linspace(-0.1, 0.1, 6), z=np.linspace(2.3, 2.5, 6))
    return fx.sweep(base(), grid)


@cache
def slice_():
    return fx.sweep(base(), fx.pose_grid(x=np.linspace(-0.3, 0.3, 21), y=np.linspace(-0.3, 0.3, 21), z=2.4))


@cache
def cloud():
    return fx.sweep(base(), fx.random_poses(fx.Box.about(fx.home_pose(base()), 0.05, 0.03), 500))


@cache
def planned():
    hexapod = fx.load("mukherjee-i")
    start = fx.Pose.from_rpy(0, 0, 0.89, 0, -33, -10, degrees=True)
    goal = fx.Pose.from_rpy(0, 0, 0.89, 0, 45, 53, degrees=True)
    return hexapod, fx.plan_path(hexapod, start, goal, fx.PathRequirements(110.0))


@cache
def loaded_path():
    way = fx.Trajectory(fx.Pose([[0, 0, 0.89], [0.05, 0, 0.89]]), [0, 1])
    return fx.paths.path_loads(fx.load("mukherjee-i"), way)


@cache
def driven_path():
    curve = {"speeds_rpm": [0, 3000], "peak_torques": [9, 8], "continuous_torques": [3, 2]}
    drive = {"lead_mm": 5, "efficiency": 0.9, "motor": curve}
    return fx.paths.motor_loads(fx.load("mukherjee-i").replace({"drive": drive}), loaded_path())


@cache
def indexed_path():
    way = fx.Trajectory(fx.Pose([[0, 0, 0.89], [0.05, 0, 0.89]]), [0, 1])
    return fx.path_index(fx.load("mukherjee-i"), way, bound=100.0)


@cache
def shaken():
    return fx.simulate(isolator(), duration=0.5, base_motion=fx.harmonic("x", 1e-4, 20.0))


@cache
def controlled():
    law = fx.control.VelocityFeedback(50.0)
    return fx.control.controlled_transmissibility(isolator(), controller=law)


@cache
def sampled():
    law = fx.control.VelocityFeedback(50.0).on(fx.linearise(isolator())).sampled(2e-3)
    shake = fx.harmonic("z", 1e-4, 30.0)
    return fx.control.simulate_control(isolator(), controller=law, duration=0.5, base_motion=shake)


@cache
def random():
    return fx.random_response(isolator(), psd=fx.vc_curve("VC-C"), axis="z")


@cache
def transmitted():
    return fx.transmissibility(isolator(), frequency=np.geomspace(1, 100, 200))


@cache
def elevated():
    elevation = np.radians(np.linspace(90, 15, 16))
    gravity = fx.mechanics.gravity_at(elevation)
    return fx.load_cases(base(), gravity=gravity, reference=0, point=[0, 0, 0.5]), elevation


DRAW = {
    "control.controlled_run": lambda f: partial(f, sampled()),
    "control.gain_map": lambda f: partial(
        f, fx.control.gain_map(base(), kp=np.geomspace(1e5, 1e8, 9), kd=np.geomspace(1e3, 1e6, 9))
    ),
    "control.isolation": lambda f: partial(f, controlled()),
    "control.root_locus": lambda f: partial(f, fx.control.root_locus(isolator(), None, "force"), chosen=5.0),
    "control.schedule": lambda f: partial(
        f,
        fx.control.gain_schedule(
            base(), fx.pose_grid(z=2.4, x=[-0.1, 0.1], yaw=[-0.2, 0.0, 0.2]), "velocity", damping=0.3
        ),
    ),
    "envelope.pairs": lambda f: partial(f, fx.envelope(base(), directions=24), base().name),
    "machine_3d.machine": lambda f: partial(f, base()),
    "machine_3d.mode": lambda f: partial(f, base(), None, fx.natural_modes(base()), 1),
    "natural_frequencies.frequencies": lambda f: partial(f, fx.natural_modes(base()).omega),
    "optimisation.front": lambda f: partial(f, fronted()),
    "optimisation.importance": lambda f: partial(f, uncertain()),
    "optimisation.plan": lambda f: partial(f, searched()),
    "optimisation.search": lambda f: partial(f, searched()),
    "optimisation.spread": lambda f: partial(f, uncertain()),
    "path.index_along": lambda f: partial(f, indexed_path()),
    "path.loads": lambda f: partial(f, loaded_path()),
    "path.motors": lambda f: partial(f, driven_path()),
    "path.plan_map": lambda f: partial(f, fx.paths.plan_slice(*planned())),
    "response.frequency_response": lambda f: partial(f, transmitted(), given="x"),
    "response.random_spectra": lambda f: partial(f, random()),
    "response.stepped_ratio": lambda f: partial(
        f, fx.stepped_sine(fx.load("mukherjee-ii"), omega=[300.0, 500.0], amplitude=1e-6, axis="z")
    ),
    "simulation.displacements": lambda f: partial(f, shaken().time, shaken().displacement),
    "simulation.leg_forces": lambda f: partial(f, shaken()),
    "statics.load_cases": lambda f: partial(f, *elevated()),
    "sweep.index_line": lambda f: partial(f, volume().isel(y=0, z=0)),
    "sweep.index_map": lambda f: partial(f, slice_()),
    "sweep_scatter.index_scatter": lambda f: partial(f, cloud()),
    "sweep_surface.iso_surface": lambda f: partial(f, volume()),
}


@cache
def prepared(name):
    """The function of a name with arguments; what is left are `ax` or `figure`."""
    return DRAW[name](functions()[name])
