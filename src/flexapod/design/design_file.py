"""Design files: TOML text to checked values in SI units, changes to such values, and values back to TOML text.

Values are a flat dict: the file's dotted keys without units -> arrays in SI units (`name` is text).
"""

import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from flexapod.design.schema import KEYS, TEXT_KEYS, is_of_each_leg, rule_of
from flexapod.design.short_forms import ShortForm, written
from flexapod.design.shorthands import Values, expand
from flexapod.design.tables import START, complete, flatten
from flexapod.design.text_limits import bytes_of_file, check_count, check_depth, check_size
from flexapod.design.units import printed, si_unit
from flexapod.errors import DesignError, shown

_DESIGNS = Path(__file__).parent / "machines"
_TEMPLATE = "template"


def packaged_designs() -> list[str]:
    """List the designs that come with Flexapod.

    Returns
    -------
    list of str
        Names that `flexapod.load` takes.

    Notes
    -----
    Their files are in the folder `design/machines` of the package and say where the numbers are from; ``flexapod
    designs`` shows what they say.

    Examples
    --------
    >>> [name for name in fx.packaged_designs() if name.startswith("mukherjee")]
    ['mukherjee-i', 'mukherjee-ii']
    """
    return sorted(path.stem for path in _DESIGNS.glob("*.toml") if path.stem != _TEMPLATE)


def find(name_or_path: str | Path) -> Path:
    """The file behind a packaged name or a path. Raises DesignError that lists the names when there is none."""
    text = str(name_or_path)
    if isinstance(name_or_path, str) and text in packaged_designs():
        return _DESIGNS / f"{text}.toml"
    path = Path(name_or_path)
    try:
        is_directory, exists = path.is_dir(), path.exists()
    except OSError:  # such as a name too long for the file system
        is_directory, exists = False, False
    if is_directory:
        raise DesignError(f"{text!r} is a directory; a design is a .toml file. Give the file in it.")
    if not exists:
        from difflib import get_close_matches

        near = get_close_matches(path.stem.lower(), packaged_designs(), n=1)
        hint = f"Did you mean {near[0]!r}? " if near else ""
        names = ", ".join(packaged_designs())
        raise DesignError(
            f"{text!r} is neither a file nor a packaged design. {hint}Packaged designs: {names}. "
            f"A design of your own: give the path of its .toml file; {START}"
        )
    return path


def template(name: str) -> str:
    """Write the text of a complete, commented design file for a new machine.

    Parameters
    ----------
    name : str
        What the machine is called.

    Returns
    -------
    str
        TOML text, in SI units, to be changed by hand.

    See Also
    --------
    flexapod.Hexapod.from_toml : Read such a text.

    Notes
    -----
    The numbers are those of a machine of no special purpose, with a platform of 60 kg.

    Examples
    --------
    >>> fx.Hexapod.from_toml(fx.design.template("my machine")).platform_mass
    60.0
    """
    import tomlkit  # slow to import, and only writing needs it

    text = (_DESIGNS / f"{_TEMPLATE}.toml").read_text(encoding="utf-8")
    return text.replace('name = "template"', f"name = {tomlkit.item(name).as_string()}", 1)


def read_file(path: Path) -> tuple[Values, tuple[ShortForm, ...]]:
    """Values of a design file, and its short forms. Without a name in it, the design is named after the file."""
    try:
        text = bytes_of_file(path).decode("utf-8-sig")
    except DesignError as error:
        raise DesignError(f"{path}: {error}") from None
    except UnicodeDecodeError:
        raise DesignError(f"{path} is not a text file in UTF-8, so no TOML design. {START}") from None
    except OSError as error:
        raise DesignError(f"{path} cannot be read: {error.strerror}. Check the file's permissions.") from error
    try:
        values, forms = read_text(text, path.parent)
    except DesignError as error:
        raise DesignError(f"{path}: {error}") from error
    values.setdefault("name", path.stem.encode(errors="replace").decode())  # a name may be no text, and so not printed
    return values, forms


def self_contained(path: Path) -> str:
    """The text of a design file, with the numbers in place of another file that it names, where that can be read."""
    text = bytes_of_file(path).decode("utf-8-sig", "replace")
    try:
        joints = tables_of(text).get("joints")
        return write_text(*read_file(path)) if isinstance(joints, dict) and "csv" in joints else text
    except DesignError:
        return text


def tables_of(text: str) -> dict[str, Any]:
    """Nested tables of a TOML text that may be a design's. Raises DesignError, also where it is too large for one."""
    if not isinstance(text, str):
        raise DesignError(f"the text of the design is {shown(text)}; it must be text.")
    check_size(len(text))
    check_depth(text)
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # ValueError: wrong TOML, or an integer of thousands of digits
        raise DesignError(f"this is not TOML: {error}. Correct that line; {START}") from None
    check_count(tables)
    return tables


def read_text(text: str, directory: Path | None = None) -> tuple[Values, tuple[ShortForm, ...]]:
    """Values of a design given as TOML text, and its short forms. directory: where the files that it names are."""
    tables = tables_of(text)
    if not tables:
        raise DesignError(f"the design is empty; it must have [base], [platform] and [legs]. {START}")
    values, forms = expand(flatten(tables), directory)
    return complete(values), forms


def write_text(values: Values, forms: Iterable[ShortForm] = ()) -> str:
    """Values as a commented TOML file in SI units, by short forms where these made them.

    Reading it gives the same numbers bit for bit.
    """
    import tomlkit  # slow to import, and only writing needs it

    document = tomlkit.document()
    document.add("name", tomlkit.item(values["name"]))
    for key, value in written(values, forms).items():
        if key == "name":
            continue
        *path, last = key.split(".")
        here: Any = document
        for name in path:
            if name not in here:
                here.add(name, tomlkit.table())
            here = here[name]
        if key in TEXT_KEYS:
            here.add(last, tomlkit.item(value))
            continue
        value = _one_for_all(key, value)
        item = tomlkit.item(value.tolist())
        if value.ndim > 1:
            item.multiline(True)
        rule = rule_of(key)
        unit = printed(si_unit(rule.dimension))
        item.comment(f"{rule.meaning}, {unit}" if unit else rule.meaning)
        here.add(last, item)
    return tomlkit.dumps(document)


def _one_for_all(key: str, value: Any) -> Any:
    """One value where all six legs have the same, else the value itself."""
    per_leg = is_of_each_leg(key) and value.ndim > len(KEYS[key].shapes[0])
    return value[0] if per_leg and (value == value[0]).all() else value
