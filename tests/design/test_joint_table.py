"""Joint coordinates from CSV files: the ways in which tables are written, and wrong ones."""

import numpy as np
import pytest
from tests.helpers.cases import case
from tests.helpers.plain import plain_machine
from tests.helpers.support import relative

import flexapod as fx
from flexapod.design import design_file
from flexapod.design.universal_axes import tangent_axes

BASE = np.array([[0.5, 0.1, 0], [0.4, 0.4, 0.01], [-0.4, 0.4, 0], [-0.5, 0, 0], [-0.1, -0.5, 0], [0.1, -0.5, 0.02]])
PLATFORM = 0.6 * BASE[[1, 2, 3, 4, 5, 0]] + [0, 0, 0.05]
AXES = np.roll(BASE, 1, axis=1) + np.array([0, 0, 1])
HEADER = "leg,base_x_mm,base_y_mm,base_z_mm,platform_x_mm,platform_y_mm,platform_z_mm"
DESIGN = """
[platform]
mass = 10.0
mass_center = [0, 0, 0]
inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
[legs]
stiffness = 1e7
[joints]
csv = "joints.csv"
"""
HOME = "[home]\nposition = [0.02, 0.01, 0.5]\norientation_deg = [0, 5, 30]\n"


def table(header=HEADER, columns=(BASE, PLATFORM), scale=1000, separator=",", order=range(6), leg=True):
    """A file's text: leg by leg, the columns side by side."""
    lines = [header]
    for i in order:
        numbers = [repr(float(x)) for x in scale * np.concatenate([points[i] for points in columns])]
        cells = [str(i + 1), *numbers] if leg else numbers
        lines.append(separator.join(cells))
    return "\n".join(lines) + "\n"


@pytest.fixture
def write(tmp_path):
    """Write joints.csv and return its path."""

    def call(text, encoding="utf-8"):
        file = tmp_path / "joints.csv"
        file.write_text(text, encoding=encoding)
        return file

    return call


WAYS = {
    "as documented": table(),
    "in another order": table(order=[3, 1, 5, 0, 2, 4]),
    "without legs": table(HEADER[4:], leg=False),
    "in metres": table("leg,bx,by,bz,px,py,pz", scale=1),
    "as a CAD program titles them": table(
        "No.;Base X [mm];Base Y [mm];Base Z [mm];Top-X (mm);Top-Y (mm);Top-Z (mm)", separator=";"
    ),
    "with decimal commas": table(HEADER.replace(",", ";"), separator=";").replace(".", ","),
    "with tabs": table(HEADER.replace(",", "\t"), separator="\t"),
    "with a mark of Unicode at the start": "\ufeff" + table(),
    "with remarks and empty lines": "# from CAD\n\n" + table().replace("\n3,", "\n\n# the third\n3,"),
    "with a column of notes": "note," + table().replace("\n", '\n"left, rear",').removesuffix('"left, rear",'),
}


def points(letters="BP", order=range(12), header="Point,X [mm],Y [mm],Z [mm]"):
    """A file's text: a line for each of the twelve joints."""
    rows = [f"{letter}{i + 1}" for letter in letters for i in range(6)]
    numbers = 1000 * np.concatenate([BASE, PLATFORM])
    lines = [",".join([rows[i], *(repr(float(x)) for x in numbers[i])]) for i in order]
    return "\n".join([header, *lines]) + "\n"


@pytest.mark.parametrize("order", [range(12), range(11, -1, -1)], ids=["in order", "backwards"])
def test_joints_point_by_point(write, order):
    read = fx.design.read_joints(write(points(order=order)))
    assert read["base.joints"] == pytest.approx(BASE, rel=1e-15)
    assert read["platform.joints"] == pytest.approx(PLATFORM, rel=1e-15)
    home = fx.Pose([0.1, 0, 0.4])
    moved = fx.design.read_joints(write(points("BH", order)), home)
    assert moved["platform.joints"] == pytest.approx(PLATFORM - [0.1, 0, 0.4], rel=1e-14)


def test_a_published_table_of_points():
    found = fx.load(case("recordings", "pts.toml"))
    np.testing.assert_array_equal(found.base_joints[:, 0], [100, 200, 300, 400, 500, 600])
    np.testing.assert_array_equal(found.platform_joints[0], [50, 0, 300])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (points().replace("B2", "C2"), "line 3, column Point: 'C2' is no point"),
        (points().replace("B2", "B1"), "lines 2 and 3 are both point B1"),
        (points(order=range(11)), "B1 to B6 and P1 to P6"),
        (points(header="Point,X,Y,Base Z"), "columns point, x, y, z and no others"),
        (points().replace("P3", "K3"), "'K3' is no point"),
    ],
)
def test_a_wrong_table_of_points_is_told(write, text, words):
    with pytest.raises(fx.DesignError, match=words):
        fx.design.read_joints(write(text))


