"""What the documents show works: every block of the README, the tutorial and the guides is run as it stands there."""

import re
from pathlib import Path

import pytest
from tests.helpers.documents import blocks, matches, run_document

ROOT = Path(__file__).parents[2]
GUIDES = [path for path in sorted((ROOT / "docs").rglob("*.md")) if "```" in path.read_text(encoding="utf-8")]

OUTSIDE = [
    str(path.relative_to(ROOT)) for folder in (".", "benchmarks", "examples") for path in ROOT.glob(f"{folder}/*.md")
]


@pytest.fixture
def there(tmp_path, monkeypatch):
    """An empty folder to be in, and a terminal of 80 columns."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path


def test_what_the_readme_shows_works(there, run):
    run_document(ROOT / "README.md", there, run)
    assert (there / "my-machine.html").exists()
    assert (there / "reports" / "my-machine.html").exists()


@pytest.mark.parametrize("path", GUIDES, ids=lambda path: path.stem)
def test_what_a_guide_shows_works(path, there, run):
    run_document(path, there, run)


@pytest.mark.parametrize("path", OUTSIDE)
def test_links_from_outside_the_site_lead_to_files(path):
    """Those within docs/ are checked by `make docs`."""
    text = (ROOT / path).read_text(encoding="utf-8")
    for target in re.findall(r"\]\((?!https?:|#)([^)#\s]+)", text):
        assert ((ROOT / path).parent / target).exists(), f"{path} links to {target}"


EXAMPLE = """\
<!-- test: append to a.toml -->
```toml title="a.toml"
mass = 1
```

   ```python
   n = 1000
   ```

<!-- test: skip, it takes a day -->
```sh
flexapod serve
```
"""


def test_blocks_are_found_with_what_they_are():
    toml, python, sh = blocks(EXAMPLE)
    assert toml == ("toml", "a.toml", "mass = 1\n", "append to a.toml", 3)
    assert (python.language, python.text, python.how) == ("python", "n = 1000\n", "")
    assert sh.how == "skip, it takes a day"


WRONG = {
    "another output": '```python\nprint(1)\n```\n\n```text title="output"\n2\n```\n',
    "a command that fails": "```sh\nflexapod modes nowhere\n```\n",
    "a command that prints something else": "```console\n$ flexapod designs\nnone\n```\n",
    "an error that is none": "```console\n$ flexapod designs\nError: no\n```\n",
    "code that raises": "```python\nassert False\n```\n",
    "an edit of what is not there": '<!-- test: instead of b = 1 in a.toml -->\n```toml title="a.toml"\nb = 2\n```\n',
    "a number that is not shown": "<!-- test: 10 as 1 -->\n```python\nn = 2\n```\n",
}


@pytest.mark.parametrize("case", WRONG)
def test_a_document_that_is_wrong_is_found_out(case, there, run):
    (there / "a.toml").write_text("a = 1\n")
    (there / "a.md").write_text(WRONG[case])
    with pytest.raises(AssertionError):
        run_document(there / "a.md", there, run)


def test_files_and_edits_are_written(there, run):
    parts = [
        '```toml title="a.toml"\na = 1\n```',
        '<!-- test: append to a.toml -->\n```toml title="a.toml, at its end"\nb = 2\n```',
        '<!-- test: instead of a = 1 in a.toml -->\n```toml title="a.toml"\na = 3\n```',
    ]
    (there / "a.md").write_text("\n\n".join(parts) + "\n")
    assert run_document(there / "a.md", there, run) == 3
    assert (there / "a.toml").read_text() == "a = 3\nb = 2\n"


def test_outputs_match_however_their_lines_are_broken():
    assert matches("a  b\nc", "a b c\n")
    assert matches("a ... c", "a b b c")
    assert matches("a\n...\nc", "a c")
    assert matches("a\n...", "a b")
    assert matches("in ... s; at 1", "in 2 s; at 1")
    assert not matches("a ... c", "a b")
    assert not matches("a", "a b")
    assert not matches("1.0", "100")
