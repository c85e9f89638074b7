"""Entry speeds that a position can serve."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import EntrySpeed, Plant
from synth.retarder.comparison.served_entry import ENTRY_PASSES, ENTRY_POINTS, entry_sweep, feasibility_of, served
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.simulation.unavoidable_error import unavoidable_error

TARGET_M_S = 2.0


@pytest.fixture(scope="module")
def passes(plant_of: Callable[[float], Plant]) -> CommonPasses:
    return common_passes(plant_of(66.0), stratified_passes(3, 0, 2000))


def test_served_speeds_end_where_the_limit_is_met() -> None:
    entry = np.array([2.0, 3.0, 4.0, 5.0])
    assert served(entry, np.array([0.2, 0.05, 0.06, 0.16]), 0.1) == pytest.approx((2.0 + 2.0 / 3.0, 4.4))
    assert served(entry, np.array([0.02, 0.05, 0.06, 0.07]), 0.1) == (2.0, 5.0)
    assert served(entry, np.array([0.2, 0.3, 0.4, 0.5]), 0.1) is None


def test_the_error_at_an_entry_speed_is_that_of_cuts_that_all_enter_with_it(passes: CommonPasses) -> None:
    found = feasibility_of(entry_sweep(passes), TARGET_M_S, 0.05)
    assert len(found.entry_m_s) == ENTRY_POINTS
    for place in (ENTRY_POINTS // 2, ENTRY_POINTS - 1):
        speed = float(found.entry_m_s[place])
        plant = replace(passes.plant, entry=EntrySpeed(speed, speed))
        alone = common_passes(plant, passes.passes.part(0, ENTRY_PASSES)).exit_range
        exact = unavoidable_error(alone.slowest, alone.fastest, TARGET_M_S).rms_m_s
        assert exact > 0.0
        assert found.entry_rms_m_s[place] == pytest.approx(exact, rel=1e-9)
