"""Which aim tables command the positions that aim, those of the hump file, or others by the configuration; and the aim
of last positions by them, asked as a controller asks them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from plant_models.errors import PlantError, require
from plant_models.frozen_arrays import Floats
from plant_models.hump import Retarder, Route
from plant_models.library.weight_category import WeightCategory
from synth.aim.knowledge import MOST_N_PER_KN, ResistanceByTwoSpeeds
from synth.aim.scene import MeasuredStretch
from synth.frame.printed_numbers import ranges
from synth.hump.configuration.settings import HumpTrialSettings, TrialAimSettings
from synth.hump.planning.aim_control import CategoryAim, HumpAim, no_speeds
from synth.hump.planning.aim_design import AimDesign, MeasuredAhead, scene_of
from synth.hump.planning.position_roles import Roles
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.retarder.forms.tables_at import read_aims
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


Kinds = Mapping[WeightCategory, Collection[int]]
"""Numbers of cars of the cuts of each weight category that trains can have."""

COUPLING_TOLERANCE_M_S, SAME_PLACE_M = 0.005, 1.0
"""What counts as the same coupling speed, and as the same place."""


def table_aim(choice: AimChoice, routes: HumpRoutes, kinds: Kinds, design: AimDesign) -> HumpAim:
    """The aim by the tables of `choice` on its routes; `require_fitting` has found that they fit.

    `design` tells the weight categories, whether resistance is measured, and which cuts its mean is expected of.
    """
    tables, lowest = [], []
    for member in design.population.categories.members:
        own = category_tables(choice, member, measured=isinstance(design.knowledge, MeasuredAhead))
        if member not in kinds or not own:
            tables.append(CategoryAim(no_speeds()))
            lowest.append(design.requirement.bounds_m_s[0])
            continue
        read = own[-1] if own[-1].is_measured else None
        mean = mean_reading_n_per_kn(choice, read, routes, member, design) if read is not None else np.nan
        tables.append(CategoryAim(own[0].held, None if read is None else read.held, mean))
        lowest.append(min(table.bounds_m_s[0] for table in own))
    rows = np.array(choice.rows)
    stretch = np.full((len(rows), 2), np.nan)
    if isinstance(design.knowledge, MeasuredAhead):
        stretch = stretches_m(choice, routes)
    return HumpAim(np.zeros(len(rows), dtype=np.int64), (tuple(tables),), np.array([lowest]), stretch)


def category_tables(choice: AimChoice, member: WeightCategory, measured: bool) -> tuple[AimTable, ...]:
    """The table by category, if there is one, and that by measured resistance, if that is asked for. A controller
    without the first has no answer where nothing was read."""
    kinds = (False, True) if measured else (False,)
    found = (choice.tables.select(member.number, kind) for kind in kinds)
    return tuple(table for table in found if table is not None)


def require_fitting(choice: AimChoice, routes: HumpRoutes, kinds: Kinds, measured: bool) -> None:
    """`PlantError` unless the tables of `choice` answer for all cuts that trains can have on its routes."""
    for member, cars in kinds.items():
        asked = choice.of(member, measured)
        for table in (asked, *category_tables(choice, member, measured)):
            listed = table.axes.cars
            for count in (min(cars), max(cars)):
                require(
                    bool(listed[0] <= count <= listed[-1]),
                    f"{choice.named}, whose table {table.id} is for cuts of {listed[0]} to {listed[-1]} cars; trains "
                    f"can have cuts of {min(cars)} to {max(cars)} (trains.most_cars): make a table for these",
                )
    if measured:
        stretches_m(choice, routes)


def aim_warnings(aims: tuple[AimChoice, ...], routes: HumpRoutes, settings: HumpTrialSettings) -> Iterator[str]:
    """A sentence for each thing in which the tables are for something else than what is simulated."""
    for choice in aims:
        for table in choice.tables.tables:
            known, std = table.measured, settings.sensors.speed_std_m_s
            if settings.aim.knowledge == "measured" and known is not None and known.speed_std_m_s != std:
                yield (
                    f"sensors.speed_std_m_s is {std:g}; the aim table {table.id} was made for speeds measured to "
                    f"{known.speed_std_m_s:g} m/s"
                )
            asked = table.required.coupling_speed_m_s
            if abs(asked - settings.couplings.allowed_m_s) > COUPLING_TOLERANCE_M_S:
                yield (
                    f"the aim table {table.id} is for couplings at up to {asked:g} m/s; over-speeds are told above "
                    f"{settings.couplings.allowed_m_s:.2f} m/s"
                )
        ends, exit_m = routes.release_m[list(choice.rows)], choice.tables.tables[0].position.exit_at_m
        if np.abs(ends - exit_m).max() > SAME_PLACE_M:
            yield (
                f"{choice.named}, made for a position that ends {exit_m:g} m from the crest; in this hump it ends at "
                f"{ends.min():g} to {ends.max():g} m: falls and bends may differ"
            )


def stretches_m(choice: AimChoice, routes: HumpRoutes) -> Floats:
    """Where the resistance is measured on each route of `choice`, (rows, 2): as far from the end of the position as the
    tables have it. `PlantError` where the tables differ in it, or it reaches into the position."""
    stretches = {
        (table.measured.from_m, table.measured.to_m) for table in choice.tables.tables if table.measured is not None
    }
    if len(stretches) != 1:
        raise PlantError(
            f"{choice.named}, whose tables are for resistances measured on {len(stretches)} different stretches "
            f"({', '.join(f'{a:g} to {b:g} m' for a, b in sorted(stretches))}); those of one position must have one"
        )
    rows = np.array(choice.rows)
    ((begin, end),) = stretches
    ahead = routes.release_m[rows] - choice.tables.tables[0].position.exit_at_m
    found = np.stack((begin + ahead, end + ahead), axis=1)
    entrance = routes.entrance_m[rows, routes.positions_of[rows] - 1]
    beyond = np.flatnonzero(found[:, 1] > entrance + 1e-6)
    if len(beyond):
        row = beyond[0]
        track = routes.graph.track_called(int(routes.tracks[rows[row]]))
        raise PlantError(
            f"{choice.named}, whose resistances are measured up to {found[row, 1]:g} m from the crest on the way to "
            f"track {track}, where the last position begins at {entrance[row]:g} m; give tables "
            "that are measured ahead of the position"
        )
    return found


def mean_reading_n_per_kn(
    choice: AimChoice, table: AimTable, routes: HumpRoutes, member: WeightCategory, design: AimDesign
) -> float:
    """The mean of what is read of single cars of a category on the stretch of `table`, on the first route of `choice`;
    cars that stop there left out."""
    assert isinstance(design.knowledge, MeasuredAhead)
    begin, end = stretches_m(choice, routes)[0]
    law = design.knowledge.speed_mean_m_s, design.knowledge.speed_spread_m_s
    scene = replace(
        scene_of(routes.routes[choice.rows[0]], design, design.threads),
        stretch=MeasuredStretch(max(float(begin), 0.0), float(end), *law),
    )
    cuts = scene.draw(member, int(table.axes.cars[0]), design.seed, 0, design.design_cuts)
    read = ResistanceByTwoSpeeds(design.knowledge.speed_std_m_s).of(cuts).value
    return float(read[read < MOST_N_PER_KN].mean())
