"""The error of integration: passes whose differences are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from synth.simulation.passes import PassTrace
from synth.studies.integration_error import commands_of, compared


def trace(exit_m_s: float, stages: list[int]) -> PassTrace:
    n = len(stages)
    return PassTrace(
        time_s=np.arange(float(n)) * 0.1,
        path_m=np.arange(float(n)),
        speed_m_s=np.full(n, exit_m_s),
        overpressure_kpa=np.zeros(n),
        stage=np.array(stages),
        measured_m_s=np.full(n, np.nan),
        stalled=False,
    )


def test_commands_are_the_changes_of_stage() -> None:
    assert commands_of(trace(3.0, [0, 0, 1, 1, 0])) == [(0.2, 1), (0.4, 0)]


def test_passes_with_other_commands_count_for_the_share_alone() -> None:
    truth = [trace(3.0, [0, 1, 1]), trace(3.0, [0, 1, 1]), trace(3.0, [0, 1, 1])]
    mine = [trace(3.003, [0, 1, 1]), trace(2.996, [0, 1, 1]), trace(4.0, [0, 0, 1])]
    row = compared(5, mine, truth)
    assert row.same == pytest.approx(2.0 / 3.0)
    assert row.rms_m_s == pytest.approx(np.sqrt((0.003**2 + 0.004**2) / 2.0))
    assert row.largest_m_s == pytest.approx(0.004)
    assert compared(5, mine[2:], truth[2:]) == replace(row, same=0.0, rms_m_s=0.0, largest_m_s=0.0)
