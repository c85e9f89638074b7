"""How a controller did on the bench, beside the table's promise, the table itself and the rules on the same cuts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.retarder.bench.bench_pass import BenchPass
from synth.retarder.bench.cases import BenchCase
from synth.retarder.class_setup import TUNING_PASSES
from synth.retarder.comparison.baselines import tune_baselines
from synth.simulation.random_passes import random_passes
from synth.simulation.replicates import Interval, Mean, mean_of, rms_of, rms_quotient
from tuning_tables.decisions import Decisions

Floats = NDArray[np.float64]

EACH = 1
"""Each cut is a replicate: they are drawn as they come, independent of each other."""

LEAST_PASSES = 20
"""With fewer the score decides nothing."""


@dataclass(frozen=True)
class Score:
    """What became of n cuts, of one table or of all: errors of the exit speed in m/s, intervals of 95 %.

    `promised_m_s`: rms that the tables predict; `by_table`, `by_rules`: rms on these very cuts, by the simulator;
    `ratio`: rms of the controller / rms of the table, paired; None where the table made no error.
    """

    label: str
    target_m_s: float | None
    passes: tuple[BenchPass, ...]
    rms_m_s: tuple[float, Interval]
    promised_m_s: float
    by_table_m_s: tuple[float, Interval]
    by_rules_m_s: Mapping[str, tuple[float, Interval]]
    ratio: tuple[float, Interval]
    switchings: Mean
    switchings_by_table: float


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Errors:
    """Exit errors of the cuts of one table, (n,) each: of the controller, of the table, of the rules by name."""

    case: BenchCase
    passes: tuple[BenchPass, ...]
    controller_m_s: Floats
    table_m_s: Floats
    rules_m_s: Mapping[str, Floats]
    table_switchings: Floats


def errors_of(case: BenchCase, passes: Sequence[BenchPass], seed: int) -> Errors:
    """Those of `passes`, all of `case`; rules are tuned on other cuts of the same plant."""
    target, table = case.table.target_speed_m_s, case.table
    numbers = np.array([each.number for each in passes])
    others = case.common.of_others(random_passes(seed, 0, TUNING_PASSES))
    laws = tune_baselines(others, target, tuple(dict.fromkeys((Decisions.AT_REST, table.decisions))))
    by_rule = {law.name: case.common.run(law.controller).exit_speed_m_s for law in laws}
    return Errors(
        case,
        tuple(passes),
        np.array([each.end.exit_speed_m_s for each in passes]) - target,
        case.by_table.exit_speed_m_s[numbers] - target,
        {name: speeds[numbers] - target for name, speeds in by_rule.items()},
        case.by_table.switchings[numbers].astype(np.float64),
    )


def score_of(label: str, target_m_s: float | None, errors: Sequence[Errors]) -> Score:
    """The score on the cuts of all of `errors` together, two at least."""

    def together(values: Callable[[Errors], Floats]) -> Floats:
        return np.concatenate([values(each) for each in errors])

    controller, table = together(lambda each: each.controller_m_s), together(lambda each: each.table_m_s)
    n, one = len(controller), np.ones(len(controller))
    promised = together(lambda each: np.full(len(each.passes), each.case.table.predicted.rms_m_s))
    passes = tuple(found for each in errors for found in each.passes)
    same = np.array_equal(controller, table)
    return Score(
        label,
        target_m_s,
        passes,
        rms_of(controller, one, EACH),
        float(np.sqrt(promised @ promised / n)),
        rms_of(table, one, EACH),
        {name: rms_of(together(lambda each: each.rules_m_s[name]), one, EACH) for name in errors[0].rules_m_s},  # noqa: B023
        (1.0, (1.0, 1.0)) if same else rms_quotient(controller, table, one, EACH),
        mean_of(np.array([float(each.switchings) for each in passes]), one, EACH),
        float(together(lambda each: each.table_switchings).mean()),
    )
