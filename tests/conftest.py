"""What all tests share: how examples are drawn, the command line in this process, and what was measured."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings
from tests.helpers.claims import FILE, Ledger, committed

from flexapod.cli import main

# Hypothesis draws the same examples in every run, so that a failure is never a matter of luck.
settings.register_profile(
    "flexapod", derandomize=True, deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("flexapod")


@pytest.fixture(autouse=True)
def figures_closed():
    """Pyplot keeps the figures that a test has drawn; the next one begins without."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture
def run(capsys):
    """Run the command line in this process: exit code, standard output, standard error."""

    def call(*arguments):
        code = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


@pytest.fixture
def result(run):
    """The JSON that a command prints."""

    def call(*arguments):
        code, out, err = run(*arguments, "--json")
        assert (code, err) == (0, "")
        return json.loads(out)

    return call


# --- what was measured ------------------------------------------------------------------------------------------------

LEDGER = pytest.StashKey[Ledger]()


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 2 MiB. Only the superuser of a machine that allows it can make one."""
    path = tmp_path / "disk"
    path.mkdir()
    made = shutil.which("mount") and subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", path], capture_output=True, check=False
    )
    if not made or made.returncode:
        pytest.skip("a small file system cannot be mounted here")
    yield path
    subprocess.run(["umount", path], check=True)


def pytest_addoption(parser):
    parser.addoption(
        "--record-validation",
        metavar="FILE",
        type=Path,
        help="run the tests that measure the claims of the validation page, and write what they found",
    )


def pytest_configure(config):
    recording = config.getoption("--record-validation") is not None
    unwritten = recording or not FILE.exists()  # a source distribution has no docs/
    config.stash[LEDGER] = Ledger(None if unwritten else committed())


#: Files of tests that take longest, the longest first: begun last, one of them would keep a single core busy at the end.
LONG = (
    "docs/test_documents",
    "web/test_page",
    "web/test_looks",
    "web/test_questions",
    "web/test_links",
    "web/test_notebook_view",
    "web/test_fields",
    "paper/test_paper",
    "report/test_print",
    "core/test_new_number",
    "web/test_doors",
    "attack/test_full_disk",
    "plots/test_print",
    "attack/test_command_lines",
    "cli/test_start",
    "web/test_away",
    "attack/test_kills",
    "optimisation/test_stored_study",
    "certificates/test_certify_strays",
    "workspace/test_sweep_springs",
    "workspace/test_envelope",
    "cli/test_certify_command",
    "report/test_progress",
    "cli/test_optimise_commands",
    "attack/test_api",
    "cli/test_path_and_control_commands",
    "workspace/test_slurm_scripts",
    "web/test_laws",
    "docs/test_notebooks",
    "cli/test_sweep_command",
    "docs/test_examples",
    "web/test_load",
    "core/test_certify",
    "project/test_docstrings",
)
PLACES = {f"tests/{name}.py": place for place, name in enumerate(LONG)}


def pytest_collection_modifyitems(config, items):
    items.sort(key=lambda item: PLACES.get(item.nodeid.partition("::")[0], len(LONG)))
    if config.getoption("--record-validation") is not None:
        measuring = [item for item in items if "measured" in getattr(item, "fixturenames", ())]
        config.hook.pytest_deselected(items=[item for item in items if item not in measuring])
        items[:] = measuring


def pytest_sessionfinish(session, exitstatus):
    path = session.config.getoption("--record-validation")
    if path is not None and exitstatus == 0:
        try:
            session.config.stash[LEDGER].write(path)
        except ValueError as error:
            pytest.exit(str(error), returncode=1)


@pytest.fixture(scope="session")
def measured(request):
    """`measured(key, found, bound)`: assert a deviation and take it down for the validation page (claims.py)."""
    return request.config.stash[LEDGER]
