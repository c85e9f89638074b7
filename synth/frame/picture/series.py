"""How lines that follow an order (cars, distances, resistances) are told apart: dark to light, each with a marker."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib import colormaps
from matplotlib.colors import to_hex
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import LINE_MARKERS


def graded(count: int) -> tuple[str, ...]:
    """`count` colours in an order that is one in grey, too: dark blue over red to yellow, its palest end left out; they
    are none of those of the weight categories."""
    scale = colormaps["plasma"]
    return tuple(to_hex(scale(0.9 * place / max(count - 1, 1))) for place in range(count))


def markers(count: int) -> tuple[str, ...]:
    """`count` markers."""
    return tuple(LINE_MARKERS[place % len(LINE_MARKERS)] for place in range(count))


def named_lines(names: Sequence[str]) -> list[Line2D]:
    """Entries of a legend for lines in this order."""
    looks = zip(names, graded(len(names)), markers(len(names)), strict=True)
    return [Line2D([], [], color=colour, marker=marker, markersize=4, label=name) for name, colour, marker in looks]
