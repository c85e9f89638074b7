"""The conditions off nominal, and a table as stored put through its first validation passes under each of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models import Plant, PlantError
from synth.problem.problem import OVERSPEED_M_S
from synth.retarder.case_result import OffNominal, Outcome
from synth.retarder.configuration.plant_values import SLOPES, nominal_value, with_values
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.exit_statistics import overspeed_of, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import rms_of, share_of
from tuning_tables import ControllerTable

Change = Callable[[Plant], Plant]


@dataclass(frozen=True)
class Condition:
    """`key` in `summary.json`; `name` in sentences and tables; `changes` by what they do: the worst of them counts."""

    key: str
    name: str
    changes: Mapping[str, Change]


def times(factor: float, *keys: str) -> Change:
    """The values under `keys` of the configuration times `factor`; of those that the plant has."""

    def changed(plant: Plant) -> Plant:
        known = {key: nominal_value(plant, key) for key in keys}
        return with_values(plant, {key: factor * value for key, value in known.items() if value is not None})

    return changed


def losing(share: float, burst_s: float) -> Change:
    """The radar loses `share` of its readings, in bursts of `burst_s` on average, of at least one reading."""

    def changed(plant: Plant) -> Plant:
        burst = max(burst_s, plant.sensor.sample_period_s)
        return with_values(plant, {"sensor.missed_share": share, "sensor.missed_burst_s": burst})

    return changed


VALVES: Final = tuple(
    f"retarder.pneumatics.{name}"
    for name in (
        "brake_delay_s", "touch_delay_s", "release_delay_s", "closing_delay_s", "fill_time_constant_s",
        "exhaust_time_constant_s",
    )
)  # fmt: skip

CONDITIONS: Final = (
    # ξ and the slope K enter the force as their product: all friction times 0.7, its floor too, is another K.
    Condition("low_friction", "friction × 0.7", {"friction × 0.7": times(0.7, *SLOPES)}),
    Condition("slow_valves", "valves slower × 1.5", {"valve delays and time constants × 1.5": times(1.5, *VALVES)}),
    Condition(
        "lost_readings",
        "a third of the readings lost",
        {"a third of the readings lost, in bursts of 0.6 s on average": losing(1.0 / 3.0, 0.6)},
    ),
    Condition(
        "wrong_weight",
        "weight ± 10 %",
        {"the cut 10 % lighter": times(0.9, "cut.mass_t"), "the cut 10 % heavier": times(1.1, "cut.mass_t")},
    ),
)
"""In the order of the report."""


PASSES = 4000
"""Passes of a condition: the first of the validation, or all of these if they are fewer."""

ChangedPasses = Mapping[str, CommonPasses] | str
"""The passes on each changed plant, by what the change does; a sentence where no plant can be so."""


@dataclass(frozen=True)
class Trials:
    """The passes of every condition."""

    passes: tuple[tuple[Condition, ChangedPasses], ...]

    def of(self, table: ControllerTable, nominal: ExitSample) -> tuple[OffNominal, ...]:
        """What becomes of `table`, whose validation passes on its own plant were `nominal`."""
        return tuple(tried(condition, passes, table, nominal) for condition, passes in self.passes)


def trials(validation: CommonPasses, count: int = PASSES) -> Trials:
    """The first `count` passes of `validation` on every changed plant; the same for all tables of a class."""
    first = validation.first(count)
    return Trials(tuple((condition, changed_passes(condition.changes, first)) for condition in CONDITIONS))


def changed_passes(changes: Mapping[str, Change], nominal: CommonPasses) -> ChangedPasses:
    """The same passes on the plant of each change; a sentence where one of these cannot be."""
    try:
        return {name: common_passes(change(nominal.plant), nominal.passes) for name, change in changes.items()}
    except PlantError as error:
        return str(error)


def tried(condition: Condition, passes: ChangedPasses, table: ControllerTable, nominal: ExitSample) -> OffNominal:
    """The worst that becomes of `table` in `condition`."""
    if isinstance(passes, str):
        return OffNominal(condition.key, condition.name, None, passes)
    try:
        samples = {name: each.run(TableController(table)) for name, each in passes.items()}
    except PlantError as error:  # valves that cannot follow commands at any time
        return OffNominal(condition.key, condition.name, None, str(error))
    outcomes = [outcome_of(name, sample, table.target_speed_m_s, nominal) for name, sample in samples.items()]
    return OffNominal(condition.key, condition.name, max(outcomes, key=lambda each: each.rms_m_s))


def outcome_of(change: str, sample: ExitSample, target_m_s: float, nominal: ExitSample) -> Outcome:
    """The figures of `sample`, the first passes of `nominal` on the changed plant."""
    same = ExitSample(**{name: array[: len(sample)] for name, array in vars(nominal).items()})
    known = bool(np.any(same.exit_speed_m_s != target_m_s)) and bool(np.any(sample.exit_speed_m_s != target_m_s))
    ratio, ratio_ci95 = rms_ratio(sample, same, target_m_s) if known else (None, None)
    overspeed, stalled = overspeed_of(sample, target_m_s, OVERSPEED_M_S), share_of(sample.stalled, sample.weight)
    rms = rms_of(sample.exit_speed_m_s - target_m_s, sample.weight)
    return Outcome(change, len(sample), *rms, ratio, ratio_ci95, *overspeed, *stalled)
