"""The benchmarks run, and refuse a tool that computes something else. How long things take is not tested."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from benchmarks import _figure, _results
from benchmarks._contest import OURS, Contender, Contest, Disagreement, Plan, take_turns
from benchmarks._machine import missing

ROOT = Path(__file__).parents[2]

TASKS = [
    "Start-up",
    "Pose sweep",
    "Sweep of poses, all threads",
    "One call for one pose",
    "Natural frequencies, one pose",
    "Equations of motion",
    "Simulation, rtol 1e-9",
    "Simulation, fastest mode to 1 %",
    "Worst case of a design",
    "Proved bound over a box",
    "Proved bound over a large box",
    "Proved bound over the smallest box",
]


def contest(error=1e-12, limit=1e-9):
    times = iter([1.0, 3.0, 2.0, 4.0, 1.0, 5.0])
    ours = Contender(OURS, "flexapod", "this", lambda: next(times))
    return Contest(
        "Task", "pose", "x, relative", [ours, Contender("NumPy", "numpy", "that", lambda: next(times), error, limit)]
    )


@pytest.fixture
def results():
    return _results.Results({"processor": "a processor"}, True, False, 3, ["jax"], take_turns(contest(), 3))


def test_quick_run_of_all_tools_installed(tmp_path):
    command = [sys.executable, "-m", "benchmarks", "--quick", "--out", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found = json.loads((tmp_path / "results.json").read_text())
    assert list(dict.fromkeys(r["task"] for r in found["records"])) == TASKS
    assert found["absent"] == sorted(
        p for p in ("exudyn", "jax", "mujoco-core", "python-flint", "scikit-sundae") if missing(p)
    )
    tools = {r["tool"] for r in found["records"]}
    assert {"Flexapod", "NumPy + LAPACK", "SciPy", "Pinocchio"} <= tools
    for record in found["records"]:
        assert all(seconds > 0 for seconds in record["seconds"])
    assert "its numbers mean nothing" in done.stdout
    for name in ("table.md", "all-tools.png", "all-tools.svg"):
        assert (tmp_path / name).stat().st_size > 500


def test_ratios_are_of_one_turn(results):
    ours, theirs = results.records
    assert ours.seconds == [1.0, 2.0, 1.0]
    assert theirs.ratios == [3.0, 2.0, 5.0]
    assert (theirs.time, theirs.ratio) == (4.0, 3.0)


@pytest.mark.parametrize("error", [1e-8, float("nan")])
def test_a_tool_that_disagrees_is_not_timed(error):
    with pytest.raises(Disagreement, match=r"Task: NumPy \(that\) is off by"):
        take_turns(contest(error), 1)


def test_a_missing_package_is_named():
    plan = Plan(quick=False)
    assert plan.has("numpy")
    assert not plan.has("numpy", "no-such-package-of-ours")
    assert plan.absent == {"no-such-package-of-ours"}


def test_results_come_back_from_their_file(results, tmp_path):
    _results.save(results, tmp_path / "results.json")
    assert _results.load(tmp_path / "results.json") == results


def test_readme_is_written_between_its_marks(results, tmp_path):
    readme = tmp_path / "README.md"
    readme.write_text(f"before\n{_results.BEGIN}\nold table\n{_results.END}\nafter\n")
    for _ in range(2):  # once more changes nothing
        _results.update(readme, results)
    text = readme.read_text()
    assert text.startswith(f"before\n{_results.BEGIN}\n")
    assert text.endswith(f"{_results.END}\nafter\n")
    assert text.count("| that | 4.00 s | 3.0 | 1e-12 |") == 1
    assert "old table" not in text
    assert "Not installed, so not compared: jax" in text
    readme.write_text("no marks")
    with pytest.raises(SystemExit, match="must have one line"):
        _results.update(readme, results)


def test_own_readme_has_the_marks():
    text = (ROOT / "benchmarks" / "README.md").read_text()
    assert text.index(_results.BEGIN) < text.index(_results.END)


def test_figure_says_time_and_ratio_of_each_bar(results, tmp_path):
    _figure.save(results, tmp_path)
    drawn = (tmp_path / "all-tools.svg").read_text()
    for words in ("3.0 ×", "4.00 s", "Task: 1.00 s a pose (this)"):
        assert words in drawn


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(123.4, "123 s"), (1.0, "1.00 s"), (0.0213, "21.3 ms"), (1.5e-7, "150 ns"), (3e-10, "0.30 ns")],
)
def test_durations_are_told_with_three_digits(seconds, words):
    assert _results.duration(seconds) == words
