"""The closed loop of a table that was read from a file: nothing is solved again."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from plant_models import Plant
from plant_models.library.position_entry import APPROACH
from synth.frame.input_error import InputError
from synth.retarder.comparison.measured import honesty_of
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.judgement import Judgement, judgement
from synth.simulation.closed_loop import TableController, simulate_many
from synth.simulation.controllers import Controller, full_brake
from synth.simulation.exit_statistics import BrakePower, ExitStatistics, brake_power, exit_statistics, overspeed_of
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import Interval
from tuning_tables import ControllerTable
from tuning_tables.table_kinds import StageTable

LENGTH_TOLERANCE = 1e-6
"""Relative, for lengths, masses and pressures that must be the same."""


Tell = Callable[[str], None]


def no_notice(sentence: str) -> None:
    """Nobody wants to know."""


@dataclass(frozen=True)
class Revalidation:
    """What the passes of `plant` under `table` gave, beside what the file says of itself.

    `overspeed`: share of passes above target + margin of the limits, with its interval; `confirmed`: the 95 % intervals
    of the file and of these passes overlap, None where the file has none; `judgement`: what the passes say of the
    limits; `infeasible`: the summary beside the file calls the case so; `same_config`: the table was made from this
    very configuration.
    """

    table: StageTable
    label: str
    statistics: ExitStatistics
    brake_power: BrakePower
    overspeed: tuple[float, Interval]
    honesty: tuple[float, Interval]
    confirmed: bool | None
    judgement: Judgement
    infeasible: bool
    same_config: bool

    @property
    def told(self) -> str:
        """The table and its rms in a sentence."""
        low, high = self.statistics.rms_ci95_m_s
        rms = f"rms {self.statistics.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s"
        return f"{self.table.id}: {rms} in {self.statistics.passes} passes"


@dataclass(frozen=True)
class Rehearsal:
    """What every table of a source is simulated with: the plants of `config`, and `passes` passes of `seed`."""

    config: ResolvedConfig
    source: str
    passes: int
    seed: int
    threads: int

    def run(self, plant: Plant, controller: Controller) -> ExitSample:
        """The passes of `plant` under `controller`."""
        return simulate_many(plant, controller, self.seed, self.passes, threads=self.threads)


def revalidated(
    tables: Sequence[ControllerTable], rehearsal: Rehearsal, infeasible: Sequence[bool], tell: Tell = no_notice
) -> list[Revalidation]:
    """Simulate each table on the cut class that it is for; `InputError` if there is none for one of them.

    `tell` is given a sentence for each.
    """
    plants = dict(rehearsal.config.plants())

    @cache
    def at_full_brake(label: str) -> ExitSample:
        plant = plants[label]
        return rehearsal.run(plant, full_brake(plant.top_stage + 1, plant.start_m, plant.exit_m))

    found = []
    for table, known in zip(tables, infeasible, strict=True):
        label, plant = plant_for(table, rehearsal.config, rehearsal.source)
        sample = rehearsal.run(plant, TableController(table))
        power = brake_power(sample, at_full_brake(label), table.target_speed_m_s)
        found.append(revalidation(table, label, sample, power, known, rehearsal.config))
        tell(found[-1].told)
    return found


def revalidation(
    table: StageTable, label: str, sample: ExitSample, power: BrakePower, infeasible: bool, config: ResolvedConfig
) -> Revalidation:
    """What `sample` says of `table`, beside what the table says of itself."""
    target, limits = table.target_speed_m_s, config.acceptance
    found = exit_statistics(sample, target)
    over = overspeed_of(sample, target, limits.overspeed_margin_m_s)
    return Revalidation(
        table=table,
        label=label,
        statistics=found,
        brake_power=power,
        overspeed=over,
        honesty=honesty_of(table.predicted.rms_m_s, table.predicted.passes, found),
        confirmed=confirmed(table, found),
        judgement=judgement(found, over, table.predicted, limits),
        infeasible=infeasible,
        same_config=table.generator.config_sha256 == config.sha256,
    )


def confirmed(table: StageTable, found: ExitStatistics) -> bool | None:
    """Whether the interval that the file states and that of `found` overlap."""
    if table.validated is None:
        return None
    low, high = table.validated.rms_ci95_m_s
    return low <= found.rms_ci95_m_s[1] and found.rms_ci95_m_s[0] <= high


def plant_for(table: ControllerTable, config: ResolvedConfig, source: str) -> tuple[str, Plant]:
    """(label, plant) of the cut class that `table` is for; `source` is what a message calls the configuration.

    Of several that fit, the one whose label begins the table's id. `InputError` names what differs in the nearest.
    """
    plants = config.plants()
    apart = [tuple(differences(table, plant)) for _, plant in plants]
    fitting = [place for place, found in enumerate(apart) if not found]
    named = [place for place in fitting if table.id.startswith(f"{plants[place][0]}-to-")]
    if len(named or fitting) == 1:
        return plants[(named or fitting)[0]]
    if fitting:
        labels = ", ".join(plants[place][0] for place in fitting)
        raise InputError(
            f"{source}: the classes {labels} all fit the table {table.id}; leave the one it was made for, by --config"
        )
    nearest = min(range(len(plants)), key=lambda place: len(apart[place]))
    raise InputError(
        f"{source}: no cut class fits the table {table.id}; the nearest, {plants[nearest][0]}, differs in "
        f"{' and '.join(apart[nearest])}; {remedy(table, apart[nearest])}"
    )


def remedy(table: ControllerTable, apart: Sequence[str]) -> str:
    """What to do where the nearest class differs in `apart`. A configuration of before names no approach, so it gets
    the one of the library's position, which tables of before do not have."""
    given = "give the configuration that the table was made from by --config"
    if table.approach is None and len(apart) == 1 and apart[0].startswith(APPROACH):
        return f"{given}, with {APPROACH} = 0 in it if it names none"
    return given


