"""Books of tables, or the tuned energy rule, tuned for the positions of a hump, and all positions in their closed
loop, on the plants that they were tuned for or on others.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from plant_models import Plant, PressingForce, WeightForce
from plant_models.library.weight_category import WeightCategories
from scripts.studies.cases import CREATED, side_by_side
from scripts.studies.yard_chain.park_book import energy_class, tables_of
from synth.hump.rolling.table_hump_position import ClassChoice, TableHumpPosition
from synth.hump.trial.trial import HumpTrial
from synth.retarder.class_setup import ClassSetup, class_setup, origin_of, validation_passes
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.plant_values import SLOPES, STAGE_PRESSURES, with_values
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.table_class import TableClass, table_classes

MASSES_T = {"L": 23.0, "LS": 36.0, "S": 52.0, "ST": 66.0, "T": 86.0}
"""Of a car of the class of each category."""

CARS = (1, 3)
"""Cars of the classes; a class stands for cuts of nearly so many axles."""


@dataclass(frozen=True)
class Book:
    """What a position of the library is tuned for."""

    position: str
    entry_m_s: tuple[float, float]
    targets_m_s: tuple[float, ...]

    def config(self, estimator: bool, criterion: str = "") -> ResolvedConfig:
        """The configuration that a user would write; `criterion`: lines of its section."""
        classes = "".join(
            f'[[cut]]\nlabel = "{name}-{count}"\ncar = "gondola-4"\ncars = {count}\nmass_t = {mass * count}\n'
            for name, mass in MASSES_T.items()
            for count in CARS
        )
        low, high = self.entry_m_s
        text = (
            f'[position]\nname = "{self.position}"\n[entry]\nlow_m_s = {low}\nhigh_m_s = {high}\n'
            f"[targets]\nexit_speeds_m_s = [{', '.join(map(str, self.targets_m_s))}]\n"
            f"[regulator]\nestimator = {str(estimator).lower()}\n[criterion]\n{criterion}{classes}"
        )
        return parse_config(text, f"book of {self.position}")

    def tables(self) -> tuple[TableClass, ...]:
        """The classes with their tables, as they are read back."""
        return self.read_back(self.config(estimator=False))

    def estimating_tables(self) -> tuple[TableClass, ...]:
        """The same with tables that are designed for an estimator of speed and friction."""
        return self.read_back(self.config(estimator=True))

    def energy_rule(self) -> tuple[TableClass, ...]:
        """The classes under the energy rule, tuned for each class and target as a comparison tunes it."""
        config = self.config(estimator=False)
        return side_by_side(lambda setup: energy_class(config, setup), self.setups(config))

    def read_back(self, config: ResolvedConfig) -> tuple[TableClass, ...]:
        """The classes of `config` with the tables that a tune of it makes."""
        made = side_by_side(lambda setup: tables_of(config, setup), self.setups(config))
        return table_classes([table for of_class in made for table in of_class], config, f"book of {self.position}")

    @staticmethod
    def setups(config: ResolvedConfig) -> list[ClassSetup]:
        """What the targets of each class share."""
        origin, passes = origin_of(config.sha256, CREATED), validation_passes(config)
        return [class_setup(config, label, plant, passes, origin) for label, plant in config.plants()]


Regulator = Callable[[Book], tuple[TableClass, ...]]
"""What makes the classes of a book."""

HIGHEST_M_S = 6.5
"""Highest exit speed of the books for intervals: cuts come with 7 m/s at most."""

BUNCH = Book("knp-5-bunch", (4.5, 7.0), (3.0, 4.0, 5.0, 6.0, HIGHEST_M_S))
PARK = Book("rnz-2m-park", (2.0, 5.5), (0.8, 1.2, 1.6, 2.2, 3.0, 4.5))
BOOKS = (BUNCH, BUNCH, PARK)
"""By position; the first has the type of the second on the hump of the studies."""


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
