"""Every option that counts something says itself what is too much."""

import click
import pytest

from flexapod.cli import COMMANDS, group
from flexapod.cli.options.sweep import MOST_POINTS
from flexapod.workspace import pose_sets


def counting():
    for name in COMMANDS:
        command = group.get_command(click.Context(group), name)
        for parameter in command.params:
            if isinstance(parameter.type, click.types.IntParamType):
                yield pytest.param(name, parameter, id=f"{name} {parameter.opts[0]}")


@pytest.mark.parametrize(("name", "option"), list(counting()))
def test_a_number_that_is_too_large_is_told_by_its_option(name, option):
    context = click.Context(group.get_command(click.Context(group), name))
    for digits in ("9" * 40, "9" * 400):
        with pytest.raises(click.BadParameter) as caught:
            option.type_cast_value(context, digits)
        assert caught.value.param is option


def test_the_most_points_are_those_of_a_set_of_poses():
    assert MOST_POINTS == pose_sets.MOST
