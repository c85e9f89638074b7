"""Retarders, cars and weight categories as data: every number with unit, range, source and confidence."""

from plant_models.library.car_entry import CarEntry
from plant_models.library.catalogue import car_names, load_car, load_retarder, retarder_names
from plant_models.library.retarder_entry import RetarderEntry
from plant_models.library.source import Source, sources, sources_cited_in
from plant_models.library.sourced_value import SourcedValue, Value
from plant_models.library.weight_category import (
    WeightCategory,
    weight_categories,
    weight_category,
    weight_category_named,
)

__all__ = [
    "CarEntry",
    "RetarderEntry",
    "Source",
    "SourcedValue",
    "Value",
    "WeightCategory",
    "car_names",
    "load_car",
    "load_retarder",
    "retarder_names",
    "sources",
    "sources_cited_in",
    "weight_categories",
    "weight_category",
    "weight_category_named",
]
