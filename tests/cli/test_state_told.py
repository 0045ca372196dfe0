"""Studies of the index say whether the machine stands where it is least, and that a singular pose has the index zero."""

import json

import pytest

import flexapod as fx

HEAVY = ["cubic-isolator", "--set", "platform.mass=200"]
STUDIES = {
    "sweep": ["--around", 0.002, 1, "--points", 64],
    "robust": ["--uncertain", "cubic.edge_mm=1", "--samples", 16, "--sensitivity", 0],
    "robust --pose": ["--uncertain", "cubic.edge_mm=1", "--samples", 16, "--sensitivity", 0, "--pose", 0, 0, 0.03, 0, 0, 3, "--all-poses"],
    "optimise": ["--around", 0.002, 1, "--trials", 1, "--points", 16, "--verify", 32, "--vary", "cubic.middle=0.3:0.7"],
}  # fmt: skip


@pytest.mark.parametrize("name", STUDIES)
@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_a_machine_that_falls_over_is_told_in_every_study_of_the_index(run, name, joint):
    command = name.split()[0]
    code, out, _ = run(command, *HEAVY, *STUDIES[name], "--joint", joint, "--json")
    assert code == 0
    assert "Not stable at rest" in " ".join(json.loads(out)["warnings"])
    stable = run(command, HEAVY[0], *STUDIES[name], "--joint", joint, "--json")
    assert "Not stable" not in " ".join(json.loads(stable[1])["warnings"])


def test_a_machine_that_falls_over_on_a_path_is_told(run, tmp_path):
    file = tmp_path / "path.csv"
    file.write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0.002,0,0,0,1,0\n")
    code, out, _ = run("path", HEAVY[0], file, "--from-home", *HEAVY[1:], "--json")
    assert code == 0
    assert any("Not stable at rest" in text for text in json.loads(out)["warnings"])


def test_singular_poses_have_index_zero_in_extremes_and_quantiles(run, tmp_path):
    run("new", tmp_path / "own.toml")
    own = tmp_path / "own.toml"
    code, out, _ = run("sweep", own, "--grid", "yaw=-90:90:3", "--all-poses", "--json")
    found = json.loads(out)
    assert code == 0
    assert found["summary"]["worst"]["omega_1"] == 0
    assert found["summary"]["quantiles"]["0.01"] == 0
    assert any("The pose is singular" in text for text in found["warnings"])
    assert "times the 5 % quantile" not in run("sweep", own, "--grid", "yaw=-90:90:3", "--all-poses")[1]


def test_a_search_over_singular_poses_finds_nothing_better(run, tmp_path):
    run("new", tmp_path / "own.toml")
    search = ["--around", 0.3, 60, "--trials", 1, "--points", 64, "--verify", 256, "--vary", "platform.mass=50:70"]
    code, out, _ = run("optimise", tmp_path / "own.toml", *search, "--json")
    found = json.loads(out)
    assert code == 0
    assert found["index_rad_s"] == found["start_index_rad_s"] == found["gain"] == 0
    assert found["start_breaks"] == ["the index is zero: a pose is singular, or out of the legs' reach"]
    assert not found["improved"]


def test_a_law_is_not_blamed_for_a_machine_that_falls_over():
    heavy = fx.load("cubic-isolator").replace({"platform.mass": 200})
    with pytest.raises(fx.errors.UnstableError, match="Without control it falls over"):
        fx.control.closed_loop(heavy, controller=fx.control.VelocityFeedback(300.0))


def test_a_mode_without_damping_is_called_so():
    still = fx.load("cubic-isolator").replace({"legs.damping.prismatic": 0.0})
    with pytest.raises(fx.ArgumentError, match="has no damping, so its random response"):
        fx.random_response(still, psd=fx.vc_curve("VC-C"), axis="z")


def test_a_unit_of_another_quantity_is_answered_by_a_few(run, tmp_path):
    (tmp_path / "psd.csv").write_text("frequency [Hz];z [N2/Hz]\n1;1\n100;1\n")
    code, _, err = run("response", "cubic-isolator", "--psd", tmp_path / "psd.csv")
    assert code == 2
    assert "has the unit 'N2_per_Hz'" in err
    assert len(err) < 400
