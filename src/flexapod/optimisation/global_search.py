"""Global search with Optuna. Trials live in an SQLite file: it can be stopped, resumed, and shared between processes.

What a trial tries depends on the seed, its number and the trials finished before it, never on which process asks: the
first is the start, then come points of a Sobol sequence, then the sampler's own.
"""

from __future__ import annotations

import json
import os
import socket
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from flexapod.conventions import Array
from flexapod.errors import OutputError
from flexapod.optimisation.problem import Assessment, Problem
from flexapod.optimisation.study_file import open_storage, optuna_package, told
from flexapod.workspace.sobol import Sobol

Progress = Callable[[float], object]  # share of the trials done
OnTrial = Callable[[int, int, float], object]  # trials finished, trials wanted, best objective so far (NaN for none)
Stop = Callable[[], bool]


@dataclass(frozen=True)
class Trial:
    """A finished trial: its number, its variables x (SI), and what the objectives made of them."""

    number: int
    x: Array
    values: tuple[float, ...]
    feasible: bool
    violation: float


class Study:
    """The trials of one problem, in memory or in a file. aim: what is searched for, such as "index"; part of what a
    file holds, so that a search and a Pareto front do not share one."""

    def __init__(
        self,
        problem: Problem,
        file: str | Path | None = None,
        *,
        aim: str = "index",
        directions: tuple[str, ...] = ("maximize",),
        seed: int = 0,
        sampler: Literal["tpe", "sobol", "nsga2"] = "tpe",
        samples: int = 2**12,
    ) -> None:
        optuna = optuna_package()
        self.problem, self.seed, self.samples = problem, seed, samples
        self.file = None if file is None else Path(file)
        self._told = {**problem.describe(), "searched for": aim, "poses per trial": samples, "seed": seed}
        self._storage = storage = open_storage(self.file)
        self._name = f"flexapod {problem.hexapod.name} {_digest(self._told)}"
        self._space = {
            p.name: optuna.distributions.FloatDistribution(p.low, p.high, log=p.log) for p in problem.map.parameters
        }
        with told(self.file):
            if self.file is not None:
                self._refuse_others(optuna, storage)
            self._study = optuna.create_study(
                storage=storage,
                study_name=self._name,
                directions=list(directions),
                sampler=_sampler(problem, self._space, seed, sampler),
                load_if_exists=True,
            )
            self._study.set_user_attr("problem", json.dumps(self._told, sort_keys=True))
            self._worker = f"{socket.gethostname()}:{os.getpid()}"
            self._give_up_dead(optuna)
            self._study.set_user_attr(f"worker {self._worker}", True)

    def _refuse_others(self, optuna: Any, storage: Any) -> None:
        for summary in optuna.get_all_study_summaries(storage=storage):
            if summary.study_name == self._name:
                continue
            there = json.loads(summary.user_attrs.get("problem", "{}"))
            if not there:
                raise OutputError(
                    f"{self.file} holds the study {summary.study_name!r}, none of flexapod's. Choose another file."
                )
            raise OutputError(
                f"{self.file} {_conflict(there, self._told)} Choose another file, or set up the same again."
            )

    def _give_up_dead(self, optuna: Any) -> None:
        """Closes the trials of processes of this computer that have ended; they will be made up for.

        A trial that was killed before it had its worker's name is closed if no other worker is left. Optuna's heartbeat
        would not see such a trial, and finds the others only after a while.
        """
        names = [name.partition(" ")[2] for name in self._study.user_attrs if name.startswith("worker ")]
        alone = not any(_at_work(name) for name in names if name != self._worker)
        for trial in self._study.get_trials(deepcopy=False, states=(optuna.trial.TrialState.RUNNING,)):
            name = trial.user_attrs.get("worker")
            if alone if name is None else not _at_work(name):
                self._study.tell(trial.number, state=optuna.trial.TrialState.FAIL, skip_if_finished=True)

    @contextmanager
    def _let_go(self) -> Iterator[None]:
        """At the end, closes the file until it is used again: SQLite then keeps nothing beside it."""
        try:
            yield
        finally:
            if self._storage is not None:
                self._storage.remove_session()
                self._storage.engine.dispose()

    def run(
        self,
        trials: int,
        evaluate: Callable[[Array], tuple[Assessment, tuple[float, ...]]],
        progress: Progress | None = None,
        on_trial: OnTrial | None = None,
        stop: Stop | None = None,
    ) -> None:
        """Goes on until `trials` are finished, by all processes together."""
        optuna = optuna_package()
        with told(self.file), self._let_go():
            while not (stop is not None and stop()):
                done = self._finished()
                if progress is not None:
                    progress(min(1.0, len(done) / trials))
                if on_trial is not None:
                    on_trial(len(done), trials, max((t.values[0] for t in done if t.feasible), default=float("nan")))
                if len(done) >= trials or self._enough_under_way(optuna, len(done), trials):
                    return
                trial = self._study.ask()
                trial.set_user_attr("worker", self._worker)
                if self._ahead(optuna, trial.number) >= trials:  # another process asked for the last one first
                    self._study.tell(trial, state=optuna.trial.TrialState.FAIL)
                    return
                x = np.array([trial.suggest_float(n, s.low, s.high, log=s.log) for n, s in self._space.items()])
                assessment, values = evaluate(x)
                trial.set_constraint("index is zero", 0.0 if assessment.index > 0 else 1.0)
                for k, (requirement, margin) in enumerate(
                    zip(self.problem.requirements, assessment.margins, strict=True)
                ):
                    trial.set_constraint(f"{k} {requirement.name}", 0.0 if margin >= 0 else -float(margin))
                trial.set_user_attr("feasible", assessment.feasible)
                trial.set_user_attr("violation", assessment.violation)
                self._study.tell(trial, values)

    def _enough_under_way(self, optuna: Any, done: int, trials: int) -> bool:
        """Whether other processes are at work on all trials that are missing."""
        running = self._study.get_trials(deepcopy=False, states=(optuna.trial.TrialState.RUNNING,))
        return done + len(running) >= trials and self.file is not None and bool(running)

    def _ahead(self, optuna: Any, number: int) -> int:
        """Trials before this one that are finished or under way."""
        counted = (optuna.trial.TrialState.COMPLETE, optuna.trial.TrialState.RUNNING)
        return sum(t.number < number for t in self._study.get_trials(deepcopy=False, states=counted))

    def finished(self) -> list[Trial]:
        """In order of their numbers."""
        with self._let_go():
            return self._finished()

    def _finished(self) -> list[Trial]:
        optuna = optuna_package()
        with told(self.file):
            trials = self._study.get_trials(deepcopy=False, states=(optuna.trial.TrialState.COMPLETE,))
        found = []
        for t in trials:
            x = np.array([t.params[name] for name in self._space])
            found.append(Trial(t.number, x, tuple(t.values), t.user_attrs["feasible"], t.user_attrs["violation"]))
        return found


