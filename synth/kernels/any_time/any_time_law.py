"""Kernel of a law that is asked at every sample, whatever the drive is doing."""

from __future__ import annotations

from typing import NamedTuple

from synth.kernels.compiling import part
from synth.kernels.loop.regulator import Rule, stage_by_lines, stage_by_table


class AnyTimeLaw(NamedTuple):
    """What is asked at every sample: a rule of the locked loop.

    The gauge shows `gauge_factor` times the true pressure; NaN: it shows none.
    """

    rule: Rule
    gauge_factor: float


@part
def wanted_stage(law: AnyTimeLaw, stage: int, top: int, pressure: float, s: float, v: float) -> int:
    """The stage that is wanted at a sample, within 0 … `top`; `v` is the speed that the regulator knows."""
    by = law.rule
    if by.table.stages > 0:
        by_table: int = stage_by_table(by.table, stage, s, v, pressure * law.gauge_factor)
        return by_table
    wanted: int = stage_by_lines(by.lower, by.upper, by.start_m, by.spacing_m, by.farthest, stage, top, s, v)
    return wanted
