"""The check of one value of a design against its key's rule."""

from typing import Any

import numpy as np

from flexapod.checks import is_masked
from flexapod.conventions import Array
from flexapod.design.key import SHAPES, Key
from flexapod.design.units import printed, si_unit, to_si
from flexapod.errors import DesignError, shown, told_apart

LARGEST = 1e100  # squares and products of such numbers still do not overflow
DEEPEST = max(len(shape) for shape in SHAPES) + 2  # a little more than any value has: the shape is checked later


def check_value(name: str, value: Any, rule: Key, unit: str | None = None) -> Array:
    """One value as an array in SI units, in the shape it was given. Raises DesignError that says what is wrong."""
    unit = si_unit(rule.dimension) if unit is None else unit
    given = _numbers(name, value, rule)
    if rule.symmetric and given.shape == rule.shapes[0][:1]:
        given = np.diag(given)
    if not rule.takes(given.shape):
        shape = "one number" if given.ndim == 0 else f"shape {' x '.join(map(str, given.shape))}"
        raise DesignError(f"{name} has {shape}; it must be {rule.shape_text}. {rule.remedy}")
    si = to_si(given, rule.dimension, unit) if rule.dimension else given
    _check_each(name, given, si, rule, unit)
    if rule.symmetric:
        si = _symmetric(name, given, si, rule, unit)
    return np.asarray(si + 0.0)  # + 0.0: -0.0 becomes 0.0, so that equal designs have equal bytes


def _numbers(name: str, value: Any, rule: Key) -> Array:
    """The value as float64 of any shape; text, truth values and ragged lists are refused."""
    if hasattr(value, "__array__"):
        if is_masked(value):
            raise DesignError(f"{name} has masked entries; it must be {rule.shape_text}. Fill them in.")
        value = np.asarray(value)
    found = _not_a_number(value, "")
    if found is not None:
        path, item = found
        kind = "text" if isinstance(item, str) else type(item).__name__
        must = "it must be a number" if path else f"it must be {rule.shape_text}"
        raise DesignError(f"{name}{path} is {shown(item)} ({kind}); {must}. {rule.remedy}")
    try:
        return np.array(value, dtype=np.float64)
    except OverflowError:
        raise DesignError(
            f"{name} holds an integer too large for a number of this machine; it must be finite."
        ) from None
    except ValueError:
        raise DesignError(
            f"{name} has rows of different lengths; it must be {rule.shape_text}. {rule.remedy}"
        ) from None


def _not_a_number(value: Any, path: str, depth: int = 0) -> tuple[str, Any] | None:
    """Where a nested list holds something that is not a number, and what; None if nowhere."""
    if isinstance(value, np.ndarray):
        return None if value.dtype.kind in "iuf" else (path, value.tolist())
    if isinstance(value, list | tuple) and depth <= DEEPEST:
        found = (_not_a_number(item, f"{path}[{index}]", depth + 1) for index, item in enumerate(value))
        return next((item for item in found if item is not None), None)
    is_number = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    return None if is_number else (path, value)


def _check_each(name: str, given: Array, si: Array, rule: Key, unit: str) -> None:
    low, high = si.min(), si.max()  # NaN, which keeps no bound, where any of them is
    above = rule.least is None or low > rule.least or (low == rule.least and not rule.open_)
    if above and (rule.most is None or high <= rule.most) and low > -LARGEST and high < LARGEST:
        return
    bad, bound, sign = ~(np.abs(si) < LARGEST), LARGEST, "smaller than"
    if rule.least is not None and not bad.any():
        bad, bound, sign = si <= rule.least if rule.open_ else si < rule.least, rule.least, ">" if rule.open_ else ">="
    if rule.most is not None and not bad.any():
        bad, bound, sign = si > rule.most, rule.most, "<="
    index = tuple(np.argwhere(bad)[0])
    place = "".join(f"[{i}]" for i in index)
    limit = bound / float(to_si(1.0, rule.dimension, unit)) if rule.dimension else bound
    value, least = (f"{words} {printed(unit)}".rstrip() for words in told_apart(float(given[index]), limit, (6, 4)))
    must = f"{sign} {least if limit else 0}"
    remedy = rule.remedy
    if bound == LARGEST:
        remedy = rule.too_large or remedy
        must = f"smaller than {LARGEST:g} in SI units" if np.isfinite(given).all() else "a finite number"
    raise DesignError(f"{name}{place} is {value}; it must be {must}. {remedy}")


def _symmetric(name: str, given: Array, si: Array, rule: Key, unit: str) -> Array:
    """The symmetric part of matrices that are symmetric but for rounding; others are refused."""
    turned = np.swapaxes(si, -1, -2)
    scale = np.abs(si).max(axis=(-1, -2), keepdims=True)
    if rule.dimension is None:  # translations and rotations: numbers of several units
        root = np.sqrt(np.abs(np.diagonal(si, axis1=-2, axis2=-1)))
        scale = root[..., :, None] * root[..., None, :]
    bad = np.abs(si - turned) > 1e-9 * scale  # beyond what printing with ten digits does
    if bad.any():
        index = tuple(np.argwhere(bad)[0])
        *leg, i, j = index
        place = "".join(f"[{n}]" for n in leg)
        one, other = given[index], np.swapaxes(given, -1, -2)[index]
        raise DesignError(
            f"{name}{place} is not symmetric: [{i}][{j}] is {one:.6g} and [{j}][{i}] is "
            f"{f'{other:.6g} {printed(unit)}'.rstrip()}; "
            f"{'an inertia' if rule.dimension == 'inertia' else 'it'} must be symmetric. {rule.remedy}"
        )
    return (si + turned) / 2
