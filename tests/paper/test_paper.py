"""The paper reproduced: figures, frequencies, conclusions and the errors of its print, all made once by the command."""

import json
import re
import sys

import numpy as np
import pandas as pd
import pytest
from tests.helpers.states import draw_state, perturbed
from tests.helpers.support import relative
from tests.oracles import closed_chain_answers as engine_answers
from tests.oracles import printed

import flexapod as fx
from flexapod.cli import main
from flexapod.paper import FIGURES, PARTS, corrections, data_interpretation, gains, vibration
from flexapod.paper.printed_errors import MISPRINTS, State, acceleration
from flexapod.paper.printed_errors import printed as with_errors
from flexapod.paper.reference_answers import answers, disagreement

II = fx.Pose((0, 0, 0.085))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The directory that `flexapod paper` fills, with few poses in the scatter figures."""
    out = tmp_path_factory.mktemp("paper")
    assert main(["paper", "--points", "20000", "--out", str(out), "--json"]) == 0
    return out


@pytest.fixture(scope="module")
def numbers(made):
    """The numbers of every part by its name."""
    return {name: json.loads((made / f"{name}.json").read_text(encoding="utf-8"))["numbers"] for name in PARTS}


# --- the files ------------------------------------------------------------------------------------------------------


def test_every_part_has_its_files(made):
    for name in PARTS:
        assert (made / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        svg = made / f"{name}.svg"
        assert "<svg" in svg.read_text(encoding="utf-8")[:2000]
        assert svg.stat().st_size < 1_000_000  # dense drawings are pixels in it
        assert len(pd.read_csv(made / f"{name}.csv")) >= 1
        assert (made / f"{name}.csv").stat().st_size < 6_000_000


def test_the_page_needs_nothing_else_and_holds_everything(made):
    page = (made / "index.html").read_text(encoding="utf-8")
    assert page.count("<svg") == len(PARTS)
    for name in PARTS:
        record = json.loads((made / f"{name}.json").read_text(encoding="utf-8"))
        section = page[page.index(f'id="{name}"') :].split("</section>")[0]
        assert "<svg" in section
        assert section.count('class="verdict') == len(record["claims"]) > 0
    assert not re.search(r"<script|<link|<img|src=\"http", page)
    linked = set(re.findall(r'href="([\w.-]+)"', page))
    assert linked == {f"{name}.{kind}" for name in PARTS for kind in ("png", "svg", "csv", "json")}
    for number in ("E1", "E2", "E3", "E4", "E5", "E6", "E7", "E8", "B", "C"):
        assert f'<th scope="row">{number}</th>' in page


def test_every_statement_stands_beside_what_is_found(made):
    table = pd.read_csv(made / "comparison.csv", keep_default_na=False)
    assert set(table.part) == set(PARTS)
    assert set(table.verdict) == {"agrees", "differs", "open"}
    assert (table.ours != "").all()
    assert (table[table.verdict != "agrees"].why != "").all()
    first = table[table.part == "natural-frequencies"].iloc[1]
    assert "761.408" in first.ours
    assert first.verdict == "differs"


def test_one_figure_without_the_page(run, tmp_path):
    code, text, _ = run("paper", "--figure", 4, "--points", 500, "--out", tmp_path)
    assert code == 0
    assert "each coordinate plus and minus" in text
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"figure-4.{k}" for k in ("csv", "json", "png", "svg")]
    code, _, said = run("paper", "--figure", 6, "--out", tmp_path)
    assert code == 2
    assert "there are 2, 3, 4, 5" in " ".join(said.split())


# --- figures --------------------------------------------------------------------------------------------------------


def test_figures_2_to_5_say_what_the_text_says(made, numbers):
    for number in (2, 3, 4, 5):
        found = numbers[f"figure-{number}"]
        by_cond = list(found["omega_1_by_cond_H"].values())
        assert by_cond == sorted(by_cond, reverse=True)
        assert by_cond[0] > 40 * by_cond[-1]  # "decreases sharply with increase of condition number"
        assert found["rank_correlation"] < -0.7
        assert found["spread_at_equal_cond_H"] > 1.2  # "at the same condition number ... a lot of variation"
        assert found["part_of_poses_lower_with_larger_mass"] == 1.0  # "decreases with increasing mass"
        assert found["median_ratio_light_to_heavy"] > 3
        table = pd.read_csv(made / f"figure-{number}.csv")
        assert len(table) == pytest.approx(0.99 * 20_000, abs=1)
        assert table.omega_1_rad_s.median() == pytest.approx(found["omega_1_median_rad_s"], rel=0.02)
    assert numbers["figure-2"]["spread_at_equal_cond_H"] > 2


def test_figure_7_grows(made, numbers):
    found = numbers["figure-7"]
    assert found["omega_rad_s"] == pytest.approx(761.408, abs=6e-4)  # corrections, section D
    assert found["omega_printed_rad_s"] == 749.715
    table = pd.read_csv(made / "figure-7.csv", index_col="time_s")
    size = [np.abs(table.yaw_rad[a : a + 0.1]).max() for a in np.arange(0.0, 1.0, 0.1)]
    assert (np.diff(size) > 0).all()
    # Resonance: growth of the amplitude is linear at first, as friction's e-fold is a minute away.
    np.testing.assert_allclose(np.diff(size)[3:], np.diff(size)[3:].mean(), rtol=0.2)  # the other modes beat
    assert found["growth_of_yaw"] == pytest.approx(size[-1] / size[0], rel=0.05)
    assert found["apart_from_tangent"] < 1e-3


def test_figure_8_beats_within_bounds(made, numbers):
    found = numbers["figure-8"]
    assert found["omega_rad_s"] == 550.136
    np.testing.assert_allclose(found["second_half_over_first"], 1.0, atol=0.05)
    assert found["apart_from_tangent"] < 1e-3
    table = pd.read_csv(made / "figure-8.csv", index_col="time_s")
    tangent = vibration._FromRest(fx.linearise(fx.load("mukherjee-ii"), II, joint="spin_free"), 550.136)
    bound = tangent.bound(table.index.values)
    assert (np.abs(table.values) <= 1.001 * bound).all()
    assert bound[:, 2].max() < 1.5 * vibration.AMPLITUDE


def test_figure_9_peaks_where_the_linear_model_says(made, numbers):
    found = numbers["figure-9"]
    assert found["found"] == found["frequencies"] == 200
    assert found["peaks_elsewhere"] == 0
    assert len(found["peaks_rad_s"]) >= 2
    assert found["median_apart_from_tangent"] < 1e-6
    table = pd.read_csv(made / "figure-9.csv", index_col="omega_rad_s")
    assert (table.status == "found").all()
    assert table.index[table.yaw.argmax()] == pytest.approx(761.408, rel=1e-3)
    assert table.index[table.x.argmax()] == pytest.approx(492.6, rel=2e-3)  # the near-repeated pair


# --- frequencies and readings ---------------------------------------------------------------------------------------

TABLE_D = {
    "II, 4 kg": [492.233, 493.049, 761.408, 8636.400, 16141.207, 16233.745],
    "II, 4 kg, exact joints": [492.239, 493.119, 762.076, 8634.964, 16158.869, 16208.143],
    "II, 4 kg, mass centre r_u0 of I": [485.996, 489.707, 750.441, 8689.980, 15923.983, 16749.283],
    "II, 400 kg": [119.656, 119.933, 727.679, 1103.613, 14505.732, 14576.578],
    "II, 4 kg, massless legs": [1226.969, 1229.873, 9819.538, 16564.807, 67114.551, 67248.287],
}


def test_natural_frequencies_to_the_digits_of_table_d(made):
    table = pd.read_csv(made / "natural-frequencies.csv", index_col="manipulator")
    for name, omega in TABLE_D.items():
        np.testing.assert_allclose(table.loc[name].values[:6], omega, rtol=0, atol=1e-3)
        assert table.cond_H[name] == pytest.approx(136.7985, abs=5.001e-5)


def test_every_reading_has_its_effect(made, numbers):
    table = pd.read_csv(made / "readings.csv")
    assert len(table) == len(data_interpretation.READINGS) + 2  # and gravity, for each machine
    still = table.largest_change == 0
    assert list(table.datum[still]) == ["k̄₁"]  # its length does not count: said so
    assert (table.largest_change[~still] > 1e-6).all()
    assert (numbers["readings"]["least_eigenvalue_of_J"]["I"], numbers["readings"]["least_eigenvalue_of_J"]["II"]) > (
        0,
        0,
    )
    printed_r_u0 = fx.load("mukherjee-i").replace({"legs.upper.mass_center": [-6.0, -0.08, 0.08]})
    omega = fx.natural_modes(printed_r_u0, fx.home_pose(printed_r_u0), joint="spin_free").omega
    np.testing.assert_allclose(table.filter(like="omega_").iloc[0, :6], omega, rtol=1e-8)


def test_the_nearest_body_is_one():
    nearest = fx.interchange.nearest_physical(fx.load("mukherjee-i"))
    assert fx.interchange.nearest_physical(nearest) is nearest  # a body stays as it is
    for part in (nearest.legs.lower, nearest.legs.upper):
        body = part.inertia
        principal = np.linalg.eigvalsh(body)
        assert (principal > 0).all()
        assert (principal.sum(axis=1) - 2 * principal[:, 2] > -1e-15).all()  # the triangle inequality


def test_the_printed_inertias_are_none_of_a_body():
    for part, definite in ((fx.load("mukherjee-i").legs.lower, False), (fx.load("mukherjee-i").legs.upper, True)):
        principal = np.linalg.eigvalsh(part.inertia[0])
        assert (principal > 0).all() == definite
        assert principal[2] > principal[0] + principal[1]


# --- conclusions ----------------------------------------------------------------------------------------------------


def test_conclusion_1_each_criterion_is_won_by_its_machine(made, numbers):
    machines = numbers["conclusion-1"]["machines"]
    for measure, winner in (
        ("at_one_pose_rad_s", "best at one pose"),
        ("least_on_path_rad_s", "best least index on the path"),
        ("weighted_mean_rad_s", "best weighted mean on the path"),
    ):
        values = {name: machine[measure] for name, machine in machines.items()}
        assert max(values, key=values.get) == winner
        assert values[winner] > 1.5 * values["as printed"]
    along = pd.read_csv(made / "conclusion-1.csv")
    least = along["best least index on the path (rad/s)"].min()
    assert least == pytest.approx(machines["best least index on the path"]["least_on_path_rad_s"], rel=1e-7)


def test_conclusion_2_poles_near_natural_frequencies_can_vibrate_more(made, numbers):
    found = numbers["conclusion-2"]
    table = pd.read_csv(made / "conclusion-2.csv")
    more, near = table.rms_over_no_control > 1, table.distance < 0.1
    assert found["loops_near_vibrate_more"] == (more & near).sum() > 20
    assert not (more & ~near).any()
    assert (~near).sum() > 20
    assert found["rms_over_no_control"]["near"] > 1.2
    assert found["rms_over_no_control"]["far"] < 0.5
    # After a shock of the tangent's white spectrum, the complete machine moves as the covariance says.
    assert found["rms_over_no_control"]["far"] == pytest.approx(found["predicted"]["far"]["ratio"], rel=0.05)


def test_conclusion_3_the_rule_keeps_a_margin(numbers):
    found = numbers["conclusion-3"]
    omega = fx.natural_modes(fx.load("mukherjee-ii"), II, joint="spin_free").omega
    assert found["rule_s"] == pytest.approx(2 * np.pi / (20 * omega[-1]), rel=1e-6)
    # The force comes 1.5 samples late: a late force damps a mode no more when that is a quarter of its period.
    assert found["samples_per_period_at_the_edge"] == pytest.approx(6, rel=0.15)
    assert 0.85 < found["kept_at_the_rule"] < 1
    rms = list(found["rms_over_fastest"].values())
    assert rms[-1] is None  # unstable
    assert (np.diff(rms[:-1]) > 0).all()


def test_conclusion_2_needs_no_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "control", None)
    bench = gains._Bench("spin_free")
    near, far = (bench.measured(*gains.RUNS[name]).distance for name in ("near", "far"))
    assert near < gains.NEAR < far


# --- corrections ----------------------------------------------------------------------------------------------------


def test_the_stored_answers_are_the_engine_s():
    stored = json.loads(engine_answers.FILE.read_text(encoding="utf-8"))
    for kind, cases in engine_answers.cases().items():
        assert len(stored[kind]) == len(cases)
        for kept, case in zip(stored[kind], cases, strict=True):
            # Near rest an acceleration is what weight (10 m/s2) and leg forces leave of each other: their rounding stays.
            engine = np.array(kept["engine"])
            bound = 1e-11 * np.abs(engine).max() + 1e-12
            np.testing.assert_allclose(engine_answers.answer(kept), engine, rtol=0, atol=bound)
            for body in ("platform", "base"):  # the states are those that the script describes
                for name, value in case[body].items():
                    np.testing.assert_allclose(kept[body][name], value, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("kind", ["moving", "spinning base", "carried"])
def test_without_errors_the_core_agrees_with_the_engine(kind):
    for case in answers(kind):
        assert max(disagreement(acceleration(case.state), case.engine)) < 1e-10  # promised; found: 4e-14


@pytest.mark.parametrize("errors", [(), *[(name,) for name in ("E1", "E2", "E3", "E4", "E5")], tuple(MISPRINTS)[:5]])
@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii"])
def test_misprints_are_the_printed_equations(name, errors):
    """Eqs 6 to 34 written out with the errors in place, against the core with the package's terms added."""
    rng = np.random.default_rng(25)
    for _ in range(3):
        hexapod = perturbed(fx.load(name), rng)
        drawn = draw_state(hexapod, rng)
        state = State(hexapod, drawn.platform, drawn.base, drawn.leg_force, drawn.force, drawn.moment)
        found = with_errors(state, errors, "spin_free")
        expected = printed.equations(hexapod, drawn.platform, drawn.base, errors)
        for field in expected._fields:  # sums of a few hundred products
            assert relative(getattr(found, field), getattr(expected, field)) < 1e-13


