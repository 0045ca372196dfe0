"""Certificates of machines with springs, a law and places that stray, in searches, on clusters, and gone on with."""

import numpy as np
import pytest
from tests.helpers.drawn import sprung, with_law
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.certificates import file, largest
from flexapod.errors import OutputError

BASE = plain_machine("motion-base")
HOME = fx.home_pose(BASE)
RNG = np.random.default_rng(14)
SPRUNG = sprung(BASE, RNG)
BOTH = with_law(SPRUNG.replace({"limits": None}), RNG, "hydraulic")
TABLE = with_law(plain_machine("mukherjee-ii"), RNG, "table")
SMALL = fx.Box.about(HOME, 0.02, np.radians(1))


def wide(design, share, degrees):
    home = fx.home_pose(design)
    return fx.Box.about(home, share * float(np.mean(fx.inverse_kinematics(design, home))), np.radians(degrees))


def test_a_cluster_proves_what_one_computer_does():
    pytest.importorskip("distributed")
    places = fx.Uncertain("base.joints[0]", 0.001, relative=False)
    with fx.workspace.cluster("local") as workers:
        for given in ({}, {"uncertain": places}):
            found = fx.certify(BOTH, SMALL, cluster=workers, gap=0.05, **given)
            alone = fx.certify(BOTH, SMALL, gap=0.05, **given)
            assert found.proved
            assert found.lower == pytest.approx(alone.lower, rel=1e-9)


@pytest.mark.parametrize("uncertain", [(), fx.Uncertain("platform.joints", 1e-6, relative=False)])
def test_a_proof_that_was_stopped_is_gone_on_with(uncertain, tmp_path):
    box, path = wide(TABLE, 0.04, 4), tmp_path / "proof.json"
    level = 0.9 * fx.worst_pose(TABLE, box).omega_1
    stopped = fx.certify(TABLE, box, at_least=level, uncertain=uncertain, path=path, time_limit=0.05)
    assert stopped.status == "undecided"
    assert len(stopped.left) > 0
    done = fx.certify(TABLE, box, at_least=level, uncertain=uncertain, path=path, resume=True)
    assert done.proved
    assert done.boxes > stopped.boxes
    assert fx.certificates.check_certificate(path).proved
    again = fx.certify(TABLE, box, at_least=level, uncertain=uncertain, path=path, resume=True)
    assert file.text_of(again) == file.text_of(done)


@pytest.mark.parametrize("design", [SPRUNG, BOTH], ids=["springs", "law"])
def test_what_a_design_search_ends_with_is_proved(design):
    stiffness = "legs.joint_stiffness.spherical"
    found = fx.optimise(
        design,
        [fx.Variable(stiffness, 0.5, 2.0, kind="scale")],
        fx.LeastIndex(SMALL),
        trials=2,
        samples=64,
        verify=256,
        certify=True,
    )
    proof = found.verification.certificate
    assert proof.proved
    assert proof.hexapod.digest == found.hexapod.digest
    assert 0.99 * found.index <= proof.lower * (1 + 1e-9) < found.index
    swept = fx.sweep(found.hexapod, fx.random_poses(SMALL, 5000, seed=3), quantities="omega_1")
    assert float(swept.omega_1.min()) >= proof.lower


@pytest.mark.parametrize("design", [SPRUNG, BOTH], ids=["springs", "law"])
def test_a_planned_path_is_proved(design):
    bound = 0.9 * float(fx.stability_index(design))
    goal = HOME.displaced([0.05, 0.03, 0.05, 0.02, 0.0, 0.05])
    plan = fx.plan_path(design, HOME, goal, bound, certify=True)
    assert plan.certificate.proved
    assert plan.certificate.wanted == bound
    assert fx.path_index(design, plan.path).minimum >= bound


