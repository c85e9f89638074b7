"""The tables of one plant for several approaches, on the same passes, and what the study `approach` has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from plant_models import Approach, Plant
from scripts.studies.cases import tuned_table
from scripts.studies.study import ABSENT, Findings, MarkdownTable, around, plus_minus, table
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


@dataclass(frozen=True)
class CaseRow:
    """One case from the entrance and from before it, with the best rule of thumb of each; `ratio`: rms / rms.

    `served_m_s`: the highest entry speed that the position can serve, without and with.
    """

    case: str
    without: Figures
    ahead: Figures
    ratio: float
    ratio_ci95: Interval
    rival_without: Rival
    rival: Rival
    served_m_s: tuple[float | None, float | None]


@dataclass(frozen=True)
class LengthRow:
    """rms of one case by the length of the approach."""

    case: str
    rms_m_s: tuple[float, ...]
    rms_ci95_m_s: tuple[Interval, ...]


@dataclass(frozen=True)
class AtEntrance:
    """rms of one case, with this stage allowed at the entrance."""

    case: str
    stage: int
    rms_m_s: float
    rms_ci95_m_s: Interval


@dataclass(frozen=True)
class FoundClosed:
    """rms where the regulator finds the brake at `stage`, and over that of a released brake, same table and passes."""

    case: str
    stage: int
    rms_m_s: float
    ratio: float
    ratio_ci95: Interval


@dataclass(frozen=True)
class Approaches(Findings):
    """All parts."""

    config_sha256: str
    seed: int
    passes: int
    length_m: float
    lengths_m: tuple[float, ...]
    cases: tuple[CaseRow, ...]
    by_length: tuple[LengthRow, ...]
    at_entrance: tuple[AtEntrance, ...]
    found_closed: tuple[FoundClosed, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`gain`, `rivals`: a row a case; `length`: a column a length; `entrance`, `closed`: a row a stage."""
        ahead = f"from {self.length_m:g} m before it"
        stages = sorted({row.stage for row in self.at_entrance})
        by_case = dict.fromkeys(row.case for row in self.at_entrance)
        return {
            "gain": table(
                "rms, m/s ± half its 95 % interval; ratio of the two rms; cuts in 10 000 that no table "
                "stops; highest entry speed served, m/s",
                ("case", "from the entrance", ahead, "ratio", "brake saturated", "served up to"),
                map(gain_cells, self.cases),
            ),
            "rivals": table(
                "rms of the table / rms of the best tuned rule of thumb that may act from the same place",
                ("case", "from the entrance", ahead),
                ((row.case, rival_cell(row.rival_without), rival_cell(row.rival)) for row in self.cases),
            ),
            "length": table(
                "rms by the length of the approach, m/s ± half its 95 % interval",
                ("case", *(f"{x:g} m" for x in self.lengths_m)),
                ((row.case, *map(rms_cell, row.rms_m_s, row.rms_ci95_m_s)) for row in self.by_length),
            ),
            "entrance": table(
                "rms by the highest stage allowed at the entrance, m/s ± half its 95 % interval",
                ("case", *(f"stage {stage}" for stage in stages)),
                ((case, *self.entrance_cells(case, stages)) for case in by_case),
            ),
            "closed": table(
                "the same table where the brake is still at a stage when the regulator takes over: rms, m/s; over that "
                "of a released brake, 95 % interval",
                ("case", "stage", "rms", "ratio"),
                ((r.case, str(r.stage), f"{r.rms_m_s:.4f}", around(r.ratio, r.ratio_ci95, 3))
                 for r in self.found_closed),
            ),
        }  # fmt: skip

    def entrance_cells(self, case: str, stages: list[int]) -> list[str]:
        """The cells of one case, by stage."""
        mine = {row.stage: rms_cell(row.rms_m_s, row.rms_ci95_m_s) for row in self.at_entrance if row.case == case}
        return [mine.get(stage, ABSENT) for stage in stages]

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and what lost."""
        lost = [row.case for row in self.cases if row.rival.table_ratio_ci95[0] > 1.0]
        return (
            f"{self.passes} stratified passes of seed {self.seed}, the same cuts in every column",
            f"a rule of thumb that acts from the same place is better beyond its interval: {', '.join(lost) or 'none'}",
        )

    def faults(self) -> tuple[str, ...]:
        """Cases that the approach makes worse beyond the interval."""
        worse = (row for row in self.cases if row.ratio_ci95[0] > 1.0)
        return tuple(f"{row.case}: worse with approach, ratio {around(row.ratio, row.ratio_ci95, 3)}" for row in worse)


def gain_cells(row: CaseRow) -> tuple[str, ...]:
    """The cells of one case."""
    served = " → ".join(ABSENT if speed is None else f"{speed:.2f}" for speed in row.served_m_s)
    return (
        row.case, rms_cell(row.without.rms_m_s, row.without.rms_ci95_m_s),
        rms_cell(row.ahead.rms_m_s, row.ahead.rms_ci95_m_s), around(row.ratio, row.ratio_ci95, 3),
        f"{in_10_000(row.without.brake_saturated)} → {in_10_000(row.ahead.brake_saturated)}", served,
    )  # fmt: skip


def in_10_000(share: float) -> str:
    """'184' or '7.5': of 10 000 cuts."""
    return f"{1e4 * share:.0f}" if share >= 0.01 else f"{1e4 * share:.2g}"


def rms_cell(rms_m_s: float, ci95_m_s: Interval) -> str:
    """'0.0382 ± 0.0004'."""
    return plus_minus(rms_m_s, ci95_m_s, 4)


def rival_cell(rival: Rival) -> str:
    """'0.78 [0.76, 0.80] (energy rule)'."""
    return f"{around(rival.table_ratio, rival.table_ratio_ci95, 2)} ({rival.name})"
