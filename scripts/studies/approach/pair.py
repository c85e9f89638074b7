"""The tables of one plant for several approaches, on the same passes."""

from __future__ import annotations

from dataclasses import dataclass, replace

from plant_models import Approach, Plant
from scripts.studies.tuned_table import tuned_table
from synth.retarder.comparison.baselines import tune_baselines
from synth.retarder.comparison.served_entry import entry_sweep, served
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.exit_statistics import brake_power, exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval
from tuning_tables import ControllerTable

SERVED_PASSES = 2000
"""At each entry speed."""


@dataclass(frozen=True)
class Given:
    """What every case is given: settings, passes to compare on, passes to tune rules of thumb on."""

    config: ResolvedConfig
    passes: RandomPasses
    tuning: RandomPasses


@dataclass(frozen=True)
class Figures:
    """A table in the closed loop; `brake_saturated`: share of the cuts that no table stops."""

    rms_m_s: float
    rms_ci95_m_s: Interval
    brake_saturated: float
    switchings: float


def with_approach(plant: Plant, length_m: float, entrance_stage: int | None = None, initial_stage: int = 0) -> Plant:
    """`plant` with another approach; the stage allowed at the entrance is its own unless given."""
    stage = plant.approach.entrance_stage if entrance_stage is None else entrance_stage
    return replace(plant, approach=Approach(length_m, stage, initial_stage))


def table_of(plant: Plant, target_m_s: float, given: Given) -> ControllerTable:
    """The table that a tune makes for `plant`."""
    return tuned_table(given.config, plant, target_m_s)


def run_on(plant: Plant, table: ControllerTable, given: Given) -> tuple[ExitSample, CommonPasses]:
    """The passes of `plant` under `table`, and the passes."""
    passes = common_passes(plant, given.passes)
    return passes.run(TableController(table)), passes


def own_figures(plant: Plant, target_m_s: float, given: Given) -> Figures:
    """What the passes of `plant` say of its own table."""
    return figures_of(*run_on(plant, table_of(plant, target_m_s, given), given), target_m_s)


def figures_of(sample: ExitSample, passes: CommonPasses, target_m_s: float) -> Figures:
    """What a sample says of a table."""
    found = exit_statistics(sample, target_m_s)
    power = brake_power(sample, passes.at_full_brake, target_m_s)
    return Figures(found.rms_m_s, found.rms_ci95_m_s, power.brake_saturated, found.switchings)


@dataclass(frozen=True)
class Rival:
    """The tuned rule of thumb with the least rms, and the rms of the table over its rms, on the same passes."""

    name: str
    rms_m_s: float
    table_ratio: float
    table_ratio_ci95: Interval


def best_rival(table: ExitSample, passes: CommonPasses, target_m_s: float, given: Given) -> Rival:
    """The best of the rules of thumb, which act from the same place and are tuned on passes of their own."""
    tuned = tune_baselines(passes.of_others(given.tuning), target_m_s)
    runs = [(each.name, passes.run(each.controller)) for each in tuned]
    name, sample = min(runs, key=lambda run: exit_statistics(run[1], target_m_s).rms_m_s)
    ratio, ci95 = rms_ratio(table, sample, target_m_s)
    return Rival(name, exit_statistics(sample, target_m_s).rms_m_s, ratio, ci95)


def highest_served_m_s(plant: Plant, target_m_s: float, given: Given) -> float | None:
    """The highest entry speed at which the position does not forbid the limit of the acceptance."""
    sweep = entry_sweep(common_passes(plant, given.passes), SERVED_PASSES)
    found = served(sweep.entry_m_s, sweep.unavoidable_rms_m_s(target_m_s), given.config.acceptance.rms_m_s)
    return found and found[1]
