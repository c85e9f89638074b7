"""An element of the hump from the cells of its row; each fault keeps the place of the key that it is about."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Final, TypeVar

from plant_models.errors import Faults, PlantError
from plant_models.hump import (
    GROUPS,
    Branch,
    Curve,
    Edge,
    PointSensor,
    Radar,
    Retarder,
    Signal,
    Switch,
    TrackSection,
    Vertex,
)
from plant_models.library.data_file import keyed
from plant_models.library.hump_cells import Cell, Cells
from plant_models.library.hump_forms import FoundFaults
from plant_models.library.library import BUILT_IN
from plant_models.library.position_entry import position_with_types
from plant_models.library.toml_lines import Place

_T = TypeVar("_T")

KEYS_OF_VALUES: Final = {
    "grades: ": "grade_permille: ",
    "curve: ": "curves: ",
    "point_sensors: ": "point_sensors_m: ",
    "point sensor: ": "point_sensors_m: ",
    "radars: ": "radars_m: ",
    "radar: ": "radars_m: ",
}
"""How the sentences of the values begin, and the keys of a file that this means."""

ANY_EDGE: Final = Edge(None, 1.0, ((0.0, 0.0),))
"""Stands for an edge that is at fault while the other keys of a row are looked at."""


@dataclass(frozen=True)
class ElementMaker:
    """Makes the element of the row at `place`, of `kind`; what is at fault goes to `found`.

    A value that is missing or at fault is None, and so is all that would be made of it.
    """

    kind: str
    place: Place
    found: FoundFaults

    def element(self, cells: Cells) -> Vertex | None:
        """The element; None where the row is at fault."""
        before = len(self.found)
        made = MAKERS[self.kind](self, cells)
        return None if len(self.found) > before or any_faulty(cells) else made

    def number(self, cells: Cells) -> int | None:
        """Its number, or where that is not in its group, another one for now."""
        (number,) = self.needed(cells, ["number"])
        group = next(each for each in GROUPS if each.noun == self.kind)
        if number is None or number in group:
            return None if number is None else int(number)
        told = f"the number is not in its group; give a {group.noun} a number from {group.first} to {group.last}"
        self.found.add((*self.place, "number"), told)
        return group.first

    def needed(self, cells: Cells, keys: Sequence[str], inside: str = "", if_missing: str = "") -> list[Any]:
        """The values under `keys`, which must be there; nothing is missing where the type of a row is not there."""
        missing = [key for key in keys if key not in cells]
        if missing and "type" not in cells:
            told = "key {} is missing; give it" if len(missing) == 1 else "keys {} are missing; give them"
            here = f"{told.format(', '.join(missing))} here or in the type"
            self.found.add(self.place, inside + (if_missing or here))
        return [given(cells, key, None) for key in keys]

    def made(self, cells: Cells, inside: str, make: Callable[[], _T]) -> _T | None:
        """What `make` gives; what it refuses is told at the place of the key that the sentence begins with."""
        try:
            return make()
        except PlantError as error:
            for told in error.sentences if isinstance(error, Faults) else (str(error),):
                sentence = keyed(told, KEYS_OF_VALUES)
                cell = cells.get(sentence.split(" ")[0].rstrip(":"))
                if isinstance(cell, Cell):
                    self.found.add(cell.place, sentence)
                else:
                    self.found.add(self.place, inside + sentence)
            return None

    def next_edge(self, cells: Cells) -> Edge | None:
        """The edge of what is no switch."""
        inner = self.table(cells, "next")
        return None if inner is None else self.edge(inner, "next: ")

    def table(self, cells: Cells, key: str) -> Cells | None:
        """The cells of the table under `key`, which must be there."""
        found = cells.get(key)
        if found is None and "type" not in cells:
            told = "it must be a table of to, length_m and grade_permille"
            self.found.add(self.place, f"key {key} is missing; {told}")
        return found if isinstance(found, dict) else None

    def branch(self, cells: Cells, side: str) -> Branch | None:
        """A branch of a switch, which must lead to an element."""
        inner, inside = self.table(cells, side), f"{side}: "
        if inner is None:
            return None
        self.needed(
            inner, ["to"], inside, "key to is missing; a switch must have two exits, name the element it leads to"
        )
        edge = self.edge(inner, inside)
        turn, fouling = self.needed(inner, ["turn_deg", "fouling_m"], inside)
        if edge is None or turn is None or fouling is None:
            return None
        return self.made(inner, inside, lambda: Branch(edge, turn, fouling))

    def edge(self, cells: Cells, inside: str) -> Edge | None:
        """An edge; to nowhere where the table names no element."""
        length, grades = self.needed(cells, ["length_m", "grade_permille"], inside)
        if length is None or grades is None or is_faulty(cells, "to"):
            return None
        profile = ((0.0, grades),) if isinstance(grades, float) else grades

        def make() -> Edge:
            curves = tuple(Curve(*row) for row in given(cells, "curves", ()))
            sensors = tuple(PointSensor(at) for at in given(cells, "point_sensors_m", ()))
            radars = tuple(Radar(*ends) for ends in given(cells, "radars_m", ()))
            return Edge(given(cells, "to", None), length, profile, curves, sensors, radars)

        return self.made(cells, inside, make)


def signal_from(maker: ElementMaker, cells: Cells) -> Signal | None:
    """A signal."""
    number, edge = maker.number(cells), maker.next_edge(cells) or ANY_EDGE
    return None if number is None else maker.made(cells, "", lambda: Signal(number, edge))


def switch_from(maker: ElementMaker, cells: Cells) -> Switch | None:
    """A switch."""
    number, counted, name = maker.number(cells), given(cells, "axle_counters", True), given(cells, "name", None)
    left, right = (maker.branch(cells, side) or Branch(ANY_EDGE, 0.0, 1.0) for side in ("left", "right"))
    entry, leave, throw, relay = maker.needed(cells, ["entry_joint_m", "exit_joint_m", "throw_s", "relay_s"])
    if None in (number, entry, leave, throw, relay):
        return None
    return maker.made(cells, "", lambda: Switch(number or 0, left, right, entry, leave, throw, relay, counted, name))


def retarder_from(maker: ElementMaker, cells: Cells) -> Retarder | None:
    """A retarder; the zones are those of its position in the library where the row has none."""
    number, edge = maker.number(cells), maker.next_edge(cells) or ANY_EDGE
    position, entry, leave = maker.needed(cells, ["position", "entry_joint_m", "exit_joint_m"])
    zones = given(cells, "zones_m", None) if "zones_m" in cells else of_library(maker, cells, position, leave)
    if None in (number, position, entry, leave, zones):
        return None
    book, exit_std = (given(cells, key, None) for key in ("book", "exit_std_m_s"))
    if any(is_faulty(cells, key) for key in ("book", "exit_std_m_s")):
        exit_std = 0.0  # nothing more is told of what controls it
    aims, counted = given(cells, "aim_tables", ()), given(cells, "axle_counters", True)
    name = given(cells, "name", None)
    return maker.made(
        cells,
        "",
        lambda: Retarder(number or 0, edge, zones or (), entry, leave, position, book, aims, counted, exit_std, name),
    )


def of_library(
    maker: ElementMaker, cells: Cells, position: str | None, exit_joint_m: float | None
) -> tuple[tuple[float, float], ...] | None:
    """The zones of the `position` of the library, over which the insulated section must reach."""
    if position is None:
        return None
    named, joint = cells["position"], cells.get("exit_joint_m")
    assert isinstance(named, Cell)
    try:
        zones = zones_of(position)
    except PlantError as error:
        maker.found.add(named.place, f"{error} A position of your own needs zones_m here.")
        return None
    ends = zones[-1][1]
    if exit_joint_m is not None and exit_joint_m < ends and isinstance(joint, Cell):
        maker.found.add(
            joint.place,
            f"exit_joint_m is {exit_joint_m:g}; it must not be before the end of the last zone, and position "
            f"{position} is {ends:g} m long; give {ends:g} or more, or the zones_m of a position of your own",
        )
        return None
    return zones


@cache
def zones_of(position: str) -> tuple[tuple[float, float], ...]:
    """Braking zones of a position of the library; `PlantError` with a hint if there is none."""
    zones = position_with_types(position, BUILT_IN).position.zones_m
    return tuple((float(begin), float(end)) for begin, end in zones)


def section_from(maker: ElementMaker, cells: Cells) -> TrackSection | None:
    """A section of track; the last one of a track is as long as its edge."""
    number, edge = maker.number(cells), maker.next_edge(cells)
    if edge is None:
        return None
    length = given(cells, "length_m", edge.length_m) if edge.to is None else maker.needed(cells, ["length_m"])[0]
    wrong = any(is_faulty(cells, key) for key in ("length_m", "track", "standing_m"))
    if number is None or length is None or wrong:
        return None
    track = given(cells, "track", None)
    standing, counted = given(cells, "standing_m", 0.0), given(cells, "axle_counters", True)
    name = given(cells, "name", None)
    return maker.made(cells, "", lambda: TrackSection(number, edge, length, track, standing, counted, name))


MAKERS: Final[Mapping[str, Callable[[ElementMaker, Cells], Vertex | None]]] = {
    "signal": signal_from,
    "switch": switch_from,
    "retarder": retarder_from,
    "section": section_from,
}


def given(cells: Cells, key: str, absent: Any) -> Any:
    """The value under `key`; `absent` where there is none, or it is at fault."""
    cell = cells.get(key)
    return cell.value if isinstance(cell, Cell) and not cell.faulty else absent


def any_faulty(cells: Cells) -> bool:
    """A value of the row is at fault."""
    return any(cell.faulty if isinstance(cell, Cell) else any_faulty(cell) for cell in cells.values())


def is_faulty(cells: Cells, key: str) -> bool:
    """The key is there, and its value is at fault."""
    cell = cells.get(key)
    return isinstance(cell, Cell) and cell.faulty
