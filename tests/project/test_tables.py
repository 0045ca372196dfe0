"""CSV files as loggers, spreadsheets and CAD programs write them: one reader for recordings, paths, poses and spectra."""

import numpy as np
import pytest
from tests.helpers.cases import case

import flexapod as fx
from flexapod.cli.options import poses, waypoints
from flexapod.cli.options.spectra import read_spectra
from flexapod.tables import parse_table

ROWS = [(0.01 * i, 0.001 * i**2, 2.0 * i) for i in range(8)]


def lines(header, separator=",", mark=".", end=""):
    rows = (separator.join(f"{x:.6f}".replace(".", mark) for x in row) + end for row in ROWS)
    return "\n".join([header + end, *rows]) + "\n"


RECORDINGS = {
    "plain": lines("time,z,roll_deg"),
    "a mark of Unicode at the start": "\ufeff" + lines("time,z,roll_deg"),
    "units in brackets": lines("Time [s],Z [m],Roll [deg]"),
    "units in parentheses": lines("t (s),z (m),roll (deg)"),
    "capitals": lines("TIME,Z_M,ROLL_DEG"),
    "quoted titles": lines('"time","z","roll_deg"'),
    "semicolons and decimal commas": lines("time;z;roll_deg", ";", ","),
    "tabs": lines("time\tz\troll_deg", "\t"),
    "separators at the ends": lines("time,z,roll_deg", end=","),
    "remarks": "# recorded 2024\n#\n\n" + lines("time,z,roll_deg") + ",,\n",
    "another order": "roll_deg,time,note,z\n" + "".join(f"{c},{a},left,{b}\n" for a, b, c in ROWS),
}


@pytest.mark.parametrize("way", RECORDINGS)
def test_a_recording_is_the_same_however_it_is_written(way, tmp_path):
    (tmp_path / "a.csv").write_text(RECORDINGS[way], encoding="utf-8")
    value = fx.read_time_series(tmp_path / "a.csv").evaluate(0.05)[0]
    assert value[[2, 3]] == pytest.approx([0.025, np.radians(10)], rel=1e-12)


def test_waypoints_and_poses_may_have_units_and_any_order(tmp_path):
    file = tmp_path / "w.csv"
    file.write_text("time_ms;x_mm;yaw_rad;y;z;roll;pitch\n0;0;0;0;2,4;0;0\n1000;100;0,1;0;2,4;10;0\n")
    path = waypoints.read(file, "rest")
    assert path.times.tolist() == [0, 1]
    assert [*path.waypoints.position[1], *path.waypoints.rpy[1]] == pytest.approx([0.1, 0, 2.4, np.radians(10), 0, 0.1])
    file.write_text("x,y,z,yaw,pitch,roll\n0,0,2.4,30,0,0\n")
    assert poses.read_poses(file) == pytest.approx(np.array([[0, 0, 2.4, 0, 0, np.radians(30)]]))
    file.write_text("# x y z roll pitch yaw\n0,0,2.4,30,0,0\n")
    assert poses.read_poses(file) == pytest.approx(np.array([[0, 0, 2.4, np.radians(30), 0, 0]]))


@pytest.mark.parametrize(
    "text", ["Frequency (Hz),X (m2/s4/Hz)\n1,2\n2,2\n", "frequency_hz;x\n1;2\n2;2\n", "f [kHz],x\n0.001,2\n0.002,2\n"]
)
def test_spectra_may_have_units_in_their_titles(tmp_path, text):
    (tmp_path / "psd.csv").write_text(text)
    hertz, density, *_ = read_spectra(tmp_path / "psd.csv")
    assert hertz == pytest.approx([1.0, 2.0])
    assert density.tolist() == [[2, 0, 0, 0, 0, 0]] * 2


@pytest.mark.parametrize(
    ("title", "words"),
    [("force_MN", "unit 'MN'"), ("force_NM", "unit 'NM'"), ("length", "column 'length' is unknown. Give a force.")],
)
def test_units_are_not_guessed(title, words):
    units = {"mN": (1, 1e3), "N_m": (1, 1), "nm": (1, 1e9), "mm": (1, 1e3)}

    def read():
        table = parse_table(f"{title}\n1\n", {"force": "force"}, "Give a force.")
        return table.numbers(table.columns[0], units)

    with pytest.raises(fx.ArgumentError, match=words):
        read()


def test_a_product_of_units_needs_no_mark_between_them():
    units = {"nm": (1, 1e9), "N_m": (1, 1), "kN_m": (1e3, 1)}
    for title, value in {"moment_Nm": 1.0, "moment [kN·m]": 1e3, "moment (N m)": 1.0}.items():
        table = parse_table(f"{title}\n1\n", {"moment": "moment"}, "Give a moment.")
        assert table.numbers(table.columns[0], units)[0] == value


def test_numbers_are_those_of_tables_and_not_of_programs():
    table = parse_table("force\n1_0\n", {"force": "force"}, "Give a force.")
    with pytest.raises(fx.ArgumentError, match="'1_0' is no"):
        table.numbers(table.columns[0])


def test_a_wrong_cell_is_told_with_its_line():
    table = parse_table("# remark\nforce_MM\n\n1\n1e5x\n", {"force": "force"}, "Give a force.")
    with pytest.raises(fx.ArgumentError, match="line 5, column force_MM: '1e5x' is no number"):
        table.numbers(table.columns[0], {"mm": (1, 1e3)}, finite=False)


@pytest.mark.parametrize("name", ["wp", "wp2", "wpmm", "wrapwp", "wrapwp2"])
def test_waypoints_as_people_write_them(name):
    path = waypoints.read(case("recordings", f"{name}.csv"), "rest")
    assert path.waypoints.position[0].tolist() == [0, 0, 2.39]


def test_poses_as_people_write_them():
    rows = poses.read_poses(case("recordings", "poses.csv"))
    assert rows == pytest.approx(np.array([[0, 0, 2.39, 0, 0, 0], [0.1, 0, 2.39, 0, np.radians(5), 0]]))


def test_a_field_without_end_is_told(tmp_path):
    (tmp_path / "a.csv").write_text('time,z\n"' + "1" * 140_000 + "\n")
    with pytest.raises(fx.ArgumentError, match=r"a\.csv: it is no CSV file: field larger than field limit"):
        fx.read_time_series(tmp_path / "a.csv")
