"""Certificates in files: without loss, checked by other boxes, changed by hand, gone on with after a kill, shared out."""

import json
import os
import signal
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.helpers.waiting import until

import flexapod as fx
from flexapod import _core
from flexapod.certificates import checking, file, largest_file, proving
from flexapod.certificates.certificate import Certificate
from flexapod.workspace import proof
from flexapod.workspace.store.integrity import sealed

BASE, II = plain_machine("motion-base"), fx.load("mukherjee-ii")
SMALL = fx.Box.about(fx.home_pose(BASE), 0.05, np.radians(2))
PATH = fx.Trajectory([[0, 0, 2.4, 0, 0, 0], [0.1, 0, 2.5, 0, 0.1, 0.2]], [0, 1])
HOME_OF_II = fx.home_pose(II).position
HARD = fx.Box.about(fx.home_pose(II), 0.02, np.radians(12))


def same(one: Certificate, other: Certificate) -> bool:
    """Whether two certificates are the same in all that files keep."""
    return file.text_of(one) == file.text_of(other)


@pytest.mark.parametrize("region", [SMALL, [SMALL, SMALL], PATH], ids=["box", "boxes", "path"])
def test_a_file_keeps_everything(region, tmp_path):
    found = fx.certify(BASE, region, uncertain=fx.Uncertain("legs.stiffness", 0.1), path=tmp_path / "proof.json")
    read = fx.certificates.read_certificate(tmp_path / "proof.json")
    assert same(found, read)
    assert read.hexapod == found.hexapod
    assert np.array_equal(read.place.parts, found.place.parts)
    checked = fx.certificates.check_certificate(tmp_path / "proof.json")
    assert checked.status == "proved"
    assert checked.lower == found.lower
    assert checked.wanted == found.lower


def test_every_claim_is_checked_anew(tmp_path):
    for number, found in enumerate(
        (
            fx.certify(BASE, SMALL, joint="spin_free"),
            fx.certify(BASE, SMALL, at_least=40.0),
            fx.certify_regular(BASE, SMALL),
            fx.certify_limits(BASE, SMALL),
            fx.certify_limits(BASE, fx.Box(z=(2.4, 3.2))),
            fx.certify_condition_number(BASE, SMALL),
            fx.certify_condition_number(BASE, SMALL, at_most=2.0),
        )
    ):
        path = file.write_certificate(found, tmp_path / f"{number}.json")
        checked = fx.certificates.check_certificate(path)
        assert checked.status == found.status
        assert checked.claim == found.claim
        assert same(fx.certificates.read_certificate(path), found)


def test_a_check_cuts_the_boxes_elsewhere():
    box = np.stack([HARD.low, HARD.high], axis=-1)[None]
    ends = []
    for cut in (proof.CUT, checking.CUT):
        options = _core.CertificateOptions()
        options.max_boxes, options.cut = 40, cut
        left = _core.certify(II.packed, _core.Joint.universal, box, _core.CertificateKind.index, 300.0, options, None)
        ends.append(left.remaining)
    inner = [set(np.unique(parts)) - set(np.unique(box)) for parts in ends]
    assert inner[0]
    assert inner[1]
    assert not inner[0] & inner[1]


@pytest.mark.parametrize("key", ["lower", "upper", "pose", "region", "design", "status", "level", "wanted"])
def test_what_was_changed_is_told(key, tmp_path):
    path = tmp_path / "proof.json"
    fx.certify(BASE, SMALL, path=path)
    data = json.loads(path.read_text())
    data[key] = {"lower": 27.5, "upper": 99.0, "pose": [0.0] * 6, "region": {"boxes": [[[0, 1]] * 6]}, "design": {},
                 "status": "refuted", "level": 1.0, "wanted": 3.0}[key]  # fmt: skip
    path.write_text(json.dumps(data))
    with pytest.raises(fx.errors.OutputError, match="was changed since it was written"):
        fx.certificates.check_certificate(path)


