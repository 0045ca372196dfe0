"""What a report says of the springs of joints, of suspensions, laws and losses."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.report import springs
from flexapod.report.studies.machine import study
from flexapod.report.study import Table

ISOLATOR = plain_machine("cubic-isolator")
SOFT = ISOLATOR.replace(
    {
        "legs.joint_stiffness": {"universal": [15.0, 12.0], "spherical": 14.0, "torsion": 10.0, "loss_factor": 0.02},
        "legs.series_stiffness": [94e6, 50e6],
        "suspension.stiffness": np.diag([2e3, 2e3, 3e3, 50.0, 50.0, 80.0]),
        "suspension.point": [0.0, 0.0, 0.01],
        "limits.universal_moment": 0.3,
    }
)
AWAY = SOFT.home.displaced([0.002, 0, 0, 0.01, 0, 0])
SCREW = plain_machine("precision-positioner").replace(
    {"legs.stiffness_law": {"kind": "screw", "fixed": 5e7, "axial_rigidity": 2e7, "zero_length": 0.1}}
)


def tables(hexapod, pose=None):
    """All tables by title, or by the name of their first column: column -> values."""
    parts = [part for one in study(fx.report.gather(hexapod, pose)).sections for part in one.items]
    found = {}
    for table in parts:
        if isinstance(table, Table):
            name = table.title or table.columns[0].title
            found[name] = {column.title: list(column.values) for column in table.columns}
    return found


def _facts(hexapod, title):
    """A table of names and values."""
    parts = [part for one in study(fx.report.gather(hexapod)).sections for part in one.items]
    (found,) = [
        part for part in parts if isinstance(part, Table) and part.title == title and part.columns[0].title == ""
    ]
    return dict(zip(*(column.values for column in found.columns), strict=True))


def words(hexapod):
    return " ".join(text for one in study(fx.report.gather(hexapod)).sections for text in one.words)


def test_inputs_hold_every_number_of_the_springs():
    found = tables(SOFT)
    legs = found["Legs"]
    joints = found["Stiffness of the joints"]
    assert joints["universal 1"] == ["15"]
    assert joints["universal 2"] == ["12"]
    assert joints["spherical"] == ["14"]
    assert joints["torsion"] == ["10"]
    assert joints["loss factor"] == ["0.02"]
    assert legs["series stiffness 2"] == ["50000000"]
    assert found["Stiffness of the suspension, SI units, axes of the base"]["yaw"] == ["0"] * 5 + ["80"]
    facts = _facts(SOFT, "Gravity, home and limits")
    assert facts["suspension at"] == "(0, 0, 0.01) m, platform frame"
    assert "moment of universal joints 0.3 N m" in facts["limits"]


def test_a_table_of_stiffnesses_is_listed_as_given():
    law = {"kind": "table", "lengths": [0.1, 0.12, 0.14], "stiffnesses": [1.1e4, 1e4, 0.9e4]}
    found = tables(ISOLATOR.replace({"legs.stiffness_law": law}))["Stiffness of the legs by their length"]
    assert found == {"length": ["0.1", "0.12", "0.14"], "stiffness": ["11000", "10000", "9000"]}


def test_shares_of_energy_sum_to_one_over_legs_joints_and_suspension():
    found = tables(SOFT)["strain energy"]
    names = found.pop("strain energy")
    assert names == [*(f"leg {i}" for i in "123456"), *(f"joints of leg {i}" for i in "123456"), "suspension"]
    for column in found.values():
        assert sum(column) == pytest.approx(1)
        assert min(column[12], max(column[6:12])) > 0.01
    assert tables(ISOLATOR)["strain energy"]["strain energy"] == [f"leg {i}" for i in "123456"]
    told = fx.report.gather(SOFT).to_dict()
    parts = [told[f"strain_energy_share_{part}_modes"] for part in ("legs", "joints", "suspension")]
    assert parts[0].sum(axis=0) + parts[1].sum(axis=0) + parts[2] == pytest.approx(np.ones(6))


def test_moments_of_the_joints_stand_beside_the_legs_and_are_marked():
    found = fx.joint_moments(SOFT, AWAY)
    parts = [part for one in study(fx.report.gather(SOFT, AWAY)).sections for part in one.items]
    (table,) = [part for part in parts if isinstance(part, Table) and part.title == "Moments of the joints"]
    assert table.columns[2].values == pytest.approx(found.bending_moment)
    universal = np.linalg.norm(found.universal_moment, axis=-1)
    assert table.columns[1].values == pytest.approx(universal)
    assert (np.asarray(table.columns[1].marked) == (universal > 0.3)).all()
    assert table.columns[1].marked.any()
    assert "Moments of the joints" not in tables(ISOLATOR)


@pytest.mark.parametrize(
    ("hexapod", "told", "untold"),
    [
        (
            ISOLATOR,
            "Legs are axial springs, their joints turn without resistance but friction, the plates",
            "suspension",
        ),
        (SOFT, "axial springs with others in series, their joints resist turning", "without resistance"),
        (SOFT, "a suspension stands beside them", "follows their length"),
        (SCREW, "whose stiffness follows their length (a screw's)", "suspension"),
    ],
)
def test_assumptions_are_those_of_the_design(hexapod, told, untold):
    assert told in words(hexapod)
    assert untold not in words(hexapod)


def test_the_stiffness_told_is_that_of_the_pose():
    """With a law a design has no constant stiffness: at 0.266 m the screw's is 1 / (1/fixed + (L - L_0)/EA)."""
    length = float(fx.inverse_kinematics(SCREW)[0])
    told = 1e-6 / (1 / 5e7 + (length - 0.1) / 2e7)
    facts = _facts(SCREW, "")
    assert facts["Leg stiffness here, with springs in series"] == f"{told:.4g} N/\u00b5m"


def test_moments_that_are_the_rounding_of_angles_are_not_shown():
    flexible = plain_machine("cubic-isolator").replace(
        {"legs.joint_stiffness.spherical": 15.0, "legs.joint_stiffness.universal": 15.0}
    )
    for pose, zero in ((flexible.home, True), (fx.Pose.from_rpy(1e-3, 0, flexible.home.position[2], 0, 0, 0), False)):
        (table,) = springs.moments(flexible, pose, "universal", {})
        assert (not np.any(table.columns[1].values)) == zero
        assert (not np.any(table.columns[2].values)) == zero


def test_moments_are_those_of_the_joint_model():
    flexible = plain_machine("cubic-isolator").replace(
        {"legs.joint_stiffness.spherical": 15.0, "legs.joint_stiffness.universal": [15.0, 2.0]}
    )
    pose = fx.Pose.from_rpy(1e-3, 2e-3, flexible.home.position[2], 0.02, 0.01, 0.1)
    tables = {joint: springs.moments(flexible, pose, joint, {})[0] for joint in ("universal", "spin_free")}
    for joint, table in tables.items():
        found = fx.joint_moments(flexible, pose, joint=joint)
        np.testing.assert_allclose(table.columns[1].values, np.linalg.norm(found.universal_moment, axis=-1))
    assert not np.allclose(*([column.values for column in table.columns[1:]] for table in tables.values()), rtol=1e-6)
