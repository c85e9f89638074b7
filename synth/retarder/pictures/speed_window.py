"""Which speeds of a case are worth drawing."""

from __future__ import annotations

from synth.retarder.case_result import CaseResult


def speed_window_m_s(case: CaseResult) -> tuple[float, float]:
    """Speeds worth drawing: from somewhat below the target to somewhat above what a cut can reach before braking."""
    highest = max([case.plant.entry.high_m_s, *(float(t.speed_m_s.max()) for t in case.traces)])
    return max(0.0, case.target_speed_m_s - 1.0), highest + 0.4
