"""What the server answers, as types. The page's TypeScript types are generated from them (`make web-types`).

Arrays are sent as nested lists. NaN and infinity are sent as null, where the type says that they may occur.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, NamedTuple, TypedDict

import numpy as np


class Sent(NamedTuple):
    """How numbers are sent: nested in `depth` lists, and whether any of them may be null."""

    depth: int
    nullable: bool = False


OptionalNumber = Annotated[float, Sent(0, nullable=True)]
Vector = Annotated[np.ndarray, Sent(1)]
Matrix = Annotated[np.ndarray, Sent(2)]
OptionalVector = Annotated[np.ndarray, Sent(1, nullable=True)]
OptionalMatrix = Annotated[np.ndarray, Sent(2, nullable=True)]
OptionalCube = Annotated[np.ndarray, Sent(3, nullable=True)]


class FieldError(TypedDict):
    """What is wrong with one key of a design. `line` counts from 1; it is 0 if the key is not in the text."""

    key: str
    message: str
    line: int


class Refusal(TypedDict):
    """The answer to a wrong request, design or pose."""

    error: str
    fields: list[FieldError]


class Field(TypedDict):
    """One key of a design file. `shapes` are those that it takes (-1: any length), `laws` those that it belongs to."""

    key: str
    meaning: str
    unit: str
    shapes: list[list[int]]
    optional: bool
    laws: list[str]


class NamedText(TypedDict):
    """A design file: its name and its text."""

    name: str
    text: str


class Start(TypedDict):
    """What a new page needs first: the packaged designs, the design to show, the keys of a design file."""

    version: str
    presets: dict[str, str]
    start: NamedText | None
    fields: list[Field]


class Parameter(TypedDict):
    """A main parameter of a design, with a slider. `size` (m) is the slider's half range if it is linear."""

    key: str
    label: str
    unit: str
    logarithmic: bool
    original: float
    value: float
    size: float


class PoseBox(TypedDict):
    """Ranges of x, y, z (m), roll, pitch and yaw (degrees)."""

    low: list[float]
    high: list[float]


class Drawn(TypedDict):
    """What a 3-D view must know of a design: `home` in m and degrees, `leg`: mean length at home, m."""

    name: str
    home: list[float]
    box: PoseBox
    leg: float


class Design(Drawn):
    """A design with all its numbers: `values` by key; `laws`: changes to each."""

    digest: str
    warnings: list[str]
    values: dict[str, Any]
    laws: dict[str, dict[str, Any]]
    parameters: list[Parameter]
    toml: str


class Geometry(TypedDict):
    """Joints and universal axes (6 x 3), mass centre, and the pose as position and rotation matrix, m."""

    base: Matrix
    axes: Matrix
    platform: Matrix
    mass_center: Vector
    position: Vector
    matrix: Matrix


class Mode(TypedDict):
    """A mode in words, its dominant axis, and the share of each axis in its kinetic energy."""

    text: str
    dominant: str
    share: OptionalVector


class LoneMode(TypedDict):
    """A damped mode that is like no undamped one: in words, Hz (null: it does not vibrate), damping ratio."""

    text: str
    frequency: OptionalNumber
    ratio: float


class DampedModes(TypedDict):
    """Damped modes at the places of undamped ones that move alike, rad/s, Hz; ratio < 0: it grows; alone: like none."""

    omega: OptionalVector
    frequency: OptionalVector
    ratio: OptionalVector
    overlap: OptionalVector
    alone: list[LoneMode]


class StaticLegs(TypedDict):
    """Leg lengths (m), static forces (N) and spring energies (J). `why` says why there are no forces."""

    length: OptionalVector
    force: OptionalVector | None
    energy: OptionalVector | None
    why: str


class Legs(StaticLegs):
    """The same with the angles of both joints of each leg, degrees."""

    universal: OptionalVector
    spherical: OptionalVector


class Limits(TypedDict):
    """Whether the design has limits, whether they hold, and those exceeded in words: all, and by leg."""

    any: bool
    ok: bool
    exceeded: list[str]
    by_leg: list[list[str]]


class Snapshot(TypedDict):
    """The machine at one pose. `shape` and `strain` have a row per mode; beside what is `grave` no limit matters."""

    pose: list[float]
    stability: Literal["stable", "falls over", "singular"]
    geometry: Geometry
    omega: OptionalVector
    frequency: OptionalVector
    index: OptionalNumber
    condition: OptionalNumber
    shape: Matrix
    modes: list[Mode]
    strain: OptionalMatrix
    damped: DampedModes | None
    sampling_time: OptionalNumber
    legs: Legs
    leg_distance: OptionalNumber
    limits: Limits
    grave: list[str]
    warnings: list[str]
    near_repeated: list[tuple[int, int]]


class ResponseMode(TypedDict):
    """A mode marked in the plots of the response."""

    name: str
    omega: float


class FrequencyResponse(TypedDict):
    """Magnitude and phase (degrees) by output, input, frequency (rad/s); `losses` and `caution` are in words."""

    omega: Vector
    magnitude: OptionalCube
    phase: OptionalCube
    outputs: list[str]
    inputs: list[str]
    output_units: list[str]
    input_units: list[str]
    modes: list[ResponseMode]
    losses: str
    caution: str


class ComplexVector(TypedDict):
    """Real and imaginary parts."""

    real: Vector
    imag: Vector


class ShakenBase(TypedDict):
    """The platform's displacement for a unit motion of the base, and the factor by which to draw both."""

    platform: ComplexVector
    base: Vector
    ratio: OptionalNumber
    reach: float


class JobStarted(TypedDict):
    """The first message of a job. `waiting`: other jobs must end first."""

    type: Literal["job"]
    id: str
    waiting: bool


class Progress(TypedDict):
    """How far a job is. With `points` and `rows` come binary float32 numbers."""

    type: Literal["points", "rows", "progress"]
    done: float
    total: float
    seconds: float


class WorstPose(TypedDict):
    """The pose (m, degrees) of the lowest index (rad/s) in the box. `within`: part of it that is within the limits."""

    type: Literal["found"]
    pose: list[float]
    index: OptionalNumber
    within: float | None
    words: str


class SimulationRun(TypedDict):
    """A simulation of `count` rows. `speed`: simulated seconds per second of playback; `factor`: of what is drawn."""

    type: Literal["run"]
    count: int
    speed: float
    factor: float
    words: str


class JobEnd(TypedDict):
    """The job is done, or was cancelled."""

    type: Literal["done", "cancelled"]


class JobFailure(TypedDict):
    """The job failed."""

    type: Literal["failed"]
    error: str


JobMessage = JobStarted | Progress | WorstPose | SimulationRun | JobEnd | JobFailure
Message = tuple[JobMessage, bytes]  #: a message of a job with the binary numbers behind it
