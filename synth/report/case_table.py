"""The summary table: one row a case."""

from __future__ import annotations

from synth.plots.case_names import contest, honesty, why_infeasible
from synth.report.book_report import BookReport
from synth.report.figures import ABSENT, interval, percent, quotient, speed
from synth.report.markup import Cell, Markup, head_row, table
from synth.tuning.case_result import CaseResult

HONEST = (0.9, 1.1)
"""Predicted / simulated rms inside this is called honest."""

GROUPS = (
    ("", 1), ("Cut and target", 3), ("Exported table", 4), ("Full lines", 2), ("Friction known", 2),
    ("Best baseline", 2), ("As published", 3), ("Table: risk and effort", 4),
)  # fmt: skip

COLUMNS = (
    "case", "mass, t", "target, m/s", "feasible", "rms, m/s", "95 % interval", "predicted", "predicted / simulated",
    "rms, m/s", "table loss", "rms, m/s", "regret", "which", "rms, m/s", "predicted", "simulated",
    "predicted / simulated", "p99 of |error|, m/s", "over-speed, % [95 %]", "stalls", "switchings a pass",
)  # fmt: skip


def case_table(book: BookReport) -> Markup:
    """All cases; infeasible ones are marked, not left out."""
    rows = [(case_row(case, book.acceptance_rms_m_s), "" if case.feasibility.feasible else "infeasible")
            for case in book.cases]  # fmt: skip
    return table("Results by case", (head_row(*GROUPS), head_row(*COLUMNS)), rows, kind="cases")


def case_row(case: CaseResult, limit_m_s: float) -> list[str | Cell]:
    """The cells of one case."""
    found = contest(case)
    table, best = found.table.statistics, found.best_baseline
    feasible = case.feasibility.feasible
    over = "bad" if feasible and table.rms_m_s > limit_m_s else "key"
    honest = HONEST[0] <= honesty(found.table) <= HONEST[1]
    low, high = table.overspeed_ci95
    return [
        case.label,
        f"{case.plant.cut.mass_t:g}",
        f"{case.target_speed_m_s:g}",
        Cell("yes" if feasible else f"no: {why_infeasible(case)}", kind="words"),
        Cell(speed(table.rms_m_s), f"{table.passes} passes, bias {table.bias_m_s:+.3f} m/s", over),
        interval(table.rms_ci95_m_s),
        speed(found.table.predicted_rms_m_s),
        Cell(quotient(honesty(found.table), 3), kind="" if honest or not feasible else "bad"),
        speed(found.lines.statistics.rms_m_s),
        quotient(found.table_loss),
        speed(found.known_friction.statistics.rms_m_s),
        quotient(found.regret),
        best.name if best else ABSENT,
        speed(best.statistics.rms_m_s) if best else ABSENT,
        speed(found.published.predicted_rms_m_s),
        speed(found.published.statistics.rms_m_s),
        quotient(honesty(found.published), 3),
        speed(table.p99_m_s),
        f"{percent(table.overspeed)} [{percent(low)}, {percent(high)}]",
        f"{table.stalls} of {table.passes}",
        f"{table.switchings:.1f}",
    ]
