"""What the commands share: their common options, and how arguments become a design and a pose and results become JSON.

A command stacks the decorators it needs on a function whose parameters carry the option's name:

    @click.command()
    @machine_options      # design: str, changes: tuple[str, ...], pose: tuple[float, ...] | None, joint: JointModel
                          #     turn the first three into a Hexapod and a Pose with `machine(design, changes, pose)`
    @json_option          # as_json: bool      print with `print_json`
    def command(...): ...

`machine_options` is design_argument, pose_option, set_option and joint_option; some commands need only a part of them.
Nothing here imports NumPy before a command asks for a design, so that `flexapod --help` answers at once. A command
raises FlexapodError or click.UsageError for what the user can put right; `flexapod.cli.main` prints it and exits
with 2.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.shell_completion import CompletionItem

from flexapod.cli.options.given import needed
from flexapod.cli.options.quantities import FREQUENCY, LENGTH, POSITIVE_LENGTH, SIX
from flexapod.conventions import JOINT_MODELS
from flexapod.errors import OutputError
from flexapod.output_files import check_directory, check_file

if TYPE_CHECKING:
    from rich.console import Console

    from flexapod.design.hexapod import Hexapod
    from flexapod.pose import Pose

_ENOUGH = 10_000  # columns of what is no terminal: no number is cut


class DesignName(click.ParamType):
    """A packaged design's name or a path to a .toml file; completes both."""

    name = "design"

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from flexapod.design.design_file import packaged_designs

        names = [CompletionItem(name) for name in packaged_designs() if name.startswith(incomplete)]
        return [*names, CompletionItem(incomplete, type="file")]


class Assignment(click.ParamType):
    """KEY=VALUE of a design file; completes the keys."""

    name = "key=value"

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from flexapod.design.schema import KEYS

        return [CompletionItem(f"{key}=") for key in KEYS if key.startswith(incomplete)]


class Output(click.ParamType):
    """A file or directory to be written, tried before anything is computed. check: raises OutputError."""

    name = "path"

    def __init__(self, check: Callable[[Path], object]) -> None:
        self.check = check

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        path = Path(value)
        try:
            self.check(path)
        except OutputError as error:
            raise OutputError(f"{max(param.opts, key=len)}: {error}" if param else str(error)) from error
        return path

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        return [CompletionItem(incomplete, type="dir" if self.check is check_directory else "file")]


DIRECTORY, FILE = Output(check_directory), Output(check_file)
GIVEN_FILE = click.Path(path_type=Path, exists=True, dir_okay=False)  #: a file that is read


class Finite(click.FloatRange):
    """A number in a range: neither NaN nor infinite."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{value} is not a finite number.", param, ctx)
        return number


_MOST = 1e30  # of any number, in its unit: its square and cube are finite
NUMBER = Finite(min=-_MOST, max=_MOST)
POSITIVE = Finite(min=0, min_open=True, max=_MOST)
NOT_NEGATIVE = Finite(min=0, max=_MOST)
SEED = click.IntRange(0, 2**32 - 1)
THREADS = click.IntRange(1, 4096)


def count(least: int = 1, most: int = 10**7) -> click.IntRange:
    """How many of something that is held in memory."""
    return click.IntRange(least, most)


design_argument = click.argument("design", type=DesignName())
set_option = click.option(
    "--set",
    "changes",
    type=Assignment(),
    multiple=True,
    metavar="KEY=VALUE",
    help="Change a number of the design, as platform.mass=400 or legs.stiffness_N_per_um[2]=10. Repeatable.",
)
_TURNS = "flexapod.turns"  # in a context's meta: the order and the pivot of its poses, and whether it names one
_POSE_FILES = ("file", "path_file", "mean")  # parameters: a file may have poses


def _keep(context: click.Context, parameter: click.Parameter, value: Any) -> None:
    if parameter.name == "rotation_order" and value is not None:
        from flexapod.rotations import check_order

        check_order(value)
    context.meta.setdefault(_TURNS, {})[parameter.name] = value


def turning_needs(there: object) -> None:
    """Raise UsageError for --rotation-order or --pivot without a pose that it turns."""
    needed(there, "the angles of poses that are given, and here is none", "rotation_order", "pivot")


def turns() -> tuple[str | None, tuple[float, float, float] | None]:
    """The command line's --rotation-order and --pivot; None each where it is not given."""
    context = click.get_current_context(silent=True)
    given = {} if context is None else context.meta.get(_TURNS, {})
    return given.get("rotation_order"), given.get("pivot")


def _as_rpy(context: click.Context, _: click.Parameter, six: tuple[float, ...] | None) -> tuple[float, ...] | None:
    """x, y, z, roll, pitch, yaw (m, deg) of a pose in the context's order and about its pivot."""
    given = context.meta[_TURNS]
    order, pivot = given["rotation_order"], given["pivot"]
    given["turned"] = given.get("turned", False) or six is not None
    if six is None or (order is None and pivot is None):
        return six
    from flexapod.pose import Pose

    pose = Pose.from_angles(six[:3], six[3:], order or "xyz", degrees=True, pivot=pivot or (0.0, 0.0, 0.0))
    return (*pose.position.tolist(), *(math.degrees(angle) for angle in pose.rpy.tolist()))


def pose_named(*names: str, help: str) -> Callable[[Any], Any]:
    """An option whose six numbers are a pose, as `rotation_options` beside it say; None where it is not given."""
    metavar = "X Y Z ROLL PITCH YAW"
    return click.option(*names, type=SIX, default=None, metavar=metavar, callback=_as_rpy, help=help)


