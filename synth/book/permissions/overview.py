"""What permissions give over all cases, in one column and one line: the least that tells what to ask for."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Final

from synth.book.permissions.permission import CasePermissions, Permission, PermissionResult

SHORT: Final[Mapping[Permission, str]] = {
    Permission.ANY_TIME: "any time",
    Permission.ESTIMATOR: "estimator",
    Permission.NO_ESTIMATOR: "no estimator",
    Permission.APPROACH: "approach",
    Permission.NO_APPROACH: "no approach",
}
"""What permissions are called above their figures, in the order of those. Without a gauge commands at any time are
rarely asked for: only the line and the report tell of them."""

HINT: Final = "What commands at any time and other permissions of the hardware would give: tune --permissions."
"""Where nobody has asked."""


@dataclass(frozen=True)
class Overview:
    """All cases of a book, at least one."""

    cases: tuple[CasePermissions, ...]

    @property
    def in_column(self) -> tuple[Permission, ...]:
        """What the column tells, in its order."""
        return tuple(each for each in SHORT if any(case.of(each) for case in self.cases))

    @property
    def line(self) -> str:
        """The medians in a sentence, with what bounds the intervals of all figures."""
        if not any(case.results for case in self.cases):
            return f"rms × if permitted: none can be told.{missing(self.cases)}"
        return (
            f"rms × if permitted: rms over that of the table as configured, on the same {self.cases[0].table.passes} "
            f"passes, no 95 % interval wider than ±{self.widest:.2f}. Medians: {medians(self.cases)}."
            f"{missing(self.cases)}"
        )

    @property
    def widest(self) -> float:
        """The wider half of the widest 95 % interval of a ratio, rounded up to two digits; 0 where nothing is told."""
        halves = [half_width(each) for case in self.cases for each in case.results]
        return math.ceil(100.0 * max(halves, default=0.0)) / 100.0


def overview_of(found: Iterable[CasePermissions | None]) -> Overview | None:
    """The overview of the cases that tell of permissions, if any does."""
    told = tuple(each for each in found if each is not None)
    return Overview(told) if told else None


def asked_of(cases: Sequence[CasePermissions]) -> list[Permission]:
    """The permissions that were asked for in some case."""
    return [each for each in Permission if any(case.of(each) for case in cases)]


def median_ratios(cases: Sequence[CasePermissions]) -> dict[str, float]:
    """The median of each permission's ratio over all cases, by its name."""
    return {each.value: median(result.ratio for case in cases if (result := case.of(each))) for each in asked_of(cases)}


def medians(cases: Sequence[CasePermissions]) -> str:
    """The same as a list in words."""
    return ", ".join(f"{name} {ratio:.2f}" for name, ratio in median_ratios(cases).items())


def missing(cases: Iterable[CasePermissions]) -> str:
    """A sentence, after a space, about permissions that cannot be told; nothing where there is none."""
    parts = [part for case in cases for part in case.missing]
    return f" What cannot be told: {'; '.join(parts)}." if parts else ""


def half_width(result: PermissionResult) -> float:
    """The wider half of a ratio's 95 % interval."""
    low, high = result.ratio_ci95
    return max(result.ratio - low, high - result.ratio)
