"""The command line as a user meets it: numbers against published ones, exit codes, messages, JSON, start-up."""

import json
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import click
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.plain import file

import flexapod as fx
from flexapod.cli import COMMANDS
from flexapod.cli.options import common

CENTER = ["--pose", "0", "0", "0.085", "0", "0", "0"]


def test_modes_gives_the_published_frequencies(result):
    found = result("modes", "mukherjee-ii", *CENTER, "--joint", "spin_free")
    published = [492.233, 493.049, 761.408, 8636.400, 16141.207, 16233.745]  # corrections' table, spin_free, M = 4
    assert found["omega_rad_s"] == pytest.approx(published, abs=6e-4)  # half of the last printed digit, and rounding
    assert found["frequency_hz"] == pytest.approx(np.array(found["omega_rad_s"]) / (2 * np.pi), rel=1e-15)
    assert found["condition_number"] == pytest.approx(136.7985, abs=6e-5)  # the same table
    h = fx.load("mukherjee-ii")
    lengths = np.linalg.norm(np.array([0, 0, 0.085]) + h.platform_joints - h.base_joints, axis=1)
    assert found["leg_lengths_m"] == pytest.approx(lengths, rel=1e-14)


def test_set_changes_the_design(result):
    found = result("modes", "mukherjee-ii", *CENTER, "--joint", "spin_free", "--set", "platform.mass=400")
    assert found["stability_index_rad_s"] == pytest.approx(119.656, abs=6e-4)  # the same table, M = 400
    two = result("modes", "mukherjee-ii", "--set", "platform.mass=400", "--set", "legs.stiffness_N_per_um[2]=10")
    h = fx.load("mukherjee-ii").replace({"platform.mass": 400, "legs.stiffness[2]": 1e7})
    assert two["omega_rad_s"] == fx.natural_modes(h, fx.home_pose(h)).omega.tolist()


def test_pose_takes_negative_numbers_and_degrees_about_fixed_axes(result):
    found = result("modes", "mukherjee-i", "--pose", "-0.05", "-.02", "0.9", "-5", "10", "-2.5e1")
    rotation = Rotation.from_euler("xyz", [-5, 10, -25], degrees=True)  # lower case: fixed axes
    pose = fx.Pose([-0.05, -0.02, 0.9], rotation)
    expected = fx.natural_modes(fx.load("mukherjee-i"), pose).omega
    assert found["omega_rad_s"] == pytest.approx(expected, rel=1e-12)  # two ways to one rotation matrix
    assert found["pose_m_deg"] == pytest.approx([-0.05, -0.02, 0.9, -5, 10, -25], rel=1e-13)


def test_characteristic_length_scales_the_moment_rows(result):
    found = result("modes", "mukherjee-ii", *CENTER, "--characteristic-length", "0.05")
    h = fx.load("mukherjee-ii")
    H = fx.force_transformation(h, fx.home_pose(h)) / np.repeat([1.0, 0.05], 3)[:, None]
    assert found["condition_number"] == pytest.approx(np.linalg.cond(H), rel=1e-12)


def test_modes_shows_a_table(run):
    code, out, _ = run("modes", "mukherjee-ii")
    assert code == 0
    assert "492.239" in out  # the table of the corrections, universal
    assert "78.342" in out
    assert "136.799" in out


def test_modes_at_a_singular_pose_has_index_zero(result):
    # A hexagon over a hexagon, turned by a right angle: the platform can screw up and down freely.
    found = result("modes", file("precision-positioner"), "--pose", "0", "0", "0.244", "0", "0", "90")
    assert found["stability_index_rad_s"] < 1e-9 * found["omega_rad_s"][-1]  # zero to rounding
    assert found["condition_number"] is None or found["condition_number"] > 1e12


def test_check_lists_warnings_and_exceeded_limits(run, result):
    fine = result("check", "motion-base")
    assert fine["ok"] is True
    assert fine["limits_exceeded"] == fine["warnings"] == []
    high = result("check", file("motion-base"), "--pose", "0", "0", "3.5", "0", "0", "0")
    assert high["ok"] is False
    assert len(high["limits_exceeded"]) == 6  # every leg is too long there, and nothing else
    assert all("length" in text for text in high["limits_exceeded"])
    assert len(result("check", "mukherjee-i")["warnings"]) == 3
    code, out, _ = run("check", "mukherjee-i")
    assert code == 0
    assert "no rigid body has it" in " ".join(out.split())


def test_new_writes_a_machine_that_works(run, result, tmp_path):
    file = tmp_path / "my machine.toml"
    code, out, _ = run("new", file)
    assert code == 0
    assert str(file) in out
    assert fx.load(file).name == "my machine"
    assert result("check", file)["ok"] is True
    assert len(result("modes", file)["omega_rad_s"]) == 6


