"""`flexapod optimise` and `flexapod robust`: what they print, write and refuse."""

import json
import os
import re
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from tests.helpers.waiting import until

import flexapod as fx
from flexapod.cli import main

VARY = ["--vary", "home.position_mm[2]=70:100", "--vary", "platform.circle.radius_mm=30:60"]


def run(capsys, *arguments):
    code = main([str(a) for a in arguments])
    told = capsys.readouterr()
    return code, told.out, told.err


def test_optimise_prints_json_and_writes_a_design_that_does_what_it_says(capsys, tmp_path):
    code, out, _ = run(
        capsys, "optimise", "mukherjee-ii", *VARY, "--vary", "base.circle.half_angle_deg=5:55", "--vary",
        "base.circle.radius_mm=20:32", "--keep", "footprint", "--keep", "stroke_mm=26", "--around", 0.004, 4,
        "--trials", 6, "--points", 256, "--verify", 4096, "--study", tmp_path / "s.db",
        "--out", tmp_path / "out", "--json",
    )  # fmt: skip
    assert code == 0
    told = json.loads(out)
    assert told["index_rad_s"] > told["start_index_rad_s"]
    assert told["trials"] == 6
    assert [c["name"] for c in told["constraints"]] == ["footprint of the base", "leg stroke"]
    assert told["constraints"][1]["bound"] == 0.026
    toml, html, png = (Path(file) for file in told["files"])
    better = fx.load(toml)
    assert better.digest == told["digest"]
    worst = fx.stability_index(better, fx.Pose.from_rpy(*told["worst_pose_m_rad"]))
    assert worst == pytest.approx(told["index_rad_s"], rel=1e-12)
    assert 70 <= told["variables"]["home.position_mm[2]"] <= 100
    page = html.read_text(encoding="utf-8")
    assert "all poses within 0.004 m and 4 degrees of home" in page
    assert page.count("<svg") == 2
    assert png.read_bytes()[:4] == b"\x89PNG"


def test_optimise_goes_on_with_its_file_and_refuses_another_design(capsys, tmp_path):
    common = ["--points", 64, "--verify", 128, "--study", tmp_path / "s.db", "--json", *VARY]
    assert run(capsys, "optimise", "mukherjee-ii", "--trials", 3, *common)[0] == 0
    code, out, _ = run(capsys, "optimise", "mukherjee-ii", "--trials", 5, *common)
    assert (code, json.loads(out)["trials"]) == (0, 5)
    code, _, err = run(capsys, "optimise", "mukherjee-i", "--trials", 5, *common)
    assert code == 2
    assert "mukherjee-ii" in json.loads(err)["error"]
    assert "'mukherjee-i'" in json.loads(err)["error"]


def test_front(capsys, tmp_path):
    code, out, _ = run(
        capsys, "optimise", "mukherjee-ii", *VARY, "--vary", "platform.mass=2:4", "--against", "platform-footprint",
        "--trials", 30, "--refine", 3, "--points", 64, "--verify", 128, "--out", tmp_path,
    )  # fmt: skip
    assert code == 0
    assert "against footprint of the platform" in out
    assert (tmp_path / "mukherjee-ii-front.png").exists()
    assert "<svg" in (tmp_path / "mukherjee-ii-front.html").read_text(encoding="utf-8")
    assert fx.load(tmp_path / "mukherjee-ii-1.toml").platform_mass >= 2