@pytest.mark.parametrize("way", WAYS)
def test_the_same_joints_however_they_are_written(write, way):
    read = fx.design.read_joints(write(WAYS[way]))
    assert read["base.joints"] == pytest.approx(BASE, rel=1e-15)
    assert read["platform.joints"] == pytest.approx(PLATFORM, rel=1e-15)
    assert read["base.universal_axes"] is None


def test_a_design_file_names_a_table_beside_it(write, tmp_path, result):
    write(table())
    file = tmp_path / "machine.toml"
    file.write_text(DESIGN + HOME)
    hexapod = fx.load(file)
    assert hexapod.name == "machine"
    assert relative(hexapod.base_joints, BASE) < 1e-15
    assert relative(hexapod.platform_joints, PLATFORM) < 1e-15
    assert relative(hexapod.universal_axes, tangent_axes(BASE)[0]) < 1e-15
    assert result("check", file, "--set", "gravity=[0, 0, 0]")["ok"] is True  # under its weight it falls over
    hexapod.save(tmp_path / "saved.toml")
    write("nothing any more")
    assert fx.load(tmp_path / "saved.toml") == hexapod  # it holds the numbers themselves


def test_axes_come_from_the_table_too(write, tmp_path):
    write(table(HEADER + ",axis_x,axis_y,kz", (BASE, PLATFORM, AXES)))
    file = tmp_path / "machine.toml"
    file.write_text(DESIGN)
    assert relative(fx.load(file).universal_axes, AXES / np.linalg.norm(AXES, axis=1)[:, None]) < 1e-15


def test_platform_joints_where_they_stand_at_home(write, tmp_path):
    home = fx.Pose.from_rpy(0.02, 0.01, 0.5, *np.radians([0, 5, 30]))
    standing = home.position + PLATFORM @ home.matrix.T
    csv = write(table(HEADER.replace("platform", "home"), (BASE, standing)))
    file = tmp_path / "machine.toml"
    file.write_text(DESIGN + HOME)
    hexapod = fx.load(file)
    assert relative(hexapod.platform_joints, PLATFORM) < 1e-14
    assert relative(fx.design.read_joints(csv, home)["platform.joints"], PLATFORM) < 1e-14
    length = np.linalg.norm(standing - BASE, axis=1)
    assert fx.inverse_kinematics(hexapod, fx.home_pose(hexapod)) == pytest.approx(length, rel=1e-13)
    file.write_text(DESIGN)
    with pytest.raises(fx.DesignError, match=r"joints.csv.*there is no home\. Add a \[home\] table"):
        fx.load(file)


def test_joints_of_a_table_replace_those_of_a_design(write):
    hexapod = plain_machine("motion-base").replace(fx.design.read_joints(write(table())))
    assert relative(hexapod.base_joints, BASE) < 1e-15
    assert relative(hexapod.universal_axes, tangent_axes(BASE)[0]) < 1e-15


def test_a_text_from_elsewhere_reads_no_file(write, tmp_path, monkeypatch):
    write(table())
    monkeypatch.chdir(tmp_path)
    with pytest.raises(fx.DesignError, match=r"joints\.csv is 'joints\.csv'.*read_joints"):
        fx.Hexapod.from_toml(DESIGN)
    with pytest.raises(fx.DesignError, match=r"joints\.csv is 'joints\.csv'.*read_joints"):
        plain_machine("motion-base").replace({"joints.csv": "joints.csv"})


def test_a_design_for_the_page_holds_its_joints(write, tmp_path):
    write(table())
    file = tmp_path / "machine.toml"
    file.write_text(DESIGN)
    assert fx.Hexapod.from_toml(design_file.self_contained(file)) == fx.load(file)
    write("wrong")
    assert design_file.self_contained(file) == DESIGN
    file.write_text("no TOML = ")
    assert design_file.self_contained(file) == "no TOML = "