def test_e6_turns_the_leg_forces_round():
    case = answers("moving")[0]
    turned = case.state._replace(leg_force=-case.state.leg_force)
    np.testing.assert_allclose(acceleration(case.state, ("E6",)), acceleration(turned), rtol=1e-11)


def test_every_error_shows(numbers):
    found = numbers["corrections"]
    assert set(found) == {*(f"E{n}" for n in range(1, 9)), "E1–E5", "B", "C"}
    for number, row in found.items():
        wrong, right = max(row["as_printed"]), max(row["corrected"])
        assert wrong > 1e-2, number
        if number not in ("E8", "C"):
            assert right < 1e-10, number
    assert max(found["C"]["corrected"]) < 1e-5  # differences of the engine's accelerations err by the step squared
    assert max(found["E8"]["corrected"]) < 0.02 < max(found["E8"]["as_printed"])


def test_size_of_e2_and_of_e7():
    legs = {row.number: row for row in corrections.found()}
    assert "0.39 kg" in legs["E2"].more
    # To second order in a small turn, angles and rotation vector part by half the sums of their products.
    vector = np.array([1e-4, 2e-4, -1e-4])
    x, y, z = vector
    expected = 0.5 * np.linalg.norm([y * z, x * z, x * y])
    assert corrections._angle(vector) == pytest.approx(expected, rel=1e-3)


def test_figures_are_those_of_the_paper():
    assert sorted(FIGURES) == [2, 3, 4, 5, 7, 8, 9]
