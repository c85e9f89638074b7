"""What every table of cases holds besides simulated figures: which case it is, and what its table promises."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Final, Protocol

from plant_models import Plant
from synth.frame.exhibits import Column, Exhibit, Row, Table
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals
from synth.retarder.acceptance import CaseVerdict
from synth.retarder.exit_figures import told
from synth.retarder.failed_case import FailedCase
from synth.simulation.unavoidable_error import UnavoidableError
from tuning_tables import ControllerTable
from tuning_tables.passages.passage_table import PassageTable

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

FAILED: Final = (
    Column("label", "case", words=True),
    Column("target_m_s", "target", "m/s"),
    Column("reason", "reason", words=True),
)
NO_TABLE: Final = "no table"


class Polished(Protocol):
    """What every polish tells."""

    @property
    def cost_before(self) -> float:
        """Of the lines that it began with, m²/s²."""
        ...

    @property
    def cost_after(self) -> float:
        """Of those that it found."""
        ...

    @property
    def evaluations(self) -> int:
        """How often the cost was asked for."""
        ...

    @property
    def converged(self) -> bool:
        """Whether it ended well."""
        ...

    @property
    def status(self) -> str:
        """How it ended, in words."""
        ...


def polish_row(polish: Polished) -> Row:
    """The figures of `POLISH`."""
    return {
        "converged": polish.converged,
        "status": polish.status,
        "evaluations": polish.evaluations,
        "cost_before_m2_s2": polish.cost_before,
        "cost_after_m2_s2": polish.cost_after,
    }


def key_row(label: str, plant: Plant, table: ControllerTable | PassageTable, verdict: CaseVerdict) -> Row:
    """Which case it is, what its table says of itself, and what the case comes to."""
    return {
        "label": label,
        "target_speed_m_s": table.target_speed_m_s,
        "id": table.id,
        "category": plant.cut.category,
        "mass_t": plant.cut.mass_t,
        "top_stage": plant.top_stage,
        "verdict": verdict.word,
        "why_infeasible": verdict.obstacle or None,
        **promise_row(table),
    }


def promise_row(table: ControllerTable | PassageTable) -> Row:
    """What a table says of itself."""
    return {f"predicted_{key}": value for key, value in asdict(table.predicted).items()}


def failed_rows(failed: Sequence[FailedCase]) -> list[Row]:
    """Rows without figures for cases without a table."""
    return [{"label": each.label, "target_speed_m_s": each.target_m_s, "verdict": NO_TABLE} for each in failed]


def failed_cases(failed: Sequence[FailedCase]) -> Iterator[Exhibit]:
    """Why they have none; nothing where all have one."""
    if failed:
        yield Table("failed", "Cases without a table", FAILED, [asdict(case) for case in failed])


def is_outside(row: Row) -> bool:
    """Whether a case takes no part in the verdict, or has no table."""
    return row["verdict"] in ("infeasible", NO_TABLE)


def unavoidable(found: UnavoidableError, passes: int) -> Interval | None:
    """The rms that no regulator avoids."""
    return told(found.rms_m_s, found.rms_ci95_m_s, passes)
