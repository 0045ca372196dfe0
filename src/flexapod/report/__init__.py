"""Reports: studies as data, with one renderer for the terminal, one for pages, and one for JSON.

    report.gather(hexapod, pose)     # in a notebook: the report of the machine
    report.page(report.study(report.gather(hexapod, pose)))

May import: design, mechanics, workspace, certificates, simulation, paths, optimisation, control, plots, paper.
"""

from flexapod._suggestions import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
