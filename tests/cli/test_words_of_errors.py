"""What commands print on standard error is in the words of the command line: no calls and arguments of Python alone."""

import pytest
from tests.attack.test_command_lines import PYTHON
from tests.helpers.plain import file

#: Command lines whose errors come from the library, and the option that their remedy names.
LINES = [
    (("robust", "motion-base", "--uncertain", "platform.mass_center[0]=10%"), "it has no %"),
    (
        ("sweep", file("motion-base"), "--box", "z=3.5:3.6,roll=0:1", "--worst", "--no-summary", "--points", "64"),
        "--all-poses",
    ),
    (("sweep", file("motion-base"), "--grid", "z=3.5:3.6:3"), "--all-poses"),
    (
        ("robust", "motion-base", "--uncertain", "platform.mass=10%", "--pose", "0", "0", "3.6", "0", "0", "0"),
        "--all-poses",
    ),
    (("path", "mukherjee-i", "through.csv"), "--from and --to"),
]


@pytest.mark.parametrize(("line", "option"), LINES, ids=lambda part: part[0] if isinstance(part, tuple) else None)
def test_remedies_name_options(line, option, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # from one side of det H to the other: between them no leg force holds the platform
    rows = "t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0,0,0.89,0,0,170\n"
    (tmp_path / "through.csv").write_text(rows)
    code, _, err = run(*line)
    assert code == 2
    said = " ".join(err.split())
    assert option in said
    assert not PYTHON.search(said), said


def test_the_pattern_knows_python():
    for words in (
        "Give hexapod.replace({...})",
        "see fx.load",
        "take all (all_poses)",
        "relative=False",
        "call plan_path()",
    ):
        assert PYTHON.search(words), words
    for words in (
        "pose is (1, 2) m",
        "take all (all_poses, on the command line --all-poses)",
        "KEY=VALUE",
        "cond(H) is 3",
    ):
        assert not PYTHON.search(words), words