ROW = "4,-500.0,"
WRONG = {
    "empty": ("", ["nothing in it", "leg, base_x_mm"]),
    "no header": (table().split("\n", 1)[1], ["column '1' is unknown", "A header is leg"]),
    "five legs": (table(order=range(5)), ["5 lines", "six are needed"]),
    "a leg twice": (table(order=[0, 1, 1, 3, 4, 5]), ["lines 3 and 4 are both leg 2", "once"]),
    "no such leg": (table().replace("\n6,", "\n7,"), ["line 7, column leg: '7'", "1 to 6"]),
    "a word": (table().replace(ROW, "4,abc,"), ["line 5, column base_x_mm: 'abc'", "no finite number"]),
    "an empty cell": (table().replace(ROW, "4,,"), ["line 5, column base_x_mm: ''", "no finite number"]),
    "NaN": (table().replace(ROW, "4,nan,"), ["line 5, column base_x_mm: 'nan'"]),
    "a decimal comma among commas": (table().replace(ROW, "4,-500,0,"), ["line 5 has 8 entries", "7 columns"]),
    "a column too few": (table(HEADER + ",note"), ["line 2 has 7 entries", "8 columns"]),
    "a column missing": (table(HEADER.replace("base_z_mm", "note")), ["missing columns: base_z"]),
    "no platform": (table("leg,bx,by,bz", (BASE,)), ["missing columns: platform_x", "or home_x"]),
    "half an axis": (table(HEADER + ",kx,ky,note", (BASE, PLATFORM, AXES)), ["missing columns: axis_z"]),
    "both platforms": (
        table(HEADER + ",hx,hy,hz", (BASE, PLATFORM, PLATFORM)),
        ["platform_x, ... and home_x", "Leave one of them out"],
    ),
    "a column twice": (table(HEADER.replace("base_y", "base_x")), ["'base_x_mm' and 'base_x_mm' are the same"]),
    "an unknown column": (table(HEADER.replace("base_y", "basis_y")), ["column 'basis_y_mm' is unknown", "base_x"]),
    "an unknown unit": (table(HEADER.replace("_mm", "_yd")), ["column 'base_x_yd' has the unit 'yd'", "m, cm, mm"]),
    "an axis with a unit": (
        table(HEADER + ",kx_mm,ky,kz", (BASE, PLATFORM, AXES)),
        ["'kx_mm'", "this column has none"],
    ),
    "a cell without an end": (table().replace(ROW, '4,"' + 200_000 * "5"), ["no CSV file", "Export"]),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_table_is_told_with_its_place(write, case):
    text, words = WRONG[case]
    file = write(text)
    with pytest.raises(fx.DesignError) as raised:
        fx.design.read_joints(file)
    message = str(raised.value)
    assert message.startswith(str(file))
    assert all(word in message for word in words), message


def test_files_that_cannot_be_read(write, tmp_path):
    with pytest.raises(fx.DesignError, match=r"nowhere\.csv cannot be read: No such file"):
        fx.design.read_joints(tmp_path / "nowhere.csv")
    with pytest.raises(fx.DesignError, match="cannot be read"):
        fx.design.read_joints(tmp_path / "a\0b")
    with pytest.raises(fx.DesignError, match="not a text file in UTF-8"):
        fx.design.read_joints(write("base_x µm", "latin-1"))


TOGETHER = {
    "joints": ("[base]\njoints = [[1,0,0],[2,0,0],[3,0,0],[4,0,0],[5,0,0],[6,0,1]]\n", "base.joints and [joints]"),
    "a circle": ("[base.circle]\nradius = 1\nangles_deg = [0, 60, 120, 180, 240, 300]\n", "[base.circle] and [joints]"),
    "a cube": ("[cubic]\nedge = 0.5\nmiddle = 0.7\n", "[cubic] and [joints]"),
}


@pytest.mark.parametrize("case", TOGETHER)
def test_joints_are_given_once(write, tmp_path, case):
    write(table())
    more, words = TOGETHER[case]
    file = tmp_path / "machine.toml"
    file.write_text(DESIGN + more)
    with pytest.raises(fx.DesignError) as raised:
        fx.load(file)
    assert words in str(raised.value)
    assert "Leave one of them out" in str(raised.value)


def test_axes_are_given_once(write, tmp_path):
    write(table(HEADER + ",kx,ky,kz", (BASE, PLATFORM, AXES)))
    file = tmp_path / "machine.toml"
    file.write_text(DESIGN + f"[base]\nuniversal_axes = {AXES.tolist()}\n")
    with pytest.raises(fx.DesignError, match=r"base.universal_axes and \[joints\] are both given"):
        fx.load(file)


@pytest.mark.parametrize("value", ["3", '""', "['joints.csv']", "{ a = 1 }"])
def test_the_name_of_a_table_is_text(write, tmp_path, value):
    file = tmp_path / "machine.toml"
    file.write_text(DESIGN.replace('"joints.csv"', value))
    with pytest.raises(fx.DesignError, match=r'joints.csv is .*must be text. Write joints.csv = "joints.csv"'):
        fx.load(file)
