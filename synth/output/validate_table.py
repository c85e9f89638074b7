"""The closed loop of a table that was read from a file: nothing is solved again."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from synth.configuration.resolved_config import ResolvedConfig
from synth.input_error import InputError
from synth.output.acceptance import missed_limits, overspeed_share
from synth.problem import Plant
from synth.simulation.closed_loop import TableController, simulate_many
from synth.simulation.exit_statistics import ExitStatistics, exit_statistics
from tuning_tables import ControllerTable

LENGTH_TOLERANCE = 1e-6
"""Relative, for lengths, masses and pressures that must be the same."""


@dataclass(frozen=True)
class Revalidation:
    """What the passes of `plant` under `table` gave, beside what the file says of itself.

    `overspeed`: share of passes above target + margin of the limits; `honesty`: the file's predicted rms / simulated
    rms; `confirmed`: the 95 % intervals of the file and of these passes overlap, None where the file has none;
    `missed`: the limits that the table does not keep; `infeasible`: the summary beside the file calls the case
    so; `same_config`: the table was made from this very configuration.
    """

    table: ControllerTable
    label: str
    statistics: ExitStatistics
    overspeed: float
    honesty: float
    confirmed: bool | None
    missed: tuple[str, ...]
    infeasible: bool
    same_config: bool


def revalidate(
    table: ControllerTable, config: ResolvedConfig, source: str, passes: int, seed: int, threads: int, infeasible: bool
) -> Revalidation:
    """Simulate `passes` passes of the cut class of `config` that `table` is for; `InputError` if none is."""
    label, plant = plant_for(table, config, source)
    sample = simulate_many(plant, TableController(table), seed, passes, threads=threads)
    target, limits = table.target_speed_m_s, config.acceptance
    found = exit_statistics(sample, target)
    honest = table.predicted.rms_m_s / found.rms_m_s if found.rms_m_s else math.nan
    over = overspeed_share(sample.exit_speed_m_s, target, limits.overspeed_margin_m_s)
    return Revalidation(
        table=table,
        label=label,
        statistics=found,
        overspeed=over,
        honesty=honest,
        confirmed=confirmed(table, found),
        missed=missed_limits(found, over, honest, limits),
        infeasible=infeasible,
        same_config=table.generator.config_sha256 == config.sha256,
    )


def confirmed(table: ControllerTable, found: ExitStatistics) -> bool | None:
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
        f"{' and '.join(apart[nearest])}; give the configuration that the table was made from by --config"
    )


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
        ("the highest stage allowed", [plant.top_stage], [reached_stage(table)]),
    )  # fmt: skip
    for key, ours, theirs in pairs:
        if len(ours) != len(theirs) or not all(map(alike, ours, theirs)):
            yield f"{key} ({numbers(ours)}, in the table {numbers(theirs)})"
    if cut.category != table.cut.category:
        yield f"cut.category ({cut.category}, in the table {table.cut.category})"


def reached_stage(table: ControllerTable) -> int:
    """The highest stage that the table ever asks for."""
    return next(stage.k for stage in table.stages if stage.upper is None)


def alike(one: float, other: float) -> bool:
    """Equal but for rounding."""
    return math.isclose(one, other, rel_tol=LENGTH_TOLERANCE, abs_tol=LENGTH_TOLERANCE)


def numbers(values: Sequence[float]) -> str:
    """Numbers with commas."""
    return ", ".join(f"{value:g}" for value in values)
