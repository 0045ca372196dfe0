"""`flexapod certify` as it is used: exit codes, JSON, files, checks, and what cannot be asked."""

import json
import os
import re
import signal
import threading
import time

import numpy as np
import pytest
from tests.helpers.plain import file

import flexapod as fx
from flexapod.certificates.file import write_certificate
from flexapod.cli.output.interrupt import Stopping

SMALL = ("--around", "0.05", "2")
HARD = ("mukherjee-ii", "--around", "0.02", "12")


@pytest.fixture(autouse=True)
def there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_bound_that_is_proved(run, there):
    code, out, _ = run("certify", "motion-base", *SMALL, "--at-least", "4Hz")
    assert code == 0
    assert "The index is at least 25.1327 rad/s (4 Hz) at every pose of the box: proved." in out
    assert {path.name for path in there.iterdir()} == {"motion-base-certificate.html", "motion-base-certificate.json"}
    kept = fx.certificates.read_certificate(there / "motion-base-certificate.json")
    assert kept.lower == pytest.approx(8 * np.pi)
    code, out, _ = run("certify", "--check", "motion-base-certificate.json")
    assert code == 0
    assert "checked by other boxes" in out


def test_a_proof_is_not_lost_to_a_weaker_one(run, there):
    proof, earlier = there / "motion-base-certificate.json", there / "motion-base-certificate-earlier.json"
    for bound in (24, 25):  # the second covers the first, and takes its place
        code, out, _ = run("certify", "motion-base", *SMALL, "--at-least", bound)
        assert (code, "earlier proof" in out) == (0, False)
    best = proof.read_text()
    code, out, _ = run("certify", "motion-base", *SMALL, "--at-least", 20)
    assert "The earlier proof is kept as motion-base-certificate-earlier.json" in " ".join(out.split())
    assert earlier.read_text() == best
    code, out, _ = run("certify", "motion-base", *SMALL, "--at-least", "5Hz")  # refuted: the one at 20 stays beside
    assert code == 1
    assert fx.certificates.read_certificate(there / "motion-base-certificate-earlier2.json").lower == 20
    run("certify", "motion-base", *SMALL, "--at-least", 25)
    kept = proof.read_text()
    code, _, err = run("certify", "motion-base", *SMALL, "--condition", -1)  # nothing is computed: nothing is moved
    assert code == 2, err
    assert proof.read_text() == kept
    code, out, _ = run("certify", "motion-base", "--around", "0.02", "1", "--at-least", 25)  # of another region
    assert "earlier proof" in out


def test_a_bound_that_a_pose_breaks_and_one_that_is_not_decided(run):
    code, out, _ = run("certify", "motion-base", *SMALL, "--at-least", "5Hz", "--json")
    found = json.loads(out)
    assert (code, found["status"]) == (1, "refuted")
    assert found["upper_rad_s"] < 10 * np.pi
    assert fx.stability_index(fx.load("motion-base"), found["pose_m_rad"]) == pytest.approx(found["upper_rad_s"])
    assert found["files"] == []
    code, out, _ = run("certify", *HARD, "--at-least", 300, "--time-limit", "300ms", "--json")
    found = json.loads(out)
    assert (code, found["status"]) == (3, "undecided")
    assert found["parts_left"] > 0
    assert 0 < found["share_left"] <= 1
    assert found["warnings"]


def test_the_closest_bound_as_the_library_has_it(result):
    found = result("certify", "motion-base", *SMALL, "--gap", "2%", "--joint", "spin_free")
    box = fx.Box.about(fx.home_pose(fx.load("motion-base")), 0.05, np.radians(2))
    own = fx.certify(fx.load("motion-base"), box, gap=0.02, joint="spin_free")
    assert found["lower_rad_s"] == pytest.approx(own.lower)
    assert found["gap"] == pytest.approx(0.02)
    assert found["joint"] == "spin_free"
    assert np.allclose(found["region"], own.place.parts)


