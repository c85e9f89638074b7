"""The values of a hump file: the form of each, numbers with a unit of their own ("4 mph"), for which cars a hump
was made; and what is at fault in them, each fault with its place, collected, so that all are told at once.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Final

from plant_models.errors import PlantError
from plant_models.library.data_file import number, pairs, shown
from plant_models.library.toml_lines import Place

UNITS: Final[Mapping[str, Mapping[str, float]]] = {
    "m/s": {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": 0.44704, "ft/s": 0.3048},
    "m": {"m": 1.0, "ft": 0.3048, "yd": 0.9144},
    "t": {"t": 1.0, "kg": 0.001, "short tons": 0.90718474, "long tons": 1.0160469088, "lb": 0.00045359237},
    "permille": {"permille": 1.0, "%": 10.0},
}
"""By declared unit: what a file may write, and how much of the declared unit it is. "tons" alone are no unit: they may
be short or long ones."""

IN_NAMES: Final = {"_m_s": "m/s", "_m": "m", "_t": "t", "_permille": "permille"}
"""By the end of a key: the unit that it has."""

WRITTEN: Final = re.compile(r"([-+]?[0-9]+(?:\.[0-9]+)?) ?([^0-9]+)")


def in_unit(raw: Any, unit: str) -> Any:
    """`raw` with each number that is written with a unit as a number in `unit`; all else as it is. A list or a table is
    taken value by value."""
    if isinstance(raw, list):
        return [in_unit(each, unit) for each in raw]
    if isinstance(raw, dict):
        return {key: in_unit(each, unit) for key, each in raw.items()}
    found = WRITTEN.fullmatch(raw) if isinstance(raw, str) else None
    factor = UNITS.get(unit, {}).get(found[2]) if found else None
    return raw if found is None or factor is None else float(found[1]) * factor


def unit_in_name(key: str) -> str:
    """The unit that ends `key`, of those that may be written in another way; '' where it has none of them."""
    found = (unit for end, unit in IN_NAMES.items() if key.endswith(end) and not key.endswith(f"_per{end}"))
    return next(found, "")


def words_for(raw: object, unit: str) -> str:
    """What `raw` must be, where it is no number but could be one with a unit; '' where it could not."""
    if not isinstance(raw, str) or unit not in UNITS:
        return ""
    return f"a number in {unit}, or in quotes a number with one of the units {', '.join(UNITS[unit])}"


def unit_schema(unit: str) -> dict[str, Any] | None:
    """The JSON Schema of a number with its unit; None where `unit` alone is allowed."""
    if unit not in UNITS:
        return None
    return {"type": "string", "pattern": rf"^[-+]?[0-9]+(\.[0-9]+)? ?({'|'.join(UNITS[unit])})$"}


class HumpFileFault(PlantError):
    """What is at fault in a hump file, and at which `place` of it."""

    def __init__(self, place: Place, sentence: str) -> None:
        super().__init__(sentence)
        self.place = place


@dataclass
class FoundFaults:
    """The faults of a file so far, each once: that of a type is met in every row that names it."""

    by_place: dict[tuple[Place, str], HumpFileFault] = field(default_factory=dict)

    def add(self, place: Place, sentence: str) -> None:
        """One more."""
        self.by_place.setdefault((place, sentence), HumpFileFault(place, sentence))

    @contextmanager
    def collecting(self) -> Iterator[None]:
        """Within, a `HumpFileFault` ends the block and is kept here."""
        try:
            yield
        except HumpFileFault as fault:
            self.add(fault.place, str(fault))

    @property
    def faults(self) -> tuple[HumpFileFault, ...]:
        """All, in the order in which they were found."""
        return tuple(self.by_place.values())

    def __len__(self) -> int:
        return len(self.by_place)


LONGEST_NAME: Final = 24
"""Characters; a longer name leaves no room on a plan."""


def text(raw: object) -> str | None:
    """A non-empty string of printable characters."""
    return raw if isinstance(raw, str) and raw and raw.isprintable() else None


def short_text(raw: object) -> str | None:
    """A non-empty string of at most 24 printable characters."""
    found = text(raw)
    return found if found is not None and len(found) <= LONGEST_NAME else None


def texts(raw: object) -> tuple[str, ...] | None:
    """A list of non-empty strings of printable characters."""
    items = [text(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def whole(raw: object) -> int | None:
    """A whole number."""
    return raw if isinstance(raw, int) and not isinstance(raw, bool) else None


def wholes(raw: object) -> tuple[int, ...] | None:
    """A list of whole numbers."""
    items = [whole(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def truth(raw: object) -> bool | None:
    """True or false."""
    return raw if isinstance(raw, bool) else None


def some_numbers(raw: object) -> tuple[float, ...] | None:
    """A list of finite numbers."""
    items = [number(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def triples(raw: object) -> tuple[tuple[float, float, float], ...] | None:
    """A list of [from_m, to_m, turn_deg], each of three finite numbers."""
    items = [some_numbers(x) for x in raw] if isinstance(raw, list) else [None]
    rows = [(x[0], x[1], x[2]) for x in items if x is not None and len(x) == 3]
    return tuple(rows) if len(rows) == len(items) else None


def some_pairs(raw: object) -> tuple[tuple[float, float], ...] | None:
    """A list of pairs of finite numbers."""
    return () if raw == [] else pairs(raw)


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
