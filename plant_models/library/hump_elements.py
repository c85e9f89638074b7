"""An element of the hump from the cells of its row; a fault keeps the place of the key that it is about."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, Final, TypeVar

from plant_models.errors import PlantError
from plant_models.hump import (
    Branch,
    Curve,
    Edge,
    HumpError,
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


class ElementFault(PlantError):
    """What is at fault in a row, and the `place` of the key; () where it is the row itself."""

    def __init__(self, place: Place, sentence: str) -> None:
        super().__init__(sentence)
        self.place = place


def element_from(kind: str, cells: Cells) -> Vertex:
    """The element of a row; `ElementFault`, or `HumpError` for a number that is not in its group."""
    return MAKERS[kind](cells)


def signal_from(cells: Cells) -> Signal:
    """A signal."""
    return made(cells, "", lambda: Signal(needed(cells, "number"), next_edge(cells)))


def switch_from(cells: Cells) -> Switch:
    """A switch."""
    left, right = (branch_from(table(cells, side), f"{side}: ") for side in ("left", "right"))
    number, entry, leave, throw, relay = (
        needed(cells, key) for key in ("number", "entry_joint_m", "exit_joint_m", "throw_s", "relay_s")
    )
    counted = given(cells, "axle_counters", True)
    return made(cells, "", lambda: Switch(number, left, right, entry, leave, throw, relay, counted))


def retarder_from_row(cells: Cells) -> Retarder:
    """A retarder; the zones are those of its position in the library where the row has none."""
    edge, position = next_edge(cells), needed(cells, "position")
    number, entry, leave = (needed(cells, key) for key in ("number", "entry_joint_m", "exit_joint_m"))
    zones = given(cells, "zones_m", None)
    if zones is None:
        cell = cells["position"]
        assert isinstance(cell, Cell)
        try:
            zones = zones_of(position)
        except PlantError as error:
            raise ElementFault(cell.place, f"{error} A position of your own needs zones_m here.") from None
    book, exit_std = (given(cells, key, None) for key in ("book", "exit_std_m_s"))
    aim_tables = given(cells, "aim_tables", ())
    counted = given(cells, "axle_counters", True)
    return made(
        cells,
        "",
        lambda: Retarder(number, edge, zones, entry, leave, position, book, aim_tables, counted, exit_std),
    )


@cache
def zones_of(position: str) -> tuple[tuple[float, float], ...]:
    """Braking zones of a position of the library; `PlantError` with a hint if there is none."""
    zones = position_with_types(position, BUILT_IN).position.zones_m
    return tuple((float(begin), float(end)) for begin, end in zones)


def section_from(cells: Cells) -> TrackSection:
    """A section of track; the last one of a track is as long as its edge."""
    edge = next_edge(cells)
    length = given(cells, "length_m", edge.length_m) if edge.to is None else needed(cells, "length_m")
    number, track = needed(cells, "number"), given(cells, "track", None)
    standing, counted = given(cells, "standing_m", 0.0), given(cells, "axle_counters", True)
    return made(cells, "", lambda: TrackSection(number, edge, length, track, standing, counted))


MAKERS: Final[Mapping[str, Callable[[Cells], Vertex]]] = {
    "signal": signal_from,
    "switch": switch_from,
    "retarder": retarder_from_row,
    "section": section_from,
}


def next_edge(cells: Cells) -> Edge:
    """The edge of what is no switch."""
    return edge_from(table(cells, "next"), "next: ")


def branch_from(cells: Cells, inside: str) -> Branch:
    """A branch of a switch, which must lead to an element."""
    if "to" not in cells:
        raise ElementFault((), f"{inside}key to is missing; a switch must have two exits, name the element it leads to")
    edge = edge_from(cells, inside)
    turn, fouling = (needed(cells, key, inside) for key in ("turn_deg", "fouling_m"))
    return made(cells, inside, lambda: Branch(edge, turn, fouling))


def edge_from(cells: Cells, inside: str) -> Edge:
    """An edge; to nowhere where the table names no element."""
    length, grades = (needed(cells, key, inside) for key in ("length_m", "grade_permille"))
    profile = ((0.0, grades),) if isinstance(grades, float) else grades

    def make() -> Edge:
        curves = tuple(Curve(*row) for row in given(cells, "curves", ()))
        sensors = tuple(PointSensor(at) for at in given(cells, "point_sensors_m", ()))
        radars = tuple(Radar(*ends) for ends in given(cells, "radars_m", ()))
        return Edge(given(cells, "to", None), length, profile, curves, sensors, radars)

    return made(cells, inside, make)


def made(cells: Cells, inside: str, make: Callable[[], _T]) -> _T:
    """What `make` gives; what it refuses is told at the place of the key that the sentence begins with."""
    try:
        return make()
    except (HumpError, ElementFault):
        raise
    except PlantError as error:
        sentence = keyed(str(error), KEYS_OF_VALUES)
        cell = cells.get(sentence.split(" ")[0].rstrip(":"))
        if isinstance(cell, Cell):
            raise ElementFault(cell.place, sentence) from None
        raise ElementFault((), inside + sentence) from None


def needed(cells: Cells, key: str, inside: str = "") -> Any:
    """The value under `key`, which must be there."""
    cell = cells.get(key)
    if not isinstance(cell, Cell):
        raise ElementFault((), f"{inside}key {key} is missing; give it here or in the type")
    return cell.value


def given(cells: Cells, key: str, absent: Any) -> Any:
    """The value under `key`, or `absent`."""
    cell = cells.get(key)
    return cell.value if isinstance(cell, Cell) else absent


def table(cells: Cells, key: str) -> Cells:
    """The cells of the table under `key`, which must be there."""
    found = cells.get(key)
    if not isinstance(found, dict):
        raise ElementFault((), f"key {key} is missing; it must be a table of to, length_m and grade_permille")
    return found
