"""What a command writes besides figures."""

from __future__ import annotations

from synth.frame.settings.section import Section, choice


class OutputSettings(Section):
    """What is written besides figures; changes no result and no hash."""

    plots: bool = choice(True, "draw the pictures")
    report: bool = choice(True, "write report.html")
    workbook: bool = choice(False, "write sheets.xlsx, all tables in one workbook")
