"""Aim tables in files for trials on the medium hump, in closed form or exported by an aim of the same cuts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from plant_models.library import load_hump, load_weight_categories
from synth.aim.configuration.aim_file import parse_aim_file
from synth.aim.resolved_aim import ResolvedAim
from synth.frame.command import Asked
from synth.hump.aiming import resolve
from synth.hump.options import AimOptions
from synth.hump.planning.aim_design import positions_m
from synth.hump.rolling.hump_routes import HumpRoutes, hump_routes
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tuning_tables.aim import AimTable, MeasuredResistance, ParkPosition
from tuning_tables.json_file import write_json

CATEGORIES = load_weight_categories()
EXIT_M = 295.0
STRETCH_M = 250.0, 280.0


def medium() -> HumpRoutes:
    """The routes of the medium hump, whose park positions end at `EXIT_M`."""
    return hump_routes(load_hump("medium").graph, 201)


def made_tables(grade: float, measured: bool = True) -> list[AimTable]:
    """A table of each category and kind; steeper `grade`, slower exit speeds."""
    found = []
    for member in CATEGORIES.members:
        named = member.number, member.name
        found.append(category_table(grade, *named))
        if measured:
            found.append(replace(measured_table(grade, *named), measured=MeasuredResistance(*STRETCH_M, 0.1)))
    return [replace(each, position=ParkPosition("rnz-2m-park", EXIT_M)) for each in found]


def written(folder: Path, tables: Iterable[AimTable]) -> Path:
    """The tables as files of `folder`."""
    folder.mkdir(parents=True)
    for table in tables:
        write_json(table, folder / f"{table.id}.json")
    return folder


def resolved_aim(hump: HumpRoutes, row: int, passes: int) -> ResolvedAim:
    """An aim for the last position of the route `row` of the medium hump, by category Л, with the nodes of a trial's
    own aim."""
    route = hump.routes[row]
    room = route.length_m - positions_m(route)[-1][1] - 60.0
    distances = [round(max(room * (place / 15) ** 2, 0.5), 3) for place in range(16)]
    text = (
        f'[cuts]\ncategories = ["Л"]\ncars = [1, 2, 3]\n'
        f'[aim]\nfree_distances_m = {distances}\nknowledge = ["category"]\n'
    )
    options = AimOptions(hump=Path("medium"), track=route.track, passes=passes)
    return resolve(Asked(parse_aim_file(text, "aim.toml"), options, "aim.toml", Path(), text))
