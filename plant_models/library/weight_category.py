"""Weight categories of cuts: limits, running resistance and the stages that they may be given."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Final

from plant_models.errors import PlantError, near_miss, require
from plant_models.library.data_file import (
    Quantity,
    number,
    parse_toml,
    shown,
    shown_key,
    sourced_table,
    take_string,
    telling,
)
from plant_models.library.library import TypeFile
from plant_models.library.sourced_value import SourcedTable, SourcedValue
from plant_models.rolling_resistance import RollingResistance

OF_CATEGORY = {
    "rolling_resistance.mean_n_per_kn": Quantity("N/kN", number),
    "rolling_resistance.std_n_per_kn": Quantity("N/kN", number),
    "allowed_stage": Quantity("1", number),
}
ENTRANCE_STAGE: Final = "entrance_stage"
"""A key that may be left out: then the allowed stage is allowed at the entrance, too."""

STAGES: Final = ("allowed_stage", ENTRANCE_STAGE)
"""Keys whose numbers are stages."""

BRAKING_STAGES: Final = "braking_stages"
"""A key of the file that may be left out: of how many braking stages its stages are."""

BY_MASS = {"mass_above_t": Quantity("t", number), **OF_CATEGORY}
BY_AXLE_LOAD = {"axle_load_above_t": Quantity("t", number), **OF_CATEGORY}
"""Every key of a category: its limit is the mass of a 4-axle car, or the load of an axle."""

YARD_NUMBERS: Final = MappingProxyType({"Л": 1, "ЛС": 2, "С": 3, "СТ": 4, "Т": 5})
OWN_NUMBERS: Final = range(16, 256)
"""Of the five categories of the yard, and of a user's own."""

HIGHEST_STAGE: Final = 31
"""More stages than any retarder has; a table holds no more."""

LATIN: Final = re.compile(r"[A-Za-z0-9_-]{1,20}")
"""Of the second name of a category."""

LOOK_ALIKES = str.maketrans("CT", "СТ")
"""Latin letters that a keyboard puts in place of the Cyrillic ones."""


@dataclass(frozen=True)
class WeightCategory:
    """A category of 4-axle cars heavier than `mass_above_t`, up to the limit of the next category.

    `name` is the name in tables, `latin` a second one for keyboards; `number` stands for it in tables and
    controllers and is fixed for good, wherever the category stands in a file. `of_stages`: of how many braking stages
    `allowed_stage` and `entrance_stage` are, None where the file does not say.
    """

    name: str
    number: int
    latin: str
    mass_above_t: float
    resistance: RollingResistance
    allowed_stage: int
    entrance_stage: int
    of_stages: int | None
    provenance: tuple[SourcedValue, ...]

    def __repr__(self) -> str:
        return f"WeightCategory({self.label}, above {self.mass_above_t:g} t)"

    @property
    def label(self) -> str:
        """Both names, where there are two: Л (L)."""
        return self.name if self.name == self.latin else f"{self.name} ({self.latin})"

    def at(self, top_stage: int) -> WeightCategory:
        """The same at a position whose highest stage is `top_stage`: its stages are counted in those of that position.

        Where `of_stages` tells of how many braking stages they are, the same part of them is allowed there, rounded
        down: the highest stays the highest, and a light car gets no harder brake by a coarser division. Otherwise they
        stay as they are, as far as the position has them. Sensible ranges end with the position's highest stage.
        """
        values = tuple(
            counted_in(value, self.of_stages, top_stage) if value.key in STAGES else value for value in self.provenance
        )
        table = SourcedTable(values)
        allowed, at_entrance = (int(table.number(key)) for key in STAGES)
        return replace(self, allowed_stage=allowed, entrance_stage=at_entrance, of_stages=top_stage, provenance=values)


def counted_in(value: SourcedValue, of_stages: int | None, top_stage: int) -> SourcedValue:
    """The number of a stage of `of_stages` (None: of any) at a position whose highest stage is `top_stage`."""
    assert isinstance(value.value, float), value.key
    stage = int(value.value)
    there = min(stage, top_stage) if of_stages is None else top_stage * stage // of_stages
    here = max(there, min(stage, 1))
    low, high = value.range or (0.0, float(top_stage))
    span = min(low, float(here)), float(top_stage if of_stages is not None else min(high, top_stage))
    source = value.source if of_stages in (None, top_stage) else f"{value.source}; {stage} of {of_stages} stages there"
    return replace(value, value=float(here), range=span, source=source)


@dataclass(frozen=True)
class WeightCategories:
    """All categories of a yard, the lightest first."""

    name: str
    title: str
    members: tuple[WeightCategory, ...]

    def __repr__(self) -> str:
        return f"WeightCategories({self.name}: {', '.join(member.label for member in self.members)})"

    def of(self, mass_t: float, axles: int = 4) -> WeightCategory:
        """The category of a cut of `mass_t` tonnes on `axles` axles.

        Categories are limits of mass of a 4-axle car; other axle numbers, and cuts of several cars, are
        compared by axle load, as the rail weigher does: the category of 4·`mass_t`/`axles`.
        """
        four_axle_mass_t = 4.0 * mass_t / axles
        return [c for c in self.members if c.mass_above_t < four_axle_mass_t or c.mass_above_t == 0.0][-1]

    def named(self, name: str) -> WeightCategory:
        """The category with this name or second name (Л or L, ЛС or LS, С or S, СТ or ST, Т or T)."""
        for category in self.members:
            if name in (category.name, category.latin) or name.translate(LOOK_ALIKES) == category.name:
                return category
        names = [c.name for c in self.members] + [c.latin for c in self.members]
        raise PlantError(f"weight category {name!r} is not in the library; {near_miss(name, names)}")


