"""Commands killed at random moments: what they write is whole or not there, and what they keep is taken up again.

FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import os
import shutil
import sqlite3
from itertools import cycle

import pytest
from tests.attack.bounded import rounds, tried
from tests.attack.killing import Running, cut_short, drawn_kill, killed
from tests.helpers.stores import content
from tests.helpers.writers import WRITERS, files_of, given_files, same

if os.name != "posix":
    pytest.skip("kills with POSIX signals", allow_module_level=True)
pytest.importorskip("optuna")
pytest.importorskip("ompl")
pytest.importorskip("zarr")

BEFORE = b"from before"
NAMES = sorted(set(WRITERS) - {"new"})  # it does not replace anything, and is over at once
SEARCH = ["optimise", "precision-positioner", "--vary", "platform.mass=20:30", "--vary", "home.position_mm[2]=200:300",
          "--trials", "24", "--points", "64", "--verify", "128", "--study", "s.db"]  # fmt: skip
NO_FIGURES = "--json"  # for the searches that are not killed: drawing takes as long as searching
SWEEP = ["sweep", "mukherjee-i", "--around", "0.05", "10", "--points", "60000", "--chunk", "4000", "--out", "a.zarr"]


def _fresh(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return given_files(folder)


@pytest.fixture(scope="module")
def wholes():
    """Commands that were not killed, by name: how they ended and what they wrote."""
    return {}


def test_a_file_is_the_one_from_before_or_the_whole_new_one(tmp_path, wholes):
    folder = tmp_path / "work"
    names = cycle(NAMES)
    for draw in rounds(0.4, "kills"):
        if draw.random() < 0.01 or not wholes:
            names = cycle(draw.sample(NAMES, len(NAMES)))
        name = next(names)
        line = WRITERS[name]
        if name not in wholes:
            own = _fresh(folder)
            wholes[name] = (killed(line, folder), {k: v for k, v in files_of(folder).items() if k not in own})
            assert wholes[name][0].code == 0, wholes[name][0]
        whole, written = wholes[name]
        own = _fresh(folder)
        replaced = draw.random() < 0.5
        for file in written if replaced else ():
            (folder / file).parent.mkdir(exist_ok=True)
            (folder / file).write_bytes(BEFORE)
        as_json = draw.random() < 0.5
        kill = drawn_kill(draw, whole)
        ended = killed([*line, *(["--json"] if as_json else [])], folder, kill)
        told = f"{name}: {kill}: {ended}"
        outcome = cut_short(ended, kill, as_json)
        found = {k: v for k, v in files_of(folder).items() if k not in own}
        stray = [file for file in found if file.rpartition("/")[2].startswith(".")]
        assert kill.signal == 9 or not stray, f"{told} left {stray}"
        for file, now in found.items():
            if file not in stray:
                best_so_far = name == "optimise" and now.endswith((b"\n", b">", b"IEND\xaeB`\x82"))
                assert (replaced and now == BEFORE) or best_so_far or same(now, written[file]), f"{told} cut {file}"
        assert outcome != "done" or set(written) <= set(found), told
        tried("commands killed while they work and write", f"{outcome}, files whole")


def test_a_stored_sweep_goes_on_to_the_same_bytes(tmp_path):
    folder = tmp_path / "work"
    _fresh(folder)
    whole = killed(SWEEP, folder)
    assert whole.code == 0, whole
    truth = content(folder / "a.zarr")
    for draw in rounds(0.25, "killed sweeps"):
        _fresh(folder)
        kills = 0
        for _ in range(draw.randrange(1, 5)):
            as_json = draw.random() < 0.5
            kill = drawn_kill(draw, whole)
            ended = _go_on(folder, ["--json"] if as_json else [], kill)
            if cut_short(ended, kill, as_json) == "done":
                break
            kills += 1
            stray = [path.name for path in folder.iterdir() if path.name.startswith(".")]
            assert kill.signal == 9 or not stray, f"{kill} left {stray}"
        ended = _go_on(folder, [])
        assert ended.code == 0, ended
        assert content(folder / "a.zarr") == truth
        tried("stored sweeps killed and gone on with", f"same bytes after {kills} kills")


def _go_on(folder, more, kill=None):
    return killed([*SWEEP, *(["--resume"] if (folder / "a.zarr").exists() else []), *more], folder, kill)


def _trials(file):
    """Finished trials by their number, read by SQLite itself, which is to find the file sound."""
    if not file.exists():
        return {}
    with sqlite3.connect(file) as db:
        assert db.execute("pragma integrity_check").fetchall() == [("ok",)]
        if not db.execute("select count(*) from sqlite_master where name = 'trial_values'").fetchone()[0]:
            return {}
        rows = db.execute(
            "select t.number, p.param_name, p.param_value, v.value from trials t join trial_values v using (trial_id) "
            "join trial_params p using (trial_id) where t.state = 'COMPLETE' order by t.number, p.param_name"
        ).fetchall()
    found = {}
    for number, name, at, value in rows:
        found.setdefault(number, {"value": value})[name] = at
    return found


def test_a_search_keeps_every_finished_trial_and_repeats_none(tmp_path):
    folder = tmp_path / "work"
    _fresh(folder)
    whole = killed([*SEARCH, NO_FIGURES], folder)
    assert (whole.code, len(_trials(folder / "s.db"))) == (0, 24), whole
    for draw in rounds(0.25, "killed searches"):
        _fresh(folder)
        kept, kills = {}, 0
        for _ in range(draw.randrange(1, 4)):
            as_json = draw.random() < 0.5
            kill = drawn_kill(draw, whole)
            beside = Running([*SEARCH, NO_FIGURES], folder) if draw.random() < 0.3 else None  # shares the work
            ended = killed([*SEARCH, *(["--json"] if as_json else [])], folder, kill)
            kills += cut_short(ended, kill, as_json) == "cut short"
            if beside is not None:
                assert beside.end().code == 0
            now = _trials(folder / "s.db")
            assert {number: now.get(number) for number in kept} == kept, f"{kill} lost a finished trial"
            kept = now
        ended = killed([*SEARCH, NO_FIGURES], folder)
        assert ended.code == 0, ended
        found = _trials(folder / "s.db")
        assert {number: found.get(number) for number in kept} == kept
        assert len(found) == 24
        assert len({tuple(sorted(trial.items())) for trial in found.values()}) == 24, "a trial was made twice"
        with sqlite3.connect(folder / "s.db") as db:
            assert db.execute("select count(*) from trials where state = 'RUNNING'").fetchone() == (0,)
        tried("searches with --study killed and gone on with", f"all trials kept after {kills} kills")
