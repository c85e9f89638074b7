"""What is shown of the cases of every tune: what a yard engineer asks first (what is kept, how near cuts leave, what to
do next), a row for each, how its table was found, and all doubts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from statistics import median
from typing import Final

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table, Tile, Tiles
from synth.frame.printed_numbers import counted, decimals
from synth.retarder.acceptance import CaseVerdict, FoundBook, advice_of
from synth.retarder.exit_figures import LEGEND, table_row, told
from synth.retarder.tuned_case import Case, TunedCase
from tuning_tables.document import StageTable

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


MILLIMETRES: Final = decimals(3)
"""A speed to a millimetre a second: what a reader at a glance can use."""


def tiles(found: FoundBook[Case]) -> Tiles:
    """The main figures."""
    near = (near_tile(found), worst_tile(found)) if found.feasible else ()
    return Tiles((kept_tile(found), *near, *weak_tiles(found)))


def kept_tile(found: FoundBook[Case]) -> Tile:
    """How many tables keep all limits."""
    asked = len(found.book.cases) + len(found.book.failed)
    kept = sum(verdict.word == "accepted" for verdict in found.verdicts)
    open_ones = any(verdict.word == "not decidable" for verdict in found.verdicts)
    missed = bool(found.book.failed) or any(verdict.word == "missed" for verdict in found.verdicts)
    told = "tables (cut class and exit speed) keep all limits"
    return Tile(f"{kept} of {asked}", told, False if missed else None if open_ones or not kept else True)


def near_tile(found: FoundBook[Case]) -> Tile:
    """How near to the commanded speed cuts leave."""
    near = [case.statistics.p95_m_s for case in found.feasible]
    words = (
        f"of the commanded speed leave 95 of 100 cuts: median of {counted(len(near), 'table')}, from "
        f"±{MILLIMETRES(min(near))} to ±{MILLIMETRES(max(near))}"
    )
    return Tile(f"±{MILLIMETRES(median(near))} m/s", words)


def worst_tile(found: FoundBook[Case]) -> Tile:
    """The largest rms error beside its limit."""
    limit = found.book.config.acceptance.rms_m_s
    worst = max(found.feasible, key=lambda case: case.statistics.rms_m_s)
    low, high = worst.statistics.rms_ci95_m_s
    kept = True if high <= limit else False if low > limit else None
    words = f"is the largest rms error ({worst.label} to {worst.target_speed_m_s:g} m/s); allowed is {limit:g} m/s"
    return Tile(f"{MILLIMETRES(worst.statistics.rms_m_s)} m/s", words, kept)


def weak_tiles(found: FoundBook[Case]) -> Iterator[Tile]:
    """For how many cases no controller would do, where there are some."""
    weak = [case for case, verdict in found.judged if not verdict.feasible]
    if weak:
        names = ", ".join(f"{case.label} to {case.target_speed_m_s:g} m/s" for case in weak)
        yield Tile(str(len(weak)), f"for {names} no controller keeps the limit: the position itself cannot")


def to_do(found: FoundBook[Case]) -> Iterator[Sentence]:
    """Steps, the most urgent first; the terminal has what follows from the verdict."""
    if advice := advice_of(found.verdicts):
        yield Sentence(advice, brief=True, to_do=True)
    for step in next_steps(found):
        yield Sentence(step, to_do=True)


def next_steps(found: FoundBook[Case]) -> Iterator[str]:
    """What is to be done with every book."""
    parameters = found.book.config.parameters
    assumed = sum(each.assumed for each in parameters)
    if assumed:
        yield (
            f"Measure your retarder: {assumed} of {counted(len(parameters), 'parameter')} are assumed, and every "
            "figure here depends on them. 'retarder-synth sensitivity' tells which to measure first, 'retarder-synth "
            "identify' reads them from logs."
        )
    yield "Check the tables with the independent program: retarder-synth verify DIR."
    yield "Load tables/*.json or the code in c/ into the control computer, and try it on the track."