def categories_from(file: TypeFile) -> WeightCategories:
    """The categories written in `file`, one table each; `TypeFileError` names file and key."""
    members: list[WeightCategory] = []
    with telling(file.place, file.text):
        tree = parse_toml(file.text)
        title = take_string(tree, "title")
        of_stages = take_stages(tree)
        for latin, below in tree.items():
            require(
                LATIN.fullmatch(latin) is not None,
                f"{shown_key(latin)} is no name of a category's table; it must have at most 20 Latin letters, digits, "
                "hyphens and underscores",
            )
            require(isinstance(below, dict), f"{latin} is {shown(below)}; it must be a table")
            with telling(file.place, file.text, {"rolling resistance: ": "rolling_resistance."}, latin):
                members.append(replace(category_of(latin, below, tuple(members), file.origin), of_stages=of_stages))
                require_among(members[-1], of_stages)
        require(len(members) > 0, "it holds no category")
    return WeightCategories(file.name, title, tuple(members))


def take_stages(tree: dict[str, Any]) -> int | None:
    """Remove and return the number of braking stages that stages are counted in, None where it is left out."""
    if BRAKING_STAGES not in tree:
        return None
    stages = tree.pop(BRAKING_STAGES)
    whole = isinstance(stages, int) and not isinstance(stages, bool)
    require(
        whole and 1 <= stages <= HIGHEST_STAGE,
        f"{BRAKING_STAGES} is {shown(stages)}; it must be a whole number from 1 to {HIGHEST_STAGE}",
    )
    return int(stages)


def require_among(category: WeightCategory, of_stages: int | None) -> None:
    """Raise where a category has a stage beyond those that stages are counted in."""
    for key, stage in zip(STAGES, (category.allowed_stage, category.entrance_stage), strict=True):
        require(
            of_stages is None or stage <= of_stages,
            f"{key} is {stage}; it must be at most {of_stages}, the {BRAKING_STAGES} of this file",
        )


def category_of(latin: str, tree: dict[str, Any], lighter: tuple[WeightCategory, ...], origin: str) -> WeightCategory:
    """The category in the table `latin`; `lighter`: those before it in the file."""
    name, its_number = take_string(tree, "name"), tree.pop("number", None)
    require(len(name) <= 40, f"name is {name[:40]!r}…; it must have at most 40 characters")
    require_number(name, its_number)
    same = [c.latin for c in lighter if its_number == c.number or {name, latin} & {c.name, c.latin}]
    require(not same, f"its name {name} or number {its_number} is that of {', '.join(same)}, too")
    schema = BY_AXLE_LOAD if "axle_load_above_t" in tree else BY_MASS
    if ENTRANCE_STAGE in tree:
        schema = {**schema, ENTRANCE_STAGE: Quantity("1", number)}
    table = with_entrance_stage(sourced_table(tree, schema, origin))
    by_axle = "axle_load_above_t" in tree
    key = "axle_load_above_t" if by_axle else "mass_above_t"
    limit = table.number(key) * (4.0 if by_axle else 1.0)  # exact: the limits of a 4-axle car
    resistance = RollingResistance(
        table.number("rolling_resistance.mean_n_per_kn"), table.number("rolling_resistance.std_n_per_kn")
    )
    allowed, at_entrance = table.number("allowed_stage"), table.number(ENTRANCE_STAGE)
    for of_stage, stage, least in (("allowed_stage", allowed, 1), (ENTRANCE_STAGE, at_entrance, 0)):
        require(
            stage.is_integer() and least <= stage <= HIGHEST_STAGE,
            f"{of_stage} is {stage:g}; it must be a whole number from {least} to {HIGHEST_STAGE}",
        )
    lowest = lighter[-1].mass_above_t if lighter else None
    require(
        limit == 0.0 if lowest is None else limit > lowest,
        f"{key} is {table.number(key):g}; the limits must start at 0 and increase",
    )
    stages = int(allowed), int(at_entrance)
    return WeightCategory(name, its_number, latin, limit, resistance, *stages, None, table.values)


def with_entrance_stage(table: SourcedTable) -> SourcedTable:
    """`table` with the stage allowed at the entrance, if need be that of the whole position."""
    if any(value.key == ENTRANCE_STAGE for value in table.values):
        return table
    allowed = table["allowed_stage"]
    return SourcedTable((*table.values, replace(allowed, key=ENTRANCE_STAGE, source="not stated: as allowed_stage")))


def require_number(name: str, number_of_category: object) -> None:
    """Raise unless the number may stand for the category `name`: the yard's five have theirs for good."""
    yard = YARD_NUMBERS.get(name)
    if yard is not None:
        require(
            type(number_of_category) is int and number_of_category == yard,
            f"number is {number_of_category!r}; it must be {yard}, the number of {name} in every table",
        )
        return
    require(
        type(number_of_category) is int and number_of_category in OWN_NUMBERS,
        f"number is {number_of_category!r}; it must be a whole number from {OWN_NUMBERS[0]} to {OWN_NUMBERS[-1]}, as "
        "this is no category of the yard",
    )
