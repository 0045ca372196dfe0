"""Every result that has a figure draws it by `plot`, with the options of the function that draws it."""

import inspect
import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from tests.helpers import figures
from tests.helpers.public import CLASSES, PUBLIC

import flexapod as fx
from flexapod.plots import results
from flexapod.plots.style import figure_of


def gain_map():
    return fx.control.gain_map(figures.base(), kp=np.geomspace(1e5, 1e8, 9), kd=np.geomspace(1e3, 1e6, 9))


def schedule():
    poses = fx.pose_grid(z=2.4, x=[-0.1, 0.1], yaw=[-0.2, 0.0, 0.2])
    return fx.control.gain_schedule(figures.base(), poses, "velocity", damping=0.3)


def stepped():
    return fx.stepped_sine(fx.load("mukherjee-ii"), omega=[300.0, 500.0], amplitude=1e-6, axis="z")


#: A result of each kind, and the function of the plots that draws it.
RESULTS = {
    "machine_3d.machine": figures.base,
    "natural_frequencies.frequencies": lambda: fx.natural_modes(figures.base()),
    "envelope.pairs": lambda: fx.envelope(figures.base(), directions=12),
    "path.index_along": figures.indexed_path,
    "optimisation.search": figures.searched,
    "optimisation.front": figures.fronted,
    "optimisation.spread": figures.uncertain,
    "control.schedule": schedule,
    "control.gain_map": gain_map,
    "control.isolation": figures.controlled,
    "control.root_locus": lambda: fx.control.root_locus(figures.isolator(), None, "force"),
    "control.controlled_run": figures.sampled,
    "sweep.index_map": figures.slice_,
    "sweep.index_line": lambda: figures.volume().isel(y=0, z=0),
    "sweep_scatter.index_scatter": figures.cloud,
    "sweep_surface.iso_surface": figures.volume,
    "statics.load_cases": lambda: figures.elevated()[0],
    "path.loads": figures.loaded_path,
    "path.motors": figures.driven_path,
    "path.plan_map": lambda: fx.paths.plan_slice(*figures.planned()),
    "simulation.displacements": figures.shaken,
    "response.frequency_response": figures.transmitted,
    "response.random_spectra": figures.random,
    "response.stepped_ratio": stepped,
}
#: Figures of a result that are not its first, or need the machine beside it.
MORE = {"machine_3d.mode", "optimisation.plan", "optimisation.importance", "simulation.leg_forces"}
pytestmark = pytest.mark.filterwarnings("ignore::flexapod.control.GainWarning")


def test_every_function_that_draws_is_reached():
    assert set(figures.functions()) == set(RESULTS) | MORE


#: Options with which the function draws what `tests/helpers/figures.py` draws with it.
OPTIONS = {
    "response.frequency_response": {"given": "x"},
    "control.root_locus": {"chosen": 5.0},
    "statics.load_cases": {"elevation": np.radians(np.linspace(90, 15, 16))},
}
UNIT = re.compile(r"\b(1/s|rad/s²?|[munµ]?m|m/s²?|[munµ]?rad|[kM]?N|N/m|N s/m|N/\(m s\)|s|deg|Hz|kg|rpm)(\b|$|²)")
#: What labels name that has no unit.
NUMBERS = re.compile(r"cond\(H\)|damping|trial|case|designs|over that|ratio|poses|relative$|^transmissibility$")


def labels(drawn):
    return [(ax.get_xlabel(), ax.get_ylabel(), ax.get_zlabel() if ax.name == "3d" else "") for ax in drawn.axes]


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_draws_its_figure_with_units(name):
    drawn = figure_of(fx.plot(RESULTS[name](), **OPTIONS.get(name, {})))
    assert isinstance(drawn, Figure)
    assert labels(drawn) == labels(figure_of(figures.prepared(name)()))
    said = [text for ax in labels(drawn) for text in ax if text]
    assert said
    assert not [text for text in said if not (UNIT.search(text) or NUMBERS.search(text))]


def test_every_type_with_a_figure_has_the_method_with_the_same_options():
    """But for the Hexapod, which is no result."""
    for kind, draw in results.TYPES.items():
        if kind is fx.Hexapod:
            continue
        own = list(inspect.signature(kind.plot, eval_str=False).parameters.values())[1:]
        function = fx.plots.frequencies if draw is results._modes else draw
        of_function = list(inspect.signature(function).parameters.values())[1:]
        assert {p.name: (p.kind, p.default, p.annotation) for p in own} == {
            p.name: (p.kind, p.default, p.annotation) for p in of_function
        }, kind
    with_method = {PUBLIC[name] for name in CLASSES if hasattr(PUBLIC[name], "plot")}
    assert with_method == set(results.TYPES) - {fx.Hexapod}


METHODS = [
    lambda: fx.natural_modes(figures.base()),
    lambda: fx.linearise(figures.base()).modes(),
    *(RESULTS[name] for name in RESULTS if name.startswith(("envelope", "path.index", "optimisation"))),
]


@pytest.mark.parametrize("make", METHODS)
def test_the_method_draws_where_it_is_told(make):
    result = make()
    page = Figure(figsize=(12, 9))
    options = inspect.signature(type(result).plot).parameters
    given = {"figure": page} if "figure" in options else {"ax": page.add_subplot()}
    drawn = result.plot(**given)
    assert figure_of(drawn) is page
    assert all(ax.has_data() for ax in page.axes)


def test_a_dataset_is_of_one_kind():
    """Each is known by its own variable, whatever comes first in the list."""
    for name, make in RESULTS.items():
        result = make()
        if isinstance(result, xr.Dataset):
            known = [one for one in results.DATASETS if one.variable in result]
            assert len(known) == 1, (name, known)


def test_what_has_no_figure_is_answered():
    many = fx.natural_modes(figures.base(), fx.Pose(figures.base().home.position + np.zeros((2, 3))))
    with pytest.raises(fx.ArgumentError, match="compute them at one pose"):
        many.plot()
    with pytest.raises(fx.ArgumentError, match="there is no figure of it"):
        fx.plot(3.0)
    with pytest.raises(fx.ArgumentError, match="there is no figure of it"):
        fx.plot(xr.Dataset({"a": 1.0}))
    runs = xr.concat([figures.shaken()] * 2, "run", combine_attrs="override")
    with pytest.raises(fx.ArgumentError, match=r"choose one by result.isel\(run=0\)"):
        fx.plot(runs)
    assert fx.plot(runs.isel(run=0)).axes
    with pytest.raises(fx.ArgumentError, match="give the whole result"):
        fx.plot(figures.transmitted().isel(base=0))
