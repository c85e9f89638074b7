"""What cases and their controllers are called in pictures and reports, and how they are grouped."""

from __future__ import annotations

from collections.abc import Iterable

from synth.retarder.case_result import CaseResult


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
