"""Searches in a file: killed and resumed, shared by two processes, refused for another design or problem."""

import json
import os
import signal
import sqlite3
import subprocess
import sys
import threading
from contextlib import closing
from itertools import pairwise

import numpy as np
import pytest
from tests.helpers.waiting import until

import flexapod as fx
from flexapod.optimisation import study_file
from flexapod.optimisation.global_search import Study
from flexapod.optimisation.problem import Problem
from flexapod.optimisation.study_file import open_storage

WORKER = """
import sys, time
import flexapod as fx
from flexapod.optimisation import design_search as o
from flexapod.optional import ASKED_OF_ARRAYS, spare

spare(ASKED_OF_ARRAYS)
pause, trials, file = float(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
whole = o._one
def slow(*given):
    time.sleep(pause)
    return whole(*given)
o._one = slow
o.optimise(fx.load("mukherjee-ii"), [fx.Variable("home.position[2]", 0.07, 0.1), fx.Variable("platform.mass", 3, 5)],
    trials=trials, study=file, samples=64, verify=128)
"""


def problem(name="mukherjee-ii", high=0.1, joint="universal"):
    variables = [fx.Variable("home.position[2]", 0.07, high), fx.Variable("platform.mass", 3, 5)]
    return Problem(fx.load(name), variables, fx.LeastIndex(), [], joint, 1)


def start_worker(file, pause, trials):
    return subprocess.Popen([sys.executable, "-c", WORKER, str(pause), str(trials), str(file)], stderr=subprocess.PIPE)


def finished(file):
    """Number, variables and value of every finished trial, as the file itself has them."""
    with sqlite3.connect(f"file:{file}?mode=ro", uri=True) as db:
        rows = db.execute(
            "select t.number, v.value, p.param_name, p.param_value from trials t join trial_values v using (trial_id) "
            "join trial_params p using (trial_id) where t.state = 'COMPLETE' order by t.number, p.param_name"
        ).fetchall()
    found = {}
    for number, value, name, parameter in rows:
        found.setdefault(number, {"value": value})[name] = parameter
    return found


def wait_for(file, count, worker):
    def got_on():
        assert worker.poll() is None, worker.stderr.read().decode()
        try:
            return len(finished(file)) >= count
        except sqlite3.Error:
            return False  # the file is being made

    assert until(got_on, 120), "the worker did not get on"


@pytest.mark.skipif(os.name == "nt", reason="kills with a POSIX signal")
def test_a_killed_search_resumes_and_loses_no_finished_trial(tmp_path):
    file = tmp_path / "study.db"
    worker = start_worker(file, 0.05, 400)
    try:
        wait_for(file, 4, worker)
    finally:
        worker.send_signal(signal.SIGKILL)
        worker.wait()
        worker.stderr.close()
    before = finished(file)
    assert 4 <= len(before) < 400
    found = fx.optimise(
        fx.load("mukherjee-ii"),
        [fx.Variable("home.position[2]", 0.07, 0.1), fx.Variable("platform.mass", 3, 5)],
        trials=len(before) + 6,
        study=file,
        samples=64,
        verify=128,
    )
    after = finished(file)
    assert {number: after[number] for number in before} == before
    assert len(after) == len(before) + 6  # the trial that was killed counts for nothing
    assert found.history.sizes["trial"] == len(after)
    with sqlite3.connect(file) as db:  # and is marked as failed, not left running
        assert db.execute("select count(*) from trials where state = 'RUNNING'").fetchone() == (0,)


def test_two_processes_share_the_work_and_repeat_none(tmp_path):
    file = tmp_path / "study.db"
    workers = [start_worker(file, 0.03, 30) for _ in range(2)]
    for worker in workers:
        _, errors = worker.communicate(timeout=120)
        assert worker.returncode == 0, errors.decode()
    found = finished(file)
    assert len(found) == 30
    points = {(t["home.position[2]"], t["platform.mass"]) for t in found.values()}
    assert len(points) == 30
    with sqlite3.connect(file) as db:
        rows = db.execute("select value_json from trial_user_attributes where key = 'worker'").fetchall()
    shares = [sum(json.loads(row[0]).endswith(f":{worker.pid}") for row in rows) for worker in workers]
    assert min(shares) >= 4  # both were at work


def test_what_a_trial_tries_depends_on_its_number_alone(tmp_path):
    """The same search in one go, and with a stop between, and in memory: the same trials to the last digit."""

    def run(file, stops):
        p = problem()
        for trials in stops:
            study = Study(p, file, samples=16)
            study.run(trials, lambda x: ((a := p.assess_at(x, 16)), (a.index,)))
        return [(t.number, *t.x, *t.values) for t in study.finished()]

    whole = run(None, [16])
    assert whole == run(tmp_path / "a.db", [16]) == run(tmp_path / "b.db", [3, 11, 16])
    assert whole[0][1:3] == (0.085, 4.0)  # the start


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (lambda: problem("mukherjee-i", 0.1), ("'mukherjee-ii' (digest ", "'mukherjee-i' (digest ")),
        (lambda: problem(high=0.2), ("with other variables: there", "0.1", "0.2")),
        (lambda: problem(joint="spin_free"), ("with other joint", '"universal"', '"spin_free"')),
    ],
)
def test_a_study_file_of_another_design_or_problem_is_refused(tmp_path, other, words):
    file = tmp_path / "study.db"
    Study(problem(), file)
    with pytest.raises(fx.errors.OutputError) as error:
        Study(other(), file)
    assert all(word in str(error.value) for word in words), error.value


