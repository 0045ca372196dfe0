"""Corners of control: loops that are not well posed, designs that cannot be made."""

import numpy as np
import pytest
import slycot
from tests.helpers.plain import plain_machine

import control
import flexapod as fx
from flexapod.control import isolation
from flexapod.control.h_infinity_synthesis import suboptimal_controller
from flexapod.control.plant import Controller, Plant
from flexapod.mechanics.linearisation import linearise


@pytest.fixture(scope="module")
def isolator():
    hexapod = plain_machine("cubic-isolator")
    return hexapod, fx.home_pose(hexapod)


def test_a_loop_of_gain_one_through_itself_is_not_well_posed(isolator):
    hexapod, pose = isolator
    plant = Plant(linearise(hexapod, pose))
    D = np.linalg.inv(plant.D[plant.measured(("acceleration",))])
    none = np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0))
    law = Controller(*none, D, ("acceleration",), "acceleration feedback")
    with pytest.raises(fx.errors.UnstableError, match="the loop of acceleration feedback is not well posed"):
        fx.control.closed_loop(hexapod, pose, law)


def test_a_schedule_says_where_there_is_no_gain(isolator):
    hexapod, pose = isolator
    here = np.concatenate([pose.position, pose.rpy])[None]
    gains = np.geomspace(1.0, 10.0, 4)
    small = fx.control.gain_schedule(hexapod, here, "velocity", gains=gains, damping=0.9)
    assert small.status.values.tolist() == ["no_gain"]
    assert np.isnan(small.gain.values).all()
    easy = fx.control.gain_schedule(hexapod, here, "velocity", gains=gains, damping=1e-6)
    assert easy.gain.values.tolist() == [1.0]  # the first is more than enough
    assert easy.least_damping.values[0] > 1e-6
    met = hexapod.base_joints[0] - hexapod.platform_joints[0]  # leg 1 has no length
    mixed = fx.control.gain_schedule(hexapod, np.concatenate([here, [[*met, 0, 0, 0]]]), "velocity", gains=gains)
    assert mixed.status.values.tolist() == ["ok", "no_rest"]


class Routine:
    """SLICOT's routine as seen from outside: it finds controllers above a least gamma, but for some by chance."""

    def __init__(self, least, fails=lambda gamma: False, most_calls=np.inf):
        self.least, self.fails, self.calls, self.most_calls = least, fails, 0, most_calls

    def __call__(self, *given, **options):
        gamma, self.calls = given[5], self.calls + 1
        if gamma < self.least or self.fails(gamma) or self.calls > self.most_calls:
            raise slycot.exceptions.SlycotError("no", 6)
        return (None, *(np.full((1, 1), gamma),) * 4)


SYSTEM = (np.zeros((2, 2)),) * 4


@pytest.mark.parametrize("least", [0.003, 0.7, 40.0])
def test_gamma_is_a_fifth_above_the_least_wherever_that_is(least, monkeypatch):
    monkeypatch.setattr(slycot, "sb10ad", Routine(least))
    gamma, matrices = suboptimal_controller(SYSTEM, 6)
    assert 1.2 * least <= gamma <= 1.2 * 1.01 * least
    assert matrices[0] == gamma


def test_a_gamma_at_which_the_routine_fails_is_passed_by(monkeypatch):
    monkeypatch.setattr(slycot, "sb10ad", Routine(0.7, fails=lambda gamma: 0.8 < gamma < 0.9))
    gamma, _ = suboptimal_controller(SYSTEM, 6)
    assert gamma == pytest.approx(0.7 * 1.1, rel=0.02)


def test_designs_that_cannot_be_made_are_told(isolator, monkeypatch):
    with monkeypatch.context() as patched:
        patched.setattr(slycot, "sb10ad", Routine(np.inf))
        with pytest.raises(fx.errors.UnstableError, match="no H-infinity controller was found"):
            fx.control.h_infinity(*isolator)
    with monkeypatch.context() as patched:
        patched.setattr(slycot, "sb10ad", Routine(0.7, most_calls=10))  # the bisection takes ten
        with pytest.raises(
            fx.errors.UnstableError, match=r"too badly conditioned\. Raise effort and noise, or lower the depth"
        ):
            suboptimal_controller(SYSTEM, 6)
    with monkeypatch.context() as patched:
        patched.setattr(isolation, "is_stable", lambda *given: False)
        with pytest.raises(fx.errors.UnstableError, match=r"too badly conditioned to be used\. Raise effort and noise"):
            fx.control.h_infinity(*isolator)

    def failing(*given):
        raise np.linalg.LinAlgError("no finite solution")

    monkeypatch.setattr(control, "care", failing)
    with pytest.raises(
        fx.errors.UnstableError, match="no optimal controller exists for these weights: no finite solution"
    ):
        fx.control.lqg(*isolator)
