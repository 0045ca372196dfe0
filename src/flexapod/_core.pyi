# What the compiled core offers; functions take arguments by position only. design: Hexapod.packed; platform, base,
# start: motions, rows of `motion_size` numbers; poses: rows of the first 12 of these.
from collections.abc import Callable
from enum import Enum, Flag
from typing import Any, overload

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
PIECE: list[Any]  # a piece of an excitation, as numpy.dtype takes it
design_size: int
stray_numbers: int  # of a design, and of its payload's place
plain_size: int  # the first numbers of a design, which a machine without laws, joint springs and suspension needs
motion_size: int

class Joint(Enum):
    universal = 1
    spin_free = 0

class Law(Enum):
    constant = 0
    screw = 1
    hydraulic = 2
    table = 3

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
    outside_stiffness_law = 8

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
    joint_moment = 1024
    rpy = 2048

class CertificateKind(Enum):
    index = 0
    regular = 1
    condition = 2
    limits = 3

class BrokenLimit(Enum):
    length = 0
    universal_joint = 1
    spherical_joint = 2
    distance = 3
    moment_in_the_universal_joint = 4
    moment_in_the_spherical_joint = 5
    stiffness_law = 6

class CertificateStatus(Enum):
    proved = 0
    refuted = 1
    undecided = 2

class SweepStatus(Enum):
    ok = 0
    singular = 1
    no_leg = 2
    not_finite = 3
    no_inertia = 4
    outside_stiffness_law = 5

class TermKind(Enum):
    sinusoids = 0
    chirp = 1
    pieces = 2

# Of rotations, rows of any number: whether all are what they should be, and the same in other numbers.
def all_finite(numbers: _A, threads: int, /) -> bool: ...
def all_rotate(matrices: _A, threads: int, /) -> bool: ...
def all_of_length_one(quaternions: _A, threads: int, /) -> bool: ...
def matrices_of_quaternions(quaternions: _A, threads: int, /) -> _A: ...
def matrices_of_angles(angles: _A, threads: int, /) -> _A: ...
def angles_of_matrices(matrices: _A, threads: int, /) -> _A: ...
def leg_rates(design: _A, platform: _A, base: _A, /) -> tuple[_A, _A, _A]: ...
def leg_fit(design: _A, platform: _A, base: _A, /) -> tuple[_A, _A]: ...
def joint_angles(design: _A, platform: _A, base: _A, neutral: _A, /) -> tuple[_A, _A, _A, _A]: ...
def leg_distances(design: _A, platform: _A, base: _A, /) -> _A: ...
def shared_joints(joints: _A, /) -> _A: ...
def forward_kinematics(design: _A, lengths: _A, start: _A, /) -> tuple[_A, _A]: ...

class AssemblySearch:
    def __init__(self, design: _A, /) -> None: ...
    @property
    def paths(self) -> int: ...
    def find(self, lengths: _A, threads: int, /) -> tuple[NDArray[int64], _A, _A, NDArray[Any]]: ...

def force_transformation(design: _A, platform: _A, base: _A, /) -> _A: ...
def spring_matrix(design: _A, joint: Joint, platform: _A, base: _A, /) -> _A: ...

SPRING_LEGS: tuple[int, ...]

def axial_stiffness(design: _A, lengths: _A, /) -> tuple[_A, _A]: ...
def unstretched_lengths(design: _A, lengths: _A, forces: _A, /) -> _A: ...
def joint_moments(design: _A, joint: Joint, platform: _A, base: _A, /) -> tuple[_A, _A]: ...
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
def settle(design: _A, joint: Joint, start: _A, base: _A, wrench: _A, unstretched: _A, /) -> tuple[_A, Rest]: ...

class OnePose:
    """A machine that answers one call for one pose. None where something is unusual, which the way of many poses tells.

    A state is position (3,) and rotation (3, 3), or six numbers and None; and four rates of a motion, or None.
    """

    def __init__(self, design: _A, joint: Joint, /) -> None: ...
    def leg_lengths(self, platform: tuple[object, ...], base: tuple[object, ...], /) -> _A | None: ...
    def natural_modes(self, platform: tuple[object, ...], base: tuple[object, ...], /) -> tuple[_A, _A] | None: ...
    def forward_dynamics(
        self,
        platform: tuple[object, ...],
        base: tuple[object, ...],
        leg_force: object,
        force: object,
        moment: object,
        /,
    ) -> tuple[_A, _A] | None: ...
    def inverse_dynamics(
        self,
        platform: tuple[object, ...],
        base: tuple[object, ...],
        force: object,
        moment: object,
        /,
    ) -> _A | None: ...
    def linearise(
        self,
        platform: tuple[object, ...],
        base: tuple[object, ...],
        force: object,
        moment: object,
        /,
    ) -> tuple[_A, _A, _A, _A] | None: ...

