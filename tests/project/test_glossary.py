"""One name for each thing: the arguments of public functions and classes are words of the glossary."""

import inspect
import re
from pathlib import Path

import pytest
from tests.helpers.public import CLASSES, FUNCTIONS, PUBLIC

GLOSSARY = Path(__file__).parents[2] / "docs" / "glossary.md"
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in GLOSSARY.read_text(encoding="utf-8").splitlines()
    if line.startswith("| `")
]
WORDS = {word for row in ROWS for word in re.findall(r"`(\w+)`", row[0])}
REPLACED = {word.strip(): row[0] for row in ROWS for word in row[3].split(",") if word.strip()}

#: Arguments of single functions, which need no word of their own.
SINGLE = {
    *("x", "y", "z", "roll", "pitch", "yaw"),
    *(
        "box",
        "result",
        "model",
        "lengths",
        "characteristic_length",
        "directions",
        "elevation",
        "gravity",
        "base_roll",
        "magnitude",
        "reference",
        "at",
        "axes",
        "index",
        "proportions",
        "section",
        "gap",
        "name",
        "name_or_path",
    ),  # mechanics, design
    *(
        "omega_min",
        "omega_max",
        "omega_start",
        "omega_end",
        "law",
        "hold",
        "phase",
        "peak",
        "acceleration",
        "recovery",
        "change",
    ),
    *("coefficients", "values", "recorded", "rms", "quantity", "spectrum", "response", "height", "period", "gamma"),
    *("waypoints", "at_least", "sweep", "starts", "address", "timeout", "timestep", "hardware", "after", "runs"),
    *(
        "method",
        "rtol",
        "atol",
        "max_step",
        "max_steps",
        "stop_at_singular",
        "detrend",
        "highpass",
        "energies",
        "reactions",
        "tolerance",
        "of",
    ),
    *("gains", "leak", "legs", "linear", "measure", "effort", "noise", "corner", "depth", "bandwidth", "stroke"),
    *("kp", "kd", "nearness", "unstable", "bound", "singular", "goal", "timing", "plan", "study", "against", "refine"),
    *("number", "dataset", "window", "frames", "exaggeration", "sensitivity", "sampler", "verify", "on_trial", "stop"),
    "pose_samples",
    *("at_most", "within_limits", "time_limit", "cluster", "resume", "certified", "certify"),
    "loss_frequency",
    *(
        "length",
        "radius",
        "thickness",
        "width",
        "diameter",
        "material",
        "first",
        "second",
        "at_base",
        "at_platform",
    ),  # flexures
}


def arguments(name):
    """The arguments of a function; of a class that a user makes, those of its constructor."""
    return [p.name for p in inspect.signature(PUBLIC[name]).parameters.values() if p.kind is not p.VAR_KEYWORD]


def test_the_glossary_is_a_list_of_different_words():
    words = [word for row in ROWS for word in re.findall(r"`(\w+)`", row[0])]
    assert len(words) == len(set(words))
    assert 40 <= len(words) <= 80
    assert not set(words) & set(REPLACED)
    assert all(len(row) == 4 and row[1] for row in ROWS)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_arguments_are_words_of_the_glossary(name):
    unknown = set(arguments(name)) - WORDS - SINGLE
    told = {word: f"use {REPLACED[word]}" for word in unknown if word in REPLACED}
    assert not unknown, f"{name}: {told or unknown}; rename the argument, or add its word to docs/glossary.md"


def test_single_words_are_used():
    used = {argument for name in FUNCTIONS for argument in arguments(name)}
    assert not SINGLE - used


MADE = [name for name in CLASSES if not issubclass(PUBLIC[name], BaseException | tuple)]
MADE.remove("Verification")  # a result whose field keeps its name: points


#: Parameters of classes that are named by a word that is replaced elsewhere, where it means another thing.
OWN_WORDS = {"Hexapod": {"points"}}  # places by name, not how many poses


@pytest.mark.parametrize("name", MADE)
def test_classes_use_no_replaced_word(name):
    assert set(inspect.signature(PUBLIC[name]).parameters) & set(REPLACED) == OWN_WORDS.get(name, set())