def rotation_options(function: Any) -> Any:
    """--rotation-order and --pivot, for all options of `pose_named`."""
    early: dict[str, Any] = {"is_eager": True, "expose_value": False, "callback": _keep}
    order = click.option(
        "--rotation-order",
        metavar="ORDER",
        help="Axes of the three angles of poses, as SciPy names them: xyz (default) about fixed axes, XYZ about moving "
        "axes, ZXZ, and so on; the first turn first.",
        **early,
    )
    pivot = click.option(
        "--pivot",
        type=(LENGTH,) * 3,
        default=None,
        metavar="X Y Z",
        help="Point of the platform, in its frame, m, that the angles of poses turn it about. Default: its origin.",
        **early,
    )

    @wraps(function)
    def turned(*args: Any, **given: Any) -> Any:
        named = click.get_current_context().meta[_TURNS].get("turned")
        turning_needs(named or any(given.get(name) for name in _POSE_FILES))
        return function(*args, **given)

    return order(pivot(turned))


def pose_option(function: Any) -> Any:
    """--pose, with what says how it is turned."""
    pose = pose_named(
        "--pose",
        help="Pose of the platform in the base frame: m, and degrees about the fixed axes x, y, z. Default: home pose.",
    )
    return pose(rotation_options(function))


joint_option = click.option(
    "--joint",
    type=click.Choice(JOINT_MODELS),
    default="universal",
    show_default=True,
    help="Model of the base joints: exact, or the paper's legs that do not spin.",
)
characteristic_length_option = click.option(
    "--characteristic-length",
    type=POSITIVE_LENGTH,
    default=None,
    metavar="M",
    help="Divide the moment rows of H by this length before its condition number is taken.",
)
exaggeration_option = click.option(
    "--exaggeration",
    type=POSITIVE,
    default=None,
    metavar="FACTOR",
    help="How many times larger a moving picture shows the motion. Default: so that it is seen well.",
)
loss_frequency_option = click.option(
    "--loss-frequency",
    type=FREQUENCY,
    default=None,
    metavar="RAD/S",
    help="Frequency at which viscous friction takes as much as the design's loss factors. Default: no losses.",
)
json_option = click.option("--json", "as_json", is_flag=True, help="Print the results as JSON, in SI units.")


def out_option(help: str) -> Callable[[Any], Any]:
    """--out DIR: None where it is not given."""
    return click.option("--out", type=DIRECTORY, default=None, metavar="DIR", help=help)


def stack(*decorators: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Several decorators as one, the first outermost."""

    def decorate(function: Any) -> Any:
        for decorator in reversed(decorators):
            function = decorator(function)
        return function

    return decorate


machine_options = stack(design_argument, pose_option, set_option, joint_option)


def machine(design: str, changes: Iterable[str], pose: tuple[float, ...] | None) -> tuple[Hexapod, Pose]:
    """The design with its changes, and the pose given or else its home. Raises DesignError, UsageError."""
    hexapod = load_design(design, changes)
    return hexapod, chosen_pose(hexapod, pose)


def load_design(design: str, changes: Iterable[str] = ()) -> Hexapod:
    """The design of a name or path, with the changes of `--set`. Raises DesignError."""
    from flexapod.design.changes import parse_assignments
    from flexapod.design.loading import load

    hexapod = load(design)
    assignments = parse_assignments(changes)
    return hexapod.replace(assignments) if assignments else hexapod


def chosen_pose(hexapod: Hexapod, six: tuple[float, ...] | None) -> Pose:
    """The pose of `--pose` (m, deg), or else the design's home pose. Raises UsageError where there is neither."""
    pose = pose_or_none(hexapod, six)
    if pose is None:
        raise click.UsageError(
            f"{hexapod.name!r} names no home pose, so a pose is needed. Give --pose X Y Z ROLL PITCH YAW (m, degrees), "
            "or add a [home] table with position = [x, y, z] to the design."
        )
    return pose


def home_for(hexapod: Hexapod, option: str) -> Pose:
    """The home pose, from which an option counts. Raises UsageError where the design names none."""
    if hexapod.home is None:
        raise click.UsageError(f"{hexapod.name!r} names no home pose for {option}. Add [home] to the design.")
    return hexapod.home


def pose_or_none(hexapod: Hexapod, six: tuple[float, ...] | None) -> Pose | None:
    """As `chosen_pose`, but None where there is neither."""
    from flexapod.mechanics.kinematics import home_pose

    return home_pose(hexapod) if six is None else pose_of(six)


def pose_of(six: tuple[float, ...]) -> Pose:
    """The pose of the six numbers of an option (m, deg)."""
    from flexapod.pose import Pose

    return Pose.from_rpy(*six, degrees=True)


def place(out: Path | None, as_json: bool) -> Path | None:
    """Where files go: --out, or else the current directory; with --json nowhere unless --out is given.

    Raises OutputError, before anything is computed, where nothing can be written.
    """
    return None if out is None and as_json else check_directory(out or Path())


def print_json(result: Mapping[str, Any]) -> None:
    """A result on standard output as JSON, a key a line; arrays become lists, NaN and infinity become null."""
    lines = (f"  {json.dumps(key)}: {json.dumps(plain(value))}" for key, value in result.items())
    click.echo("{\n" + ",\n".join(lines) + "\n}")


def plain(value: Any) -> Any:
    """A value in what JSON knows."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if hasattr(value, "tolist"):  # an array or a number of NumPy
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def console() -> Console:
    """Where tables are printed: as wide as the terminal; where it is none, plain text as wide as it needs to be."""
    from rich.console import Console

    console = Console(highlight=False)
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console.width = _ENOUGH
    return console


def print_warnings(texts: Iterable[str]) -> None:
    """What to beware of, on standard output with the results; brackets in it are no markup."""
    from rich.markup import escape

    for text in texts:
        console().print(f"[bold yellow]Warning:[/bold yellow] {escape(text)}", soft_wrap=True)