def test_a_lie_with_a_right_sum_is_not_proved(tmp_path):
    path = tmp_path / "proof.json"
    found = fx.certify(BASE, SMALL, path=path)
    for change, error in (
        ({"lower": found.upper * 1.001}, None),
        ({"upper": 99.0}, "has 27"),
        ({"pose": [0.0, 0, 9, 0, 0, 0]}, "not in its region"),
        ({"status": "refuted"}, "does not break the claim"),
        ({"status": "refuted", "pose": None}, "names none"),
    ):
        path.write_text(json.dumps(sealed({**json.loads(file.text_of(found)), **change})))
        if error is None:
            assert fx.certificates.check_certificate(path).status == "refuted"
        else:
            with pytest.raises(fx.ArgumentError, match=error):
                fx.certificates.check_certificate(path)


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("", "no JSON"),
        ("[]", "its format is not"),
        ('{"format": "flexapod certificate", "version": 9}', "of version 9"),
        (json.dumps(sealed({"format": file.FORMAT, "version": 1})), "cannot be understood"),
        (
            json.dumps(sealed({"format": file.FORMAT, "version": 1, "design": {"toml": "a", "digest": ""}})),
            "understood",
        ),
    ],
)
def test_what_is_no_certificate_is_told(text, match, tmp_path):
    (tmp_path / "some.json").write_text(text)
    with pytest.raises(fx.errors.OutputError, match=match):
        fx.certificates.read_certificate(tmp_path / "some.json")


def test_other_numbers_of_a_region_or_a_design_are_told(tmp_path):
    data = json.loads(file.text_of(fx.certify(BASE, SMALL)))
    boxes = data["region"]["boxes"]
    for change in (
        {"region": {"boxes": [[pair[::-1] for pair in boxes[0]]]}},
        {"region": {"boxes": boxes[0]}},
        {"design": {**data["design"], "digest": "0" * 16}},
        {"claim": "stiff"},
    ):
        (tmp_path / "odd.json").write_text(json.dumps(sealed({**data, **change})))
        with pytest.raises(fx.errors.OutputError, match="cannot be understood"):
            fx.certificates.read_certificate(tmp_path / "odd.json")


def test_an_undecided_one_is_gone_on_with(tmp_path):
    path = tmp_path / "proof.json"
    first = fx.certify(II, HARD, at_least=300.0, time_limit=0.5, path=path)
    assert first.status == "undecided"
    again = fx.certify(II, HARD, at_least=300.0, time_limit=0.5, path=path, resume=True)
    assert again.boxes >= first.boxes
    assert again.share_left <= first.share_left
    with pytest.raises(fx.errors.OutputError, match="another question: its bound differ"):
        fx.certify(II, HARD, at_least=310.0, path=path, resume=True)
    with pytest.raises(fx.errors.OutputError, match="another question: its design and region differ"):
        fx.certify(BASE, SMALL, at_least=300.0, path=path, resume=True)
    with pytest.raises(fx.ArgumentError, match="nothing to check"):
        fx.certificates.check_certificate(path)
    done = fx.certify(BASE, SMALL, path=tmp_path / "done.json")
    assert same(fx.certify(BASE, SMALL, path=tmp_path / "done.json", resume=True), done)


def test_the_parts_left_and_the_parts_proved_are_the_region():
    found = fx.certify(II, HARD, at_least=300.0, time_limit=1.0)
    assert found.status == "undecided"
    volume = (found.left[:, :, 1] - found.left[:, :, 0]).prod(axis=1).sum()
    assert volume / (HARD.high - HARD.low).prod() == pytest.approx(found.share_left, rel=1e-6)
    assert (found.left[:, :, 0] >= HARD.low).all()
    assert (found.left[:, :, 1] <= HARD.high).all()


KILLED = """
import sys, time, numpy as np, flexapod as fx
from flexapod.certificates import proving
proving.KEEP = 0.0
machine = fx.load("mukherjee-ii")
box = fx.Box.about(fx.home_pose(machine), 0.02, np.radians(12))
fx.certify(machine, box, at_least=300.0, path=sys.argv[1])
"""


@pytest.mark.skipif(os.name != "posix", reason="kill")
def test_what_a_kill_leaves_is_whole(tmp_path):
    path = tmp_path / "proof.json"
    run = subprocess.Popen([sys.executable, "-c", KILLED, str(path)])
    try:
        until(lambda: path.exists() or run.poll() is not None, 120)
        assert path.exists()
    finally:
        run.send_signal(signal.SIGKILL)
        run.wait()
    left = fx.certificates.read_certificate(path)
    assert left.status in ("undecided", "proved", "refuted")
    again = fx.certify(II, HARD, at_least=300.0, time_limit=0.2, path=path, resume=True)
    assert again.boxes >= left.boxes
    assert [one.name for one in tmp_path.iterdir()] == ["proof.json"]


