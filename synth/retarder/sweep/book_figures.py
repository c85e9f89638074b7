"""What is known of the book of a condition: small figures of each of its tables, and what has failed."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from synth.frame.exhibits import Row
from synth.retarder.exit_figures import table_row
from synth.retarder.shown.cases import promise_row
from synth.retarder.sweep.plan import Gap
from synth.retarder.sweep.sweep_file import Condition
from synth.retarder.sweep.unit_result import Row as UnitRow
from tuning_tables import ControllerTable


@dataclass(frozen=True)
class Failure:
    """A unit without a result, or one target of it without a table, and why, in one sentence."""

    condition: str
    label: str
    reason: str
    target_m_s: float | None = None

    @property
    def name(self) -> str:
        """What has failed, as a person would call it."""
        target = "" if self.target_m_s is None else f" to {self.target_m_s:g} m/s"
        return f"{self.condition}/{self.label}".lstrip("/") + target


@dataclass(frozen=True)
class BookFigures:
    """What is known of the book of a condition.

    `cases`: a row of figures a table; `gaps`: a row for each gap between two targets that was measured; `shadowed`:
    tables that no choice by category and axles can reach; `no_code`: why the book makes no controller code, if so.
    """

    condition: Condition
    cases: tuple[Row, ...] = ()
    gaps: tuple[Row, ...] = ()
    failures: tuple[Failure, ...] = ()
    shadowed: int = 0
    no_code: str = ""

    @property
    def failed_classes(self) -> int:
        """Classes without any table."""
        return sum(failure.target_m_s is None for failure in self.failures)

    @property
    def refused_targets(self) -> int:
        """Targets without a table, of the other classes."""
        return len(self.failures) - self.failed_classes

    @property
    def missing_a_limit(self) -> int:
        """Tables that miss a limit of [acceptance]."""
        return sum(bool(case["missed_limits"]) for case in self.cases)

    @property
    def highest_loss_m_s(self) -> float | None:
        """Of the gaps that were left open; None where none was measured."""
        return max((gap["loss_m_s"] for gap in self.gaps if not gap["refined"]), default=None)


def case_row(condition: Condition, label: str, row: UnitRow, table: ControllerTable) -> Row:
    """One table's figures, by the keys that the table of cases of a tune has."""
    return {
        "condition": condition.name or None,
        "id": table.id,
        "label": label,
        "category": table.cut.category,
        "mass_t": table.cut.mass_t,
        "target_speed_m_s": table.target_speed_m_s,
        "missed_limits": row.judgement.missed,
        "undecided_limits": row.judgement.undecided,
        **promise_row(table),
        **table_row(row.statistics, row.brake_power, table.predicted),
    }


def gap_row(condition: Condition, label: str, gap: Gap) -> Row:
    """One gap's figures."""
    return {
        "condition": condition.name or None,
        "label": label,
        **asdict(gap),
        "middle_m_s": gap.middle_m_s,
        "loss_m_s": gap.loss_m_s,
    }
