"""Plants and tables of the tests of identification: ours as assumed, and the foreign railway."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from plant_models import Plant
from tests.studies.identification.coarse_table import coarse_table
from tests.studies.identification.foreign.foreign_plant import ForeignPlant, neighbour_of_knp5
from tests.synth.conftest import plant_22t, plant_52t, plant_of
from tuning_tables import ControllerTable

__all__ = ["plant_22t", "plant_52t", "plant_of"]

MASSES_T = {"empty": 22.0, "half": 52.0}
TARGET_M_S = 3.0


@pytest.fixture(scope="session")
def assumed_plants(plant_of: Callable[[float], Plant]) -> Mapping[str, Plant]:
    """Our plant by class, with assumed parameters."""
    return {label: plant_of(mass) for label, mass in MASSES_T.items()}


@pytest.fixture(scope="session")
def assumed_tables(assumed_plants: Mapping[str, Plant]) -> Mapping[str, ControllerTable]:
    """Tables to 3 m/s by class, tuned for the assumed parameters."""
    return {label: coarse_table(plant, TARGET_M_S) for label, plant in assumed_plants.items()}


@pytest.fixture(scope="session")
def foreign_plants(assumed_plants: Mapping[str, Plant]) -> Mapping[str, ForeignPlant]:
    """The foreign railway by class: the same cuts on a neighbour of the same position."""
    cuts = {label: plant.cut for label, plant in assumed_plants.items()}
    return {label: neighbour_of_knp5(cut.mass_t, cut.category, cut.axle_offsets_m) for label, cut in cuts.items()}
