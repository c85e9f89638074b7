"""Which aim tables command the positions that aim: those of the hump file, or others by the configuration."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from plant_models.errors import PlantError, require
from plant_models.hump import Retarder, Route
from plant_models.library.weight_category import WeightCategory
from synth.frame.printed_numbers import ranges
from synth.hump.configuration.settings import TrialAimSettings
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.position_roles import Roles
from synth.retarder.forms.table_file import read_aims
from tuning_tables.aim import AimTable, AimTables
from tuning_tables.errors import InvalidTable

KNOWN = {False: "category alone", True: "measured resistance"}


@dataclass(frozen=True)
class AimChoice:
    """The aim `tables` of the last positions on the routes of `rows`, which are the `retarders`, by number.

    `named`: what names their `files` in messages; one file a table.
    """

    named: str
    rows: tuple[int, ...]
    retarders: tuple[int, ...]
    files: tuple[Path, ...]
    tables: AimTables

    @property
    def sha256(self) -> tuple[str, ...]:
        """Of the files, whatever they are called."""
        return tuple(sorted(hashlib.sha256(file.read_bytes()).hexdigest() for file in self.files))

    def of(self, category: WeightCategory, measured: bool) -> AimTable:
        """The table for a weight category; `PlantError` where there is none."""
        found = self.tables.select(category.number, measured)
        if found is None:
            held = ", ".join(f"{t.category.name} by {KNOWN[t.is_measured]}" for t in self.tables.tables)
            raise PlantError(
                f"{self.named}, which has no table by {KNOWN[measured]} for the weight category {category.label}, "
                f"number {category.number}; there are {held}: make one for each category, as aim.knowledge asks"
            )
        return found


def aim_choices(
    routes: HumpRoutes, roles: Roles, settings: TrialAimSettings, hump_folder: Path, folder: Path
) -> tuple[AimChoice, ...]:
    """The aim tables of the routes on which a position aims and that have any, by what names them; names of the hump
    file begin at `hump_folder`, those of `settings` at `folder`.

    `PlantError` with the key at fault; `TableError` for a damaged table.
    """
    last = {row: last_retarder(routes.routes[row]) for row in roles.aimed_rows}
    own = settings.tables_of or {}
    numbers = {str(retarder.number) for retarder in last.values()}
    for name in own:
        require(
            name in numbers,
            f"aim.tables_of names {name!r}; retarders that aim at the standing cars: "
            f"{ranges(sorted(map(int, numbers))) or 'none'}",
        )
    named: dict[tuple[Path, ...], str] = {}
    rows: dict[tuple[Path, ...], list[int]] = {}
    for row, retarder in last.items():
        found = source_of(retarder, settings.tables, own, hump_folder, folder)
        if found is not None:
            named.setdefault(found[1], found[0])
            rows.setdefault(found[1], []).append(row)
    return tuple(choice_of(named[paths], paths, rows[paths], last) for paths in rows)


def last_retarder(route: Route) -> Retarder:
    """The last retarder of a route, which has some."""
    return [each.vertex for each in route.elements if isinstance(each.vertex, Retarder)][-1]


def source_of(
    retarder: Retarder, of_all: str | None, own: Mapping[str, str], hump_folder: Path, folder: Path
) -> tuple[str, tuple[Path, ...]] | None:
    """(what names the aim tables of `retarder`, where they are); None where nothing does."""
    number = str(retarder.number)
    if number in own:
        return f"aim.tables_of.{number}", (folder / own[number],)
    if of_all is not None:
        return "aim.tables", (folder / of_all,)
    if retarder.aim_tables:
        return f"hump: retarder {number}: aim_tables", tuple(hump_folder / name for name in retarder.aim_tables)
    return None


def choice_of(named: str, paths: Sequence[Path], rows: Sequence[int], last: Mapping[int, Retarder]) -> AimChoice:
    """The tables at `paths` for the routes `rows`, whose last retarders are `last`; each retarder once."""
    found = [each for path in paths for each in read_at(named, path)]
    try:
        tables = AimTables(tuple(table for _, table in found))
    except InvalidTable as fault:
        raise PlantError(
            f"{named} names {', '.join(map(str, paths))}, which cannot be used together: {fault}"
        ) from None
    retarders = {last[row].number: last[row] for row in rows}
    for retarder in retarders.values():
        require(
            tables.tables[0].position.name == retarder.position,
            f"{named} names {paths[0]}, whose table {tables.tables[0].id} is for the position "
            f"{tables.tables[0].position.name}, but retarder {retarder.number} is a {retarder.position}; give tables "
            "of that position",
        )
    files = tuple(path for path, _ in found)
    return AimChoice(f"{named} names {paths[0]}", tuple(rows), tuple(sorted(retarders)), files, tables)


def read_at(named: str, path: Path) -> Iterator[tuple[Path, AimTable]]:
    """The aim tables at `path`; `PlantError` for none."""
    require(
        path.exists(),
        f"{named} names {path}, and there is no such file or directory; 'retarder-synth aim' makes aim tables",
    )
    found = read_aims(path)
    what = "is no aim table" if path.is_file() else "holds no aim tables"
    require(
        len(found) > 0,
        f"{named} names {path}, which {what} (JSON of the kind aim); give what 'retarder-synth aim' left",
    )
    for each in found:
        yield each.path, each.table
