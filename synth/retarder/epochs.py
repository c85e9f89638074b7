"""Decision epochs: when and on what a regulator decides, as far as the one tune of all tables must know it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

from plant_models import Plant
from synth.problem.resolution import Resolution
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tuned_case import TunedCase
from tuning_tables import ControllerTable
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
