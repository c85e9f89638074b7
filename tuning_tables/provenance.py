"""Where a table comes from and what it is for: the generator, the retarder and the cut it was made for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Final

from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN, LEAST_OWN, require_category_number
from tuning_tables.declared.leaf import Json
from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.declared.texts import Text
from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import SHA256_HEX, UTC_INSTANT, require_rising, require_text

TABLE_NAME: Final = Text("name of the table, also that of its file")
CREATED: Final = Text("instant of creation, which the caller gives", UTC_INSTANT, "2026-11-20T22:46:00Z")


@dataclass(frozen=True)
class Generator:
    """The program that made the table.

    Examples
    --------
    >>> from tuning_tables import Generator
    >>> Generator(name="by hand", version="1", config_sha256="0" * 64).name
    'by hand'
    """

    name: Annotated[str, Text("its name")]
    version: Annotated[str, Text("its version")]
    config_sha256: Annotated[
        str, Text("SHA-256 of its resolved configuration", SHA256_HEX, "of 64 lower-case hex digits")
    ]

    def __post_init__(self) -> None:
        require_declared(self, "generator")


@dataclass(frozen=True)
class RetarderId:
    """The retarder position that the table is for.

    Zones are in the order of the path and do not overlap; the exit does not lie before the end of the last one.

    Examples
    --------
    >>> from tuning_tables import RetarderId
    >>> RetarderId(
    ...     "my-retarder",
    ...     zones_m=((0.0, 12.0), (14.0, 26.0)),
    ...     exit_m=36.5,
    ...     dead_band_kpa=15.0,
    ... ).exit_m
    36.5
    """

    name: Annotated[str, Text("its name")]
    zones_m: Annotated[
        tuple[tuple[float, float], ...],
        Row(Row(Number("beginning and end of each retarder along the path"), "end", 2, 2), "zone"),
    ]
    exit_m: Annotated[float, Number("path of the first axle at which the pass ends")]
    dead_band_kpa: Annotated[float, Number("dead band of the pressure regulator", 0.0)]

    def __post_init__(self) -> None:
        require_declared(self, "retarder")
        reached_m = -float("inf")
        for index, zone in enumerate(self.zones_m):
            key = f"retarder.zones_m[{index}]"
            require_rising(zone, key)
            if zone[0] < reached_m:
                raise InvalidTable(f"{key} is {zone!r}, but it must not begin before {reached_m!r}, the end before it.")
            reached_m = zone[1]
        if self.exit_m < reached_m:
            raise InvalidTable(
                f"retarder.exit_m is {self.exit_m!r}, but it must not lie before {reached_m!r}, the last zone's end."
            )


@dataclass(frozen=True)
class CutId:
    """The class of cuts that the table is for.

    Axle offsets rise from 0.0. A category of the yard has its number whether the table states it or not.

    Examples
    --------
    >>> from tuning_tables import CutId
    >>> CutId(category="С", mass_t=52.0, axle_offsets_m=(0.0, 1.85, 8.65, 10.5)).number
    3
    """

    category: Annotated[str, Text("weight category")]
    mass_t: Annotated[float, Number("mass of the cut", is_positive=True)]
    axle_offsets_m: Annotated[tuple[float, ...], Row(Number("of each axle behind the first"), "axle")]
    category_number: Annotated[
        int | None, Count("what stands for the category in controllers; without it, that of the yard", 1, LARGEST_OWN)
    ] = None
    SCHEMA: ClassVar[Json] = {
        "oneOf": [
            {"properties": {"category_number": {"type": "null"}}},
            {
                "properties": {
                    "category": {"not": {"enum": list(KNOWN_NUMBERS)}},
                    "category_number": {"type": "integer", "minimum": LEAST_OWN},
                }
            },
            *(
                {"properties": {"category": {"const": name}, "category_number": {"const": number}}}
                for name, number in KNOWN_NUMBERS.items()
            ),
        ]
    }

    def __post_init__(self) -> None:
        require_text(self.category, "cut.category")
        if self.category_number is not None:
            require_category_number(self.category, self.category_number)
        require_declared(self, "cut")
        require_rising(self.axle_offsets_m, "cut.axle_offsets_m")
        if self.axle_offsets_m[0] != 0.0:
            raise InvalidTable(
                f"cut.axle_offsets_m begins with {self.axle_offsets_m[0]!r}, "
                "but it must begin with 0.0: offsets are measured from the first axle."
            )

    @property
    def number(self) -> int | None:
        """What stands for the category in controllers, as stated, else that of a category of the yard, else None."""
        return KNOWN_NUMBERS.get(self.category) if self.category_number is None else self.category_number
