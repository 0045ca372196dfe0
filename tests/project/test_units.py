"""Units of Datasets: one spelling each, which Pint reads, on everything that the library returns."""

import inspect
import io
from functools import cache

import numpy as np
import pint
import pint_xarray  # noqa: F401  gives Datasets their `.pint`
import pytest
import xarray as xr
from tests.helpers.public import CLASSES, FUNCTIONS, PUBLIC

import flexapod as fx
from flexapod.conventions import UNITS
from flexapod.design.layout import entries
from flexapod.simulation.run import SimulationRun
from flexapod.workspace.quantities import QUANTITIES

NAMES = "Dataset", "DataArray"
H = fx.load("cubic-isolator")
HOME = fx.home_pose(H)
POSITIONER = fx.load("precision-positioner")
BAND = {"omega": [10.0, 20.0, 30.0]}


@cache  # it takes seconds
def _plan():
    mukherjee = fx.load("mukherjee-i")
    start = fx.Pose.from_rpy(0, 0, 0.89, *np.radians([0, -33, -10]))
    goal = fx.Pose.from_rpy(0, 0, 0.89, *np.radians([0, 45, 53]))
    return mukherjee, fx.plan_path(mukherjee, start, goal, 110.0)


def _way():
    return H, fx.Trajectory([[0, 0, 0, 0, 0, 0], [0, 0, 1e-3, 0, 0, 0]], [0, 1], origin=HOME)


def _law():
    return fx.control.VelocityFeedback(10.0).on(fx.linearise(H, HOME)).sampled(1e-3)


def _store(folder):
    path = folder / "swept.zarr"
    store = fx.workspace.SweepStore.create(path, H, fx.random_poses(fx.Box.about(HOME, 0.001, 0.01), 20))
    store.run(1)
    return fx.open_sweep(path)


def _motors(folder):
    curve = {"speeds": [0.0, 100.0], "peak_torques": [9.0, 8.0], "continuous_torques": [3.0, 2.0]}
    machine, path = _way()
    machine = machine.replace({"drive": {"lead": 0.01, "efficiency": 0.9, "motor": curve}})
    return fx.paths.motor_loads(machine, fx.paths.path_loads(machine, path, samples=10))


def _front():
    heavier = fx.Variable("platform.mass", 20, 30)
    return fx.pareto_front(POSITIONER, [heavier], fx.optimisation.TotalMass(), trials=12, refine=0, samples=4)


#: What returns a Dataset, and a call of it that returns it whole.
CALLS = {
    "load_cases": lambda folder: fx.load_cases(
        H, gravity=fx.mechanics.gravity_at(np.radians([90.0, 60.0])), reference=0
    ),
    "controlled_random_response": lambda folder: fx.control.controlled_random_response(
        H, HOME, controller=_law(), psd=np.ones(3), axis="z", **BAND
    ),
    "controlled_transmissibility": lambda folder: fx.control.controlled_transmissibility(
        H, HOME, controller=_law(), **BAND
    ),
    "gain_map": lambda folder: fx.control.gain_map(
        H, HOME, kp=[1e4, 2e4], kd=[1.0, 2.0], controller=fx.control.PID(1.0, 1.0, space="task"), nearness=1e-9
    ),
    "gain_schedule": lambda folder: fx.control.gain_schedule(H, fx.pose_grid(z=[0.03, 0.035])),
    "motor_loads": _motors,
    "open_sweep": _store,
    "path_loads": lambda folder: fx.paths.path_loads(_plan()[0], _plan()[1].path),
    "payload_loads": lambda folder: fx.paths.payload_loads(*_way(), [fx.paths.PayloadCase("full", 2.0)], samples=10),
    "plan_slice": lambda folder: fx.paths.plan_slice(*_plan(), samples=5),
    "random_response": lambda folder: fx.random_response(H, HOME, psd=np.ones(3), axis="z", **BAND),
    "root_locus": lambda folder: fx.control.root_locus(H, HOME, "velocity", gains=[1.0, 2.0, 3.0]),
    "simulate": lambda folder: fx.simulate(H, HOME, duration=0.01, samples=3, reactions=True),
    "simulate_control": lambda folder: fx.control.simulate_control(
        H, HOME, controller=_law(), base_motion=fx.harmonic("z", 1e-6, 20.0), duration=0.01
    ),
    "simulate_many": lambda folder: fx.simulate_many([SimulationRun(H, HOME)], 0.01, samples=3),
    "stepped_sine": lambda folder: fx.stepped_sine(H, HOME, omega=[10.0, 11.0], amplitude=1e-6, axis="z"),
    "sweep": lambda folder: fx.sweep(H, fx.pose_grid(z=[0.03, 0.035]), quantities=QUANTITIES),
    "transmissibility": lambda folder: fx.transmissibility(H, HOME, **BAND),
    "OptimalDesign.history": lambda folder: (
        fx.optimise(POSITIONER, [fx.Variable("platform.mass", 20, 30)], trials=2, samples=4, verify=8).history
    ),
    "ParetoFront.history": lambda folder: _front().history,
    "PathIndex.samples": lambda folder: fx.path_index(_plan()[0], _plan()[1].path).samples,
    "Robustness.samples": lambda folder: (
        fx.robustness(H, fx.Uncertain("legs.stiffness", 0.1), samples=8, sensitivity=0).samples
    ),
    "Robustness.sensitivity": lambda folder: (
        fx.robustness(H, fx.Uncertain("legs.stiffness", 0.1), samples=8, sensitivity=16).sensitivity
    ),
}


