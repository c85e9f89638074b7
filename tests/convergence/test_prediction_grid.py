"""The grid on which exported tables are predicted, at the lowest target of the default book, where cells are widest."""

from __future__ import annotations

from dataclasses import replace

import pytest

from synth.book.class_setup import Origin
from synth.book.degree_study import tables_by_degree
from synth.book.tuned_table import predict
from synth.configuration.config_file import load_config
from synth.problem.aim import Aim
from synth.problem.resolution import finer_for_check
from synth.simulation.closed_loop import TableController, simulate_many
from synth.simulation.random_passes import random_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import check_chain, persistent_chain
from tuning_tables import Generator

NEAR_M_S = 0.3


@pytest.mark.parametrize("label", ["gondola-4-36t", "gondola-4-52t"])
def test_prediction_of_a_polished_table_is_that_of_the_limit_and_of_passes(label: str) -> None:
    """Rms within 2 % of that on half the speed step (1.5 % measured; 6 % at three quarters of the design's step).

    Near the target, where no cut without brake power hides it, within 4 % of 60 000 passes (0.4 and 1.9 % measured).
    """
    config = load_config(None)
    plant, target = dict(config.plants())[label], config.targets_m_s[0]
    solution = solve(persistent_chain(plant, config.resolution), Aim(target, config.criterion))
    origin = Origin(Generator("retarder-synth", "0", "ab" * 32), "2026-11-21T00:00:00Z")
    table = next(tables_by_degree(solution, (config.fit.degree,), origin)).polished
    assert table is not None
    check = finer_for_check(config.resolution)
    half = replace(check, speed_step_m_s=0.5 * check.speed_step_m_s)
    density, finer = (predict(check_chain(plant, resolution), table) for resolution in (check, half))
    assert density.rms_m_s(target) == pytest.approx(finer.rms_m_s(target), rel=0.02)

    near = abs(density.speed_m_s - target) <= NEAR_M_S
    weight, error = density.probability[near], density.speed_m_s[near] - target
    exits = (
        simulate_many(plant, TableController(table), 11, 60_000, threads=2, row=random_passes).exit_speed_m_s - target
    )
    simulated = exits[abs(exits) <= NEAR_M_S]
    ratio = ((weight * error**2).sum() / weight.sum() / (simulated**2).mean()) ** 0.5
    print(label, density.rms_m_s(target) / finer.rms_m_s(target), ratio)
    assert ratio == pytest.approx(1.0, abs=0.04)
