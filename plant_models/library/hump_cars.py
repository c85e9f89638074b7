"""For which cars a hump was made: a key of its file that may be left out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from plant_models.library.data_file import shown
from plant_models.library.hump_forms import texts, whole

CATEGORIES: Final = "categories"
MOST_CARS: Final = "most_cars"

FORM: Final = f'a table such as {{ {CATEGORIES} = ["L"], {MOST_CARS} = 1 }}, with one of the two keys or both'


@dataclass(frozen=True)
class ForCars:
    """Names of the weight `categories` of the cuts that a hump is for, None: all; `most_cars` of a cut, None: any."""

    categories: tuple[str, ...] | None
    most_cars: int | None

    @property
    def table(self) -> dict[str, Any]:
        """As a hump file has it."""
        names = None if self.categories is None else list(self.categories)
        told = {CATEGORIES: names, MOST_CARS: self.most_cars}
        return {key: value for key, value in told.items() if value is not None}


def for_cars(raw: object) -> ForCars:
    """What the file says; `ValueError` with a sentence on what is wrong in it."""
    if not isinstance(raw, dict) or not raw or not set(raw) <= {CATEGORIES, MOST_CARS}:
        raise ValueError(f"for_cars is {shown(raw)}; it must be {FORM}")
    categories, most = (raw.get(key) for key in (CATEGORIES, MOST_CARS))
    names = None if categories is None else texts(categories)
    if categories is not None and not names:
        raise ValueError(
            f"for_cars.{CATEGORIES} is {shown(categories)}; it must be a list of names of weight categories"
        )
    count = whole(most)
    if most is not None and (count is None or count < 1):
        raise ValueError(f"for_cars.{MOST_CARS} is {shown(most)}; it must be a whole number from 1 on")
    return ForCars(names, count)
