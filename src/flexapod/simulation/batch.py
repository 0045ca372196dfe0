"""Many time simulations at once, as one xarray Dataset."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.checks import level_outside, numbers, positive, whole
from flexapod.conventions import Array, JointModel
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError, shown
from flexapod.mechanics.inputs import ZERO, PointLike, as_point
from flexapod.mechanics.modes import advised_sampling_time, natural_modes
from flexapod.progress import ProgressLike, with_progress
from flexapod.simulation.datasets import Told, one_run
from flexapod.simulation.integrator import IntegratorOptions, Method, Trajectories, integrate
from flexapod.simulation.notes import of_recordings, of_results
from flexapod.simulation.run import SimulationRun

MOST_SAMPLES = 20_000
MOST_ASKED = 10_000_000


@with_progress("simulations")
def simulate_many(
    runs: Sequence[SimulationRun],
    duration: float | None = None,
    *,
    times: ArrayLike | None = None,
    samples: int | None = None,
    point: PointLike = ZERO,
    joint: JointModel = "universal",
    method: Method = "automatic",
    rtol: float = 1e-9,
    atol: float | None = None,
    max_step: float = np.inf,
    max_steps: float = 1e8,
    stop_at_singular: bool = True,
    energies: bool = True,
    reactions: bool = False,
    threads: int | None = None,
    progress: ProgressLike = None,
) -> xr.Dataset:
    """Simulate many machines at once, on all threads.

    Parameters
    ----------
    runs : sequence of SimulationRun
        What to simulate.
    duration : float, optional
        Length of every simulation, s. Default: where there is a recording, its length; of several the shortest. A
        recording that ends less than one of its samples earlier ends the simulation.
    times : array_like, optional
        Instants of the result, (m,) s, ascending from 0 or later, the same for all runs.
    samples : int, optional
        Number of instants, evenly spaced from 0 to `duration`; by default as in `simulate`, for the stiffest machine.
    point : array_like or str, optional
        Point of the platforms whose motion is told, (3,) m, in their frames, or the name that it has in every design,
        whose place there must be the same.
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.
    method, rtol, atol, max_step, max_steps, stop_at_singular : optional
        Integrator, its accuracy and its limits, as in `simulate`.
    energies, reactions : bool, optional
        Whether the energy balance and the joints' forces are computed.
    threads : int, optional
        Threads to use; all by default.
    progress : callable or False, optional
        Called with the share done, 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

    Returns
    -------
    xarray.Dataset
        The variables of `simulate` with a first dimension `run`, and over `run`: status ("complete", or why it ended),
        end_time (s), steps, exponential_steps (of them), evaluations, energy_error_relative. A run that ends early is
        NaN from there on.

    Raises
    ------
    ArgumentError
        If there are no runs, or an argument has a wrong shape or range.
    SingularPoseError
        If no leg forces hold the pose of a run.

    Warns
    -----
    UserWarning
        If a recording is sampled too coarsely for the machine, drifts, or begins off zero; if a motion exceeds a limit
        of its machine, or an energy balance is off.

    See Also
    --------
    simulate : one simulation, whose early end is an error.

    Notes
    -----
    The method is that of `simulate`. Runs are spread over the threads; their results do not depend on the number of
    threads.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> runs = [
    ...     fx.simulation.SimulationRun(hexapod, base_motion=fx.harmonic("z", 1e-6, omega)) for omega in (100.0, 200.0)
    ... ]
    >>> result = fx.simulate_many(runs, 0.05, samples=50)
    >>> result.status.values.tolist()
    ['complete', 'complete']
    """
    options = IntegratorOptions(rtol, atol, max_step, max_steps, stop_at_singular, threads, method)
    for i, run in enumerate(runs):
        if not isinstance(run, SimulationRun):
            raise ArgumentError(f"runs[{i}] is {shown(run)}; it must be a flexapod.simulation.SimulationRun.")
    runs = [run.with_friction(joint) for run in runs]
    told = Told(_one_point(runs, point), joint, energies, reactions)
    highest = [natural_modes(run.hexapod, run.pose, joint=joint, base=run.base).omega[-1] for run in runs]
    end = _end(runs, duration) if times is None else duration
    at = _sample_times(times, end, samples, max(highest, default=0.0))
    notes = [note for run, omega in zip(runs, highest, strict=True) for note in of_recordings(run, omega)]
    found = integrate(runs, at, joint=joint, options=options, works=energies, progress=progress or None)
    each = [one_run(run, found, i, at, told) for i, run in enumerate(runs)]
    notes = list(dict.fromkeys([*notes, *_of_results(runs, each, joint)]))
    for note in notes:
        warnings.warn(note, UserWarning, stacklevel=level_outside())
    dataset = xr.concat([part.reindex(time=at) for part in each], dim="run", combine_attrs="drop_conflicts")
    dataset.attrs = {
        **origin(*(run.hexapod for run in runs)),
        "joint": joint,
        "method": _told_method(found),
        "rtol": rtol,
        "warnings": notes,
        "point_m": told.point.tolist(),
        "point": point if isinstance(point, str) else "",
        "last": found.last,
    }
    return dataset


def _told_method(found: Trajectories) -> str:
    exponential = "exponential Adams of orders up to 11 and " if found.steps[:, 3].any() else ""
    return f"{exponential}Runge-Kutta 8(5,3), Dormand and Prince; orientation on SO(3)"


def _one_point(runs: Sequence[SimulationRun], point: PointLike) -> Array:
    """The point of all runs (3,), m, platform frame. Raises ArgumentError where designs have it at different places."""
    places = [as_point(run.hexapod, point) for run in runs]
    if any((place != places[0]).any() for place in places):
        raise ArgumentError(f"point {point!r} is at different places in the designs. Give it as [x, y, z], m.")
    return places[0] if places else np.zeros(3)


def _of_results(runs: Sequence[SimulationRun], each: Sequence[xr.Dataset], joint: JointModel) -> list[str]:
    """What there is to say of the results; of many runs, of the first for each kind and how many there are."""
    found = [of_results(run, result, joint) for run, result in zip(runs, each, strict=True)]
    said = [i for i, notes in enumerate(found) if notes]
    if len(runs) == 1 or not said:
        return [note for notes in found for note in notes]
    return [f"run {said[0]}, and {len(said) - 1} of {len(runs)} runs besides: {note}" for note in found[said[0]]]


def _sample_times(times: ArrayLike | None, duration: float | None, samples: int | None, highest: float) -> Array:
    if times is not None:
        if duration is not None or samples is not None:
            raise ArgumentError("times is given, so duration and samples must not be.")
        return numbers(times, "times", None)
    if duration is None:
        raise ArgumentError("duration is missing, and no recording gives it; give the length in s, or times.")
    end = positive(duration, "duration", "s")
    if samples is None:
        needed = MOST_SAMPLES if highest <= 0 else int(min(np.ceil(end / advised_sampling_time(highest)), MOST_SAMPLES))
        samples = min(MOST_SAMPLES, max(needed, 1)) + 1
    if whole(samples, "samples", 2) > MOST_ASKED:
        raise ArgumentError(f"samples is {samples}; at most {MOST_ASKED} instants are kept. Simulate in parts.")
    found = np.linspace(0.0, end, samples)
    if not (np.diff(found) > 0).all():
        raise ArgumentError(f"duration is {end:.6g} s, in which {samples} instants are the same. Give a longer one.")
    return found


def _end(runs: Sequence[SimulationRun], duration: float | None) -> float | None:
    """The duration given, or that of the shortest recording where it is missing or less than a sample longer."""
    terms = [term for run in runs for use in run.histories().values() for term in use.terms if term.sampled > 0]
    if duration is None:
        return min((term.last for term in terms if term.stop > term.last), default=None)
    end = positive(duration, "duration", "s")
    near = [term.last for term in terms if end - 1.000001 * term.sampled <= term.last < min(end, term.stop)]
    return min([end, *near])
