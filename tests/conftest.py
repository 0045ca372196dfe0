"""What all tests share: how examples are drawn, and the command line in this process."""

import json

import pytest
from hypothesis import HealthCheck, settings

from flexapod.cli import main

# Hypothesis draws the same examples in every run, so that a failure is never a matter of luck.
settings.register_profile(
    "flexapod", derandomize=True, deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("flexapod")


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