class Compiled:
    """A machine on a base at rest, asked with arrays whose shapes are all that is checked. None where one is wrong."""

    def __init__(self, design: _A, joint: Joint, base: _A, /) -> None: ...
    def stability_index(self, pose: object, /) -> float | None: ...
    def natural_frequencies(self, pose: object, /) -> _A | None: ...
    def leg_lengths(self, pose: object, /) -> _A | None: ...
    def jacobian(self, pose: object, /) -> _A | None: ...
    def forward_dynamics(self, pose: object, twist: object, leg_force: object, wrench: object, /) -> _A | None: ...
    def inverse_dynamics(self, pose: object, twist: object, acceleration: object, wrench: object, /) -> _A | None: ...
    def linearised(self, pose: object, wrench: object, /) -> tuple[_A, _A, _A, _A] | None: ...

least_sine: float  # of the angle between a leg and its universal joint's axis

def shortest_leg(design: _A, /) -> float: ...

class SimulationOptions:
    """How accurately and how long to integrate, and what to keep."""

    def __init__(
        self,
        *,
        rtol: float,
        atol: float,
        max_step: float,
        max_steps: float,
        stop_at_singular: bool,
        motions: bool,
        works: bool,
        exponential: bool,
        threads: int,
    ) -> None: ...
    rtol: float
    atol: float
    max_step: float
    max_steps: float
    stop_at_singular: bool
    motions: bool
    works: bool
    exponential: bool
    threads: int

class SimulationSetup:
    """A machine at rest on its base and what drives it from t = 0; poses of 12 numbers, inertial axes."""

    def __init__(
        self,
        *,
        design: _A,
        joint: Joint,
        platform: _A,
        base: _A,
        leg_force: _A,
        wrench: _A,
        displacement: _A,
        velocity: _A,
        roll_pitch_yaw: bool,
        carried: bool,
        base_motion: _A,
        load: _A,
        command: _A,
    ) -> None: ...
    @property
    def joint(self, /) -> Joint: ...
    @property
    def roll_pitch_yaw(self, /) -> bool: ...
    @property
    def carried(self, /) -> bool: ...

class SimulationResult:
    """Rows for n simulations at m instants, NaN after the end of one that was stopped."""

    @property
    def displacement(self, /) -> _A: ...
    @property
    def relative(self, /) -> _A: ...
    @property
    def work(self, /) -> _A: ...
    @property
    def platform(self, /) -> _A: ...
    @property
    def base(self, /) -> _A: ...
    @property
    def leg_force(self, /) -> _A: ...
    @property
    def outcome(self, /) -> list[Outcome]: ...
    @property
    def time(self, /) -> _A: ...
    @property
    def last(self, /) -> _A: ...
    @property
    def steps(self, /) -> NDArray[int64]: ...

class ControllerMatrices:
    """A sampled controller that is shown all measurements."""

    def __init__(self, *, A: _A, B: _A, C: _A, D: _A, limit: _A) -> None: ...
    @property
    def order(self, /) -> int: ...

class ControlRecord:
    """One run of a sampled controller: rows at every step's end (measured, displacement), and at every sample."""

    @property
    def measured(self, /) -> _A: ...
    @property
    def displacement(self, /) -> _A: ...
    @property
    def force(self, /) -> _A: ...
    @property
    def cut(self, /) -> _A: ...
    @property
    def outcome(self, /) -> Outcome: ...

class Equations:
    """y' = rates(t, y) from y = start(), for other integrators."""

    def __init__(self, setup: SimulationSetup, /) -> None: ...
    def start(self, /) -> _A: ...
    def rates(self, t: float, y: _A, /) -> _A: ...

def simulate(
    setups: list[SimulationSetup],
    times: _A,
    options: SimulationOptions,
    progress: Callable[[float], object] | None,
    /,
) -> SimulationResult: ...
def control_loop(
    setup: SimulationSetup,
    controller: ControllerMatrices,
    noise: _A,
    dt: float,
    steps: int,
    progress: Callable[[float], object] | None,
    /,
) -> ControlRecord: ...
def excitation(terms: _A, times: _A, /) -> _A: ...
def base_motion(terms: _A, roll_pitch_yaw: bool, rest: _A, times: _A, /) -> _A: ...
def sweep_designs(designs: _A, joint: Joint, poses: _A, paired: bool, modes: int, threads: int, /) -> _A: ...

