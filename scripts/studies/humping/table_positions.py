"""All positions of a hump in their closed loop, on the plants that they were tuned for or on others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from plant_models import Plant, PressingForce, WeightForce
from plant_models.library.weight_category import WeightCategories
from scripts.studies.humping.books import BOOKS, Regulator
from synth.hump.trains.class_choice import ClassChoice
from synth.hump.trains.table_hump_position import TableHumpPosition
from synth.hump.trains.trial import HumpTrial
from synth.retarder.configuration.plant_values import SLOPES, STAGE_PRESSURES, with_values
from synth.retarder.table_class import TableClass


@dataclass(frozen=True)
class TablePositions:
    """The classes of all positions."""

    classes: tuple[tuple[TableClass, ...], ...]
    categories: WeightCategories

    def on(self, trial: HumpTrial) -> HumpTrial:
        """The trial with these positions."""
        positions = tuple(TableHumpPosition(ClassChoice(each, self.categories)) for each in self.classes)
        return replace(trial, positions=positions)

    def changed(self, values: Mapping[str, float]) -> TablePositions:
        """The same tables on other plants: `FRICTION` or `SUPPLY` times so much; no controller knows."""
        return replace(self, classes=tuple(tuple(other_plant(c, values) for c in each) for each in self.classes))


FRICTION, SUPPLY = "friction", STAGE_PRESSURES


def other_plant(of_class: TableClass, values: Mapping[str, float]) -> TableClass:
    """A class with its controllers on another plant."""
    return replace(of_class, plant=with_values(of_class.plant, keyed(of_class.plant, values)))


def keyed(plant: Plant, values: Mapping[str, float]) -> dict[str, float]:
    """The keys of this plant; friction is in the slope of its force."""
    force = plant.position.force
    if isinstance(force, PressingForce):
        slope, now = SLOPES[0], force.slope_kn_per_kpa_per_pair
    else:
        assert isinstance(force, WeightForce)
        slope, now = SLOPES[1], force.slope_kn_per_kpa_per_t
    return {slope if key == FRICTION else key: now * v if key == FRICTION else v for key, v in values.items()}


def table_positions(trial: HumpTrial, regulator: Regulator) -> TablePositions:
    """The books of all positions of `trial` under `regulator`; the same book is tuned once."""
    of_book = {book: regulator(book) for book in dict.fromkeys(BOOKS)}
    return TablePositions(tuple(of_book[book] for book in BOOKS), trial.source.people.categories)
