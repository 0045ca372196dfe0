"""What a search may change: bounded variables, each tied to numbers of the design by a smooth map.

    Variable("legs.stiffness_N_per_um", 10, 80)                            all six legs, always equal
    Variable("platform.joints[:][2]", -0.02, 0.02, kind="add")             the plate's joints raised together
    Variable({"base.joints[0][1]": 1, "base.joints[5][1]": -1}, 0.05, 0.2) two joints kept as mirror images
    JointCircle("base", radius=(0.1, 0.2), half_angle=(0.05, 0.5))         three pairs, symmetric whatever the values

The map takes complex numbers as well, so that its derivatives are exact to rounding (complex step).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.design import layout
from flexapod.design.hexapod import Hexapod
from flexapod.design.schema import Key
from flexapod.errors import ArgumentError, DesignError

Kind = Literal["set", "add", "scale"]
Range = tuple[float, float]
_STEP = 1e-200  # of the complex step: no difference is taken, so nothing cancels


@dataclass(frozen=True)
class Variable:
    """One bounded number that sets, adds to or scales numbers of the design.

    targets: a key of the design file with indices, counted from 0 (`[:]` is all), in the key's unit; several keys that
    are kept equal; or keys with the factor that each has of the variable (ties). low, high: bounds, in the first key's
    unit; for kind="scale" a ratio. kind: the entries are the variable ("set"), or what they were plus it ("add") or
    times it ("scale"). name: in results; default: the key. log: search its logarithm, for what spans decades.

    Source: own.
    """

    targets: str | Sequence[str] | Mapping[str, float]
    low: float
    high: float
    kind: Kind = "set"
    name: str = ""
    log: bool = False

    def parts(self, hexapod: Hexapod) -> list[Part]:
        """The map of this variable for a design.

        Raises: ArgumentError for what cannot be a variable of the design.
        """
        if self.kind not in ("set", "add", "scale"):
            raise ArgumentError(f"{self._name}: kind is {self.kind!r}; it must be 'set', 'add' or 'scale'.")
        factors = self._factors()
        unit = layout.entries(next(iter(factors)))[2] if self.kind != "scale" else 1.0
        parameter = Parameter(self._name, self.low * unit, self.high * unit, unit, self.log)
        parameter.check()
        found = [(layout.entries(key), factor) for key, factor in factors.items()]
        index = np.concatenate([place for (place, _, _), _ in found])
        factor = np.concatenate([np.full(len(place), factor) for (place, _, _), factor in found])
        if self.kind != "scale":
            for (_, rule, _), scale in found:
                self._check_range(parameter, rule, scale)
        base = layout.numbers(hexapod)[index]
        if np.isnan(base).any():
            raise ArgumentError(f"{self._name} changes the home pose, but {hexapod.name!r} names none. Add [home].")
        return [Tie(parameter, index, factor, base, self.kind)]

    @property
    def _name(self) -> str:
        if self.name:
            return self.name
        keys = list(self._factors())
        return keys[0] if len(keys) == 1 else f"{keys[0]}.."

    def _factors(self) -> dict[str, float]:
        if isinstance(self.targets, str):
            return {self.targets: 1.0}
        if isinstance(self.targets, Mapping):
            found = {str(key): float(factor) for key, factor in self.targets.items()}
        else:
            found = dict.fromkeys(self.targets, 1.0)
        if not found or not all(np.isfinite(factor) and factor for factor in found.values()):
            raise ArgumentError(f"{self.targets!r} ties nothing; give one key or more, with factors that are not 0.")
        return found

    def _check_range(self, parameter: Parameter, rule: Key, factor: float) -> None:
        """Bounds that leave the range a design allows are refused at once, not trial by trial."""
        if self.kind != "set":
            return
        low, high = sorted((parameter.low * factor, parameter.high * factor))
        if rule.least is not None and (low < rule.least or (rule.open_ and low <= rule.least)):
            sign = ">" if rule.open_ else ">="
            raise ArgumentError(
                f"{self._name} may go down to {low:.6g}, but {rule.meaning} must be {sign} {rule.least:.6g} (SI). "
                "Raise its lower bound."
            )
        if rule.most is not None and high > rule.most:
            raise ArgumentError(
                f"{self._name} may go up to {high:.6g}, but {rule.meaning} must be <= {rule.most:.6g} (SI). "
                "Lower its upper bound."
            )


@dataclass(frozen=True)
class JointCircle:
    """The six joints of a plate as three mirror-symmetric pairs, 120 degrees apart on a circle about its z axis.

    plate: "base" or "platform". radius m, half_angle rad (between a joint and the middle of its pair), turn rad (of the
    first pair's middle from x), height m: a pair (least, most) makes a variable, a number holds it, None holds what the
    design has (the mean over its joints, if they are not on such a circle). Which legs form a pair is read from the
    design's joints. On the base, universal joint axes become tangents of the circle unless axes="keep".

    Source: own.
    """

    plate: Literal["base", "platform"]
    radius: float | Range | None = None
    half_angle: float | Range | None = None
    turn: float | Range | None = None
    height: float | Range | None = None
    axes: Literal["tangent", "keep"] = "tangent"

    def parts(self, hexapod: Hexapod) -> list[Part]:
        """The map of this circle for a design.

        Raises: ArgumentError for what cannot be a circle of the design.
        """
        if self.plate not in ("base", "platform"):
            raise ArgumentError(f"a joint circle is on {self.plate!r}; it must be on 'base' or 'platform'.")
        if self.axes not in ("tangent", "keep"):
            raise ArgumentError(f"axes of a joint circle is {self.axes!r}; it must be 'tangent' or 'keep'.")
        joints = hexapod.base_joints if self.plate == "base" else hexapod.platform_joints
        third, side, own = _pairs(joints)
        parameters: list[Parameter | float] = []
        for name in ("radius", "half_angle", "turn", "height"):
            given = getattr(self, name)
            if given is None:
                parameters.append(own[name])
            elif np.ndim(given) == 0:
                parameters.append(float(given))
            elif np.shape(given) != (2,):
                raise ArgumentError(f"{self.plate}.{name} is {given!r}; give a number, or a pair (least, most).")
            else:
                low, high = given
                parameters.append(Parameter(f"{self.plate}.{name}", float(low), float(high), start=own[name]))
                parameters[-1].check()  # type: ignore[union-attr]
        if isinstance(parameters[0], Parameter) and parameters[0].low <= 0:
            raise ArgumentError(f"{self.plate}.radius may go down to {parameters[0].low:.6g} m; it must be > 0.")
        return [Circle(self.plate, parameters, third, side, self.plate == "base" and self.axes == "tangent")]


def _pairs(joints: Array) -> tuple[Array, Array, dict[str, float]]:
    """Which third (0, 1, 2) and which side (-1, 1) of a pair each joint is on, and the circle that fits best."""
    angle = np.arctan2(joints[:, 1], joints[:, 0])
    order = np.argsort(angle)
    gaps = np.diff(angle[order], append=angle[order[0]] + 2 * np.pi)
    first = 0 if gaps[0::2].sum() <= gaps[1::2].sum() else 1  # the joints that are nearer together are pairs
    third, side = np.empty(6), np.empty(6)
    for k in range(3):
        third[order[(first + 2 * k) % 6]] = third[order[(first + 2 * k + 1) % 6]] = k
        side[order[(first + 2 * k) % 6]], side[order[(first + 2 * k + 1) % 6]] = -1, 1
    relative = angle - third * 2 * np.pi / 3
    turn = float(np.angle(np.exp(1j * relative).mean()))
    half = float((side * np.angle(np.exp(1j * (relative - turn)))).mean())
    radius = float(np.hypot(joints[:, 0], joints[:, 1]).mean())
    return third, side, {"radius": radius, "half_angle": half, "turn": turn, "height": float(joints[:, 2].mean())}


@dataclass(frozen=True)
class Parameter:
    """A variable's name and bounds (SI), its unit in SI units, and where the design has it."""

    name: str
    low: float
    high: float
    unit: float = 1.0
    log: bool = False
    start: float = np.nan

    def check(self) -> None:
        if not (np.isfinite(self.low) and np.isfinite(self.high)):
            raise ArgumentError(f"{self.name} has the bounds {self.low} and {self.high}; both must be finite numbers.")
        if not self.low < self.high:
            low, high = self.low / self.unit, self.high / self.unit
            raise ArgumentError(
                f"{self.name} has the bounds {low:.6g} and {high:.6g}, which contradict each other; the lower bound "
                "must be < the upper one. To hold a number, leave it out of the variables."
            )
        if self.log and self.low <= 0:
            raise ArgumentError(f"{self.name} is searched in its logarithm; its lower bound must be > 0.")


@dataclass(frozen=True)
class Tie:
    """A `Variable`: entries that are affine in one parameter."""

    parameter: Parameter
    index: NDArray[np.int64]
    factor: Array
    base: Array
    kind: Kind

    @property
    def parameters(self) -> list[Parameter]:
        return [self.parameter]

    @property
    def touched(self) -> NDArray[np.int64]:
        return self.index

    def start(self) -> list[float]:
        if self.kind == "set":
            return [float((self.base / self.factor).mean())]
        return [0.0 if self.kind == "add" else 1.0]

    def put(self, x: Any, numbers: Any) -> None:
        if self.kind == "set":
            numbers[self.index] = self.factor * x[0]
        elif self.kind == "add":
            numbers[self.index] = self.base + self.factor * x[0]
        else:
            numbers[self.index] = self.base * (1 + self.factor * (x[0] - 1))


@dataclass(frozen=True)
class Circle:
    """A `JointCircle`: radius, half angle, turn and height, each a parameter or a number."""

    plate: str
    four: list[Parameter | float]
    third: Array
    side: Array
    tangent: bool

    @property
    def parameters(self) -> list[Parameter]:
        return [p for p in self.four if isinstance(p, Parameter)]

    @property
    def touched(self) -> NDArray[np.int64]:
        joints = layout.PLACES[f"{self.plate}.joints"].ravel()
        axes = layout.PLACES["base.universal_axes"].ravel() if self.tangent else joints[:0]
        return np.concatenate([joints, axes])

    def start(self) -> list[float]:
        return [p.start for p in self.parameters]

    def put(self, x: Any, numbers: Any) -> None:
        given = iter(x)
        radius, half, turn, height = (next(given) if isinstance(p, Parameter) else p for p in self.four)
        angle = turn + self.third * (2 * np.pi / 3) + self.side * half
        place = layout.PLACES[f"{self.plate}.joints"]
        cosine, sine = np.cos(angle), np.sin(angle)
        numbers[place[:, 0]], numbers[place[:, 1]], numbers[place[:, 2]] = radius * cosine, radius * sine, height
        if self.tangent:
            axes = layout.PLACES["base.universal_axes"]
            numbers[axes[:, 0]], numbers[axes[:, 1]], numbers[axes[:, 2]] = -sine, cosine, 0.0


Part = Tie | Circle


class DesignMap:
    """From variables x (n,), SI units, to the numbers of a design (see layout.py) and back to a `Hexapod`."""

    def __init__(self, hexapod: Hexapod, variables: Sequence[Variable | JointCircle]) -> None:
        if isinstance(variables, Variable | JointCircle):
            variables = [variables]
        wrong = [v for v in variables if not isinstance(v, Variable | JointCircle)]
        if wrong or not variables:
            what = f"holds {wrong[0]!r}" if wrong else "is empty"
            raise ArgumentError(f"variables {what}; give at least one Variable or JointCircle.")
        self.hexapod = hexapod
        self.parts = [part for variable in variables for part in variable.parts(hexapod)]
        self.parameters = [p for part in self.parts for p in part.parameters]
        if not self.parameters:
            raise ArgumentError("variables holds nothing that varies; give at least one pair of bounds (least, most).")
        self._check_apart()
        self.changed = np.zeros(layout.SIZE, dtype=bool)
        for part in self.parts:
            self.changed[part.touched] = True
        self._axes = layout.PLACES["base.universal_axes"]
        self._turned = self.changed[self._axes].any(axis=1)
        self._numbers = layout.numbers(hexapod)

    def _check_apart(self) -> None:
        owner: dict[int, str] = {}
        names: set[str] = set()
        for part in self.parts:
            title = ", ".join(p.name for p in part.parameters) or "a joint circle"
            for number in part.touched.tolist():
                if number in owner:
                    raise ArgumentError(
                        f"{owner[number]} and {title} both set {layout.describe(number)}. Leave one of them out."
                    )
                owner[number] = title
            for p in part.parameters:
                if p.name in names:
                    raise ArgumentError(f"two variables are named {p.name!r}. Give one of them another name.")
                names.add(p.name)

    @property
    def names(self) -> list[str]:
        return [p.name for p in self.parameters]

    @property
    def low(self) -> Array:
        return np.array([p.low for p in self.parameters])

    @property
    def high(self) -> Array:
        return np.array([p.high for p in self.parameters])

    @property
    def logarithmic(self) -> NDArray[np.bool_]:
        return np.array([p.log for p in self.parameters])

    def own(self) -> Array:
        """Where the design itself has the variables; they may lie outside the bounds."""
        return np.concatenate([part.start() for part in self.parts])

    def numbers(self, x: Any) -> Any:
        """The design's numbers, real or complex as x is."""
        x = np.asarray(x)
        found = self._numbers.astype(np.result_type(x, np.float64))
        first = 0
        for part in self.parts:
            count = len(part.parameters)
            part.put(x[first : first + count], found)
            first += count
        for axis in self._axes[self._turned]:
            with np.errstate(invalid="ignore"):  # an axis of length zero is NaN, which makes no hexapod
                found[axis] = found[axis] / np.sqrt((found[axis] ** 2).sum())
        return found

    def jacobian(self, x: Array) -> Array:
        """(m, n): derivatives of the numbers by the variables."""
        n = len(self.parameters)
        columns = [self.numbers(x + 1j * _STEP * np.eye(n)[k]).imag / _STEP for k in range(n)]
        return np.stack(columns, axis=1)

    def hexapod_at(self, x: Array) -> Hexapod:
        """Raises DesignError where the numbers are no hexapod."""
        numbers = self.numbers(x)
        if not np.isfinite(numbers[self.changed]).all():
            raise DesignError("the variables give numbers that are not finite")
        return layout.with_numbers(self.hexapod, numbers, self.changed)

    def values(self, x: Array) -> dict[str, float]:
        """The variables by name, in the unit of their keys."""
        return {p.name: float(v / p.unit) for p, v in zip(self.parameters, x, strict=True)}

    def from_values(self, values: Mapping[str, float]) -> Array:
        """The variables from values by name (as `values` gives them); those left out as the design has them."""
        x = np.clip(self.own(), self.low, self.high)
        for name, value in values.items():
            if name not in self.names:
                raise ArgumentError(f"start names {name!r}, which is no variable. There are: {', '.join(self.names)}.")
            k = self.names.index(name)
            p = self.parameters[k]
            if not p.low <= value * p.unit <= p.high:
                raise ArgumentError(
                    f"the start has {name} = {value:.6g}, outside its bounds {p.low / p.unit:.6g} to "
                    f"{p.high / p.unit:.6g}. Move the start, or widen the bounds."
                )
            x[k] = value * p.unit
        return x

    def unit(self, x: Array) -> Array:
        """From 0 to 1 between the bounds (of the logarithms, where they are searched)."""
        low, high, x = self._searched(self.low), self._searched(self.high), self._searched(x)
        return (x - low) / (high - low)

    def from_unit(self, u: Array) -> tuple[Array, Array]:
        """The variables at u, and dx/du (n,)."""
        low, high = self._searched(self.low), self._searched(self.high)
        x = low + np.clip(u, 0.0, 1.0) * (high - low)
        x = np.where(self.logarithmic, np.exp(np.where(self.logarithmic, x, 0.0)), x)
        slope = (high - low) * np.where(self.logarithmic, x, 1.0)
        return np.clip(x, self.low, self.high), slope

    def _searched(self, x: Array) -> Array:
        return np.where(self.logarithmic, np.log(np.where(self.logarithmic, x, 1.0)), x)

    def describe(self) -> list[dict[str, Any]]:
        """Everything that makes this map and no other, in plain numbers and words."""
        found = []
        for part in self.parts:
            plain: dict[str, Any] = {"part": type(part).__name__}
            for name, value in vars(part).items():
                plain[name] = _plain(value)
            found.append(plain)
        return found


def _plain(value: Any) -> Any:
    if isinstance(value, Parameter):
        return {"name": value.name, "low": value.low, "high": value.high, "log": value.log}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return value.tolist() if isinstance(value, np.ndarray) else value