def _digest(told: Mapping[str, Any]) -> str:
    from hashlib import sha256

    return sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()[:16]


def _conflict(there: Mapping[str, Any], here: Mapping[str, Any]) -> str:
    """What a study file is for, and what it was opened for."""
    if there["design"] != here["design"]:
        return f"holds a search that began with the design {there['design']}; this one begins with {here['design']}."
    for part in here:
        if json.dumps(there.get(part), sort_keys=True) != json.dumps(here[part], sort_keys=True):
            was, now = (_short(told.get(part)) for told in (there, here))
            return f"holds a search for {here['design']} with other {part}: there {was}; here {now}."
    return "holds another search."


def _short(value: Any, most: int = 300) -> str:
    text = json.dumps(value, sort_keys=True)
    return text if len(text) <= most else text[:most] + " ..."


def _at_work(worker: str) -> bool:
    """Whether a worker, host:process, is there; those of other machines are taken to be."""
    host, _, pid = worker.rpartition(":")
    if host != socket.gethostname() or os.name == "nt":  # there a signal 0 would end the process
        return True
    try:
        os.kill(int(pid), 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _sampler(problem: Problem, space: Mapping[str, Any], seed: int, kind: str) -> Any:
    """Number 0 is the start, then twice as many Sobol points as variables (at least 10), then the sampler proper,
    made anew for each trial from the seed and the trial's number: two processes never try the same."""
    optuna = optuna_package()
    sequence = Sobol(len(space), seed)
    even = max(10, 2 * len(space))
    start = np.clip(problem.map.own(), problem.map.low, problem.map.high)

    class Numbered(optuna.samplers.BaseSampler):  # type: ignore[name-defined]
        def _proper(self, number: int) -> Any:
            own = np.random.SeedSequence([seed, number]).generate_state(1)[0]
            if kind == "nsga2":
                return optuna.samplers.NSGAIISampler(population_size=24, seed=int(own))
            return optuna.samplers.TPESampler(multivariate=True, constant_liar=True, n_startup_trials=0, seed=int(own))

        def infer_relative_search_space(self, study: Any, trial: Any) -> Any:
            return dict(space)

        def sample_relative(self, study: Any, trial: Any, search_space: Any) -> Any:
            complete = (optuna.trial.TrialState.COMPLETE,)
            found: dict[str, float] = {}
            begun = trial.number >= even and bool(study.get_trials(deepcopy=False, states=complete))
            if kind == "nsga2" or (kind == "tpe" and begun):  # the genetic one counts its generations from trial 0
                found = self._proper(trial.number).sample_relative(study, trial, search_space)
            if found:
                return found
            number = trial.number
            x = start if number == 0 else problem.map.from_unit(sequence.points(number, number + 1)[0])[0]
            return dict(zip(space, x.tolist(), strict=True))

        def sample_independent(self, study: Any, trial: Any, name: str, distribution: Any) -> Any:
            k = list(space).index(name)  # a mutation of the genetic sampler: anywhere between the bounds
            u = np.full(len(space), np.random.default_rng([seed, trial.number, k]).random())
            return float(problem.map.from_unit(u)[0][k])

        def after_trial(self, study: Any, trial: Any, state: Any, values: Any) -> None:
            if kind == "nsga2":
                self._proper(trial.number).after_trial(study, trial, state, values)

    return Numbered()
