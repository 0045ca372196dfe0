"""Pages on paper: numbered, with a running title, no heading alone at the foot, and no page for a footer only."""

import re
import subprocess
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from pypdf import PdfReader
from tests.helpers.everything import machine_with_everything
from tests.web.browser import CHROMIUM, FLAGS

import flexapod as fx
from flexapod.optimisation import Payload
from flexapod.paper import Settings, draw
from flexapod.report import gather, paper_page
from flexapod.report import page as whole
from flexapod.report.studies import machine, robustness

if CHROMIUM is None:
    pytest.skip("chromium is not installed", allow_module_level=True)

HOME_RUN = ["control", "cubic-isolator", "lqg", "--shake", "0.01", "--duration", "2"]
PLANNED = [
    "path",
    "mukherjee-i",
    "--from",
    "0",
    "0",
    "0.89",
    "0",
    "-33",
    "-10",
    "--to",
    "0",
    "0",
    "0.89",
    "0",
    "45",
    "53",
    "--bound",
    "110",
]


def _report(name, **changes):
    h = fx.load(name).replace(changes) if changes else fx.load(name)
    return whole(machine.study(gather(h, fx.home_pose(h))))


def _robust():
    h = fx.load("motion-base")
    strays = [
        fx.Uncertain("legs.stiffness_law.bulk_modulus", 0.15),
        Payload((0, 500), ((-0.5, 0.5), (-0.5, 0.5), (0.5, 1.5))),
    ]
    return whole(robustness.study(h, fx.robustness(h, strays, samples=64, sensitivity=16), "home"))


def _command(run, tmp_path, arguments):
    code, _, err = run(*arguments, "--out", tmp_path)
    assert code == 0, err
    return next(tmp_path.glob("*.html")).read_text(encoding="utf-8")


def _paper():
    names = ("figure-2", "figure-3", "natural-frequencies", "corrections")
    return paper_page.page([draw(name, Settings(200, 0, "spin_free")) for name in names])


MADE = {
    "report": lambda run, folder: _report("cubic-isolator"),
    "report of another": lambda run, folder: _report("mukherjee-ii"),
    "report, unstable": lambda run, folder: _report("cubic-isolator", **{"platform.mass": 200.0}),
    "robust": lambda run, folder: _robust(),
    "control": lambda run, folder: _command(run, folder, HOME_RUN),
    "path": lambda run, folder: _command(run, folder, PLANNED),
    "paper": lambda run, folder: _paper(),
}


def printed(html, folder):
    """Rows of text of each page, from above: (height in px from below, words)."""
    (folder / "page.html").write_text(html, encoding="utf-8")
    address, file = (folder / "page.html").as_uri(), folder / "page.pdf"
    order = [CHROMIUM, "--headless", *FLAGS, "--no-pdf-header-footer", f"--print-to-pdf={file}", address]
    subprocess.run(order, check=True, capture_output=True, timeout=120)
    pages = []
    for page in PdfReader(file).pages:
        rows: dict[int, str] = {}

        def take(text, cm, tm, font, size, rows=rows):
            if text.strip():
                place = np.array([tm[4], tm[5], 1]) @ np.array([[cm[0], cm[1]], [cm[2], cm[3]], [cm[4], cm[5]]])
                rows[round(place[1])] = rows.get(round(place[1]), "") + text

        page.extract_text(visitor_text=take)
        pages.append([(height, " ".join(rows[height].split())) for height in sorted(rows, reverse=True)])
    return pages


def test_on_a_phone_wide_tables_scroll_in_their_place_and_show_it(tmp_path):
    """The page itself is no wider than the screen; a table that is casts a shadow at its edge."""
    told = """<script>
    const wide = [...document.querySelectorAll(".scroll")].filter(one => one.scrollWidth > one.clientWidth)
    const shaded = wide.filter(one => getComputedStyle(one).backgroundAttachment.includes("local"))
    document.title = [document.documentElement.scrollWidth <= innerWidth, wide.length, shaded.length].join()
    </script>"""
    (tmp_path / "page.html").write_text(_report("cubic-isolator").replace("</body>", told + "</body>"))
    order = [CHROMIUM, "--headless", *FLAGS, "--window-size=500,900", "--dump-dom", (tmp_path / "page.html").as_uri()]
    found = subprocess.run(order, check=True, capture_output=True, text=True, timeout=120).stdout
    fits, wide, shaded = re.search("<title>(.*)</title>", found)[1].split(",")
    assert fits == "true"
    assert int(wide) == int(shaded) > 1


@pytest.mark.parametrize("name", MADE)
def test_it_prints_well(name, run, tmp_path):
    html = MADE[name](run, tmp_path)
    pages = printed(html, tmp_path)
    title = re.search("<title>(.*)</title>", html)[1]
    headings = {_plain(words) for words in re.findall(r"<(?:h2|h3|caption)[^>]*>(.*?)</(?:h2|h3|caption)>", html)}
    assert len(headings) > 2
    for number, rows in enumerate(pages, 1):
        *above, (_, last) = rows
        assert re.sub(r"\s", "", last) == f"{number}/{len(pages)}"
        body = [words for _, words in above if words != title] if number > 1 else [words for _, words in above]
        assert len(body) < len(above) or number == 1, "no running title"
        assert _plain(body[-1]) not in headings, f"page {number} ends with a heading"
        assert len([words for words in body if "Flexapod 0." not in words and "digest" not in words]) > 1


def _plain(words):
    """Letters of a heading, without tags, ligatures and blanks."""
    words = re.sub("<.*?>", "", words).replace("\ufb01", "fi").replace("\ufb02", "fl")
    return re.sub(r"\W", "", words)


FULL = {
    "report": lambda run, folder, design: _report(design),
    "path": lambda run, folder, design: _command(
        run, folder, ["path", design, "way.csv", "--from-home", "--payload", "2", "0", "0", "0.1", "--point", "vertex"]
    ),
    "envelope": lambda run, folder, design: _command(run, folder, ["envelope", design]),
}


@pytest.mark.parametrize("kind", FULL)
def test_no_table_makes_the_words_of_a_page_smaller_on_paper(kind, run, tmp_path, monkeypatch):
    """A browser shrinks all of a page to the width of its widest table; the machine with everything has the widest."""
    monkeypatch.chdir(tmp_path)
    machine_with_everything().save("full.toml")
    Path("way.csv").write_text("t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0.0003,0,0,0,0.1,0\n")
    html = FULL[kind](run, tmp_path / "made", "full.toml")
    printed(html, tmp_path)
    sizes: Counter[float] = Counter()

    def take(text, cm, tm, font, size):
        sizes[round(abs(size * tm[3] * cm[3]), 1)] += len(text.strip())

    for page in PdfReader(tmp_path / "page.pdf").pages:
        page.extract_text(visitor_text=take)
    assert min(size for size, letters in sizes.items() if letters > 300) >= 8.0
    assert sizes.most_common(1)[0][0] in (8.0, 9.0, 9.5)
