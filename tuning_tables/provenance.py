"""Where a table comes from and what it is for: the generator, the retarder and the cut it was made for."""

from __future__ import annotations

from dataclasses import dataclass

from tuning_tables.category_number import KNOWN_NUMBERS, require_category_number
from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import (
    SHA256_HEX,
    require_between,
    require_finite,
    require_match,
    require_positive,
    require_rising,
    require_text,
    require_tuple,
)


@dataclass(frozen=True)
class Generator:
    """The program that made the table, and the SHA-256 (64 lower-case hex digits) of its resolved configuration."""

    name: str
    version: str
    config_sha256: str

    def __post_init__(self) -> None:
        require_text(self.name, "generator.name")
        require_text(self.version, "generator.version")
        require_match(self.config_sha256, "generator.config_sha256", SHA256_HEX, "of 64 lower-case hex digits")


@dataclass(frozen=True)
class RetarderId:
    """The retarder position the table is for.

    `zones_m`: (begin, end) of each retarder along the path, in order, not overlapping. `exit_m`: path of the first
    axle at which the pass ends, not before the last zone's end. `dead_band_kpa`: of the pressure regulator, >= 0.
    """

    name: str
    zones_m: tuple[tuple[float, float], ...]
    exit_m: float
    dead_band_kpa: float

    def __post_init__(self) -> None:
        require_text(self.name, "retarder.name")
        require_tuple(self.zones_m, "retarder.zones_m")
        reached_m = -float("inf")
        for index, zone in enumerate(self.zones_m):
            key = f"retarder.zones_m[{index}]"
            require_tuple(zone, key, 2)
            require_rising(zone, key)
            if zone[0] < reached_m:
                raise InvalidTable(f"{key} is {zone!r}, but it must not begin before {reached_m!r}, the end before it.")
            reached_m = zone[1]
        if not self.zones_m:
            raise InvalidTable("retarder.zones_m is empty, but a retarder position has at least one zone.")
        require_finite(self.exit_m, "retarder.exit_m")
        if self.exit_m < reached_m:
            raise InvalidTable(
                f"retarder.exit_m is {self.exit_m!r}, but it must not lie before {reached_m!r}, the last zone's end."
            )
        require_between(self.dead_band_kpa, "retarder.dead_band_kpa", 0.0)


@dataclass(frozen=True)
class CutId:
    """The class of cuts the table is for: category, mass in t (> 0), axle offsets in m behind the first axle (0.0).

    `category_number`: as the table states it; None in tables from before there were numbers.
    """

    category: str
    mass_t: float
    axle_offsets_m: tuple[float, ...]
    category_number: int | None = None

    def __post_init__(self) -> None:
        require_text(self.category, "cut.category")
        if self.category_number is not None:
            require_category_number(self.category, self.category_number)
        require_positive(self.mass_t, "cut.mass_t")
        require_rising(self.axle_offsets_m, "cut.axle_offsets_m")
        if self.axle_offsets_m[0] != 0.0:
            raise InvalidTable(
                f"cut.axle_offsets_m begins with {self.axle_offsets_m[0]!r}, "
                "but it must begin with 0.0: offsets are measured from the first axle."
            )

    @property
    def number(self) -> int | None:
        """What stands for the category in controllers: as stated, else that of a category of the yard, else None."""
        return KNOWN_NUMBERS.get(self.category) if self.category_number is None else self.category_number