def test_a_wide_rung_is_not_taken_for_the_last():
    """Parts that are left of a wide gap say nothing about the wanted one: all parts are taken again."""
    found = fx.certify(BASE, SMALL)
    wide = replace(found, status="undecided", level=0.5 * found.upper, left=found.place.parts[:0], share_left=0.2)
    assert len(proving._gone_on(wide, None, 0.01).left) == 0
    close = replace(wide, level=found.lower, left=found.place.parts)
    assert len(proving._gone_on(close, None, 0.01).left) == 1


def test_turns_of_shares_are_put_together():
    place = proof.Boxes(np.stack([SMALL.low, SMALL.high], axis=-1)[None])
    parts = place.split(place.parts, 8)
    assert len(parts) == 8
    assert place.volume(parts) == pytest.approx(place.volume(place.parts))
    prover = proof.Prover(BASE, "universal", "index", place)
    shares = [parts[:5], parts[5:]]
    turns = [prover.turn(share, 25.0, 0.0, 60.0, None) for share in shares]
    both = proof.together(prover, turns, shares)
    assert both.status == "proved"
    assert both.proved == pytest.approx(1)
    lost = proof.together(prover, [turns[0], None], shares)
    assert lost.status == "undecided"
    assert np.array_equal(lost.left, shares[1])
    assert lost.proved == pytest.approx(5 / 8)
    assert len(proof.together(prover, [None, None], shares).left) == 8
    broken = proof.together(prover, [turns[0], prover.turn(shares[1], 40.0, 0.0, 60.0, None)], shares)
    assert broken.status == "refuted"


def test_a_cluster_shares_the_boxes():
    pytest.importorskip("distributed")
    box = fx.Box.about(fx.home_pose(BASE), 0.12, np.radians(5))
    with fx.workspace.cluster("local") as workers:
        found = fx.certify(BASE, box, cluster=workers)
    assert found.proved
    assert found.lower == pytest.approx(fx.certify(BASE, box).lower, rel=1e-9)


def test_a_search_for_the_largest_box_is_gone_on_with(tmp_path):
    shape, path, told = fx.Workspace.about_home(0.05, 0.05), tmp_path / "largest.json", []

    def proved_once() -> bool:
        return path.exists() and json.loads(path.read_text())["found"] is not None

    stopped = fx.certified_box(BASE, shape, 26.0, tolerance=0.02, path=path, stop=proved_once)
    assert [one.name for one in tmp_path.iterdir()] == ["largest.json"]
    done = fx.certified_box(BASE, shape, 26.0, tolerance=0.02, path=path, resume=True, progress=told.append)
    whole = fx.certified_box(BASE, shape, 26.0, tolerance=0.02)
    assert stopped.scale <= done.scale
    assert (done.scale, done.refuted) == (whole.scale, whole.refuted)
    assert same(replace(done.certificate, seconds=0.0), replace(whole.certificate, seconds=0.0))
    with pytest.raises(fx.errors.OutputError, match="its bound differ"):
        fx.certified_box(BASE, shape, 25.0, tolerance=0.02, path=path, resume=True)
    with pytest.raises(fx.ArgumentError, match="no path is given"):
        fx.certified_box(BASE, shape, 26.0, resume=True)
    with pytest.raises(fx.errors.OutputError, match="its format is not"):
        fx.certificates.read_certificate(path)
    path.write_text(path.read_text().replace('"low": ', '"low": 1'))
    with pytest.raises(fx.errors.OutputError, match="was changed"):
        fx.certified_box(BASE, shape, 26.0, tolerance=0.02, path=path, resume=True)


def test_the_box_in_hand_is_gone_on_with(tmp_path, monkeypatch):
    """A search that is stopped inside of a proof: the next one begins with the parts that were left."""
    monkeypatch.setattr(proving, "KEEP", 0.5)
    shape, path = fx.Workspace.about_home(0.02, np.radians(12)), tmp_path / "largest.json"
    with pytest.raises(fx.ArgumentError, match="no box of this shape was proved"):
        fx.certified_box(II, shape, 250.0, path=path, stop=lambda: largest_file.in_hand(path).exists())
    left = fx.certificates.read_certificate(largest_file.in_hand(path))
    assert left.status == "undecided"
    assert json.loads(path.read_text())["scale"] == pytest.approx((left.region[0].high[0] - HOME_OF_II[0]) / 0.02)
