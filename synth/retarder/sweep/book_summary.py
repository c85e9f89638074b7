"""summary.json of a sweep's books, in the form of that of a tune so far as a sweep knows it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from importlib.metadata import version
from statistics import median
from typing import Any

from synth.frame.summary import plain, summary_head
from synth.retarder.configured import head_of
from synth.retarder.exit_figures import table_row
from synth.retarder.shown.cases import promise_row
from synth.retarder.sweep.refinement import Gap
from synth.retarder.sweep.sweep_file import Condition
from synth.retarder.sweep.unit_result import Row
from tuning_tables import ControllerTable
from tuning_tables.canonical import canonical_json

Document = dict[str, Any]


@dataclass(frozen=True)
class Failure:
    """A unit without a result, or one target of it without a table, and why, in one sentence."""

    key: str
    condition: str
    label: str
    reason: str
    target_m_s: float | None = None

    @property
    def name(self) -> str:
        """What has failed, as a person would call it."""
        target = "" if self.target_m_s is None else f" to {self.target_m_s:g} m/s"
        return f"{self.condition}/{self.label}".lstrip("/") + target


@dataclass
class BookFigures:
    """What is collected while the book of a condition is bound: small figures, no tables."""

    condition: Condition
    cases: list[Document] = field(default_factory=list)
    gaps: list[tuple[str, Gap]] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
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


def case_of(label: str, row: Row, table: ControllerTable) -> Document:
    """One table's figures, keys as in the summary of a tune."""
    return {
        "id": table.id,
        "label": label,
        "category": table.cut.category,
        "mass_t": table.cut.mass_t,
        "target_speed_m_s": table.target_speed_m_s,
        "missed_limits": list(row.judgement.missed),
        "undecided_limits": list(row.judgement.undecided),
        **promise_row(table),
        **table_row(row.statistics, row.brake_power, table.predicted),
    }


def book_summary(figures: BookFigures, created: str) -> bytes:
    """summary.json of one book. `accepted` is null: without a bound for each case a sweep cannot judge any."""
    config = figures.condition.config
    document = {
        **summary_head("sweep", head_of(config), created),
        "condition": figures.condition.name or None,
        "accepted": None,
        "limits": [{"sentence": verdict(figures), "kept": None}],
        "criterion": config.criterion.sentence,
        "tables": {
            "cases": figures.cases,
            "interpolation": interpolation(figures.gaps),
            "failed": [asdict(failure) for failure in figures.failures],
        },
        "shadowed_tables": figures.shadowed,
        "no_controller_code": figures.no_code or None,
        "files": figures.files,
    }
    return canonical_json(plain(document)) + b"\n"


def verdict(figures: BookFigures) -> str:
    """What can be said of the book in one sentence."""
    missed = sum(bool(case["missed_limits"]) for case in figures.cases)
    failed = f"; {figures.failed_classes} of the classes failed and are not in it" if figures.failed_classes else ""
    if figures.refused_targets:
        failed += f"; targets without a table: {figures.refused_targets}"
    return (
        f"a sweep judges no table, for it does not know which cases are feasible; {missed} of {len(figures.cases)} "
        f"tables miss a limit of [acceptance]{failed}"
    )


def interpolation(gaps: list[tuple[str, Gap]]) -> Document | None:
    """What lines between two tables lose at the middle; None where it was not measured."""
    if not gaps:
        return None
    left = [gap for _, gap in gaps if not gap.refined]
    return {
        "gaps": [
            {"label": label, **asdict(gap), "middle_m_s": gap.middle_m_s, "loss_m_s": gap.loss_m_s}
            for label, gap in gaps
        ],
        "highest_loss_m_s": max(gap.loss_m_s for gap in left),
    }


def sweep_summary(books: list[BookFigures], created: str) -> Document:
    """The figures of the whole sweep, plain values."""
    return {
        "format": "retarder-sweep-summary",
        "version": 1,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth")},
        "title": books[0].condition.config.title,
        "tables": sum(len(book.cases) for book in books),
        "failed": [asdict(failure) for book in books for failure in book.failures],
        "conditions": [condition_of(book) for book in books],
    }


def condition_of(book: BookFigures) -> Document:
    """The figures of one condition."""
    rms = [case["rms_m_s"].value for case in book.cases]
    measured = interpolation(book.gaps)
    return {
        "name": book.condition.name or None,
        "config_sha256": book.condition.config.sha256,
        "classes": len(book.condition.config.cuts),
        "tables": len(book.cases),
        "failed": book.failed_classes,
        "refused_targets": book.refused_targets,
        "median_rms_m_s": median(rms) if rms else None,
        "highest_rms_m_s": max(rms, default=None),
        "missing_a_limit": sum(bool(case["missed_limits"]) for case in book.cases),
        "highest_interpolation_loss_m_s": measured["highest_loss_m_s"] if measured else None,
        "shadowed_tables": book.shadowed,
        "no_controller_code": book.no_code or None,
        "files": {f"{book.condition.name}/{name}".lstrip("/"): sha for name, sha in book.files.items()},
    }
