"""Where the boxes of a block diagram stand and how its wires run, inches from the lower left corner.

A closed loop runs clockwise: measuring block and control computer from left to right in the upper rows, drive, pads and
cut from right to left in the lower ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from synth.simulation.structure.diagram import Block

Place = tuple[float, float]

COLUMN_IN, FIRST_COLUMN_IN = 1.78, 1.05
ROWS_IN: Final = (5.2, 4.05, 2.55, 1.3)
WIDTH_IN, HEIGHT_IN = 1.24, 0.74
SIZE_IN: Final = (14.5, 6.6)

_SHARED: Final[dict[str, tuple[int, int]]] = {
    "impulse element": (1, 0),
    "relay element of the speed": (2, 0),
    "relay element of the path": (2, 1),
    "digital controller": (3, 0),
    "lock": (3, 1),
    "computing delay": (5, 0),
    "ideal impulse element": (6, 0),
    "zero-order hold": (7, 0),
    "comparison": (7, 2),
    "relay element of the pressure": (6, 2),
    "block of changing structure": (5, 2),
    "valve delay": (4, 2),
    "pneumatic link": (3, 2),
    "converter": (5, 3),
    "dead zone of the pads": (2, 2),
    "slope of the pads": (2, 3),
    "integrator of the speed": (1, 2),
    "integrator of the path": (0, 2),
}
CELLS: Final[dict[str, tuple[int, int]]] = {
    **_SHARED,
    "functional converter": (0, 0),
    "interlock of the entrance": (4, 0),
}
"""(column, row) of every part, rows from above."""

NAMES: Final[dict[Block, tuple[float, float]]] = {
    Block.MEASURING: (0.0, 1.0),
    Block.COMPUTER: (1.0, 1.0),
    Block.PRESSURE: (1.0, 0.0),
    Block.PADS: (0.5, 0.5),
    Block.CUT: (1.0, 0.0),
}
"""Where in the field of a block its name stands: 0 … 1 from the left to the right and from below."""


@dataclass(frozen=True)
class Route:
    """A wire: `out` and `into` are the places where it leaves the source and meets the target, relative to the boxes.

    (−1 … 1, −1 … 1) from the left to the right and from the lower to the upper side of a box. `via`: the corners, each
    the x of a vertical or the y of a horizontal stretch, in turn; `label`: the stretch that bears the name, −1: none.
    """

    out: Place
    into: Place
    via: tuple[float, ...] = ()
    label: int = 0


def centre(name: str) -> Place:
    """The middle of the box of a part."""
    column, row = CELLS[name]
    return FIRST_COLUMN_IN + COLUMN_IN * column, ROWS_IN[row]


def port(name: str, place: Place) -> Place:
    """A place on the border of a box, (−1 … 1, −1 … 1)."""
    x, y = centre(name)
    return x + 0.5 * WIDTH_IN * place[0], y + 0.5 * HEIGHT_IN * place[1]


def gap(column: float) -> float:
    """x of the gap behind a column."""
    return FIRST_COLUMN_IN + COLUMN_IN * (column + 0.5)


RIGHT, LEFT, UP, DOWN = (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)

ABOVE = ROWS_IN[0] + 0.62
UNDER_COMPUTER = ROWS_IN[1] - 0.5
BETWEEN = 0.5 * (ROWS_IN[1] + ROWS_IN[2])
BELOW = 0.5 * (ROWS_IN[2] + ROWS_IN[3])

_FROM_COMMAND: Final[dict[tuple[str, str], Route]] = {
    ("U_τ[n]", "ideal impulse element"): Route(RIGHT, LEFT),
    ("U*[n]", "zero-order hold"): Route(RIGHT, LEFT),
    ("U_k", "comparison"): Route(DOWN, UP, label=0),
    ("U_k", "valve delay"): Route((-0.5, -1.0), UP, (BETWEEN - 0.12,), label=1),
    ("ε_U", "relay element of the pressure"): Route(LEFT, RIGHT),
    ("sgn ε_U", "block of changing structure"): Route(LEFT, RIGHT),
    ("P_in, T", "valve delay"): Route(LEFT, RIGHT),
    ("P_v, T", "pneumatic link"): Route(LEFT, RIGHT),
    ("P", "dead zone of the pads"): Route(LEFT, RIGHT),
    ("P", "converter"): Route(DOWN, LEFT, (ROWS_IN[3],), label=1),
    ("P", "valve delay"): Route((0.4, -1.0), DOWN, (BELOW,), label=1),
    ("P", "block of changing structure"): Route((0.4, -1.0), (-0.4, -1.0), (BELOW,), label=-1),
    ("U_P", "comparison"): Route(RIGHT, DOWN, (), label=0),
    ("p", "integrator of the speed"): Route(LEFT, RIGHT),
    ("B(S)", "integrator of the speed"): Route(LEFT, (0.4, -1.0), label=0),
    ("V", "integrator of the path"): Route(LEFT, RIGHT),
    ("S", "integrator of the speed"): Route(DOWN, (-0.4, -1.0), (BELOW,), label=1),
    ("ξ_cut", "slope of the pads"): Route((-0.5, -1.9), (-0.5, -1.0)),
    ("η", "slope of the pads"): Route((0.5, -1.9), (0.5, -1.0)),
    ("locked", "digital controller"): Route(UP, DOWN),
    ("z", "relay element of the speed"): Route((0.0, 1.9), UP),
}

RADAR_ROUTES: Final[dict[tuple[str, str], Route]] = {
    **_FROM_COMMAND,
    ("V", "impulse element"): Route(UP, DOWN),
    ("S", "impulse element"): Route(UP, LEFT, (), label=0),
    ("V[n]", "relay element of the speed"): Route(RIGHT, LEFT),
    ("S[n]", "relay element of the path"): Route((1.0, -0.6), LEFT, (gap(1),), label=1),
    ("V*[n]", "digital controller"): Route(RIGHT, LEFT),
    ("S*[n]", "digital controller"): Route(RIGHT, (-1.0, -0.6), (gap(2),), label=1),
    ("S*[n]", "interlock of the entrance"): Route(DOWN, DOWN, (UNDER_COMPUTER,), label=2),
    ("D[n]", "interlock of the entrance"): Route(RIGHT, LEFT),
    ("U[n]", "computing delay"): Route(RIGHT, LEFT, label=-1),
    ("U[n]", "digital controller"): Route(RIGHT, UP, (gap(4), ABOVE), label=-1),
    ("U[n]", "lock"): Route(RIGHT, RIGHT, (gap(4),), label=1),
}
"""(signal, target) → route, for a radar."""

POINT_SENSOR_ROUTES: Final[dict[tuple[str, str], Route]] = {
    **_FROM_COMMAND,
    ("S", "functional converter"): Route((-0.4, 1.0), (-0.4, -1.0)),
    ("V", "functional converter"): Route(UP, (0.4, -1.0), (BETWEEN,), label=0),
    ("F⁻¹(S)", "impulse element"): Route(RIGHT, LEFT),
    ("z_b", "impulse element"): Route((0.0, 1.9), UP),
    ("t_V[n]", "relay element of the speed"): Route(RIGHT, LEFT),
    ("m[n]", "relay element of the path"): Route((0.5, -1.0), (-1.0, 0.45), label=1),
    ("Δt[n]", "relay element of the path"): Route((-0.5, -1.0), (-1.0, -0.45), label=1),
    ("V*[n]", "digital controller"): Route(RIGHT, LEFT),
    ("V*[n]", "relay element of the path"): Route(DOWN, UP),
    ("S*[n]", "digital controller"): Route(RIGHT, (-1.0, -0.6), (gap(2),), label=1),
    ("U[n]", "computing delay"): Route(RIGHT, LEFT),
    ("U[n]", "lock"): Route(RIGHT, RIGHT, (gap(3),), label=-1),
}
"""(signal, target) → route, for point sensors."""


def corners(source: str, target: str, route: Route) -> tuple[Place, ...]:
    """All corners of a wire from end to end; a wire from outside begins where `out` says, beside the target."""
    start, end = port(source or target, route.out), port(target, route.into)
    horizontal = abs(route.out[0]) == 1.0 and bool(source)
    places, here = [start], start
    for step in route.via:
        here = (step, here[1]) if horizontal else (here[0], step)
        places.append(here)
        horizontal = not horizontal
    here = (end[0], here[1]) if horizontal else (here[0], end[1])
    return (*places, here, end) if here != end else (*places, end)
