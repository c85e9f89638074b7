"""The report of a tune: one self-contained HTML page."""

from synth.present.report.book_report import BookReport
from synth.present.report.page import report_page

__all__ = ["BookReport", "report_page"]
