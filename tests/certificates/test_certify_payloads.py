"""Bounds for all places of a payload in a range: no design that carries it has less."""

import itertools

import numpy as np
import pytest
from tests.certificates.test_certify_strays import BASE, HOME, MACHINES, SMALL, about_home, least, uncertain
from tests.oracles.exact_modes import exact_modes

import flexapod as fx
from flexapod.certificates import checking, file
from flexapod.design.payload import with_payload
from flexapod.errors import OutputError

LOAD = fx.optimisation.Payload((0, 300), ((-0.2, 0.2), 0.1, (0.3, 0.5)))


def carrying(design, mass, at):
    return with_payload(design, mass, np.array(at), np.zeros((3, 3)))


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize("kind", ["plain", "joints and suspension", "law"])
def test_no_place_of_a_payload_has_less_than_the_bound(kind, joint, tmp_path):
    design, path = MACHINES[kind], tmp_path / "proof.json"
    box = about_home(design)
    found = fx.certify(design, box, joint=joint, uncertain=LOAD, gap=0.02, path=path)
    assert found.proved
    assert found.payload == (300.0, 0.0, 0.1, 0.4)
    assert found.assumed == ("a payload of 0 to 300 kg at (-0.2 to 0.2, 0.1, 0.3 to 0.5) m",)
    assert found.hexapod.digest == found.nominal == design.digest
    rng = np.random.default_rng(8)
    corners = [(x, 0.1, z) for x, z in itertools.product((-0.2, 0.2), (0.3, 0.5))]
    inside = [(rng.uniform(-0.2, 0.2), 0.1, rng.uniform(0.3, 0.5)) for _ in range(8)]
    heavy = [least(carrying(design, 300.0, at), box, joint) for at in corners + inside]
    light = [least(carrying(design, rng.uniform(0, 300), at), box, joint) for at in inside]
    assert min(*heavy, *light) >= found.lower
    assert found.upper <= min(heavy) * (1 + 1e-12)
    assert found.upper == pytest.approx(float(fx.stability_index(found.adverse, found.pose, joint=joint)), rel=1e-9)
    if design.legs.stiffness_law is None:
        assert exact_modes(found.adverse, found.pose, joint == "universal").omega[0] > found.lower
    assert checking.check_certificate(path).proved
    again = fx.certify(design, box, joint=joint, uncertain=LOAD, gap=0.02, path=path, resume=True)
    assert file.text_of(again) == file.text_of(found)
    above = fx.certify(design, box, joint=joint, uncertain=LOAD, at_least=found.upper * (1 + 1e-6))
    assert above.status == "refuted"
    other = fx.optimisation.Payload((0, 301), LOAD.position)
    with pytest.raises(OutputError, match="uncertain places differ"):
        fx.certify(design, box, joint=joint, uncertain=other, gap=0.02, path=path, resume=True)


def test_ball_arithmetic_proves_the_same():
    exact_bounds = pytest.importorskip("tests.oracles.exact_bounds", reason="python-flint is not installed")
    box = about_home(BASE, 0.001, 0.1)
    ends = [(-0.01, 0.01), (0.1, 0.1), (0.3, 0.31)]
    found = fx.certify(BASE, box, gap=0.05, uncertain=fx.optimisation.Payload((0, 200), ends))
    assert found.proved
    given = np.stack([box.low, box.high], axis=-1)
    assert exact_bounds.proved(BASE, given, found.lower, most=20, load=(200.0, ends)) is not None
    assert exact_bounds.proved(BASE, given, found.upper * 1.001, most=5, load=(200.0, ends)) is None


def test_a_payload_and_places_stray_together_in_any_order():
    places = uncertain(0.001, "base.joints[0]", "platform.mass_center")
    first = fx.certify(BASE, SMALL, uncertain=[LOAD, *places], gap=0.03)
    last = fx.certify(BASE, SMALL, uncertain=[*places, LOAD], gap=0.03)
    assert first.proved
    assert first.lower == pytest.approx(last.lower, rel=1e-12)
    rng = np.random.default_rng(9)
    for _ in range(15):
        center = BASE.platform_mass_center + rng.choice([-1, 1], 3) * 0.001
        joints = BASE.base_joints.copy()
        joints[0] += rng.choice([-1, 1], 3) * 0.001
        design = BASE.replace({"platform.mass_center": center, "base.joints": joints})
        at = (rng.choice([-0.2, 0.2]), 0.1, rng.choice([0.3, 0.5]))
        assert least(carrying(design, 300.0, at), SMALL, samples=300) >= first.lower


def test_a_fixed_payload_beside_places_and_masses():
    load = fx.optimisation.Payload((0, 200), (0.1, 0.0, 0.3))
    alone = fx.certify(BASE, SMALL, uncertain=load)
    assert alone.payload == ()
    assert alone.lower == pytest.approx(fx.certify(carrying(BASE, 200.0, (0.1, 0.0, 0.3)), SMALL).lower, rel=1e-12)
    mass = fx.Uncertain("platform.mass", 0.1)
    orders = [fx.certify(BASE, SMALL, uncertain=given) for given in ([load, mass], [mass, load])]
    assert orders[0].lower == orders[1].lower
    heavier = BASE.replace({"platform.mass": 1.1 * BASE.platform_mass})
    assert orders[0].hexapod.platform_mass == pytest.approx(1.1 * BASE.platform_mass + 200)
    assert least(carrying(heavier, 200.0, (0.1, 0.0, 0.3)), SMALL) >= orders[0].lower
    beside = fx.certify(BASE, SMALL, uncertain=[load, *uncertain(0.001, "platform.mass_center")])
    assert beside.payload == (200.0, 0.1, 0.0, 0.3)
    moved = BASE.replace({"platform.mass_center": BASE.platform_mass_center + np.array([0.001, -0.001, 0.001])})
    assert least(carrying(moved, 200.0, (0.1, 0.0, 0.3)), SMALL) >= beside.lower


def test_two_payloads_beside_places_are_refused():
    fixed = fx.optimisation.Payload((0, 20))
    assert fx.certify(BASE, HOME, uncertain=[fixed, fixed]).proved
    with pytest.raises(fx.ArgumentError, match="2 payloads"):
        fx.certify(BASE, SMALL, uncertain=[LOAD, fixed])