def test_other_claims(result, run):
    assert result("certify", "motion-base", *SMALL, "--regular")["claim"] == "regular"
    assert result("certify", "motion-base", *SMALL, "--limits")["status"] == "proved"
    found = result("certify", "motion-base", *SMALL, "--condition", 5)
    assert found["lower"] < found["upper"] == 5
    code, out, _ = run("certify", "motion-base", "--box", "z=2.4:3.2", "--limits", "--json")
    assert code == 1
    assert json.loads(out)["broken"].startswith("length of leg")


def test_uncertain_machines_and_payloads(result):
    plain = result("certify", "motion-base", *SMALL)
    given = ("--uncertain", "legs.stiffness_law.bulk_modulus=10%", "--payload", "0:200", "--payload-at", 0, 0, "0.8")
    found = result("certify", "motion-base", *SMALL, *given)
    assert found["lower_rad_s"] < 0.95 * plain["lower_rad_s"]
    assert found["nominal_digest"] == plain["digest"] != found["digest"]
    assert found["uncertain"] == [
        "legs.stiffness_law.bulk_modulus +-10 % (uniform)",
        "a payload of 0 to 200 kg at (0, 0, 0.8) m",
    ]


def test_places_that_stray_are_proved_and_checked(result, run, there):
    plain = result("certify", "motion-base", *SMALL)
    found = result("certify", "motion-base", *SMALL, "--uncertain", "base.joints_mm=1", "--out", "proof")
    assert found["status"] == "proved"
    assert 0.98 * plain["upper_rad_s"] < found["upper_rad_s"] < plain["upper_rad_s"]
    assert found["uncertain"] == ["base.joints_mm +-1 mm (uniform)"]
    assert found["digest"] == plain["digest"]
    kept = there / "proof" / "motion-base-certificate.json"
    assert run("certify", "--check", kept)[0] == 0
    assert "coordinates stray" in (there / "proof" / "motion-base-certificate.html").read_text()
    assert (
        result("certify", "motion-base", *SMALL, "--regular", "--uncertain", "base.joints_mm=1")["status"] == "proved"
    )


def test_the_largest_box(result):
    found = result("certify", file("motion-base"), *SMALL, "--at-least", 27, "--largest")
    assert found["status"] == "proved"
    assert 1 < found["scale"] < found["refuted_scale"] <= 1.02 * found["scale"]


def test_a_path_from_a_file(result, there):
    (there / "way.csv").write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,2.4,0,0,0\n1,0.1,0,2.5,0,5,10\n")
    found = result("certify", "motion-base", "--path", "way.csv", "--at-least", 20)
    assert found["status"] == "proved"
    assert found["path_s"] == 1
    assert found["region"] is None
    path = result("path", "motion-base", "way.csv", "--bound", 20, "--certify")
    assert path["certificate"]["status"] == "proved"
    planned = result("path", "mukherjee-i", "--from", *["0", "0", "0.89", "0", "0", "0"], "--to", *["0.1", "0", "0.89", "0", "0", "0"],
                     "--bound", 90, "--certify")  # fmt: skip
    assert planned["certificate"]["lower_rad_s"] == 90


def test_an_optimised_design_is_proved_on_request(run):
    given = ("optimise", "mukherjee-ii", "--vary", "platform.mass=2:5", "--trials", 0, "--points", 64,
             "--verify", 256, "--around", "0.005", "1")  # fmt: skip
    found = json.loads(run(*given, "--certify", "--json")[1])
    proof = found["certificate"]
    assert proof["status"] == "proved"
    assert proof["lower_rad_s"] == pytest.approx(0.99 * proof["upper_rad_s"])
    assert proof["digest"] == found["digest"]
    assert found["index_rad_s"] <= proof["upper_rad_s"] * (1 + 1e-9)
    code, out, _ = run(*given, "--certify", "--out", "better")
    assert code == 0
    assert re.search(r"Index, proved at least [\d.]+ rad/s, to 1\.00 % of what is found", out)
    assert json.loads(run(*given, "--json")[1])["certificate"] is None
    assert run(*given, "--against", "mass", "--certify")[0] == 2


