"""Packages that load their names when first used, and errors for wrong names that say the right ones.

Words of common speech, American spellings and names of other packages are known; others are compared by their letters.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any, NoReturn, TypeVar

import lazy_loader

TOP = "flexapod"

_MODES = "natural_modes (its omega in rad/s, frequency in Hz, and shape)"
_RESPONSE = "transmissibility (of base motion), or linearise (its state_space)"
_KINEMATICS = "inverse_kinematics or forward_kinematics"
_DYNAMICS = "forward_dynamics, inverse_dynamics or equations_of_motion"

#: Words that people try, and the names that do it; each answer begins with a public name.
WORDS = {
    **dict.fromkeys(("modes", "modal", "modal_analysis", "eigenmodes", "mode_shapes", "eigen", "eigenvalues"), _MODES),
    **dict.fromkeys(("natural_frequencies", "natural_frequency", "eigenfrequencies", "resonances"), _MODES),
    **dict.fromkeys(("frequencies", "modal_frequencies"), _MODES),
    "lowest_frequency": "stability_index",
    "mass_matrix": "equations_of_motion (its J_p), or linearise (its M)",
    "inertia_matrix": "equations_of_motion (its J_p), or linearise (its M)",
    "stiffness_matrix": "linearise (its K)",
    "stiffness": "linearise (its K)",
    "damping_matrix": "linearise (its C)",
    "damping": "linearise (its modes().damping_ratio)",
    "damping_ratio": "linearise (its modes().damping_ratio)",
    "damped_modes": "linearise (its modes())",
    "state_space": "linearise (its state_space())",
    "jacobian": "force_transformation (H; its transpose maps the platform's twist to leg rates)",
    "inverse_jacobian": "force_transformation (H; its transpose maps the platform's twist to leg rates)",
    **dict.fromkeys(("frf", "FRF", "frequency_response", "transfer_function", "bode", "compliance"), _RESPONSE),
    **dict.fromkeys(("response", "harmonic_response"), _RESPONSE),
    **dict.fromkeys(("random", "random_vibration", "psd", "PSD", "rms"), "random_response (and vc_curve for spectra)"),
    "spectrum": "vc_curve, or excitation.Spectrum",
    **dict.fromkeys(("sine", "sin", "sinusoid", "sine_wave"), "harmonic"),
    **dict.fromkeys(("chirp", "sweep_sine", "swept_sine"), "sine_sweep"),
    **dict.fromkeys(("shock", "pulse", "half_sine"), "half_sine_shock"),
    **dict.fromkeys(("integrate", "solve", "run", "time_simulation", "transient"), "simulate"),
    **dict.fromkeys(("Path", "path"), "Trajectory (waypoints with times); path_index analyses one"),
    **dict.fromkeys(("StewartPlatform", "Stewart", "Platform", "Machine", "Design"), "Hexapod"),
    **dict.fromkeys(("read", "open", "load_design", "read_design", "from_toml"), "load"),
    **dict.fromkeys(("designs", "machines", "list_designs"), "packaged_designs"),
    **dict.fromkeys(("plot_mode", "plot_modes"), "plots.mode (or plots.machine)"),
    **dict.fromkeys(("show", "draw"), "plot (the figure of any result)"),
    "animate": "animate_mode or animate_simulation",
    **dict.fromkeys(("equilibrium", "statics", "sag"), "static_equilibrium, or hold for a given pose"),
    **dict.fromkeys(("leg_forces", "leg_force"), "hold (at rest) or inverse_dynamics"),
    **dict.fromkeys(("leg_lengths", "leg_length", "ik"), "inverse_kinematics"),
    "fk": "forward_kinematics",
    **dict.fromkeys(("assemblies", "assembly_modes", "all_poses"), "forward_kinematics_all"),
    "kinematics": _KINEMATICS,
    "dynamics": _DYNAMICS,
    "reactions": "joint_reactions",
    "singularity": "condition_number",
    "conditioning": "condition_number",
    "dexterity": "condition_number",
    "limits": "check_limits",
    **dict.fromkeys(("monte_carlo", "tolerances", "uncertainty"), "robustness"),
    "sensitivity": "frequency_sensitivity",
    "pareto": "pareto_front",
    **dict.fromkeys(("optimization", "optimizer", "minimize", "minimise"), "optimise"),
    **dict.fromkeys(("linearization", "linear", "tangent"), "linearise"),
    **dict.fromkeys(("lqr", "LQR", "LQG"), "control.lqg"),
    "pid": "control.PID",
    **dict.fromkeys(("export", "to_mujoco", "mujoco"), "interchange.write_mjcf (also write_sdf, write_urdf)"),
}


def attach(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """`__getattr__`, `__dir__` and `__all__` of a package whose names its stub lists."""
    load, names, public = lazy_loader.attach_stub(package, file)

    def __getattr__(name: str) -> Any:
        if name in public or name.startswith("_"):
            return load(name)
        raise AttributeError(_of_package(package, name, public), name=name)

    return __getattr__, names, public


def _of_package(package: str, name: str, public: Iterable[str]) -> str:
    if _is_module(f"{package}.{name}"):
        return f"{package}.{name} is a module that is not loaded; write import {package}.{name}"
    known = british(name)
    if package != TOP and known in public:
        found = [known]
    else:
        found = [one if package == TOP else f"{TOP}.{one}" for one in _at_top(name, known)]
    return f"{package} has no {name}{did_you_mean(found or _near(known, public))}"


def _at_top(name: str, known: str) -> list[str]:
    """What a word stands for, as it is reached from the top: a known word, or a name but for capitals."""
    if name in WORDS:
        return [WORDS[name]]
    found = _reached()
    if known in found:
        return [found[known]]
    return [call for one, call in found.items() if one.lower() == known.lower()]


@cache
def _reached() -> dict[str, str]:
    """Every public name, and how it is reached from the top; found once, since `hasattr` comes here too."""
    top = importlib.import_module(TOP)
    found = {one: one for one in top.__all__}
    for place in top.__all__:
        if _is_module(f"{TOP}.{place}"):  # a package
            package = importlib.import_module(f"{TOP}.{place}")
            names = getattr(package, "__all__", ())
            modules = [one for one in names if place != "plots" and _is_module(f"{TOP}.{place}.{one}")]
            inside = {one: f"{place}.{module}.{one}" for module in modules for one in _own(getattr(package, module))}
            found = inside | {one: f"{place}.{one}" for one in names} | found
    return found


def _own(module: Any) -> list[str]:
    """The names that a module defines for its users."""
    own = ((one, getattr(thing, "__module__", "")) for one, thing in vars(module).items())
    return [one for one, place in own if place == module.__name__ and not one.startswith("_")]


def british(name: str) -> str:
    """A name in the spelling that Flexapod uses."""
    import re

    return re.sub(r"(?<=\w{4})iz(?=[ea])", "is", name).replace("yze", "yse").replace("centre", "center")


def _near(word: str, known: Iterable[str]) -> list[str]:
    from difflib import get_close_matches  # needed for errors only

    return get_close_matches(word, list(known), n=2, cutoff=0.7)


def _is_module(name: str) -> bool:
    from importlib.util import find_spec

    return find_spec(name) is not None


def did_you_mean(found: Iterable[str]) -> str:
    """The end of a message: the names that may be meant."""
    found = list(dict.fromkeys(found))
    return f"; did you mean {' or '.join(found)}?" if found else ""


Class = TypeVar("Class", bound=type)


def suggests(words: Mapping[str, str]) -> Callable[[Class], Class]:
    """A class whose objects answer a wrong attribute with the right one; `words` as in `WORDS`."""

    def decorated(cls: Class) -> Class:
        def __getattr__(self: Any, name: str) -> NoReturn:
            raise AttributeError(_of_class(cls, name, words), name=name, obj=self)

        setattr(cls, "__getattr__", __getattr__)  # noqa: B010  # set like this, type checkers still know wrong attributes
        setattr(cls, "_words", words)  # noqa: B010
        return cls

    return decorated


class Suggesting(type):
    """Metaclass of classes that answer a wrong name on the class itself, such as `Hexapod.load`."""


def _class_getattr(cls: type, name: str) -> NoReturn:
    raise AttributeError(_of_class(cls, name, cls.__dict__.get("_words", {})), name=name, obj=cls)


Suggesting.__getattr__ = _class_getattr  # type: ignore[attr-defined]


def _of_class(cls: type, name: str, words: Mapping[str, str]) -> str:
    start = f"{cls.__name__} has no {name}"
    if name.startswith("_"):
        return start
    if name in words:
        return start + did_you_mean([words[name]])
    own = [one for one in {*dir(cls), *getattr(cls, "__dataclass_fields__", ())} if not one.startswith("_")]
    near = _near(british(name), own)
    if not near and cls.__name__ == "Hexapod":  # perhaps a function of one
        of_top = british(name) in importlib.import_module(TOP).__all__
        near = [f"{TOP}.{british(name)}(hexapod, ...)"] if of_top else [f"{TOP}.{WORDS[name]}"] if name in WORDS else []
    return start + did_you_mean(near)