def test_robust(capsys, tmp_path):
    code, out, _ = run(
        capsys, "robust", "motion-base", "--uncertain", "legs.stiffness_law.bulk_modulus=10%,together", "--uncertain",
        "platform.mass=100,normal", "--payload", "0:500", "--payload-at", 0, "-0.5:0.5", 1.2, "--samples", 256,
        "--sensitivity", 32, "--out", tmp_path, "--json",
    )  # fmt: skip
    assert code == 0
    told = json.loads(out)
    assert told["worst_rad_s"] < told["quantiles_rad_s"]["0.01"] < told["nominal_rad_s"]
    assert set(told["sobol_total"]) == {"legs.stiffness_law.bulk_modulus", "platform.mass", "payload.mass", "payload.y"}
    assert told["worst_at"]["payload.mass"] == 500
    page = Path(told["files"][0]).read_text(encoding="utf-8")
    assert page.count("<svg") == 2
    code, out, _ = run(capsys, "robust", "motion-base", "--uncertain", "legs.stiffness_law.bulk_modulus=10%", "--samples", 64,
                       "--sensitivity", 0, "--out", tmp_path)  # fmt: skip
    assert code == 0
    assert "worst case" in out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--vary", "platform.mass"], "write KEY=LEAST:LARGEST"),
        (["--vary", "platform.mass=5:x"], "'x' is no number"),
        (["--vary", "platform.mass=5kg:6kg"], "'5kg' is no number. A unit stands at the end of the key"),
        (["--vary", "platform.mass=5:2"], "contradict each other"),
        (["--vary", "platform.circle.radus=1:2"], "there is no 'radus'"),
        ([*VARY, "--keep", "stroke_kg=3"], "there is no 'stroke_kg'"),
        ([*VARY, "--keep", "limits=3"], "takes no bound"),
        ([*VARY, "--keep", "limits"], "no [limits] to respect"),
        ([*VARY, "--keep", "longest-leg"], "needs a bound"),
        ([*VARY, "--around", "0.1", "5", "--pose", *"000000"], "Give one of them"),
        ([], "Missing option '--vary'"),
    ],
)
def test_wrong_command_lines_exit_with_2(capsys, arguments, words):
    code, _, err = run(capsys, "optimise", "mukherjee-ii", "--trials", 0, *arguments)
    assert code == 2
    assert words in err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--uncertain", "legs.stiffness"], "write KEY=SPREAD"),
        (["--uncertain", "legs.stiffness=10%,normal,uniform"], "two distributions"),
        (["--uncertain", "legs.stiffness=10%,gauss"], "'gauss'"),
        ([], "nothing strays"),
    ],
)
def test_wrong_robust_command_lines_exit_with_2(capsys, arguments, words):
    code, _, err = run(capsys, "robust", "mukherjee-ii", *arguments)
    assert code == 2
    assert words in err


