"""Responses that assume small motions about rest say whether the machine, or its loop, stays there."""

import dataclasses

import numpy as np
import pytest
import scipy.linalg
from tests.helpers.plain import file, plain_machine

import flexapod as fx
from flexapod.control.closed_loop_poles import assess, loop_sampling_time
from flexapod.control.losses import assumptions
from flexapod.control.plant import Plant

ISOLATOR = plain_machine("cubic-isolator")
TOPPLES = ISOLATOR.replace({"platform.mass": 4000.0})
LAW = fx.control.VelocityFeedback(300.0)


def made(name, hexapod):
    """What each function that assumes stability gives."""
    calls = {
        "transmissibility": lambda: fx.transmissibility(hexapod, omega=[5.0]),
        "stepped_sine": lambda: fx.stepped_sine(hexapod, omega=[5.0], amplitude=1e-9, axis="z"),
        "root_locus": lambda: fx.control.root_locus(hexapod, feedback="velocity", gains=[10.0, 20.0]),
    }
    return calls[name]()


@pytest.mark.parametrize("name", ["transmissibility", "stepped_sine", "root_locus"])
def test_a_toppling_machine_is_no_machine_that_vibrates(name):
    stable, topples = made(name, ISOLATOR).attrs, made(name, TOPPLES).attrs
    assert (stable["stability"], stable["caution"]) == ("stable", "")
    assert topples["stability"] == "falls over"
    assert "no motion of the machine approaches it" in topples["caution"]


def test_random_vibration_of_a_toppling_machine_is_refused():
    for loss in (0.0, 0.05):  # with a loss factor a pole that grows has its decaying brother above the real axis
        with pytest.raises(fx.ArgumentError, match="not stable at rest"):
            fx.random_response(TOPPLES, psd=fx.vc_curve("VC-C"), axis="z", loss_factor=loss)


def test_an_unstable_loop_is_told_apart_from_its_machine():
    linear = fx.linearise(ISOLATOR)
    slow = fx.control.VelocityFeedback(1e3).on(linear).sampled(0.05)
    found = fx.control.controlled_transmissibility(ISOLATOR, controller=slow, omega=[5.0]).attrs
    assert (found["stability"], found["passive_stability"]) == ("unstable", "stable")
    assert "No motion approaches the response with control: the machine is unstable" in found["caution"]
    good = fx.control.controlled_transmissibility(ISOLATOR, controller=LAW, omega=[5.0]).attrs
    assert (good["stability"], good["passive_stability"], good["caution"]) == ("stable", "stable", "")
    held = fx.control.PID(kp=2e6, kd=4e4)  # holds what falls over by itself
    found = fx.control.controlled_transmissibility(TOPPLES, controller=held, omega=[5.0]).attrs
    assert (found["stability"], found["passive_stability"]) == ("stable", "falls over")
    assert found["caution"].startswith("Without control: Not stable at rest")


def test_the_command_and_the_page_say_it(run, result):
    heavy = ("--set", "platform.mass=4000")
    out = " ".join(run("response", file("cubic-isolator"), *heavy)[1].split())
    assert "Not stable at rest: 6 modes of the machine grow" in out
    requests = pytest.importorskip("flexapod.web.response")
    told = requests.response(
        {"design": TOPPLES.to_toml(), "pose": [*TOPPLES.home.position, 0, 0, 0], "quantity": "absolute"}
    )
    assert told["caution"].startswith("Not stable at rest")
    assert not told["modes"]  # those that grow have no frequency


def test_modes_that_grow_alike_are_counted_each_however_they_are_rounded():
    linear = fx.linearise(TOPPLES)
    squares, shapes = scipy.linalg.eigh(linear.K, linear.M)
    assert squares[0] == pytest.approx(squares[1])
    a, b = linear.M @ shapes[:, :2].T[0], linear.M @ shapes[:, :2].T[1]
    for parted in (-1e-15, 1e-15):  # a pair of equal poles leaves the real axis
        turned = dataclasses.replace(linear, K=linear.K + parted * squares[0] * (np.outer(a, b) - np.outer(b, a)))
        modes = turned.modes()
        assert not modes.pole.imag.any()
        assert (modes.pole.real > 0).all()
        assert np.linalg.matrix_rank(modes.shape) == 6


def test_control_says_what_its_model_leaves_out(run):
    out = " ".join(run("control", file("cubic-isolator"), "velocity", "--gain", 300)[1].split())
    assert assumptions(ISOLATOR) in out
    assert fx.control.root_locus(ISOLATOR, gains=[1.0, 2.0]).attrs["assumptions"] == assumptions(ISOLATOR)


def test_the_sampling_time_follows_a_loop_that_is_faster_than_the_machine():
    """Forces hold the platform, and hardly any spring: the machine alone would do with half a second."""
    soft = ISOLATOR.replace({"legs.stiffness": 1.0, "legs.damping": None})
    plant = Plant(fx.linearise(soft))
    law = fx.control.PID(kp=2e5, kd=4.5e3, ki=1e4).on(plant.linear)
    alone = fx.control.sampling_time(soft)
    advised = loop_sampling_time(plant, law, alone)
    assert advised < 0.01 * alone
    assert not assess(plant, law.sampled(alone)).stable
    ideal, sampled = assess(plant, law), assess(plant, law.sampled(advised))
    assert sampled.stable
    assert sampled.worst_damping > 0.2 * ideal.worst_damping
    assert loop_sampling_time(plant, law, alone, delay=20) < advised  # what comes late has to be sampled faster


def test_the_machine_decides_where_its_loop_is_slower():
    plant = Plant(fx.linearise(ISOLATOR))
    assert loop_sampling_time(plant, LAW.on(plant.linear), 1e-3) == 1e-3


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((file("motion-base"), "velocity", "--pose", 0, 0, 1e-12, 0, 0, 0), "move away from a singular pose"),
        ((file("precision-positioner"), "lqg", "--measure", "leg_length", "--noise", 1e-6), "raise noise or effort"),
    ],
)
def test_what_cannot_be_designed_is_a_sentence(run, arguments, words):
    code, _, err = run("control", *arguments)
    assert (code, words in " ".join(err.split())) == (2, True), err


def test_a_delay_is_bounded():
    law = LAW.on(fx.linearise(ISOLATOR))
    assert law.sampled(1e-3, delay=100).order == 600
    with pytest.raises(fx.ArgumentError, match=r"delay is 1000 samples; each adds six states.*at most 116"):
        law.sampled(1e-3, delay=1000)


@pytest.mark.parametrize("gain", [1e200, 1e308])
def test_gains_beyond_all_bounds_are_refused(gain):
    with pytest.raises(fx.ArgumentError, match="beyond all bounds"):
        fx.control.closed_loop(ISOLATOR.replace({"platform.mass": 1e-3}), controller=fx.control.PID(kd=1e308, ki=gain))


def test_figures_say_it_in_their_titles():
    topples = fx.transmissibility(TOPPLES, omega=[1.0, 5.0, 20.0])
    figure = fx.plots.response.frequency_response(topples, "absolute", "z")
    assert "(falls over: no motion approaches this)" in figure.get_suptitle()
    slow = fx.control.VelocityFeedback(1e3).on(fx.linearise(ISOLATOR)).sampled(0.05)
    for law, words in ((slow, "(unstable: no motion approaches this)"), (LAW, "")):
        found = fx.control.controlled_transmissibility(ISOLATOR, controller=law, omega=[1.0, 5.0, 20.0])
        title = fx.plots.control.isolation(found).get_suptitle()
        assert title.endswith(words)
        assert bool(words) == ("unstable" in title)
