"""What permissions give over all cases."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from synth.retarder.permissions.permission import CasePermissions, Permission


def asked_of(cases: Sequence[CasePermissions]) -> list[Permission]:
    """The permissions that were asked for in some case."""
    return [each for each in Permission if any(case.of(each) for case in cases)]


def median_ratios(cases: Sequence[CasePermissions]) -> dict[str, float]:
    """The median of each permission's ratio over all cases, by its name."""
    return {each.value: median(result.ratio for case in cases if (result := case.of(each))) for each in asked_of(cases)}


def medians(cases: Sequence[CasePermissions]) -> str:
    """The same as a list in words."""
    return ", ".join(f"{name} {ratio:.2f}" for name, ratio in median_ratios(cases).items())