@pytest.mark.skipif(os.name == "nt", reason="sends a POSIX signal")
def test_a_signal_stops_between_trials_and_tells_how_to_go_on(tmp_path):
    file = tmp_path / "s.db"
    command = [sys.executable, "-m", "flexapod", "optimise", "mukherjee-ii", *VARY, "--trials", "100000"]
    command += ["--points", "64", "--verify", "128", "--study", str(file), "--out", str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as worker:
        until(lambda: file.exists() and _trials(file) >= 3, 120)
        worker.send_signal(signal.SIGINT)
        out, err = worker.communicate(timeout=120)
    assert worker.returncode == 130, err
    assert "Go on with the same command" in err
    assert "verified at 128 poses" in out


@pytest.mark.skipif(os.name == "nt", reason="sends a POSIX signal")
@pytest.mark.parametrize("against", [[], ["--against", "mass"]], ids=["design", "front"])
def test_a_search_that_is_terminated_gives_its_best_and_says_so(capsys, monkeypatch, against):
    """SIGTERM comes before the fourth trial; nothing is kept in a file."""
    seen = []

    def trial(self, done, wanted, best):
        seen.append(done)
        if done == 3:
            os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr("flexapod.cli.output.progress.TrialProgress.__call__", trial)
    code, out, err = run(capsys, "optimise", "mukherjee-ii", "--vary", "platform.mass=1:5", "--trials", 1000, "--points",
                         16, "--verify", 32, "--json", *against)  # fmt: skip
    told = json.loads(out)
    assert (code, told["cut_short"], told["trials"]) == (143, True, seen[-1] + 1)
    assert "the best so far follows. The trials themselves are not kept without --study." in err
    assert np.max(told["index_rad_s"]) > 0


@pytest.mark.skipif(os.name == "nt", reason="sends a POSIX signal")
@pytest.mark.parametrize("json_too", [[], ["--json"]], ids=["words", "json"])
def test_a_search_that_is_stopped_before_it_has_a_result_exits_with_its_signal(capsys, monkeypatch, json_too):
    monkeypatch.setattr(
        "flexapod.cli.output.progress.TrialProgress.__call__", lambda *told: os.kill(os.getpid(), signal.SIGINT)
    )
    with pytest.raises(SystemExit) as end:
        run(capsys, "optimise", "mukherjee-ii", "--vary", "platform.mass=4:5", "--keep", "mass_kg=2", "--trials", 9,
            "--points", 16, "--verify", 32, *json_too)  # fmt: skip
    err = capsys.readouterr().err
    assert end.value.code == 130
    assert "stopped: no design that keeps every constraint was found" in err
    assert not json_too or json.loads(err)["cut_short"]


def _trials(file):
    import sqlite3

    try:
        with sqlite3.connect(f"file:{file}?mode=ro", uri=True) as db:
            return db.execute("select count(*) from trials where state = 'COMPLETE'").fetchone()[0]
    except sqlite3.Error:
        return 0


def test_the_example_of_the_readme_makes_the_machine_better(capsys, tmp_path, monkeypatch):
    readme = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8").replace("\\\n", " ")
    line = next(line for line in readme.splitlines() if line.startswith("flexapod optimise my-machine.toml"))
    command, _, told = line.partition("#")
    before, after = (float(number) for number in re.findall(r"(\d+) -> (\d+) rad/s", told)[0])
    monkeypatch.chdir(tmp_path)
    assert run(capsys, "new", "my-machine.toml")[0] == 0
    code, out, _ = run(capsys, *shlex.split(command)[1:], "--json")
    found = json.loads(out)
    assert (code, found["improved"], found["start_breaks"]) == (0, True, [])
    assert (found["start_index_rad_s"], found["index_rad_s"]) == pytest.approx((before, after), abs=0.5)
    assert not [
        name for name, one in found["variable_ranges"].items() if not one["low"] <= one["before"] <= one["high"]
    ]


def test_a_start_that_breaks_a_limit_is_said_first(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run(capsys, "new", "own.toml")
    told = ["optimise", "own.toml", "--around", 0.03, 8, "--trials", 0, "--points", 256, "--verify", 4096, "--keep"]
    told += ["limits", "--keep", "footprint", "--vary", "home.position_mm[2]=400:600", "--out", "."]
    code, out, _ = run(capsys, *told)
    assert code == 0
    assert " ".join(out.split()).startswith("own-optimised: own itself is not allowed (shortest leg is 0.485")
    assert "No variable moves: footprint of the base." in out
    page = Path("own-optimised.html").read_text(encoding="utf-8")
    assert page.index("own itself is not allowed (shortest leg") < page.index("Index, verified")
    code, out, _ = run(capsys, *told, "--json")
    found = json.loads(out)
    assert list(found).index("start_breaks") < list(found).index("index_rad_s")
    assert found["start_breaks"][0].startswith("shortest leg is 0.485")
    assert found["unmoved"] == ["footprint of the base"]


def test_answers_are_in_the_units_that_were_asked(capsys, tmp_path):
    told = ["optimise", "mukherjee-ii", "--vary", "platform.circle.radius_mm=46:60", "--vary"]
    told += [
        "base.circle.half_angle_deg=5:55",
        "--vary",
        "legs.stiffness_N_per_um=5:9",
        "--trials",
        0,
        "--out",
        tmp_path,
    ]
    code, out, _ = run(capsys, *told)
    assert code == 0
    lines = {line.split()[0]: line.split()[1:] for line in out.splitlines() if ".circle." in line or "legs." in line}
    assert lines["platform.circle.radius_mm"][:4] == ["mm", "45.0240", "46", "60"]
    assert lines["base.circle.half_angle_deg"][:4] == ["deg", "19.2988", "5", "55"]
    assert lines["legs.stiffness_N_per_um"][0] == "N/um"
    assert "platform.circle.radius_mm is 45.024, its bounds are 46 to 60 mm" in " ".join(out.split())


def test_where_nothing_is_better_no_design_is_written(capsys, tmp_path):
    told = ["optimise", "precision-positioner", "--vary", "platform.mass=60:80", "--trials", 0, "--out", tmp_path]
    code, out, _ = run(capsys, *told)
    assert code == 0
    assert "No design better than precision-positioner was found" in out
    assert not list(tmp_path.glob("*.toml"))
    code, out, _ = run(capsys, *told, "--json")
    found = json.loads(out)
    assert (found["improved"], found["gain"], found["variables"]["platform.mass"]) == (False, 0.0, 30.31)


def test_robust_states_its_assumptions_and_counts_legs_from_one(capsys, tmp_path):
    told = [
        "robust",
        "motion-base",
        "--uncertain",
        "legs.stiffness_law.bulk_modulus=15%",
        "--uncertain",
        "platform.mass_t=0.5,normal",
    ]
    told += ["--payload", "0:500", "--payload-at", 0, "-0.5:0.5", 1.2, "--samples", 64, "--seed", 3]
    code, out, _ = run(capsys, *told, "--sensitivity", 16, "--out", tmp_path)
    assert code == 0
    page = (tmp_path / "motion-base-robust.html").read_text(encoding="utf-8")
    for words in (
        "legs.stiffness_law.bulk_modulus, leg 1",
        "legs.stiffness_law.bulk_modulus, leg 6",
        "uniform",
        "normal",
        "fixed",
        "payload.z",
        "Pa",
    ):
        assert words in out
        assert words in page
    assert "64 designs of a scrambled Sobol sequence, seed 3" in page
    assert "searches ended at this index" in page
    assert "leg 0" not in page
    assert "[0]" not in page
    code, out, _ = run(capsys, *told, "--sensitivity", 0, "--json")
    found = json.loads(out)
    assert (found["seed"], found["samples"], found["poses"]) == (3, 64, 1)
    assert found["worst_at"]["platform.mass_t"] == pytest.approx(6.0)
    assert found["parameters"]["payload.mass"]["high"] == 500
    assert (
        found["parameters"]["legs.stiffness_law.bulk_modulus[0]"]["words"] == "legs.stiffness_law.bulk_modulus, leg 1"
    )