def test_new_does_not_overwrite(run, tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("mine")
    code, _, err = run("new", file)
    assert code == 2
    assert "--force" in err
    assert file.read_text() == "mine"
    assert run("new", file, "--force")[0] == 0
    assert fx.load(file).name == "a"


@pytest.mark.parametrize(("given", "written"), [("plain", "plain.toml"), ("with.toml", "with.toml")])
def test_new_names_the_file(result, tmp_path, monkeypatch, given, written):
    monkeypatch.chdir(tmp_path)
    assert result("new", given) == {"file": written, "name": Path(written).stem}
    assert [path.name for path in tmp_path.iterdir()] == [written]


def test_designs_are_found_by_words(run, result):
    assert list(result("designs", "--search", "voice-coil ISOLATES")) == ["cubic-isolator"]
    every = result("designs")
    for name, one in every.items():
        word = next(word for word in one["about"].split() if word.isalpha())
        assert name in result("designs", "--search", f"{name} {word}")
    code, _, err = run("designs", "--search", "isolator submarine")
    assert code == 2
    assert "no packaged design has all of the words isolator, submarine" in err
    assert run("designs", "--search", " ")[0] == 2


def test_designs_lists_the_packaged_ones(run, result):
    assert list(result("designs")) == fx.packaged_designs()
    assert all(name in run("designs")[1] for name in fx.packaged_designs())


@pytest.fixture
def homeless(tmp_path):
    file = tmp_path / "homeless.toml"
    fx.load("motion-base").replace({"home": None}).save(file)
    return file


WRONG = {
    "no such design": (["modes", "motion-bas"], "Did you mean 'motion-base'"),
    "five numbers": (["modes", "mukherjee-ii", "--pose", "0", "0", "0", "0", "0"], "--pose"),
    "not a number": (["modes", "mukherjee-ii", "--pose", "0", "0", "a", "0", "0", "0"], "'a'"),
    "NaN": (["modes", "mukherjee-ii", "--pose", "0", "0", "nan", "0", "0", "0"], "finite"),
    "no such joint model": (["modes", "mukherjee-ii", "--joint", "ball"], "spin_free"),
    "no such key": (["modes", "mukherjee-ii", "--set", "platform.mas=4"], "platform.mass"),
    "no value": (["modes", "mukherjee-ii", "--set", "platform.mass"], "KEY=VALUE"),
    "negative mass": (["modes", "mukherjee-ii", "--set", "platform.mass=-1"], "platform.mass"),
    "unit at a number": (["modes", "mukherjee-ii", "--set", "platform.mass=4kg"], "its unit at the end of the key"),
    "no such option": (["modes", "mukherjee-ii", "--pos"], "--pose"),
    "no such command": (["mods"], "mods"),
    "no design": (["report"], "DESIGN"),
    "zero length": (["modes", "mukherjee-ii", "--characteristic-length", "0"], "--characteristic-length"),
    "leg of length zero": (
        ["modes", "mukherjee-ii", "--set", "platform.joints[0]=[0.03,0,0]", "--pose", *"000000"],
        "leg 1",
    ),
    "not a TOML name": (["new", "design.txt"], ".toml"),
    "no such directory": (["new", "/no/such/directory/a.toml"], "cannot be written"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_wrong_is_said_and_exits_with_2(run, case):
    arguments, words = WRONG[case]
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert words in err
    assert "Traceback" not in err
    message = err[err.index("Error: ") :]
    assert message.count("\n") == 1  # one paragraph
    code, out, err = run(*arguments, "--json")
    assert (code, out) == (2, "")
    assert words in json.loads(err)["error"]


@pytest.mark.parametrize("command", ["modes", "report"])
def test_without_home_and_pose_the_remedy_is_named(run, homeless, command):
    code, _, err = run(command, homeless)
    assert code == 2
    assert "--pose X Y Z ROLL PITCH YAW" in err
    assert "[home]" in err


def test_a_design_without_home_is_checked_as_far_as_it_goes(result, homeless):
    found = result("check", homeless)
    assert found["ok"] is True
    assert found["limits_exceeded"] is None


@pytest.mark.parametrize("content", ["", "name = ", "\udcff", "x = 1"])
def test_a_broken_file_exits_with_2(run, tmp_path, content):
    file = tmp_path / "broken.toml"
    file.write_bytes(content.encode("utf-8", "surrogateescape"))
    code, out, err = run("check", file)
    assert (code, out) == (2, "")
    assert err.startswith("Error: ")
    assert "broken.toml" in err


@pytest.mark.parametrize("command", [[], *([name] for name in COMMANDS)])
def test_every_command_has_help(run, command):
    code, out, err = run(*command, "--help")
    assert (code, err) == (0, "")
    assert "Usage: flexapod" in out
    assert "--json" in out or not command


def test_alone_it_shows_its_help(run):
    code, out, _ = run()
    assert code == 0
    assert all(name in out for name in COMMANDS)


@pytest.mark.parametrize(
    "arguments", [["modes", "mukherjee-ii"], ["check", "mukherjee-ii"], ["designs"], ["--version"]]
)
def test_quick_commands_load_no_heavy_package(arguments):
    # The times are those of `python -m benchmarks startup`; a test of times would fail on a busy machine.
    script = (
        "import sys; from flexapod.cli import main\n"
        f"assert main({arguments!r}) == 0\n"
        "heavy = {'matplotlib', 'scipy', 'xarray', 'pandas', 'control', 'tomlkit'} & set(sys.modules)\n"
        "sys.exit(' '.join(sorted(heavy)) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")


def test_import_loads_nothing_heavy():
    script = "import sys, flexapod; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], timeout=60).returncode == 0


def test_runs_as_a_module_and_as_a_command():
    for command in ([sys.executable, "-m", "flexapod"], [str(Path(sys.executable).with_name("flexapod"))]):
        done = subprocess.run([*command, "modes", "nowhere"], capture_output=True, text=True, timeout=60)
        assert done.returncode == 2
        assert done.stderr.startswith("Error: 'nowhere'")
        done = subprocess.run([*command, "--version"], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0
        assert fx.__version__ in done.stdout


def test_designs_and_keys_complete():
    from flexapod.cli.options.common import Assignment, DesignName

    names = [item.value for item in DesignName().shell_complete(None, None, "mukh")]
    assert names[:2] == ["mukherjee-i", "mukherjee-ii"]
    keys = [item.value for item in Assignment().shell_complete(None, None, "legs.st")]
    assert keys[0] == "legs.stiffness="
    assert all(key.startswith("legs.stiffness") for key in keys)


@pytest.mark.parametrize(
    "typed",
    [["modes", "{}", "--point", "v"], ["response", "--json", "{}", "--at", "v"], ["modes", "--point", "v", "{}"]],
)
def test_points_complete_where_the_design_is_typed(typed, tmp_path):
    """By the shell's own way through the whole command line."""
    path = tmp_path / "pointed.toml"
    path.write_text(fx.load("motion-base").to_toml() + "\n[points]\nvertex_mm = [0, 0, -150]\neye = [0.2, 0, 1.1]\n")
    words = ["flexapod", *(word.format(path) for word in typed[: typed.index("v") + 1])]
    environment = {**os.environ, "_FLEXAPOD_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}  # fmt: skip
    done = subprocess.run([str(Path(sys.executable).with_name("flexapod"))], capture_output=True, text=True, timeout=60, env=environment)  # fmt: skip
    assert (done.stderr, done.stdout.split()) == ("", ["plain,vertex"] if str(path) in words else [])


@pytest.mark.parametrize(
    "point",
    [
        ["--point", "-0.1", "0", "25mm"],
        ["--point=-0.1", "0", "25mm"],
        ["--point", "-10 cm", "0", "0.025"],
        ["--point", "p"],
    ],
)
def test_a_point_is_one_word_or_three(result, tmp_path, point):
    path = tmp_path / "pointed.toml"
    path.write_text(fx.load("mukherjee-ii").to_toml() + "\n[points]\np = [-0.1, 0, 0.025]\n")
    found = result("modes", path, *point, "--set", "platform.mass=4")
    assert found["point_m"] == [-0.1, 0.0, 0.025]
    assert found == result("modes", *point, path, "--set", "platform.mass=4")


@pytest.mark.parametrize(
    ("point", "words"),
    [
        (["--point"], "Option '--point' requires an argument"),
        (["--point", "1", "2"], "1 2 is no point; it takes three numbers X Y Z, or a NAME"),
        (["--point", "1", "2", "3kg"], "'3kg' is not a number with a unit of length"),
        (["--point="], "point is ''"),
        (["--point", "1", "2", "3", "4"], "Got unexpected extra argument (4)"),
    ],
)
def test_what_is_no_point(run, point, words):
    code, _, err = run("modes", "mukherjee-ii", *point)
    assert code == 2
    assert words in err


def test_options_of_files_are_of_one_kind():
    """Every file that is read is looked for before anything is computed, and told with its option."""
    kinds = {}
    for name in COMMANDS:
        command = import_module(f"flexapod.cli.commands.{name}").command
        for one in command.params:
            for kind in getattr(one.type, "types", [one.type]):
                if isinstance(kind, click.Path):
                    kinds[name, one.name] = kind is common.GIVEN_FILE
    written = {place for place, given in kinds.items() if not given}
    assert written == {("new", "file"), ("optimise", "study")}
    assert len(kinds) > 10


def test_check_says_that_a_pose_is_singular(run):
    code, out, _ = run("check", file("motion-base"), "--pose", 0, 0, 2.4, 0, 0, 90)
    assert code == 0
    assert "The pose is singular" in " ".join(out.split())
    assert "OK" not in out
    code, out, _ = run("check", "motion-base")
    assert "singular" not in out.lower()


def test_simulate_says_that_nothing_drives(run):
    assert "Nothing drives the machine" in " ".join(run("simulate", "motion-base", "--duration", 0.01)[1].split())
    driven = run("simulate", "motion-base", "--harmonic", "z", "1um", 20, "--duration", 0.01)[1]
    assert "Nothing drives" not in driven
