"""A cut class of a configuration: the cut, its running resistance, its target speeds, and the origin of its numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from plant_models import Cut, EntryLaw, PlantError, RollingResistance, couple
from plant_models.library import Library, PositionEntry, SourcedValue, WeightCategories, WeightCategory
from plant_models.library.data_file import keyed
from plant_models.library.entry_values import entry_law, with_entry
from plant_models.library.sourced_value import SET_BY_USER, SourcedTable
from synth.frame.faults import InputError
from synth.retarder.configuration.consist import Consist, consist_values, resolve_consist
from synth.retarder.configuration.plant_fault import in_file
from synth.retarder.configuration.plant_settings import DEFAULT_CUTS, CutSettings

DEFAULT_BOOK = "default book: one gondola for each weight category"

LIMITS_OF_CATEGORY = ("mass_above_t", "axle_load_above_t")
"""Keys of a category that are not of a cut."""

LONGEST_LABEL = 61
"""Characters of a label, which file names begin with."""


@dataclass(frozen=True)
class CutClass:
    """A labelled cut, its resistance, and the origin of its numbers (keys as in the configuration).

    `mass_limits_t`: what the cut can weigh without leaving its category. `entry`, `targets_m_s`: the class's own entry
    speeds and exit speeds, None where those of the configuration hold.
    """

    label: str
    consist: Consist
    cut: Cut
    resistance: RollingResistance
    entrance_stage: int
    mass_limits_t: tuple[float, float]
    entry: EntryLaw | None
    targets_m_s: tuple[float, ...] | None
    provenance: tuple[SourcedValue, ...]

    def canonical(self) -> dict[str, Any]:
        """The class as it enters the canonical JSON; what it has not of its own is left out."""
        first, *others = self.consist.parts
        own: dict[str, Any] = {"car": first.entry.name, "cars": first.count}
        if others:
            own = {"consist": [{"car": part.entry.name, "cars": part.count} for part in self.consist.parts]}
        if self.entry is not None:
            values = (value for value in self.provenance if ".entry." in value.key)
            own["entry"] = {value.key.rpartition(".")[2]: value.value for value in values}
        if self.targets_m_s is not None:
            own["targets_m_s"] = self.targets_m_s
        if self.cut.category_number is not None and self.cut.category_number > 5:
            own["category_number"] = self.cut.category_number
        return {
            **own,
            "label": self.label,
            "mass_t": self.cut.mass_t,
            "category": self.cut.category,
            "allowed_stage": self.cut.allowed_stage,
            "axle_offsets_m": self.cut.axle_offsets_m,
            "rolling_resistance": {
                "mean_n_per_kn": self.resistance.mean_n_per_kn,
                "std_n_per_kn": self.resistance.std_n_per_kn,
            },
        }


@dataclass(frozen=True)
class Surroundings:
    """What the classes of a configuration have in common; `file` is what messages call it."""

    position: PositionEntry
    categories: WeightCategories
    library: Library
    file: str


def resolve_cut(settings: CutSettings, index: int, at: Surroundings) -> CutClass:
    """The cut class of one [[cut]] table."""
    key, file = f"cut[{index}]", at.file
    consist = resolve_consist(settings, key, at.library, file)
    top = at.position.position.top_stage
    for name, stage, least in (("allowed", settings.allowed_stage, 1), ("entrance", settings.entrance_stage, 0)):
        if stage is not None and not least <= stage <= top:
            raise InputError(
                f"{file}: {key}.{name}_stage is {stage}; it must be from {least} to {top}, "
                f"the highest stage of {at.position.name}"
            )
    with in_file(file, lambda sentence: of_class(sentence, key)):
        axles = sum(len(car.axle_offsets_m) for car in consist.cars)
        by_mass = at.categories.of(consist.mass_t, axles)
        category = (by_mass if settings.category is None else at.categories.named(settings.category)).at(top)
        table = SourcedTable(category.provenance).replaced(overrides_of(settings))
        resistance = RollingResistance(
            table.number("rolling_resistance.mean_n_per_kn"), table.number("rolling_resistance.std_n_per_kn")
        )
        stage = int(table.number("allowed_stage"))
        cut = couple(consist.cars, consist.mass_t, category.name, stage, category.number)
        entry_values, entry = own_entry(settings, at.position)
    targets = settings.targets_m_s
    if targets is not None:
        resolve_targets(f"{key}.targets_m_s", targets, entry or at.position.entry, file)
    source = DEFAULT_BOOK if settings in DEFAULT_CUTS else SET_BY_USER
    provenance = (
        *consist_values(consist, key, source),
        *(replace(value, key=f"{key}.{value.key}") for value in table.values if value.key not in LIMITS_OF_CATEGORY),
        *(replace(value, key=f"{key}.entry.{value.key}") for value in entry_values),
        *target_values(targets, key),
    )
    limits = mass_limits_t(consist, category, at.categories, axles)
    label = settings.label or consist.label
    if len(label) > LONGEST_LABEL:
        raise InputError(f"{file}: {key}.label is missing; the names of so many cars make none: give the class a label")
    at_entrance = int(table.number("entrance_stage"))
    return CutClass(label, consist, cut, resistance, at_entrance, limits, entry, targets, provenance)


def of_class(sentence: str, key: str) -> str:
    """The plant's sentence with the key path of a class."""
    keys = {
        "rolling resistance: ": f"{key}.rolling_resistance.",
        "cut: ": f"{key}.",
        "entry: ": f"{key}.entry.",
        "weight category ": f"{key}.category is ",
    }
    return keyed(sentence, keys).replace(" is not in the library", ", not in the library")


