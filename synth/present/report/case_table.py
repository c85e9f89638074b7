"""The summary table: one row a case."""

from __future__ import annotations

from synth.book.case_result import CaseResult
from synth.book.failed_case import FailedCase
from synth.frame.page.markup import Cell, Markup, head_row, table
from synth.frame.printed_numbers import ABSENT, in_ten_thousand, interval, percent, quotient, quotient_interval, speed
from synth.present.report.book_report import BookReport
from synth.present.report.permissions_section import GROUP, column_cell, column_head
from synth.simulation.exit_statistics import BrakePower, ExitStatistics

HONEST = (0.9, 1.1)
"""Predicted / simulated rms inside this is called honest."""

GROUPS = (
    ("", 1), ("Cut and target", 3), ("Exported table", 4), ("Of the cuts that leave", 4),
    ("Friction known", 2), ("Best baseline", 2), ("Table: risk and effort", 4),
)  # fmt: skip

COLUMNS = (
    "case", "mass, t", "target, m/s", "feasible", "rms, m/s", "95 % interval", "predicted", "predicted / simulated",
    "95 of 100 within ±, m/s", "99 of 100 within ±, m/s", "in 10 000 out of brake", "rms of all others, m/s",
    "rms, m/s", "regret", "which", "rms, m/s", "over-speed, % [95 %]", "stopped inside, % [95 %]", "switchings a pass",
    "time, s [95 %]",
)  # fmt: skip


def case_table(book: BookReport) -> Markup:
    """All cases; infeasible ones, and at the end those without a table, are marked, not left out."""
    rows = [(case_row(case, book.acceptance_rms_m_s), "" if case.feasibility.feasible else "infeasible")
            for case in book.cases]  # fmt: skip
    groups, columns, permissions = list(GROUPS), list(COLUMNS), book.permissions
    if permissions is not None:
        groups.append((GROUP, 1))
        columns.append(column_head(permissions))
        for (cells, _), case in zip(rows, permissions.cases, strict=True):
            cells.append(column_cell(case, permissions))
    rows += [(failed_row(case, len(columns)), "infeasible") for case in book.failed]
    return table("Results by case", (head_row(*groups), head_row(*columns)), rows, kind="cases")


def failed_row(case: FailedCase, columns: int) -> list[str | Cell]:
    """The cells of a case without a table."""
    words = Cell("no table: see the verdict", kind="words")
    return [case.label, ABSENT, f"{case.target_m_s:g}", words, *[ABSENT] * (columns - 4)]


def case_row(case: CaseResult, limit_m_s: float) -> list[str | Cell]:
    """The cells of one case."""
    found = case.comparison
    table, best = found.table.statistics, found.best_baseline
    feasible, power = case.feasibility.feasible, case.brake_power
    over = "bad" if feasible and table.rms_ci95_m_s[0] > limit_m_s else "key"
    ratio, (low, high) = found.table.honesty, found.table.honesty_ci95
    honest = low <= HONEST[1] and high >= HONEST[0]
    return [
        case.label,
        f"{case.plant.cut.mass_t:g}",
        f"{case.target_speed_m_s:g}",
        Cell("yes" if feasible else f"no: {case.feasibility.obstacle}", kind="words"),
        Cell(speed(table.rms_m_s), f"{table.passes} passes, bias {table.bias_m_s:+.3f} m/s", over),
        interval(table.rms_ci95_m_s),
        speed(found.table.predicted_rms_m_s),
        Cell(f"{quotient(ratio, 3)} {quotient_interval((low, high), 3)}", kind="" if honest or not feasible else "bad"),
        f"{speed(table.p95_m_s)} {interval(table.p95_ci95_m_s)}",
        f"{speed(table.p99_m_s)} {interval(table.p99_ci95_m_s)}",
        in_ten_thousand(power.out_of_brake, power.out_of_brake_ci95),
        within_power(power),
        speed(found.friction_known.statistics.rms_m_s),
        f"{quotient(found.regret, 3)} {quotient_interval(found.regret_ci95, 3)}".rstrip(),
        best.name if best else ABSENT,
        speed(best.statistics.rms_m_s) if best else ABSENT,
        share_cell(table.overspeed, table.overspeed_ci95),
        share_cell(table.stalled, table.stalled_ci95),
        f"{table.switchings:.1f}",
        time_cell(table),
    ]


def time_cell(found: ExitStatistics) -> str:
    """The mean time in the position, with its interval."""
    return f"{found.time_s:.2f} {quotient_interval(found.time_ci95_s)}"


def share_cell(share: float, ends: tuple[float, float]) -> str:
    """A probability in per cent, with its interval."""
    return f"{percent(share)} [{percent(ends[0])}, {percent(ends[1])}]"


def within_power(power: BrakePower) -> str:
    """The rms of the cuts within brake power, with its interval."""
    if power.rms_within_m_s is None or power.rms_within_ci95_m_s is None:
        return ABSENT
    return f"{speed(power.rms_within_m_s)} {interval(power.rms_within_ci95_m_s)}"
