"""The report of a machine at a pose: `gather` its findings, then show them as a page (HTML) or in the terminal."""

from flexapod.report.findings import Findings, as_dict, gather
from flexapod.report.page import page
from flexapod.report.terminal import summary

__all__ = ["Findings", "as_dict", "gather", "page", "summary"]
