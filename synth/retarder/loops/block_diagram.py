"""The block diagram of a closed loop, drawn from the declaration of its parts."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping, Sequence
from itertools import combinations, pairwise
from math import dist

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch, Rectangle

from synth.frame.picture.house_style import GREY, INK, MATHEMATICS, new_figure
from synth.retarder.loops.block_layout import (
    HEIGHT_IN,
    NAMES,
    POINT_SENSOR_ROUTES,
    RADAR_ROUTES,
    SIZE_IN,
    WIDTH_IN,
    Place,
    Route,
    centre,
    corners,
)
from synth.retarder.loops.control_loop import LineControlLoop, PassageControlLoop
from synth.retarder.pictures.table_picture import subject
from synth.simulation.controllers import TableController
from synth.simulation.structure.diagram import Block, Box, Sketch, Wire
from synth.simulation.structure.regulators import passage_diagram, radar_diagram


def loop_structure(loop: LineControlLoop | PassageControlLoop) -> Figure:
    """The parts of the loop and their wires. `ValueError` for a table with an estimator."""
    if isinstance(loop, PassageControlLoop):
        return block_diagram(
            passage_diagram(loop.loop, loop.controller).sketch, POINT_SENSOR_ROUTES, subject(loop.table)
        )
    diagram = radar_diagram(loop.plant, TableController(loop.table), 0.5 * loop.plant.sensor.sample_period_s)
    return block_diagram(diagram.sketch, RADAR_ROUTES, subject(loop.table))


FILLS: Mapping[Block, str] = {
    Block.MEASURING: "#eaf4fb",
    Block.COMPUTER: "#fdf3e1",
    Block.PRESSURE: "#e8f5f0",
    Block.PADS: "#fae9e1",
    Block.CUT: "#f3eaf1",
}
"""Pale shades of the house colours; the name of the block stands on each."""

MARGIN_IN = 0.22
LETTERS_A_LINE = 15
MATHTEXT = {"{": r"\{", "}": r"\}", "⁻¹": "^{-1}", "*": "^{*}", " ": r"\ ", "sgn": r"\mathrm{sgn}"}
GREEK = {"ε": r"\varepsilon", "ξ": r"\xi", "η": r"\eta", "τ": r"\tau", "σ": r"\sigma", "Δ": r"\Delta ", "−": "-"}


def block_diagram(sketch: Sketch, routes: Mapping[tuple[str, str], Route], subject: str = "") -> Figure:
    """The parts of a diagram as boxes in their blocks, its signals as wires on `routes`. `KeyError` for no route."""
    figure = new_figure(*SIZE_IN, f"Regulator and plant, {sketch.title}", subject)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, SIZE_IN[0]), ylim=(0.0, SIZE_IN[1]))
    axes.set_axis_off()
    for block in Block:
        draw_block(axes, block, [box for box in sketch.boxes if box.block == block.value])
    for wire in sketch.wires:
        draw_wire(axes, wire, routes[wire.signal, wire.target])
    for x, y in branches(sketch, routes):
        axes.plot(x, y, marker="o", markersize=4.0, color=INK, zorder=2)
    for box in sketch.boxes:
        draw_part(axes, box)
    return figure


def draw_block(axes: Axes, block: Block, boxes: list[Box]) -> None:
    """A pale field behind the parts of a block, with its name."""
    places = [centre(box.name) for box in boxes]
    left, right = (edge(x for x, _ in places) for edge in (min, max))
    low, high = (edge(y for _, y in places) for edge in (min, max))
    x, y = left - 0.5 * WIDTH_IN - MARGIN_IN, low - 0.5 * HEIGHT_IN - MARGIN_IN
    width, height = right - left + WIDTH_IN + 2.0 * MARGIN_IN, high - low + HEIGHT_IN + 2.0 * MARGIN_IN
    axes.add_patch(Rectangle((x, y), width, height, facecolor=FILLS[block], edgecolor="none", zorder=0))
    across, up = NAMES[block]
    axes.text(
        x + 0.06 + across * (width - 0.12), y + 0.03 + up * (height - 0.06), block.value, fontsize=9, color=GREY,
        ha=("left", "center", "right")[round(2 * across)], va=("bottom", "center", "top")[round(2 * up)],
        style="italic",
    )  # fmt: skip


def draw_part(axes: Axes, box: Box) -> None:
    """A box with the name of the part and its symbol in the source."""
    x, y = centre(box.name)
    corner = x - 0.5 * WIDTH_IN, y - 0.5 * HEIGHT_IN
    frame = FancyBboxPatch(
        corner, WIDTH_IN, HEIGHT_IN, boxstyle="round,pad=0,rounding_size=0.05", facecolor="white", edgecolor=INK,
        linewidth=1.1, zorder=3,
    )  # fmt: skip
    axes.add_patch(frame)
    name = textwrap.fill(box.name, LETTERS_A_LINE)
    text = f"{name}\n{in_mathtext(box.symbol)}" if box.symbol else name
    axes.text(x, y, text, ha="center", va="center", fontsize=8.5, linespacing=1.15, color=INK, zorder=4,
              label=MATHEMATICS)  # fmt: skip


def draw_wire(axes: Axes, wire: Wire, route: Route) -> None:
    """An arrow along the route, and the name of the signal."""
    places = corners(wire.source, wire.target, route)
    xs, ys = zip(*places, strict=True)
    axes.plot(xs[:-1], ys[:-1], color=INK, linewidth=1.0, zorder=2, solid_joinstyle="miter")
    axes.annotate(
        "", places[-1], places[-2],
        arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 1.0, "shrinkA": 0.0, "shrinkB": 0.0}, zorder=2,
    )  # fmt: skip
    if not wire.source:
        axes.text(*places[0], in_mathtext(wire.signal), ha="center", va="bottom" if ys[0] > ys[-1] else "top",
                  fontsize=9.5, color=INK, label=MATHEMATICS)  # fmt: skip
    elif route.label >= 0:
        draw_name(axes, wire.signal, places[route.label], places[route.label + 1])


def draw_name(axes: Axes, signal: str, start: Place, end: Place) -> None:
    """The name of a signal above a horizontal stretch of its wire, or to the right of a vertical one."""
    x, y = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    text = in_mathtext(signal)
    if start[1] == end[1]:
        axes.text(x, y + 0.05, text, ha="center", va="bottom", fontsize=9.5, color=INK, zorder=5, label=MATHEMATICS)
    else:
        axes.text(x + 0.06, y, text, ha="left", va="center", fontsize=9.5, color=INK, zorder=5, label=MATHEMATICS)


def branches(sketch: Sketch, routes: Mapping[tuple[str, str], Route]) -> set[Place]:
    """Where two wires of one signal part that have left their source together."""
    found = set()
    for one, other in combinations(sketch.wires, 2):
        if (one.signal, one.source) == (other.signal, other.source) and one.source:
            paths = [corners(each.source, each.target, routes[each.signal, each.target]) for each in (one, other)]
            if paths[0][0] == paths[1][0]:
                found.add(parting(*paths))
    return found


def parting(one: Sequence[Place], other: Sequence[Place]) -> Place:
    """The last place that two paths of the same beginning share."""
    for (a, b), (_, c) in zip(pairwise(one), pairwise(other), strict=False):
        if b != c:
            along = [dist(a, each) for each in (b, c)]
            together = (b[0] - a[0]) * (c[0] - a[0]) + (b[1] - a[1]) * (c[1] - a[1]) > 0.0
            return (b if along[0] < along[1] else c) if together else a
    return one[-1]


def in_mathtext(symbol: str) -> str:
    """A symbol with its subscripts set as such; words and Cyrillic letters stay as they are."""
    if not re.search(r"[_*\[(⁻]|^[A-Za-zεξητz]$", symbol):
        return symbol
    text = symbol
    for letters, set_as in MATHTEXT.items():
        text = text.replace(letters, set_as)
    text = re.sub(r"\bsign\b", r"\\mathrm{sign}", text)
    text = re.sub(r"_(\w+)", lambda found: f"_{{{roman(found[1])}}}", text)
    return "$" + "".join(GREEK.get(letter, letter) for letter in text) + "$"


def roman(subscript: str) -> str:
    """Words below a symbol stand upright, single letters do not."""
    return rf"\mathrm{{{subscript}}}" if len(subscript) > 1 else subscript
