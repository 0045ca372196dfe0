"""The reference of the public Python names, from their docstrings: a page for each topic, and one that lists them all.

A topic is a list of the package's modules, so a new public name of a module that is there appears by itself, and a new
module that belongs to no topic stops the build.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import flexapod

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files


class Topic(NamedTuple):
    title: str
    about: str
    modules: tuple[str, ...]


TOPICS = {
    "designs": Topic("Designs", "A machine: read, checked, changed, written.", ("hexapod", "units", "schema")),
    "kinematics": Topic("Poses and kinematics", "Where the platform is, and what the legs do.", ("pose", "kinematics")),
    "dynamics": Topic("Dynamics and statics", "Forces, motions and energies at one state.", ("dynamics", "statics")),
    "modes": Topic("Modes and the tangent", "Free vibration about a pose.", ("modal", "linear")),
    "workspace": Topic("Workspace", "Many poses at once.", ("posesets", "sweeps")),
    "simulation": Topic(
        "Simulation",
        "The complete machine in time, and what drives it.",
        ("excitation", "recordings", "trajectory", "simulation", "animate"),
    ),
    "vibration": Topic("Vibration", "Response by frequency, and random motion.", ("spectra", "response", "stepped")),
    "optimal-design": Topic("Optimal design", "Searches, trade-offs and uncertainty.", ("optimal", "robust")),
    "paths": Topic("Paths", "Motions through the workspace.", ("waypoints", "path", "requirements", "planning")),
    "control": Topic(
        "Control",
        "Laws, their poles, and the machine under them.",
        (
            "sampling",
            "feedback",
            "laws",
            "assessment",
            "position_loops",
            "damping_loops",
            "isolators",
            "sampled",
            "schedule",
        ),
    ),
    "interchange": Topic(
        "Exchange with other tools", "The same machine in other tools' formats.", ("jointfile", "interchange")
    ),
    "errors": Topic("Errors", "All of them are `FlexapodError`.", ("errors",)),
}


def names_of(topic: Topic) -> list[str]:
    """The public names of a topic, in the order of its modules."""
    homes = [home for module in topic.modules for home in flexapod._HOMES if home.split(".")[0] == module]
    return [name for home in homes for name in flexapod._HOMES[home]]


def unplaced() -> set[str]:
    """Public names that no topic shows."""
    shown = {name for topic in TOPICS.values() for name in names_of(topic)}
    return set(flexapod.__all__) - shown - {"__version__"}


def page(topic: Topic) -> str:
    names = names_of(topic)
    return f"# {topic.title}\n\n{topic.about}\n\n" + "\n\n".join(f"::: flexapod.{name}" for name in names) + "\n"


def index() -> str:
    """All names by topic, with the first line of what each says."""
    lines = ["# Python", "", "`import flexapod as fx` gives all of these. SI units and rad/s throughout.", ""]
    for file, topic in TOPICS.items():
        lines += [f"## [{topic.title}]({file}.md)", "", topic.about, "", "| name | what it is |", "|---|---|"]
        lines += [f"| [`{name}`][flexapod.{name}] | {_first_line(name)} |" for name in names_of(topic)]
        lines.append("")
    return "\n".join(lines)


def _first_line(name: str) -> str:
    first = (getattr(flexapod, name).__doc__ or "").strip().split("\n\n")[0]
    return " ".join(first.split()).replace("|", "\\|")


def pages() -> Iterator[tuple[str, str]]:
    yield "api/index.md", index()
    for file, topic in TOPICS.items():
        yield f"api/{file}.md", page(topic)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    from mkdocs.exceptions import PluginError
    from mkdocs.structure.files import File

    if missing := unplaced():
        raise PluginError(
            f"docs/_hooks/reference.py: no topic has the modules of {sorted(missing)}; add them to TOPICS"
        )
    for path, content in pages():
        files.append(File.generated(config, path, content=content))
    return files
