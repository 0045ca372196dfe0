"""Arguments that are one of a few words: any other word is refused, never taken for the last of them."""

import inspect
import re
from dataclasses import replace

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.helpers.public import PUBLIC

import flexapod as fx
from flexapod.errors import FlexapodError

MACHINE = plain_machine("motion-base")
LINEAR = fx.linearise(MACHINE)
EMPTY = (np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), np.eye(6))
STIFFNESS = fx.Variable("legs.stiffness", 1e5, 1e7)
#: A call with a word that is none: the right one with a capital letter, as a slip of the hand makes it.
WRONG = {
    ("Controller", "measures"): lambda: fx.control.closed_loop(
        MACHINE, controller=fx.control.Controller(*EMPTY, measures=("Leg_length",), name="wrong")
    ),
    ("Excitation", "rotation"): lambda: replace(fx.harmonic("roll", 1e-3, 1.0), rotation="RPY").motion([0.0, 0.1]),
    ("JointAngle", "joint"): lambda: fx.optimise(
        MACHINE, [STIFFNESS], constraints=[fx.optimisation.JointAngle("Universal")], trials=1
    ),
    ("JointCircle", "plate"): lambda: fx.optimisation.JointCircle("Base", radius=(1, 2)).parts(MACHINE),
    ("JointCircle", "axes"): lambda: fx.optimisation.JointCircle("base", radius=(1, 2), axes="Keep").parts(MACHINE),
    ("PID", "space"): lambda: fx.control.PID(1.0, space="Joint"),
    ("PID", "actuator"): lambda: fx.control.PID(1.0, actuator="Force"),
    ("PathRequirements", "joint"): lambda: fx.plan_path(
        MACHINE, MACHINE.home, MACHINE.home, fx.PathRequirements(1.0, joint="Universal")
    ),
    ("Uncertain", "distribution"): lambda: fx.Uncertain("legs.stiffness", 0.1, "Uniform").parameters(MACHINE),
    ("Variable", "kind"): lambda: fx.Variable("legs.stiffness", 1, 2, kind="Set").parts(MACHINE),
    ("closed_loop", "unstable"): lambda: fx.control.closed_loop(MACHINE, unstable="Keep"),
    ("flat_spectrum", "quantity"): lambda: fx.excitation.flat_spectrum(1.0, 1.0, 2.0, quantity="Acceleration"),
    ("gain_schedule", "feedback"): lambda: fx.control.gain_schedule(MACHINE, feedback="Force"),
    ("ground_noise", "model"): lambda: fx.excitation.ground_noise("High"),
    ("h_infinity", "measure"): lambda: fx.control.h_infinity(MACHINE, measure="Acceleration"),
    ("lqg", "measure"): lambda: fx.control.lqg(MACHINE, measure="Acceleration"),
    ("open_zeros", "feedback"): lambda: fx.control.open_zeros(LINEAR, "Force", (1, 2)),
    ("optimise", "sampler"): lambda: fx.optimise(MACHINE, [STIFFNESS], trials=1, sampler="TPE"),
    ("controlled_random_response", "of"): lambda: fx.control.controlled_random_response(
        MACHINE,
        controller=fx.control.VelocityFeedback(1.0),
        psd=[1.0, 1.0],
        omega=[1.0, 2.0],
        axis="z",
        of="Acceleration",
    ),
    ("random_response", "of"): lambda: fx.random_response(
        MACHINE, psd=np.ones(2), omega=[1.0, 2.0], axis="z", of="Acceleration", loss_factor=0.01
    ),
    ("root_locus", "feedback"): lambda: fx.control.root_locus(MACHINE, feedback="Force"),
    ("sine_sweep", "law"): lambda: fx.excitation.sine_sweep("z", 1e-3, 1.0, 2.0, 1.0, law="Log"),
    ("sine_sweep", "hold"): lambda: fx.excitation.sine_sweep("z", 1e-3, 1.0, 2.0, 1.0, hold="Displacement"),
}
#: Made by the library only, from words that it has checked.
INNER = {
    ("Requirement", "quantity"),
    ("Spectrum", "quantity"),
    ("Spectrum", "unit"),
    ("UncertainParameter", "distribution"),
}
WORDS = re.compile(r"Literal\[|\b(Feedback|Space|Actuator|Measurement|Quantity|Distribution|Kind|ConstraintQuantity)\b")


def arguments_of_words():
    """Every argument of the public functions and classes whose type is a few words; joint models have a test of theirs."""
    for name, called in PUBLIC.items():
        if inspect.isfunction(called) or (inspect.isclass(called) and not issubclass(called, Exception)):
            for argument in inspect.signature(called).parameters.values():
                if WORDS.search(str(argument.annotation)) and "JointModel" not in str(argument.annotation):
                    yield name, argument.name


def test_every_argument_of_words_is_here():
    assert set(arguments_of_words()) <= set(WRONG) | INNER


@pytest.mark.parametrize("call", WRONG, ids=".".join)
def test_another_word_is_refused(call):
    with pytest.raises(FlexapodError, match=r"must be|one of|one or several of"):
        WRONG[call]()


def test_every_joint_model_is_checked():
    """Wherever a joint model is an argument of a function of a machine and a pose."""
    for called in PUBLIC.values():
        if not inspect.isfunction(called):
            continue
        parameters = inspect.signature(called).parameters
        if {"hexapod", "pose", "joint"} <= parameters.keys():
            needed = [p for p in parameters.values() if p.default is p.empty and p.name not in ("hexapod", "pose")]
            if not needed:
                with pytest.raises(fx.ArgumentError, match="joint is 'Universal'"):
                    called(MACHINE, joint="Universal")
