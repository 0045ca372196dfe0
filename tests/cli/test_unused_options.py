"""An option that would count for nothing is refused, instead of an answer that leaves it out without a word."""

import pytest

CERTIFY = ["certify", "motion-base", "--around", "0.01", "0.5", "--at-least", "1Hz"]
SIMULATE = ["simulate", "cubic-isolator", "--harmonic", "z", "1um", "5Hz", "--duration", "0.05"]
SWEEP = ["sweep", "cubic-isolator", "--around", "0.001", "1", "--points", "20"]
GRID = ["sweep", "cubic-isolator", "--grid", "x=0:0.001:2"]


@pytest.mark.parametrize(
    "line",
    [
        ["control", "cubic-isolator", "velocity", "--kp", "1"],
        ["control", "cubic-isolator", "pid", "--kp", "1", "--kd", "1", "--gain", "1"],
        ["control", "cubic-isolator", "velocity", "--leak", "1"],
        ["control", "cubic-isolator", "force", "--effort", "1"],
        ["control", "cubic-isolator", "velocity", "--force-limit", "1"],
        [*CERTIFY, "--ends", "free"],
        [*CERTIFY, "--from-home"],
        [*CERTIFY, "--timeout", "1"],
        ["certify", "--check", "given.csv", "--at-least", "1Hz"],
        ["certify", "--check", "given.csv", "--set", "platform.mass=1"],
        ["path", "mukherjee-i", "given.csv", "--seed", "1"],
        ["path", "mukherjee-i", "given.csv", "--no-limits"],
        ["path", "mukherjee-i", "given.csv", "--least", "time"],
        ["path", "mukherjee-i", *["--from", *"001000"], *["--to", *"001100"], "--bound", "1", "--ends", "free"],
        ["response", "cubic-isolator", "--steps", "7"],
        [*SIMULATE, "--seed", "2"],
        [*SIMULATE, "--exaggeration", "2"],
        ["statics", "cubic-isolator", "--axes", "base"],
        ["modes", "cubic-isolator", "--pivot", *"000"],
        ["envelope", "motion-base", "--pivot", *"001"],
        ["control", "cubic-isolator", "force", "--rotation-order", "XYZ"],
        [*CERTIFY, "--pivot", *"001"],
        ["statics", "cubic-isolator", "loads.csv", "--pivot", *"001"],
        [*SWEEP, "--chunk", "7"],
        [*SWEEP, "--no-poses"],
        [*SWEEP, "--timeout", "1"],
        [*SWEEP, "--level", "1"],
        [*GRID, "--seed", "2"],
    ],
)
def test_it_is_named_with_what_it_is_for(line, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "given.csv").write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0,0,0.9,0,0,0\n")
    (tmp_path / "loads.csv").write_text("case,force_x\n1,2\n")
    code, out, err = run(*line)
    assert (code, out) == (2, "")
    assert " is for " in err
    assert "Leave it out." in err
    option = err.partition("Error: ")[2].split()[0]
    assert option in line or option in ("--limits", "--keep-poses")  # the other names of flags that say no


def test_the_range_of_a_payload_has_units(run):
    line = ["robust", "precision-positioner", "--samples", "8", "--sensitivity", "0", "--json"]
    metric = run(*line, "--payload", "0:0.45359237", "--payload-at", "0", "0", "0.0254:0.0508")
    inches = run(*line, "--payload", "0:1lb", "--payload-at", "0", "0", "1in:2in")
    assert metric[0] == inches[0] == 0
    assert metric[1] == inches[1]
    code, _, err = run(*line, "--payload", "0:1m")
    assert code == 2
    assert "'1m' is not a number with a unit of mass" in err
    code, _, err = run(*line, "--uncertain", "platform.mass=5%", "--payload-at", "0", "0", "1")
    assert code == 2
    assert "--payload-at is the place of a load, and there is none" in err
