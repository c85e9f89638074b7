"""Decision epochs: when and on what a regulator decides, as far as the one tune of all tables must know it; and a
table of any of them, simulated as a controller will read it and stored with what that gave.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

from plant_models import Plant
from synth.problem.resolution import Resolution
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tuned_case import TunedCase
from synth.simulation.exit_statistics import BrakePower, ExitStatistics, brake_power, exit_statistics
from synth.simulation.passes import ExitSample
from tuning_tables import ControllerTable, Validated
from tuning_tables.passages.passage_table import PassageTable

if TYPE_CHECKING:
    from synth.retarder.class_setup import Origin
    from synth.simulation.random_passes import RandomPasses

Table = TypeVar("Table", ControllerTable, PassageTable)
Made = TypeVar("Made", bound=TunedCase, covariant=True)

Store = Callable[[Table], Table]
"""Keeps a table, and gives it back as a controller will read it."""


@dataclass(frozen=True)
class Ground(Generic[Table]):
    """What all cases of a tune stand on: the problem, the stamp of the tables, the passes that they are simulated on,
    and where they are kept."""

    config: ResolvedConfig
    origin: Origin
    passes: RandomPasses
    store: Store[Table]


class Epochs(Protocol[Made, Table]):
    """When and on what a regulator decides: at samples of a radar, or at passages over point sensors.

    Everything else of a tune is the same for both.
    """

    def grids(self, config: ResolvedConfig, plant: Plant) -> tuple[Plant, Sequence[Resolution]]:
        """The plant that is designed for in place of the configured `plant`, and the grids of its chains."""
        ...

    def cases(self, ground: Ground[Table], label: str, plant: Plant) -> Sequence[Callable[[], Made]]:
        """Prepare the class `label`; what makes the case of each of its targets, in their order.

        `PlantError` and `InvalidTable` of either are about what was asked for.
        """
        ...


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
