"""Estimates of a known plant, their derivatives, and what is done where the likelihood has an edge."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from scripts.studies.identification.truths import TRUTHS, Yard
from synth.logs import unknowns as asked
from synth.logs.estimate import SIDE, Estimate, Side, estimate, posterior
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identifiability import findings_of
from synth.logs.unknowns import unknowns_of
from synth.simulation.controllers import TableController
from tuning_tables import ControllerTable


def test_intervals_hold_the_truth_of_most_numbers(found: Estimate) -> None:
    truth = TRUTHS[0].values(tuple(unknown.key for unknown in found.unknowns))
    z = [
        (u - unknown.standing(truth[unknown.key])) / std
        for unknown, u, std in zip(found.unknowns, found.u, found.std, strict=True)
    ]
    assert np.sum(np.abs(z) < 1.96) >= len(z) - 3
    assert np.max(np.abs(z)) < 3.5


def test_scores_are_the_slope_of_the_likelihood(passes: FittingPasses, found: Estimate) -> None:
    target = posterior(passes, found.unknowns, 1)
    rng = np.random.default_rng(0)
    u = found.u + 0.3 * found.std * rng.standard_normal(len(found.u))
    gradient = target.gradient(u)
    for j in (0, 8, 11, 12):  # of the motion alone: those of the valves have edges
        step = np.zeros(len(u))
        step[j] = 1e-4
        slope = (target.value(u + step) - target.value(u - step)) / 2e-4
        assert abs(gradient[j] - slope) < 1e-3 * max(1.0, abs(slope))


def test_threads_change_nothing(passes: FittingPasses, found: Estimate, monkeypatch: pytest.MonkeyPatch) -> None:
    """An estimate is made of these alone. Four parts of the log, so that threads have something to do."""
    monkeypatch.setattr("synth.logs.estimate.CHUNK", 20)
    one, two = (posterior(passes, found.unknowns, threads) for threads in (1, 2))
    assert len(one.parts) == 4
    for u in (found.u, 0.5 * found.u):
        assert one.value(u) == two.value(u)
        by_one, by_two = (target.linearised_by(u, {asked.FILL: Side(*SIDE)}) for target in (one, two))
        assert by_one.log_likelihood == by_two.log_likelihood
        assert by_one.scores.tobytes() == by_two.scores.tobytes()
        assert by_one.information.tobytes() == by_two.information.tobytes()


def up_to_stage_1(controller: TableController) -> TableController:
    """A regulator whose commands go one stage."""
    table = controller.table
    assert isinstance(table, ControllerTable)
    stages = (each if each.k == 0 else replace(each, upper=None) for each in table.stages)
    return TableController(replace(table, stages=tuple(stages)))


@pytest.mark.long
def test_a_summit_on_an_edge_is_no_sharp_number(yard: Yard, found: Estimate) -> None:
    """Of a change to stage 1 the pressure rests before the next reading whatever the touch delay is, nearly.

    On the way to a higher stage a gauge is read that tells it.
    """
    low_yard = replace(yard, controllers={label: up_to_stage_1(each) for label, each in yard.controllers.items()})
    passes = low_yard.passes(TRUTHS[0], 80, 7)
    lowly = estimate(passes, unknowns_of(passes, yard.config.parameters), 2)
    widths = []
    for each in (lowly, found):
        (number,) = (i for i, unknown in enumerate(each.unknowns) if unknown.key == asked.TOUCH_DELAY)
        low, high = each.interval(number)
        widths.append(high - low)
    assert widths[0] > 0.01 > widths[1]


def test_without_gauge_and_with_path_from_speed_less_is_told(
    yard: Yard, passes: FittingPasses, found: Estimate
) -> None:
    blind = replace(passes.log, pressure_kpa=np.full(len(passes.log.time_s), np.nan), path_is_independent=False)
    some = replace(passes, log=blind)
    unknowns = unknowns_of(some, yard.config.parameters)
    keys = {unknown.key for unknown in unknowns}
    assert not keys & {asked.BIAS, asked.GAUGE_NOISE}
    left = {finding.key: finding.left for finding in findings_of(found)}
    blindly = {finding.key: finding for finding in findings_of(estimate(some, unknowns, 2))}
    for key in (asked.FILL, asked.EXHAUST, asked.BRAKE_DELAY, asked.RELEASE_DELAY):
        assert blindly[key].left > 5.0 * left[key]
    for key in (asked.COMMON_CV, asked.NOISE):
        assert blindly[key].identified
        assert blindly[key].left < 1.1 * left[key]
