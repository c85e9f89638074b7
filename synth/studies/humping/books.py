"""Positions that run exported tables in their closed loop, tuned for the cuts of a hump."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from plant_models import Plant, PressingForce, WeightForce
from plant_models.library.weight_category import WeightCategories
from synth.book.class_setup import class_setup, origin_of, validation_passes
from synth.configuration.config_file import parse_config
from synth.configuration.resolved_config import ResolvedConfig
from synth.studies.humping.base_trial import Day, with_stds
from synth.studies.humping.day_figures import Pair
from synth.studies.humping.disturbances import OILED, WEAKER
from synth.studies.robustness.plant_values import SLOPES, STAGE_PRESSURES, with_values
from synth.studies.side_by_side import side_by_side
from synth.studies.study import Tell
from synth.studies.tuned_table import CREATED
from synth.studies.yard_chain.park_book import tables_of
from synth.yard.humping.class_choice import ClassChoice
from synth.yard.humping.table_hump_position import TableHumpPosition
from synth.yard.humping.train_source import DrawnSource
from synth.yard.humping.trial import HumpTrial
from synth.yard.table_class import TableClass, table_classes

MASSES_T = {"L": 23.0, "LS": 36.0, "S": 52.0, "ST": 66.0, "T": 86.0}
"""Of a car of the class of each category."""

CARS = (1, 3)
"""Cars of the classes; a class stands for cuts of nearly so many axles."""

TABLES_STD_M_S = 0.05
"""Error that the exit speeds of the last position are chosen with where it runs tables."""


@dataclass(frozen=True)
class Book:
    """What a position of the library is tuned for."""

    position: str
    entry_m_s: tuple[float, float]
    targets_m_s: tuple[float, ...]

    def config(self) -> ResolvedConfig:
        """The configuration that a user would write."""
        classes = "".join(
            f'[[cut]]\nlabel = "{name}-{count}"\ncar = "gondola-4"\ncars = {count}\nmass_t = {mass * count}\n'
            for name, mass in MASSES_T.items()
            for count in CARS
        )
        low, high = self.entry_m_s
        text = (
            f'[position]\nname = "{self.position}"\n[entry]\nlow_m_s = {low}\nhigh_m_s = {high}\n'
            f"[targets]\nexit_speeds_m_s = [{', '.join(map(str, self.targets_m_s))}]\n{classes}"
        )
        return parse_config(text, f"book of {self.position}")

    def classes(self) -> tuple[TableClass, ...]:
        """The classes with their tables, as they are read back."""
        config = self.config()
        origin, passes = origin_of(config.sha256, CREATED), validation_passes(config)
        setups = [class_setup(config, label, plant, passes, origin) for label, plant in config.plants()]
        made = side_by_side(lambda setup: tables_of(config, setup), setups)
        return table_classes([table for of_class in made for table in of_class], config, f"book of {self.position}")


HIGHEST_M_S = 6.5
"""Highest exit speed of the books for intervals: cuts come with 7 m/s at most."""

BUNCH = Book("knp-5-bunch", (4.5, 7.0), (3.0, 4.0, 5.0, 6.0, HIGHEST_M_S))
TABLES = "our tables in their closed loop"

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


def table_positions(trial: HumpTrial) -> TablePositions:
    """The books of all positions of `trial`; the same book is tuned once."""
    assert isinstance(trial.source, DrawnSource)
    of_book = {book: book.classes() for book in dict.fromkeys(BOOKS)}
    return TablePositions(tuple(of_book[book] for book in BOOKS), trial.source.people.categories)


def table_pairs(day: Day, stds_m_s: tuple[float, ...], tell: Tell) -> list[Pair]:
    """A pair for our tables, as tuned and on plants that they were not tuned for, beside normal positions."""
    aimed = replace(day, std_m_s=TABLES_STD_M_S, more=f"[exit_speeds]\nhighest_m_s = [{HIGHEST_M_S}, {HIGHEST_M_S}]\n")
    base = aimed.trial()
    made = table_positions(base)
    tell("books tuned")
    rows = [
        Pair(f"normal, σ {std:g}, commands for σ {TABLES_STD_M_S:g}", with_stds(base, (std,) * 3)) for std in stds_m_s
    ]
    rows.append(Pair(TABLES, made.on(base)))
    rows.append(Pair(f"{TABLES}, friction −30 %", made.changed({FRICTION: OILED}).on(base)))
    rows.append(Pair(f"{TABLES}, stages at {WEAKER:g} of their pressure", made.changed({SUPPLY: WEAKER}).on(base)))
    return rows
