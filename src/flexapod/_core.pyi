# What the compiled core offers, by position only. design: Hexapod.packed; platform, base, start: rows of 24 numbers.
from collections.abc import Callable
from enum import Enum, Flag
from typing import Any

from numpy import float64, int64
from numpy.typing import NDArray

_A = NDArray[float64]

class Field:
    """A named value in the numbers of a design or a motion; of each leg where `stride` > 0."""

    @property
    def name(self, /) -> str: ...
    @property
    def offset(self, /) -> int: ...
    @property
    def stride(self, /) -> int: ...
    @property
    def shape(self, /) -> tuple[int, ...]: ...
    @property
    def unit(self, /) -> str: ...
    @property
    def index(self, /) -> NDArray[int64]: ...

DESIGN_LAYOUT: tuple[Field, ...]
MOTION_LAYOUT: tuple[Field, ...]
design_size: int
motion_size: int

class Joint(Enum):
    universal = 0
    spin_free = 1

class Measure(Enum):
    leg_length = 0
    leg_rate = 1
    leg_force = 2
    position = 3
    velocity = 4
    acceleration = 5

class Outcome(Enum):
    complete = 0
    singular = 1
    leg_collapsed = 2
    joint_locked = 3
    step_collapse = 4
    not_finite = 5
    max_steps = 6
    stopped = 7

class Rest(Enum):
    found = 0
    singular = 1
    not_found = 2

class SweepQuantity(Flag):
    omega_1 = 1
    omega = 2
    cond_H = 4
    leg_length = 8
    leg_distance = 16
    leg_force = 32
    lowest_stiffness = 64
    joint_angle = 128
    within_limits = 256
    omega_1_gradient = 512

class SweepStatus(Enum):
    ok = 0
    singular = 1
    no_leg = 2
    not_finite = 3
    no_inertia = 4

class TermKind(Enum):
    sinusoids = 0
    chirp = 1
    pieces = 2

def leg_rates(design: _A, platform: _A, base: _A, /) -> tuple[_A, _A, _A]: ...
def leg_fit(design: _A, platform: _A, base: _A, /) -> tuple[_A, _A]: ...
def joint_angles(design: _A, platform: _A, base: _A, neutral: _A, /) -> tuple[_A, _A, _A, _A]: ...
def leg_distance(design: _A, platform: _A, base: _A, /) -> _A: ...
def forward_kinematics(design: _A, lengths: _A, start: _A, /) -> tuple[_A, _A]: ...
def force_transformation(design: _A, platform: _A, base: _A, /) -> _A: ...
def spring_matrix(design: _A, platform: _A, base: _A, /) -> _A: ...

SPRING_LEGS: tuple[int, ...]

def equations_of_motion(design: _A, joint: Joint, platform: _A, base: _A, /) -> tuple[_A, _A, _A, _A]: ...
def forward_dynamics(design: _A, joint: Joint, platform: _A, base: _A, leg_force: _A, wrench: _A, /) -> _A: ...
def inverse_dynamics(design: _A, joint: Joint, platform: _A, base: _A, wrench: _A, /) -> _A: ...
def joint_reactions(
    design: _A, joint: Joint, platform: _A, base: _A, leg_force: _A, section: float, /
) -> tuple[_A, _A]: ...
def energy(design: _A, joint: Joint, platform: _A, base: _A, unstretched: _A, /) -> _A: ...
def natural_modes(design: _A, joint: Joint, platform: _A, base: _A, /) -> tuple[_A, _A]: ...
def inertia_parts(design: _A, joint: Joint, platform: _A, base: _A, /) -> tuple[_A, _A]: ...
def frequency_derivatives(design: _A, joint: Joint, platform: _A, base: _A, /) -> tuple[_A, _A]: ...
def tangent(design: _A, joint: Joint, platform: _A, base: _A, wrench: _A, unstretched: _A, /) -> tuple[_A, ...]: ...
def settle(design: _A, joint: Joint, start: _A, base: _A, wrench: _A, unstretched: _A, /) -> tuple[_A, Rest]: ...

setup_size: int

def simulate(
    designs: _A,
    joint: Joint,
    setups: _A,
    excitations: list[_A],
    times: _A,
    options: _A,
    progress: Callable[[float], object] | None,
    /,
) -> tuple[_A, _A, _A, _A, _A, _A, _A, _A, _A, _A]: ...
def control_loop(
    design: _A,
    joint: Joint,
    setup: _A,
    base: _A,
    controller: list[_A],
    noise: _A,
    timing: _A,
    progress: Callable[[float], object] | None,
    /,
) -> tuple[_A, _A, _A, _A, _A]: ...

class Equations:
    def __init__(self, design: _A, joint: Joint, setup: _A, excitations: list[_A], /) -> None: ...
    def start(self, /) -> _A: ...
    def rates(self, t: float, y: _A, /) -> _A: ...

def excitation(terms: _A, times: _A, /) -> _A: ...
def base_motion(terms: _A, roll_pitch_yaw: bool, rest: _A, times: _A, /) -> _A: ...
def sweep_designs(designs: _A, joint: Joint, poses: _A, paired: bool, modes: int, threads: int, /) -> _A: ...
def design_gradients(
    design: _A,
    joint: Joint,
    platforms: _A,
    directions: _A,
    displacements: _A,
    home: _A,
    home_displacements: _A,
    what: int,
    /,
) -> dict[str, Any]: ...

# The pose sweep. limits: neutral directions (36), leg length bounds (12), largest universal and spherical angle, least
# leg distance. Gives arrays by name, and "status": a value of SweepStatus.
SWEEP_ARRAYS: dict[str, SweepQuantity]  # array -> what to ask for

def sweep(
    design: _A, joint: Joint, poses: _A, quantities: SweepQuantity, limits: _A, threads: int, /
) -> dict[str, NDArray[Any]]: ...
def sweep_flops(design: _A, joint: Joint, poses: _A, quantities: SweepQuantity, /) -> float: ...

compiler: str  # name and version

def simd() -> str: ...
def simd_available() -> tuple[str, ...]: ...
def peak_flops(rounds: int, /) -> float: ...
