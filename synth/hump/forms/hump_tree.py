"""A hump as the tables of a hump file, without types and origins; and as the text of one."""

from __future__ import annotations

from typing import Any, Final

from plant_models.hump import Edge, Retarder, Signal, Switch, TrackSection, Vertex
from plant_models.library.hump_cells import ELEMENTS
from plant_models.library.hump_elements import zones_of
from plant_models.library.hump_entry import FORMAT, VERSION, HumpEntry
from plant_models.library.library import BUILT_IN
from plant_models.library.type_file import POSITIONS
from synth.frame.settings.toml_text import value_text

Tree = dict[str, Any]

KINDS: Final = {Signal: "signal", Switch: "switch", Retarder: "retarder", TrackSection: "section"}


def hump_tree(hump: HumpEntry) -> Tree:
    """The tables; read again they give the same graph."""
    rows: Tree = {kind: [] for kind in ELEMENTS}
    for vertex in hump.graph.vertices:
        rows[KINDS[type(vertex)]].append(row_of(vertex))
    notes = {"notes": list(hump.notes)} if hump.notes else {}
    found = {kind: listed for kind, listed in rows.items() if listed}
    cars = {} if hump.cars is None else {"for_cars": hump.cars.table}
    head = {"format": FORMAT, "version": VERSION, "title": hump.title, **notes, **cars}
    return {**head, "hump": {"leads": list(hump.graph.leads), **found}}


def tree_toml(hump: HumpEntry) -> str:
    """The text of the file, a row a line."""
    tree = hump_tree(hump)
    lines = [f"{key} = {value_text(value)}" for key, value in tree.items() if key != "hump"]
    lines += ["", "[hump]", f"leads = {tree['hump']['leads']}"]
    for kind in ELEMENTS:
        if kind in tree["hump"]:
            lines += [f"{kind} = [", *(f"    {value_text(row)}," for row in tree["hump"][kind]), "]"]
    return "\n".join(lines) + "\n"


def row_of(vertex: Vertex) -> Tree:
    """An element as a row; keys that say what is so without them are left out."""
    row: Tree = {"number": vertex.number}
    if not isinstance(vertex, Signal) and vertex.name is not None:
        row["name"] = vertex.name
    match vertex:
        case Switch():
            row |= {key: getattr(vertex, key) for key in ("entry_joint_m", "exit_joint_m", "throw_s", "relay_s")}
            for side, branch in (("left", vertex.left), ("right", vertex.right)):
                row[side] = {**edge_of(branch.edge), "turn_deg": branch.turn_deg, "fouling_m": branch.fouling_m}
        case Retarder():
            row |= {key: getattr(vertex, key) for key in ("position", "entry_joint_m", "exit_joint_m")}
            row |= {} if is_of_library(vertex) else {"zones_m": [list(zone) for zone in vertex.zones_m]}
            row |= {key: getattr(vertex, key) for key in ("book", "exit_std_m_s") if getattr(vertex, key) is not None}
            row |= {"aim_tables": list(vertex.aim_tables)} if vertex.aim_tables else {}
        case TrackSection():
            row |= {} if vertex.is_last else {"length_m": vertex.length_m}
            row |= {} if vertex.track is None else {"track": vertex.track}
            row |= {"standing_m": vertex.standing_m} if vertex.standing_m else {}
    if not isinstance(vertex, Signal) and not vertex.axle_counters:
        row["axle_counters"] = False
    return row if isinstance(vertex, Switch) else {**row, "next": edge_of(vertex.next)}


def edge_of(edge: Edge) -> Tree:
    """An edge as a table."""
    grades = [list(each) for each in edge.grades]
    lists = {
        "curves": [[each.from_m, each.to_m, each.turn_deg] for each in edge.curves],
        "point_sensors_m": [each.at_m for each in edge.point_sensors],
        "radars_m": [[each.from_m, each.to_m] for each in edge.radars],
    }
    to = {} if edge.to is None else {"to": edge.to}
    grade = grades[0][1] if len(grades) == 1 else grades
    return {**to, "length_m": edge.length_m, "grade_permille": grade, **{k: v for k, v in lists.items() if v}}


def is_of_library(retarder: Retarder) -> bool:
    """Its zones are those of its position in the library."""
    named = retarder.position in BUILT_IN.names(POSITIONS)
    return named and zones_of(retarder.position) == retarder.zones_m
