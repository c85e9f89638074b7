"""Weight categories of cuts: limits, running resistance and the stages that they may be given."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from plant_models.errors import PlantError, require
from plant_models.library.data_file import Quantity, number, parse_toml, sourced_table, take_string
from plant_models.library.near_miss import near_miss
from plant_models.library.sourced_value import SourcedValue
from plant_models.rolling_resistance import RollingResistance

FILE = "weight_categories.toml"

CATEGORY_SCHEMA = {
    "mass_above_t": Quantity("t", number),
    "rolling_resistance.mean_n_per_kn": Quantity("N/kN", number),
    "rolling_resistance.std_n_per_kn": Quantity("N/kN", number),
    "allowed_stage": Quantity("1", number),
}
"""Every key of a category."""

YARD_NUMBERS, OWN_NUMBERS = range(1, 6), range(16, 256)
"""Of the five categories of the yard, and of a user's own."""

LOOK_ALIKES = str.maketrans("CT", "СТ")
"""Latin letters that a keyboard puts in place of the Cyrillic ones."""


@dataclass(frozen=True)
class WeightCategory:
    """A category of 4-axle cars heavier than `mass_above_t`, up to the limit of the next category.

    `name` is the Cyrillic name of the sources, `latin` its transcription; `number` stands for it in tables and
    controllers and is fixed for good, wherever the category stands in a file.
    """

    name: str
    number: int
    latin: str
    mass_above_t: float
    resistance: RollingResistance
    allowed_stage: int
    provenance: tuple[SourcedValue, ...]


@cache
def weight_categories() -> tuple[WeightCategory, ...]:
    """All categories of the library, the lightest first."""
    return categories_from_toml(files("plant_models.library").joinpath(FILE).read_text(encoding="utf-8"))


def weight_category(mass_t: float, axles: int = 4) -> WeightCategory:
    """The category of a cut of `mass_t` tonnes on `axles` axles.

    Categories are limits of mass of a 4-axle car; other axle numbers, and cuts of several cars, are
    compared by axle load, as the rail weigher does: the category of 4·`mass_t`/`axles`.
    """
    four_axle_mass_t = 4.0 * mass_t / axles
    return [c for c in weight_categories() if c.mass_above_t < four_axle_mass_t or c.mass_above_t == 0.0][-1]


def weight_category_named(name: str) -> WeightCategory:
    """The category with this Cyrillic or Latin name (Л or L, ЛС or LS, С or S, СТ or ST, Т or T)."""
    for category in weight_categories():
        if name in (category.name, category.latin) or name.translate(LOOK_ALIKES) == category.name:
            return category
    names = [c.name for c in weight_categories()] + [c.latin for c in weight_categories()]
    raise PlantError(f"weight category {name!r} is not in the library; {near_miss(name, names)}")


def categories_from_toml(text: str) -> tuple[WeightCategory, ...]:
    """The categories written in `text`, one table each; `PlantError` names file and key."""
    categories: list[WeightCategory] = []
    for latin, tree in parse_toml(text, FILE).items():
        place = f"{FILE}: {latin}"
        require(isinstance(tree, dict), f"{place} is {tree!r}; it must be a table")
        name = take_string(tree, "name", place)
        its_number = tree.pop("number", None)
        require(
            type(its_number) is int and its_number in (*YARD_NUMBERS, *OWN_NUMBERS),
            f"{place}: number is {its_number!r}; it must be a whole number from 1 to 5 for a category of the yard, "
            "from 16 to 255 for another one",
        )
        same = [c.latin for c in categories if c.number == its_number or c.name == name]
        require(not same, f"{place}: its name {name} or number {its_number} is that of {', '.join(same)}, too")
        table = sourced_table(tree, CATEGORY_SCHEMA, place)
        try:
            resistance = RollingResistance(
                table.number("rolling_resistance.mean_n_per_kn"), table.number("rolling_resistance.std_n_per_kn")
            )
        except PlantError as error:
            raise PlantError(f"{place}: {error}") from None
        limit, stage = table.number("mass_above_t"), table.number("allowed_stage")
        require(stage.is_integer() and stage >= 1, f"{place}: allowed_stage is {stage:g}; it must be 1, 2, 3 …")
        lowest = categories[-1].mass_above_t if categories else None
        require(
            limit == 0.0 if lowest is None else limit > lowest,
            f"{place}: mass_above_t is {limit:g}; the limits must start at 0 and increase",
        )
        categories.append(WeightCategory(name, its_number, latin, limit, resistance, int(stage), table.values))
    require(len(categories) > 0, f"{FILE}: it holds no category")
    return tuple(categories)
