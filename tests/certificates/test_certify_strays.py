"""Bounds for all places of joints in a range: no design of the range has less, whatever is beside it."""

import itertools

import numpy as np
import pytest
from tests.helpers.drawn import sprung, with_law
from tests.helpers.plain import plain_machine
from tests.oracles.exact_modes import exact_modes

import flexapod as fx
from flexapod import _core
from flexapod.certificates import checking, file
from flexapod.design.strays import rows_of, strayed
from flexapod.errors import OutputError
from flexapod.report.studies.certificate import study

BASE = plain_machine("motion-base")
HOME = fx.home_pose(BASE)
SMALL = fx.Box.about(HOME, 0.02, np.radians(1))
RNG = np.random.default_rng(14)
MACHINES = {
    "plain": BASE,
    "cubic": plain_machine("cubic-isolator"),
    "joints and suspension": sprung(BASE, RNG),
    "law": with_law(sprung(BASE, RNG), RNG, "hydraulic"),
    "table": with_law(plain_machine("mukherjee-ii"), RNG, "table"),
}
PLACES = ("base.joints", "platform.joints", "platform.mass_center")


def about_home(design, share=0.01, degrees=1.0):
    home = fx.home_pose(design)
    return fx.Box.about(home, share * float(np.mean(fx.inverse_kinematics(design, home))), np.radians(degrees))


def uncertain(amount, *keys):
    return [fx.Uncertain(key, amount, relative=False) for key in keys or PLACES]


def options(reach):
    return _core.CertificateOptions(
        gap=0.0,
        limits=None,
        seconds=np.inf,
        max_boxes=np.inf,
        threads=1,
        cut=0.5,
        strays=reach,
        payload=np.zeros(4),
        home=np.zeros(0),
    )


def least(design, box, joint="universal", samples=1000):
    return float(
        fx.sweep(design, fx.random_poses(box, samples, seed=3), quantities="omega_1", joint=joint).omega_1.min()
    )


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize("kind", MACHINES)
def test_no_design_of_the_range_has_less_than_the_bound(kind, joint, tmp_path):
    design, path = MACHINES[kind], tmp_path / "proof.json"
    box, amount = about_home(design), 3e-4 * float(np.abs(design.base_joints).max())
    if kind == "table":  # lengths that stray over the nodes of a table cost more
        box, amount = about_home(design, 0.005, 0.5), 0.1 * amount
    found = fx.certify(design, box, joint=joint, uncertain=uncertain(amount), path=path)
    assert found.proved
    assert len(found.strays) == 39
    assert found.lower == pytest.approx(0.99 * found.upper, rel=1e-12)
    rng = np.random.default_rng(3)
    for draw in range(40):
        values = rng.uniform(-1, 1, 39) if draw % 2 else rng.choice([-1.0, 1.0], 39)
        assert least(strayed(design, found.strays, values), box, joint) >= found.lower
    # the design and the pose that have the least that is known, which is less than the middle's
    assert found.upper == pytest.approx(float(fx.stability_index(found.adverse, found.pose, joint=joint)), rel=1e-9)
    assert found.upper < least(design, box, joint) * (1 - 1e-5)
    assert np.abs(found.adverse.base_joints - design.base_joints).max() == pytest.approx(amount)
    if design.legs.stiffness_law is None:
        assert exact_modes(found.adverse, found.pose, joint == "universal").omega[0] > found.lower
    assert checking.check_certificate(path).proved
    again = fx.certify(design, box, joint=joint, uncertain=uncertain(amount), path=path, resume=True)
    assert file.text_of(again) == file.text_of(found)
    above = fx.certify(design, box, joint=joint, uncertain=uncertain(amount), at_least=found.upper * (1 + 1e-6))
    assert above.status == "refuted"


