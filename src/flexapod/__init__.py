"""Flexapod: dynamic stability, vibration and design of flexible 6-UPS Stewart platforms (hexapods).

SI units and rad/s throughout. The everyday names are here; all names are in the packages of their subjects, such as
`flexapod.control.lqg`. A name is loaded when it is first used, so that `import flexapod` is quick.
"""

from flexapod._suggestions import attach
from flexapod.showing import FACE, teach_datasets

__version__ = "0.6.0"

# How results show themselves: the one place that knows library and faces.
FACE.update(html="flexapod.report.notebook", plot="flexapod.plots.results")
teach_datasets()

__getattr__, __dir__, __all__ = attach(__name__, __file__)
