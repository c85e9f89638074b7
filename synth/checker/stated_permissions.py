"""What a summary says that permissions of the hardware would give, against the figures that it is made of.

Their tables are written nowhere, so nothing can be simulated anew. But every ratio is one of two stated rms.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, Final

from synth.checker.finding import shown

ROUNDING: Final = 1e-9
"""Relative: both sums of squares are taken over thousands of passes, in another order."""


def permission_faults(case: Mapping[str, Any]) -> Iterator[str]:
    """Where the permissions of a case contradict themselves or its simulated figures; none where none are told."""
    stated = case.get("permissions")
    if stated is None:
        return
    if not isinstance(stated, dict) or not stated:
        yield f"summary.json says of its permissions {shown(stated)}, which are none"
        return
    simulated = case.get("simulated")
    configured = simulated if isinstance(simulated, dict) else {}
    for name, figures in stated.items():
        fault = ratio_fault(figures if isinstance(figures, dict) else {}, configured)
        if fault:
            yield f"summary.json says of its permission {shown(name)} {fault}"


def ratio_fault(figures: Mapping[str, Any], configured: Mapping[str, Any]) -> str | None:
    """What is wrong with the ratio of one permission, if anything is."""
    ends = figures.get("ratio_ci95")
    given: list[Any] = [figures.get("rms_m_s"), configured.get("rms_m_s"), figures.get("ratio")]
    given += ends if isinstance(ends, list) else []
    if len(given) != 5 or not all(map(is_number, given)):
        return "no rms and no ratio with an interval"
    rms, beside, ratio, low, high = given
    if not math.isclose(ratio * beside, rms, rel_tol=ROUNDING):
        return f"a ratio of {shown(ratio)}, but its rms is {shown(rms)} and that of the table {shown(beside)}"
    if not low <= ratio <= high:
        return f"a ratio of {shown(ratio)}, which is outside its interval {shown(ends)}"
    if figures.get("passes") != configured.get("passes"):
        return f"{shown(figures.get('passes'))} passes, but {shown(configured.get('passes'))} of the table"
    return None


def is_number(value: object) -> bool:
    """Whether `value` is a finite number, which a ratio and an rms are."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