def test_limits_of_bending_are_the_same_in_both_joint_models():
    poses = fx.random_poses(SMALL, 4000)
    moments = fx.joint_moments(SPRUNG, poses.rows(0, 4000))
    bend = float(np.quantile(moments.bending_moment.max(axis=-1), 0.6))
    design = SPRUNG.replace({"limits.spherical_moment": bend})
    kept = {
        joint: fx.sweep(design, poses, joint=joint, quantities=["omega_1", "within_limits"])
        for joint in ("universal", "spin_free")
    }
    assert 0.3 < float(kept["universal"].within_limits.mean()) < 0.8
    assert (kept["universal"].within_limits == kept["spin_free"].within_limits).all()
    rows = poses.rows(0, 300)
    for joint, swept in kept.items():
        assert (fx.check_limits(design, rows, joint=joint).ok == swept.within_limits.values[:300]).all()
        found = fx.certify_limits(design, SMALL, joint=joint)
        assert found.status == "refuted"
        assert not fx.check_limits(design, found.pose, joint=joint).ok
        inside = fx.certify(design, SMALL, joint=joint, within_limits=True, gap=0.02)
        assert inside.proved
        assert inside.lower <= float(swept.omega_1.where(swept.within_limits).min())
        assert inside.share_outside <= 1 - float(swept.within_limits.mean()) + 0.02
    most = float(moments.bending_moment.max())
    wider = SPRUNG.replace({"limits.spherical_moment": 1.3 * most})
    assert fx.certify_limits(wider, SMALL, joint="spin_free").proved


def test_moments_of_universal_joints_are_refused_in_the_model_they_are_not_proved_in():
    design = SPRUNG.replace({"limits.universal_moment": 1e6})
    assert fx.certify_limits(design, SMALL).proved
    with pytest.raises(fx.ArgumentError, match="exact joint model only"):
        fx.certify_limits(design, SMALL, joint="spin_free")


@pytest.mark.parametrize(
    ("region", "error"),
    [([], fx.PoseError), ([SMALL, "box"], fx.PoseError), (np.zeros((0, 6)), fx.PoseError)],
    ids=["no boxes", "a box and a word", "no poses"],
)
def test_regions_without_poses_are_refused(region, error):
    with pytest.raises(error):
        fx.certify(BASE, region)


def test_reversed_boxes_are_refused():
    with pytest.raises(fx.ArgumentError, match="x"):
        fx.Box(x=(0.1, -0.1))


def test_a_target_that_no_pose_has_is_refuted_at_once():
    found = fx.certify(BOTH, SMALL, at_least=1e6)
    assert found.status == "refuted"
    assert found.boxes == 0
    assert found.upper == pytest.approx(float(fx.stability_index(BOTH, found.pose)), rel=1e-9)


def test_the_largest_box_of_a_law_takes_few_searches(monkeypatch):
    """Corners tell where a box leaves the range of a law; the searches for the worst pose are what takes long."""
    design, searches = fx.load("motion-base").replace({"limits": None}), []
    original = largest.least_index
    monkeypatch.setattr(largest, "least_index", lambda *given: searches.append(given) or original(*given))
    shape = fx.Workspace.about_home(0.05, 0.05)
    found = fx.certified_box(design, shape, 20.0, tolerance=0.1)
    assert len(searches) <= 3
    assert found.certificate.proved
    length, law = fx.inverse_kinematics(design, found.pose), design.legs.stiffness_law
    assert ((length < law.range[:, 0]) | (length > law.range[:, 1])).any(), "beyond it no pose has an index"
    assert found.scale <= found.refuted <= 1.2 * found.scale
    swept = fx.sweep(design, fx.random_poses(found.box, 4000), quantities="omega_1")
    assert float(swept.omega_1.min()) >= 20.0


def test_a_search_for_a_box_is_not_gone_on_with_for_other_ranges(tmp_path):
    path, shape = tmp_path / "largest.json", fx.Workspace.about_home(0.02, 0.02)
    places = fx.Uncertain("base.joints[0]", 1e-4, relative=False)
    given = {"tolerance": 0.3, "path": path}
    found = fx.certified_box(BASE, shape, 27.0, uncertain=places, **given)
    again = fx.certified_box(BASE, shape, 27.0, uncertain=places, resume=True, **given)
    assert again.scale == found.scale
    for other in ((), fx.Uncertain("base.joints[0]", 2e-4, relative=False)):
        with pytest.raises(OutputError, match="uncertain places differ"):
            fx.certified_box(BASE, shape, 27.0, uncertain=other, resume=True, **given)