def overrides_of(settings: CutSettings) -> dict[str, float]:
    """What a [[cut]] table changes of its category."""
    changed = settings.rolling_resistance.model_dump(exclude_none=True)
    overrides = {f"rolling_resistance.{name}": float(value) for name, value in changed.items()}
    for name in ("allowed_stage", "entrance_stage"):
        stage = getattr(settings, name)
        if stage is not None:
            overrides[name] = float(stage)
    return overrides


def own_entry(settings: CutSettings, position: PositionEntry) -> tuple[tuple[SourcedValue, ...], EntryLaw | None]:
    """The entry speeds of a class with their origin; nothing where it has none of its own."""
    changes = settings.entry.model_dump(exclude_none=True)
    if not changes:
        return (), None
    values = with_entry(position.entry_provenance, changes)
    law = entry_law(SourcedTable(values), "")
    highest = position.position.max_entry_speed_m_s
    if law.high_m_s > highest:
        raise PlantError(
            f"entry: {law.high_key} is {law.high_m_s:g}; {position.name} takes at most {highest:g} m/s: lower it"
        )
    return values, law


def target_values(targets_m_s: tuple[float, ...] | None, key: str) -> Iterator[SourcedValue]:
    """The targets of a class with their origin."""
    if targets_m_s is not None:
        yield SourcedValue(f"{key}.targets_m_s", targets_m_s, "m/s", None, SET_BY_USER, "")


def mass_limits_t(
    consist: Consist, category: WeightCategory, categories: WeightCategories, axles: int
) -> tuple[float, float]:
    """What the cut can weigh: tare and gross mass, and the limits of its category."""
    heavier = axles / 4.0
    next_limits = [c.mass_above_t * heavier for c in categories.members if c.mass_above_t * heavier >= consist.mass_t]
    lightest, heaviest = consist.limits_t
    return max(lightest, category.mass_above_t * heavier), min([heaviest, *next_limits])


def category_warnings(cuts: tuple[CutClass, ...], categories: WeightCategories) -> Iterator[str]:
    """A sentence for every cut whose category is not that of its axle load."""
    for i, c in enumerate(cuts):
        by_mass = categories.of(c.cut.mass_t, c.cut.axles).name
        if by_mass != c.cut.category:
            yield f"cut[{i}].category is {c.cut.category}; by its axle load the cut is {by_mass}"


def resolve_targets(key: str, speeds_m_s: tuple[float, ...], entry: EntryLaw, file: str) -> tuple[float, ...]:
    """The targets under `key`, which must be different and below the highest entry speed."""
    for speed in speeds_m_s:
        if not 0.3 <= speed < entry.high_m_s:
            raise InputError(
                f"{file}: {key} holds {speed!r}; a target must be at least 0.3 m/s and below the highest entry speed, "
                f"entry.high_m_s = {entry.high_m_s:g}"
            )
    named: dict[str, float] = {}
    for speed in speeds_m_s:
        name = f"{speed:g}"
        if name in named:
            raise InputError(
                f"{file}: {key} holds {named[name]!r} and {speed!r}, but tables are named by six digits of their "
                "target; give each only once"
            )
        named[name] = speed
    return speeds_m_s
