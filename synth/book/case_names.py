"""What cases and their controllers are called in pictures and reports, and how they are grouped."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from synth.book.case_result import CaseResult
from synth.book.comparison.measured import Measured


@dataclass(frozen=True)
class Contest:
    """The comparison of a case by role."""

    table: Measured
    lines: Measured
    published: Measured
    known_friction: Measured
    baselines: tuple[Measured, ...]
    without_estimator: Measured | None = None

    @property
    def entries(self) -> tuple[Measured, ...]:
        """All controllers, in the order of `CaseResult.comparison`."""
        last = () if self.without_estimator is None else (self.without_estimator,)
        return (self.table, self.lines, self.published, self.known_friction, *self.baselines, *last)

    @property
    def best_baseline(self) -> Measured | None:
        """The baseline of least rms, None if there is none."""
        return min(self.baselines, key=lambda entry: entry.statistics.rms_m_s, default=None)

    @property
    def regret(self) -> float:
        """rms of the table / rms of the friction-known bound."""
        return self.known_friction.table_ratio

    @property
    def table_loss(self) -> float:
        """rms of the table / rms of the full switching lines."""
        return self.lines.table_ratio


def contest(case: CaseResult) -> Contest:
    """The comparison of `case` by role, taken from the order of `CaseResult.comparison`.

    The prediction of the formulation as published is the one that the case itself states.
    """
    table, lines, published, known, *baselines = case.comparison
    published = replace(published, predicted_rms_m_s=case.published_predicted_rms_m_s)
    without = baselines.pop() if case.estimate is not None else None
    return Contest(table, lines, published, known, tuple(baselines), without)


def target_name(case: CaseResult) -> str:
    """The commanded exit speed in words."""
    return f"target {case.target_speed_m_s:g} m/s"


def case_name(case: CaseResult) -> str:
    """Cut class and target in one line."""
    return f"{case.label}, {target_name(case)}"


def cut_name(case: CaseResult) -> str:
    """Cut class with what matters of the cut: category, mass, axles."""
    cut = case.plant.cut
    return f"{case.label} (category {cut.category}, {cut.mass_t:g} t, {cut.axles} axles)"


def file_stem(*parts: str) -> str:
    """A file name from words: lower case, letters and digits of any script kept, the rest one hyphen."""
    text = "".join(c if c.isalnum() or c == "." else " " for c in " ".join(parts).lower())
    return "-".join(text.split())


def by_class(cases: Iterable[CaseResult]) -> tuple[tuple[CaseResult, ...], ...]:
    """The cases of each cut class, in the order in which the classes first appear."""
    groups: dict[str, list[CaseResult]] = {}
    for case in cases:
        groups.setdefault(case.label, []).append(case)
    return tuple(tuple(group) for group in groups.values())


def why_infeasible(case: CaseResult) -> str:
    """What stands in the way of an infeasible case, in three words."""
    too_fast = contest(case).known_friction.statistics.bias_m_s > 0.0
    return "out of brake power" if too_fast else "leaves too slow"
