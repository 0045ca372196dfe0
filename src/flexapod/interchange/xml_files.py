"""XML: elements whose numbers read back bit for bit."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from typing import Any

import numpy as np


def add(parent: ET.Element, tag: str, **attributes: Any) -> ET.Element:
    """A child element; numbers and arrays become text, None is left out."""
    given = {key: text(value) for key, value in attributes.items() if value is not None}
    return ET.SubElement(parent, tag, given)


def say(parent: ET.Element, tag: str, value: Any) -> ET.Element:
    """A child element with text."""
    element = ET.SubElement(parent, tag)
    element.text = text(value)
    return element


def text(value: Any) -> str:
    """A number or an array as text, with as many digits as it needs."""
    if isinstance(value, str):
        return value
    return " ".join(repr(float(number) + 0.0) for number in np.ravel(value))


def note_left_out(root: ET.Element, left_out: Iterable[str]) -> None:
    """A comment in the file that names what the file leaves out of the design, if anything."""
    words = "; ".join(left_out)
    if words:
        root.append(ET.Comment(f" Not in this file: {words}. "))


def document(root: ET.Element) -> str:
    """The whole XML file."""
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
