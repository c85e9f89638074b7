"""The report of a tune: one self-contained HTML page."""

from synth.present.report.book_report import BookReport
from synth.present.report.page import report_page, write_report

__all__ = ["BookReport", "report_page", "write_report"]