def test_a_front_and_a_search_do_not_share_a_file(tmp_path):
    Study(problem(), tmp_path / "study.db")
    with pytest.raises(fx.errors.OutputError, match="with other searched for"):
        Study(problem(), tmp_path / "study.db", aim="index against total mass", directions=("maximize", "minimize"))


def test_files_that_are_no_studies_are_refused(tmp_path):
    text = tmp_path / "notes.txt"
    text.write_text("no data base")
    for place, words in (
        (text, "is no study file"),
        (tmp_path / "no" / "where.db", "is no directory"),
        (tmp_path / "a\0b", "cannot be written: embedded null"),
    ):
        with pytest.raises(fx.errors.OutputError, match=words):
            Study(problem(), place)
    assert text.read_text() == "no data base"
    import optuna

    optuna.create_study(storage=f"sqlite:///{tmp_path / 'other.db'}", study_name="another's")
    with pytest.raises(fx.errors.OutputError, match="another's"):
        Study(problem(), tmp_path / "other.db")


def test_a_search_is_stopped_between_trials():
    p = problem()
    study = Study(p, samples=16)
    seen, shares = [], []
    study.run(
        50,
        lambda x: ((a := p.assess_at(x, 16)), (a.index,)),
        progress=shares.append,
        on_trial=lambda done, wanted, best: seen.append((done, wanted, best)),
        stop=lambda: len(seen) >= 5,
    )
    assert [done for done, _, _ in seen] == [0, 1, 2, 3, 4]
    assert shares == [0.0, 0.02, 0.04, 0.06, 0.08]
    assert np.isnan(seen[0][2])
    assert all(b2 >= b1 for (_, _, b1), (_, _, b2) in pairwise(seen[1:]))
    assert len(study.finished()) == 5


def test_a_study_file_is_there_as_a_whole_or_not_at_all(tmp_path, monkeypatch):
    """Whoever finds it finds its tables and its journal mode: that is what "database is locked" came of. No lock that
    a killed process could leave."""
    file, seen = tmp_path / "new.db", []
    link = os.link

    def linked(making, name):
        with closing(sqlite3.connect(making)) as db:
            seen.append(db.execute("select count(*) from sqlite_master where name = 'trials'").fetchone()[0])
            seen.append(db.execute("pragma journal_mode").fetchone()[0])
        assert not file.exists()
        link(making, name)

    monkeypatch.setattr(os, "link", linked)
    open_storage(file).engine.dispose()
    assert seen == [1, "wal"]
    assert [path.name for path in tmp_path.iterdir()] == ["new.db"]


def test_a_study_file_that_another_process_made_meanwhile_stays(tmp_path):
    file = tmp_path / "s.db"
    study = Study(problem(), file, samples=16)
    before = file.stat().st_ino
    study_file._make(file)  # by who looked before it was there
    assert file.stat().st_ino == before
    assert study.finished() == []


def test_nothing_stays_beside_a_study_file(tmp_path):
    file, p = tmp_path / "s.db", problem()
    study = Study(p, file, samples=16)
    study.run(2, lambda x: ((a := p.assess_at(x, 16)), (a.index,)))
    assert list(tmp_path.iterdir()) == [file]
    assert len(study.finished()) == 2
    assert list(tmp_path.iterdir()) == [file]


def test_threads_that_make_one_study_file_at_once_share_it(tmp_path):
    made = []
    threads = [threading.Thread(target=lambda: made.append(open_storage(tmp_path / "new.db"))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert len(made) == 4
    assert len({made[k].create_new_study([1], f"study {k}") for k in range(4)}) == 4
    for storage in made:
        storage.engine.dispose()


@pytest.mark.parametrize("name", ["run?1.db", "a%20b.db", "a b#c.db", "x&y=1.db"])
def test_a_study_is_kept_under_the_name_that_was_given(tmp_path, name):
    search = Study(problem(), tmp_path / name)
    search.run(2, lambda x: (search.problem.assess_at(x, 8), (1.0,)))
    assert (tmp_path / name).read_bytes().startswith(b"SQLite format 3")
    assert len(finished_in(tmp_path / name)) == 2
    assert {file.name.removesuffix("-wal").removesuffix("-shm") for file in tmp_path.iterdir()} == {name}


def finished_in(file):
    with closing(sqlite3.connect(file)) as db:
        return db.execute("select trial_id from trials where state = 'COMPLETE'").fetchall()
