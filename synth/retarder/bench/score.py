"""How a controller did on the bench, beside the table's promise, the table itself and the rules on the same cuts.

A few dozen cuts tell nothing of the rare ones that make most of an rms: no interval from them holds the rms of all cuts
as often as it says. So what is told of these cuts is told of these cuts alone, which is exact. And what the promise
means for so many cuts is drawn: the range within which the rms of 95 of 100 such groups lies under the table.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.retarder.bench.bench_pass import BenchCase, BenchPass
from synth.retarder.bench.exchange import Cycles, Traffic
from synth.retarder.class_setup import TUNING_PASSES
from synth.retarder.comparison.baselines import permitted, tune_baselines
from synth.simulation.closed_loop import TableController
from synth.simulation.random_passes import BLOCK_PASSES, random_passes
from synth.simulation.replicates import UPPER_TAIL, Interval

GROUPS = 1000
"""As many groups of cuts are drawn: the ends of the range are known to one per cent of probability."""


@frozen_arrays
class Errors:
    """Exit errors of the n cuts of one table, m/s: of the controller, of the table, of the rules by name, (n,) each.

    `promised_m_s` (`GROUPS`, n): of the table, on other cuts. `table_switchings` (n,).
    """

    case: BenchCase
    passes: tuple[BenchPass, ...]
    controller_m_s: Floats
    table_m_s: Floats
    rules_m_s: Mapping[str, Floats]
    promised_m_s: Floats
    table_switchings: Floats


@dataclass(frozen=True)
class Score:
    """What became of n cuts, of one table or of all; errors of the exit speed in m/s, `target_speed_m_s` None for all.

    `predicted_rms_m_s`: rms that the tables predict of all cuts; `range_m_s`: within which the rms of 95 of 100 groups
    of n cuts lies under the tables. All else is of these very cuts.
    """

    label: str
    target_speed_m_s: float | None
    cuts: int
    rms_m_s: float
    predicted_rms_m_s: float
    range_m_s: Interval
    by_table_m_s: float
    by_rules_m_s: Mapping[str, float]
    switchings: float
    switchings_by_table: float

    @property
    def ratio(self) -> float:
        """rms of the controller / rms of the table."""
        return self.rms_m_s / self.by_table_m_s


def errors_of(case: BenchCase, passes: Sequence[BenchPass], seed: int) -> Errors:
    """Those of `passes`, all of `case`; rules are tuned on other cuts of the same plant."""
    target, table = case.table.target_speed_m_s, case.table
    numbers = np.array([each.number for each in passes])
    others = case.common.of_others(random_passes(seed, 0, TUNING_PASSES))
    laws = tune_baselines(others, target, permitted(table))
    return Errors(
        case,
        tuple(passes),
        np.array([each.end.exit_speed_m_s for each in passes]) - target,
        case.by_table.exit_speed_m_s[numbers] - target,
        {law.name: case.common.run(law.controller).exit_speed_m_s[numbers] - target for law in laws},
        exits_of(case, seed + 1, GROUPS * len(passes)).reshape(GROUPS, -1) - target,
        case.by_table.switchings[numbers].astype(np.float64),
    )


def exits_of(case: BenchCase, seed: int, count: int) -> Floats:
    """Exit speeds of `count` cuts of another row under the table, block by block, as memory has no room for all."""
    controller = TableController(case.table)
    blocks = (
        case.common.of_others(random_passes(seed, first, min(BLOCK_PASSES, count - first))).run(controller)
        for first in range(0, count, BLOCK_PASSES)
    )
    return np.concatenate([block.exit_speed_m_s for block in blocks])


def score_of(label: str, target_m_s: float | None, errors: Sequence[Errors]) -> Score:
    """The score on the cuts of all of `errors` together."""

    def together(values: Callable[[Errors], Floats]) -> Floats:
        return np.concatenate([values(each) for each in errors], axis=-1)

    def rms(values: Callable[[Errors], Floats]) -> float:
        return float(np.sqrt(np.mean(together(values) ** 2)))

    predicted = together(lambda each: np.full(len(each.passes), each.case.table.predicted.rms_m_s))
    groups = np.sqrt(np.mean(together(lambda each: each.promised_m_s) ** 2, axis=1))
    low, high = np.quantile(groups, (UPPER_TAIL, 1.0 - UPPER_TAIL)).tolist()
    rules = {name: rms(lambda each, name=name: each.rules_m_s[name]) for name in errors[0].rules_m_s}  # type: ignore[misc]
    return Score(
        label,
        target_m_s,
        len(predicted),
        rms(lambda each: each.controller_m_s),
        float(np.sqrt(np.mean(predicted**2))),
        (low, high),
        rms(lambda each: each.table_m_s),
        rules,
        float(np.mean([found.switchings for each in errors for found in each.passes])),
        float(together(lambda each: each.table_switchings).mean()),
    )


@dataclass(frozen=True)
class FoundBench:
    """What became of the cuts that came, out of `asked`; `cycles` None where there was no clock."""

    title: str
    period_s: float
    computing_delay_s: float
    seed: int
    asked: int
    passes: tuple[BenchPass, ...]
    errors: tuple[Errors, ...]
    traffic: Traffic
    cycles: Cycles | None
    prediction_ratio_low: float
