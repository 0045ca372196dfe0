"""Which figure belongs to which result: `flexapod.plot(result)`, and the method `plot` of results that are types."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import xarray as xr

from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, shown
from flexapod.mechanics.linearisation import DampedModes
from flexapod.mechanics.modes import NaturalModes
from flexapod.optimisation.design_results import OptimalDesign
from flexapod.optimisation.pareto import ParetoFront
from flexapod.optimisation.uncertainty import Robustness
from flexapod.paths.analysis import PathIndex
from flexapod.plots import control, envelope, optimisation, path, response, simulation, statics, sweep
from flexapod.plots.machine_3d import machine
from flexapod.plots.natural_frequencies import frequencies
from flexapod.workspace.envelope import Envelope

if TYPE_CHECKING:
    from flexapod.plots.style import Drawn


def _modes(modes: NaturalModes | DampedModes, **options: Any) -> Any:
    if modes.omega.ndim != 1:
        shape = modes.omega.shape[:-1]
        raise ArgumentError(f"the modes are those of {shape} poses; one pose is drawn: compute them at one pose.")
    return frequencies(modes.omega, **options)


def _displacements(run: xr.Dataset, **options: Any) -> Any:
    return simulation.displacements(run.time, run.displacement, **options)


#: What draws a result of a type.
TYPES: Mapping[type, Callable[..., Any]] = {
    Hexapod: machine,
    NaturalModes: _modes,
    DampedModes: _modes,
    Envelope: envelope.pairs,
    PathIndex: path.index_along,
    OptimalDesign: optimisation.search,
    ParetoFront: optimisation.front,
    Robustness: optimisation.spread,
}


class _Known(NamedTuple):
    """A Dataset that is known by one of its variables, and the dimensions that this has."""

    variable: str
    dims: tuple[str, ...] | None  # None: those of any set of poses
    draw: Callable[..., Any]


#: What draws a Dataset. No other result has a variable of that name.
DATASETS = (
    _Known("fixed_damping", None, control.schedule),
    _Known("omega_1", None, sweep.auto),
    _Known("spherical_force", ("case", "leg", "axis"), statics.load_cases),
    _Known("static_force", ("time", "leg"), path.loads),
    _Known("motor_torque", ("time", "leg"), path.motors),
    _Known("path_along", ("step",), path.plan_map),
    _Known("relative_displacement", ("time", "output"), _displacements),
    _Known("absolute", ("omega", "output", "base"), response.frequency_response),
    _Known("psd_acceleration", ("omega", "output"), response.random_spectra),
    _Known("harmonics", ("omega", "harmonic", "output"), response.stepped_ratio),
    _Known("controlled", ("omega", "output", "base"), control.isolation),
    _Known("predicted_rms_acceleration", ("case", "axis"), control.controlled_run),
    _Known("zero", ("zero_number",), control.root_locus),
    _Known("distance", ("kp", "kd"), control.gain_map),
)


def plot(result: Any, **options: Any) -> Drawn:
    """Draw the figure of a design or a result, whatever it is.

    Parameters
    ----------
    result : object
        A Hexapod, or what a function of Flexapod gave: modes, an envelope, a search, or the Dataset of a sweep, a
        response, a simulation and so on.
    **options
        Those of the function of `flexapod.plots` that draws it, such as `ax` or `figure`.

    Returns
    -------
    Axes or Figure
        What that function returns.

    Raises
    ------
    ArgumentError
        If there is no figure of such a result, or it holds several of which one must be chosen.

    Notes
    -----
    Results that are types of Flexapod have it as their method `plot`. The figures that are not the first choice are
    those of `flexapod.plots`, such as `plots.optimisation.importance` beside `plots.optimisation.spread`.

    Examples
    --------
    >>> hexapod = fx.load("motion-base")
    >>> fx.plot(fx.natural_modes(hexapod)).get_xlabel()
    'natural frequency, Hz'
    >>> fx.plot(fx.transmissibility(hexapod), given="x").savefig("transmissibility.png")
    """
    drawn: Drawn = _of(result)(**options)
    return drawn


def _of(result: Any) -> Callable[..., Any]:
    """What draws a result, which it is given."""
    for kind, draw in TYPES.items():
        if isinstance(result, kind):
            return partial(draw, result)
    if isinstance(result, xr.Dataset):
        return partial(_of_dataset(result), result)
    raise ArgumentError(f"result is {shown(result)}; there is no figure of it. {_drawn()}")


def _of_dataset(result: xr.Dataset) -> Callable[..., Any]:
    known = next((one for one in DATASETS if one.variable in result), None)
    if known is None:
        names = ", ".join(map(str, result))
        raise ArgumentError(f"result is a Dataset of {names}; there is no figure of it. {_drawn()}")
    dims = tuple(map(str, result[known.variable].dims))
    if known.dims not in (None, dims):
        more = [dim for dim in dims if dim not in known.dims]
        remedy = f"choose one by result.isel({more[0]}=0)" if more else "give the whole result"
        raise ArgumentError(f"result is over {', '.join(dims)}; the figure is over {', '.join(known.dims)}: {remedy}.")
    return known.draw


def _drawn() -> str:
    types = ", ".join(kind.__name__ for kind in TYPES)
    return (
        f"Figures are of {types} and of the Datasets of sweeps (of omega_1), responses, simulations, loads and control."
    )
