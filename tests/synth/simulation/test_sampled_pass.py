"""A pass that is commanded from outside, sample by sample, against the kernels of the closed loop."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from synth.retarder.bench.run import TableShadow
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import random_passes
from synth.simulation.sampled_pass import PassEnd, SampledPass, sampled_pass
from tests.controller_code.fmi.test_position_unit import CASES, Case
from tests.effort import sized
from tuning_tables import ControllerTable

PASSES, SEED = sized(12, 300), 3
TOLERANCE = 1e-10
"""m/s and s. Both compute the same in double precision, in another order: 4e-12 were measured in 100 passes."""


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_under_the_stages_of_a_table_it_ends_as_in_the_simulator(case: Callable[[], Case]) -> None:
    plant, table = case()
    loop = close_loop(plant, len(table.stages))
    draws = loop.draws(random_passes(SEED, 0, PASSES))
    simulated = loop.run(TableController(table), draws)
    for i in range(PASSES):
        end, commands = driven(sampled_pass(loop, draws.part(i, i + 1)), table)
        assert end.exit_speed_m_s == pytest.approx(simulated.exit_speed_m_s[i], abs=TOLERANCE)
        assert end.time_s == pytest.approx(simulated.transit_time_s[i], abs=TOLERANCE)
        assert end.stalled == simulated.stalled[i]
        assert commands == simulated.switchings[i]


def driven(rolling: SampledPass, table: ControllerTable) -> tuple[PassEnd, int]:
    """The end under `table`, and how many commands it gave."""
    asked, reading, commands = TableShadow(table), next(rolling), 0
    while True:
        stage = asked.stage_at(reading)
        commands += stage != reading.stage
        try:
            reading = rolling.send(stage)
        except StopIteration as ended:
            return ended.value, commands
