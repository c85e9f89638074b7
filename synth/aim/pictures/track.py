"""The track: its height, its positions and bends, and how good and bad runners lose their energy on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from synth.aim.aim_curves import RUNNERS, Runners
from synth.aim.scene import AimScene
from synth.frame.picture.category_colour import category_colour
from synth.frame.picture.house_style import (
    GREY,
    INK,
    LINE_STYLES,
    PALE_GREY,
    dress,
    legend_below,
    new_figure,
    place,
)

LOOKS = LINE_STYLES[1], LINE_STYLES[0], LINE_STYLES[3]
"""Strokes of a bad, a middling and a good runner; the colour is that of the category."""


def track(scene: AimScene, rolled: Sequence[Runners]) -> Figure:
    """Height over distance from the crest, energy heads above it, in the colour of each category."""
    figure = new_figure(
        10.5,
        5.2,
        "The track, and how far cuts would roll unbraked",
        "Energy head of single cars from the bunch position on: 5, 50 and 95 of 100 cars are slower at each place",
    )
    place(figure, left=0.7, right=0.2, bottom=1.25, top=0.85)
    axes = figure.subplots()
    dress(axes, x="distance from the crest, m", y="height above the end of the track, m")
    x = np.linspace(0.0, scene.track.end_m, 1000)
    end = float(scene.track.fall_m(np.array([scene.track.end_m]))[0])
    height = end - scene.track.fall_m(x)
    axes.fill_between(x, height, min(0.0, float(height.min())), color=PALE_GREY, linewidth=0.0)
    axes.plot(x, height, color=INK, linewidth=1.4)
    for each in rolled:
        colour = category_colour(each.category.number)
        ground = end - scene.track.fall_m(each.head_m)
        for style, head in zip(LOOKS, each.energy_head_m, strict=True):
            rolls = head > 0.0
            axes.plot(each.head_m[rolls], (ground + head)[rolls], color=colour, linewidth=1.4, linestyle=style)
    mark(axes, scene)
    names = ("bad", "middling", "good")
    handles: list[Artist] = [
        Line2D(
            [],
            [],
            color=category_colour(each.category.number),
            linestyle=style,
            label=f"{each.category.name}, {name} ({100.0 * q:g} of 100)",
        )
        for each in rolled
        for style, name, q in zip(LOOKS, names, RUNNERS, strict=True)
    ]
    handles += [
        Line2D([], [], color=GREY, linewidth=5, label="measured stretch"),
        Patch(color=INK, label="park position"),
    ]
    handles.append(Line2D([], [], color=GREY, linestyle="none", marker="|", markersize=9, label="switch or curve"))
    legend_below(figure, handles, columns=3)
    axes.set_xlim(0.0, scene.track.end_m)
    return figure


def mark(axes: Axes, scene: AimScene) -> None:
    """Stretch, position and bends along the bottom."""
    stretch, bottom = scene.stretch, axes.get_xaxis_transform()
    spans = [(stretch.from_m, stretch.to_m - stretch.from_m)]
    axes.broken_barh(spans, (0.0, 0.018), transform=bottom, facecolor=GREY, zorder=4)
    position = [(scene.entrance_m, scene.exit_m - scene.entrance_m)]
    axes.broken_barh(position, (0.0, 0.03), transform=bottom, facecolor=INK, zorder=5)
    middles = [0.5 * (bend.from_m + bend.to_m) for bend in scene.track.bends]
    axes.plot(middles, [0.045] * len(middles), "|", color=GREY, markersize=9, transform=bottom, zorder=4)
