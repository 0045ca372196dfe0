"""The reference of the public Python names, from their docstrings: a page for each package, and a list of all.

The packages, their names and what each is for are read from the library, so that a new name appears by itself.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

import flexapod

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files


def packages() -> list[str]:
    """The packages of subjects, those that import fewest others first, and the errors."""
    names = [name for name in flexapod.__all__ if hasattr(getattr(flexapod, name), "__path__")]
    others = {name: (import_module(f"flexapod.{name}").__doc__ or "").partition("May import: ")[2] for name in names}
    return [*sorted(names, key=lambda name: (others[name].count(","), name)), "errors"]


def _package(name: str) -> ModuleType:
    return flexapod if name == "top" else import_module(f"flexapod.{name}")


def names_of(package: str) -> list[str]:
    """Full names of what a page shows, without `flexapod.` in front; each is on the page of its own package."""
    if package == "errors":
        module = import_module("flexapod.errors")
        names = sorted(
            name for name, thing in vars(module).items() if isinstance(thing, type) and issubclass(thing, BaseException)
        )
        return [name if name in flexapod.__all__ else f"errors.{name}" for name in names]
    if package == "top":
        return [name for name in flexapod.__all__ if _home(name) == "pose"]
    inside = [
        name for name in _package(package).__all__ if not isinstance(getattr(_package(package), name), ModuleType)
    ]
    names = [name if name in flexapod.__all__ else f"{package}.{name}" for name in inside]
    return names + [f"{package}.{module}.{name}" for module in _modules(package) for name in _defined(package, module)]


def _home(name: str) -> str:
    """The folder or module directly below flexapod where a name of the top is defined."""
    thing = getattr(flexapod, name)
    return "" if isinstance(thing, ModuleType) else getattr(thing, "__module__", "").split(".")[1]


def thing(name: str) -> object:
    """What stands behind `natural_modes` or `control.lqg`."""
    found: object = flexapod
    for part in name.split("."):
        found = getattr(found, part)
    return found


def about(package: str) -> str:
    doc = "Where a body is and how it moves." if package == "top" else (_package(package).__doc__ or "")
    return doc.strip().split("\n\n")[0].replace("\n", " ")


def title(package: str) -> str:
    return "Poses and motions" if package == "top" else package.capitalize()


def file(package: str) -> str:
    return f"api/{'pose' if package == 'top' else package}.md"


def page(package: str) -> str:
    shown = "\n\n".join(f"::: flexapod.{name}" for name in names_of(package))
    extra = "" if package != "plots" else "\n\n" + "\n\n".join(f"::: flexapod.plots.{name}" for name in _figures())
    return f"# {title(package)}\n\n{about(package)}\n\n{shown}{extra}\n"


def _modules(package: str) -> list[str]:
    """The modules that a package shows by name, but for those of figures, which are shown as a whole."""
    if package == "plots":
        return []
    place = _package(package)
    return [name for name in place.__all__ if isinstance(getattr(place, name), ModuleType)]


def _defined(package: str, module: str) -> list[str]:
    """The functions and classes of such a module."""
    place = getattr(_package(package), module)
    return [
        name
        for name, found in vars(place).items()
        if not name.startswith("_") and getattr(found, "__module__", "") == place.__name__
    ]


def _figures() -> list[str]:
    """The modules of figures, which are public as a whole."""
    plots = _package("plots")
    return [name for name in plots.__all__ if isinstance(getattr(plots, name), ModuleType)]


def index() -> str:
    """All names by package, with the first line of what each says."""
    lines = ["# Python", "", "`import flexapod as fx` gives all of these. SI units and rad/s throughout.", ""]
    for package in ("top", *packages()):
        lines += [
            f"## [{title(package)}]({file(package)[4:]})",
            "",
            about(package),
            "",
            "| name | what it is |",
            "|---|---|",
        ]
        lines += [f"| [`{name}`][flexapod.{name}] | {_first_line(name)} |" for name in names_of(package)]
        lines.append("")
    return "\n".join(lines)


def _first_line(name: str) -> str:
    first = (thing(name).__doc__ or "").strip().split("\n\n")[0]
    return " ".join(first.split()).replace("|", "\\|")


def pages() -> Iterator[tuple[str, str]]:
    yield "api/index.md", index()
    for package in ("top", *packages()):
        yield file(package), page(package)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    from mkdocs.structure.files import File

    for path, content in pages():
        files.append(File.generated(config, path, content=content))
    return files
