"""The study `rooms`: which room of the house is for what, and which rooms it stands on."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Final

from scripts.studies.study import Findings, MarkdownTable, Method, Tell, table

if TYPE_CHECKING:
    import networkx as nx

HOUSE: Final = "synth"
PACKAGES: Final = ("plant_models", HOUSE, "tuning_tables")


@dataclass(frozen=True)
class Options:
    """There is nothing to be chosen: the house is what stands in the checkout."""


@dataclass(frozen=True)
class Room:
    """A package, or a module at the top of `synth`.

    `purpose`: the first sentence of its docstring; `floor`: rooms below it, one on another, at most; `stands_on`: the
    rooms that it imports from, but for those that one of these stands on.
    """

    name: str
    purpose: str
    floor: int
    stands_on: tuple[str, ...]


@dataclass(frozen=True)
class Rooms(Findings):
    """The rooms, the highest floor first."""

    rooms: tuple[Room, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """One of all rooms."""
        rows = [(f"`{room.name}`", room.purpose, words(room.stands_on)) for room in self.rooms]
        return {"rooms": table("Rooms of the house", ("room", "is", "stands on"), rows)}


def words(names: tuple[str, ...]) -> str:
    """Names of rooms in a cell."""
    return ", ".join(f"`{name}`" for name in names) or "nothing of the house"


def run(options: Options, tell: Tell) -> Rooms:
    """Read the imports of all modules, those inside functions too."""
    import networkx as nx

    graph = imports()
    reduced = nx.transitive_reduction(graph)
    floors = floors_of(graph)
    tell(f"{len(graph)} rooms on {max(floors.values()) + 1} floors")
    return Rooms(
        tuple(
            Room(name, purpose_of(name), floors[name], tuple(sorted(reduced[name])))
            for name in sorted(graph, key=lambda name: (-floors[name], name))
        )
    )


def floors_of(graph: nx.DiGraph) -> dict[str, int]:
    """Every room as low as it can stand; one that stands on nothing as high as those who know it allow."""
    import networkx as nx

    floors = {name: floor for floor, names in enumerate(nx.topological_generations(graph.reverse())) for name in names}
    for name in graph:
        if not graph[name]:
            floors[name] = min((floors[user] for user in graph.predecessors(name)), default=1) - 1
    return floors


def imports() -> nx.DiGraph:
    """From every room an arrow to each other that one of its modules imports, or names as a command of its list."""
    import grimp
    import networkx as nx

    from synth.cli.listed import COMMANDS, HUMP

    found = grimp.build_graph(*PACKAGES)
    modules = [each for each in PACKAGES if each != HOUSE] + sorted(found.find_children(HOUSE))
    for module in modules:
        if found.find_children(module):
            found.squash_module(module)
    graph = nx.DiGraph()
    graph.add_nodes_from(map(room_of, modules))
    graph.add_edges_from(
        (room_of(module), room_of(other))
        for module in modules
        for other in found.find_modules_directly_imported_by(module)
        if other in modules and other != module
    )
    listed = {each.place.split(".")[1] for each in (*COMMANDS, *HUMP)}
    graph.add_edges_from(("cli", room) for room in listed if room != "cli")
    return graph


def room_of(module: str) -> str:
    """What a room is called: the top of `synth` is left out."""
    return module.removeprefix(f"{HOUSE}.")


def purpose_of(room: str) -> str:
    """The first sentence of a room's docstring."""
    spec = find_spec(room if room in PACKAGES else f"{HOUSE}.{room}")
    assert spec is not None
    assert spec.origin is not None
    text = ast.get_docstring(ast.parse(Path(spec.origin).read_text(encoding="utf-8")))
    return (text or "").partition("\n\n")[0].replace("\n", " ").replace("`", "")


METHOD = Method(options=Options, smallest=Options(), findings=Rooms, run=run)
