"""The end of a tune for point sensors in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path

from synth.cli import case_columns as of
from synth.cli.book_table import places
from synth.frame.terminal.printed_page import Verdict, print_page
from synth.frame.terminal.printed_table import PrintedTable

COLUMNS = (
    of.CASE, of.TARGET, of.RMS, of.UNAVOIDABLE, of.WITHIN_95, of.OUT_OF_BRAKE, of.HONESTY, of.SWITCHINGS, of.TIME,
    of.VERDICT,
)  # fmt: skip

LEGEND = (
    "Unavoidable: what of the rms no table can avoid. 95 of 100 within ±: so many cuts leave within so many m/s "
    "of the target. Out of brake: leaves more than 0.3 m/s too fast even at full brake. Intervals and ± are 95 %."
)


def print_sensors(summary: of.Case, directory: Path) -> None:
    """Print the table of cases, the verdict, and where everything is."""
    cases = summary["cases"]
    rows = [*cases, *map(of.without_table, summary["failed"])]
    tables = (f"tables in {directory / 'tables'}", f"code in {directory / 'c'} and {directory / 'st'}")
    print_page(
        PrintedTable(COLUMNS, rows, "summary.json and the report", summary["title"]),
        f"{cases[0]['simulated']['passes']} stratified passes a case. {LEGEND}",
        Verdict(summary["accepted"], summary["verdict"]),
        places(tables, summary, directory),
    )
