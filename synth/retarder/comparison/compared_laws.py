"""The classical laws tuned for a table's case, and run on the passes that the table had."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from synth.retarder.comparison.baselines import TunedBaseline, tune_baselines
from synth.retarder.comparison.measured import Measured
from synth.simulation.common_passes import CommonPasses
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from tuning_tables import ControllerTable, Decisions


@dataclass(frozen=True, eq=False)
class ComparedLaw:
    """A law as it was tuned, the passes under it, and its figures beside those of the table."""

    law: TunedBaseline
    sample: ExitSample
    measured: Measured


def compared_laws(
    tuning: CommonPasses, passes: CommonPasses, table: ExitSample, target_m_s: float, decisions: Sequence[Decisions]
) -> tuple[ComparedLaw, ...]:
    """Every baseline, tuned on `tuning` and run on `passes`; `table`: the table's sample of these."""
    found = []
    for law in tune_baselines(tuning, target_m_s, decisions):
        sample = passes.run(law.controller)
        found.append(ComparedLaw(law, sample, beside_table(law.name, sample, table, target_m_s)))
    return tuple(found)


def best_law(laws: Sequence[ComparedLaw]) -> ComparedLaw:
    """The law of least rms."""
    return min(laws, key=lambda each: each.measured.statistics.rms_m_s)


def permitted(table: ControllerTable) -> tuple[Decisions, ...]:
    """When laws that a table is compared with may command: as it, or less often."""
    return tuple(dict.fromkeys((Decisions.AT_REST, table.decisions)))


def beside_table(name: str, sample: ExitSample, table: ExitSample, target_m_s: float) -> Measured:
    """Figures of a controller's `sample`, and how the table fares on the same passes."""
    found = exit_statistics(sample, target_m_s)
    if found.rms_m_s == 0.0:
        return Measured(name, found)
    ratio, ci95 = rms_ratio(table, sample, target_m_s)
    return Measured(name, found, table_ratio=ratio, table_ratio_ci95=ci95)
