"""Every example runs, answers with the right number, and stands in the table of examples/README.md.

An example is one question: the first line of its docstring. Its `main()` prints the answer and returns one number,
which is in NUMBERS below. Long studies are in STUDIES: their `main()` returns several, and runs on a small budget.
"""

import ast
import importlib.util
import re
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "examples"
FILES = {path.stem: path for path in sorted(FOLDER.glob("*.py"))}

LEG = sqrt(0.4**2 + (2 * 0.3 * np.sin(np.radians(20))) ** 2)  # m, length of those legs

#: What each example returns, and how near it must be, relative.
NUMBERS = {
    "active_damping": (0.256980, 1e-3),
    "bearing_loads": (15829.469, 1e-5),
    "controller_rate": (1.751293e-4, 1e-4),
    "gravity_on_soft_legs": (974.507316, 1e-6),
    "heavier_payload": (900.362736, 1e-6),
    "joint_models": (0.003554672, 1e-5),
    "leg_tolerances": (83.435085, 1e-5),
    "motion_base_on_a_ship": (15937.19, 1e-4),
    "natural_frequencies": (92.4990433, 1e-6),
    "off_centre_point": (7.161571, 1e-4),
    "own_design": (sqrt(6 * 5e6 * (0.4 / LEG) ** 2 / 25.0) / (2 * pi), 1e-12),  # six springs at one slope, one mass
    "path_round_weak_poses": (110.19, 2e-3),
    "platform_on_a_floor": (0.003066021, 1e-5),
    "pose_from_leg_lengths": (3.228303e-6, 1e-5),
    "proved_bound": (4.2679, 1e-4),
    "shock_test": (1.3768, 0.006),  # a mass on a spring and a damper of the mode's frequency and damping, integrated
    "stiffness_for_a_frequency": (16488.2285, 1e-6),
    "to_python_control": (18656.858 + 6 * 4e4 / 3, 1e-6),  # six legs of a cube: their slopes squared are 1/3
    "weakest_pose": (29.4435576, 1e-6),  # within the limits
    "what_matters_most": (0.16278129, 1e-6),  # half of the 32.6 % of the strain energy that the leg holds
}
STUDIES = {"better_manipulators", "better_positioner"}


def example(name):
    specification = importlib.util.spec_from_file_location(f"example_{name}", FILES[name])
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def question(name):
    return ast.get_docstring(ast.parse(FILES[name].read_text(encoding="utf-8"))).splitlines()[0]


def test_every_example_has_its_number():
    missing = set(FILES) - set(NUMBERS) - STUDIES
    assert not missing, f"put the number that main() returns into NUMBERS: {sorted(missing)}"
    assert set(NUMBERS) | STUDIES == set(FILES), "a number without an example"


@pytest.mark.parametrize("name", NUMBERS)
def test_example_gives_its_number(name, capsys):
    found = example(name).main()
    assert isinstance(found, float)
    value, near = NUMBERS[name]
    assert found == pytest.approx(value, rel=near)
    assert len(capsys.readouterr().out.splitlines()) >= 3


@pytest.mark.parametrize("name", FILES)
def test_example_is_one_short_question(name):
    text = FILES[name].read_text(encoding="utf-8")
    assert len(text.splitlines()) < 60
    assert question(name).endswith("?"), f"the docstring of {name} begins with {question(name)!r}, which asks nothing"
    assert "import flexapod as fx\n" in text
    hidden = re.findall(r"fx\._\w+|from flexapod\._\w+|\.packed\b", text)
    assert not hidden, f"{name} uses {hidden}; an example uses public names"


def test_table_lists_every_example():
    rows = re.findall(r"^\| \[`(\w+)\.py`\]\((\w+)\.py\) \| (.*) \| (.*) \|$", (FOLDER / "README.md").read_text(), re.M)
    told = {name: (link, asked, answer) for name, link, asked, answer in rows}
    assert list(told) == list(FILES), "examples/README.md lists other examples than the folder holds"
    for name, (link, asked, answer) in told.items():
        assert link == name
        assert asked == question(name)
        if name in NUMBERS:
            assert float(answer.split()[0]) == pytest.approx(NUMBERS[name][0], rel=0.01), f"the table has {answer}"


def test_own_design_is_saved_and_figure_drawn_where_asked(tmp_path, capsys):
    example("own_design").main(str(tmp_path / "first.toml"))
    example("off_centre_point").main(str(tmp_path / "sensor.png"))
    assert "first machine" in (tmp_path / "first.toml").read_text()
    assert (tmp_path / "sensor.png").stat().st_size > 10_000


def test_study_of_the_manipulators():
    told = example("better_manipulators").main(points=256, verify=1024)
    for name, gain, gap in (("mukherjee-i", 7.5, 1.1), ("mukherjee-ii", 1.5, 1.01)):
        one = told[name]
        assert one["best"] > gain * one["as printed"]
        assert one["best"] > gap * one["best conditioned"]  # the best-conditioned design is not the best one
        assert one["cond(H) best conditioned"] < one["cond(H) best"]
        assert np.isfinite(list(one.values())).all()


def test_study_of_the_positioner():
    told = example("better_positioner").main(trials=8, points=128, verify=512, samples=256)
    assert told["after"] > 1.1 * told["before"]
    assert told["designs"] >= 2
    assert told["worst"] < told["after"]