def test_what_the_core_is_told_is_never_above_the_least_of_a_corner():
    """One pose, three strays, all corners: no level above the least of them is proved, and one just below is."""
    strays = [one for each in uncertain(0.002, "base.joints[0]") for one in each.strays(BASE)]
    home = np.r_[HOME.position, HOME.rpy]
    box = np.stack([home, home], axis=-1)[None]
    corners = [
        float(fx.stability_index(strayed(BASE, strays, corner), home))
        for corner in itertools.product((-1, 1), repeat=3)
    ]

    def status(level, reach):
        return _core.certify(
            BASE.packed, _core.Joint.universal, box, _core.CertificateKind.index, level, options(reach), None
        ).status.name

    assert min(corners) < 0.9999 * float(fx.stability_index(BASE, home))
    assert status(min(corners) * (1 + 1e-6), rows_of(strays)) != "proved"
    assert status(min(corners) * (1 - 1e-4), rows_of(strays)) == "proved"
    assert status(min(corners) * (1 + 1e-6), rows_of([])) == "proved", "without strays it holds"


def test_ball_arithmetic_proves_the_same():
    exact_bounds = pytest.importorskip("tests.oracles.exact_bounds", reason="python-flint is not installed")
    box, reach = about_home(BASE, 0.001, 0.1), 2e-5
    found = fx.certify(BASE, box, gap=0.05, uncertain=uncertain(reach))
    given = np.stack([box.low, box.high], axis=-1)
    assert exact_bounds.proved(BASE, given, found.lower, most=20, reach=reach) is not None
    assert exact_bounds.proved(BASE, given, found.upper * 1.001, most=5, reach=reach) is None


def test_numbers_that_go_together_stray_less():
    each = fx.certify(BASE, SMALL, uncertain=fx.Uncertain("legs.stiffness", 0.05), gap=0.02)
    both = [fx.Uncertain("legs.stiffness", 0.05), *uncertain(0.001, "base.joints")]
    found = fx.certify(BASE, SMALL, uncertain=both, gap=0.02)
    assert found.proved
    assert found.upper < each.upper
    assert found.nominal == BASE.digest != found.hexapod.digest
    rng = np.random.default_rng(5)
    for _ in range(30):
        design = BASE.replace(
            {
                "legs.stiffness": BASE.legs.stiffness * rng.uniform(0.95, 1.05, 6),
                "base.joints": BASE.base_joints + rng.uniform(-0.001, 0.001, (6, 3)),
            }
        )
        assert least(design, SMALL, samples=500) >= found.lower
    together = fx.Uncertain("base.joints[:][2]", 0.01, relative=False, each=False)
    apart = fx.Uncertain("base.joints[:][2]", 0.01, relative=False)
    assert fx.certify(BASE, SMALL, uncertain=together).upper > fx.certify(BASE, SMALL, uncertain=apart).upper


@pytest.mark.parametrize("distribution", ["normal", "triangular", "lognormal"])
def test_other_distributions_are_taken_to_their_ends(distribution):
    one = fx.Uncertain("platform.joints", 1e-4, distribution)
    strays = one.strays(BASE)
    furthest = {"normal": 4e-4, "triangular": 1e-4, "lognormal": np.expm1(4e-4)}[distribution]
    reach = np.concatenate([stray.reach for stray in strays])
    assert reach == pytest.approx(furthest * np.abs(BASE.platform_joints.ravel()), rel=1e-6)
    assert fx.certify(BASE, HOME, uncertain=one).proved


def test_paths_and_other_claims_are_proved_over_ranges(tmp_path):
    path = fx.Trajectory([[0, 0, 2.4, 0, 0, 0], [0.1, 0.05, 2.5, 0.1, 0, 0.1]], [0, 1])
    plain, found = fx.certify(BASE, path), fx.certify(BASE, path, uncertain=uncertain(0.001))
    assert found.proved
    assert found.upper < plain.upper
    kept = tmp_path / "proof.json"
    regular = fx.certify_regular(BASE, SMALL, uncertain=uncertain(0.01), path=kept)
    assert regular.proved
    assert checking.check_certificate(kept).proved
    condition = fx.certify_condition_number(BASE, SMALL, uncertain=uncertain(0.001), path=kept)
    assert condition.proved
    assert condition.lower > fx.certify_condition_number(BASE, SMALL).lower
    assert float(fx.condition_number(condition.adverse, condition.pose)) == pytest.approx(condition.lower, rel=1e-9)
    assert checking.check_certificate(kept).proved
    rng, poses = np.random.default_rng(3), fx.random_poses(SMALL, 500)
    for _ in range(30):
        design = strayed(BASE, condition.strays, rng.choice([-1.0, 1.0], 39))
        assert float(fx.sweep(design, poses, quantities="cond_H").cond_H.max()) <= condition.upper


