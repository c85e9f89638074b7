"""What is shown of the cases of every tune: a row for each, how its table was found, and all doubts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals
from synth.retarder.acceptance import CaseVerdict
from synth.retarder.exit_figures import LEGEND, table_row, told
from synth.retarder.found_book import FoundBook
from synth.retarder.tuned_case import Case, TunedCase
from tuning_tables.table_kinds import StageTable

UNAVOIDABLE: Final = Column("unavoidable_rms_m_s", "unavoidable", "m/s", decimals(4), spare=2)
VERDICT: Final = Column("verdict", "verdict", words=True)
IDENTITY: Final = (
    Column("id", "table", words=True, detail=True),
    Column("category", "category", detail=True),
    Column("mass_t", "mass", "t", detail=True),
)
KEYS: Final = (
    *IDENTITY,
    Column("top_stage", "highest stage", detail=True),
    Column("why_infeasible", "why infeasible", words=True, detail=True),
)
PROMISE: Final = (
    Column("predicted_bias_m_s", "predicted mean error", "m/s", decimals(4), detail=True),
    Column("predicted_p_overspeed", "predicted over-speed", detail=True),
    Column("predicted_p_stall", "predicted stops", detail=True),
    Column("predicted_switchings", "predicted switchings", detail=True),
    Column("predicted_passes", "passes of the prediction", detail=True),
)
"""What a table says of itself, besides its rms."""

POLISH: Final = (
    Column("converged", "polish converged"),
    Column("evaluations", "evaluations"),
    Column("cost_before_m2_s2", "cost before", "m²/s²"),
    Column("cost_after_m2_s2", "cost after", "m²/s²"),
    Column("status", "how it ended", words=True),
)
"""How the search for the lines, surfaces or speeds of least cost ended."""

ESCAPED: Final = Column("escaped_probability", "left the grid", form="{:.1e}".format)

FAILED: Final = (
    Column("label", "case", words=True),
    Column("target_m_s", "target", "m/s"),
    Column("reason", "reason", words=True),
)
NO_TABLE: Final = "no table"


def cases_table(
    found: FoundBook[Case], columns: Sequence[Column], row: Callable[[Case, CaseVerdict], Row]
) -> Iterator[Exhibit]:
    """A `row` for each case, one without figures for each that has no table, and why these have none."""
    failed = found.book.failed
    rows = [row(case, verdict) for case, verdict in found.judged]
    rows += [{"label": each.label, "target_speed_m_s": each.target_m_s, "verdict": NO_TABLE} for each in failed]
    yield Table("cases", found.book.config.title, columns, rows, True, is_outside)
    if failed:
        yield Table("failed", "Cases without a table", FAILED, [asdict(case) for case in failed])


def is_outside(row: Row) -> bool:
    """Whether a case takes no part in the verdict, or has no table."""
    return row["verdict"] in ("infeasible", NO_TABLE)


def passes_told(cases: Sequence[TunedCase]) -> str:
    """How many passes, and what the columns are."""
    return f"{cases[0].statistics.passes} stratified passes a case. {LEGEND}"


def identity_row(case: TunedCase) -> Row:
    """Which case it is: the figures of `CASE`."""
    return {"label": case.label, "target_speed_m_s": case.target_speed_m_s}


def case_row(case: TunedCase, verdict: CaseVerdict) -> Row:
    """What is told of every case: which it is, its closed loop, what its table says, and what it comes to."""
    found, least = case.statistics, case.unavoidable
    return {
        **identity_row(case),
        "id": case.table.id,
        "category": case.plant.cut.category,
        "mass_t": case.plant.cut.mass_t,
        "top_stage": case.plant.top_stage,
        "verdict": verdict.word,
        "why_infeasible": verdict.obstacle or None,
        **promise_row(case.table),
        **table_row(found, case.brake_power, case.table.predicted),
        "unavoidable_rms_m_s": told(least.rms_m_s, least.rms_ci95_m_s, found.passes),
    }


def promise_row(table: StageTable) -> Row:
    """What a table says of itself."""
    return {f"predicted_{key}": value for key, value in asdict(table.predicted).items()}


def design_row(case: TunedCase) -> Row:
    """How the table of a case was found: the figures of `CASE`, `POLISH` and `ESCAPED`."""
    polish = case.polish
    return {
        **identity_row(case),
        "converged": polish.converged,
        "status": polish.status,
        "evaluations": polish.evaluations,
        "cost_before_m2_s2": polish.cost_before,
        "cost_after_m2_s2": polish.cost_after,
        "escaped_probability": case.predicted.escaped,
    }


def doubts(cases: Sequence[TunedCase]) -> Iterator[Exhibit]:
    """All warnings."""
    for case in cases:
        yield from (Sentence(f"Warning for {case.name}: {warning}.") for warning in case.warnings)
