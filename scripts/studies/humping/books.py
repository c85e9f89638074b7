"""Classes of cuts that run exported tables, or the tuned energy rule, tuned for the positions of a hump."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from scripts.studies.side_by_side import side_by_side
from scripts.studies.tuned_table import CREATED
from scripts.studies.yard_chain.park_book import energy_class, tables_of
from synth.retarder.class_setup import ClassSetup, class_setup, origin_of, validation_passes
from synth.retarder.configuration.config_file import parse_config
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