def test_what_strays_too_far_is_undecided_at_once():
    found = fx.certify(BASE, HOME, uncertain=uncertain(0.02), gap=0.001)
    assert found.status == "undecided"
    assert 0.9 * found.upper < found.lower < found.upper
    assert found.boxes < 20
    rng = np.random.default_rng(3)
    for _ in range(20):
        design = strayed(BASE, found.strays, rng.choice([-1.0, 1.0], 39))
        assert float(fx.stability_index(design, HOME)) >= found.lower
    refuted = fx.certify(BASE, SMALL, uncertain=uncertain(0.02), at_least=0.9999 * found.upper)
    assert refuted.status == "refuted"
    asked = fx.certify(BASE, SMALL, uncertain=uncertain(0.02), at_least=0.9999 * refuted.upper)
    assert asked.status == "undecided"
    assert asked.boxes < 20
    assert any("uncertain" in one.text for one in study(asked).cautions)


def test_a_file_without_its_ranges_is_no_certificate_of_them(tmp_path):
    path = tmp_path / "proof.json"
    found = fx.certify(BASE, SMALL, uncertain=uncertain(0.001, "base.joints"), path=path)
    assert '"version": 2' in path.read_text()
    read = fx.certificates.read_certificate(path)
    assert read.strays == found.strays
    assert read.strayed == found.strayed
    path.write_text(path.read_text().replace('"base.joints[0][0]": 0.001', '"base.joints[0][0]": 0.002'))
    with pytest.raises(OutputError, match="was changed"):
        fx.certificates.read_certificate(path)
    fx.certify(BASE, SMALL, path=path)
    with pytest.raises(OutputError, match="uncertain places differ"):
        fx.certify(BASE, SMALL, path=path, resume=True, uncertain=uncertain(0.001, "base.joints"))


def test_the_largest_box_over_ranges():
    shape = fx.Workspace.about_home(0.05, 0.05)
    plain = fx.certified_box(BASE, shape, 27.0, tolerance=0.2)
    found = fx.certified_box(BASE, shape, 27.0, tolerance=0.2, uncertain=uncertain(0.002))
    assert found.certificate.proved
    assert found.refuted < plain.refuted
    assert float(fx.stability_index(found.certificate.adverse, found.certificate.pose)) >= 27.0


@pytest.mark.parametrize(
    ("wrong", "match"),
    [
        ("base.universal_axes[0][0]", "base.universal_axes"),
        ("legs.lower.mass_center[0][0]", "legs.lower.mass_center"),
        ("platform.inertia[0][1]", "platform.inertia"),
    ],
)
def test_other_geometry_is_refused_by_name(wrong, match):
    with pytest.raises(fx.ArgumentError, match=match):
        fx.certify(BASE, SMALL, uncertain=fx.Uncertain(wrong, 1e-3, relative=False))


def test_what_cannot_be_proved_over_ranges_is_refused():
    with pytest.raises(fx.ArgumentError, match="within the limits"):
        fx.certify(BASE, SMALL, uncertain=uncertain(0.001), within_limits=True)
    with pytest.raises(fx.ArgumentError, match="twice"):
        fx.certify(BASE, SMALL, uncertain=uncertain(0.001, "base.joints", "base.joints[0]"))
    isolator = fx.load("cubic-isolator")
    with pytest.raises(fx.ArgumentError, match="cubic"):
        fx.certify(isolator, uncertain=fx.Uncertain(f"{isolator.short_forms[0].table}.edge", 0.001))
    with pytest.raises(ValueError, match="may not stray"):
        _core.certify(
            BASE.packed,
            _core.Joint.universal,
            np.zeros((1, 6, 2)),
            _core.CertificateKind.index,
            1.0,
            options(np.ones((1, _core.stray_numbers))),
            None,
        )
