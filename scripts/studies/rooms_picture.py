"""The picture of the study `rooms`: a box for each room, an arrow to each that it stands on."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import fill
from typing import TYPE_CHECKING, Final

from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from synth.frame.picture.house_style import GREY, INK, SKY, new_figure

if TYPE_CHECKING:
    from scripts.studies.rooms import Room, Rooms

WIDTH_IN: Final = 9.0
FLOOR_IN, BOX_IN, BOX_WIDTH_IN = 1.0, 0.68, 2.75
LETTERS: Final = 46
"""Of a purpose in a line of a box."""


def picture(rooms: tuple[Room, ...]) -> Figure:
    """Floors one over another; arrows point down."""
    floors = 1 + max(room.floor for room in rooms)
    height = floors * FLOOR_IN + 0.4
    figure = new_figure(WIDTH_IN, height, "The rooms of the house: an arrow leads to what a room stands on")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, WIDTH_IN), ylim=(0.0, height))
    axes.set_axis_off()
    places = {room.name: place for floor in range(floors) for room, place in on_floor(rooms, floor)}
    for room in rooms:
        for below in room.stands_on:
            axes.add_patch(arrow(places[room.name], places[below]))
    for room in rooms:
        x, y = places[room.name]
        axes.add_patch(
            FancyBboxPatch(
                (x - 0.5 * BOX_WIDTH_IN, y - 0.5 * BOX_IN), BOX_WIDTH_IN, BOX_IN,
                boxstyle="round,pad=0,rounding_size=0.06", facecolor="white", edgecolor=SKY, linewidth=1.2, zorder=3,
            )
        )  # fmt: skip
        axes.text(x, y + 0.23, room.name, ha="center", va="center", fontsize=9, weight="bold", color=INK, zorder=4)
        said = fill(room.purpose, LETTERS, max_lines=3, placeholder=" …")
        axes.text(x, y - 0.1, said, ha="center", va="center", fontsize=7, color=INK, zorder=4)
    return figure


def on_floor(rooms: tuple[Room, ...], floor: int) -> list[tuple[Room, tuple[float, float]]]:
    """The rooms of a floor with the middle of their boxes, in inches; a lone one left or right by turns."""
    here = [room for room in rooms if room.floor == floor]
    middle = 0.5 * WIDTH_IN
    shift = 0.45 * (1 if floor % 2 else -1) if len(here) == 1 else 0.0
    step = BOX_WIDTH_IN + 0.25
    first = middle + shift - 0.5 * step * (len(here) - 1)
    return [(room, (first + step * k, 0.5 + FLOOR_IN * floor)) for k, room in enumerate(here)]


def arrow(start: tuple[float, float], end: tuple[float, float]) -> FancyArrowPatch:
    """From the lower edge of a box to the upper edge of another; around those between, where it passes floors."""
    (x, y), (to_x, to_y) = (start[0], start[1] - 0.5 * BOX_IN), (end[0], end[1] + 0.5 * BOX_IN)
    bent = 0.0 if y - to_y < FLOOR_IN else 0.35
    return FancyArrowPatch(
        (x, y), (to_x, to_y), arrowstyle="-|>", mutation_scale=9, color=GREY, linewidth=1.0,
        connectionstyle=f"arc3,rad={bent}", shrinkA=0.0, shrinkB=0.0, zorder=2,
    )  # fmt: skip


def figures(found: Rooms) -> Mapping[str, Figure]:
    """The one picture."""
    return {"house": picture(found.rooms)}