def differences(table: ControllerTable, plant: Plant) -> Iterator[str]:
    """What of the plant is not what the table was made for, 'key (plant's value, in the table …)'."""
    position, cut = plant.position, plant.cut
    pairs: tuple[tuple[str, Sequence[float], Sequence[float]], ...] = (
        ("retarder.zones_m", [x for zone in position.zones_m for x in zone],
         [x for zone in table.retarder.zones_m for x in zone]),
        ("retarder.stage_pressures_kpa", position.stage_pressures_kpa, [s.pressure_kpa for s in table.stages]),
        ("retarder.dead_band_kpa", [position.pneumatics.dead_band_kpa], [table.retarder.dead_band_kpa]),
        ("cut.mass_t", [cut.mass_t], [table.cut.mass_t]),
        ("cut.axle_offsets_m", cut.axle_offsets_m, table.cut.axle_offsets_m),
        (APPROACH, [plant.approach.length_m], [table.approach.length_m if table.approach else 0.0]),
        ("the highest stage allowed", [plant.top_stage], [table.highest_raised]),
    )  # fmt: skip
    for key, ours, theirs in pairs:
        if len(ours) != len(theirs) or not all(map(alike, ours, theirs)):
            yield f"{key} ({numbers(ours)}, in the table {numbers(theirs)})"
    if table.approach and table.approach.entrance_stage != plant.entrance_stage:
        yield f"cut.entrance_stage ({plant.entrance_stage}, in the table {table.approach.entrance_stage})"
    if cut.category != table.cut.category:
        yield f"cut.category ({cut.category}, in the table {table.cut.category})"


def alike(one: float, other: float) -> bool:
    """Equal but for rounding."""
    return math.isclose(one, other, rel_tol=LENGTH_TOLERANCE, abs_tol=LENGTH_TOLERANCE)


def numbers(values: Sequence[float]) -> str:
    """Numbers with commas."""
    return ", ".join(f"{value:g}" for value in values)