class DesignDirections:
    """A machine at n poses and m directions of its design; values come with their derivatives along these."""

    def __init__(
        self,
        *,
        design: _A,
        joint: Joint,
        platform: _A,
        directions: _A,
        displacements: _A,
        home: _A,
        home_displacements: _A,
    ) -> None: ...
    def frequencies(self, /) -> tuple[_A, _A]: ...
    def force_transformation(self, /) -> tuple[_A, _A]: ...
    def stiffness(self, /) -> tuple[_A, _A]: ...
    def held_wrench(self, /) -> tuple[_A, _A]: ...
    def legs(self, /) -> tuple[tuple[_A, _A], tuple[_A, _A], tuple[_A, _A], tuple[_A, _A]]: ...

class SweepLimits:
    """What joints and legs allow; without arguments, everything."""

    @overload
    def __init__(self, /) -> None: ...
    @overload
    def __init__(
        self,
        *,
        neutral: _A,
        leg_length: _A,
        universal_angle: float,
        spherical_angle: float,
        leg_distance: float,
        universal_moment: float,
        spherical_moment: float,
    ) -> None: ...
    @property
    def universal_angle(self, /) -> float: ...
    @property
    def spherical_angle(self, /) -> float: ...
    @property
    def leg_distance(self, /) -> float: ...
    @property
    def universal_moment(self, /) -> float: ...
    @property
    def spherical_moment(self, /) -> float: ...

# The pose sweep: arrays by name, and "status", values of SweepStatus.
SWEEP_ARRAYS: dict[str, SweepQuantity]  # array -> what to ask for

# poses: rows (n, 6) or (n, 12), or positions (n, 3) and rotations, quaternions (n, 4) or matrices (n, 9)
@overload
def sweep(
    design: _A, joint: Joint, poses: _A, quantities: SweepQuantity, limits: SweepLimits, threads: int, /
) -> dict[str, NDArray[Any]]: ...
@overload
def sweep(
    design: _A, joint: Joint, poses: tuple[_A, _A], quantities: SweepQuantity, limits: SweepLimits, threads: int, /
) -> dict[str, NDArray[Any]]: ...

class CertificateOptions:
    """How a certificate is looked for; without arguments: the level itself, without limits, on one thread.

    `gap` > 0: the level is a value that some pose has, and what is proved lies that share from the worst that is seen.
    `limits`: boxes that break one are left out. `cut`: where boxes are cut, 0.3 to 0.7 of the side. `strays`: (n,
    stray_numbers), what each of n variables from -1 to 1 adds to the numbers of the design and to its payload's place.
    `payload`: (4,), where something strays, mass and place of a load beside the design's. `home`: (12,) or none, the
    pose at which joints are in the middle, wherever they are.
    """

    @overload
    def __init__(self, /) -> None: ...
    @overload
    def __init__(
        self,
        *,
        gap: float,
        limits: SweepLimits | None,
        seconds: float,
        max_boxes: float,
        threads: int,
        cut: float,
        strays: _A,
        payload: _A,
        home: _A,
    ) -> None: ...
    gap: float
    limits: SweepLimits | None
    seconds: float
    max_boxes: float
    threads: int
    cut: float

class Certification:
    """What was proved of boxes, or of spans of a path."""

    @property
    def status(self, /) -> CertificateStatus: ...
    @property
    def level(self, /) -> float: ...
    @property
    def value(self, /) -> float: ...  # the worst of the centres seen
    @property
    def at(self, /) -> _A: ...  # (12,), its pose; of a refuted one the pose that refutes
    @property
    def broken(self, /) -> int: ...  # limits: a `BrokenLimit`; else -1
    @property
    def leg(self, /) -> int: ...  # or pair of legs; -1
    @property
    def boxes(self, /) -> int: ...
    @property
    def proved(self, /) -> float: ...  # share of the volume
    @property
    def outside(self, /) -> float: ...
    @property
    def remaining(self, /) -> _A: ...  # (n, 6, 2), of paths (n, 3)
    @property
    def seconds(self, /) -> float: ...

# Boxes: (n, 6, 2), ends of x, y, z, roll, pitch, yaw. A progress function that answers False ends the call.
def certify(
    design: _A,
    joint: Joint,
    boxes: _A,
    kind: CertificateKind,
    level: float,
    options: CertificateOptions,
    progress: Callable[[float], object] | None,
    /,
) -> Certification: ...

# Pieces: (n, 6, powers), position and rotation vector e by powers of a parameter, R = exp(e) middle. Spans: (m, 3), the
# number of a piece and the ends of its parameter.
def certify_path(
    design: _A,
    joint: Joint,
    pieces: _A,
    middle: _A,
    spans: _A,
    kind: CertificateKind,
    level: float,
    options: CertificateOptions,
    progress: Callable[[float], object] | None,
    /,
) -> Certification: ...

compiler: str  # name and version

def simd() -> str: ...
def simd_available() -> tuple[str, ...]: ...
