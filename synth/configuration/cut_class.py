"""One cut class of a configuration: the cut, its running resistance, and the origin of its numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from plant_models import Cut, PlantError, RollingResistance, couple
from plant_models.library import (
    CarEntry,
    RetarderEntry,
    SourcedValue,
    car_names,
    load_car,
    weight_category,
    weight_category_named,
)
from plant_models.library.near_miss import near_miss
from plant_models.library.sourced_value import SET_BY_USER, SourcedTable
from synth.configuration.settings import DEFAULT_CUTS, CutSettings
from synth.faults.input_error import InputError
from tuning_tables.excerpt import excerpt

DEFAULT_BOOK = "default book: one gondola for each weight category"


@dataclass(frozen=True)
class CutClass:
    """A labelled cut, its resistance, and the origin of its numbers (keys as in the configuration)."""

    label: str
    car: str
    cars: int
    cut: Cut
    resistance: RollingResistance
    provenance: tuple[SourcedValue, ...]

    def canonical(self) -> dict[str, Any]:
        """The class as it enters the canonical JSON."""
        return {
            "label": self.label,
            "car": self.car,
            "cars": self.cars,
            "mass_t": self.cut.mass_t,
            "category": self.cut.category,
            "allowed_stage": self.cut.allowed_stage,
            "axle_offsets_m": self.cut.axle_offsets_m,
            "rolling_resistance": {
                "mean_n_per_kn": self.resistance.mean_n_per_kn,
                "std_n_per_kn": self.resistance.std_n_per_kn,
            },
        }


def resolve_cut(settings: CutSettings, index: int, retarder: RetarderEntry, file: str) -> CutClass:
    """The cut class of one [[cut]] table."""
    key = f"cut[{index}]"
    if settings.car not in car_names():
        raise InputError(
            f"{file}: {key}.car is {excerpt(settings.car)!r}, which the library does not hold; "
            f"{near_miss(settings.car, car_names())}"
        )
    entry = load_car(settings.car)
    lightest, heaviest = settings.cars * entry.car.tare_t, settings.cars * entry.car.gross_t
    if not lightest <= settings.mass_t <= heaviest:
        raise InputError(
            f"{file}: {key}.mass_t is {settings.mass_t!r}; {settings.cars} × {settings.car} weigh together "
            f"from {lightest:g} t (tare) to {heaviest:g} t (gross)"
        )
    top = retarder.position.top_stage
    if settings.allowed_stage is not None and not 1 <= settings.allowed_stage <= top:
        raise InputError(
            f"{file}: {key}.allowed_stage is {settings.allowed_stage}; it must be from 1 to {top}, "
            f"the highest stage of {retarder.name}"
        )
    try:
        axles = settings.cars * len(entry.car.axle_offsets_m)
        by_mass = weight_category(settings.mass_t, axles)
        category = by_mass if settings.category is None else weight_category_named(settings.category)
        changed = settings.rolling_resistance.model_dump(exclude_none=True)
        overrides = {f"rolling_resistance.{name}": value for name, value in changed.items()}
        if settings.allowed_stage is not None:
            overrides["allowed_stage"] = float(settings.allowed_stage)
        table = SourcedTable(category.provenance).replaced(overrides)
        resistance = RollingResistance(
            table.number("rolling_resistance.mean_n_per_kn"), table.number("rolling_resistance.std_n_per_kn")
        )
        stage = int(table.number("allowed_stage"))
        cut = couple((entry.car,) * settings.cars, settings.mass_t, category.name, stage, category.number)
    except PlantError as error:
        sentence = str(error).replace("rolling resistance: ", f"{key}.rolling_resistance.").replace("cut: ", f"{key}.")
        sentence = sentence.replace("weight category ", f"{key}.category is ").replace(" is not in", ", not in")
        raise InputError(f"{file}: {excerpt(sentence, 400)}") from None
    many = f"x{settings.cars}" if settings.cars > 1 else ""
    label = settings.label or f"{settings.car}{many}-{settings.mass_t:g}t"
    provenance = tuple(cut_values(settings, key, entry, table))
    return CutClass(label, settings.car, settings.cars, cut, resistance, provenance)


def cut_values(settings: CutSettings, key: str, entry: CarEntry, category: SourcedTable) -> Iterator[SourcedValue]:
    """The numbers of a cut class with their origin."""
    source = DEFAULT_BOOK if settings in DEFAULT_CUTS else SET_BY_USER
    limits = (settings.cars * entry.car.tare_t, settings.cars * entry.car.gross_t)
    yield SourcedValue(f"{key}.mass_t", settings.mass_t, "t", limits, source, "")
    yield SourcedValue(f"{key}.cars", float(settings.cars), "1", (1.0, 60.0), source, "")
    for value in entry.provenance:
        if value.key in ("length_m", "pivot_base_m", "bogie_axle_offsets_m"):
            yield replace(value, key=f"{key}.car.{value.key}")
    for value in category.values:
        if value.key != "mass_above_t":
            yield replace(value, key=f"{key}.{value.key}")


def category_warnings(cuts: tuple[CutClass, ...]) -> Iterator[str]:
    """A sentence for every cut whose category is not that of its axle load."""
    for i, c in enumerate(cuts):
        by_mass = weight_category(c.cut.mass_t, c.cut.axles).name
        if by_mass != c.cut.category:
            yield f"cut[{i}].category is {c.cut.category}; by its axle load the cut is {by_mass}"