def _returning() -> set[str]:
    """Public functions, fields, properties and methods that are annotated to give a Dataset."""
    found = {name for name in FUNCTIONS if _gives(inspect.signature(PUBLIC[name]).return_annotation)}
    for owner in CLASSES:
        kind = PUBLIC[owner]
        found |= {f"{owner}.{name}" for name, given in getattr(kind, "__annotations__", {}).items() if _gives(given)}
        for name, member in vars(kind).items():
            function = getattr(member, "fget", None) or getattr(member, "func", None) or member
            if inspect.isfunction(function) and _gives(inspect.signature(function).return_annotation):
                found.add(f"{owner}.{name}")
    return found


def _gives(annotation: object) -> bool:
    return any(name in str(annotation) for name in NAMES)


def test_every_dataset_of_the_library_is_read_here():
    assert _returning() == set(CALLS)


@pytest.mark.parametrize("name", sorted(CALLS))
def test_it_says_where_it_comes_from_and_pint_reads_the_unit_of_every_number(name, tmp_path):
    dataset = CALLS[name](tmp_path)
    assert isinstance(dataset, xr.Dataset)
    assert dataset.attrs["source"] == f"flexapod {fx.__version__}"
    assert dataset.attrs["design"]
    assert len(dataset.attrs["design_digest" if "sweep" in name else "digest"]) == len(H.digest)
    for variable, values in dataset.variables.items():
        told = values.attrs.get("units")
        if told is not None:
            assert told in UNITS, variable
        if values.dtype.kind in "fc" and not _own(variable):
            assert told or _mixed(dataset, values.attrs["mixed_units"]), variable
    quantified = dataset.pint.quantify()
    for variable, values in dataset.data_vars.items():
        if "units" in values.attrs:
            assert quantified[variable].pint.units == pint.Unit(values.attrs["units"]), variable


def _own(variable: str) -> bool:
    """Numbers of a design are in the unit that their key names; a law of one's own has a gain of its own."""
    try:
        return bool(entries(variable)[0].size)
    except fx.ArgumentError:
        return variable in ("against",)


def _mixed(dataset: xr.Dataset, units: str) -> bool:
    """Whether an expression of names of coordinates and of units is right when units take the names' places."""
    coordinates = [name for name in dataset.coords if str(name).endswith("_unit")]
    used = [name for name in coordinates if str(name) in units]
    for row in range(6):
        text = units
        for name in used:
            assert set(dataset[name].values) <= set(UNITS)
            text = text.replace(str(name), f"({dataset[name].values[row]})")
        pint.Unit(text)
    return bool(used)


def test_files_keep_them(tmp_path):
    swept = CALLS["sweep"](tmp_path)
    again = xr.load_dataset(io.BytesIO(bytes(swept.to_netcdf())))
    assert again.pint.quantify().omega_1.pint.units == pint.Unit("rad/s")
