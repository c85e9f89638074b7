"""The end of a tune in words and figures, on stdout."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from synth.cli import case_columns as of
from synth.frame.printed_numbers import plus_minus
from synth.frame.terminal.printed_page import Exhibit, Verdict, print_page
from synth.frame.terminal.printed_table import Column, PrintedTable

if TYPE_CHECKING:
    from synth.book.permissions.overview import Overview

LEGEND = (
    "95 of 100 within ±: so many cuts leave within so many m/s of the target. Out of brake: leaves more than 0.3 m/s "
    "too fast whatever a table does. Intervals and ± are 95 %."
)

NO_REGRET = (
    "No regret is told where the regulator that is told the friction is beaten by one that is not: it is no reference "
    "there."
)


def print_book(summary: of.Case, directory: Path, permissions: Overview | None, lines: Sequence[str]) -> None:
    """Print the cases, `lines` of what else was asked for, what is infeasible, the verdict, and where everything is."""
    cases = summary["cases"]
    columns, rows = columns_of(cases, permissions), [*cases, *map(of.without_table, summary["failed"])]
    page: list[Exhibit] = [PrintedTable(columns, rows, "summary.json and the report", summary["title"])]
    if cases:
        page.append(f"{cases[0]['simulated']['passes']} stratified passes a case. {LEGEND}")
    if any(case.get("simulated") and case["regret"] is None for case in cases):
        page.append(NO_REGRET)
    page += filter(None, lines)
    page += (f"infeasible: {infeasible(case)}" for case in cases if not case["feasible"])
    page.append(Verdict(summary["accepted"], summary["verdict"]))
    tables = (f"tables in {directory / 'tables'}", f"book {directory / 'book.h5'}")
    print_page(*page, places(tables, summary, directory))


def columns_of(cases: Sequence[of.Case], permissions: Overview | None) -> tuple[Column[of.Case], ...]:
    """The columns of the table of cases, with one for each permission that was asked for."""
    at_any_time = any(case.get("at_rest_ratio") is not None for case in cases)
    asked = permissions.in_column if permissions else ()
    return (
        of.CASE, of.TARGET, of.RMS, of.WITHIN_95, of.WITHIN_99, of.OUT_OF_BRAKE, of.HONESTY,
        *[of.AT_REST] * at_any_time, of.REGRET, of.BEST_BASELINE, of.SWITCHINGS, of.TIME,
        *map(of.permission_column, asked), of.VERDICT,
    )  # fmt: skip


def places(tables: Sequence[str], summary: of.Case, directory: Path) -> str:
    """Where `tables` are, and the pictures and the report that the summary lists."""
    pictures = [f"pictures in {directory / 'plots'}"] * any(name.startswith("plots/") for name in summary["files"])
    report = [f"report {directory / 'report.html'}"] * ("report.html" in summary["files"])
    return " · ".join((*tables, *pictures, *report))


def infeasible(case: of.Case) -> str:
    """What of an infeasible case can be served."""
    served, entry = case["served_entry_m_s"], case["entry_m_s"]
    least = plus_minus(case["unavoidable_rms_m_s"], case["unavoidable_ci95_m_s"], 4)
    part = (
        f"entry speeds from {served[0]:.2f} to {served[1]:.2f} m/s can be served" if served else "no entry speed can be"
    )
    return (
        f"{case['label']} to {case['target_speed_m_s']:g} m/s, {case['why_infeasible']}; {part}, "
        f"of the {entry[0]:g} to {entry[1]:g} m/s asked for, where the rms that no regulator avoids is {least} m/s"
    )
