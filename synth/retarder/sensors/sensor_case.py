"""One case of a tune for point sensors: its table, and what became of the passages at which it decides."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import frozen_arrays
from synth.problem.aim import Aim
from synth.retarder.epochs import Store
from synth.retarder.sensors.passage_table import passage_table
from synth.retarder.sensors.sensor_class import SensorClass, SensorPasses
from synth.retarder.sensors.tuned_passages import tuned_passages
from synth.retarder.tuned_case import TunedCase
from synth.retarder.validated_table import validated
from synth.simulation.passage_controller import of_table
from synth.simulation.passage_sample import (
    HEARD,
    MISTAKEN,
    TAKEN,
    UNFINISHED,
    PassageSample,
    PassageTrace,
    shares_of_outcomes,
)
from synth.simulation.passes import TRACE_FACTORS, ExitSample
from synth.simulation.replicates import Interval
from synth.simulation.unavoidable_error import UnavoidableError, unavoidable_error
from tuning_tables.passages.passage_table import PassageTable


@dataclass(frozen=True)
class HeardShares:
    """Of the cuts heard at every passage at which is decided, in its order, the shares with 95 % intervals.

    `unfinished`: found a change of stage unfinished, so that nothing was decided; `mistaken`: the tracker took the
    pulses for no passage, or for one at which nothing is decided. NaN where no cut came. `taken`: passes whose pulses
    were taken for the passage, of which `unfinished` is told; `heard`: all heard there, of which `mistaken` is.
    """

    unfinished: tuple[tuple[float, Interval], ...]
    mistaken: tuple[tuple[float, Interval], ...]
    taken: tuple[int, ...]
    heard: tuple[int, ...]


@frozen_arrays
class SensorCase(TunedCase):
    """One case of tables for point sensors.

    Slowest of the passes behind `unavoidable` are cuts under the harder braking of two, the table and full brake at
    every passage.
    """

    table: PassageTable
    traces: tuple[PassageTrace, ...]
    heard: HeardShares


def sensor_case(setup: SensorClass, aim: Aim, store: Store[PassageTable]) -> SensorCase:
    """Tune one case; the table is simulated as read back from where it is stored, and stored with the figures."""
    passes, target_m_s = setup.passes, aim.target_speed_m_s
    tuned = tuned_passages(setup.chains, aim)
    table = passage_table(tuned, *setup.origin.stamp(setup.label, target_m_s))
    found = validated(table, store, lambda kept: passes.run(of_table(kept, tracking=True)), setup.passes.at_full_brake)
    controller = of_table(found.table, tracking=True)
    return SensorCase(
        label=setup.label,
        plant=setup.plant,
        table=found.table,
        predicted=tuned.predicted,
        polish=tuned.polish,
        exit_speeds_m_s=found.sample.exit_speed_m_s.astype(np.float32),
        exit_weight=found.sample.weight,
        statistics=found.statistics,
        brake_power=found.brake_power,
        unavoidable=unavoidable(passes, found.sample, target_m_s),
        traces=tuple(passes.trace(controller, i, factor) for i, factor in enumerate(TRACE_FACTORS)),
        heard=heard_shares(found.sample),
    )


def unavoidable(passes: SensorPasses, sample: ExitSample, target_m_s: float) -> UnavoidableError:
    """The error that no rule with these sensors avoids; `sample`: the passes under a table."""
    slowest = np.minimum(sample.exit_speed_m_s, passes.at_full_brake.exit_speed_m_s)
    return unavoidable_error(replace(sample, exit_speed_m_s=slowest), passes.released, target_m_s)


def heard_shares(sample: PassageSample) -> HeardShares:
    """Passages that found a change of stage unfinished, or were mistaken."""
    taken, heard = (np.isin(sample.outcome, outcomes).sum(axis=0) for outcomes in (TAKEN, HEARD))
    return HeardShares(
        shares_of_outcomes(sample, (UNFINISHED,), TAKEN),
        shares_of_outcomes(sample, MISTAKEN, HEARD),
        tuple(taken.tolist()),
        tuple(heard.tolist()),
    )
