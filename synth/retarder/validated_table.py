"""A table simulated as a controller will read it, and stored with what that gave."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from synth.retarder.epochs import Store, Table
from synth.simulation.exit_statistics import BrakePower, ExitStatistics, brake_power, exit_statistics
from synth.simulation.passes import ExitSample
from tuning_tables import Validated

Sample = TypeVar("Sample", bound=ExitSample)


@dataclass(frozen=True)
class ValidatedTable(Generic[Table, Sample]):
    """The table as stored, with what the closed loop on the passes of the tune says of it."""

    table: Table
    sample: Sample
    statistics: ExitStatistics
    brake_power: BrakePower


def validated(
    table: Table, store: Store[Table], run: Callable[[Table], Sample], at_full_brake: ExitSample
) -> ValidatedTable[Table, Sample]:
    """`table` stored, run as it is read back, and stored with the figures.

    `run` gives the passes under a table, `at_full_brake` are the same with every decision for more brake.
    """
    kept, target_m_s = store(table), table.target_speed_m_s
    sample = run(kept)
    found = exit_statistics(sample, target_m_s)
    stored = store(kept.with_validated(Validated(found.passes, found.rms_m_s, found.rms_ci95_m_s)))
    return ValidatedTable(stored, sample, found, brake_power(sample, at_full_brake, target_m_s))
