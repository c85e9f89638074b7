"""What stands at each position of a hump for a trial: by the hump file, or otherwise by the configuration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from plant_models.errors import PlantError, require
from plant_models.hump import Retarder, Route
from synth.hump.configuration.sections import HumpPositionSettings
from synth.retarder.forms.tables_at import book_in, tables_at

T = TypeVar("T")


@dataclass(frozen=True)
class HeldTables:
    """What the tables of a book are for: `kinds`, (weight category, axles) of its classes; every class has tables for
    exit speeds from `lowest_m_s` to `highest_m_s`."""

    kinds: frozenset[tuple[str, int]]
    lowest_m_s: float
    highest_m_s: float

    def within(self, low_m_s: float, high_m_s: float) -> tuple[float, float]:
        """The part of a range of exit speeds that there are tables for; the ends lie the wrong way round for none."""
        return max(low_m_s, self.lowest_m_s), min(high_m_s, self.highest_m_s)


@dataclass(frozen=True)
class PositionChoice:
    """Position `number` of every route that has so many, 1 being the first behind the crest: `site`, its name in the
    library.

    Its controller: `exit_std_m_s`, or `book` with the configuration `tuned_with` (None: the built-in one). Out of
    service it brakes nothing. `supply_share`: of the full brake power. `std_set_by_user`: not by the hump file.
    `held`: what the tables of the book are for; None without a book.
    """

    number: int
    site: str
    exit_std_m_s: float | None
    book: Path | None
    tuned_with: Path | None
    out_of_service: bool
    supply_share: float
    std_set_by_user: bool
    held: HeldTables | None


def retarders_at(routes: Sequence[Route]) -> list[list[Retarder]]:
    """The retarders of each position, each once, of the routes that have so many; `PlantError` where none has any."""
    of_routes = [[e.vertex for e in route.elements if isinstance(e.vertex, Retarder)] for route in routes]
    most = max(map(len, of_routes))
    require(most > 0, "hump: there is no retarder on the way to any track; a trial needs one position at least")
    places = ([held[place] for held in of_routes if place < len(held)] for place in range(most))
    return [list({r.number: r for r in place}.values()) for place in places]


def position_choices(
    routes: Sequence[Route], settings: Sequence[HumpPositionSettings], hump_folder: Path, folder: Path
) -> tuple[PositionChoice, ...]:
    """The choice for each position; books of the hump file begin at `hump_folder`, those of `settings` at `folder`.

    `PlantError` tells the key at fault.
    """
    places = retarders_at(routes)
    own: dict[int, tuple[str, HumpPositionSettings]] = {}
    for row, each in enumerate(settings):
        key = f"position[{row}]"
        require(
            each.number <= len(places),
            f"{key}.number is {each.number}; the hump has the positions 1 to {len(places)}, 1 being the first behind "
            "the crest",
        )
        require(each.number not in own, f"{key}.number is {each.number}, which is there before; put the two together")
        own[each.number] = key, each
    return tuple(
        choice_of(number, held, *own.get(number, ("", HumpPositionSettings(number=number))), hump_folder, folder)
        for number, held in enumerate(places, start=1)
    )


def choice_of(
    number: int, held: Sequence[Retarder], key: str, settings: HumpPositionSettings, hump_folder: Path, folder: Path
) -> PositionChoice:
    """The choice for one position, whose retarders are `held`."""
    site = same_of(number, "position", {r.position for r in held})
    std, book, tuned_with = settings.exit_std_m_s, None, None
    if settings.tables is not None:
        book = book_in(folder / settings.tables)
    elif std is None:
        std, named = same_of(number, "exit_std_m_s or book", {(r.exit_std_m_s, r.book) for r in held})
        book = None if named is None else book_in(hump_folder / named)
    if settings.tables_config is not None:
        require(
            book is not None,
            f"{key}.tables_config is {settings.tables_config!r}, but no book of tables is named; add tables, or take "
            "it out",
        )
        tuned_with = folder / settings.tables_config
    for path in (book, tuned_with):
        if path is not None and not path.is_file():
            raise PlantError(
                f"position {number}: there is no file {str(path)!r}; 'retarder-synth init --for' prints the "
                "configuration of a book for this trial, and 'retarder-synth tune' makes it"
            )
    supply = 1.0 if settings.supply_share is None else settings.supply_share
    require(
        supply == 1.0 or book is None,
        f"{key}.supply_share is {supply:g}, but position {number} runs a book of tables, whose plant has its supply in "
        "its own configuration: change it there (tables_config)",
    )
    by_user = settings.exit_std_m_s is not None
    out, held_tables = settings.out_of_service, None if book is None else held_in(book)
    return PositionChoice(number, site, std, book, tuned_with, out, supply, by_user, held_tables)


def held_in(book: Path) -> HeldTables:
    """What the tables in `book` are for."""
    tables = tables_at(book).only_lines("a position of a trial")
    targets: dict[tuple[str, float, tuple[float, ...]], list[float]] = {}
    for table in tables:
        key = table.cut.category, table.cut.mass_t, tuple(table.cut.axle_offsets_m)
        targets.setdefault(key, []).append(table.target_speed_m_s)
    return HeldTables(
        kinds=frozenset((category, len(axles)) for category, _, axles in targets),
        lowest_m_s=max(min(of_class) for of_class in targets.values()),
        highest_m_s=min(max(of_class) for of_class in targets.values()),
    )


def same_of(number: int, what: str, found: set[T]) -> T:
    """The only member; `PlantError` where the retarders of a position differ."""
    if len(found) != 1:
        told = ", ".join(sorted(str(each) for each in found))
        raise PlantError(
            f"hump: position {number}: its retarders differ in {what} ({told}); a trial has one model for a position: "
            f"give exit_std_m_s or tables under [[position]] with number = {number}"
        )
    return next(iter(found))