def test_the_page_says_what_is_proved_and_how_to_check_it(run, there):
    assert (
        run(
            "certify",
            "motion-base",
            *SMALL,
            "--gap",
            "1%",
            "--uncertain",
            "legs.stiffness_law.bulk_modulus=5%",
            "--out",
            "proof",
        )[0]
        == 0
    )
    page = (there / "proof" / "motion-base-certificate.html").read_text()
    kept = fx.certificates.read_certificate(there / "proof" / "motion-base-certificate.json")
    for words in (
        kept.hexapod.digest,
        kept.nominal,
        f"{kept.lower:.6g}",
        "What it does not cover",
        "flexapod certify --check motion-base-certificate.json",
        "2.34 to 2.44",
        "legs.stiffness_law.bulk_modulus +-5 %",
        "exact universal joints",
    ):
        assert words in page, words
    assert "<script" not in page


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "give a DESIGN to certify, or --check FILE"),
        (("motion-base", "--at-least", "0Hz"), "> 0"),
        (("motion-base", "--at-least", "4", "--gap", "1%"), "Give one of them"),
        (("motion-base", "--gap", "1%", "--regular"), "each make a claim"),
        (("motion-base", "--gap", "150%"), "is no share"),
        (("motion-base", "--gap", "nan"), "is no share"),
        (("motion-base", "--at-least", "4mm"), "unit of frequency"),
        (("motion-base", "--largest", *SMALL), "Give --at-least"),
        (("motion-base", "--largest", "--at-least", "4"), "needs a shape"),
        (("motion-base", "--limits", "--within-limits"), "true of every machine"),
        (("motion-base", "--regular", "--payload", "0:5"), "depend on geometry alone"),
        (("motion-base", "--limits", "--uncertain", "legs.stiffness_law.bulk_modulus=5%"), "places of joints alone"),
        (("motion-base", "--box", "z=2.5:2.4"), "the least comes first"),
        (("motion-base", "--uncertain", "base.universal_axes[0][0]=0.01", *SMALL), "neither rises nor falls"),
        (("motion-base", "--resume", "--json"), "Give --out DIR"),
        (("motion-base", "--check", "nothing.json"), "does not exist"),
        (("mukherjee-ii", "--within-limits", "--around", "0.01", "1"), "has no limits"),
    ],
)
def test_what_cannot_be_asked_is_told(arguments, words, run):
    code, _, err = run("certify", *arguments)
    assert code == 2
    assert words in err


def test_a_certificate_of_another_design_or_a_changed_one_is_told(run, there):
    machine = fx.load("motion-base")
    path = write_certificate(fx.certify(machine, at_least=20.0), there / "proof.json")
    assert run("certify", "motion-base", "--check", path)[0] == 0
    code, _, err = run("certify", "mukherjee-i", "--check", path)
    assert code == 2
    assert "It proves nothing of that one" in err
    path.write_text(path.read_text().replace('"wanted": 20.0', '"wanted": 30.0'))
    code, _, err = run("certify", "--check", path)
    assert code == 2
    assert "was changed since it was written" in err


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_an_interrupt_keeps_what_is_proved_and_resume_goes_on(run, there):
    def interrupt():
        while not isinstance(getattr(signal.getsignal(signal.SIGINT), "__self__", None), Stopping):
            time.sleep(0.01)  # it has not begun
        time.sleep(0.5)
        os.kill(os.getpid(), signal.SIGINT)

    other = threading.Thread(target=interrupt, daemon=True)
    other.start()
    code, out, err = run("certify", *HARD, "--at-least", 300, "--out", "kept")
    other.join()
    assert code == 130, err
    assert "undecided" in out
    kept = fx.certificates.read_certificate(there / "kept" / "mukherjee-ii-certificate.json")
    assert kept.status == "undecided"
    code, out, _ = run("certify", *HARD, "--at-least", 300, "--out", "kept", "--resume", "--time-limit", "500ms")
    assert code in (0, 3)
    again = fx.certificates.read_certificate(there / "kept" / "mukherjee-ii-certificate.json")
    assert again.boxes >= kept.boxes
    code, _, err = run("certify", *HARD, "--at-least", 301, "--out", "kept", "--resume")
    assert code == 2
    assert "another question" in err
